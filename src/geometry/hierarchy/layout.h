/* The memory layouts that hierarchies are built into and traversed in; private to this folder.
 *
 * Triangles are stored in blocks of four, as structures of arrays, and tested four at a time. A block that is not full
 * repeats its last triangle, which changes no hit. If every coordinate of the mesh is exactly a float, blocks hold
 * floats: half the memory, identical results. */
#pragma once

#include "geometry/hierarchy/hierarchy.h"

/* Triangles per block, children per node, blocks per leaf (four bits of a child), and the levels of nodes, which size
 * the stacks of the traversals. */
enum { BLOCK = 4, WIDTH = 8, LEAF_BLOCKS_MAX = 16, BVH_DEPTH_MAX = 64, SPHERES_DEPTH_MAX = 64 };

typedef struct block_single {
    float corner[3][3][BLOCK];
    uint32_t triangle[BLOCK];
} block_single; /* [corner][axis][lane] */
typedef struct block_double {
    double corner[3][3][BLOCK];
    uint32_t triangle[BLOCK];
} block_double;

/* A child: a node's number, or a range of blocks: LEAF | (number of blocks - 1) << 27 | number of the first block. */
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

/* Boxes by axis and child, rounded outwards; an unused child has low +inf and high -inf. */
typedef struct bvh_node {
    float low[3][WIDTH] __attribute__((aligned(64)));
    float high[3][WIDTH]; /* must follow low: a ray's plane offsets run through both */
    uint32_t child[WIDTH];
    uint32_t child_count, unused[7];
} bvh_node; /* 256 bytes */

/* A node of a sphere tree. If a ray hits its sphere, its own blocks are tested, then its children. */
typedef struct sphere_node {
    float center[3], radius; /* rounded outwards */
    uint32_t first_block, blocks;
    uint32_t first_child, children; /* children are contiguous */
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
    size_t referred;   /* bvh: triangles in its blocks; fewer than the mesh's if some had coinciding corners */
    double built_cost; /* hierarchy_cost at the build; 0 for other kinds */
    float reach[3];    /* bvh: the largest magnitude of a box's planes, by axis */
    hierarchy_report report;
};

/* Builders by kind. Each fills h's arrays and report from h->of, except build_s and, with one thread, threads. */
status hierarchy_build_none(hierarchy *h, diagnostic *why); /* all triangles in blocks, in order */
status hierarchy_build_bvh(hierarchy *h, int threads, diagnostic *why);
status hierarchy_build_spheres(hierarchy *h, diagnostic *why); /* HIERARCHY_SPHERE and HIERARCHY_OCTANT */

/* Writes triangles order[0 .. count-1] into blocks from block number `first` on, fills the last block by repetition,
 * and returns the number of blocks. */
size_t hierarchy_fill_blocks(hierarchy *h, const uint32_t *order, size_t count, size_t first);
/* Memory that starts at a cache line, in large pages (base/array.h): a ray through a large mesh jumps between
 * pages, and looking up their addresses would cost as much as the data. Freed with free; NULL: out of memory. */
void *hierarchy_allocate(size_t bytes);
/* Allocates memory for that many blocks; false: out of memory. */
bool hierarchy_make_blocks(hierarchy *h, size_t count);
