/* Rays among all copies of all meshes. Each copy is asked in its own frame, where distances along the ray are the same, because
 * the direction is not made a unit vector there. */
#include "base/kernel.h"
#include "base/lanes.h"
#include "geometry/forest.h"

#define TREES KERNEL(hierarchy_kernels)

struct last_crossing;

/* What one way down asks each copy that it comes by. */
typedef struct quest {
    const forest *f;
    const forest_ray *ray;
    enum quest_kind { NEXT, ANY, LAST } kind; /* the next crossing that matters; anything at all; the last crossing of each mesh */
    bool blocked;
    double t_max;
    forest_hit *best;        /* NEXT */
    struct last_crossing *last; /* LAST: by part */
} quest;

static vec3 direction_in(const forest_part *p, vec3 d)
{
    const vec3 turned = p->turned ? mat3_apply_transposed(p->rotation, d) : d;
    return p->scaled ? vec3_make(turned.x / p->scale.x, turned.y / p->scale.y, turned.z / p->scale.z) : turned;
}

/* A ray that starts on a skin may lie on either side of it by rounding, and of another triangle at the same place: it begins beyond its
 * point's error bound. */
static double beyond_skin(const forest_part *p, uint32_t copy, const forest_ray *ray)
{
    const mesh_triangle tri = p->triangles->triangles[mesh_face_triangle(ray->start)];
    const vec3 a = forest_vertex_point(p, copy, tri.corner[0]), b = forest_vertex_point(p, copy, tri.corner[1]),
               c = forest_vertex_point(p, copy, tri.corner[2]);
    const vec3 n = vec3_cross(vec3_sub(b, a), vec3_sub(c, a)), d = ray->direction, o = ray->origin;
    const double across = fabs(vec3_dot(n, d)), length = vec3_length(n);
    const double error = 0x1p-48 * (fabs(o.x) + fabs(o.y) + fabs(o.z) + p->reach) * length;
    const double least = 1e-6 * length * vec3_length(d);
    return error / greater(across, least);
}

/* The ray in a copy's frame; false where that mesh is of no concern to it. */
static bool ray_in(const quest *q, const forest_part *p, uint32_t copy, mesh_ray *local)
{
    const forest_ray *ray = q->ray;
    const uint64_t bit = (uint64_t)1 << p->primitive;
    const bool within = (ray->inside & bit) != 0;
    if (!(ray->wanted & bit) || (q->kind == NEXT && (p->closed && within ? p->rank < ray->before : p->rank <= ray->before)))
        return false;
    const vec3 moved = vec3_sub(ray->origin, forest_origin(p, copy));
    *local = (mesh_ray){.origin = direction_in(p, moved), .direction = direction_in(p, ray->direction), .t_min = ray->t_min, .t_max = q->t_max,
                        .skip = TRIANGLE_NONE, .facing = !p->closed || q->kind == LAST ? FACING_ANY : within ? FACING_BACK : FACING_FRONT};
    if (is_mesh_face(ray->start) && mesh_face_primitive(ray->start) == p->primitive && mesh_face_copy(ray->start) == copy) {
        local->skip = mesh_face_triangle(ray->start);
        if (!p->closed)
            local->t_min += beyond_skin(p, copy, ray);
    }
    return true;
}

/* Of equal distances the lower face number wins, so that the order of looking does not matter. */
static void take(quest *q, const forest_part *p, uint32_t copy, const mesh_hit *hit)
{
    if (hit->triangle == TRIANGLE_NONE)
        return;
    const int64_t face = mesh_face_number(p->primitive, copy, hit->triangle);
    forest_hit *best = q->best;
    if (best->face != FACE_NONE && !(hit->t < best->t || (hit->t == best->t && face < best->face)))
        return;
    *best = (forest_hit){hit->t, hit->u, hit->v, face, hit->facing};
    q->t_max = hit->t;
}

/* The last crossing of each mesh on the way, whichever triangle: its side says whether the ray is inside behind it. */
typedef struct last_crossing { double t; bool inside; double t_min; bool met; } last_crossing;

static void note_crossing(void *context, const mesh_hit *hit)
{
    last_crossing *last = context;
    if (hit->t <= last->t_min || (last->met && hit->t < last->t))
        return;
    /* At one distance, a silhouette's front and back: outside. */
    const bool inside = hit->facing == FACING_FRONT;
    last->inside = last->met && hit->t == last->t ? last->inside && inside : inside;
    last->t = hit->t;
    last->met = true;
}

static void ask_copy(quest *q, size_t instance)
{
    const forest_part *p = q->f->parts;
    while (instance - p->first_instance >= (size_t)p->copies[0] * p->copies[1] * p->copies[2])
        p++;
    const uint32_t copy = (uint32_t)(instance - p->first_instance);
    mesh_ray local;
    if (!ray_in(q, p, copy, &local))
        return;
    if (q->kind == ANY) {
        q->blocked |= TREES.any(p->tree, &local);
        return;
    }
    if (q->kind == LAST) {
        TREES.all(p->tree, &local, note_crossing, &q->last[p - q->f->parts]);
        return;
    }
    mesh_hit hit;
    TREES.nearest(p->tree, &local, &hit);
    take(q, p, copy, &hit);
}

static double come_by(void *context, uint32_t instance, double t_max)
{
    quest *q = context;
    (void)t_max;
    ask_copy(q, instance);
    return q->blocked ? -1.0 : q->t_max;
}

static void walk(quest *q)
{
    const mesh_ray ray = {.origin = q->ray->origin, .direction = q->ray->direction, .t_min = q->ray->t_min, .t_max = q->t_max};
    TREES.boxes(q->f->top, &ray, come_by, q);
}

static void ask(quest *q)
{
    if (q->f->instance_count == 1)
        ask_copy(q, 0);
    else
        walk(q);
}

/* One copy of one mesh: its rays go down together. */
static void nearest_of_one(const forest *f, const forest_ray *rays, int count, forest_hit *hits)
{
    const forest_part *p = f->parts;
    mesh_ray local[BATCH];
    mesh_hit found[BATCH];
    int ray[BATCH], asked = 0;
    for (int i = 0; i < count; i++) {
        quest q = {.f = f, .ray = &rays[i], .t_max = rays[i].t_max};
        hits[i] = (forest_hit){.t = HUGE_VAL, .face = FACE_NONE};
        if (ray_in(&q, p, 0, &local[asked]))
            ray[asked++] = i;
    }
    if (asked == 0)
        return;
    TREES.nearest_batch(p->tree, local, asked, found);
    for (int k = 0; k < asked; k++)
        if (found[k].triangle != TRIANGLE_NONE)
            hits[ray[k]] = (forest_hit){found[k].t, found[k].u, found[k].v, mesh_face_number(p->primitive, 0, found[k].triangle), found[k].facing};
}

static void nearest(const forest *f, const forest_ray *rays, int count, forest_hit *hits)
{
    if (f->instance_count == 1) {
        nearest_of_one(f, rays, count, hits);
        return;
    }
    for (int i = 0; i < count; i++) {
        hits[i] = (forest_hit){.t = HUGE_VAL, .face = FACE_NONE};
        quest q = {.f = f, .ray = &rays[i], .t_max = rays[i].t_max, .best = &hits[i]};
        ask(&q);
    }
}

static void any_of_one(const forest *f, const forest_ray *rays, int count, bool *blocked)
{
    mesh_ray local[BATCH];
    bool found[BATCH];
    int ray[BATCH], asked = 0;
    for (int i = 0; i < count; i++) {
        quest q = {.f = f, .ray = &rays[i], .kind = ANY, .t_max = rays[i].t_max};
        blocked[i] = false;
        if (ray_in(&q, f->parts, 0, &local[asked]))
            ray[asked++] = i;
    }
    if (asked == 0)
        return;
    TREES.any_batch(f->parts->tree, local, asked, found);
    for (int k = 0; k < asked; k++)
        blocked[ray[k]] = found[k];
}

static void any(const forest *f, const forest_ray *rays, int count, bool *blocked)
{
    if (f->instance_count == 1) {
        any_of_one(f, rays, count, blocked);
        return;
    }
    for (int i = 0; i < count; i++) {
        quest q = {.f = f, .ray = &rays[i], .kind = ANY, .t_max = rays[i].t_max};
        ask(&q);
        blocked[i] = q.blocked;
    }
}

static uint64_t cross(const forest *f, const forest_ray *ray)
{
    last_crossing last[PRIMITIVES_MAX];
    for (int i = 0; i < f->part_count; i++)
        last[i] = (last_crossing){.t_min = ray->t_min};
    quest q = {.f = f, .ray = ray, .kind = LAST, .t_max = ray->t_max, .last = last};
    ask(&q);
    uint64_t set = ray->inside;
    for (int i = 0; i < f->part_count; i++) {
        const uint64_t bit = (uint64_t)1 << f->parts[i].primitive;
        if (last[i].met)
            set = !f->parts[i].closed || last[i].inside ? set | bit : set & ~bit;
    }
    return set;
}

const forest_kernels KERNEL(forest_kernels) = {nearest, any, cross};
