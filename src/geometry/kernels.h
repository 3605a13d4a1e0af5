/* The kernels' parts, by instruction set; for src/geometry's own *_kernel.c files. */
#ifndef CUVETTE_GEOMETRY_KERNELS_H
#define CUVETTE_GEOMETRY_KERNELS_H

#include "base/kernel.h"
#include "geometry/rays.h"

/* scratch->in and out of every wanted primitive (a set) for every ray; scratch->slack is not touched. */
void KERNEL(intervals_of)(const arrangement *a, const ray_batch *rays, uint64_t wanted, ray_scratch *scratch);

void KERNEL(surface_points)(const primitive *p, const ray_batch *rays, const double *t, int bit, surface_batch *points);

/* Share of the distance and of the arrangement's extent within which a second boundary is looked at closely. It changes no
 * result: it only must be wider than the error bounds, which it is unless a ray grazes within 2e-7 rad. */
#define BOUNDARY_CLOSE 0x1p-24

/* The next crossings of meshes, where they come before those that c has, for the first n columns; then the meshes' bits in
 * c's sets, when those of the others are there. */
void KERNEL(mesh_changes)(const arrangement *a, const ray_batch *rays, int n, ray_scratch *s, hit_batch *c, forest_hit *hits);
void KERNEL(mesh_sets)(const arrangement *a, const ray_batch *rays, int n, ray_scratch *s, hit_batch *c, const forest_hit *hits);

/* The meshes' bits in the sets just before low and just behind high, between which column k, in the medium of that rank, crosses something. */
void KERNEL(mesh_sets_closely)(const arrangement *a, const ray_batch *rays, int k, const ray_scratch *s, int64_t rank, double low, double high,
                               uint64_t *before, uint64_t *after);

/* Where column k crosses the mesh of a bit in low <= t <= high, from the set `before`; its face is FACE_NONE where it does not. */
forest_hit KERNEL(mesh_hit_between)(const arrangement *a, const ray_batch *rays, int k, const ray_scratch *s, int bit, uint64_t before, double low,
                                    double high);

/* Marks the shadow rays (but settled ones) that meshes of a set are in the way of. */
void KERNEL(mesh_shadows)(const arrangement *a, const ray_batch *rays, uint64_t wanted, int64_t *marked, const int64_t *settled);

#endif
