#include "scene/model/place/spot.h"
#include "scene/model/camera.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* A floor's normal is steeper than this. */
static const double FLOOR_Y = 0.9;

double spot_round(double value, double size)
{
    char text[512];
    const double digits = 2.0 - floor(log10(size > 0.0 ? size : 1.0));
    snprintf(text, sizeof text, "%.*f", digits < 0.0 ? 0 : digits > 100.0 ? 100 : (int)digits, value);
    return strtod(text, NULL) + 0.0;
}

bool spot_ground(const scene *s, double x, double z, double *y)
{
    bool found = false;
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid_shape *shape = &s->solids[i].shape;
        if (shape->kind != SHAPE_PLANE || !s->solids[i].visible)
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

/* Of a mesh's bounds, all copies together, in the solid's frame. */
static bounds3 mesh_box(const scene *s, const solid *of)
{
    const solid_shape *shape = &of->shape;
    const mesh_entry *m = scene_find_mesh(s, of->mesh);
    const double r = m && m->source == MESH_SLIME ? m->slime.radius : 1.0;
    const vec3 at = m && m->source == MESH_SLIME ? m->slime.position : vec3_make(0, 0, 0);
    bounds3 b = {vec3_make(at.x - r, at.y - r, at.z - r), vec3_make(at.x + r, at.y + r, at.z + r)};
    if (m && m->data && m->data->triangle_count)
        b = m->data->bounds;
    const vec3 more = vec3_make((shape->copies.x - 1) * shape->spacing.x, (shape->copies.y - 1) * shape->spacing.y,
                                (shape->copies.z - 1) * shape->spacing.z);
    b.low = vec3_make(b.low.x * shape->scale.x + fmin(more.x, 0), b.low.y * shape->scale.y + fmin(more.y, 0),
                      b.low.z * shape->scale.z + fmin(more.z, 0));
    b.high = vec3_make(b.high.x * shape->scale.x + fmax(more.x, 0), b.high.y * shape->scale.y + fmax(more.y, 0),
                       b.high.z * shape->scale.z + fmax(more.z, 0));
    return b;
}

bool spot_ball(const scene *s, const solid *of, vec3 *centre, double *radius)
{
    const solid_shape *shape = &of->shape;
    vec3 middle = vec3_make(0, 0, 0);
    switch (shape->kind) {
    case SHAPE_CYLINDER:
    case SHAPE_CUP:
        middle.y = 0.5 * shape->height;
        *radius = hypot(shape->radius / fmin(shape->m, 1.0), middle.y);
        break;
    case SHAPE_BOX: *radius = 0.5 * vec3_length(shape->size); break;
    case SHAPE_SPHERE: *radius = shape->radius; break;
    case SHAPE_MESH: {
        const bounds3 b = mesh_box(s, of);
        middle = vec3_scale(vec3_add(b.low, b.high), 0.5);
        *radius = 0.5 * vec3_length(vec3_sub(b.high, b.low));
        break;
    }
    case SHAPE_PLANE:
    case SHAPE_COUNT: return false;
    }
    *centre = vec3_add(shape->position, mat3_apply(rotation_from_deg(shape->rotation_deg), middle));
    return true;
}

double spot_half_size(const scene *s, const solid *of, vec3 along)
{
    const solid_shape *shape = &of->shape;
    const mat3 turn = rotation_from_deg(shape->rotation_deg);
    const double x = fabs(vec3_dot(along, mat3_apply(turn, vec3_make(1, 0, 0)))),
                 y = fabs(vec3_dot(along, mat3_apply(turn, vec3_make(0, 1, 0)))),
                 z = fabs(vec3_dot(along, mat3_apply(turn, vec3_make(0, 0, 1))));
    vec3 size = shape->size;
    switch (shape->kind) {
    case SHAPE_CYLINDER:
    case SHAPE_CUP: return 0.5 * y * shape->height + hypot(x, z) * shape->radius / fmin(shape->m, 1.0);
    case SHAPE_SPHERE: return shape->radius;
    case SHAPE_MESH: {
        const bounds3 b = mesh_box(s, of);
        size = vec3_sub(b.high, b.low);
        break;
    }
    case SHAPE_BOX: break;
    case SHAPE_PLANE:
    case SHAPE_COUNT: return 0.0;
    }
    return 0.5 * (x * fabs(size.x) + y * fabs(size.y) + z * fabs(size.z));
}

/* How far away is what the camera looks at that is not aimed at a point? */
static double distance_ahead(const scene *s, vec3 eye, vec3 forward)
{
    double nearest = INFINITY, y;
    for (size_t i = 0; i < s->solid_count; i++) {
        vec3 centre;
        double radius;
        if (!s->solids[i].visible || !spot_ball(s, &s->solids[i], &centre, &radius))
            continue;
        const vec3 way = vec3_sub(centre, eye);
        const double along = vec3_dot(way, forward);
        if (along > 0.0 && vec3_length(vec3_sub(way, vec3_scale(forward, along))) < radius)
            nearest = fmin(nearest, along);
    }
    if (spot_ground(s, eye.x, eye.z, &y) && forward.y < 0.0)
        nearest = fmin(nearest, (y - eye.y) / forward.y);
    return isfinite(nearest) && nearest > 0.0 ? nearest : 6.0;
}

spot spot_of(const scene *s)
{
    const camera_frame view = camera_frame_level(s);
    spot where = {.looked_at = s->camera.target, .right = vec3_make(1, 0, 0), .away = vec3_make(0, 0, 1)};
    if (!s->camera.aimed)
        where.looked_at = vec3_add(view.eye, vec3_scale(view.forward, distance_ahead(s, view.eye, view.forward)));
    where.distance = vec3_length(vec3_sub(where.looked_at, view.eye));
    where.size = spot_round(where.distance / 6.0, where.distance / 6.0);
    const vec3 flat = vec3_make(view.right.x, 0, view.right.z);
    if (vec3_length(flat) > 1e-9) {
        where.right = vec3_normalize(flat);
        where.away = vec3_make(-where.right.z, 0, where.right.x);
    }
    return where;
}

double spot_overlap(const scene *s, vec3 centre, double radius)
{
    double sum = 0.0;
    for (size_t i = 0; i < s->solid_count; i++) {
        vec3 other;
        double its_radius = 0.0;
        if (s->solids[i].visible && spot_ball(s, &s->solids[i], &other, &its_radius))
            sum += fmax(0.0, radius + its_radius - vec3_length(vec3_sub(other, centre)));
    }
    return sum;
}

static bool is_in_view(const camera_frame *view, vec3 point)
{
    const vec3 way = vec3_sub(point, view->eye);
    const double depth = vec3_dot(way, view->forward);
    return depth > 0.0 && fabs(vec3_dot(way, view->right)) < view->half_width * depth &&
           fabs(vec3_dot(way, view->up)) < view->half_height * depth;
}

bool spot_in_view(const scene *s, vec3 point)
{
    const camera_frame view = camera_frame_of(s);
    return is_in_view(&view, point);
}

vec3 spot_free(const scene *s, const spot *where, double size)
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
        at.x = spot_round(at.x, size);
        at.z = spot_round(at.z, size);
        const double in_the_air = spot_round(at.y - 0.5 * size, size);
        if (!spot_ground(s, at.x, at.z, &at.y) || !is_in_view(&view, vec3_add(at, half_up)))
            at.y = in_the_air;
        const vec3 centre = vec3_add(at, half_up);
        const double deep = spot_overlap(s, centre, 0.5 * size) + (is_in_view(&view, centre) ? 0.0 : size);
        if (deep < least) {
            least = deep;
            best = at;
        }
    }
    return best;
}
