/* Are two solids certainly apart? By planes between their convex hulls. Pure. */
#ifndef CUVETTE_GEOMETRY_APART_H
#define CUVETTE_GEOMETRY_APART_H

#include "geometry/solid.h"

/* True: they share no point. False: they may overlap; also for a mesh whose triangles are not there. */
bool solid_shapes_apart(const solid_shape *a, const solid_shape *b);

#endif
