/* Extents of placed shapes and coverage tests. */
#include "geometry/shapes/placed.h"

#include <math.h>

placed_shape shape_placed(const solid_shape *shape)
{
    return (placed_shape){*shape, rotation_from_deg(shape->rotation_deg)};
}

vec3 placed_axis(const mat3 *turn, int k)
{
    return mat3_apply(*turn, vec3_make(k == 0, k == 1, k == 2));
}

double placed_limit(const placed_shape *placed, vec3 direction)
{
    const solid_shape *shape = &placed->shape;
    return vec3_dot(direction, shape->position) +
           shape_of(shape)->farthest(shape, mat3_apply_transposed(placed->turn, direction));
}

double placed_farthest(const placed_shape *placed, vec3 direction)
{
    return shape_of(&placed->shape)->unbounded ? INFINITY : placed_limit(placed, direction);
}

double round_distance(const round_frame *f, vec3 point)
{
    const vec3 p = mat3_apply_transposed(f->turn, vec3_sub(point, f->origin));
    return f->from_point ? vec3_length(p) : hypot(p.x, f->m * p.z);
}

static vec3 corner_of(bounds3 b, int i)
{
    return vec3_make(i & 1 ? b.high.x : b.low.x, i & 2 ? b.high.y : b.low.y, i & 4 ? b.high.z : b.low.z);
}

double placed_farthest_from(const placed_shape *placed, const round_frame *frame)
{
    const solid_shape *shape = &placed->shape;
    const shape_rule *rule = shape_of(shape);
    if (rule->unbounded)
        return INFINITY;
    if (rule->farthest_from)
        return rule->farthest_from(placed, frame);
    const bounds3 box = rule->extent(shape).box;
    double most = -INFINITY;
    for (int i = 0; i < 8; i++) {
        const vec3 corner = mat3_apply(placed->turn, corner_of(box, i));
        most = fmax(most, round_distance(frame, vec3_add(shape->position, corner)));
    }
    return most;
}

bool placed_is_between(const placed_shape *cover, const placed_shape *hidden, int k, double low, double high)
{
    const vec3 up = placed_axis(&cover->turn, k);
    const double from = vec3_dot(up, cover->shape.position), length = high - low + fabs(from);
    return is_within(placed_farthest(hidden, up), from + high, length) &&
           is_within(placed_farthest(hidden, vec3_scale(up, -1.0)), -from - low, length);
}

double shape_reach(const solid_shape *shape, vec3 d)
{
    const shape_rule *rule = shape_of(shape);
    if (!rule->triangles)
        return rule->farthest(shape, d);
    const bounds3 b = rule->extent(shape).box;
    return (d.x > 0.0 ? b.high.x : b.low.x) * d.x + (d.y > 0.0 ? b.high.y : b.low.y) * d.y +
           (d.z > 0.0 ? b.high.z : b.low.z) * d.z;
}

bounds3 shape_world_box(const solid_shape *shape)
{
    const vec3 ever = vec3_make(HUGE_VAL, HUGE_VAL, HUGE_VAL), at = shape->position;
    if (shape_of(shape)->unbounded)
        return (bounds3){vec3_scale(ever, -1.0), ever};
    const mat3 turn = rotation_from_deg(shape->rotation_deg);
    double low[3], high[3];
    for (int k = 0; k < 3; k++) { /* the world's axes in the solid's frame */
        high[k] = shape_reach(shape, turn.row[k]);
        low[k] = -shape_reach(shape, vec3_scale(turn.row[k], -1.0));
    }
    return (bounds3){vec3_add(at, vec3_make(low[0], low[1], low[2])),
                     vec3_add(at, vec3_make(high[0], high[1], high[2]))};
}
