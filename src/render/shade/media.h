/* The effects of media on light: absorption (Beer-Lambert law: light falls by exp(-a d) over a length d of a medium
 * with absorption coefficient a), scattering, and polarising sheets (polarisation.h).
 *
 * Scattering, for random paths: the free flights of a batch of rays. A ray that passes media of scattering coefficients
 * s_k over lengths d_k is not scattered with the probability exp(-sum s_k d_k); otherwise it scatters where the sum
 * reaches -ln u for a random number u. So a ray's throughput falls only by absorption, by channel, up to this point.
 * Shadow rays have no free flights; they lose the light that is scattered out of them. In a spectral film s_k is that
 * at the ray's wavelength. In an RGB film whose media scatter the channels differently, a ray flies by the coefficient
 * of a random channel, and each channel's throughput is multiplied by its own density of flights over the mean of the
 * three densities, which no channel's weight exceeds by more than 3 (the balance heuristic; Veach, "Robust Monte Carlo
 * Methods for Light Transport Simulation", 1997, 9.2.2).
 *
 * Airlight: light of a lamp that a medium scatters towards the start of a ray. A free flight rarely ends within a
 * narrow cone of light. So for each point lamp a ray has a further sample point, in its interval within the lamp's cone
 * and the boxes around media that scatter, uniform in the angle at the lamp (Kulla and Fajardo, "Importance Sampling
 * Techniques for Path Tracing in Participating Media", Computer Graphics Forum 31, 2012, 4.1). The points and the ends
 * of flights are weighted by the balance heuristic, so that the mean does not depend on the interval.
 *
 * Ownership: absorption_begin allocates the tracer's memory, absorption_end frees it. */
#pragma once

#include "base/lanes.h"
#include "render/shade/polarisation.h"
#include "render/tracer/tracer.h"

enum { MEDIA_DEPTHS = 6 };

/* Sample points of airlight, one on each ray of the batch, for one lamp. */
typedef struct airlight {
    double at[ROW], density[ROW]; /* distance, infinite if there is none; density per length */
    int region[ROW]; /* priority index of the medium at the point, once the ray's segments reach it; 0 before */
    double depth[MEDIA_DEPTHS][ROW]; /* optical depths up to the point: absorption by channel, then scattering */
    double sheet_transmittance
        [ROW]; /* the fraction of the point's unpolarised light that sheets in front of it transmit */
} airlight;

/* The flights of a batch. */
typedef struct flight_work {
    bool flies;         /* the batch's rays have free flights; otherwise they lose the scattered light */
    bool flying;        /* the search for the interfaces of these rays has not ended */
    double u[ROW];      /* random number: the fraction of light that does not scatter before the end of the flight */
    double left[ROW];   /* the optical depth, by scattering, that remains up to this end */
    double passed[ROW]; /* the length of a ray's path so far */
    double end[ROW];    /* distance at which it scatters, infinite if it does not ... */
    int region[ROW];    /* ... and the priority index of the medium there */
    double depth[MEDIA_DEPTHS][ROW]; /* optical depths of the path so far, as in airlight */
    int channel[ROW];                /* whose coefficients the flight has */
    double density[ROW];             /* of the flight's end, per length; the mean over the channels */
    double weight[3][ROW];           /* of each channel, for scatter_plan.by_channel */
    airlight lamps[AIRLIGHTS_MAX];
    sheet_work sheets; /* of the path so far */
} flight_work;

typedef struct media_work {
    medium_segments segments;
    const int64_t *sample_keys;   /* of the batch whose medium segments are recorded */
    bool to_lamps;                /* the batch consists of shadow rays */
    bool dims;                    /* some of its rays pass through a medium that attenuates */
    double transmittance[3][ROW]; /* transmittance of the path to the hit, by channel */
    sheet_work sheets;
    flight_work flights;
} media_work;

/* --- absorption --- */

/* Begins a frame; absorbs: some of its media absorb, scatter or are sheets. False when out of memory. */
bool absorption_begin(tracer *t, bool absorbs);
void absorption_end(tracer *t);

/* absorption_announce: called before the search for a batch's interfaces, turns on the recording of its medium
 * segments. absorption_exempt_sky: after a search for nearest interfaces, removes absorption by the surrounding medium
 * from paths to the sky; absorption_exempt_suns: likewise, from shadow rays to suns. absorption_dim: multiplies the
 * batch's throughput by the transmittance. */
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

/* Call these before and after the search for the batch's interfaces. Afterwards the medium segments end where rays
 * scatter, and the flights and airlights are complete. */
void scattering_begin(tracer *t, const ray_queue *q, int first, int depth, int count);
void scattering_end(tracer *t);
/* Multiplies the throughput of the batch's rays by the weights of their flights, by channel; after all airlight. */
void scattering_weigh(tracer *t, ray_queue *q, int first, int count);

/* The density, per length, with which the point at `distance` on a ray along a unit vector is chosen for a lamp; 0 for
 * a lamp without airlight points. */
double airlight_density(const plan *p, int lamp, vec3 origin, vec3 direction, double distance);
/* The density, per length, of free flights that end at ray i's point: by channel, and their mean. */
double airlight_flights(const tracer *t, const airlight *l, int i, double by_channel[3]);
