/* The tracer pool of a renderer. Each tracer is lent to one worker at a time, the last returned first: its data is then
 * still in the processor's cache, and a thousand workers on few processors need no more tracers than run at once.
 * Ownership: tracer_pool_create allocates, tracer_pool_destroy releases; take and return may be called from any
 * thread. */
#pragma once

#include "render/core/tracer.h"

typedef struct tracer_pool tracer_pool;

tracer_pool *tracer_pool_create(isa level);
void tracer_pool_destroy(tracer_pool *set);

isa tracer_pool_level(const tracer_pool *set);

/* Begins a frame with `workers` workers, none of which holds a tracer. False when out of memory. */
bool tracer_pool_begin(tracer_pool *set, int workers, const tracer_target *target);

/* Returns a tracer with empty queues, whose counters are those of the frame so far; NULL when out of memory. */
tracer *tracer_pool_take(tracer_pool *set);
void tracer_pool_return(tracer_pool *set, tracer *t);

/* Sums the counters of the frame's tracers; call it after the frame. Returns true if one of them overflowed. */
bool tracer_pool_collect(const tracer_pool *set, ray_counters *sum);
