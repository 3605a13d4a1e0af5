/* Absorption by the media that rays pass through, what they scatter (scattering.h), and what their sheets do
 * (sheets.h). Ownership: absorption_begin allocates the tracer's memory, absorption_end frees it. */
#pragma once

#include "base/lanes.h"
#include "render/core/queue.h"
#include "render/core/tracer.h"
#include "render/shade/scattering.h"
#include "render/shade/sheets.h"

typedef struct media_work {
    medium_segments segments;
    const int64_t *sample_keys;   /* of the batch whose medium segments are recorded */
    bool to_lamps;                /* they are shadow rays */
    double transmittance[3][ROW]; /* transmittance of the path to the hit, by channel */
    sheet_work sheets;
    flight_work flights;
} media_work;

/* Begins a frame; absorbs: some of its media absorb. False when out of memory. */
bool absorption_begin(tracer *t, bool absorbs);
void absorption_end(tracer *t);

/* absorption_announce: called before a batch of a queue is traced, turns on the recording of its medium segments.
 * absorption_exempt_sky: after a search for nearest interfaces, removes absorption by the surrounding medium from paths
 * to the sky; absorption_exempt_suns: likewise, from shadow rays to suns. absorption_dim: multiplies the batch's
 * throughput by the transmittance. */
void absorption_announce(tracer *t, const ray_queue *q, int first, int count);
void absorption_exempt_sky(tracer *t);
void absorption_exempt_suns(tracer *t);
void absorption_dim(tracer *t, ray_queue *q, int first, int count);

/* Coefficients of a priority index in 1 / scene unit, by channel; in a spectral film at the ray's wavelength. */
vec3 absorption_coefficients(const plan *p, int priority_index, int64_t sample_key);

/* exp(-d), Beer and Lambert's law. */
static inline double absorption_left(double optical_depth)
{
    const double log2_e = 1.4426950408889634074;
    return elementary_exp2_inline(-log2_e * optical_depth);
}
