/* Meshes in the second pass over a batch (nearest_interface_kernel.c): merges their crossings with those of the other
 * primitives, and updates their bits in each ray's set of solids that contain the current point. Between two changes of
 * medium a ray can cross only meshes of lower priority, which are hidden; their bits are updated at the next change. */
#include "geometry/regions/kernels.h"

#include "geometry/regions/box_tests.h"
#include "geometry/regions/instance_set.h"
#include <math.h>

#define INSTANCE_SET KERNEL(instance_kernels)

/* Member by member, for queries in arrays: a struct that is made in registers and then copied in wide pieces waits for
 * its own stores. */
ALWAYS_INLINE void set_ray(const ray_batch *rays, int k, const ray_scratch *s, instance_ray *ray)
{
    const int i = s->ray[k];
    const mesh_scratch *m = s->meshes;
    ray->origin.x = rays->ox[i], ray->origin.y = rays->oy[i], ray->origin.z = rays->oz[i];
    ray->direction.x = rays->dx[i], ray->direction.y = rays->dy[i], ray->direction.z = rays->dz[i];
    ray->t_min = m->from[k];
    ray->t_max = HUGE_VAL;
    ray->tie = ray->tie_by_extent = 0.0;
    ray->start = m->last[k];
    ray->before = 0;
    ray->inside = s->inside[k];
    ray->wanted = 0;
    ray->counts = m->counts;
}

static instance_ray ray_of_column(const ray_batch *rays, int k, const ray_scratch *s)
{
    instance_ray ray;
    set_ray(rays, k, s, &ray);
    return ray;
}

/* A front and a back of one mesh within this fraction of the distance and of the mesh's own extent coincide: well above
 * the rounding error. */
#define ONE_PLACE 0x1p-40

static double close_to(const ray_scratch *s, int k, double t)
{
    return BOUNDARY_CLOSE * (t + s->slack[k]);
}

/* Finds the rays that miss the box around all meshes. */
static void find_misses(const instance_set *f, const ray_batch *rays, int64_t *restrict misses)
{
    const bounds3 box = f->world;
    /* VECTORISE */
    for (int i = 0; i < rays->count; i++)
        misses[i] = ray_misses_box(box.low, box.high, vec3_make(rays->ox[i], rays->oy[i], rays->oz[i]),
                                   vec3_make(rays->dx[i], rays->dy[i], rays->dz[i]));
}

/* The columns that may meet a mesh. Only a full batch is tested: rays that are searched again are close to a mesh. */
static int columns_to_query(const instance_set *f, const ray_batch *rays, int n, int *column)
{
    int64_t misses[ROW];
    int count = 0;
    if (n == rays->count)
        find_misses(f, rays, misses);
    for (int k = 0; k < n; k++) {
        column[count] = k;
        count += n < rays->count || !misses[k];
    }
    return count;
}

void KERNEL(mesh_changes)(const scene_geometry *g, const ray_batch *rays, int n, ray_scratch *s, hit_batch *c,
                          instance_hit *hits)
{
    const instance_set *f = g->meshes;
    instance_ray queries[BATCH];
    instance_hit answers[BATCH];
    int column[BATCH];
    const int queried = columns_to_query(f, rays, n, column);
    for (int q = 0; q < queried; q++) {
        const int k = column[q];
        set_ray(rays, k, s, &queries[q]);
        queries[q].t_max = c->t[k] + close_to(s, k, c->t[k]);
        queries[q].before = c->before[k];
        queries[q].wanted = f->primitives;
    }
    for (int k = 0; k < n; k++) {
        s->meshes->near[k] = 0;
        hits[k] = (instance_hit){.t = HUGE_VAL, .face = FACE_NONE};
    }
    if (queried > 0)
        INSTANCE_SET.nearest(f, queries, queried, answers);
    for (int q = 0; q < queried; q++) {
        const int k = column[q];
        hits[k] = answers[q];
        const bool found = hits[k].face != FACE_NONE;
        const bool near = found && c->hit_primitive[k] >= 0 && fabs(c->t[k] - hits[k].t) <= close_to(s, k, hits[k].t);
        s->meshes->near[k] = near ? (uint64_t)1 << mesh_face_primitive(hits[k].face) : 0;
        if (found && hits[k].t < c->t[k]) {
            c->t[k] = hits[k].t;
            c->hit_primitive[k] = mesh_face_primitive(hits[k].face);
        }
    }
}

/* The meshes of the crossings that are found, except for the copy with that face: parts of one mesh do not touch. */
typedef struct others {
    int64_t face;
    uint64_t set;
} others;

static void collect_others(void *context, const instance_hit *hit)
{
    others *o = context;
    const int p = mesh_face_primitive(hit->face);
    if (o->face == FACE_NONE || p != mesh_face_primitive(o->face) ||
        mesh_face_copy(hit->face) != mesh_face_copy(o->face))
        o->set |= (uint64_t)1 << p;
}

/* The meshes with a boundary close to column k's crossing. For a single visible mesh the nearest query has covered this
 * range already. */
static uint64_t near_meshes(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s,
                            const hit_batch *c, const instance_hit *hit)
{
    const instance_set *f = g->meshes;
    const bool on_mesh = (f->primitives & direct_bit(g, c->hit_primitive[k])) != 0;
    if (f->instance_count == 1 && (on_mesh || f->lowest >= c->before[k]))
        return on_mesh ? 0 : s->meshes->near[k];
    const double close = close_to(s, k, c->t[k]);
    instance_ray ray = ray_of_column(rays, k, s);
    ray.t_min = c->t[k] - close;
    ray.t_max = c->t[k] + close;
    ray.wanted = f->primitives;
    others o = {on_mesh ? hit->face : FACE_NONE, 0};
    INSTANCE_SET.each(f, &ray, collect_others, &o);
    return o.set;
}

/* The set at t, if the ray has been in the medium of that priority index since the set was last updated. The bits of
 * the meshes hidden there follow from their last crossings. */
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

void KERNEL(mesh_sets)(const scene_geometry *g, const ray_batch *rays, int n, ray_scratch *s, hit_batch *c,
                       const instance_hit *hits)
{
    const instance_set *f = g->meshes;
    for (int k = 0; k < n; k++) {
        if (c->hit_primitive[k] < 0)
            continue;
        const uint64_t hidden = f->closed_under[c->before[k]];
        c->inside_before[k] =
            set_at(f, rays, k, s, c->before[k], c->t[k] - close_to(s, k, c->t[k]), c->inside_before[k]);
        c->inside_after[k] = (c->inside_after[k] & ~hidden) | (c->inside_before[k] & hidden);
        const uint64_t bit = direct_bit(g, c->hit_primitive[k]);
        if (f->primitives & bit) {
            const bool leaves = (f->closed & bit) && hits[k].facing == FACING_BACK;
            c->inside_after[k] = leaves ? c->inside_after[k] & ~bit : c->inside_after[k] | bit;
        }
        s->meshes->near[k] = near_meshes(g, rays, k, s, c, &hits[k]);
        s->near[k] = (s->near[k] & ~f->primitives) | s->meshes->near[k] | (bit & f->primitives);
    }
}

void KERNEL(mesh_sets_closely)(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s,
                               int64_t priority_index, uint64_t wanted, double low, double high, uint64_t *before,
                               uint64_t *after)
{
    *before = (*before & ~wanted) | (set_at(g->meshes, rays, k, s, priority_index, low, s->inside[k]) & wanted);
    instance_ray ray = ray_of_column(rays, k, s);
    ray.t_min = low;
    ray.t_max = high;
    ray.tie = high - low;
    ray.inside = *before;
    ray.wanted = wanted;
    *after = (*after & ~wanted) | (INSTANCE_SET.cross(g->meshes, &ray) & wanted);
}

void KERNEL(mesh_each_near)(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s, int p,
                            double t, instance_found *found, void *context)
{
    instance_ray ray = ray_of_column(rays, k, s);
    ray.t_min = t - close_to(s, k, t);
    ray.t_max = t + close_to(s, k, t);
    ray.wanted = (uint64_t)1 << p;
    INSTANCE_SET.each(g->meshes, &ray, found, context);
}

instance_hit KERNEL(mesh_hit_between)(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s,
                                      int bit, uint64_t before, double low, double high)
{
    instance_hit hit;
    instance_ray ray = ray_of_column(rays, k, s);
    ray.t_min = low;
    ray.t_max = high;
    ray.inside = before;
    ray.wanted = (uint64_t)1 << bit;
    INSTANCE_SET.nearest(g->meshes, &ray, 1, &hit);
    return hit;
}

void KERNEL(mesh_shadows)(const scene_geometry *g, const ray_batch *rays, uint64_t wanted, bool certain,
                          query_counts *counts, int64_t *marked, const int64_t *settled)
{
    /* most rays that enter the box of a single mesh hit it, and would be searched twice */
    const bool by_box = !certain && g->meshes->instance_count == 1;
    instance_ray queries[BATCH];
    bool found[BATCH];
    int ray[BATCH], count = 0;
    int64_t misses[ROW];
    find_misses(g->meshes, rays, misses);
    for (int i = 0; i < rays->count; i++) {
        if (settled[i])
            continue;
        if (rays->inside[i] & wanted & g->meshes->closed) {
            marked[i] = -1;
            continue;
        }
        if (misses[i])
            continue;
        if (by_box) {
            marked[i] = -1;
            continue;
        }
        queries[count] = (instance_ray){.origin = vec3_make(rays->ox[i], rays->oy[i], rays->oz[i]),
                                        .direction = vec3_make(rays->dx[i], rays->dy[i], rays->dz[i]),
                                        .t_min = 0.0,
                                        .t_max = 1.0,
                                        .start = rays->start[i],
                                        .inside = rays->inside[i],
                                        .wanted = wanted,
                                        .counts = counts};
        ray[count++] = i;
    }
    if (count == 0)
        return;
    INSTANCE_SET.any(g->meshes, queries, count, found);
    for (int k = 0; k < count; k++)
        marked[ray[k]] |= -(int64_t)found[k];
}
