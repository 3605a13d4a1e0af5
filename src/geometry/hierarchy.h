/* Hierarchies of bounding volumes over one mesh's triangles, behind one interface. All give the same hits: the nearest
 * triangle, of equally near ones the one with the lower number, and its distance to the last bit, because all use one
 * triangle test and cull conservatively.
 *
 *   none     no hierarchy: every triangle is tested
 *   sphere   one bounding sphere around the mesh
 *   octant   the report's tree of spheres: a shell's triangles go to eight octants, those larger than a quarter of its
 *            radius stay
 *   bvh      surface-area heuristic, eight children a node, single-precision boxes rounded outwards
 *   embree   Embree's, where it was there at build time: a yardstick; single precision
 *
 * A hierarchy borrows its mesh, which must outlive it; it is not changed once it is built (but for hierarchy_refit and
 * hierarchy_follow), and any number of threads may use it. */
#pragma once

#include "geometry/mesh.h"

typedef enum hierarchy_kind {
    HIERARCHY_NONE,
    HIERARCHY_SPHERE,
    HIERARCHY_OCTANT,
    HIERARCHY_BVH,
    HIERARCHY_EMBREE,
    HIERARCHY_KIND_COUNT
} hierarchy_kind;

typedef struct hierarchy hierarchy;

typedef struct hierarchy_report {
    size_t bytes; /* all memory that it holds, without the mesh's own */
    size_t nodes, leaves;
    int depth;      /* levels of nodes */
    double build_s; /* wall time of its build */
    int threads;    /* that built it */
} hierarchy_report;

/* threads: 1..1024 of which at most as many as are useful are started. STATUS_FAILURE: memory is out; STATUS_BAD_INPUT:
 * Embree is not there. */
status hierarchy_build(const mesh *m, hierarchy_kind kind, int threads, hierarchy **out, diagnostic *why);
void hierarchy_destroy(hierarchy *h);
hierarchy_report hierarchy_describe(const hierarchy *h);

/* A mesh's hierarchy of a kind, built at its first use and kept with the mesh as long as that lives; from any thread.
 */
status hierarchy_of_mesh(const mesh *m, hierarchy_kind kind, int threads, const hierarchy **out, diagnostic *why);

/* Fits a bvh to its mesh, whose vertices have moved: triangles and boxes anew, the tree as it is, bottom up (Wald,
 * Boulos and Shirley, "Ray tracing deformable scenes using dynamic bounding volume hierarchies", ACM TOG 26(1), 2007).
 * false: it cannot be, it is to be built anew (another kind; or triangles that had no area at its build, which it
 * leaves out, or coordinates that were floats). No thread uses it meanwhile. */
bool hierarchy_refit(hierarchy *h);

/* Expected cost of a ray that meets the root's box, of a bvh: sum over nodes and blocks of their surface area over the
 * root's (MacDonald and Booth, 1990), in tests of one block. 0 of other kinds and without triangles. */
double hierarchy_cost(const hierarchy *h);

/* What became of the hierarchies that a mesh keeps after mesh_move: each is refitted, or built anew where it cannot be
 * or where its cost is more than `ratio` (at least 1) times what it was at its build. No thread uses the mesh
 * meanwhile. STATUS_FAILURE: memory is out; the mesh keeps none then. */
typedef struct hierarchy_moves {
    int refitted, rebuilt;
    double refit_s, build_s; /* wall time of either */
    double growth; /* largest cost after a refit over that at the build, of those too that were then built anew; 0 where
                      none could be */
} hierarchy_moves;
status hierarchy_follow(const mesh *m, double ratio, int threads, hierarchy_moves *out, diagnostic *why);

/* Sides of triangles that a ray looks for. */
enum { FACING_FRONT = 1, FACING_BACK = 2, FACING_ANY = 3 };
#define TRIANGLE_NONE UINT32_MAX

/* A ray in the mesh's frame. The direction is not zero and need not be a unit vector; t is in its units. */
typedef struct mesh_ray {
    vec3 origin, direction;
    double t_min, t_max; /* hits lie in t_min <= t <= t_max; t_min below 0 counts as 0 */
    uint32_t skip;       /* a triangle that is not looked at (the ray starts on it), or TRIANGLE_NONE */
    int facing;          /* of the triangles wanted */
} mesh_ray;

typedef struct mesh_hit {
    double t;
    double u, v; /* weights of the triangle's second and third corner at the hit, 0..1; the first's is 1 - u - v */
    uint32_t triangle; /* TRIANGLE_NONE for none */
    int facing;        /* FACING_FRONT or FACING_BACK: the side that the ray came upon */
} mesh_hit;

/* Called with each hit of hierarchy_all, in no order. */
typedef void mesh_visit(void *context, const mesh_hit *hit);

/* Called with each triangle whose own box the ray may meet before t_max; returns t_max, or less. Less than the ray's
 * t_min ends it all. */
typedef double box_visit(void *context, uint32_t triangle, double t_max);

/* The kernels, one set for each instruction set; the same bits from all. */
typedef struct hierarchy_kernels {
    /* The nearest hit. hit->triangle is TRIANGLE_NONE where there is none. */
    void (*nearest)(const hierarchy *h, const mesh_ray *ray, mesh_hit *hit);
    /* Is there any hit? */
    bool (*any)(const hierarchy *h, const mesh_ray *ray);
    /* All hits. */
    void (*all)(const hierarchy *h, const mesh_ray *ray, mesh_visit *visit, void *context);
    /* Of a bvh: the triangles in boxes that the ray meets, about nearest first, for who keeps other things in them. */
    void (*boxes)(const hierarchy *h, const mesh_ray *ray, box_visit *visit, void *context);
    /* nearest and any for up to 128 rays at a time, which may share the way down where they are alike. */
    void (*nearest_batch)(const hierarchy *h, const mesh_ray *rays, int count, mesh_hit *hits);
    void (*any_batch)(const hierarchy *h, const mesh_ray *rays, int count, bool *hit);
} hierarchy_kernels;

extern const hierarchy_kernels hierarchy_kernels_sse2, hierarchy_kernels_avx2, hierarchy_kernels_avx512;
