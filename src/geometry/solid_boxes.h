/* A hierarchy of axis-aligned boxes, eight to a node, over the solids of a solid tree: median splits along the longest
 * axis. Boxes are single precision, rounded outwards.
 *
 * Ownership: solid_boxes_build creates, solid_boxes_destroy frees. Any number of threads may use it at once. */
#pragma once

#include "base/status.h"
#include "geometry/mesh.h"

enum { BOXES_WIDE = 8, BOXES_DEPTH_MAX = 24 };

/* Boxes by axis and child. A child is a node's number, or ~i for item i. */
typedef struct boxes_node {
    float low[3][BOXES_WIDE] __attribute__((aligned(64)));
    float high[3][BOXES_WIDE];
    int32_t child[BOXES_WIDE];
    int32_t count, unused[7];
} boxes_node;

typedef struct solid_boxes {
    boxes_node *nodes; /* [0] is the root */
    int node_count;
    float reach; /* the largest magnitude of a coordinate */
} solid_boxes;

/* count: at least 1. */
status solid_boxes_build(const bounds3 *items, int count, solid_boxes *out, diagnostic *why);
void solid_boxes_destroy(solid_boxes *b);
