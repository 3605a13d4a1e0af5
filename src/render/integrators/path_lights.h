/* Direct light of random paths: a shadow ray to a random point of each light with a size, or of one light chosen by its
 * estimated light (render/shade/light_choice.h). Functions of the tracer's gathered group; nothing fails. */
#pragma once

#include "render/shade/area_lights.h"

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

/* Enqueues a shadow ray from record k, in a medium of that index, to a lamp, which brings that share of light of colour
 * 1; or adds its light at once, from a point without shadows. */
void path_enqueue_lamp(tracer *t, int k, int lamp, vec3 to_lamp, double index, uint64_t inside, vec3 share);
