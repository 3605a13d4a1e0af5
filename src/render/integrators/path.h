/* The parts of path tracing (path.c). Functions of the tracer's gathered group; nothing fails. */
#pragma once

#include "render/shade/kernels.h"
#include "render/shade/light_sampling.h"
#include "render/shade/rough.h"
#include "render/tracer/tracer.h"

/* --- path_rays.c: continuations of random paths, from surfaces and from points of scattering --- */

/* The continuation of a path: direction, throughput factor by channel, and media. */
typedef struct continuation {
    vec3 direction, factor;
    double q, u, v; /* with polarisation: the analyser's Stokes vector relative to its first element; 0: only the
                       intensity counts */
    uint64_t inside;
    bool refracted, matte;
    bool specular_bounce; /* a lamp that the next ray hits counts: no shadow ray sampled it */
} continuation;

/* Enqueues the continuations of a smooth surface in a frame without photons and polarisation, below the depth limit. */
void path_continue_all(tracer *t, int depth, continuations *c);
/* Enqueues the continuation of ray k, unless it ends by Russian roulette or at the depth limit. */
void path_continue(tracer *t, int k, int depth, continuation *c);

/* --- path_rays.c: direct light of random paths, a shadow ray to a random point of each light with a size, or of one
 * light chosen by its estimated light (render/shade/light_sampling.h) --- */

/* Adds the emission of the gathered group's surface, and enqueues shadow rays to lights. */
void path_sample_lights(tracer *t, int priority_index, int depth);

/* --- sampling of lamps that is weighted against the path's direction, for rough surfaces and media that scatter --- */

/* The light of record k's lamp, for a colour of 1, from its sample point. */
typedef struct lamp_aim {
    vec3 to; /* a unit vector */
    double distance;
    double light, density; /* radiance, and density per solid angle; for a point lamp, irradiance and 0 */
} lamp_aim;

/* Sets `lamp` for all records, with random points on it if it has a size. */
void path_lamp_samples(tracer *t, int lamp, int depth, lamp_samples *s);
/* Whether record k has a lamp, and is not within its sphere; call area_lights_aim_at_spheres first. */
bool path_lamp_is_outside(const plan *p, const lamp_samples *s, int k);
lamp_aim path_lamp_aim(const tracer *t, const lamp_samples *s, int k);
/* The radiance of a lamp with a size that a ray along a unit vector hits, and its distance; 0 if the ray misses. */
double path_lamp_ahead(const plan *p, int lamp, vec3 origin, vec3 direction, double *distance);

/* Enqueues a shadow ray from record k, in a medium of that index, to a lamp, with `factor` times the lamp's light; for
 * a point lamp without shadows, adds the light at once. */
void path_enqueue_lamp(tracer *t, int k, int lamp, vec3 to_lamp, double index, uint64_t inside, vec3 factor);

/* --- path_rough.c: rough surfaces --- */

/* The facet that a path meets, and the lamps' direct light. Each lamp is sampled twice, by a point on it and by the
 * path's direction if that hits the lamp; the two are weighted by the balance heuristic, so that lamps of any size have
 * little noise on surfaces of any roughness (Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo
 * Rendering", SIGGRAPH 1995, (15)). Both enqueue shadow rays; the continued path then ignores lamps. */

/* Weight of the matte branch at an opaque surface, relative to the mirror branch, whose weight is its reflectance. */
double path_matte_weight(const group *g, const material *m, int k);

/* Enqueues shadow rays to lamps, draws the paths' facets, and computes the branches there. */
void path_rough_begin(tracer *t, double alpha, bool opaque, int depth, rough_surface *r);

/* Applies the surface to the branch that was drawn at a facet; false if it ends there. */
bool path_rough_scatter(tracer *t, const rough_surface *r, int k, continuation *c);

/* --- path_scatter.c: media that scatter --- */

/* Where a flight ends (render/shade/media.h), the path continues by the phase function, and each lamp, or a chosen one,
 * is sampled: a lamp with a size by a point on it and by the path's direction, weighted as for rough surfaces; a point
 * lamp by its direction, and also along the ray (airlight), with the same weights. Like the shadow rays of surfaces,
 * these are not deflected by clear solids; they lose the light that is absorbed and scattered. */

/* hits.hit_primitive of a ray that scatters. */
enum { PATH_SCATTERED = -2 - SCENE_LIGHTS_MAX };

/* After the search for the nearest interfaces and lamps of a batch: samples lamps along its rays, and marks those that
 * scatter. */
void path_scatter_mark(tracer *t, ray_queue *q, int first, int count);
/* Scatters rays list[0 .. count - 1] of the batch, which are marked. */
void path_scatter(tracer *t, const ray_queue *q, int first, const int *list, int count);
