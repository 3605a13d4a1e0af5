/* Footprints: how far apart the neighbours of a ray are, one sample of the image away, after flat and curved mirrors
 * and clear surfaces (Igehy, "Tracing Ray Differentials", SIGGRAPH 1999). They state how much of a matte surface a
 * sample covers, so that a caustic narrower than a pixel keeps its power (render/photons/photon_map.c). Only
 * integrators with a regular grid of rays per pixel use them; random rays need none. Ownership: footprints_begin
 * allocates the tracer's memory, footprints_end frees it. */
#pragma once

#include "render/photons/photon_map.h"
#include "render/tracer/tracer.h"

/* Footprints of the gathered group's rays at their hits, and of their children. */
typedef struct footprint_work {
    photon_footprint at[ROW];
    bool bent[ROW], rough_guess[ROW];
    bool ready;             /* `reflected` and `refracted` are computed for this group */
    int64_t primitive[ROW]; /* primitive that each ray hits */
    ray_footprint reflected[ROW], refracted[ROW];
} footprint_work;

/* Whether rays of these settings have footprints. */
bool footprints_are_followed(const render_settings *r);

bool footprints_begin(tracer *t); /* begins a frame; false when out of memory */
void footprints_end(tracer *t);

/* Sets the footprints of camera rays first .. first + count - 1 of the queue. */
void footprints_of_camera(tracer *t, ray_queue *q, int first, int count);
/* Computes the footprints of the gathered group, rays list[0 ..] of the batch at `first`; call it when the group's
 * points are known. */
void footprints_gather(tracer *t, const ray_queue *q, int first, const int *list);
/* Sets the footprints of the gathered group's children, rays first .. of the queue; list: their lanes in the group. */
void footprints_of_children(tracer *t, ray_queue *q, int first, bool reflected, const int *list, int count);
/* Sets the footprint of a child of ray k, at position `at` of the queue, as for an undeflected ray. */
void footprint_straight(tracer *t, ray_queue *q, int at, int k);

/* Irradiance over pi that ray k of the gathered group sees, from photons (photon_map.h). Adds undersampled light to the
 * tracer's counters; seen: the fraction of radiance that reaches the film. */
vec3 footprint_irradiance(tracer *t, int k, int wavelength, double seen);
