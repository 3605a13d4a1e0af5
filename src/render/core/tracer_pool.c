/* Lending of tracers to workers. */
#include "render/core/tracer_pool.h"

#include "render/core/tracer_private.h"
#include <pthread.h>
#include <stdlib.h>

struct tracer_pool {
    isa level;
    pthread_mutex_t lock;
    tracer **all, **idle; /* idle: a stack of those that no worker holds */
    int capacity, count, idle_count;
    tracer_target target;
    uint64_t frame; /* serial number; a tracer stores the one in which it last began */
};

tracer_pool *tracer_pool_create(isa level)
{
    tracer_pool *set = calloc(1, sizeof *set);
    if (!set)
        return NULL;
    set->level = level;
    pthread_mutex_init(&set->lock, NULL);
    return set;
}

void tracer_pool_destroy(tracer_pool *set)
{
    if (!set)
        return;
    for (int i = 0; i < set->count; i++)
        tracer_destroy(set->all[i]);
    free(set->all);
    free(set->idle);
    pthread_mutex_destroy(&set->lock);
    free(set);
}

isa tracer_pool_level(const tracer_pool *set)
{
    return set->level;
}

static bool reserve(tracer ***list, int count)
{
    tracer **grown = realloc(*list, (size_t)count * sizeof(tracer *));
    if (grown)
        *list = grown;
    return grown != NULL;
}

bool tracer_pool_begin(tracer_pool *set, int workers, const tracer_target *target)
{
    if (workers > set->capacity) {
        if (!reserve(&set->all, workers) || !reserve(&set->idle, workers))
            return false;
        set->capacity = workers;
    }
    set->target = *target;
    set->frame++;
    return true;
}

tracer *tracer_pool_take(tracer_pool *set)
{
    pthread_mutex_lock(&set->lock);
    tracer *t = set->idle_count > 0 ? set->idle[--set->idle_count] : NULL;
    if (!t && (t = tracer_create(set->level)))
        set->all[set->count++] = t;
    pthread_mutex_unlock(&set->lock);
    if (!t || t->account.frame == set->frame)
        return t;
    if (!tracer_begin(t, &set->target)) {
        tracer_pool_return(set, t);
        return NULL;
    }
    t->account.frame = set->frame;
    return t;
}

void tracer_pool_return(tracer_pool *set, tracer *t)
{
    pthread_mutex_lock(&set->lock);
    set->idle[set->idle_count++] = t;
    pthread_mutex_unlock(&set->lock);
}

bool tracer_pool_collect(const tracer_pool *set, ray_counters *sum)
{
    bool overflow = false;
    for (int i = 0; i < set->count; i++) {
        if (set->all[i]->account.frame != set->frame)
            continue;
        ray_counters_add(sum, tracer_counters(set->all[i]));
        overflow |= tracer_overflowed(set->all[i]);
    }
    return overflow;
}
