/* May faces of two solids lie in one another? Pure. */
#pragma once

#include "geometry/solid.h"

/* False: no face of one lies in a face of the other, flat in flat (two planes that are one) or curved in curved. True:
 * perhaps. Meshes of many triangles each are not compared. */
bool solid_shapes_may_share_faces(const solid_shape *a, const solid_shape *b);
