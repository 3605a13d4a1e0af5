/* Functions that the geometry kernels share, by instruction set; private to those kernels. */
#pragma once

#include "base/isa.h"
#include "base/lanes.h"
#include "geometry/primitives/primitive.h"
#include "geometry/rays.h"
#include "geometry/regions/instance_set.h"
#include "geometry/regions/solid_tree.h"
#include <math.h>

/* Fills scratch->in and out of every wanted primitive (a set) for every ray; leaves scratch->slack unchanged. */
void KERNEL(intervals_of)(const scene_geometry *g, const ray_batch *rays, uint64_t wanted, ray_scratch *scratch);

/* A fraction of the distance and of the scene geometry's extent: boundaries within it of a crossing are compared with
 * the crossing one by one (contact_kernel.c). It is only a filter: a contact is never wider than half of it. */
#define BOUNDARY_CLOSE 0x1p-24

/* A crossing beyond this distance counts as infinite: see primitives/primitive.h. */
#define NEVER 1e120

/* Returns whether the primitive is a mesh. */
static inline bool is_mesh(const scene_geometry *g, int p)
{
    return g->meshes && p < PRIMITIVES_MAX && (g->meshes->primitives >> p & 1);
}

/* The bit of a direct primitive; 0 for one of the solid tree. */
static inline uint64_t direct_bit(const scene_geometry *g, int64_t p)
{
    return p < g->direct_count ? (uint64_t)1 << p : 0;
}

/* Advances the intervals of one primitive past t: finished intervals are replaced by the next ones. inside: whether the
 * ray is in the primitive there. */
static inline void intervals_advance(interval *found, int count, bool inside, double t)
{
    int spent = 0;
    while (spent < count && (inside ? found[spent].out : found[spent].in) <= t)
        spent++;
    const bool leaves_now = inside && spent == count;
    for (int j = 0; j < count; j++)
        found[j] = j + spent < count ? found[j + spent] : (interval){HUGE_VAL, -HUGE_VAL};
    if (inside)
        found[0].in = -HUGE_VAL;
    if (leaves_now)
        found[0].out = t;
}

/* The length of a scene unit along ray i, in units of its t: 1 for a ray that looks for its nearest interface. */
static inline double steps_per_unit(const ray_batch *rays, int i)
{
    return 1.0 / sqrt(rays->dx[i] * rays->dx[i] + rays->dy[i] * rays->dy[i] + rays->dz[i] * rays->dz[i]);
}

/* --- one region, from the intervals of its primitives ahead of a ray ---
 *
 * For the pass over the direct primitives and for the solid tree: the next change of medium by the region, and its
 * overlap with a shadow ray. No branches. */

typedef struct next_change {
    double t;
    int64_t through_hollow; /* the boundary is the hollow's */
} next_change;

/* A region without a hollow: its exit if the ray is within, otherwise its entry. */
ALWAYS_INLINE double next_of_convex(int64_t within, double in, double out)
{
    return blend(within, out, in);
}

/* A region with a hollow. If the ray is in the region, its next change is the exit: out of the outer primitive or into
 * the hollow. Otherwise it is the entry: into the outer primitive or, if the hollow covers this point, out of the
 * hollow. */
ALWAYS_INLINE next_change next_of_hollowed(int64_t within, double in, double out, double hollow_in, double hollow_out)
{
    int64_t by_hollow = mask_less(hollow_in, out);
    double leave = blend(by_hollow, hollow_in, out);
    int64_t covered = mask_less_equal(hollow_in, in) & mask_less(in, hollow_out);
    double emerge = blend(mask_less(hollow_out, out), hollow_out, HUGE_VAL);
    double enter = blend(covered, emerge, in);
    next_change c = {blend(within, leave, enter), blend_int(within, by_hollow, covered)};
    return c;
}

/* The overlap of a region with the range 0..1 of a shadow ray, whatever hides it; thick: the ends of an overlap are
 * farther apart than the window within which they could be in contact. */
typedef struct overlap {
    int64_t any, thick;
} overlap;

ALWAYS_INLINE overlap overlap_of_convex(double in, double out, double thin)
{
    const int64_t any = mask_less(in, 1.0) & mask_less(0.0, out);
    return (overlap){any, any & mask_less(thin, out - in)};
}

ALWAYS_INLINE overlap overlap_of_hollowed(double in, double out, double hollow_in, double hollow_out, double thin)
{
    const double first_out = lesser(out, hollow_in), second_in = greater(in, hollow_out);
    const int64_t first = mask_less(in, lesser(first_out, 1.0)) & mask_less(0.0, first_out);
    const int64_t second = mask_less(second_in, lesser(out, 1.0)) & mask_less(0.0, out);
    return (overlap){first | second,
                     (first & mask_less(thin, first_out - in)) | (second & mask_less(thin, out - second_in))};
}

/* --- contact_kernel.c --- */

/* Decides which boundaries of s->near[k] are in contact with column k's crossing, and updates the sets and priority
 * indices on both sides. */
void KERNEL(merge_contacts)(const scene_geometry *g, const ray_batch *rays, int k, ray_scratch *s, hit_batch *c,
                            instance_hit *mesh_hits);

/* --- solid_tree_kernel.c: for a geometry with a solid tree --- */

/* Fills s->tree.start, and writes the bits of the direct primitives that contain the rays' starts. */
void KERNEL(tree_split)(const scene_geometry *g, const ray_batch *rays, ray_scratch *s, uint64_t *direct);
/* Makes column k begin at the start of ray i. */
void KERNEL(tree_begin)(int i, int k, ray_scratch *s);
/* Makes column m continue after column k's crossing at t. */
void KERNEL(tree_advance)(int k, int m, double t, ray_scratch *s);

/* The intervals of one of the tree's primitives ahead of column k; returns their number. */
int KERNEL(tree_intervals)(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s, int p,
                           interval found[CHORDS_MAX]);

/* Finds the next changes by the tree's solids if they come before those in c, for the first n columns, and fills
 * s->tree for the crossings that are then the nearest. */
void KERNEL(tree_changes)(const scene_geometry *g, const ray_batch *rays, int n, ray_scratch *s, hit_batch *c,
                          const instance_hit *mesh_hits);

/* Calls `found` for each of the tree's primitives that may have a boundary close to t on column k (BOUNDARY_CLOSE). */
typedef void tree_found(void *context, int p, const interval *found);
void KERNEL(tree_each_near)(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s, double t,
                            tree_found *found, void *context);

/* Marks the shadow rays that the tree's solids block for certain (s->blocked), and those that they may block
 * (s->undecided). s->low: steps_per_unit of each ray. */
void KERNEL(tree_shadows)(const scene_geometry *g, const ray_batch *rays, int solid_shadows, ray_scratch *s);

/* --- solid_view_kernel.c: for a geometry with a solid tree --- */

/* Makes a view of the solids that a ray of the batch may meet before t_max; false if they are too many, or the rays are
 * not coherent. */
bool KERNEL(view_make)(const scene_geometry *g, const ray_batch *rays, double t_max, solid_view *v);
/* The bits, in the view, of the primitives that contain the rays' starts. */
void KERNEL(view_sets)(const solid_view *v, const ray_batch *rays, uint64_t *inside);
/* view_outer_set: the set, in numbers of the whole scene, of the view's primitives in `bits`. view_hits converts hits
 * to these numbers. */
uint64_t KERNEL(view_outer_set)(const solid_view *v, uint64_t bits);
void KERNEL(view_hits)(const solid_view *v, int count, hit_batch *hits);

/* --- mesh_surface_kernel.c --- */

/* See geometry_kernels. */
void KERNEL(mesh_surface)(const struct instance_set *f, const ray_batch *rays, const instance_hit *hits, bool smooth,
                          surface_batch *points, mesh_points *more);

/* --- mesh_changes_kernel.c --- */

/* For the first n columns: mesh_changes finds the next crossings of meshes if they come before those in c. Later, when
 * the bits of the other primitives are set, mesh_sets sets the meshes' bits in c's sets and in s->near. */
void KERNEL(mesh_changes)(const scene_geometry *g, const ray_batch *rays, int n, ray_scratch *s, hit_batch *c,
                          instance_hit *hits);
void KERNEL(mesh_sets)(const scene_geometry *g, const ray_batch *rays, int n, ray_scratch *s, hit_batch *c,
                       const instance_hit *hits);

/* The bits of the wanted meshes in the sets just before low and just after high. Column k, in the medium of that
 * priority index, crosses an interface between the two. */
void KERNEL(mesh_sets_closely)(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s,
                               int64_t priority_index, uint64_t wanted, double low, double high, uint64_t *before,
                               uint64_t *after);

/* Calls `found` for the crossings of mesh p that are close to t on column k (BOUNDARY_CLOSE), hidden or not. */
void KERNEL(mesh_each_near)(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s, int p,
                            double t, instance_found *found, void *context);

/* The crossing of column k with the mesh of a bit in low <= t <= high, given the set `before`; its face is FACE_NONE if
 * there is none. */
instance_hit KERNEL(mesh_hit_between)(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s,
                                      int bit, uint64_t before, double low, double high);

/* Marks the shadow rays (except settled ones) that meshes of a set block between 0 and 1. certain: only those;
 * otherwise possibly more, whose crossings the caller searches anyway. A ray that starts inside a closed mesh is
 * blocked at its start. */
void KERNEL(mesh_shadows)(const scene_geometry *g, const ray_batch *rays, uint64_t wanted, bool certain,
                          query_counts *counts, int64_t *marked, const int64_t *settled);
