/* Direct light of lights with a size, spheres, discs and rectangles: a shadow ray from each ray of the gathered group
 * to a random point. A sphere is sampled uniformly over the cone of directions to it, a flat lamp over its area
 * (Shirley, Wang and Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations", TOG 15(1), 1996).
 *
 * The choice of one light for each ray, for random paths in a scene of several lights (render.light_sampling=one):
 * light k is chosen with a probability p_k that is proportional to an estimate of its light at the point, and what it
 * contributes is divided by p_k, so that the mean stays the same (the same, section 3). The estimate is Lambert's law
 * without shadows, and above 0 wherever the light can contribute. Functions of the gathered group; nothing fails. */
#pragma once

#include "render/shade/kernels.h"
#include "render/tracer/tracer.h"

bool light_has_area(const plan *p, int lamp);

/* Radiance of a light with a size towards a ray along a unit vector, for a colour of 1. For a cone light each point of
 * the sphere emits only into the cone, so that from far away it is the cone of a point. */
double area_light_radiance(const plan *p, int lamp, vec3 direction);

/* Distance at which a ray along a unit vector that passes near a light with a size hits it, a sphere from outside, a
 * flat lamp on the side that emits; or HUGE_VAL. */
double area_light_distance(const plan *p, int lamp, vec3 origin, vec3 direction);

/* The density, per solid angle, with which area_lights_sample would choose the direction to that point of the light. */
double area_light_density(const plan *p, int lamp, vec3 origin, vec3 direction, double distance);

/* The light's colour times its intensity; in a spectral film at the sample key's wavelength. */
vec3 light_color_of(const tracer *t, int lamp, int64_t sample_key);

/* Phong's highlight k_s (R.V)^n of the light along the unit vector `to`, whose cosine is n_l. */
double highlight_of(const group *g, int k, const material *m, vec3 to, double n_l);

/* Enqueues a shadow ray from record k to a lamp, which brings light of that colour as Phong's model reflects it:
 * diffuse times the surface's colour, and shine. */
void shadow_ray_enqueue(tracer *t, int k, int lamp, vec3 to_light, vec3 color, double diffuse, double shine);

/* Lights of the group's records, and points of those with a size. */
typedef struct lamp_samples {
    int lamp[ROW];          /* -1: none */
    double weight[ROW];     /* of its light */
    sphere_samples spheres; /* u and v are set by the caller; the rest is filled for spheres */
} lamp_samples;

/* Points of spheres by the random numbers of l->spheres; undefined for a record whose light is none or no sphere. */
void area_lights_aim_at_spheres(const tracer *t, lamp_samples *l);

/* From every record whose light has a size. shines: with highlights. */
void area_lights_sample(tracer *t, const material *m, bool shines, lamp_samples *l);

/* From every record to each light with a size. */
void area_lights_sample_all(tracer *t, const material *m, bool shines, int depth);

/* The same for ray trees and ray casting with soft shadows, whose local light leaves these lights out. */
void area_lights_soften(tracer *t, int depth);

/* --- the choice of one light --- */

/* Whether the frame chooses a light for each ray. */
static inline bool light_choice_applies(const plan *p)
{
    return p->render.light_sampling == LIGHT_SAMPLING_ONE && p->light_count > 1;
}

/* What the estimate assumes of a surface. */
typedef struct light_estimate {
    float k_d, k_s; /* fractions of the light with and without Lambert's cosine */
    double side;    /* 1: light of the ray's side; -1: of the other side; 0: from everywhere, without k_d */
    int purpose;    /* of the random numbers, sampling.h */
} light_estimate;

/* Of a matte surface with Phong's highlight. */
light_estimate light_estimate_of(const material *m);

/* For the gathered group: the light of each ray, -1 if none reaches the point; the weight 1 / p_k; and what the choice
 * left of the random numbers u and v: uniform, for a point of the light. */
void light_choice_make(const tracer *t, const light_estimate *by, int depth, int *lamp, double *weight, double *u,
                       double *v);
/* p_k of a light for ray i of the group. */
double light_choice_chance(const tracer *t, const light_estimate *by, int i, int lamp);
