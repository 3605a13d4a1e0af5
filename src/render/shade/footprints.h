/* Footprints: how far apart the neighbours of a ray are, one sample of the image away, after flat and curved mirrors
 * and clear surfaces (Igehy, "Tracing Ray Differentials", SIGGRAPH 1999). They state how much of a matte surface a
 * sample stands for, so that photons' light narrower than a pixel keeps its power
 * (render/photons/photon_map.c). Only for integrators that send rays through a grid of points of each pixel;
 * random points need none. Ownership: footprints_begin allocates the tracer's memory, footprints_end frees it. */
#pragma once

#include "render/photons/photon_map.h"
#include "render/tracer/tracer.h"

/* Of the gathered group, at its hits. */
typedef struct footprint_work {
    photon_footprint at[ROW];
    bool bent[ROW], rough_guess[ROW];
    bool ready;             /* `reflected` and `refracted` are those of this group */
    int64_t primitive[ROW]; /* that each ray hits */
    ray_footprint reflected[ROW], refracted[ROW];
} footprint_work;

/* Whether rays of these settings have footprints. */
bool footprints_are_followed(const render_settings *r);

bool footprints_begin(tracer *t); /* begins a frame; false when out of memory */
void footprints_end(tracer *t);

/* Gives camera rays first .. first + count - 1 of the queue theirs. */
void footprints_of_camera(tracer *t, ray_queue *q, int first, int count);
/* Those of the gathered group, whose rays are list[0 ..] of the batch at `first`; call when its points are known. */
void footprints_gather(tracer *t, const ray_queue *q, int first, const int *list);
/* Gives the children of all rays of the gathered group, first .. of the queue, theirs. */
void footprints_of_children(tracer *t, ray_queue *q, int first, bool reflected);
/* Gives a child of ray k, at a place of the queue, that of a ray that goes straight on. */
void footprint_straight(tracer *t, ray_queue *q, int at, int k);

/* Irradiance over pi that ray k of the gathered group sees, from photons (photon_map.h); counts light that is
 * undersampled in the tracer's counters, where `seen` is the fraction of radiance that arrives in the film. */
vec3 footprint_irradiance(tracer *t, int k, int wavelength, double seen);
