/* Batches of rays and what they hit, as structures of arrays. A batch is short enough for the first-level
 * cache. Ownership: the arrays of a ray_batch belong to whoever queued the rays; hits and scratch are plain values. */
#pragma once

#include "geometry/scene_geometry.h"
#include <float.h>
#include <stdint.h>

/* Rows are a cache line longer than a batch: rows of exactly 1024 bytes would all fall into the same few sets of the
 * first-level cache and drive one another out. */
enum { BATCH = 128, LANES_MAX = 8 /* doubles in the widest vector */, ROW = BATCH + LANES_MAX };

/* A computed point may be off by this share of the sum of all magnitudes that it is computed from: see
 * primitives/kind.h. */
#define POINT_ERROR (16.0 * DBL_EPSILON)

/* A view of up to BATCH rays. Directions of rays that look for their nearest interface are unit vectors; a shadow
 * ray's reaches from its start to the light. start is the face that the ray starts on, or FACE_NONE; that
 * face's own root is known to be zero. inside is the set of primitives that the ray is in when it sets out. */
typedef struct ray_batch {
    int count;
    const double *ox, *oy, *oz, *dx, *dy, *dz;
    const int64_t *start;
    const uint64_t *inside;
} ray_batch;

/* Nearest interface by ray. */
typedef struct hit_batch {
    double t[ROW];              /* infinite for a miss */
    int64_t hit_primitive[ROW]; /* the primitive whose surface it is; -1 for a miss */
    int64_t before[ROW];        /* rank of the medium before it ... */
    int64_t after[ROW];         /* ... and behind it */
    int64_t surface[ROW]; /* rank of the body whose surface it is: an opaque one's if either side is opaque, else the
                             higher one's */
    uint64_t inside_before[ROW], inside_after[ROW]; /* sets just before and just behind it */
} hit_batch;

/* A piece of a ray within one medium, and how long it is (scene units; for ever on a ray that meets nothing: 1e120). */
typedef struct medium_segment {
    int ray, priority_index;
    double length;
} medium_segment;

/* Where a ray meets a mesh. */
typedef struct instance_hit {
    double t, u, v; /* as a mesh_hit's (geometry/hierarchy.h); t infinite for a miss */
    int64_t face;   /* mesh_face_number (geometry/instance_set.h); FACE_NONE for a miss */
    int facing;
} instance_hit;

/* What a batch needs where there are meshes: the meshes' hits by ray, and of rays that are looked at another time. */
typedef struct mesh_scratch {
    instance_hit hit[ROW], again[ROW];
    double from[ROW];   /* how far a column has been followed */
    double until[ROW];  /* the sets behind a column's hit are those here: beyond its error bound, if another boundary
                           lies close to it */
    int64_t last[ROW];  /* the mesh face where that was, or where the ray starts */
    uint64_t near[ROW]; /* meshes with a boundary close to the column's crossing, other than that of the copy that is
                           crossed */
} mesh_scratch;

/* Of analytic solids no batch has more. Rays through many meshes may: then what there is is handed over to `full`,
 * which empties the list. */
enum { SEGMENTS_MAX = BATCH * (2 * PRIMITIVES_MAX + 2) };

/* The media that each ray of a batch went through, up to its hit or its light; those of one ray in order. Kept apart
 * from the scratch, whose rows lie in the cache as they were measured to be fastest. */
typedef struct medium_segments {
    int count;
    void (*full)(void *context);
    void *context;
    double passed[ROW], unit[ROW]; /* how far a column has been followed; length of a step of 1 */
    medium_segment segment[SEGMENTS_MAX];
} medium_segments;

/* An interface that a shadow ray crosses straight on. */
typedef struct ray_crossing {
    int ray, primitive;
    int before, after; /* ranks */
    double t;
    uint64_t inside;   /* primitives that the ray is in just before it */
    instance_hit mesh; /* where the primitive is a mesh */
} ray_crossing;

/* The interfaces of each shadow ray of a batch that is not blocked before them, for who wants more of them than the
 * bodies' clearness. As with medium_segments, a full list is handed over to `full`, which empties it. */
enum { CROSSINGS_MAX = BATCH * 8 };
typedef struct ray_crossings {
    int count;
    void (*full)(void *context);
    void *context;
    ray_crossing crossings[CROSSINGS_MAX];
} ray_crossings;

/* Intervals [in, out] by row and ray, and what is derived from them. Contents but ways mean nothing between
 * calls. */
typedef struct ray_scratch {
    double in[PRIMITIVES_MAX][ROW], out[PRIMITIVES_MAX][ROW];
    double inverse_y[ROW], inverse_x[ROW], inverse_z[ROW];
    double axial_dx[ROW], axial[ROW], inverse_axial[ROW];
    double slack[ROW], low[ROW], high[ROW];
    uint64_t inside[ROW];
    uint64_t near[ROW]; /* primitives with a boundary close to the column's crossing: see BOUNDARY_CLOSE */
    hit_batch again;    /* of rays that are looked at another time */
    int64_t attention[ROW], undecided[ROW], blocked[ROW];
    int ray[ROW];              /* which ray of the batch a column belongs to */
    medium_segments *segments; /* the caller's; NULL: what rays go through is not noted */
    mesh_scratch *meshes;      /* the caller's; may be NULL where there are no meshes */
    ray_crossings *crossings;  /* the caller's; NULL: interfaces of shadow rays are not noted */
} ray_scratch;

/* Points on one primitive's surface. normal is a unit vector against the ray; cos_i = -d.n, in (0, 1] for a unit vector
 * d. error is a bound on the distance from the point to the exact one across the surface, in scene units. */
typedef struct surface_batch {
    double px[ROW], py[ROW], pz[ROW];
    double nx[ROW], ny[ROW], nz[ROW];
    double cos_i[ROW], error[ROW];
    int64_t face[ROW];
} surface_batch;

/* The kernels, one set for each instruction set; the same bits from all. */
typedef struct geometry_kernels {
    /* The nearest interface of every ray. */
    void (*nearest)(const scene_geometry *a, const ray_batch *rays, ray_scratch *scratch, hit_batch *hits);
    /* The share of light, 0..1, that comes through from the other end (t = 1). With solid_shadows any interface blocks.
     */
    void (*shadow)(const scene_geometry *a, const ray_batch *rays, int solid_shadows, ray_scratch *scratch,
                   double *transmitted);
    /* Points where rays, all of which meet primitive p (numbered bit) at t, meet it. rays->inside is here the set just
     * before the point: it says whether a ray enters the primitive or leaves it. */
    void (*surface)(const primitive *p, const ray_batch *rays, const double *t, int bit, surface_batch *points);
} geometry_kernels;

extern const geometry_kernels geometry_kernels_sse2, geometry_kernels_avx2, geometry_kernels_avx512;
