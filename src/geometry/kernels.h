/* The kernels' parts, by instruction set; for src/geometry's own *_kernel.c files. */
#ifndef CUVETTE_GEOMETRY_KERNELS_H
#define CUVETTE_GEOMETRY_KERNELS_H

#include "base/kernel.h"
#include "geometry/rays.h"

/* scratch->in and out of every wanted primitive (a set) for every ray; scratch->slack is not touched. */
void KERNEL(intervals_of)(const arrangement *a, const ray_batch *rays, uint64_t wanted, ray_scratch *scratch);

void KERNEL(surface_points)(const primitive *p, const ray_batch *rays, const double *t, int bit, surface_batch *points);

#endif
