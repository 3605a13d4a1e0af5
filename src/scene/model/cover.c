/* Containment and separating axes of solids, by the support functions of their shapes (cover.h). */
#include "scene/model/cover.h"
#include "geometry/shapes/shape.h"
#include "scene/model/camera.h"
#include "scene/model/scene.h"

#include <math.h>

bool scene_has_precedence(const solid *winner, const solid *loser)
{
    return winner != loser && winner->visible &&
           (winner->priority > loser->priority || (winner->priority == loser->priority && winner < loser));
}

static placed_shape place_shape(const scene *s, const solid *owner)
{
    const solid_shape shape = scene_loaded_shape(s, owner);
    return shape_placed(&shape);
}

/* Whether the solid is at points that are not loaded, so that its place is unknown. */
static bool is_placeless(const scene *s, const solid *owner)
{
    const mesh_entry *points = scene_points_of(s, owner);
    return points && !points->data;
}

/* The radius of a ball about a shape's position that contains it, however it is turned. */
static double reach_of(const solid_shape *shape)
{
    const shape_rule *rule = shape_of(shape);
    if (!rule->extent || (rule->triangles && !shape->mesh))
        return (double)INFINITY;
    const shape_extent e = shape_has_scale(shape) ? shape_extent_of(shape) : rule->extent(shape);
    return 0.5 * vec3_length(vec3_add(e.box.low, e.box.high)) + e.ball;
}

/* Whether their balls are apart, which is quickly seen of most pairs. reach: of b. */
static bool balls_are_apart(const solid_shape *a, const solid_shape *b, double reach)
{
    const double both = 1.000001 * (reach_of(a) + reach);
    const vec3 between = vec3_sub(a->position, b->position);
    return vec3_dot(between, between) > both * both;
}

const solid *scene_cover(const scene *s, const solid *hidden)
{
    if (s->solid_count > COVER_SOLIDS_MAX || hidden->points[0])
        return NULL;
    const placed_shape h = place_shape(s, hidden);
    const double reach = reach_of(&h.shape);
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *cover = &s->solids[i];
        const shape_rule *rule = shape_of(&cover->shape);
        if (rule->covers && !cover->points[0] && scene_has_precedence(cover, hidden) &&
            !balls_are_apart(&cover->shape, &h.shape, reach)) {
            const placed_shape c = place_shape(s, cover);
            if (!shape_is_scaled(&c.shape) && rule->covers(&c, &h))
                return cover;
        }
    }
    return NULL;
}

static bool apart_along(const placed_shape *a, const placed_shape *b, vec3 d)
{
    const vec3 back = vec3_scale(d, -1.0);
    return placed_limit(a, d) <= -placed_limit(b, back) || placed_limit(b, d) <= -placed_limit(a, back);
}

static bool are_apart(const placed_shape *a, const placed_shape *b)
{
    bool apart = false;
    for (int k = 0; k < 3 && !apart; k++)
        apart = apart_along(a, b, vec3_make(k == 0, k == 1, k == 2)) || apart_along(a, b, placed_axis(&a->turn, k)) ||
                apart_along(a, b, placed_axis(&b->turn, k));
    const vec3 between = vec3_sub(b->shape.position, a->shape.position), level = vec3_make(between.x, 0.0, between.z);
    return apart || (vec3_length(between) > 0.0 && apart_along(a, b, vec3_normalize(between))) ||
           (vec3_length(level) > 0.0 && apart_along(a, b, vec3_normalize(level)));
}

bool scene_disjoint(const scene *s, const solid *a, const solid *b)
{
    const placed_shape one = place_shape(s, a), two = place_shape(s, b);
    return !is_placeless(s, a) && !is_placeless(s, b) && are_apart(&one, &two);
}

/* The maximum of direction . p over a rectangle that contains the origins of all camera rays. */
static double starts_limit(const camera_frame *view, vec3 direction)
{
    const double across = (view->parallel ? view->half_width : 0.0) + view->lens_radius,
                 upward = (view->parallel ? view->half_height : 0.0) + view->lens_radius;
    return vec3_dot(direction, view->eye) + across * fabs(vec3_dot(direction, view->right)) +
           upward * fabs(vec3_dot(direction, view->up));
}

static bool starts_apart_along(const placed_shape *a, const camera_frame *view, vec3 d)
{
    const vec3 back = vec3_scale(d, -1.0);
    return placed_limit(a, d) <= -starts_limit(view, back) || starts_limit(view, d) <= -placed_limit(a, back);
}

static bool starts_are_apart(const placed_shape *a, const camera_frame *view)
{
    const vec3 between = vec3_sub(view->eye, a->shape.position);
    bool apart = starts_apart_along(a, view, view->forward) || starts_apart_along(a, view, view->right) ||
                 starts_apart_along(a, view, view->up);
    for (int k = 0; k < 3 && !apart; k++)
        apart = starts_apart_along(a, view, vec3_make(k == 0, k == 1, k == 2)) ||
                starts_apart_along(a, view, placed_axis(&a->turn, k));
    return apart || (vec3_length(between) > 0.0 && starts_apart_along(a, view, vec3_normalize(between)));
}

bool scene_apart_from_eye(const scene *s, const solid *owner)
{
    const camera_frame view = camera_frame_of(s);
    const placed_shape one = place_shape(s, owner);
    if (is_placeless(s, owner))
        return false;
    if (view.parallel || view.lens_radius > 0.0)
        return starts_are_apart(&one, &view);
    const solid_shape point = shape_point(view.eye);
    const placed_shape eye = shape_placed(&point);
    return are_apart(&one, &eye);
}

bool scene_is_behind_camera(const scene *s, const solid *owner)
{
    const camera_frame view = camera_frame_of(s);
    const placed_shape h = place_shape(s, owner);
    return !is_placeless(s, owner) && placed_limit(&h, view.forward) < vec3_dot(view.forward, view.eye);
}
