/* Hierarchies of bounding volumes over the triangles of one mesh, behind one interface. All kinds return the same hit:
 * the nearest triangle (of equally near ones the one with the lower number) and a distance that is bit-identical,
 * because all use one triangle test and cull conservatively.
 *
 *   none     no hierarchy: every triangle is tested
 *   sphere   one bounding sphere around the mesh
 *   octant   the sphere tree of the original report: a shell passes its triangles to eight octants and keeps those
 *            larger than a quarter of its radius
 *   bvh      binned surface-area heuristic, eight children per node, single-precision boxes rounded outwards
 *
 * A hierarchy borrows its mesh, which must outlive it. After the build only hierarchy_refit and hierarchy_update change
 * it. Any number of threads may use it at once. */
#pragma once

#include "base/counters.h"
#include "base/isa.h"
#include "base/pack.h"
#include "geometry/mesh/mesh.h"

typedef struct hierarchy_report {
    size_t bytes; /* all memory of the hierarchy, without the mesh's own */
    size_t nodes, leaves;
    int depth;      /* levels of nodes */
    double build_s; /* wall time of the build */
    int threads;    /* threads that built it */
} hierarchy_report;

/* threads: 1..1024; no more threads are started than are useful. STATUS_BAD_INPUT: unknown kind, or more memory needed
 * than the budget allows (base/budget.h); STATUS_FAILURE: out of memory, or too many triangles for the layout;
 * STATUS_INTERRUPTED: cancelled. */
status hierarchy_build(const mesh *m, hierarchy_kind kind, int threads, hierarchy **out, diagnostic *why);
void hierarchy_destroy(hierarchy *h);
hierarchy_report hierarchy_describe(const hierarchy *h);

/* The hierarchy of the given kind that the mesh owns: built at its first use, freed with the mesh. Thread-safe. */
status hierarchy_of_mesh(const mesh *m, hierarchy_kind kind, int threads, const hierarchy **out, diagnostic *why);

/* A closed mesh as the union of `count` operands, as in constructive solid geometry: the mesh itself if its shells
 * (mesh.h) neither overlap, touch nor lie in one another except as hollows; otherwise meshes that are copies of some of
 * its shells, in each of which this holds. The union is where the mesh's winding number is not 0. A shell that is
 * inside out, and no hollow, is turned over. A shell that crosses itself is not noticed. The mesh owns the operands,
 * until mesh_move. Thread-safe. STATUS_BAD_INPUT, with the place: a hollow crosses another shell, more than 32 operands
 * are needed, or, in a crowded mesh, a shell has no inside and outside; otherwise as hierarchy_build. */
status hierarchy_operands(const mesh *m, int threads, const mesh *const **operands, int *count, diagnostic *why);

/* Refits a bvh to its mesh after the vertices moved: triangles and boxes are recomputed bottom up, the tree is kept
 * (Wald, Boulos and Shirley, "Ray tracing deformable scenes using dynamic bounding volume hierarchies", ACM TOG 26(1),
 * 2007). Returns false if a refit is impossible and a rebuild is needed: for another kind, if triangles with two
 * corners at one position were left out at the build, or if the blocks hold floats and the moved vertices are not
 * floats. No other thread may use the hierarchy meanwhile. */
bool hierarchy_refit(hierarchy *h);

/* Expected cost of a ray that hits the root's box of a bvh, in units of one block test: the sum of the surface areas of
 * nodes and blocks over the root's (MacDonald and Booth, 1990). 0 for other kinds and without triangles. */
double hierarchy_cost(const hierarchy *h);

/* The result of updating a mesh's hierarchies after mesh_move. Each is refitted, or rebuilt if a refit is impossible or
 * makes the cost more than `ratio` (at least 1) times the cost at the build. No other thread may use the mesh
 * meanwhile. STATUS_FAILURE: out of memory; the mesh then has no hierarchies. */
typedef struct hierarchy_update_counts {
    int refitted, rebuilt;
    double refit_s, build_s; /* wall time of refits and of rebuilds */
    /* The largest ratio of the cost after a refit to that at the build, including hierarchies then rebuilt; 0 without a
     * refit. */
    double growth;
} hierarchy_update_counts;
status hierarchy_update(const mesh *m, double ratio, int threads, hierarchy_update_counts *out, diagnostic *why);

/* --- meshes as bytes (base/pack.h) ---
 *
 * Finished meshes with the hierarchies that they own, so that another process need not build them. Of a hierarchy's
 * blocks only the triangle numbers are written, and the blocks are filled from the mesh again: a tenth of the bytes.
 * The reader checks that every index is in range, every number finite, and that every traversal ends. Ownership: the
 * caller releases an unpacked mesh by mesh_release. Errors: STATUS_BAD_INPUT for damaged bytes, STATUS_FAILURE if
 * memory runs out. */

/* No other thread may move the mesh or build one of its hierarchies meanwhile. */
status mesh_pack(const mesh *m, pack_writer *to, diagnostic *why);
status mesh_unpack(pack_reader *from, const mesh **out, diagnostic *why);

/* The same for one hierarchy of a mesh. */
status hierarchy_pack(const hierarchy *h, pack_writer *to, diagnostic *why);
status hierarchy_unpack(const mesh *m, pack_reader *from, hierarchy **out, hierarchy_kind *kind, diagnostic *why);

/* --- queries --- */

/* The side of a triangle, and the set of sides that a ray can hit. */
enum { FACING_FRONT = 1, FACING_BACK = 2, FACING_ANY = 3 };
#define TRIANGLE_NONE UINT32_MAX

/* A ray in the mesh's frame. The direction is not zero and need not be a unit vector; t is in its units. */
typedef struct mesh_ray {
    vec3 origin, direction;
    double t_min, t_max; /* hits have t_min <= t <= t_max; a t_min below 0 counts as 0 */
    uint32_t skip;       /* a triangle to ignore (the one that the ray starts on), or TRIANGLE_NONE */
    int facing;          /* the sides that count as hits */
} mesh_ray;

typedef struct mesh_hit {
    double t;
    double u, v;       /* barycentric weights of the second and third corner, 0..1; the first's is 1 - u - v */
    uint32_t triangle; /* TRIANGLE_NONE for none */
    int facing;        /* the side that was hit: FACING_FRONT or FACING_BACK */
} mesh_hit;

/* Called with each hit of the `all` query, in no particular order. */
typedef void mesh_visit(void *context, const mesh_hit *hit);

/* Called with each triangle whose own box the ray may hit before t_max. Returns t_max or a smaller bound; a bound below
 * the ray's t_min ends the traversal. */
typedef double box_visit(void *context, uint32_t triangle, double t_max);

/* What a query looks for: the nearest hit, any hit, every hit, or the boxes of triangles. */
enum query_mode { QUERY_NEAREST, QUERY_ANY, QUERY_ALL, QUERY_BOXES };

/* Adds the tests that a query of one ray makes if the ray traverses the hierarchy by itself, without a fused
 * multiply-add. Their number depends on the mesh, the kind and the ray, not on other rays of the batch, threads or the
 * instruction set. The kernels test at least as much: a packet enters a box for all of its rays, and four triangles or
 * eight boxes are tested at once. Not for QUERY_BOXES. */
void hierarchy_count(const hierarchy *h, const mesh_ray *ray, enum query_mode mode, query_counts *counts);

/* The kernels, one set per instruction set. All sets return bit-identical results. */
typedef struct hierarchy_kernels {
    /* Returns the nearest hit; hit->triangle is TRIANGLE_NONE for a miss. */
    void (*nearest)(const hierarchy *h, const mesh_ray *ray, mesh_hit *hit);
    /* Returns whether there is any hit. */
    bool (*any)(const hierarchy *h, const mesh_ray *ray);
    /* Reports every hit. */
    void (*all)(const hierarchy *h, const mesh_ray *ray, mesh_visit *visit, void *context);
    /* Only for a bvh: reports the triangles whose boxes the ray hits, roughly nearest first. The instance set uses it
     * with one triangle per instance. */
    void (*boxes)(const hierarchy *h, const mesh_ray *ray, box_visit *visit, void *context);
    /* nearest and any for `count` rays; up to 128 coherent rays share a traversal. */
    void (*nearest_batch)(const hierarchy *h, const mesh_ray *rays, int count, mesh_hit *hits);
    void (*any_batch)(const hierarchy *h, const mesh_ray *rays, int count, bool *hit);
} hierarchy_kernels;

ISA_DECLARE(const hierarchy_kernels, hierarchy_kernels)
