/* Internals of the depth buffer, for src/render/zbuffer/.
 *
 * The sample points of the image form a grid: one per pixel, or n by n. Its unit is the distance between two points,
 * its origin the image's upper left corner, so that point i is at i + 1/2. Corners of triangles are rounded to 2^-12 of
 * that unit. From then on the coverage of points is computed in integers: two triangles that share an edge share its
 * rounded ends, and by the top-left rule no point on the edge is drawn twice or left out. */
#pragma once

#include "geometry/regions/instance_set.h"
#include "render/zbuffer/zbuffer.h"
#include <stdatomic.h>

enum {
    SUBPIXEL = 4096, /* steps of a corner's position per unit of the grid */
    /* units: largest distance of corners from the image's centre, up to rounding. Sums of two products of differences
     * stay under 2^63 */
    REACH = 3 << 16,
    SQUARE_PIXELS = 32, /* at most: fewer if pixels have more than 2 x 2 points */
    POLYGON_MAX = 8,    /* a triangle's corners and one for each clip plane */
    CHUNK_TRIANGLES = 4096,
    LAYERS_MAX = 160, /* of a point: more than the largest render.depth */
    BLOCK_LAYERS = 1 << 16,
    BLOCKS_MAX = 1 << 15
};
#define SEEN_LAYERS 0x80000000U /* flag in zbuffer.seen: the other bits are the start of the point's list */

/* One of the surfaces visible at a point, one behind the other: see zbuffer_layers.c. */
typedef struct rasterised_layer {
    uint32_t number;       /* of the triangle, plus 1; 0: the sky */
    uint8_t before, after; /* priority indices of the media */
    uint8_t surface;       /* priority index of the region whose surface it is */
    bool leaving : 1;      /* the ray leaves the primitive; unused if `ends` is set */
    bool ends : 1;         /* opaque, or the sky */
    bool passed : 1;       /* no interface: two media of equal index but different absorption */
} rasterised_layer;

/* A homogeneous point in the camera frame: right, up, forward; h = 0 is a direction, a point at infinity. */
typedef struct clip_corner {
    double x, y, z, h;
    double weight[3]; /* of the triangle's corners, before clipping */
} clip_corner;

/* A part of the rasterised scene: a mesh's instances, or one primitive as triangles in its own frame. */
typedef struct rasterised_part {
    instanced_mesh at;
    int primitive;      /* its index in the scene geometry */
    double nearest;     /* near clip depth; from the part's own extent, so that no other solid affects the result */
    bool hollow;        /* the inside of a cup */
    bool plane;         /* four triangles from the camera's foot point on the plane to the horizon */
    mesh *tessellation; /* an analytic solid's triangles; NULL for a mesh */
} rasterised_part;

typedef struct screen_triangle {
    int32_t x[3], y[3]; /* in steps, ordered so that the area is positive (clockwise on the image) */
    double a, b, c;     /* the nearness at (x, y) of the grid is a x + b y + c, ... */
    double least, most; /* ... clamped to the range of its corners */
    uint32_t triangle, copy;
    uint16_t part;
    uint8_t piece; /* of the clipped polygon */
    bool curved;   /* a piece of a curved surface; set only if there are layers */
} screen_triangle;

/* A range of triangles of one part, numbered through its instances, and the screen triangles made from them. */
typedef struct chunk {
    int part, count;
    uint64_t first;
    screen_triangle *screen;
    size_t screen_count, capacity;
} chunk;

struct zbuffer {
    const plan *frame_plan;
    int points;              /* along a pixel's edge: 1 to 8 */
    int side;                /* of a square, in pixels */
    int width, height;       /* of the grid */
    double units_x, units_y; /* grid units per unit of x / z and y / z; of x and y with an orthographic camera */
    double reach_x, reach_y; /* largest |x| / z and |y| / z, or |x| and |y| */
    int part_count;
    /* highest priority index first, so that of equally near triangles the one with the lower number is drawn; layers
     * last */
    rasterised_part parts[PRIMITIVES_MAX];
    uint64_t
        layered; /* bit r - 1: the region of priority index r is drawn as layers; 0: there is nothing to see through */
    uint64_t eye_inside;    /* clear regions that contain the camera */
    uint64_t open_surfaces; /* regions that are open meshes */
    double eye_index;       /* refractive index at the camera */
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
    size_t *first;    /* by square, index into listed; one more at the end */
    uint32_t *listed;
    uint32_t *seen; /* by grid point: number of its triangle, plus 1; 0 for none; or SEEN_LAYERS and its list */
};

/* The divisor of a corner's x and y for its position in the image: z in perspective, h with an orthographic camera. */
static inline double zbuffer_divisor(const zbuffer *z, const clip_corner *c)
{
    return z->frame_plan->view.parallel ? c->h : c->z;
}

/* The nearness of a point, which is linear in the image over a plane and greater for what is nearer: 1 / depth; with an
 * orthographic camera -depth. */
static inline double zbuffer_nearness(const zbuffer *z, const clip_corner *c)
{
    return z->frame_plan->view.parallel ? -c->z / c->h : c->h / c->z;
}

/* zbuffer_parts.c: computes layered, eye_inside, open_surfaces and eye_index. */
void zbuffer_find_layers(zbuffer *z);

/* Makes the parts and their triangles. */
status zbuffer_cut(zbuffer *z, diagnostic *why);

/* zbuffer_layers.c: adds a point of a layered triangle, and resolves all points of a window after its triangles are
 * drawn. */
void zbuffer_add_fragment(zbuffer *z, zbuffer_square *s, int point, double nearness, uint32_t number);
void zbuffer_resolve(zbuffer *z, int x0, int y0, int x1, int y1, zbuffer_square *s);

/* zbuffer_project.c: the triangle's corners in the camera frame; the polygon that remains after clipping, in order; the
 * position of a corner on the grid. */
void zbuffer_corners(const zbuffer *z, const rasterised_part *p, uint32_t copy, uint32_t triangle,
                     clip_corner out[POLYGON_MAX]);
int zbuffer_clip(const zbuffer *z, const rasterised_part *p, clip_corner polygon[POLYGON_MAX]);
void zbuffer_place(const zbuffer *z, const clip_corner *c, double *x, double *y);

static inline uint32_t zbuffer_part_triangles(const rasterised_part *p)
{
    return p->plane ? 4 : (uint32_t)p->at.triangles->triangle_count;
}

/* A corner of a part that is not a plane, relative to the camera; o: the instance's origin minus the camera's
 * position. */
static inline vec3 zbuffer_vertex(const instanced_mesh *p, vec3 o, uint32_t vertex)
{
    const vec3 v = p->triangles->vertices[vertex];
    const vec3 scaled = p->scaled ? vec3_make(v.x * p->scale.x, v.y * p->scale.y, v.z * p->scale.z) : v;
    return vec3_add(o, p->turned ? mat3_apply(p->rotation, scaled) : scaled);
}
