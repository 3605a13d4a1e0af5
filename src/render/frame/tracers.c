/* The memory of tracers, and the pool that lends them to workers. */
#include "render/frame/tracers.h"

#include "render/shade/footprints.h"
#include "render/shade/kernels.h"
#include "render/shade/media.h"
#include "render/shade/rough.h"
#include "render/shade/shading.h"
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* --- the table of integrators, from INTEGRATORS (scene/model/integrators.h) --- */

#define DECLARE(name, word, ...) extern const integrator integrator_of_##word;
INTEGRATORS(DECLARE)

const integrator *integrator_for(const render_settings *r)
{
#define ADDRESS(name, word, ...) &integrator_of_##word,
    static const integrator *const table[] = {INTEGRATORS(ADDRESS)};
    return table[r->integrator];
}
#undef DECLARE
#undef ADDRESS

tracer *tracer_create(isa level)
{
    static const geometry_kernels *const geometry[ISA_COUNT] = ISA_ARRAY(geometry_kernels);
    static const shade_kernels *const shade[ISA_COUNT] = ISA_ARRAY(shade_kernels);
    static const group_kernels *const grouping[ISA_COUNT] = ISA_ARRAY(group_kernels);
    static const sampling_kernels *const sampling[ISA_COUNT] = ISA_ARRAY(sampling_kernels);
    tracer *t = aligned_alloc(64, (sizeof(tracer) + 63) / 64 * 64);
    if (!t)
        return NULL;
    memset(t, 0, offsetof(tracer, batch));
    t->geometry = geometry[level];
    t->grouping = grouping[level];
    t->shade = shade[level];
    t->sampling = sampling[level];
    return t;
}

static void forget_integrator(tracer *t)
{
    if (t->frame_integrator && t->frame_integrator->end)
        t->frame_integrator->end(t->worker_data);
    t->worker_data = NULL;
}

void tracer_destroy(tracer *t)
{
    if (!t)
        return;
    for (int d = 0; d < t->queues.created; d++)
        queue_destroy(&t->queues.waiting[d]);
    free(t->queues.waiting);
    free(t->marks);
    absorption_end(t);
    mesh_end(t);
    radiance_end(t);
    layered_end(t);
    crystals_end(t);
    footprints_end(t);
    forget_integrator(t);
    queue_destroy(&t->queues.shadows);
    free(t);
}

/* A queue holds less than one waiting batch plus two children for every ray of a batch. With crystals there are four
 * children, and room for one more batch, because the two branches that they replace are appended with weight 0 and then
 * removed. */
enum { WAITING = 3 * BATCH + LANES_MAX, WAITING_CRYSTALS = (CRYSTAL_RAYS_MAX + 2) * BATCH + LANES_MAX };

static int waiting_of(bool crystals)
{
    return crystals ? WAITING_CRYSTALS : WAITING;
}

static int capacity_of(int queue, int depth_limit, bool crystals)
{
    return waiting_of(crystals) + (goes_deep(depth_limit) && queue >= DEPTH_DEEP ? DEEP_AT_ONCE : 0);
}

static int queue_count(int depth_limit)
{
    return (depth_limit < DEPTH_DEEP + 1 ? depth_limit : DEPTH_DEEP + 1) + 1;
}

uint64_t tracer_bytes(int64_t depth, bool crystals, bool footprints)
{
    uint64_t sum = sizeof(tracer) + (footprints ? sizeof(footprint_work) : 0);
    for (int i = 0; i < queue_count((int)depth); i++) {
        const int capacity = capacity_of(i, (int)depth, crystals);
        sum += queue_bytes(capacity) + (footprints ? (uint64_t)capacity * sizeof(ray_footprint) : 0);
    }
    return sum;
}

/* Queues that are large enough are kept. */
static bool make_queues(tracer *t, int depth_limit, bool crystals)
{
    const int count = queue_count(depth_limit);
    ray_queue *grown =
        count > t->queues.created ? realloc(t->queues.waiting, (size_t)count * sizeof *grown) : t->queues.waiting;
    if (!grown)
        return false;
    t->queues.waiting = grown;
    for (; t->queues.created < count; t->queues.created++)
        memset(&grown[t->queues.created], 0, sizeof *grown);
    for (int i = 0; i < count; i++) {
        const int capacity = capacity_of(i, depth_limit, crystals);
        if (grown[i].capacity >= capacity)
            continue;
        queue_destroy(&grown[i]);
        if (!queue_create(&grown[i], capacity))
            return false;
    }
    return true;
}

void tracer_discard(tracer *t)
{
    for (int d = 0; d < t->queues.created; d++)
        t->queues.waiting[d].count = 0;
    t->queues.shadows.count = 0;
}

static bool begin_integrator(tracer *t)
{
    const integrator *wanted =
        t->target.integrator_override ? t->target.integrator_override : integrator_for(&t->target.frame_plan->render);
    if (wanted != t->frame_integrator)
        forget_integrator(t);
    t->frame_integrator = wanted;
    return !wanted->begin || wanted->begin(t);
}

/* Allocates a mark for each primitive and each priority index: see group_kernels. */
static bool make_marks(tracer *t, const scene_geometry *g)
{
    const size_t count = (size_t)g->primitive_count + (size_t)g->region_count + 1;
    int16_t *grown = count > t->mark_count ? realloc(t->marks, count * sizeof *grown) : t->marks;
    if (!grown)
        return false;
    t->marks = grown;
    for (; t->mark_count < count; t->mark_count++)
        grown[t->mark_count] = -1;
    return true;
}

bool tracer_begin(tracer *t, const tracer_target *target)
{
    const plan *p = target->frame_plan;
    const render_settings *r = &p->render;
    t->target = *target;
    t->queues.depth_limit = (int)r->depth;
    /* In a spectral film each wavelength has a camera ray, with an equal fraction of the weight. */
    t->least_weight = r->spectrum == SPECTRUM_SPECTRAL ? r->min_weight / (double)r->wavelengths : r->min_weight;
    /* A batch waits; a rough surface samples each light up to three times, with energy compensation four times
     * (path_rough.c), a medium twice more. */
    const int shadows_at_once = BATCH * (1 + ((p->energy  ? 4
                                               : p->rough ? 3
                                                          : 1) +
                                              (p->scatter ? 2 : 0)) *
                                                 p->light_count);
    if (t->queues.shadows.capacity < shadows_at_once) {
        queue_destroy(&t->queues.shadows);
        if (!queue_create(&t->queues.shadows, shadows_at_once))
            return false;
    }
    cover_begin(t);
    if (!make_queues(t, t->queues.depth_limit, p->crystals != NULL) || !make_marks(t, p->geometry) || !mesh_begin(t) ||
        !radiance_begin(t) || !layered_begin(t) || !crystals_begin(t) || !footprints_begin(t) || !begin_integrator(t) ||
        !absorption_begin(t, p->geometry->attenuates && t->frame_integrator->traced))
        return false;
    t->by_sample_key = t->frame_integrator->needs_sample_number || r->spectrum == SPECTRUM_SPECTRAL || p->basic ||
                       scene_has_soft_shadows(r);
    tracer_discard(t);
    memset(&t->account.counters, 0, sizeof t->account.counters);
    t->account.visibility_ns = 0;
    t->account.overflow = 0;
    return true;
}

void tracer_expose_to(tracer *t, film *img)
{
    t->target.img = img;
}

const ray_counters *tracer_counters(const tracer *t)
{
    return &t->account.counters;
}

double tracer_visibility_s(const tracer *t)
{
    return 1e-9 * (double)t->account.visibility_ns;
}

bool tracer_overflowed(const tracer *t)
{
    return t->account.overflow < 0;
}

/* --- the pool --- */

struct tracer_pool {
    isa level;
    pthread_mutex_t lock;
    tracer **all, **idle; /* idle: a stack of the tracers that no worker has */
    int capacity, count, idle_count;
    tracer_target target;
    uint64_t frame; /* serial number; a tracer stores the one in which it last began */
};

tracer_pool *tracer_pool_create(isa level)
{
    tracer_pool *pool = calloc(1, sizeof *pool);
    if (!pool)
        return NULL;
    pool->level = level;
    pthread_mutex_init(&pool->lock, NULL);
    return pool;
}

void tracer_pool_destroy(tracer_pool *pool)
{
    if (!pool)
        return;
    for (int i = 0; i < pool->count; i++)
        tracer_destroy(pool->all[i]);
    free(pool->all);
    free(pool->idle);
    pthread_mutex_destroy(&pool->lock);
    free(pool);
}

isa tracer_pool_level(const tracer_pool *pool)
{
    return pool->level;
}

static bool reserve(tracer ***list, int count)
{
    tracer **grown = realloc(*list, (size_t)count * sizeof(tracer *));
    if (grown)
        *list = grown;
    return grown != NULL;
}

bool tracer_pool_begin(tracer_pool *pool, int workers, const tracer_target *target)
{
    if (workers > pool->capacity) {
        if (!reserve(&pool->all, workers) || !reserve(&pool->idle, workers))
            return false;
        pool->capacity = workers;
    }
    pool->target = *target;
    pool->frame++;
    return true;
}

tracer *tracer_pool_acquire(tracer_pool *pool)
{
    pthread_mutex_lock(&pool->lock);
    tracer *t = pool->idle_count > 0 ? pool->idle[--pool->idle_count] : NULL;
    if (!t && (t = tracer_create(pool->level)))
        pool->all[pool->count++] = t;
    pthread_mutex_unlock(&pool->lock);
    if (!t || t->account.frame == pool->frame)
        return t;
    if (!tracer_begin(t, &pool->target)) {
        tracer_pool_release(pool, t);
        return NULL;
    }
    t->account.frame = pool->frame;
    return t;
}

void tracer_pool_release(tracer_pool *pool, tracer *t)
{
    pthread_mutex_lock(&pool->lock);
    pool->idle[pool->idle_count++] = t;
    pthread_mutex_unlock(&pool->lock);
}

bool tracer_pool_collect(const tracer_pool *pool, ray_counters *sum)
{
    bool overflow = false;
    for (int i = 0; i < pool->count; i++) {
        if (pool->all[i]->account.frame != pool->frame)
            continue;
        ray_counters_add(sum, tracer_counters(pool->all[i]));
        overflow |= tracer_overflowed(pool->all[i]);
    }
    return overflow;
}
