/* The preview: every visible solid as triangles, drawn one by one into a depth buffer (Catmull, "A subdivision algorithm for computer display
 * of curved surfaces", 1974), the reports' alternative to tracing. It tells which triangle each camera ray of the tracer meets, and the tracer
 * shades that: the same rays, the same light. It knows no shadow, no reflection, no refraction, and a clear solid is drawn as its surface.
 *
 * A frame is made in steps: zbuffer_create cuts analytic solids into triangles; zbuffer_project, called by all workers at once, takes the
 * triangles into the picture; zbuffer_sort deals them to squares of the picture; zbuffer_draw, by whoever has a piece of the picture, draws it.
 * The steps wait for each other. What is drawn depends on no order. Ownership: create gives, destroy releases; the plan is borrowed. */
#ifndef CUVETTE_RENDER_ZBUFFER_H
#define CUVETTE_RENDER_ZBUFFER_H

#include "render/plan.h"
#include "render/schedule.h"

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
typedef struct zbuffer_square { double nearness[SQUARE_POINTS * SQUARE_POINTS]; } zbuffer_square;

/* Different pieces may be drawn by different threads. */
void zbuffer_draw(zbuffer *z, const span *piece, zbuffer_square *square);

/* How many triangles are in the picture, and the bytes that they and the picture's buffer take. After zbuffer_sort. */
size_t zbuffer_triangles(const zbuffer *z);
size_t zbuffer_bytes(const zbuffer *z);

#endif
