/* The tracer of one worker: queues of rays by depth, the batch of rays that is being traced, the group of its rays that
 * is being shaded, counters and scratch memory. There is no other tracer: a single ray is a batch of one. Used by the
 * shading code (render/shade), the integrators, and the loop that pops batches from the queues
 * (render/frame/batches.c); for ownership see render/frame/tracers.h. */
#pragma once

#include "base/counters.h"
#include "geometry/rays.h"
#include "render/plan/film.h"
#include "render/plan/plan.h"
#include "render/tracer/groups.h"
#include "render/tracer/integrator.h"
#include "render/tracer/queue.h"

/* From this depth on, where rays do not branch, two queues alternate, so that memory is bounded whatever the depth
 * limit. */
enum { DEPTH_DEEP = DEPTH_TREE_MAX };

/* Deep rays wait until there are this many, and are then traced to their ends, in batches that remain nearly full. */
enum { DEEP_AT_ONCE = 16 * BATCH };

static inline bool goes_deep(int depth_limit)
{
    return depth_limit > DEPTH_DEEP;
}

typedef struct tracer_queues {
    int depth_limit, created; /* created: number of queues in waiting */
    int depth;                /* of the batch that is being traced */
    ray_queue *waiting;       /* by depth, see tracer_queue_at */
    ray_queue shadows;
} tracer_queues;

/* Counters since the frame began. */
typedef struct tracer_account {
    ray_counters counters;
    int64_t visibility_ns; /* in a scene with meshes: time in the geometry kernels */
    uint64_t frame;        /* number, in the tracer_pool, of the frame that the tracer last began; 0 before the first */
    int64_t overflow;      /* negative: a sum or a contribution left the film's range */
} tracer_account;

/* For crossings of partial surfaces: the sample keys of the batch, NULL for shadow rays; its depth; and the crossings
 * so far, by ray. */
typedef struct batch_cover {
    const int64_t *sample_keys;
    int depth;
    int crossings[ROW];
} batch_cover;

/* A batch of rays and its hits. */
typedef struct tracer_batch {
    ray_scratch scratch;
    /* hit_primitive is -1 for rays that hit nothing, and less than -1 for rays with an end that only the integrator
     * defines (path.h: at a light, or where a medium scatters the ray) */
    _Alignas(64) hit_batch hits;
    _Alignas(64) double transmitted[ROW]; /* fraction of each shadow ray's light */
    hit_groups groups;
    batch_cover cover;
} tracer_batch;

/* Stokes vectors relative to their first element, of a group and of its two branches. */
typedef struct polar_group {
    double q[ROW], u[ROW], v[ROW], rq[ROW], ru[ROW], rv[ROW], tq[ROW], tu[ROW], tv[ROW];
} polar_group;

/* Gathered rays of the batch that hit one surface, and their shading results. */
typedef struct tracer_surface {
    group gathered;
    _Alignas(64) lit_group lit;
    _Alignas(64) branch_group branches;
    polar_group polar;
    const shading_material *mat;
    int key;                /* the surface key of mat (plan.h) */
    const vec3 *texture_at; /* points of the texture lookup; NULL: the hit points themselves */
    bool on_mesh;
    bool blended; /* the rays are divided: `cover` of each meets the surface, the rest goes on */
    double cover[ROW];
} tracer_surface;

struct tracer {
    const geometry_kernels *geometry;
    const group_kernels *grouping;
    const struct shade_kernels *shade;
    const struct sampling_kernels *sampling;
    tracer_target target;
    const integrator *frame_integrator; /* NULL before the first frame */
    void *worker_data;                  /* the integrator's data of this worker */
    /* branches with a smaller weight are not traced: render.min_weight times the weight of a camera ray */
    double least_weight;
    bool by_sample_key; /* the film uses more of the sample key than its pixel */
    tracer_queues queues;
    tracer_account account;
    int16_t *marks; /* see group_kernels */
    size_t mark_count;
    /* memory for some scenes; each pointer is NULL until the first such scene */
    struct mesh_work *meshes;          /* with meshes */
    struct media_work *media;          /* with media that attenuate */
    struct radiance_work *basic;       /* with basic radiance */
    struct layered_work *layered;      /* with metals or thin films */
    struct crystal_work *crystals;     /* with crystals */
    struct footprint_work *footprints; /* with photons, unless paths are random; else NULL */
    _Alignas(64) tracer_batch batch;   /* _Alignas: to cache lines */
    _Alignas(64) tracer_surface surface;
};

static inline ray_queue *tracer_queue_at(const tracer *t, int depth)
{
    return &t->queues.waiting[depth < DEPTH_DEEP ? depth : DEPTH_DEEP + (depth - DEPTH_DEEP) % 2];
}

/* The maximum probability of surviving Russian roulette: without a depth limit, a path that loses no light might never
 * end. From the 4096th surface on, two of `depth` paths end at each, so that (4096 / depth)^2 are left. Then a path has
 * 8192 surfaces on average even if it loses nothing, and the variance is finite: in a slab that scatters, the number of
 * paths falls exponentially with the depth, faster than the square of their weights rises. A constant probability would
 * raise weights exponentially, too: the variance would be infinite in milk of an optical thickness over 58. */
static inline double roulette_odds_most(int depth)
{
    return depth < 4096 ? 1.0 : 1.0 - 2.0 / depth;
}

/* A build without counters compiles the statement but never executes it. */
#define COUNT(statement) ((void)(CUVETTE_COUNTERS ? (statement) : 0))

static inline void map_cut(tracer *t, int64_t sample_key, double r, double g, double b)
{
    const int64_t units = counters_cut_units(r) + counters_cut_units(g) + counters_cut_units(b);
    t->target.pixel_cut[sample_key_pixel(sample_key)] += (double)units;
}

/* Counts a ray that is cut off, and its throughput, in *rays and sum: the counters of cuts by depth or by weight. */
static inline void count_cut(tracer *t, uint64_t *rays, int64_t sum[3], int64_t sample_key, double r, double g,
                             double b)
{
    COUNT(*rays += 1);
    COUNT(sum[0] += counters_cut_units(r));
    COUNT(sum[1] += counters_cut_units(g));
    COUNT(sum[2] += counters_cut_units(b));
    if (t->target.pixel_cut)
        map_cut(t, sample_key, r, g, b);
}

static inline void count_cut_by_depth(tracer *t, int64_t sample_key, double r, double g, double b)
{
    ray_counters *c = &t->account.counters;
    count_cut(t, &c->cut_depth, c->cut_depth_throughput, sample_key, r, g, b);
}

static inline void count_cut_by_weight(tracer *t, int64_t sample_key, double r, double g, double b)
{
    ray_counters *c = &t->account.counters;
    count_cut(t, &c->cut_weight, c->cut_weight_throughput, sample_key, r, g, b);
}
