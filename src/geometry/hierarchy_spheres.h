/* The ray-sphere test of the sphere trees: a sphere is hit if the ray's line passes within its radius plus a margin
 * wider than the rounding error, and part of its inside is between t_min and the best hit. */
#pragma once

#include "geometry/hierarchy_query.h"

/* The spheres on the stack of a traversal: per level at most all children of one node. */
typedef struct sphere_pending {
    double near;
    uint32_t node;
} sphere_pending;
enum { SPHERES_PENDING = SPHERES_DEPTH_MAX * 8 };

#define SPHERE_MARGIN 0x1p-20 /* relative; wider than the rounding of centre and radius to floats */

/* The ray's distance to its entry into the sphere; +inf for a miss. The centre's distance from the line is computed by
 * components, since a difference of squares would cancel (Haines et al., "Precision improvements for ray/sphere
 * intersection", Ray Tracing Gems, 2019). */
ALWAYS_INLINE double sphere_near(const ray_query *q, double inverse_square, const sphere_node *s)
{
    double center[3], along = 0.0, off = 0.0, reach = 0.0;
    for (int k = 0; k < 3; k++) {
        center[k] = (double)s->center[k] - q->origin[k];
        along += center[k] * q->direction[k];
        reach = greater(reach, magnitude(center[k]));
    }
    along *= inverse_square;
    for (int k = 0; k < 3; k++) {
        const double away = center[k] - along * q->direction[k];
        off += away * away;
    }
    const double radius = (double)s->radius * (1.0 + SPHERE_MARGIN) + reach * BOX_MARGIN;
    if (!(off <= radius * radius))
        return (double)INFINITY;
    /* The direction is at least 1 long, so that the radius bounds half of the chord's length in t. */
    const double near = along - radius, far = along + radius;
    return far < q->t_min || near > q->t_best ? (double)INFINITY : near;
}
