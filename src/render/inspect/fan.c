/* Following the rays of a fan; crossings by plane geometry, the focus by least squares. */
#include "render/inspect/fan.h"

#include "base/array.h"
#include "base/budget.h"
#include "base/cancel.h"
#include "base/elementary.h"
#include "render/plan/sampling.h"
#include <stdlib.h>
#include <string.h>

/* Directions are rounded to 2^-53 at each surface, and its curvature magnifies the error: rays that differ by less than
 * PARALLEL_RAD count as parallel. A focus is found up to 1e11 widths of the fan away. */
#define PARALLEL_RAD 1e-12

void fan_release(fan *f)
{
    free(f->ray);
    free(f->node);
    free(f->crossing);
    memset(f, 0, sizeof *f);
}

static status set_axes(const fan_rule *rule, fan *f, diagnostic *why)
{
    ray_axes a = {.from = rule->from};
    const status result =
        ray_axes_set(&a, rule->from, vec3_sub(rule->to, rule->from), rule->has_normal ? &rule->normal : NULL, why);
    f->from = a.from, f->axis = a.axis, f->across = a.across, f->normal = a.normal;
    return result;
}

static void start_of(const fan *f, const fan_rule *rule, int i, fan_ray *ray, vec3 *origin, vec3 *direction)
{
    const ray_axes a = {f->from, f->axis, f->across, f->normal};
    const double size = rule->spreads ? rule->spread_deg : rule->width;
    ray->offset = ray_axes_in_plane(&a, rule->spreads, size, i, rule->rays, origin, direction);
}

static status append_nodes(fan *f, const ray_tree *path, fan_ray *ray, diagnostic *why)
{
    const size_t wanted = f->node_count + path->count;
    if (wanted > f->node_capacity)
        TRY(memory_budget_check(2 * wanted * sizeof *f->node, "give fewer rays", why, "the fan"));
    if (!GROW(f->node, f->node_capacity, wanted))
        return diagnose(why, STATUS_FAILURE, "give fewer rays", "out of memory");
    memcpy(f->node + f->node_count, path->node, path->count * sizeof *path->node);
    ray->first = f->node_count;
    ray->count = path->count;
    f->node_count += path->count;
    return STATUS_OK;
}

static void cross_axis(const fan *f, fan_ray *ray)
{
    const vec3 from_axis = vec3_sub(ray->exit_point, f->from);
    const double off = vec3_dot(from_axis, f->across), slope = vec3_dot(ray->exit_direction, f->across);
    const double t = fabs(slope) > PARALLEL_RAD ? -off / slope : -1.0;
    ray->crosses_axis = t > 0.0 && t <= ray->reach;
    ray->axis_point = vec3_add(ray->exit_point, vec3_scale(ray->exit_direction, t));
    ray->axis_at = vec3_dot(vec3_sub(ray->axis_point, f->from), f->axis);
}

static void read_exit(const fan *f, fan_ray *ray)
{
    const ray_node *first = &f->node[ray->first], *last = first + ray->count - 1;
    ray->exit_point = last->origin;
    ray->exit_direction = last->direction;
    ray->weight = (last->throughput[0] + last->throughput[1] + last->throughput[2]) / 3.0;
    ray->leaves = last->end == RAY_END_SKY || last->end == RAY_END_HIT;
    ray->reach = last->end == RAY_END_HIT ? last->hit.t : HUGE_VAL;
    const vec3 turned = vec3_cross(first->direction, last->direction);
    ray->deviation_deg = elementary_atan2_deg(vec3_length(turned), vec3_dot(first->direction, last->direction));
    if (ray->leaves)
        cross_axis(f, ray);
}

/* True if two rays hit the same surfaces in the same order. */
static bool same_surfaces(const fan *f, const fan_ray *a, const fan_ray *b)
{
    if (a->count != b->count || !a->leaves || !b->leaves)
        return false;
    for (size_t k = 0; k < a->count; k++) {
        const ray_node *x = &f->node[a->first + k], *y = &f->node[b->first + k];
        const bool hits = x->end == RAY_END_HIT;
        if (x->kind != y->kind || x->end != y->end ||
            (hits && (x->hit.face_solid != y->hit.face_solid || x->hit.face != y->hit.face)))
            return false;
    }
    return true;
}

/* Intersects two lines in the fan's plane: p + t d = q + s e. */
static bool cross(const fan *f, const fan_ray *a, const fan_ray *b, vec3 *at)
{
    const vec3 between = vec3_sub(b->exit_point, a->exit_point);
    const double wx = vec3_dot(between, f->axis), wy = vec3_dot(between, f->across);
    const double dx = vec3_dot(a->exit_direction, f->axis), dy = vec3_dot(a->exit_direction, f->across);
    const double ex = vec3_dot(b->exit_direction, f->axis), ey = vec3_dot(b->exit_direction, f->across);
    const double turn = dx * ey - dy * ex;
    if (fabs(turn) < PARALLEL_RAD)
        return false;
    const double t = (wx * ey - wy * ex) / turn, s = (wx * dy - wy * dx) / turn;
    *at = vec3_add(a->exit_point, vec3_scale(a->exit_direction, t));
    return t > 0.0 && s > 0.0 && t <= a->reach && s <= b->reach;
}

static void find_crossings(fan *f)
{
    for (int i = 0; i + 1 < f->count && !cancel_asked(); i++) {
        vec3 at;
        if (same_surfaces(f, &f->ray[i], &f->ray[i + 1]) && f->ray[i].count > 1 &&
            cross(f, &f->ray[i], &f->ray[i + 1], &at))
            f->crossing[f->crossing_count++] = (fan_crossing){i, at};
    }
}

static bool is_bent(const fan_ray *ray)
{
    return ray->leaves && ray->count > 1;
}

/* The sum of the directions of the deflected rays, with the signs that make them point like the first one, since
 * opposite rays are parallel. Returns their number. */
static int sum_directions(const fan *f, const fan_ray **first, vec3 *sum)
{
    int count = 0;
    for (int i = 0; i < f->count; i++) {
        const fan_ray *ray = &f->ray[i];
        if (!is_bent(ray))
            continue;
        *first = count++ == 0 ? ray : *first;
        const double sense = vec3_dot(ray->exit_direction, (*first)->exit_direction) < 0.0 ? -1.0 : 1.0;
        *sum = vec3_add(*sum, vec3_scale(ray->exit_direction, sense));
    }
    return count;
}

/* The rows of an orthonormal frame whose first axis is u. */
static mat3 frame_along(vec3 u)
{
    const vec3 other = fabs(u.x) < 0.6 ? vec3_make(1, 0, 0) : vec3_make(0, 1, 0);
    const vec3 v = vec3_normalize(vec3_cross(u, other));
    return (mat3){{u, v, vec3_cross(u, v)}};
}

/* The normal equations sum (1 - d d^T) x = sum (1 - d d^T) p: a symmetric matrix and the right side. */
typedef struct normal_equations {
    double xx, yy, zz, xy, xz, yz;
    vec3 right;
} normal_equations;

/* With x along the rays' mean direction, xx is the sum of the squared angles from it, without cancellation: 1 - x^2
 * would lose angles below 1e-8 in rounding. */
static void add_line(normal_equations *e, vec3 d, vec3 p)
{
    const double xx = d.y * d.y + d.z * d.z, yy = d.x * d.x + d.z * d.z, zz = d.x * d.x + d.y * d.y;
    e->xx += xx, e->yy += yy, e->zz += zz;
    e->xy -= d.x * d.y, e->xz -= d.x * d.z, e->yz -= d.y * d.z;
    e->right =
        vec3_add(e->right, vec3_make(xx * p.x - d.x * (d.y * p.y + d.z * p.z), yy * p.y - d.y * (d.x * p.x + d.z * p.z),
                                     zz * p.z - d.z * (d.x * p.x + d.y * p.y)));
}

/* Eliminates y and z. Returns false if the rest of xx, a sum of squared angles of `count` lines, is within their
 * rounding: the lines are parallel. */
static bool solve(const normal_equations *e, int count, vec3 *out)
{
    const double det = e->yy * e->zz - e->yz * e->yz, of_y = (e->zz * e->xy - e->yz * e->xz) / det,
                 of_z = (e->yy * e->xz - e->yz * e->xy) / det, left = e->xx - of_y * e->xy - of_z * e->xz;
    if (!(left > count * (PARALLEL_RAD * PARALLEL_RAD)))
        return false;
    const double x = (e->right.x - of_y * e->right.y - of_z * e->right.z) / left, y = e->right.y - e->xy * x,
                 z = e->right.z - e->xz * x;
    *out = vec3_make(x, (e->zz * y - e->yz * z) / det, (e->yy * z - e->yz * y) / det);
    return true;
}

/* The point nearest to the lines of the deflected rays, relative to the first exit point to avoid cancellation. */
static bool nearest_point(const fan *f, int *count, vec3 *out)
{
    const fan_ray *first = NULL;
    vec3 sum = {0, 0, 0}, x;
    normal_equations e = {.right = {0, 0, 0}};
    *count = sum_directions(f, &first, &sum);
    if (*count < 2 || cancel_asked())
        return false;
    const mat3 frame = frame_along(vec3_normalize(sum));
    for (int i = 0; i < f->count; i++)
        if (is_bent(&f->ray[i]))
            add_line(&e, mat3_apply(frame, f->ray[i].exit_direction),
                     mat3_apply(frame, vec3_sub(f->ray[i].exit_point, first->exit_point)));
    if (!solve(&e, *count, &x))
        return false;
    *out = vec3_add(first->exit_point, mat3_apply_transposed(frame, x));
    return true;
}

static void find_focus(fan *f)
{
    int count;
    f->has_focus = nearest_point(f, &count, &f->focus);
    if (!f->has_focus)
        return;
    double squares = 0.0, ahead = 0.0;
    for (int i = 0; i < f->count; i++) {
        if (!is_bent(&f->ray[i]))
            continue;
        const vec3 to_focus = vec3_sub(f->focus, f->ray[i].exit_point);
        const double t = vec3_dot(to_focus, f->ray[i].exit_direction);
        const vec3 off = vec3_sub(to_focus, vec3_scale(f->ray[i].exit_direction, t));
        squares += vec3_dot(off, off);
        ahead += t;
    }
    f->focus_rms = sqrt(squares / count);
    f->is_virtual = ahead < 0.0;
}

static status check_rule(const fan_rule *rule, diagnostic *why)
{
    if (rule->rays < 1 || rule->rays > FAN_RAYS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "give 1 to 100000 rays", "the number of rays %d is out of range",
                        rule->rays);
    if (rule->spreads ? !(rule->spread_deg >= 0.0 && rule->spread_deg < 180.0)
                      : !(rule->width >= 0.0 && rule->width <= 1e6))
        return diagnose(why, STATUS_BAD_INPUT,
                        rule->spreads ? "give 0 to less than 180 degrees" : "give 0 to 1e6 scene units",
                        "the %s is out of range", rule->spreads ? "spread" : "width");
    return STATUS_OK;
}

static status follow_all(probe *p, const fan_rule *rule, fan *f, diagnostic *why)
{
    ray_tree path = {0};
    status result = STATUS_OK;
    for (int i = 0; i < f->count && result == STATUS_OK; i++) {
        vec3 origin, direction;
        start_of(f, rule, i, &f->ray[i], &origin, &direction);
        result = probe_path(p, origin, direction, -1, &path, why);
        THEN(result, append_nodes(f, &path, &f->ray[i], why));
        if (result == STATUS_OK)
            read_exit(f, &f->ray[i]);
    }
    ray_tree_release(&path);
    return result;
}

status fan_trace(probe *p, const fan_rule *rule, fan *out, diagnostic *why)
{
    fan_release(out);
    status result = check_rule(rule, why);
    THEN(result, set_axes(rule, out, why));
    if (result != STATUS_OK)
        return result;
    out->count = rule->rays;
    out->ray = calloc((size_t)rule->rays, sizeof *out->ray);
    out->crossing = calloc((size_t)rule->rays, sizeof *out->crossing);
    if (!out->ray || !out->crossing)
        return diagnose(why, STATUS_FAILURE, "give fewer rays", "out of memory");
    TRY(follow_all(p, rule, out, why));
    find_crossings(out);
    find_focus(out);
    return cancel_check(why);
}
