/* Where a line runs inside a body, and how large and how thick a body is. Pure. */
#ifndef CUVETTE_LINT_LINES_H
#define CUVETTE_LINT_LINES_H

#include "geometry/arrangement.h"
#include "geometry/forest.h"

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
bool line_through(const arrangement *a, const body *b, const line *l, line_spans *out);

/* The box around a body; infinite along the axes in which it is. */
bounds3 bounds_of_body(const arrangement *a, const body *b);

/* How thick a solid is where it is thinnest: of a cup its wall or floor, of a mesh twice its volume over its area,
 * which of a plate is its thickness, and of no convex body more than its width. */
double shape_thickness(const solid_shape *shape);

#endif
