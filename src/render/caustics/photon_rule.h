/* The rule by which photons are traced, as an integrator of its own frame (render/integrators/integrator.h). */
#pragma once

#include "render/caustics/emission.h"
#include "render/caustics/photon_map.h"
#include "render/integrators/integrator.h"

/* The greatest number of interfaces on a photon's path. In the wall of a glass vessel light is totally reflected dozens
 * of times before it leaves: of the rod's vessel a depth of 32 loses 0.9 % of all light, 64 loses 0.3 %. */
enum { PHOTON_DEPTH = COUNTERS_DEPTH_MAX };

/* The state of the photons' frame. */
typedef struct photon_frame {
    const emission *from;
    atomic_bool out_of_memory;
} photon_frame;

extern const integrator integrator_of_photons;

/* Enqueues photons first .. end - 1 in the tracer's first queue, which must have room; found: where those that arrive
 * are added from now on. */
void photon_rule_emit(tracer *t, int64_t first, int64_t end, photon_list *found);
