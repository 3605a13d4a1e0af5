/* What the media that rays pass through do to light: absorption (Beer and Lambert: light falls by exp(-a d) over a
 * length d of a medium with absorption coefficient a), scattering, and what sheets do (polarisation.h).
 *
 * Scattering, for random paths: the free flights of a batch of rays. A ray that passes media of scattering coefficients
 * s_k over lengths d_k comes through with the probability exp(-sum s_k d_k); the others scatter where the sum reaches
 * -ln u of a random number u. So a ray's throughput falls by absorption alone, by channel, up to where it scatters.
 * Rays that do not fly, those to lights, lose what is scattered out of them.
 *
 * Airlight: light that a medium scatters out of a lamp's beam towards a ray. A free flight rarely ends within a narrow
 * beam. So for lamps that are points each ray has a further point, which is chosen by the lamp: in the part of the ray
 * that is in the lamp's cone and in the boxes around the media that scatter, with equal angles seen from the lamp
 * (Kulla and Fajardo, "Importance Sampling Techniques for Path Tracing in Participating Media", Computer Graphics Forum
 * 31, 2012, 4.1). The points and the ends of flights are weighted by the balance heuristic, so that the mean stays the
 * same, whatever the part covers.
 *
 * Ownership: absorption_begin allocates the tracer's memory, absorption_end frees it. */
#pragma once

#include "base/lanes.h"
#include "render/shade/polarisation.h"
#include "render/tracer/tracer.h"

/* Points along the batch's rays, for one lamp. */
typedef struct airlight {
    double at[ROW], density[ROW]; /* distance, infinite if there is none; density per length */
    int region[ROW];              /* priority index of the medium there, once the ray has reached it; 0 before */
    double depth[4][ROW];         /* optical depths up to there: absorption by channel, scattering */
    double passes[ROW];           /* the fraction that the sheets on the way leave of its light, which is unpolarised */
} airlight;

/* The flights of a batch. */
typedef struct flight_work {
    bool flies;           /* the batch's rays scatter; otherwise they lose what scatters */
    bool flying;          /* their interfaces are being searched */
    double u[ROW];        /* the fraction of light that scatters beyond the end of the flight */
    double left[ROW];     /* the optical depth, by scattering, up to there */
    double passed[ROW];   /* the length of a ray's path so far */
    double end[ROW];      /* where it scatters, infinite if it does not ... */
    int region[ROW];      /* ... and the priority index of the medium there */
    double depth[4][ROW]; /* as an airlight's, of the whole path so far */
    airlight lamps[AIRLIGHTS_MAX];
    sheet_work sheets; /* of the whole path so far */
} flight_work;

typedef struct media_work {
    medium_segments segments;
    const int64_t *sample_keys;   /* of the batch whose medium segments are recorded */
    bool to_lamps;                /* they are shadow rays */
    double transmittance[3][ROW]; /* transmittance of the path to the hit, by channel */
    sheet_work sheets;
    flight_work flights;
} media_work;

/* --- absorption --- */

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

/* exp(-d), Beer and Lambert's law. */
static inline double absorption_left(double optical_depth)
{
    const double log2_e = 1.4426950408889634074;
    return elementary_exp2_inline(-log2_e * optical_depth);
}

/* --- flights and airlight --- */

/* Before and after the search for the batch's interfaces. Afterwards the medium segments end where rays scatter, and
 * the flights and airlights are complete. */
void scattering_begin(tracer *t, const ray_queue *q, int first, int depth, int count);
void scattering_end(tracer *t);

/* The density, per length, with which a point at a distance on a ray along a unit vector is chosen for a lamp; 0 for
 * one that is not chosen along rays. */
double airlight_density(const plan *p, int lamp, vec3 origin, vec3 direction, double distance);
