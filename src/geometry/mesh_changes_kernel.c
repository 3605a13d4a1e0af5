/* What meshes add to the second pass over a batch (nearest_interface_kernel.c): their crossings among those of the
 * convex primitives, and the bits of a ray's set that stand for them. Between two changes of medium only meshes of a
 * lower rank can be crossed, unseen; their bits are set right where the next change is. */
#include "geometry/kernels.h"

#include "geometry/instance_set.h"
#include <math.h>

#define INSTANCE_SET KERNEL(instance_kernels)

static instance_ray ray_of_column(const ray_batch *rays, int k, const ray_scratch *s)
{
    const int i = s->ray[k];
    const mesh_scratch *m = s->meshes;
    return (instance_ray){.origin = vec3_make(rays->ox[i], rays->oy[i], rays->oz[i]),
                          .direction = vec3_make(rays->dx[i], rays->dy[i], rays->dz[i]),
                          .t_min = m->from[k],
                          .t_max = HUGE_VAL,
                          .start = m->last[k],
                          .before = 0,
                          .inside = s->inside[k]};
}

/* A front and a back of one mesh within this share of the distance and of the mesh's own extent are at one place: well
 * above rounding. */
#define ONE_PLACE 0x1p-40

static double close_to(const ray_scratch *s, int k, double t)
{
    return BOUNDARY_CLOSE * (t + s->slack[k]);
}

void KERNEL(mesh_changes)(const scene_geometry *a, const ray_batch *rays, int n, ray_scratch *s, hit_batch *c,
                          instance_hit *hits)
{
    const instance_set *f = a->meshes;
    instance_ray asked[BATCH];
    for (int k = 0; k < n; k++) {
        asked[k] = ray_of_column(rays, k, s);
        asked[k].t_max = c->t[k] + close_to(s, k, c->t[k]);
        asked[k].before = c->before[k];
        asked[k].wanted = f->primitives;
    }
    if (n <= 0)
        return;
    INSTANCE_SET.nearest(f, asked, n, hits);
    for (int k = 0; k < n; k++) {
        const bool met = hits[k].face != FACE_NONE;
        const bool near = met && c->hit_primitive[k] >= 0 && fabs(c->t[k] - hits[k].t) <= close_to(s, k, hits[k].t);
        s->meshes->near[k] = near ? (uint64_t)1 << mesh_face_primitive(hits[k].face) : 0;
        if (met && hits[k].t < c->t[k]) {
            c->t[k] = hits[k].t;
            c->hit_primitive[k] = mesh_face_primitive(hits[k].face);
        }
    }
}

/* The meshes of the crossings that are found, but for those of the copy with that face: a mesh's own parts do not
 * touch. */
typedef struct others {
    int64_t face;
    uint64_t set;
} others;

static void take_others(void *context, const instance_hit *hit)
{
    others *o = context;
    const int p = mesh_face_primitive(hit->face);
    if (o->face == FACE_NONE || p != mesh_face_primitive(o->face) ||
        mesh_face_copy(hit->face) != mesh_face_copy(o->face))
        o->set |= (uint64_t)1 << p;
}

/* The meshes with a boundary close to column k's crossing. A single mesh that is not hidden was already looked for that
 * far. */
static uint64_t near_meshes(const instance_set *f, const ray_batch *rays, int k, const ray_scratch *s,
                            const hit_batch *c, const instance_hit *hit)
{
    const bool on_mesh = f->primitives >> c->hit_primitive[k] & 1;
    if (f->instance_count == 1 && (on_mesh || f->lowest >= c->before[k]))
        return on_mesh ? 0 : s->meshes->near[k];
    const double close = close_to(s, k, c->t[k]);
    instance_ray ray = ray_of_column(rays, k, s);
    ray.t_min = c->t[k] - close;
    ray.t_max = c->t[k] + close;
    ray.wanted = f->primitives;
    others o = {on_mesh ? hit->face : FACE_NONE, 0};
    INSTANCE_SET.each(f, &ray, take_others, &o);
    return o.set;
}

/* The set at t, where the ray has been in the medium of that rank all the way from where it was looked at last: of the
 * meshes that are hidden there what their last crossings say. */
static uint64_t set_at(const instance_set *f, const ray_batch *rays, int k, const ray_scratch *s,
                       int64_t priority_index, double t, uint64_t set)
{
    if (!(f->lowest_closed < priority_index))
        return set;
    instance_ray ray = ray_of_column(rays, k, s);
    ray.t_max = t;
    ray.tie = ONE_PLACE * t;
    ray.tie_by_extent = ONE_PLACE * steps_per_unit(rays, s->ray[k]);
    ray.wanted = f->closed_under[priority_index];
    return (set & ~ray.wanted) | (INSTANCE_SET.cross(f, &ray) & ray.wanted);
}

void KERNEL(mesh_sets)(const scene_geometry *a, const ray_batch *rays, int n, ray_scratch *s, hit_batch *c,
                       const instance_hit *hits)
{
    const instance_set *f = a->meshes;
    for (int k = 0; k < n; k++) {
        if (c->hit_primitive[k] < 0)
            continue;
        const uint64_t hidden = f->closed_under[c->before[k]];
        c->inside_before[k] =
            set_at(f, rays, k, s, c->before[k], c->t[k] - close_to(s, k, c->t[k]), c->inside_before[k]);
        c->inside_after[k] = (c->inside_after[k] & ~hidden) | (c->inside_before[k] & hidden);
        const uint64_t bit = (uint64_t)1 << c->hit_primitive[k];
        if (f->primitives & bit) {
            const bool leaves = (f->closed & bit) && hits[k].facing == FACING_BACK;
            c->inside_after[k] = leaves ? c->inside_after[k] & ~bit : c->inside_after[k] | bit;
        }
        s->meshes->near[k] = near_meshes(f, rays, k, s, c, &hits[k]);
        s->near[k] = (s->near[k] & ~f->primitives) | s->meshes->near[k] | (bit & f->primitives);
    }
}

void KERNEL(mesh_sets_closely)(const scene_geometry *a, const ray_batch *rays, int k, const ray_scratch *s,
                               int64_t priority_index, uint64_t wanted, double low, double high, uint64_t *before,
                               uint64_t *after)
{
    *before = (*before & ~wanted) | (set_at(a->meshes, rays, k, s, priority_index, low, s->inside[k]) & wanted);
    instance_ray ray = ray_of_column(rays, k, s);
    ray.t_min = low;
    ray.t_max = high;
    ray.tie = high - low;
    ray.inside = *before;
    ray.wanted = wanted;
    *after = (*after & ~wanted) | (INSTANCE_SET.cross(a->meshes, &ray) & wanted);
}

void KERNEL(mesh_each_near)(const scene_geometry *a, const ray_batch *rays, int k, const ray_scratch *s, int p,
                            double t, instance_found *found, void *context)
{
    instance_ray ray = ray_of_column(rays, k, s);
    ray.t_min = t - close_to(s, k, t);
    ray.t_max = t + close_to(s, k, t);
    ray.wanted = (uint64_t)1 << p;
    INSTANCE_SET.each(a->meshes, &ray, found, context);
}

instance_hit KERNEL(mesh_hit_between)(const scene_geometry *a, const ray_batch *rays, int k, const ray_scratch *s,
                                      int bit, uint64_t before, double low, double high)
{
    instance_hit hit;
    instance_ray ray = ray_of_column(rays, k, s);
    ray.t_min = low;
    ray.t_max = high;
    ray.inside = before;
    ray.wanted = (uint64_t)1 << bit;
    INSTANCE_SET.nearest(a->meshes, &ray, 1, &hit);
    return hit;
}

/* Rays that a mesh of the set is in the way of, between 0 and 1: those that set out in a closed one are in it from the
 * start. */
void KERNEL(mesh_shadows)(const scene_geometry *a, const ray_batch *rays, uint64_t wanted, int64_t *marked,
                          const int64_t *settled)
{
    instance_ray asked[BATCH];
    bool found[BATCH];
    int ray[BATCH], count = 0;
    for (int i = 0; i < rays->count; i++) {
        if (settled[i])
            continue;
        if (rays->inside[i] & wanted & a->meshes->closed) {
            marked[i] = -1;
            continue;
        }
        asked[count] = (instance_ray){.origin = vec3_make(rays->ox[i], rays->oy[i], rays->oz[i]),
                                      .direction = vec3_make(rays->dx[i], rays->dy[i], rays->dz[i]),
                                      .t_min = 0.0,
                                      .t_max = 1.0,
                                      .start = rays->start[i],
                                      .inside = rays->inside[i],
                                      .wanted = wanted};
        ray[count++] = i;
    }
    if (count == 0)
        return;
    INSTANCE_SET.any(a->meshes, asked, count, found);
    for (int k = 0; k < count; k++)
        marked[ray[k]] |= -(int64_t)found[k];
}
