/* Functions that several shapes share, and the extents of placed shapes. */
#include "geometry/shapes/parts.h"
#include "base/elementary.h"
#include <math.h>

/* R = R_z R_y R_x: rotation about x comes first. R_x rotates y towards z, R_y z towards x, R_z x towards y. */
double settled_deg(double degrees)
{
    double round = floor(degrees * 1e6 + 0.5) / 1e6;
    return fabs(round - degrees) < 1e-12 ? round : degrees;
}

mat3 mat3_product(mat3 a, mat3 b)
{
    mat3 c;
    for (int i = 0; i < 3; i++)
        c.row[i] = mat3_apply_transposed(b, a.row[i]);
    return c;
}

/* Angles whose rotation_from_deg is r = R_z R_y R_x. The x angle is computed from R_z^-1 r instead of r's last row, so
 * that it compensates any choice of z when y is 90 or -90 degrees: then the local x axis is along the world's z, and x
 * and z rotate about the same line. Herter and Lott, Algorithms for decomposing 3-D orthogonal matrices into primitive
 * rotations, Computers & Graphics 17 (1993). */
vec3 rotation_to_deg(mat3 r)
{
    const double cos_y = sqrt(r.row[0].x * r.row[0].x + r.row[1].x * r.row[1].x);
    const double z = elementary_atan2_deg(r.row[1].x, r.row[0].x);
    double sz, cz;
    elementary_sincos_deg(z, &sz, &cz);
    const double cos_x = cz * r.row[1].y - sz * r.row[0].y, minus_sin_x = cz * r.row[1].z - sz * r.row[0].z;
    return vec3_make(settled_deg(elementary_atan2_deg(-minus_sin_x, cos_x)),
                     settled_deg(elementary_atan2_deg(-r.row[2].x, cos_y)), settled_deg(z));
}

mat3 rotation_from_deg(vec3 rotation_deg)
{
    double sx, cx, sy, cy, sz, cz;
    elementary_sincos_deg(rotation_deg.x, &sx, &cx);
    elementary_sincos_deg(rotation_deg.y, &sy, &cy);
    elementary_sincos_deg(rotation_deg.z, &sz, &cz);
    mat3 r;
    r.row[0] = vec3_make(cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx);
    r.row[1] = vec3_make(sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx);
    r.row[2] = vec3_make(-sy, cy * sx, cy * cx);
    return r;
}

status check_length(double value, const char *name, diagnostic *why)
{
    if (isfinite(value) && value > 0.0)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "use a length above 0", "%s is %g", name, value);
}

primitive primitive_placed(const solid_shape *shape, const primitive_rule *rule, double reach)
{
    primitive p = {.rule = rule, .origin = shape->position, .m2 = 1.0};
    const vec3 r = shape->rotation_deg;
    p.rotation = rotation_from_deg(r);
    p.turned = r.x != 0.0 || r.y != 0.0 || r.z != 0.0;
    p.extent = largest_of(fabs(p.origin.x), fabs(p.origin.y), fabs(p.origin.z)) + reach;
    return p;
}

shape_extent extent_of_size(vec3 size)
{
    const vec3 half = vec3_scale(size, 0.5);
    return (shape_extent){{vec3_scale(half, -1.0), half}, 0.5 * vec3_length(size)};
}

status tessellate_lathe(const profile_point *profile, size_t count, mesh **out, diagnostic *why)
{
    return generate_lathe(profile, count, ROUND_SEGMENTS, 30.0, out, why);
}

bool level_faces(const double *heights, size_t count, size_t i, vec3 *normal, vec3 *point)
{
    *normal = vec3_make(0.0, 1.0, 0.0);
    *point = vec3_make(0.0, i < count ? heights[i] : 0.0, 0.0);
    return i < count;
}

/* --- scale --- */

bool rule_scales(const shape_rule *rule, const solid_shape *s)
{
    const vec3 k = s->scale;
    const bool unset = k.x == 0.0 && k.y == 0.0 && k.z == 0.0;
    return shape_has_scale(s) && !unset && !s->points && !rule->triangles && !rule->unbounded;
}

shape_extent rule_extent(const shape_rule *rule, const solid_shape *s)
{
    shape_extent e = rule->extent(s);
    if (!shape_has_scale(s) || !rule_scales(rule, s))
        return e;
    const vec3 a = multiplied(e.box.low, s->scale), b = multiplied(e.box.high, s->scale), k = sizes(s->scale);
    e.box.low = vec3_make(fmin(a.x, b.x), fmin(a.y, b.y), fmin(a.z, b.z));
    e.box.high = vec3_make(fmax(a.x, b.x), fmax(a.y, b.y), fmax(a.z, b.z));
    e.ball = fmin(e.ball * fmax(k.x, fmax(k.y, k.z)), 0.5 * vec3_length(vec3_sub(e.box.high, e.box.low)));
    return e;
}

/* d . (K p) = (K d) . p for the diagonal matrix K of the scale. */
double rule_farthest(const shape_rule *rule, const solid_shape *s, vec3 d)
{
    if (!shape_has_scale(s) || !rule_scales(rule, s))
        return rule->farthest(s, d);
    const vec3 along = multiplied(d, s->scale);
    const double length = vec3_length(along);
    return length * rule->farthest(s, vec3_scale(along, 1.0 / length));
}

/* --- placed shapes --- */

vec3 placed_axis(const mat3 *turn, int k)
{
    return mat3_apply(*turn, vec3_make(k == 0, k == 1, k == 2));
}

double points_reach(const solid_shape *shape, vec3 d)
{
    const vec3 s = shape->scale;
    return shape->points ? box_reach(shape->points->bounds, vec3_make(s.x * d.x, s.y * d.y, s.z * d.z)) : 0.0;
}

double placed_limit(const placed_shape *placed, vec3 direction)
{
    const solid_shape *shape = &placed->shape;
    const vec3 local = mat3_apply_transposed(placed->turn, direction);
    return vec3_dot(direction, shape->position) +
           (rule_farthest(placed->rule, shape, local) + points_reach(shape, local));
}

double placed_farthest(const placed_shape *placed, vec3 direction)
{
    return placed->rule->unbounded ? INFINITY : placed_limit(placed, direction);
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
    const shape_rule *rule = placed->rule;
    if (rule->unbounded || shape->points) /* points: not needed */
        return INFINITY;
    if (rule->farthest_from && !rule_scales(rule, shape))
        return rule->farthest_from(placed, frame);
    const bounds3 box = rule_extent(rule, shape).box;
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
