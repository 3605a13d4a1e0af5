/* A solid view: the few solids of a large scene that any ray of a batch may meet, as a scene geometry of their own with
 * other numbers, in which all primitives are direct. For coherent batches it is faster to find these solids once and to
 * test all rays against each of them, eight at a time, than to search the solid tree for every ray.
 *
 * Part of the scratch of a batch; borrows the outer geometry. Cannot fail. */
#pragma once

#include "geometry/scene_geometry.h"

enum { VIEW_PRIMITIVES_MAX = 24 }; /* with more the search for every ray was measured to be faster */

typedef struct solid_view {
    const scene_geometry *of; /* the whole scene */
    scene_geometry inner;     /* its arrays are those below */
    primitive primitives[VIEW_PRIMITIVES_MAX];
    region regions[VIEW_PRIMITIVES_MAX + 1];
    int direct_regions[VIEW_PRIMITIVES_MAX];
    int outer_primitive[VIEW_PRIMITIVES_MAX];  /* by primitive */
    int outer_region[VIEW_PRIMITIVES_MAX + 1]; /* by priority index */
} solid_view;
