/* The preview: every visible solid as triangles, drawn one by one into a depth buffer (Catmull, "A subdivision
 * algorithm for computer display of curved surfaces", 1974), the reports' alternative to tracing. It tells which
 * triangle each camera ray of the tracer meets, and the tracer shades that: the same rays, the same light. It knows no
 * shadow, and no ray is traced. Through clear solids the view goes straight on: each of their interfaces before the
 * nearest opaque surface, at most render.depth of them, adds its light and what the sky sends along the reflected
 * direction, by Fresnel's weights or the material's, and what is behind is seen with the rest, dimmed by what the media
 * absorb on the straight way. For the weights the view is bent as a ray is, so that total reflection shows the sky.
 * Where render.lighting follows no branches, a clear solid is drawn as its surface.
 *
 * A frame is made in steps: zbuffer_create cuts analytic solids into triangles; zbuffer_project, called by all workers
 * at once, takes the triangles into the picture; zbuffer_sort deals them to squares of the picture; zbuffer_draw, by
 * whoever has a piece of the picture, draws it. The steps wait for each other. What is drawn depends on no order.
 * Ownership: create gives, destroy releases; the plan is borrowed. */
#pragma once

#include "render/core/plan.h"
#include "render/core/schedule.h"

typedef struct zbuffer zbuffer;

/* STATUS_FAILURE: memory is out; STATUS_BAD_INPUT: a solid is too small to be cut into triangles, the picture too
 * large for so many samples. */
status zbuffer_create(const plan *p, zbuffer **out, diagnostic *why);
void zbuffer_destroy(zbuffer *z); /* NULL is allowed */

/* Takes parts of the scene until there are none left; from any number of threads. */
void zbuffer_project(zbuffer *z);
status zbuffer_sort(zbuffer *z, diagnostic *why);

/* What drawing needs for itself: one for each thread that draws. */
enum { SQUARE_POINTS = 64 /* across */ };
typedef struct rasterised_fragment {
    double nearness;
    uint32_t number;
    int32_t next, part;
} rasterised_fragment; /* next of the same point, or -1 */
typedef struct zbuffer_square {
    double nearness[SQUARE_POINTS * SQUARE_POINTS];
    int32_t newest[SQUARE_POINTS * SQUARE_POINTS]; /* by point: fragment, or -1 */
    rasterised_fragment *fragments, *column;       /* of the square's layers; of one point, in order */
    size_t count, capacity, column_capacity;
    struct rasterised_layer *block; /* of the frame's lists, the one that is being filled; NULL: none yet */
    uint32_t block_number, used;
} zbuffer_square;
void zbuffer_square_begin(zbuffer_square *s); /* before each frame; all zero at first */
void zbuffer_square_release(zbuffer_square *s);

/* Different pieces may be drawn by different threads. */
void zbuffer_draw(zbuffer *z, const span *piece, zbuffer_square *square);

/* Was memory out while it was drawn? Then the picture is not whole. */
bool zbuffer_failed(const zbuffer *z);

/* How many triangles are in the picture, and the bytes that they and the picture's buffer take. After zbuffer_sort. */
size_t zbuffer_triangles(const zbuffer *z);
size_t zbuffer_bytes(const zbuffer *z);
