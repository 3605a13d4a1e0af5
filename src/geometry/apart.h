/* Are two solids certainly apart? By planes between their convex hulls. Pure. */
#ifndef CUVETTE_GEOMETRY_APART_H
#define CUVETTE_GEOMETRY_APART_H

#include "geometry/solid.h"

/* True: they share no point, but for faces that touch. False: they may overlap; also for a mesh whose triangles are not there. */
bool solid_shapes_apart(const solid_shape *a, const solid_shape *b);

/* False: no face of one lies in a face of the other, flat in flat (two planes that are one) or curved in curved. True: perhaps. Meshes of many
 * triangles each are not compared. */
bool solid_shapes_may_share_faces(const solid_shape *a, const solid_shape *b);

#endif
