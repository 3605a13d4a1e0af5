/* The depth buffer's inside, for src/render/zbuffer/.
 *
 * Points where the picture is looked at form a grid: one a pixel, or n by n; its unit is the way from one to the next,
 * its origin the picture's upper left corner, so that point i stands at i + 1/2. Corners of triangles are rounded to
 * 2^-12 of that unit. From there on all that decides which points a triangle covers is whole numbers; two triangles
 * that share an edge share its rounded ends, and by the rule of top and left edges no point on it is drawn twice or
 * left out. */
#pragma once

#include "geometry/instance_set.h"
#include "render/zbuffer/zbuffer.h"
#include <stdatomic.h>

enum {
    SUBPIXEL = 4096, /* steps of a corner's place in one unit of the grid */
    REACH = 3 << 16, /* units: corners lie no farther from the picture's middle, or by a rounding. Sums of two products
                      * of differences stay under 2^63 */
    SQUARE_PIXELS = 32, /* at most: fewer where pixels have more points than two by two */
    POLYGON_MAX = 8,    /* a triangle's corners and one for each plane that cuts it */
    CHUNK_TRIANGLES = 4096,
    LAYERS_MAX = 160, /* of a point: more than the largest render.depth */
    BLOCK_LAYERS = 1 << 16,
    BLOCKS_MAX = 1 << 15
};
#define SEEN_LAYERS 0x80000000U /* of zbuffer.seen: the rest is where the point's list begins */

/* What is seen at a point, one behind the other: see zbuffer_layers.c. */
typedef struct rasterised_layer {
    uint32_t number;       /* of the triangle and 1; 0: the sky */
    uint8_t before, after; /* ranks of the media */
    uint8_t surface;       /* rank of the body whose surface it is */
    bool leaving : 1;      /* the primitive; of the last one its triangle says so */
    bool ends : 1;         /* it is opaque, or the sky */
    bool passed : 1;       /* no interface: two media of one index meet that absorb differently */
} rasterised_layer;

/* A point in the camera's frame, right, up, forward; distance 0 is a direction, infinitely far. */
typedef struct clip_corner {
    double x, y, z, h;
    double weight[3]; /* of the triangle's own corners */
} clip_corner;

/* What is drawn: a mesh's copies, or one primitive as triangles in its own frame. */
typedef struct rasterised_part {
    instanced_mesh at;
    int met;        /* primitive */
    double nearest; /* depth that is drawn; by the part's own extent, so that no other solid shows in it */
    bool hollow;    /* of a cup */
    bool plane;     /* four triangles from the foot of the eye's perpendicular to the horizon */
    mesh *own;      /* an analytic solid's triangles; NULL for a mesh */
} rasterised_part;

typedef struct screen_triangle {
    int32_t x[3], y[3]; /* in steps, so that the area is positive (clockwise as one sees it) */
    double a, b, c;     /* 1 / depth at (x, y) of the grid is a x + b y + c, */
    double least, most; /* within what its corners have */
    uint32_t triangle, copy;
    uint16_t part;
    uint8_t piece; /* of the polygon that the planes left */
    bool curved;   /* a piece of a curved surface; only known where any are layers */
} screen_triangle;

/* Triangles of one part, numbered through its copies, and what came of them. */
typedef struct chunk {
    int part, count;
    uint64_t first;
    screen_triangle *made;
    size_t made_count, capacity;
} chunk;

struct zbuffer {
    const plan *frame_plan;
    int points;              /* along a pixel's edge: 1 to 8 */
    int side;                /* of a square, in pixels */
    int width, height;       /* of the grid */
    double units_x, units_y; /* of the grid, in one of x / z and y / z */
    double reach_x, reach_y; /* largest of |x| / z and |y| / z */
    int part_count;
    rasterised_part parts[PRIMITIVES_MAX]; /* the highest rank first, so that of equally near triangles the one with the
                                       * lower number is drawn; layers last */
    uint64_t layered;    /* bit r - 1: the body of rank r is drawn as layers; 0: there is nothing to see through */
    uint64_t eye_inside; /* those that the eye is in */
    uint64_t skins;      /* those that are open meshes */
    double eye_index;    /* refractive index where the eye is */
    int first_layered_part;
    size_t first_layered;      /* triangle */
    rasterised_layer **blocks; /* of lists of layers */
    atomic_uint next_block;
    atomic_size_t layer_count;
    chunk *chunks;
    size_t chunk_count;
    atomic_size_t next_chunk;
    atomic_bool out_of_memory;
    screen_triangle *triangles;
    size_t triangle_count;
    int across, down; /* squares */
    size_t *first;    /* by square, into listed; one more */
    uint32_t *listed;
    uint32_t *seen; /* by point of the grid: number of the triangle there and 1; 0 for none */
};

/* zbuffer_cover.c: fills layered and eye_inside. */
void zbuffer_find_layers(zbuffer *z);

/* zbuffer_regions.c */
status zbuffer_cut(zbuffer *z, diagnostic *why);

/* zbuffer_layers.c: a point of a layered triangle; and all points of a window once its triangles are drawn. */
void zbuffer_add_fragment(zbuffer *z, zbuffer_square *s, int point, double nearness, uint32_t number);
void zbuffer_resolve(zbuffer *z, int x0, int y0, int x1, int y1, zbuffer_square *s);

/* zbuffer_clip.c: the triangle's corners as seen from the camera; what the planes leave of it, in order; where a corner
 * is on the grid. */
void zbuffer_corners(const zbuffer *z, const rasterised_part *p, uint32_t copy, uint32_t triangle,
                     clip_corner out[POLYGON_MAX]);
int zbuffer_clip(const zbuffer *z, const rasterised_part *p, clip_corner polygon[POLYGON_MAX]);
void zbuffer_place(const zbuffer *z, const clip_corner *c, double *x, double *y);

static inline uint32_t zbuffer_number(const rasterised_part *p)
{
    return p->plane ? 4 : (uint32_t)p->at.triangles->triangle_count;
}

/* A corner of a part that is no plane, relative to the eye; o: the copy's origin less the eye. */
static inline vec3 zbuffer_vertex(const instanced_mesh *p, vec3 o, uint32_t vertex)
{
    const vec3 v = p->triangles->vertices[vertex];
    const vec3 scaled = p->scaled ? vec3_make(v.x * p->scale.x, v.y * p->scale.y, v.z * p->scale.z) : v;
    return vec3_add(o, p->turned ? mat3_apply(p->rotation, scaled) : scaled);
}
