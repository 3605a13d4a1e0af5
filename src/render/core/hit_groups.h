/* Groups of a batch's rays that are shaded together: first those that hit one primitive on one region's surface, then
 * neighbours among these groups that look alike. Shading works on structures of arrays, so that in a scene of many
 * solids small groups would leave most lanes empty.
 *
 * Ownership: values; the table of marks belongs to the tracer. Cannot fail. */
#pragma once

#include "geometry/rays.h"

/* Rays first .. first + count - 1 of the list hit that primitive on the surface of the region with that priority
 * index. */
typedef struct hit_group {
    int hit_primitive, priority_index;
    int first, count;
} hit_group;

typedef struct hit_groups {
    int count;
    hit_group group[BATCH]; /* those that look alike are neighbours */
    int list[ROW];          /* of the batch's rays */
    int missed, miss[ROW];  /* rays that hit nothing */
} hit_groups;

/* alike: by priority index, equal numbers (from 0, below the number of priority indices) for regions whose hits may be
 * shaded together. marks: for each primitive and, from alike_marks on, for each of these numbers; all -1 before and
 * after. Groups are in the order of their first rays. */
void hit_groups_make(const hit_batch *hits, int count, const int *alike, int16_t *marks, int16_t *alike_marks,
                     hit_groups *out);
