/* Intersections of lines with solids, and the extent and thickness of solids. Pure. */
#pragma once

#include "geometry/scene_geometry.h"
#include "geometry/regions/instance_set.h"

typedef struct line {
    vec3 origin, direction;
} line; /* with a unit direction; infinite in both directions */

enum { SPANS_MAX = 32 };
/* Sorted and disjoint. Ends may be infinite. */
typedef struct line_spans {
    int count;
    double in[SPANS_MAX], out[SPANS_MAX];
} line_spans;

/* False if undecidable: an open mesh, more than SPANS_MAX spans, or a line through an edge of a mesh that counts as no
 * or two crossings. */
bool line_through(const scene_geometry *a, const region *b, const line *l, line_spans *out);
