/* Batches of rays and their hits, as structures of arrays. A batch fits into the first-level cache. Ownership: the
 * arrays of a ray_batch belong to the caller that queued the rays; hits and scratch are plain values. */
#pragma once

#include "base/counters.h"
#include "base/isa.h"
#include "geometry/scene_geometry.h"
#include <float.h>
#include <stdint.h>

/* Rows are a cache line longer than a batch: rows of exactly 1024 bytes would all map to the same few sets of the
 * first-level cache and evict each other. */
enum { BATCH = 128, LANES_MAX = 8 /* doubles in the widest vector */, ROW = BATCH + LANES_MAX };

/* The error bound of a computed point, relative to the sum of the magnitudes of its terms: see primitives/kind.h. */
#define POINT_ERROR (16.0 * DBL_EPSILON)

/* A view of up to BATCH rays. A ray that looks for its nearest interface has a unit direction; a shadow ray's direction
 * reaches from its start to the light. start is the face that the ray starts on, or FACE_NONE; the root of that face is
 * exactly zero. inside is the set of primitives that contain the ray's start. */
typedef struct ray_batch {
    int count;
    const double *ox, *oy, *oz, *dx, *dy, *dz;
    const int64_t *start;
    const uint64_t *inside;
} ray_batch;

/* A batch of ray i only, with another set, which is borrowed. */
static inline ray_batch ray_batch_one(const ray_batch *rays, int i, const uint64_t *inside)
{
    return (ray_batch){
        1, &rays->ox[i], &rays->oy[i], &rays->oz[i], &rays->dx[i], &rays->dy[i], &rays->dz[i], &rays->start[i], inside};
}

/* Nearest interface by ray. */
typedef struct hit_batch {
    double t[ROW];              /* infinite for a miss */
    int64_t hit_primitive[ROW]; /* the primitive of the surface; -1 for a miss */
    int64_t before[ROW];        /* priority index of the medium before it ... */
    int64_t after[ROW];         /* ... and after it */
    int64_t surface[ROW];       /* priority index of the region whose surface it is (see scene_geometry_surface) */
    uint64_t inside_before[ROW], inside_after[ROW]; /* sets just before and just after it */
} hit_batch;

/* A segment of a ray within one medium, and its length in scene units (1e120, infinite in effect, if the ray leaves the
 * scene). */
typedef struct medium_segment {
    int ray, priority_index;
    double length;
} medium_segment;

/* A hit of a ray on a mesh. */
typedef struct instance_hit {
    double t, u, v; /* as in mesh_hit (geometry/hierarchy/hierarchy.h); t is infinite for a miss */
    int64_t face;   /* mesh_face_number (geometry/regions/instance_set.h); FACE_NONE for a miss */
    int facing;
} instance_hit;

/* Per-batch state for meshes: the mesh hits by ray, and those of rays that are searched again. */
typedef struct mesh_scratch {
    instance_hit hit[ROW], again[ROW];
    double from[ROW]; /* the t up to which a column has been searched */
    /* The t at which the sets after a column's hit hold: the hit's t, or a t beyond its error bound if another boundary
     * is close to it. */
    double until[ROW];
    int64_t last[ROW];    /* the mesh face at `from`, or the one that the ray starts on */
    uint64_t near[ROW];   /* meshes with a boundary close to the column's crossing, other than the copy that is hit */
    query_counts *counts; /* the caller's; NULL: queries are not counted */
} mesh_scratch;

/* The most segments of a batch with analytic solids only. Rays through many meshes may have more: a full list is
 * passed to `full`, which empties it. */
enum { SEGMENTS_MAX = BATCH * (2 * PRIMITIVES_MAX + 2) };

/* The medium segments of the rays of a batch, up to their hit or light; those of one ray are in order. Separate from
 * the scratch, whose layout was measured to be the fastest for the cache. */
typedef struct medium_segments {
    int count;
    bool all; /* set by the caller: segments are also recorded in media that do not attenuate */
    void (*full)(void *context);
    void *context;
    double passed[ROW], unit[ROW]; /* the t up to which a column has been searched; the length of a step of t = 1 */
    medium_segment segment[SEGMENTS_MAX];
} medium_segments;

/* An interface that a ray crosses: one without refraction of a shadow ray, or one of a partial surface. */
typedef struct ray_crossing {
    int ray, primitive;
    int before, after; /* priority indices */
    double t;
    uint64_t inside;   /* primitives that the ray is in just before it */
    instance_hit mesh; /* if the primitive is a mesh */
} ray_crossing;

/* The interfaces of the shadow rays of a batch, up to a blocking one. Needed by callers that compute more than the
 * regions' shadow transmittance. As with medium_segments, a full list is passed to `full`, which empties it. */
enum { CROSSINGS_MAX = BATCH * 8 };
typedef struct ray_crossings {
    int count;
    void (*full)(void *context);
    void *context;
    ray_crossing crossings[CROSSINGS_MAX];
} ray_crossings;

/* How much of a partial surface is there, where a ray of a batch crosses it: 0 nothing, so that it is no interface; 1
 * all. Between them, a ray that looks for its nearest interface meets the surface, and the caller divides its light; a
 * shadow ray keeps the rest, 1 minus it. Values, and the order of calls for one ray, do not depend on the instruction
 * set. */
typedef struct surface_cover {
    double (*of)(void *context, const ray_batch *rays, const ray_crossing *x);
    void *context;
} surface_cover;

/* Per-column state of the search in a solid tree (geometry/regions/solid_tree.h). */
typedef struct tree_columns {
    uint64_t start[ROW];              /* by ray: the tree's primitives that contain its start */
    double from[ROW];                 /* the t up to which a column has been searched; -infinity at first */
    uint64_t within[ROW];             /* the tree's primitives that contain the ray there */
    uint64_t before[ROW], after[ROW]; /* those just before and just after the crossing */
    bool simple[ROW]; /* no boundary of the tree's primitives is near the crossing, except the crossing itself */
} tree_columns;

/* A solid view: the few solids of a large scene that any ray of a batch may meet, as a separate scene geometry with
 * other numbers, in which all primitives are direct. For coherent batches it is faster to find these solids once and to
 * test all rays against each of them, eight at a time, than to search the solid tree for every ray. It borrows the
 * outer geometry. */
enum { VIEW_PRIMITIVES_MAX = 24 }; /* with more the search for every ray was measured to be faster */

typedef struct solid_view {
    const scene_geometry *scene; /* the whole scene */
    scene_geometry inner;        /* with the arrays below */
    primitive primitives[VIEW_PRIMITIVES_MAX];
    region regions[VIEW_PRIMITIVES_MAX + 1];
    int direct_regions[VIEW_PRIMITIVES_MAX];
    int outer_primitive[VIEW_PRIMITIVES_MAX];  /* by primitive */
    int outer_region[VIEW_PRIMITIVES_MAX + 1]; /* by priority index */
} solid_view;

/* Intervals [in, out] by row and ray, and values derived from them. Apart from the segments and crossings, nothing is
 * kept between calls. */
typedef struct ray_scratch {
    double in[PRIMITIVES_MAX][ROW], out[PRIMITIVES_MAX][ROW];
    double inverse_y[ROW], inverse_x[ROW], inverse_z[ROW];
    double axial_dx[ROW], axial[ROW], inverse_axial[ROW];
    double slack[ROW], low[ROW], high[ROW];
    uint64_t inside[ROW];
    uint64_t near[ROW]; /* primitives with a boundary close to the column's crossing: see BOUNDARY_CLOSE */
    hit_batch again;    /* for rays that are searched again */
    int64_t attention[ROW], undecided[ROW], blocked[ROW];
    int ray[ROW];              /* the ray of the batch that a column belongs to */
    medium_segments *segments; /* the caller's; NULL: medium segments are not recorded */
    mesh_scratch *meshes;      /* the caller's; may be NULL without meshes */
    ray_crossings *crossings;  /* the caller's; NULL: interfaces of shadow rays are not recorded */
    surface_cover cover;       /* the caller's; used if the geometry is partial */
    tree_columns tree;
    solid_view view;
} ray_scratch;

/* Points on the surface of one primitive. normal is a unit vector against the ray; cos_i = -d.n, in (0, 1] for a unit
 * vector d. error bounds the distance between the computed and the exact surface point, across the surface, in scene
 * units. */
typedef struct surface_batch {
    double px[ROW], py[ROW], pz[ROW];
    double nx[ROW], ny[ROW], nz[ROW];
    double cos_i[ROW], error[ROW];
    int64_t face[ROW];
} surface_batch;

/* Surface attributes of points on meshes, for shading. */
typedef struct mesh_points {
    double gx[ROW], gy[ROW], gz[ROW]; /* geometric normal, a unit vector against the ray */
    int64_t slot[ROW];
    double weight[3][ROW];   /* barycentric weights of the triangle's corners */
    uint32_t corner[3][ROW]; /* its vertices */
} mesh_points;

/* The kernels, one set per instruction set. All sets return bit-identical results. */
typedef struct geometry_kernels {
    /* The nearest interface of every ray. */
    void (*nearest)(const scene_geometry *g, const ray_batch *rays, ray_scratch *scratch, hit_batch *hits);
    /* The fraction of light, 0..1, that arrives from the other end (t = 1). With solid_shadows any interface blocks. */
    void (*shadow)(const scene_geometry *g, const ray_batch *rays, int solid_shadows, ray_scratch *scratch,
                   double *transmitted);
    /* The points where rays hit a primitive at t; all rays hit it. Here rays->inside is the set just
     * before the point, which determines whether a ray enters or leaves the primitive. */
    void (*surface)(const scene_geometry *g, int hit_primitive, const ray_batch *rays, const double *t,
                    surface_batch *points);
    /* The points where rays hit meshes, and more about them unless `more` is NULL. With `smooth`, and if the mesh has
     * normals, the normal is interpolated, and bent so that it faces the ray and a mirror reflects the ray out of
     * the surface. */
    void (*mesh_surface)(const struct instance_set *f, const ray_batch *rays, const instance_hit *hits, bool smooth,
                         surface_batch *points, mesh_points *more);
} geometry_kernels;

ISA_DECLARE(const geometry_kernels, geometry_kernels)
