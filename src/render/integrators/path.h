/* The parts of path tracing (path.c). Functions of the tracer's gathered group; nothing fails. */
#pragma once

#include "render/shade/light_sampling.h"
#include "render/shade/rough.h"
#include "render/tracer/tracer.h"

/* --- path_rays.c: how a random path goes on, from a surface or from a point where a medium scatters it --- */

/* The continuation of a path: direction, throughput factor by channel, and media. */
typedef struct continuation {
    vec3 direction, factor;
    double q, u, v; /* with polarisation: the analyser's Stokes vector relative to its first element; 0: only the
                       intensity counts */
    uint64_t inside;
    bool refracted, matte;
    bool specular_bounce; /* the path may hit lamps */
} continuation;

/* Enqueues the continuation of ray k, unless it ends by Russian roulette or at the depth limit. */
void path_continue(tracer *t, int k, int depth, continuation *c);

/* --- path_rays.c: direct light of random paths, a shadow ray to a random point of each light with a size, or of one
 * light chosen by its estimated light (render/shade/light_sampling.h) --- */

/* Adds the emission of the gathered group's surface, and enqueues shadow rays to lights. */
void path_sample_lights(tracer *t, int priority_index, int depth);

/* --- lamps that a path's own direction is weighed against: of rough surfaces, and of media that scatter --- */

/* The light of the lamp of record k: of colour 1, at its chosen point. */
typedef struct lamp_aim {
    vec3 to; /* a unit vector */
    double distance;
    double light, density; /* radiance, and density per solid angle; of a point its irradiance, and 0 */
} lamp_aim;

/* That lamp for all records, at random points of it if it has a size. */
void path_lamp_samples(tracer *t, int lamp, int depth, lamp_samples *s);
/* Whether record k has a lamp, and is not within its sphere; its spheres must be aimed at. */
bool path_lamp_is_outside(const plan *p, const lamp_samples *s, int k);
lamp_aim path_lamp_aim(const tracer *t, const lamp_samples *s, int k);
/* The radiance of a lamp with a size that a ray along a unit vector hits, and its distance; 0 if it does not. */
double path_lamp_ahead(const plan *p, int lamp, vec3 origin, vec3 direction, double *distance);

/* Enqueues a shadow ray from record k, in a medium of that index, to a lamp, which brings that factor of light of
 * colour 1; or adds its light at once, from a point without shadows. */
void path_enqueue_lamp(tracer *t, int k, int lamp, vec3 to_lamp, double index, uint64_t inside, vec3 factor);

/* --- path_rough.c: rough surfaces --- */

/* Which facet a path meets, and the lamps' direct light. Each lamp is sampled twice: a point of its sphere, and the
 * path's own direction, where that meets the sphere; the two are weighted by the balance heuristic, so that lamps of
 * any size have little noise on surfaces of any roughness (Veach and Guibas, "Optimally Combining Sampling Techniques
 * for Monte Carlo Rendering", SIGGRAPH 1995, (15)). Both send shadow rays; the path itself then does not hit a lamp. */

/* Weight of the matte branch at an opaque surface, next to that of its mirror. */
double path_matte_weight(const group *g, const material *m, int k);

/* Enqueues shadow rays to lamps, draws the paths' facets, and computes the branches there. */
void path_rough_begin(tracer *t, double alpha, bool opaque, int depth, rough_surface *r);

/* Applies the surface to the branch that was drawn at a facet; false if it ends there. */
bool path_rough_scatter(tracer *t, const rough_surface *r, int k, continuation *c);

/* --- path_scatter.c: media that scatter --- */

/* Where a flight ends (render/shade/media.h), the path goes on by the phase function, and each lamp, or one that is
 * chosen, is sampled: a lamp with a size by a point of it and by the path's own direction, weighted as for rough
 * surfaces; a point by its direction. A point's light is also sampled along the ray (airlight), with the same weights.
 * Shadow rays go straight through clear solids, as those of surfaces do, and lose what is absorbed and scattered on
 * their way. */

/* hits.hit_primitive of a ray that scatters. */
enum { PATH_SCATTERED = -2 - SCENE_LIGHTS_MAX };

/* After the search for the nearest interfaces and lamps of a batch: samples lamps along its rays, and marks those that
 * scatter. */
void path_scatter_mark(tracer *t, const ray_queue *q, int first, int count);
/* Scatters rays list[0 .. count - 1] of the batch, which are marked. */
void path_scatter(tracer *t, const ray_queue *q, int first, const int *list, int count);
