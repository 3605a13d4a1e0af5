/* Finds a free place in view for a new object (placement.h). */
#include "scene/model/place/placement.h"
#include "geometry/shapes/shape.h"
#include "scene/model/camera.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Minimum y of the normal of a floor. */
static const double FLOOR_Y = 0.9;

double placement_round(double value, double size)
{
    char text[512];
    const double digits = 2.0 - floor(log10(size > 0.0 ? size : 1.0));
    snprintf(text, sizeof text, "%.*f", digits < 0.0 ? 0 : digits > 100.0 ? 100 : (int)digits, value);
    return strtod(text, NULL) + 0.0;
}

bool placement_ground(const scene *s, double x, double z, double *y)
{
    bool found = false;
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid_shape *shape = &s->solids[i].shape;
        if (!shape_of(shape)->unbounded || !s->solids[i].visible)
            continue;
        const vec3 up = mat3_apply(rotation_from_deg(shape->rotation_deg), vec3_make(0, 1, 0));
        if (up.y < FLOOR_Y)
            continue;
        const double height =
            shape->position.y - (up.x * (x - shape->position.x) + up.z * (z - shape->position.z)) / up.y;
        if (height < s->camera.position.y && (!found || height > *y)) {
            *y = height;
            found = true;
        }
    }
    return found;
}

/* The solid's shape with a mesh that has bounds. A mesh that is not loaded is assumed to be a slime's ball, or a ball
 * of radius 1 about the origin. */
static solid_shape with_bounds(const scene *s, const solid *of, mesh *guess)
{
    solid_shape shape = scene_loaded_shape(s, of);
    if (!shape.mesh || !shape.mesh->triangle_count) {
        const mesh_entry *m = scene_mesh_of(s, of);
        const bool slime = m && m->source == MESH_SLIME;
        const double r = slime ? m->slime.radius : 1.0;
        const vec3 at = slime ? m->slime.position : vec3_make(0, 0, 0), half = vec3_make(r, r, r);
        guess->bounds = (bounds3){vec3_sub(at, half), vec3_add(at, half)};
        shape.mesh = guess;
    }
    return shape;
}

bool placement_bounding_sphere(const scene *s, const solid *of, vec3 *centre, double *radius)
{
    mesh guess;
    const solid_shape shape = with_bounds(s, of, &guess);
    if (shape_of(&shape)->unbounded)
        return false;
    const shape_extent e = shape_extent_of(&shape);
    vec3 middle = vec3_scale(vec3_add(e.box.low, e.box.high), 0.5);
    *radius = e.ball;
    if (shape.points) {
        const bounds3 b = shape.points->bounds;
        const vec3 k = shape.scale, of_points = vec3_scale(vec3_add(b.low, b.high), 0.5),
                   half = vec3_scale(vec3_sub(b.high, b.low), 0.5);
        middle = vec3_add(middle, vec3_make(k.x * of_points.x, k.y * of_points.y, k.z * of_points.z));
        *radius += vec3_length(vec3_make(k.x * half.x, k.y * half.y, k.z * half.z));
    }
    *centre = vec3_add(shape.position, mat3_apply(rotation_from_deg(shape.rotation_deg), middle));
    return true;
}

double placement_half_size(const scene *s, const solid *of, vec3 along)
{
    mesh guess;
    const solid_shape shape = with_bounds(s, of, &guess);
    const vec3 d = mat3_apply_transposed(rotation_from_deg(shape.rotation_deg), along);
    return shape_of(&shape)->unbounded ? 0.0
                                       : 0.5 * (shape_reach(&shape, d) + shape_reach(&shape, vec3_scale(d, -1.0)));
}

/* The distance that is assumed between the camera and what it looks at, if it has no target. */
static double distance_ahead(const scene *s, vec3 eye, vec3 forward)
{
    double nearest = INFINITY, y;
    for (size_t i = 0; i < s->solid_count; i++) {
        vec3 centre;
        double radius;
        if (!s->solids[i].visible || !placement_bounding_sphere(s, &s->solids[i], &centre, &radius))
            continue;
        const vec3 offset = vec3_sub(centre, eye);
        const double along = vec3_dot(offset, forward);
        if (along > 0.0 && vec3_length(vec3_sub(offset, vec3_scale(forward, along))) < radius)
            nearest = fmin(nearest, along);
    }
    if (placement_ground(s, eye.x, eye.z, &y) && forward.y < 0.0)
        nearest = fmin(nearest, (y - eye.y) / forward.y);
    return isfinite(nearest) && nearest > 0.0 ? nearest : 6.0;
}

placement placement_of(const scene *s)
{
    const camera_frame view = camera_frame_level(s);
    placement where = {.looked_at = s->camera.target, .right = vec3_make(1, 0, 0), .away = vec3_make(0, 0, 1)};
    if (!s->camera.aimed)
        where.looked_at = vec3_add(view.eye, vec3_scale(view.forward, distance_ahead(s, view.eye, view.forward)));
    where.distance = vec3_length(vec3_sub(where.looked_at, view.eye));
    const double size = view.parallel ? 2.0 * view.half_height / 5.0 : where.distance / 6.0;
    where.size = placement_round(size, size);
    const vec3 flat = vec3_make(view.right.x, 0, view.right.z);
    if (vec3_length(flat) > 1e-9) {
        where.right = vec3_normalize(flat);
        where.away = vec3_make(-where.right.z, 0, where.right.x);
    }
    return where;
}

/* The total depth of overlap between a ball and the bounding balls of all visible solids; 0 if the ball is free. */
static double overlap(const scene *s, vec3 centre, double radius)
{
    double sum = 0.0;
    for (size_t i = 0; i < s->solid_count; i++) {
        vec3 other;
        double other_radius = 0.0;
        if (s->solids[i].visible && placement_bounding_sphere(s, &s->solids[i], &other, &other_radius))
            sum += fmax(0.0, radius + other_radius - vec3_length(vec3_sub(other, centre)));
    }
    return sum;
}

static bool is_in_view(const camera_frame *view, vec3 point)
{
    const vec3 offset = vec3_sub(point, view->eye);
    const double depth = vec3_dot(offset, view->forward), spread = camera_spread(view, depth);
    return depth > 0.0 && fabs(vec3_dot(offset, view->right)) < view->half_width * spread &&
           fabs(vec3_dot(offset, view->up)) < view->half_height * spread;
}

bool placement_in_view(const scene *s, vec3 point)
{
    const camera_frame view = camera_frame_of(s);
    return is_in_view(&view, point);
}

vec3 placement_free(const scene *s, const placement *where, double size)
{
    static const double steps[][2] = {{0, 0},   {1, 0}, {-1, 0}, {0, 1}, {1, 1},  {-1, 1}, {0, -1}, {1, -1},
                                      {-1, -1}, {2, 0}, {-2, 0}, {2, 1}, {-2, 1}, {0, 2},  {1, 2},  {-1, 2}};
    const camera_frame view = camera_frame_of(s);
    const vec3 half_up = vec3_make(0, 0.5 * size, 0);
    vec3 best = where->looked_at;
    double least = INFINITY;
    for (size_t i = 0; i < sizeof steps / sizeof *steps && least > 0.0; i++) {
        const vec3 step = vec3_add(vec3_scale(where->right, 1.25 * size * steps[i][0]),
                                   vec3_scale(where->away, 1.25 * size * steps[i][1]));
        vec3 at = vec3_add(where->looked_at, step);
        at.x = placement_round(at.x, size);
        at.z = placement_round(at.z, size);
        const double in_the_air = placement_round(at.y - 0.5 * size, size);
        if (!placement_ground(s, at.x, at.z, &at.y) || !is_in_view(&view, vec3_add(at, half_up)))
            at.y = in_the_air;
        const vec3 centre = vec3_add(at, half_up);
        const double deep = overlap(s, centre, 0.5 * size) + (is_in_view(&view, centre) ? 0.0 : size);
        if (deep < least) {
            least = deep;
            best = at;
        }
    }
    return best;
}
