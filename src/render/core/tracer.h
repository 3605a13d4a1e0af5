/* One worker's tracer: queues of rays by depth, run a batch at a time, deepest full batch first, so that what waits
 * stays small whatever the depth; the film, the counters and the scratch it works on. There is no other tracer: a
 * single ray is a batch of one. Ownership: tracer_create gives, tracer_destroy releases; plan and film are borrowed. */
#pragma once

#include "base/counters.h"
#include "base/isa.h"
#include "render/core/film.h"
#include "render/core/layers.h"
#include "render/core/plan.h"
#include "render/core/schedule.h"
#include <stdatomic.h>

typedef struct tracer tracer;

/* What a frame is traced into. pixel_rays and pixel_ns may be NULL; kept is what the integrator keeps for the frame,
 * layers where it puts named layers if they are wanted; else NULL. */
typedef struct tracer_target {
    const plan *frame_plan;
    film *img;
    double *pixel_rays, *pixel_ns;
    void *kept;
    layer_set *layers;
} tracer_target;

tracer *tracer_create(isa level);
void tracer_destroy(tracer *t);

/* Begins a frame: counters to zero, queues for its depth. False when memory is out. */
bool tracer_begin(tracer *t, const tracer_target *target);

/* Puts the camera rays of a piece of the picture in line and traces until fewer than a batch of anything waits. Adds
 * the pixels of each row to *begun when they are in line. */
void tracer_span(tracer *t, const span *piece, atomic_uint_fast64_t *begun, const atomic_bool *stop);

/* Traces what still waits; when told to stop, drops it. Nothing waits afterwards. */
void tracer_finish(tracer *t, const atomic_bool *stop);

const ray_counters *tracer_counters(const tracer *t);
/* Time in which it was found out what rays meet and what stands in a light's way. Of a scene without meshes it is not
 * measured, and 0: there the clock would be asked too often. */
double tracer_visibility_s(const tracer *t);
/* Did a contribution or a pixel's sum leave the film's range, or was it not a number? */
bool tracer_overflowed(const tracer *t);
