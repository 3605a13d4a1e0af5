/* Direct light of random paths: a shadow ray to a random point of each light's sphere, or of one light chosen by its
 * estimated light (render/shade/light_choice.h). Functions of the tracer's gathered group; nothing fails. */
#pragma once

#include "render/shade/path_kernels.h"
#include "render/shade/shading.h"

/* Radiance of a light's sphere towards a ray along a unit vector, for a colour of 1. For a cone light each point of the
 * sphere emits only into the cone, so that from far away it is the cone of a point. */
double path_light_radiance(const plan *p, int lamp, vec3 direction);

/* Distance at which a ray near a light's sphere hits it from outside, or HUGE_VAL. */
double path_light_distance(const light *l, vec3 origin, vec3 direction);

/* The light's colour times its intensity; in a spectral film at the sample key's wavelength. */
vec3 path_light_color(const tracer *t, int lamp, int64_t sample_key);

/* Adds the emission of the gathered group's surface, and enqueues shadow rays to lights. */
void path_sample_lights(tracer *t, int priority_index, int depth);

/* Lights of the group's records, and points of those that are spheres. */
typedef struct lamp_samples {
    int lamp[ROW];      /* -1: none */
    double weight[ROW]; /* of its light */
    sphere_samples spheres;
} lamp_samples;

/* The points, by the random numbers of l->spheres; undefined for a record whose light is none or no sphere. */
void path_aim_at_spheres(const tracer *t, lamp_samples *l);
