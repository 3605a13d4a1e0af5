/* Does a ray pass a box by? By the separating axes of a line and a box, the products of the ray's direction with the
 * box's edges (Gottschalk, Lin, Manocha, "OBBTree", SIGGRAPH 1996), and the box's own axes, along which it leaves. The
 * box is widened far beyond the rounding error of a hit, so that the test only saves time. Pure; cannot fail. */
#pragma once

#include "base/lanes.h"
#include "base/vec3.h"

/* -1 if it does, otherwise 0; also 0 for a box that is not a number. */
static inline int64_t box_passes(vec3 low, vec3 high, vec3 o, vec3 d)
{
    const vec3 m = vec3_make(o.x - 0.5 * (low.x + high.x), o.y - 0.5 * (low.y + high.y), o.z - 0.5 * (low.z + high.z));
    const double wider = 0x1p-30 * ((magnitude(o.x) + magnitude(o.y) + magnitude(o.z)) +
                                    ((magnitude(low.x) + magnitude(low.y) + magnitude(low.z)) +
                                     (magnitude(high.x) + magnitude(high.y) + magnitude(high.z))));
    const double x = 0.5 * (high.x - low.x) + wider, y = 0.5 * (high.y - low.y) + wider,
                 z = 0.5 * (high.z - low.z) + wider;
    const double dx = magnitude(d.x), dy = magnitude(d.y), dz = magnitude(d.z);
    return mask_less(y * dz + z * dy, magnitude(m.y * d.z - m.z * d.y)) |
           mask_less(z * dx + x * dz, magnitude(m.z * d.x - m.x * d.z)) |
           mask_less(x * dy + y * dx, magnitude(m.x * d.y - m.y * d.x)) |
           (mask_less(x, magnitude(m.x)) & mask_less(0.0, m.x * d.x)) |
           (mask_less(y, magnitude(m.y)) & mask_less(0.0, m.y * d.y)) |
           (mask_less(z, magnitude(m.z)) & mask_less(0.0, m.z * d.z));
}
