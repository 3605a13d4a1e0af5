/* Shading functions for integrators: each works on the tracer's gathered group, or on single contributions to the
 * film. */
#pragma once

#include "optics/mueller.h"
#include "render/core/tracer_private.h"

/* Adds radiance to a sample key's pixel. In a spectral film the three channels are equal: radiance at the sample key's
 * wavelength. */
void shading_expose(tracer *t, int64_t sample_key, double r, double g, double b);

/* The same for rays first .. first + count - 1 of a queue, with the shares of their radiance that arrive. */
void shading_expose_shares(tracer *t, const ray_queue *q, int first, int count, const double *share);

/* Adds the weighted sky radiance of a direction, or that of a branch that the depth limit cuts off (render.beyond). */
void shading_expose_sky(tracer *t, int64_t sample_key, vec3 direction, double wr, double wg, double wb);
void shading_expose_at_depth_limit(tracer *t, int64_t sample_key, vec3 direction, double wr, double wg, double wb);

/* The nearest interfaces of a batch, and the sky for rays that hit nothing: the defaults of most integrators. */
void intersect_nearest(tracer *t, ray_queue *q, int first, int depth, const ray_batch *rays);
void background_sky(tracer *t, const ray_queue *q, int first, const int *list, int count);

/* Camera rays for a pixel's samples, each at all of a spectral film's wavelengths. */
camera_sampling camera_samples(const render_settings *r);
/* The samples along one side of a pixel. */
int64_t samples_across(const render_settings *r);

/* True if the surface of the region with that priority index transmits no light with the tracer's current material. */
static inline bool surface_is_opaque(const tracer *t, int priority_index)
{
    return t->target.frame_plan->geometry->regions[priority_index].opaque ||
           t->surface.mat->surface.transparency == 0.0;
}

/* The terms of a surface's emission and direct light. */
typedef struct light_terms {
    bool ambient, highlights;
    bool as_points;     /* lights with a size are treated as points at their centres */
    bool emission_only; /* no light of the scene's lights */
} light_terms;
void local_light(tracer *t, int priority_index, light_terms terms);
/* The terms of Phong's model that render.lighting selects. */
static inline light_terms light_terms_of(const render_settings *r)
{
    return (light_terms){
        .ambient = true, .highlights = r->lighting != LIGHTING_LAMBERT, .as_points = !scene_has_soft_shadows(r)};
}

/* Computes directions and weights of the gathered group's branches at a surface, and counts total reflections. */
void shading_branches(tracer *t, bool opaque);
/* The same by the points' normals alone, which may be those of facets (rough.h), and without counting. */
void shading_branches_at_facets(tracer *t, bool opaque);

/* Whether the gathered group's surface is a metal's or has a film (layered.h). */
static inline bool surface_is_layered(const tracer *t)
{
    return t->layered && t->layered->surface;
}
/* Whether an opaque surface reflects rays. */
static inline bool surface_reflects(const tracer *t)
{
    return t->surface.mat->surface.reflectivity > 0.0 || surface_is_layered(t);
}

/* Counts the branches that the depth limit cuts off, and adds their fallback radiance (render.beyond). */
void cut_branches(tracer *t);

/* Enqueues children of one kind, with the sample keys of the gathered rays. Returns their number. */
int enqueue_children(tracer *t, int depth, const double *dx, const double *dy, const double *dz, const double *weight,
                     const uint64_t *inside);

/* Gathers the rays of groups that look alike, of the batch at `first` in the queue of a depth, computes their
 * colours and passes them to the integrator, split by shading material. */
void shading_groups(tracer *t, int depth, int first, const hit_group *groups, int count);

/* texture_shading.c: multiplies the gathered group's colours by the material's texture. */
void texture_colors(tracer *t, const primitive *surface);

/* spectral.c: the gathered group's refractive indices, colours and light at each ray's wavelength. */
void spectral_indices(tracer *t, const int *list);
void spectral_colors(tracer *t, int priority_index);
void spectral_light(tracer *t, int lamp);

/* polarised.c: gathers the group's Stokes vectors, and applies an interface to weights and vectors. */
void polarised_gather(tracer *t, const ray_queue *q, int first, const int *list);
void polarised_branches(tracer *t, const material *m, bool opaque);
/* Gives a shadow ray the Stokes vector of a branch of ray k along the same direction. */
void polarised_shadow(tracer *t, int k, bool refracted, int at);
/* The same for ray k at a layered surface, by what it reflects and transmits. */
void polarised_layered(tracer *t, int k, sp_response reflected, sp_response transmitted, double coating,
                       double transparency);
