/* The solid tree: a hierarchy of bounding boxes over the bounded solids of a scene without triangles, for scenes with
 * many. A ray is tested only against the solids whose boxes it hits; the other primitives of the scene geometry, the
 * direct ones, are tested by every batch.
 *
 * Ownership: solid_tree_build creates, solid_tree_destroy frees; it borrows the scene geometry that it is part of. */
#pragma once

#include "geometry/rays.h"
#include "geometry/set_table.h"
#include "geometry/solid_boxes.h"

typedef struct solid_tree {
    const scene_geometry *of;
    int count;
    int *region; /* priority indices of the tree's solids, ascending: item i of the boxes is region[i] */
    solid_boxes boxes;
    set_table *sets;
} solid_tree;

/* For a geometry whose primitives and regions are complete: over the primitives that are not direct. */
status solid_tree_build(const scene_geometry *a, solid_tree **out, diagnostic *why);
void solid_tree_destroy(solid_tree *t);

/* The set of the direct primitives of those bits and the tree's primitives that contain the point. */
uint64_t solid_tree_inside(const solid_tree *t, uint64_t direct, vec3 point);

/* The priority index of the medium for a set of primitives. */
int solid_tree_priority_index(const solid_tree *t, uint64_t set);

/* A set of primitives as its direct ones, by bit, and the set of the others. */
typedef struct split_set {
    uint64_t direct, others;
} split_set;
split_set solid_tree_split(const solid_tree *t, uint64_t set);
uint64_t solid_tree_join(const solid_tree *t, split_set parts);
