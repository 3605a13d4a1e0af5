/* The solid tree: a hierarchy of bounding boxes over the bounded solids of a scene without triangles, for scenes with
 * many. A ray is tested only against the solids whose boxes it hits; every batch of rays is tested against the
 * other primitives of the scene geometry, the direct ones.
 *
 * Ownership: solid_tree_build creates, solid_tree_destroy frees; it borrows the scene geometry that it is part of. */
#pragma once

#include "geometry/rays.h"
#include "geometry/regions/set_table.h"

/* The tree's hierarchy: axis-aligned boxes, eight to a node, by median splits along the longest axis. Boxes are single
 * precision, rounded outwards. Any number of threads may use it at once. */
enum { BOXES_WIDE = 8, BOXES_DEPTH_MAX = 7 };

/* Boxes by axis and child. A child is a node's number, or ~i for item i; used: -1, or 0 for no child. */
typedef struct boxes_node {
    float low[3][BOXES_WIDE] __attribute__((aligned(64)));
    float high[3][BOXES_WIDE];
    int32_t child[BOXES_WIDE], used[BOXES_WIDE];
} boxes_node;

typedef struct solid_boxes {
    boxes_node *nodes; /* [0] is the root */
    int node_count;
    float reach; /* the largest magnitude of a coordinate */
} solid_boxes;

/* count: at least 1. solid_boxes_destroy frees what solid_boxes_build creates. */
status solid_boxes_build(const bounds3 *items, int count, solid_boxes *out, diagnostic *why);
void solid_boxes_destroy(solid_boxes *b);

/* A solid of the tree. */
typedef struct tree_solid {
    int region;  /* priority index */
    int outside; /* the region's, repeated here so that its data can be prefetched */
} tree_solid;

typedef struct solid_tree {
    const scene_geometry *geometry;
    int count;
    tree_solid *solids; /* by priority index, ascending: item i of the boxes is solids[i] */
    solid_boxes boxes;
    set_table *sets;
} solid_tree;

/* Builds the tree over the primitives that are not direct; the geometry's primitives and regions are complete. */
status solid_tree_build(const scene_geometry *a, solid_tree **out, diagnostic *why);
void solid_tree_destroy(solid_tree *t);

/* Prefetches what a test of item i reads first: with many solids the time goes into waiting for memory. */
static inline void solid_tree_fetch(const solid_tree *t, int i)
{
    const char *primitive_at = (const char *)&t->geometry->primitives[t->solids[i].outside];
    __builtin_prefetch(&t->geometry->regions[t->solids[i].region]);
    for (size_t line = 0; line < sizeof(primitive); line += 64)
        __builtin_prefetch(primitive_at + line);
}

/* The set of the direct primitives in `direct` and of the tree's primitives that contain the point. */
uint64_t solid_tree_inside(const solid_tree *t, uint64_t direct, vec3 point);

/* The priority index of the medium for a set of primitives. */
int solid_tree_priority_index(const solid_tree *t, uint64_t set);

/* A set of primitives as its direct ones, by bit, and the set of the others. */
typedef struct split_set {
    uint64_t direct, others;
} split_set;
split_set solid_tree_split(const solid_tree *t, uint64_t set);
uint64_t solid_tree_join(const solid_tree *t, split_set parts);
