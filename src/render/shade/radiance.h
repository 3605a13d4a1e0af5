/* Basic radiance, of a plan that carries it (render.radiance). Ownership: radiance_begin gives the tracer its memory,
 * radiance_end frees it. */
#pragma once

#include "geometry/rays.h"
#include "render/core/tracer.h"

typedef struct radiance_work radiance_work;

bool radiance_begin(tracer *t); /* a frame; false when memory is out */
void radiance_end(tracer *t);

/* How much of what is sent out into the medium of a rank reaches an eye as radiance, (n_eye / n)^2. */
double radiance_share(const plan *p, int64_t sample_key, int priority_index);

/* The gathered group's throughput times that, and back again; nothing under classic radiance. */
void radiance_weigh(tracer *t);
void radiance_weigh_back(tracer *t);

/* The transmittances of the interfaces that a batch of shadow rays crosses, taken from t->batch.transmitted; nothing
 * under classic radiance. */
void radiance_begin_shadows(tracer *t, const ray_batch *rays, const int64_t *sample_keys);
void radiance_end_shadows(tracer *t);
