/* The kernels' parts, by instruction set; for src/geometry's own *_kernel.c files. */
#pragma once

#include "base/kernel.h"
#include "geometry/instance_set.h"
#include "geometry/rays.h"
#include <math.h>

/* scratch->in and out of every wanted primitive (a set) for every ray; scratch->slack is not touched. */
void KERNEL(intervals_of)(const scene_geometry *a, const ray_batch *rays, uint64_t wanted, ray_scratch *scratch);

/* A share of the distance and of the scene geometry's extent: boundaries within it of a crossing are compared with the
 * crossing one by one (contact_kernel.c). It filters and decides nothing: a contact is never wider than half of it. */
#define BOUNDARY_CLOSE 0x1p-24

/* A primitive of a mesh? */
static inline bool is_mesh(const scene_geometry *a, int p)
{
    return a->meshes && (a->meshes->primitives >> p & 1);
}

/* What a scene unit is along ray i, in its t: 1 for a ray that looks for its nearest interface. */
static inline double steps_per_unit(const ray_batch *rays, int i)
{
    return 1.0 / sqrt(rays->dx[i] * rays->dx[i] + rays->dy[i] * rays->dy[i] + rays->dz[i] * rays->dz[i]);
}

/* --- contact_kernel.c --- */

/* Decides which boundaries of s->near[k] are in contact with column k's crossing; sets and ranks on both sides follow.
 */
void KERNEL(merge_contacts)(const scene_geometry *a, const ray_batch *rays, int k, ray_scratch *s, hit_batch *c,
                            instance_hit *mesh_hits);

/* --- mesh_changes_kernel.c --- */

/* The next crossings of meshes, where they come before those that c has, for the first n columns; then the meshes' bits
 * in c's sets and in s->near, when those of the others are there. */
void KERNEL(mesh_changes)(const scene_geometry *a, const ray_batch *rays, int n, ray_scratch *s, hit_batch *c,
                          instance_hit *hits);
void KERNEL(mesh_sets)(const scene_geometry *a, const ray_batch *rays, int n, ray_scratch *s, hit_batch *c,
                       const instance_hit *hits);

/* The bits of the wanted meshes in the sets just before low and just behind high, between which column k, in the medium
 * of that rank, crosses something. */
void KERNEL(mesh_sets_closely)(const scene_geometry *a, const ray_batch *rays, int k, const ray_scratch *s,
                               int64_t priority_index, uint64_t wanted, double low, double high, uint64_t *before,
                               uint64_t *after);

/* Calls found for the crossings of mesh p that are close to t on column k (BOUNDARY_CLOSE), whatever hides them. */
void KERNEL(mesh_each_near)(const scene_geometry *a, const ray_batch *rays, int k, const ray_scratch *s, int p,
                            double t, instance_found *found, void *context);

/* Where column k crosses the mesh of a bit in low <= t <= high, from the set `before`; its face is FACE_NONE where it
 * does not. */
instance_hit KERNEL(mesh_hit_between)(const scene_geometry *a, const ray_batch *rays, int k, const ray_scratch *s,
                                      int bit, uint64_t before, double low, double high);

/* Marks the shadow rays (but settled ones) that meshes of a set are in the way of. */
void KERNEL(mesh_shadows)(const scene_geometry *a, const ray_batch *rays, uint64_t wanted, int64_t *marked,
                          const int64_t *settled);
