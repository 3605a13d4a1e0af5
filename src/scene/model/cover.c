#include "scene/model/cover.h"
#include "scene/model/camera.h"
#include "scene/model/scene.h"

#include <math.h>

#define COVER_SLACK 1e-12 /* share of a length: rounding of what is equal */

typedef struct covered {
    const solid_shape *shape;
    const mesh *triangles; /* of a mesh; NULL until it is loaded */
    mat3 turn;
} covered;

static vec3 axis_of(const mat3 *turn, int k)
{
    return vec3_make(k == 0   ? turn->row[0].x
                     : k == 1 ? turn->row[0].y
                              : turn->row[0].z,
                     k == 0   ? turn->row[1].x
                     : k == 1 ? turn->row[1].y
                              : turn->row[1].z,
                     k == 0   ? turn->row[2].x
                     : k == 1 ? turn->row[2].y
                              : turn->row[2].z);
}

/* The most that visit gives of points whose convex hull is the box or the mesh with all copies. */
typedef double point_measure(const void *context, vec3 point);

static double most_of_box(const covered *h, point_measure *measure, const void *context)
{
    double most = -INFINITY;
    for (int i = 0; i < 8; i++) {
        const vec3 half = vec3_scale(h->shape->size, 0.5);
        const vec3 corner = vec3_make(i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z);
        most = fmax(most, measure(context, vec3_add(h->shape->position, mat3_apply(h->turn, corner))));
    }
    return most;
}

static double most_of_mesh(const covered *h, point_measure *measure, const void *context)
{
    const solid_shape *s = h->shape;
    double most = h->triangles ? -INFINITY : INFINITY;
    for (int i = 0; i < 8 && h->triangles; i++) {
        const vec3 n = vec3_make(i & 1 ? s->copies.x - 1.0 : 0.0, i & 2 ? s->copies.y - 1.0 : 0.0,
                                 i & 4 ? s->copies.z - 1.0 : 0.0);
        const vec3 offset = vec3_make(n.x * s->spacing.x, n.y * s->spacing.y, n.z * s->spacing.z);
        if ((i & 1 && s->copies.x == 1.0) || (i & 2 && s->copies.y == 1.0) || (i & 4 && s->copies.z == 1.0))
            continue;
        for (size_t k = 0; k < h->triangles->vertex_count; k++) {
            const vec3 v = h->triangles->vertices[k];
            const vec3 local = vec3_add(vec3_make(v.x * s->scale.x, v.y * s->scale.y, v.z * s->scale.z), offset);
            most = fmax(most, measure(context, vec3_add(s->position, mat3_apply(h->turn, local))));
        }
    }
    return most;
}

static double along(const void *context, vec3 point)
{
    return vec3_dot(*(const vec3 *)context, point);
}

/* The most of direction . p over all points p of the solid. */
static double farthest_along(const covered *h, vec3 direction)
{
    const solid_shape *s = h->shape;
    const vec3 d = mat3_apply_transposed(h->turn, direction);
    const double middle = vec3_dot(direction, s->position);
    switch (s->kind) {
    case SHAPE_SPHERE: return middle + s->radius;
    case SHAPE_CUP:
    case SHAPE_CYLINDER: return middle + fmax(0.0, s->height * d.y) + s->radius * hypot(d.x, d.z / s->m);
    case SHAPE_BOX: return most_of_box(h, along, &direction);
    case SHAPE_MESH: return most_of_mesh(h, along, &direction);
    case SHAPE_PLANE:
    case SHAPE_COUNT: break;
    }
    return INFINITY;
}

/* A round solid: its frame, and by how much its z counts. A sphere's y counts, too. */
typedef struct round_frame {
    vec3 origin;
    mat3 turn;
    double m;
    bool sphere;
} round_frame;

static double distance_in(const void *context, vec3 point)
{
    const round_frame *f = context;
    const vec3 p = mat3_apply_transposed(f->turn, vec3_sub(point, f->origin));
    return f->sphere ? vec3_length(p) : hypot(p.x, f->m * p.z);
}

/* A cylinder's or cup's: exact around a sphere if it is round, and in a cylinder if it is round and stands along it;
 * else too far rather than too near. */
static double farthest_of_cylinder(const covered *h, const round_frame *f)
{
    const solid_shape *s = h->shape;
    const double wide = s->radius * fmax(1.0, 1.0 / s->m);
    if (f->sphere) {
        const vec3 p = mat3_apply_transposed(h->turn, vec3_sub(f->origin, s->position));
        return hypot(hypot(p.x, p.z) + wide, fmax(fabs(p.y), fabs(p.y - s->height)));
    }
    const vec3 top = vec3_add(s->position, vec3_scale(axis_of(&h->turn, 1), s->height));
    return fmax(distance_in(f, s->position), distance_in(f, top)) + wide * fmax(1.0, f->m);
}

static double farthest_from(const covered *h, const round_frame *f)
{
    switch (h->shape->kind) {
    case SHAPE_SPHERE:
        return distance_in(f, h->shape->position) + h->shape->radius * (f->sphere ? 1.0 : fmax(1.0, f->m));
    case SHAPE_CYLINDER:
    case SHAPE_CUP: return farthest_of_cylinder(h, f);
    case SHAPE_BOX: return most_of_box(h, distance_in, f);
    case SHAPE_MESH: return most_of_mesh(h, distance_in, f);
    case SHAPE_PLANE:
    case SHAPE_COUNT: break;
    }
    return INFINITY;
}

static bool is_within(double reach, double limit, double length)
{
    return reach <= limit + COVER_SLACK * length;
}

/* Between low and high along the cover's axis k. */
static bool is_between(const covered *h, const solid_shape *cover, const mat3 *turn, int k, double low, double high)
{
    const vec3 up = axis_of(turn, k);
    const double from = vec3_dot(up, cover->position), length = high - low + fabs(from);
    return is_within(farthest_along(h, up), from + high, length) &&
           is_within(farthest_along(h, vec3_scale(up, -1.0)), -from - low, length);
}

/* Clear of the cup's hollow: below its floor, or to one side of it. */
static bool avoids_hollow(const covered *h, const solid_shape *cup, const mat3 *turn)
{
    const vec3 up = axis_of(turn, 1);
    if (is_within(farthest_along(h, up), vec3_dot(up, cup->position) + cup->floor, cup->height))
        return true;
    const vec3 local = mat3_apply_transposed(*turn, vec3_sub(h->shape->position, cup->position));
    const double r = hypot(local.x, local.z);
    if (r == 0.0)
        return false;
    const vec3 out = mat3_apply(*turn, vec3_make(local.x / r, 0.0, local.z / r));
    const double hollow = cup->inner_radius * hypot(local.x / r, local.z / (r * cup->m));
    return is_within(farthest_along(h, vec3_scale(out, -1.0)), -vec3_dot(out, cup->position) - hollow, cup->radius);
}

static bool contains_all(const solid_shape *c, const covered *h)
{
    const mat3 turn = rotation_from_deg(c->rotation_deg);
    const round_frame frame = {c->position, turn, c->kind == SHAPE_CYLINDER || c->kind == SHAPE_CUP ? c->m : 1.0,
                               c->kind == SHAPE_SPHERE};
    switch (c->kind) {
    case SHAPE_PLANE: {
        const vec3 up = axis_of(&turn, 1);
        return farthest_along(h, up) <= vec3_dot(up, c->position);
    }
    case SHAPE_SPHERE: return is_within(farthest_from(h, &frame), c->radius, c->radius);
    case SHAPE_BOX:
        return is_between(h, c, &turn, 0, -0.5 * c->size.x, 0.5 * c->size.x) &&
               is_between(h, c, &turn, 1, -0.5 * c->size.y, 0.5 * c->size.y) &&
               is_between(h, c, &turn, 2, -0.5 * c->size.z, 0.5 * c->size.z);
    case SHAPE_CYLINDER:
    case SHAPE_CUP:
        return is_between(h, c, &turn, 1, 0.0, c->height) &&
               is_within(farthest_from(h, &frame), c->radius, c->radius) &&
               (c->kind == SHAPE_CYLINDER || avoids_hollow(h, c, &turn));
    case SHAPE_MESH:
    case SHAPE_COUNT: break;
    }
    return false;
}

bool scene_wins(const solid *winner, const solid *loser)
{
    return winner != loser && winner->visible &&
           (winner->priority > loser->priority || (winner->priority == loser->priority && winner < loser));
}

static covered measured(const scene *s, const solid *owner)
{
    const mesh_entry *entry = owner->shape.kind == SHAPE_MESH ? scene_find_mesh(s, owner->mesh) : NULL;
    return (covered){&owner->shape, entry ? entry->data : NULL, rotation_from_deg(owner->shape.rotation_deg)};
}

const solid *scene_cover(const scene *s, const solid *hidden)
{
    const covered h = measured(s, hidden);
    for (size_t i = 0; i < s->solid_count; i++)
        if (scene_wins(&s->solids[i], hidden) && contains_all(&s->solids[i].shape, &h))
            return &s->solids[i];
    return NULL;
}

/* The most of direction . p, of a plane along its own normal too. */
static double limit_along(const covered *h, vec3 direction)
{
    if (h->shape->kind != SHAPE_PLANE)
        return farthest_along(h, direction);
    const vec3 up = axis_of(&h->turn, 1);
    return vec3_dot(up, direction) >= 1.0 - COVER_SLACK ? vec3_dot(direction, h->shape->position) : INFINITY;
}

static bool apart_along(const covered *a, const covered *b, vec3 d)
{
    const vec3 back = vec3_scale(d, -1.0);
    return limit_along(a, d) <= -limit_along(b, back) || limit_along(b, d) <= -limit_along(a, back);
}

bool scene_apart(const scene *s, const solid *a, const solid *b)
{
    const covered one = measured(s, a), two = measured(s, b);
    bool apart = false;
    for (int k = 0; k < 3 && !apart; k++)
        apart = apart_along(&one, &two, vec3_make(k == 0, k == 1, k == 2)) ||
                apart_along(&one, &two, axis_of(&one.turn, k)) || apart_along(&one, &two, axis_of(&two.turn, k));
    const vec3 between = vec3_sub(b->shape.position, a->shape.position), level = vec3_make(between.x, 0.0, between.z);
    return apart || (vec3_length(between) > 0.0 && apart_along(&one, &two, vec3_normalize(between))) ||
           (vec3_length(level) > 0.0 && apart_along(&one, &two, vec3_normalize(level)));
}

bool scene_is_behind_camera(const scene *s, const solid *owner)
{
    const camera_frame view = camera_frame_of(s);
    const covered h = measured(s, owner);
    return limit_along(&h, view.forward) < vec3_dot(view.forward, view.eye);
}
