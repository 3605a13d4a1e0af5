/* The tracers of a renderer. Each is lent to one worker at a time, the last one given back first: what it works on is
 * then still in that processor's cache, and a thousand workers on few processors need no more tracers than run at once.
 * Ownership: tracer_pool_create gives, tracer_pool_destroy releases; take and give may be called from any thread. */
#pragma once

#include "render/core/tracer.h"

typedef struct tracer_pool tracer_pool;

tracer_pool *tracer_pool_create(isa level);
void tracer_pool_destroy(tracer_pool *set);

/* Begins a frame with so many workers, none of which holds a tracer yet. False when memory is out. */
bool tracer_pool_begin(tracer_pool *set, int workers, const tracer_target *target);

/* A tracer with nothing in its queues, its counters those of the frame so far; NULL when memory is out. */
tracer *tracer_pool_take(tracer_pool *set);
void tracer_pool_return(tracer_pool *set, tracer *t);

/* After the frame: adds up what its tracers counted; true if one of them overflowed. */
bool tracer_pool_collect(const tracer_pool *set, ray_counters *sum);
