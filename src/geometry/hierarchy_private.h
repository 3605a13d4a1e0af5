/* The layouts that hierarchies are built into and traversed in; for src/geometry/hierarchy*.c alone.
 *
 * Triangles stand in blocks of four, as structures of arrays, so that four are tested at once; a block that is not full
 * repeats one of its triangles, which changes no hit. Where every coordinate is a float, blocks hold floats: half the
 * memory, the same bits. */
#pragma once

#include "geometry/hierarchy.h"

enum { BLOCK = 4, WIDTH = 8, LEAF_BLOCKS_MAX = 16, BVH_DEPTH_MAX = 64, SPHERES_DEPTH_MAX = 64 };

typedef struct block_single {
    float corner[3][3][BLOCK];
    uint32_t triangle[BLOCK];
} block_single; /* [corner][axis][lane] */
typedef struct block_double {
    double corner[3][3][BLOCK];
    uint32_t triangle[BLOCK];
} block_double;

/* A child: a node's number, or a run of blocks: LEAF | (number of blocks - 1) << 27 | number of the first block. */
#define CHILD_LEAF 0x80000000u
static inline uint32_t child_leaf(uint32_t first_block, uint32_t blocks)
{
    return CHILD_LEAF | (blocks - 1) << 27 | first_block;
}
static inline uint32_t child_first_block(uint32_t child)
{
    return child & 0x7ffffffu;
}
static inline uint32_t child_blocks(uint32_t child)
{
    return (child >> 27 & 15) + 1;
}

/* Boxes by axis and child, rounded outwards; of a child that does not exist low is +inf and high -inf. */
typedef struct bvh_node {
    float low[3][WIDTH] __attribute__((aligned(64)));
    float high[3][WIDTH]; /* right behind low: a ray counts through both */
    uint32_t child[WIDTH];
    uint32_t child_count, unused[7];
} bvh_node; /* 256 bytes */

/* A node of a tree of spheres. Its own blocks are tested when its sphere is met; then its children. */
typedef struct sphere_node {
    float center[3], radius; /* rounded outwards */
    uint32_t first_block, blocks;
    uint32_t first_child, children; /* children stand side by side */
} sphere_node;

struct hierarchy {
    const mesh *of;
    hierarchy_kind kind;
    bool single;  /* blocks are block_single */
    void *blocks; /* 64-byte aligned */
    size_t block_count;
    bvh_node *nodes;      /* bvh; [0] is the root; 64-byte aligned */
    sphere_node *spheres; /* sphere and octant; [0] is the root */
    size_t node_count;
    size_t referred;   /* bvh: triangles in its blocks; fewer than the mesh's where some had no area at the build */
    double built_cost; /* hierarchy_cost at the build; 0 of other kinds */
    void *foreign;     /* embree's */
    hierarchy_report report;
};

/* Builders of the parts. Each fills h's arrays and report (but build_s and threads) from h->of. */
status hierarchy_build_bvh(hierarchy *h, int threads, diagnostic *why);
status hierarchy_build_spheres(hierarchy *h, diagnostic *why); /* HIERARCHY_SPHERE and HIERARCHY_OCTANT */
status hierarchy_build_embree(hierarchy *h, int threads, diagnostic *why);

/* Embree's part: hierarchy_embree.c. Where it was not there at build time it is not there, its builder says so, and
 * nothing is ever hit. */
void hierarchy_embree_destroy(hierarchy *h);
void hierarchy_embree_nearest(const hierarchy *h, const mesh_ray *ray, mesh_hit *hit);
bool hierarchy_embree_any(const hierarchy *h, const mesh_ray *ray);
void hierarchy_embree_all(const hierarchy *h, const mesh_ray *ray, mesh_visit *visit, void *context);

/* Writes triangles order[0 .. count-1] as blocks from block number `first` on, the last one filled up by repetition;
 * returns how many blocks. */
size_t hierarchy_fill_blocks(hierarchy *h, const uint32_t *order, size_t count, size_t first);
/* Memory for so many blocks and nodes, aligned; false when memory is out. */
bool hierarchy_make_blocks(hierarchy *h, size_t count);
