/* Following the rays of a fan; crossings by plane geometry, the focus by least squares. */
#include "render/inspect/fan.h"

#include "base/cancel.h"
#include "base/elementary.h"
#include "base/grow.h"
#include "base/memory_budget.h"
#include "render/inspect/ray_axes.h"
#include <stdlib.h>
#include <string.h>

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
    /* A smaller slope is rounding noise of a ray parallel to the axis. */
    const double t = fabs(slope) > 1e-12 ? -off / slope : -1.0;
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
static bool same_direction(const fan *f, const fan_ray *a, const fan_ray *b)
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
    if (fabs(turn) < 1e-12) /* parallel up to rounding */
        return false;
    const double t = (wx * ey - wy * ex) / turn, s = (wx * dy - wy * dx) / turn;
    *at = vec3_add(a->exit_point, vec3_scale(a->exit_direction, t));
    return t > 0.0 && s > 0.0 && t <= a->reach && s <= b->reach;
}

static void find_crossings(fan *f)
{
    for (int i = 0; i + 1 < f->count && !cancel_asked(); i++) {
        vec3 at;
        if (same_direction(f, &f->ray[i], &f->ray[i + 1]) && f->ray[i].count > 1 &&
            cross(f, &f->ray[i], &f->ray[i + 1], &at))
            f->crossing[f->crossing_count++] = (fan_crossing){i, at};
    }
}

static bool is_bent(const fan_ray *ray)
{
    return ray->leaves && ray->count > 1;
}

/* Solves sum (1 - d d^T) x = sum (1 - d d^T) p by Cramer's rule, with p relative to the first exit point to avoid
 * cancellation. */
static void find_focus(fan *f)
{
    vec3 row[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, right = {0, 0, 0}, base = {0, 0, 0};
    int count = 0;
    for (int i = 0; i < f->count && !cancel_asked(); i++) {
        if (!is_bent(&f->ray[i]))
            continue;
        if (count++ == 0)
            base = f->ray[i].exit_point;
        const vec3 d = f->ray[i].exit_direction, p = vec3_sub(f->ray[i].exit_point, base);
        row[0] = vec3_add(row[0], vec3_sub(vec3_make(1, 0, 0), vec3_scale(d, d.x)));
        row[1] = vec3_add(row[1], vec3_sub(vec3_make(0, 1, 0), vec3_scale(d, d.y)));
        row[2] = vec3_add(row[2], vec3_sub(vec3_make(0, 0, 1), vec3_scale(d, d.z)));
        right = vec3_add(right, vec3_sub(p, vec3_scale(d, vec3_dot(d, p))));
    }
    const double size = (double)count * count * count, det = vec3_dot(row[0], vec3_cross(row[1], row[2]));
    /* det / count^3 is of the order of the squared angle between the rays, here 1e-8 rad. */
    if (count < 2 || det < 1e-16 * size)
        return;
    const vec3 x = vec3_scale(vec3_add(vec3_scale(vec3_cross(row[1], row[2]), right.x),
                                       vec3_add(vec3_scale(vec3_cross(row[2], row[0]), right.y),
                                                vec3_scale(vec3_cross(row[0], row[1]), right.z))),
                              1.0 / det);
    f->focus = vec3_add(base, x);
    f->has_focus = true;
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

status fan_follow(probe *p, const fan_rule *rule, fan *out, diagnostic *why)
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
