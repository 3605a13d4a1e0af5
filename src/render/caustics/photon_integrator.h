/* The integrator that traces photons, as a separate frame (render/tracer/integrator.h). */
#pragma once

#include "render/caustics/emission.h"
#include "render/photons/photon_map.h"
#include "render/tracer/integrator.h"

/* The state of the photons' frame. */
typedef struct photon_frame {
    const emission *from;
    atomic_int_fast64_t *arrived; /* photons at matte surfaces, by target */
    bool is_pilot;                /* a pilot only counts photons */
    atomic_bool out_of_memory;
} photon_frame;

extern const integrator integrator_of_photons;

/* Enqueues photons first .. end - 1 in the tracer's first queue, which must have room; found: the list to which
 * arriving photons are added from now on. */
void photon_integrator_emit(tracer *t, int64_t first, int64_t end, photon_list *found);
