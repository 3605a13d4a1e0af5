/* The z-buffer preview: every visible solid is rasterised as triangles into a depth buffer (Catmull, "A subdivision
 * algorithm for computer display of curved surfaces", 1974), the published reports' alternative to ray tracing. It
 * finds the triangle that each camera ray of the tracer hits, and the tracer shades it: rays and light are the same,
 * but there are no shadows, and no ray is tested against solids. Through clear solids the view continues undeflected:
 * each of their interfaces before the nearest opaque surface, at most render.depth of them, adds its light and the sky
 * radiance of the reflected direction, weighted by Fresnel or the material; what is behind is attenuated by the weights
 * and by absorption along the straight path. For the weights the view direction is refracted like a ray, so that total
 * reflection shows the sky. If render.lighting follows no branches, only the surface of a clear solid is drawn.
 *
 * A frame is made in steps: zbuffer_create cuts analytic solids into triangles; zbuffer_project, called by all workers
 * at once, projects the triangles into the image; zbuffer_sort assigns them to squares of the image; zbuffer_draw,
 * called by the worker of a tile, rasterises it. Each step starts when the previous one has ended. The
 * result does not depend on the order. Ownership: zbuffer_create allocates, zbuffer_destroy releases; the plan is
 * borrowed. */
#pragma once

#include "render/plan/plan.h"
#include "render/plan/schedule.h"

typedef struct zbuffer zbuffer;

/* STATUS_FAILURE: out of memory; STATUS_BAD_INPUT: a solid is too small to be cut into triangles, or the image too
 * large for this number of samples. */
status zbuffer_create(const plan *p, zbuffer **out, diagnostic *why);
void zbuffer_destroy(zbuffer *z); /* NULL is allowed */

/* Projects parts of the scene until none are left; called by any number of threads. */
void zbuffer_project(zbuffer *z);
status zbuffer_sort(zbuffer *z, diagnostic *why);

/* Scratch memory of zbuffer_draw: one for each thread that draws. */
enum { SQUARE_POINTS = 64 /* along one side */ };
typedef struct rasterised_fragment {
    double nearness;
    uint32_t number;
    int32_t next, part;
} rasterised_fragment; /* next: next fragment of the same point, or -1 */
typedef struct zbuffer_square {
    double nearness[SQUARE_POINTS * SQUARE_POINTS];
    int32_t newest[SQUARE_POINTS * SQUARE_POINTS]; /* by point: fragment, or -1 */
    rasterised_fragment *fragments, *column; /* fragments: of the square's layers; column: of one point, in order */
    size_t count, capacity, column_capacity;
    struct rasterised_layer *block; /* block of the frame's lists that is being filled; NULL: none yet */
    uint32_t block_number, used;
} zbuffer_square;
void zbuffer_square_begin(zbuffer_square *s); /* call it before each frame; zero the square before the first one */
void zbuffer_square_release(zbuffer_square *s);

/* Different threads may draw different tiles. */
void zbuffer_draw(zbuffer *z, const image_tile *tile, zbuffer_square *square);

/* True when drawing ran out of memory; the image is then incomplete. */
bool zbuffer_failed(const zbuffer *z);

/* The number of triangles in the image, and the bytes of the triangles and the buffer. Call them after zbuffer_sort. */
size_t zbuffer_triangles(const zbuffer *z);
size_t zbuffer_bytes(const zbuffer *z);
