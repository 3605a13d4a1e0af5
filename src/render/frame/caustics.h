/* Caustics by photons (render.caustics: photons): before a frame, photons from the lamps are traced through mirrors and
 * clear solids to matte surfaces, by the same tracer that traces camera rays; then each matte surface that a camera ray
 * or path meets receives the irradiance of this photon map, in addition to direct light. Every solid blocks shadow
 * rays, because the photons supply the light through clear solids. Both branches of a photon at an interface are
 * followed; a branch below LEAST_PHOTON of the photon's power survives at random, with more power.
 *
 * The map is the same for any number of workers. Its only error besides noise is the width of the photons' discs.
 * Ownership: caustics_create allocates, caustics_destroy releases; the plan is borrowed, and refers to the map from
 * caustics_create's return on. */
#pragma once

#include "base/counters.h"
#include "base/isa.h"
#include "render/plan/plan.h"
#include "render/plan/schedule.h"

typedef struct caustics caustics;

/* For a plan with render.caustics set; *out is NULL if nothing can make a caustic. level: the kernels' instruction
 * set. */
status caustics_create(plan *p, isa level, int workers, caustics **out, diagnostic *why);
void caustics_destroy(caustics *c);

/* The steps before a frame, each by all workers at once (parallel) and then by one thread (serial, may be NULL). They
 * return early, with an incomplete map, once cancelled. */
typedef struct caustics_step {
    void (*parallel)(caustics *c, int worker);
    status (*serial)(caustics *c, diagnostic *why);
} caustics_step;
enum { CAUSTICS_STEPS = 3 };
extern const caustics_step caustics_steps[CAUSTICS_STEPS];

/* Adds the number of the photons' rays to counters->photon; call it after the steps. */
void caustics_count(const caustics *c, ray_counters *counters);

/* The solid with too few photons, if there is one; call it after the steps. */
photon_shortage caustics_find_shortage(const caustics *c);

/* Memory for a frame, bytes. */
uint64_t caustics_bytes(const render_settings *r);
