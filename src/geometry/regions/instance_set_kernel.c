/* Traversal of the instance set. Each copy is traversed in its own frame. The ray's direction is not normalised there,
 * so that distances along the ray are the same in all frames. */
#include "base/isa.h"
#include "base/lanes.h"
#include "geometry/regions/box_tests.h"
#include "geometry/regions/instance_set.h"

#define TREES KERNEL(hierarchy_kernels)

/* Reports every crossing of a ray with the copies that it visits. */
typedef struct visit {
    instance_found *found;
    void *context;
    const instance_set *f;
    const instance_ray *ray;
    int primitive; /* of the visited copy */
    uint32_t copy;
} visit;

/* The state of one traversal of the top-level hierarchy. */
typedef struct traversal {
    const instance_set *f;
    const instance_ray *ray;
    bool any, blocked; /* any: ignore priorities, and stop at the first hit unless `all` is given */
    visit *all;        /* report every crossing and ignore priorities; else NULL */
    double t_max;
    double beyond; /* added to t_min for open surfaces: see beyond_start */
    instance_hit *best;
} traversal;

static vec3 direction_in(const instanced_mesh *p, vec3 d)
{
    const vec3 turned = p->turned ? mat3_apply_transposed(p->rotation, d) : d;
    return p->scaled ? vec3_make(turned.x / p->scale.x, turned.y / p->scale.y, turned.z / p->scale.z) : turned;
}

/* Converts an error bound across a face's triangle into one along the ray: divides it by the cosine of incidence,
 * but by no less than 1e-6, so that the bound is finite at grazing incidence. */
static double along_ray(const instance_set *f, const instance_ray *ray, int64_t face, double error)
{
    const instanced_mesh *p = &f->parts[f->by_primitive[mesh_face_primitive(face)]];
    const uint32_t copy = mesh_face_copy(face);
    const mesh_triangle tri = p->triangles->triangles[mesh_face_triangle(face)];
    const vec3 a = instance_set_vertex_point(p, copy, tri.corner[0]),
               b = instance_set_vertex_point(p, copy, tri.corner[1]),
               c = instance_set_vertex_point(p, copy, tri.corner[2]);
    const vec3 n = vec3_cross(vec3_sub(b, a), vec3_sub(c, a)), d = ray->direction;
    const double least_cosine = 1e-6, length = vec3_length(n), least = least_cosine * length * vec3_length(d);
    return error * length / greater(fabs(vec3_dot(n, d)), least);
}

static double sum_of_magnitudes(vec3 v)
{
    return fabs(v.x) + fabs(v.y) + fabs(v.z);
}

/* A ray that starts on a mesh may be on either side of it by rounding, and of a coincident open surface: it ignores
 * open surfaces within the error bound of its start. */
static double beyond_start(const instance_set *f, const instance_ray *ray)
{
    if (!f->open_surfaces || !is_mesh_face(ray->start))
        return 0.0;
    const instanced_mesh *p = &f->parts[f->by_primitive[mesh_face_primitive(ray->start)]];
    return along_ray(f, ray, ray->start, POINT_ERROR * (sum_of_magnitudes(ray->origin) + p->reach));
}

/* If a ray that starts on a surface crosses a mesh at its start, within the crossing's error bound, the two surfaces
 * were in contact there, and the ray's set is already on the right side of the mesh. Returns that bound; 0 for all
 * other crossings. */
static double at_start(const instance_set *f, const instance_ray *ray, const instance_hit *hit)
{
    const instanced_mesh *p = &f->parts[f->by_primitive[mesh_face_primitive(hit->face)]];
    /* Crossings clearly far from the start need no exact test: 2^-20 of the reach exceeds every error bound. */
    const double reach = p->reach + sum_of_magnitudes(ray->origin);
    if (ray->start == FACE_NONE || ray->t_min > 0.0 || hit->t * sum_of_magnitudes(ray->direction) > 0x1p-20 * reach)
        return 0.0;
    const vec3 o = instance_set_origin(p, mesh_face_copy(hit->face));
    const double all = sum_of_magnitudes(vec3_sub(ray->origin, o)) + sum_of_magnitudes(o) + p->reach;
    const double bound = along_ray(f, ray, hit->face, POINT_ERROR * all);
    return hit->t <= bound ? bound : 0.0;
}

static traversal traversal_of(const instance_set *f, const instance_ray *ray)
{
    return (traversal){.f = f, .ray = ray, .t_max = ray->t_max, .beyond = beyond_start(f, ray)};
}

/* The ray in a copy's frame; false if that mesh cannot affect the ray. */
static bool ray_in(const traversal *q, const instanced_mesh *p, uint32_t copy, mesh_ray *local)
{
    const instance_ray *ray = q->ray;
    const uint64_t bit = (uint64_t)1 << p->primitive;
    const bool within = (ray->inside & bit) != 0;
    if (!(ray->wanted & bit) ||
        (!q->any && (p->closed && within ? p->priority_index < ray->before : p->priority_index <= ray->before)))
        return false;
    const vec3 moved = vec3_sub(ray->origin, instance_set_origin(p, copy));
    *local = (mesh_ray){.origin = direction_in(p, moved),
                        .direction = direction_in(p, ray->direction),
                        .t_min = ray->t_min,
                        .t_max = q->t_max,
                        .skip = TRIANGLE_NONE,
                        .facing = !p->closed ? FACING_ANY
                                  : within   ? FACING_BACK
                                             : FACING_FRONT};
    if (is_mesh_face(ray->start) && mesh_face_primitive(ray->start) == p->primitive &&
        mesh_face_copy(ray->start) == copy)
        local->skip = mesh_face_triangle(ray->start);
    if (!p->closed)
        local->t_min += q->beyond;
    if (q->all)
        local->facing = FACING_ANY;
    return true;
}

static bool misses_copy(const instanced_mesh *p, const mesh_ray *local)
{
    const bounds3 *box = &p->triangles->bounds;
    return ray_misses_box(box->low, box->high, local->origin, local->direction) != 0;
}

/* At equal distances the lower face number wins, so that the result is independent of the order. */
static void accept_hit(traversal *q, const instanced_mesh *p, uint32_t copy, const mesh_hit *hit)
{
    if (hit->triangle == TRIANGLE_NONE)
        return;
    const int64_t face = mesh_face_number(p->primitive, copy, hit->triangle);
    instance_hit *best = q->best;
    if (best->face != FACE_NONE && !(hit->t < best->t || (hit->t == best->t && face < best->face)))
        return;
    *best = (instance_hit){hit->t, hit->u, hit->v, face, hit->facing};
    q->t_max = hit->t;
}

static void note_crossing(void *context, const mesh_hit *hit)
{
    const visit *v = context;
    if (!(hit->t > v->ray->t_min))
        return;
    const int64_t face = mesh_face_number(v->primitive, v->copy, hit->triangle);
    const instance_hit found = {hit->t, hit->u, hit->v, face, hit->facing};
    if (at_start(v->f, v->ray, &found) == 0.0)
        v->found(v->context, &found);
}

static const instanced_mesh *part_of_instance(const instance_set *f, size_t instance)
{
    const instanced_mesh *p = f->parts;
    while (instance - p->first_instance >= (size_t)p->copies[0] * p->copies[1] * p->copies[2])
        p++;
    return p;
}

/* Counts the queries of rays in a copy's frame that may meet it, if requested; separate from the traversal, so as not
 * to slow it down. */
static void count_queries(const instanced_mesh *p, const mesh_ray *local, int count, enum query_mode mode,
                          query_counts *counts)
{
    for (int k = 0; counts && k < count; k++)
        if (!misses_copy(p, &local[k]))
            hierarchy_count(p->tree, &local[k], mode, counts);
}

static void query_copy(traversal *q, size_t instance)
{
    const instanced_mesh *p = part_of_instance(q->f, instance);
    const uint32_t copy = (uint32_t)(instance - p->first_instance);
    mesh_ray local;
    if (!ray_in(q, p, copy, &local) || misses_copy(p, &local))
        return;
    count_queries(p, &local, 1, q->all ? QUERY_ALL : q->any ? QUERY_ANY : QUERY_NEAREST, q->ray->counts);
    if (q->all) {
        q->all->primitive = p->primitive;
        q->all->copy = copy;
        TREES.all(p->tree, &local, note_crossing, q->all);
        return;
    }
    if (q->any) {
        q->blocked |= TREES.any(p->tree, &local);
        return;
    }
    mesh_hit hit;
    TREES.nearest(p->tree, &local, &hit);
    accept_hit(q, p, copy, &hit);
}

static double visit_instance(void *context, uint32_t instance, double t_max)
{
    traversal *q = context;
    (void)t_max;
    query_copy(q, instance);
    return q->blocked ? -1.0 : q->t_max;
}

static void traverse(traversal *q)
{
    const mesh_ray ray = {
        .origin = q->ray->origin, .direction = q->ray->direction, .t_min = q->ray->t_min, .t_max = q->t_max};
    TREES.boxes(q->f->top, &ray, visit_instance, q);
}

static void query(traversal *q)
{
    if (q->f->instance_count == 1)
        query_copy(q, 0);
    else
        traverse(q);
}

/* Up to this number of copies it is faster to traverse them in turn, each with all rays as a packet. */
enum { FEW_COPIES = 8 };

/* The box of a single copy is not tested: the box around all meshes has decided for the batch, and the root of the
 * hierarchy decides again. */
static void nearest_of_copy(const instance_set *f, size_t instance, const instance_ray *rays, int count,
                            instance_hit *hits)
{
    const instanced_mesh *p = part_of_instance(f, instance);
    const uint32_t copy = (uint32_t)(instance - p->first_instance);
    const bool boxed = f->instance_count > 1;
    mesh_ray local[BATCH];
    mesh_hit found[BATCH];
    int ray[BATCH], queued = 0;
    for (int i = 0; i < count; i++) {
        traversal q = traversal_of(f, &rays[i]);
        q.t_max = hits[i].face == FACE_NONE ? q.t_max : hits[i].t;
        if (ray_in(&q, p, copy, &local[queued]) && !(boxed && misses_copy(p, &local[queued])))
            ray[queued++] = i;
    }
    if (queued == 0)
        return;
    TREES.nearest_batch(p->tree, local, queued, found);
    count_queries(p, local, queued, QUERY_NEAREST, rays[0].counts);
    for (int k = 0; k < queued; k++) {
        traversal q = {.best = &hits[ray[k]]};
        accept_hit(&q, p, copy, &found[k]);
    }
}

static void nearest_one(const instance_set *f, const instance_ray *ray, instance_hit *hit)
{
    *hit = (instance_hit){.t = HUGE_VAL, .face = FACE_NONE};
    traversal q = traversal_of(f, ray);
    q.best = hit;
    query(&q);
}

/* Searches again beyond a crossing at the ray's start. */
static void pass_start(const instance_set *f, const instance_ray *ray, instance_hit *hit)
{
    instance_ray later = *ray;
    for (double bound; hit->face != FACE_NONE && (bound = at_start(f, ray, hit)) > later.t_min;) {
        later.t_min = bound;
        nearest_one(f, &later, hit);
    }
}

static void nearest(const instance_set *f, const instance_ray *rays, int count, instance_hit *hits)
{
    for (int i = 0; i < count; i++)
        hits[i] = (instance_hit){.t = HUGE_VAL, .face = FACE_NONE};
    for (size_t instance = 0; f->instance_count <= FEW_COPIES && instance < f->instance_count; instance++)
        nearest_of_copy(f, instance, rays, count, hits);
    for (int i = 0; i < count; i++) {
        if (f->instance_count > FEW_COPIES)
            nearest_one(f, &rays[i], &hits[i]);
        if (hits[i].face != FACE_NONE && at_start(f, &rays[i], &hits[i]) > rays[i].t_min)
            pass_start(f, &rays[i], &hits[i]);
    }
}

static void any_of_copy(const instance_set *f, size_t instance, const instance_ray *rays, int count, bool *blocked)
{
    const instanced_mesh *p = part_of_instance(f, instance);
    const uint32_t copy = (uint32_t)(instance - p->first_instance);
    const bool boxed = f->instance_count > 1;
    mesh_ray local[BATCH];
    bool found[BATCH];
    int ray[BATCH], queued = 0;
    for (int i = 0; i < count; i++) {
        traversal q = traversal_of(f, &rays[i]);
        q.any = true;
        if (!blocked[i] && ray_in(&q, p, copy, &local[queued]) && !(boxed && misses_copy(p, &local[queued])))
            ray[queued++] = i;
    }
    if (queued == 0)
        return;
    TREES.any_batch(p->tree, local, queued, found);
    count_queries(p, local, queued, QUERY_ANY, rays[0].counts);
    for (int k = 0; k < queued; k++)
        blocked[ray[k]] = found[k];
}

static void any(const instance_set *f, const instance_ray *rays, int count, bool *blocked)
{
    for (int i = 0; i < count; i++)
        blocked[i] = false;
    for (size_t instance = 0; f->instance_count <= FEW_COPIES && instance < f->instance_count; instance++)
        any_of_copy(f, instance, rays, count, blocked);
    for (int i = 0; f->instance_count > FEW_COPIES && i < count; i++) {
        traversal q = traversal_of(f, &rays[i]);
        q.any = true;
        query(&q);
        blocked[i] = q.blocked;
    }
}

static void each(const instance_set *f, const instance_ray *ray, instance_found *found, void *context)
{
    visit v = {.found = found, .context = context, .f = f, .ray = ray};
    traversal q = traversal_of(f, ray);
    q.any = true;
    q.all = &v;
    query(&q);
}

/* The last crossings of a ray with each mesh's fronts and backs, and the extents of those copies. */
typedef struct last_crossings {
    const instance_set *f;
    double front[PRIMITIVES_MAX], back[PRIMITIVES_MAX], front_extent[PRIMITIVES_MAX], back_extent[PRIMITIVES_MAX];
} last_crossings;

static void keep_last(void *context, const instance_hit *hit)
{
    last_crossings *last = context;
    const int p = mesh_face_primitive(hit->face);
    const bool front = hit->facing == FACING_FRONT;
    double *t = front ? &last->front[p] : &last->back[p];
    if (!(hit->t > *t))
        return;
    *t = hit->t;
    *(front ? &last->front_extent[p] : &last->back_extent[p]) = instance_set_extent(last->f, hit->face);
}

static void find_last_crossings(const instance_set *f, const instance_ray *ray, last_crossings *last)
{
    last->f = f;
    for (int i = 0; i < f->part_count; i++) {
        const int p = f->parts[i].primitive;
        last->front[p] = last->back[p] = -HUGE_VAL;
        last->front_extent[p] = last->back_extent[p] = 0.0;
    }
    each(f, ray, keep_last, last);
}

/* Whether the ray, at the end of its range, is in the closed mesh. The last crossing decides: fronts lead in, backs
 * lead out. If both coincide (a silhouette, or two copies that touch), the ray is inside if it was before. */
static bool is_in(const instance_set *f, const instance_ray *ray, const last_crossings *all, int number)
{
    const uint64_t bit = (uint64_t)1 << number;
    last_crossings again;
    instance_ray shorter = *ray;
    shorter.wanted = bit;
    for (const last_crossings *last = all;;) {
        const double front = last->front[number], back = last->back[number], first = lesser(front, back);
        const double tie =
            ray->tie + ray->tie_by_extent * greater(last->front_extent[number], last->back_extent[number]);
        if (greater(front, back) < 0.0 && front == back) /* no crossing */
            return (ray->inside & bit) != 0;
        if (front - back > tie || back - front > tie)
            return front > back;
        shorter.t_max = first - tie;
        if (!(shorter.t_max > ray->t_min))
            return (ray->inside & bit) != 0;
        find_last_crossings(f, &shorter, &again);
        last = &again;
    }
}

static uint64_t cross(const instance_set *f, const instance_ray *ray)
{
    uint64_t set = ray->inside;
    last_crossings last;
    find_last_crossings(f, ray, &last);
    for (int i = 0; i < f->part_count; i++) {
        const instanced_mesh *p = &f->parts[i];
        const uint64_t bit = (uint64_t)1 << p->primitive;
        if (!(ray->wanted & bit))
            continue;
        if (p->closed)
            set = is_in(f, ray, &last, p->primitive) ? set | bit : set & ~bit;
        else if (last.front[p->primitive] >= 0.0 || last.back[p->primitive] >= 0.0)
            set |= bit;
    }
    return set;
}

const instance_kernels KERNEL(instance_kernels) = {nearest, any, cross, each};
