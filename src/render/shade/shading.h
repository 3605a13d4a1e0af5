/* What surfaces do with light, for integrators to choose from: each works on the tracer's gathered group, or on single
 * contributions to the film. */
#pragma once

#include "render/core/tracer_private.h"

/* Adds radiance to a ticket's pixel. Of a spectral film the three channels are one: radiance at the ticket's
 * wavelength. */
void shading_expose(tracer *t, int64_t sample_key, double r, double g, double b);

/* Adds what the sky sends along a direction, weighted; and what a branch that the depth limit cuts off brings:
 * render.beyond. */
void shading_expose_sky(tracer *t, int64_t sample_key, vec3 direction, double wr, double wg, double wb);
void shading_expose_at_depth_limit(tracer *t, int64_t sample_key, vec3 direction, double wr, double wg, double wb);

/* The nearest interfaces of a batch, and the sky behind rays without one, as most integrators have it. */
void meet_nearest(tracer *t, ray_queue *q, int first, int depth, const ray_batch *rays);
void background_sky(tracer *t, const ray_queue *q, int first, const int *list, int count);

/* Camera rays that see a pixel's samples, each at all of a spectral film's wavelengths. */
camera_sampling camera_samples(const render_settings *r);

/* Does no light pass the surface of that rank's body with the tracer's look? */
static inline bool surface_is_opaque(const tracer *t, int priority_index)
{
    return t->target.frame_plan->geometry->regions[priority_index].opaque ||
           t->surface.mat->surface.transparency == 0.0;
}

/* Terms of the light that a surface sends out by itself or gets from lamps. */
typedef struct light_terms {
    bool ambient, highlights;
    bool spheres; /* lamps that are spheres are taken for points at their centres */
} light_terms;
void local_light(tracer *t, int priority_index, light_terms terms);
/* The terms of Phong's sum that render.lighting wants. */
static inline light_terms light_terms_of(const render_settings *r)
{
    return (light_terms){.ambient = true, .highlights = r->lighting != LIGHTING_LAMBERT, .spheres = true};
}

/* Branches of the gathered group at a surface, directions and weights, with total reflections counted. */
void shading_branches(tracer *t, bool opaque);

/* Branches that the depth limit cuts off: counted, and given what lies beyond it. */
void cut_branches(tracer *t);

/* Puts a kind of children in line, with tickets as the gathered ones'. Returns how many there are. */
int put_children_in_line(tracer *t, int depth, const double *dx, const double *dy, const double *dz,
                         const double *weight, const uint64_t *inside);

/* Gathers rays list[0 .. count-1] of the batch at `first` in the queue of a depth, all of which met primitive `met` as
 * the surface of the body of that rank, colours them and hands them to the integrator, in parts that look alike. */
void shading_group(tracer *t, int depth, int first, int met, int priority_index, const int *list, int count);

/* texture_shading.c: the look's picture times the gathered group's colours. */
void texture_colors(tracer *t, const primitive *surface);

/* spectral.c: the gathered group's indices, colours and light at each ray's wavelength. */
void spectral_indices(tracer *t, const int *list);
void spectral_colors(tracer *t, int priority_index);
void spectral_light(tracer *t, int lamp);

/* polarised.c: the group's Stokes vectors, and what an interface makes of weights and vectors. */
void polarised_gather(tracer *t, const ray_queue *q, int first, const int *list);
void polarised_branches(tracer *t, const material *m, bool opaque);
