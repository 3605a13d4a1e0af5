/* Where a line runs inside a body, and how large and how thick a body is. Pure. */
#pragma once

#include "geometry/scene_geometry.h"
#include "geometry/instance_set.h"

typedef struct line {
    vec3 origin, direction;
} line; /* of a unit direction; it has no ends */

enum { SPANS_MAX = 32 };
/* In order, apart from each other. Ends may be infinite. */
typedef struct line_spans {
    int count;
    double in[SPANS_MAX], out[SPANS_MAX];
} line_spans;

/* False where it cannot be said: an open mesh, more than SPANS_MAX, or a line through an edge of a mesh that is
 * taken for none or two. */
bool line_through(const scene_geometry *a, const region *b, const line *l, line_spans *out);
