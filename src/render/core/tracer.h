/* The tracer of one worker: queues of rays by depth, traced one batch at a time, deepest full batch first, so that few
 * rays wait whatever the depth; also the worker's counters and scratch memory. There is no other tracer: a single ray
 * is a batch of one. Ownership: tracer_create allocates, tracer_destroy releases; plan and film are borrowed. */
#pragma once

#include "base/counters.h"
#include "base/isa.h"
#include "render/core/film.h"
#include "render/core/layers.h"
#include "render/core/plan.h"
#include "render/core/schedule.h"
#include <stdatomic.h>

typedef struct tracer tracer;

/* The outputs of a frame. The maps may be NULL; pixel_cut receives the throughput of each pixel's rays that are not
 * traced, red + green + blue in units of 1/COUNTERS_CUT_ONE: integers, so that their order does not matter. state is
 * the integrator's state for the frame; layers receives named layers, NULL if they are not requested; rule: NULL for
 * the integrator of the plan's settings. */
typedef struct tracer_target {
    const plan *frame_plan;
    film *img;
    double *pixel_rays, *pixel_ns, *pixel_cut;
    void *state;
    layer_set *layers;
    const struct integrator *rule;
} tracer_target;

/* Memory of a tracer at that depth, bytes; larger where crystals are, and where rays have footprints
 * (render/shade/footprints.h). */
uint64_t tracer_bytes(int64_t depth, bool crystals, bool footprints);
tracer *tracer_create(isa level);
void tracer_destroy(tracer *t);

/* Begins a frame: resets the counters and creates queues for the frame's depth. False when out of memory. */
bool tracer_begin(tracer *t, const tracer_target *target);

/* Lets the tracer, whose queues are empty, write another film from now on, until the frame ends. */
void tracer_expose_to(tracer *t, film *img);

/* Enqueues the camera rays of a piece of the image and traces until every queue holds less than a batch. Adds the
 * pixels of each row to *begun when they are enqueued. */
void tracer_span(tracer *t, const span *piece, atomic_uint_fast64_t *begun);

/* Traces until every queue holds less than a batch, unless cancelled. */
void tracer_run_full(tracer *t);

/* Traces the remaining rays, or discards them when cancelled. All queues are empty afterwards. */
void tracer_finish(tracer *t);

const ray_counters *tracer_counters(const tracer *t);
/* Time spent in visibility queries (nearest hits and shadows). For a scene without meshes it is not measured, and 0:
 * reading the clock that often would cost too much. */
double tracer_visibility_s(const tracer *t);
/* True when a contribution or a pixel's sum left the film's range or was not a number. */
bool tracer_overflowed(const tracer *t);
