/* Direct light of lights with a size, spheres, discs and rectangles: a shadow ray from each ray of the gathered group
 * to a random point. A sphere is sampled uniformly over the cone of directions to it, a flat lamp over its area
 * (Shirley, Wang and Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations", TOG 15(1), 1996).
 *
 * The choice of one light for each ray, for random paths in a scene of several lights (render.light_sampling=one):
 * light k is chosen with a probability p_k that is proportional to an estimate of its light at the point, and its
 * contribution is divided by p_k, so that the mean stays the same (same paper, section 3). The estimate is Lambert's
 * law without shadows, and above 0 wherever the light can contribute. Functions of the gathered group; nothing
 * fails. */
#pragma once

#include "render/shade/kernels.h"
#include "render/tracer/tracer.h"

bool light_has_area(const plan *p, int lamp);

/* Radiance of a light with a size towards a ray along a unit vector, for a colour of 1. Each point of a cone light's
 * sphere emits only into the cone, so that from far away it resembles a point light. */
double area_light_radiance(const plan *p, int lamp, vec3 direction);

/* Distance at which a ray along a unit vector hits a light with a size, a sphere from outside or a flat lamp on the
 * side that emits; HUGE_VAL if it misses. */
double area_light_distance(const plan *p, int lamp, vec3 origin, vec3 direction);

/* The density, per solid angle, with which area_lights_sample chooses this direction, in which the light is at
 * `distance`. */
double area_light_density(const plan *p, int lamp, vec3 origin, vec3 direction, double distance);

/* The light's colour times its intensity; in a spectral film at the sample key's wavelength. */
vec3 light_color_of(const tracer *t, int lamp, int64_t sample_key);

/* Phong's highlight k_s (R.V)^n of the light along the unit vector `to`, at the cosine n_l to the normal. */
double highlight_of(const group *g, int k, const material *m, vec3 to, double n_l);

/* Enqueues a shadow ray from record k to a lamp with light of `color`. The surface reflects the fraction diffuse * (its
 * colour) + shine. */
void shadow_ray_enqueue(tracer *t, int k, int lamp, vec3 to_light, vec3 color, double diffuse, double shine);

/* The light chosen for each record of the group, and a sample point on it if it has a size. */
typedef struct lamp_samples {
    int lamp[ROW];          /* -1: none */
    double weight[ROW];     /* factor of the light's contribution */
    sphere_samples spheres; /* u and v are set by the caller; the rest is filled for spheres */
} lamp_samples;

/* Sets the sample points on spheres from the random numbers in l->spheres; undefined for records without a sphere. */
void area_lights_aim_at_spheres(const tracer *t, lamp_samples *l);

/* Enqueues a shadow ray from every record whose light has a size. shines: with highlights. */
void area_lights_sample(tracer *t, const material *m, bool shines, lamp_samples *l);

/* Enqueues shadow rays from every record to each light with a size. */
void area_lights_sample_all(tracer *t, const material *m, bool shines, int depth);

/* area_lights_sample_all for ray trees and ray casting with soft shadows, whose local_light omits lights with a
 * size. */
void area_lights_soften(tracer *t, int depth);

/* --- the choice of one light --- */

/* Whether the frame chooses a light for each ray. */
static inline bool light_choice_applies(const plan *p)
{
    return p->render.light_sampling == LIGHT_SAMPLING_ONE && p->light_count > 1;
}

/* The reflection that the estimate assumes. */
typedef struct light_estimate {
    float k_d, k_s; /* fractions of the light with and without Lambert's cosine */
    double side;    /* 1: lights on the ray's side; -1: on the other side; 0: on both, without k_d */
    int purpose;    /* of the random numbers: DRAW_... of sampling.h */
} light_estimate;

/* The estimate for a matte surface with Phong's highlight. */
light_estimate light_estimate_of(const material *m);

/* Chooses a light for each ray of the gathered group, -1 if none reaches the point; weight: 1 / p_k; u, v: random
 * numbers that remain uniform after the choice, for a point on the light. */
void light_choice_make(const tracer *t, const light_estimate *by, int depth, int *lamp, double *weight, double *u,
                       double *v);
/* The probability p_k of a light for ray i of the group. */
double light_choice_chance(const tracer *t, const light_estimate *by, int i, int lamp);
