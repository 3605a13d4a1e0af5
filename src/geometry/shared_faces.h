/* A test whether two solids may have coincident faces. Pure. */
#pragma once

#include "geometry/solid.h"

/* False: no face of one coincides with part of a face of the other, flat with flat (in the same plane) or curved with
 * curved. True: perhaps. Two meshes of many triangles are not compared. */
bool solid_shapes_may_share_faces(const solid_shape *a, const solid_shape *b);
