/* The memory of a hierarchy, and its blocks of four triangles, in single or double precision. */
#include "base/array.h"
#include "base/cancel.h"
#include "geometry/hierarchy/layout.h"

#include <stdlib.h>

enum { CACHE_LINE = 64 };

void *hierarchy_allocate(size_t bytes)
{
    const size_t rounded = (bytes + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE;
    return large_pages(aligned_alloc(CACHE_LINE, rounded ? rounded : CACHE_LINE), rounded);
}

static size_t block_bytes(const hierarchy *h)
{
    return h->single ? sizeof(block_single) : sizeof(block_double);
}

bool hierarchy_make_blocks(hierarchy *h, size_t count)
{
    h->blocks = hierarchy_allocate(count * block_bytes(h));
    h->block_count = h->blocks ? count : 0;
    return h->blocks;
}

static void fill_single(const mesh *m, const uint32_t *order, size_t last, block_single *b)
{
    for (size_t lane = 0; lane < BLOCK; lane++) {
        uint32_t triangle = order[lane < last ? lane : last];
        b->triangle[lane] = triangle;
        for (int corner = 0; corner < 3; corner++) {
            const vec3 *v = &m->vertices[m->triangles[triangle].corner[corner]];
            b->corner[corner][0][lane] = (float)v->x;
            b->corner[corner][1][lane] = (float)v->y;
            b->corner[corner][2][lane] = (float)v->z;
        }
    }
}

static void fill_double(const mesh *m, const uint32_t *order, size_t last, block_double *b)
{
    for (size_t lane = 0; lane < BLOCK; lane++) {
        uint32_t triangle = order[lane < last ? lane : last];
        b->triangle[lane] = triangle;
        for (int corner = 0; corner < 3; corner++) {
            const vec3 *v = &m->vertices[m->triangles[triangle].corner[corner]];
            b->corner[corner][0][lane] = v->x;
            b->corner[corner][1][lane] = v->y;
            b->corner[corner][2][lane] = v->z;
        }
    }
}

size_t hierarchy_fill_blocks(hierarchy *h, const uint32_t *order, size_t count, size_t first)
{
    size_t blocks = (count + BLOCK - 1) / BLOCK;
    for (size_t i = 0; i < blocks && !cancel_asked_at(i); i++) {
        size_t left = count - i * BLOCK, last = (left < BLOCK ? left : BLOCK) - 1;
        if (h->single)
            fill_single(h->of, order + i * BLOCK, last, (block_single *)h->blocks + first + i);
        else
            fill_double(h->of, order + i * BLOCK, last, (block_double *)h->blocks + first + i);
    }
    return blocks;
}

status hierarchy_build_none(hierarchy *h, diagnostic *why)
{
    const size_t count = h->of->triangle_count;
    uint32_t *order = malloc((count + 1) * sizeof *order);
    const bool complete = order && hierarchy_make_blocks(h, (count + BLOCK - 1) / BLOCK);
    if (complete) {
        for (size_t i = 0; i < count; i++)
            order[i] = (uint32_t)i;
        hierarchy_fill_blocks(h, order, count, 0);
        if (cancel_asked()) {
            free(order);
            return cancel_check(why);
        }
        h->report.bytes = h->block_count * (h->single ? sizeof(block_single) : sizeof(block_double));
        h->report.leaves = 1;
    }
    free(order);
    return complete ? STATUS_OK
                    : diagnose(why, STATUS_FAILURE, "use a smaller mesh", "out of memory for %zu triangles", count);
}
