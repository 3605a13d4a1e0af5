/* The tracers of a frame (render/tracer/tracer.h): their memory, the order in which they trace batches, and the pool
 * that lends them to workers.
 *
 * A tracer traces one batch at a time, of the deepest queue that holds a full one, so that few rays wait whatever the
 * depth. Ownership: tracer_create allocates, tracer_destroy releases; plan and film are borrowed.
 *
 * Each tracer of a pool is lent to one worker at a time, the last returned first: its data is then still in the
 * processor's cache, and a thousand workers on few processors need no more tracers than run at once. Ownership:
 * tracer_pool_create allocates, tracer_pool_destroy releases; tracer_pool_acquire and tracer_pool_release may be called
 * from any thread. */
#pragma once

#include "base/counters.h"
#include "base/isa.h"
#include "base/worker_pool.h"
#include "render/frame/renderer.h"
#include "render/plan/plan.h"
#include "render/tracer/integrator.h"
#include <stdatomic.h>

/* Memory of a tracer with that depth limit, bytes; larger with crystals, and with footprints
 * (render/shade/footprints.h). */
uint64_t tracer_bytes(int64_t depth, bool crystals, bool footprints);
tracer *tracer_create(isa level);
void tracer_destroy(tracer *t);

/* Begins a frame: resets the counters and creates queues for the frame's depth. False when out of memory. */
bool tracer_begin(tracer *t, const tracer_target *target);

/* Makes the tracer, whose queues must be empty, write to another film until the frame ends. */
void tracer_expose_to(tracer *t, film *img);

/* Discards all rays that wait. */
void tracer_discard(tracer *t);

/* --- batches.c --- */

/* Enqueues the camera rays of a tile and traces as tracer_run_full does. Adds the number of pixels to *begun, row by
 * row of blocks. */
void tracer_render_tile(tracer *t, const image_tile *tile, atomic_uint_fast64_t *begun);

/* Traces until every queue holds less than a batch, and the queue of deep rays less than DEEP_AT_ONCE rays, unless
 * cancelled. */
void tracer_run_full(tracer *t);

/* Traces the remaining rays, or discards them when cancelled. All queues are empty afterwards. */
void tracer_finish(tracer *t);

/* Traces one batch of a queue (depth -1: shadow rays), and adds its time and rays to the pixels if requested. */
void tracer_run_batch(tracer *t, int depth);

/* Enqueues the camera rays of one pixel of an rgb film; returns their number. */
int tracer_camera_rays(tracer *t, int x, int y);

/* --- results of the frame so far --- */

const ray_counters *tracer_counters(const tracer *t);
/* Time spent in visibility queries (nearest hits and shadows). For a scene without meshes it is not measured, and 0:
 * reading the clock that often would cost too much. */
double tracer_visibility_s(const tracer *t);
/* True when a contribution or a pixel's sum left the film's range or was not a number. */
bool tracer_overflowed(const tracer *t);

/* --- the pool --- */

typedef struct tracer_pool tracer_pool;

tracer_pool *tracer_pool_create(isa level);
void tracer_pool_destroy(tracer_pool *pool);

isa tracer_pool_level(const tracer_pool *pool);

/* Begins a frame with `workers` workers, none of which holds a tracer. False when out of memory. */
bool tracer_pool_begin(tracer_pool *pool, int workers, const tracer_target *target);

/* Returns a tracer with empty queues, whose counters continue from its earlier tiles of the frame; NULL when out of
 * memory. */
tracer *tracer_pool_acquire(tracer_pool *pool);
void tracer_pool_release(tracer_pool *pool, tracer *t);

/* Sums the counters of the frame's tracers; call it after the frame. Returns true if one of them overflowed. */
bool tracer_pool_collect(const tracer_pool *pool, ray_counters *sum);

/* Internals of the renderer, used only in this folder. */

struct renderer {
    const topology *machine;
    worker_pool *threads;
    tracer_pool *tracers;
};

/* frame.c: renders into a result of render_result_create; state: the integrator's state for the frame. */
status frame_run(renderer *r, const scene *s, const render_options *options, plan *p, void *state,
                 render_result *result, diagnostic *why);

/* render_result.c: allocates a result. render_map_create returns a map of zeros whose pages exist, or NULL when out of
 * memory. */
status render_result_create(const scene *s, const render_options *options, render_result **out, diagnostic *why);
double *render_map_create(size_t pixels);
film_space render_film_space(const scene *s);
