/* Basic radiance (L / n^2), for a plan whose rays carry it (render.radiance). Ownership: radiance_begin allocates the
 * tracer's memory, radiance_end frees it. */
#pragma once

#include "geometry/rays.h"
#include "render/tracer/tracer.h"

typedef struct radiance_work radiance_work;

bool radiance_begin(tracer *t); /* begins a frame; false when out of memory */
void radiance_end(tracer *t);

/* The factor of radiance emitted in the medium of a priority index, as the camera receives it, (n_eye / n)^2. */
double radiance_scale(const plan *p, int64_t sample_key, int priority_index);
/* radiance_scale for a medium of that index; 1 with classic radiance. */
double radiance_scale_at_index(const plan *p, int64_t sample_key, double index);

/* Multiply the gathered group's throughput by radiance_scale, and restore it; no effect with classic radiance. */
void radiance_weigh(tracer *t);
void radiance_weigh_back(tracer *t);

/* Multiply t->batch.transmitted by the transmittances of the interfaces that a batch of shadow rays crosses; call them
 * before and after its search. No effect with classic radiance. */
void radiance_begin_shadows(tracer *t, const ray_batch *rays, const int64_t *sample_keys);
void radiance_end_shadows(tracer *t);
