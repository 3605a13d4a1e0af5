/* The memory of a hierarchy and its blocks of four triangles, in single or double precision; and the builder of the
 * sphere trees. `sphere` is a tree of one node. `octant` is the tree of the published rod report: a shell bounds the
 * triangles; its centre divides them among eight octants by their own centres, except those larger than a quarter of
 * the shell's radius, which stay with the shell. */
#include "geometry/hierarchy/layout.h"

#include "base/array.h"
#include "base/cancel.h"
#include "base/lanes.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- memory and blocks --- */

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

/* --- sphere trees --- */

enum { OCTANTS = 8, STAY = OCTANTS };

/* `order` is permuted in place; `octant` holds the destination of each triangle in the current division. */
typedef struct spheres_build {
    hierarchy *h;
    uint32_t *order, *moved;
    uint8_t *octant;
    size_t nodes, blocks;
    int depth;
    bool write; /* the first pass counts, the second writes */
} spheres_build;

static double axis_of(vec3 v, int k)
{
    return k == 0 ? v.x : k == 1 ? v.y : v.z;
}

typedef struct box {
    double low[3], high[3];
} box;

static void box_of_triangle(const mesh *m, uint32_t triangle, box *b)
{
    for (int k = 0; k < 3; k++) {
        b->low[k] = INFINITY;
        b->high[k] = -INFINITY;
        for (int j = 0; j < 3; j++) {
            const double v = axis_of(m->vertices[m->triangles[triangle].corner[j]], k);
            b->low[k] = fmin(b->low[k], v);
            b->high[k] = fmax(b->high[k], v);
        }
    }
}

/* Half the box's diagonal. */
static double radius_of(const box *b)
{
    double square = 0.0;
    for (int k = 0; k < 3; k++)
        square += (b->high[k] - b->low[k]) * (b->high[k] - b->low[k]);
    return 0.5 * sqrt(square);
}

/* The bounding sphere of the triangles' boxes, not of the triangles: a hit may be anywhere in its triangle's box
 * (query.h). */
static void shell_of(const spheres_build *b, size_t first, size_t count, sphere_node *s)
{
    box all = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}}, one;
    for (size_t i = first; i < first + count && !cancel_asked_at(i); i++) {
        box_of_triangle(b->h->of, b->order[i], &one);
        for (int k = 0; k < 3; k++) {
            all.low[k] = fmin(all.low[k], one.low[k]);
            all.high[k] = fmax(all.high[k], one.high[k]);
        }
    }
    double center[3];
    for (int k = 0; k < 3; k++) {
        center[k] = single_round(0.5 * (all.low[k] + all.high[k]));
        s->center[k] = (float)center[k];
    }
    double most = 0.0;
    for (size_t i = first; i < first + count && !cancel_asked_at(i); i++) {
        box_of_triangle(b->h->of, b->order[i], &one);
        double square = 0.0;
        for (int k = 0; k < 3; k++) {
            const double reach = fmax(one.high[k] - center[k], center[k] - one.low[k]);
            square += reach * reach;
        }
        most = fmax(most, square);
    }
    s->radius = nextafterf((float)(sqrt(most) * (1.0 + 0x1p-40)), INFINITY);
}

/* Sorts a node's triangles by octant, those that stay with the shell first. start[i]: the first triangle of octant i -
 * 1; start[0]: the first that stays. */
static void divide(spheres_build *b, size_t first, size_t count, const sphere_node *s, size_t start[OCTANTS + 2])
{
    size_t number[OCTANTS + 1] = {0}, at[OCTANTS + 1];
    for (size_t i = first; i < first + count; i++) {
        box one;
        box_of_triangle(b->h->of, b->order[i], &one);
        int octant = 0;
        for (int k = 0; k < 3; k++)
            octant |= (one.low[k] + one.high[k] > 2.0 * (double)s->center[k]) << k;
        b->octant[i] = (uint8_t)(radius_of(&one) > 0.25 * (double)s->radius ? 0 : octant + 1);
        number[b->octant[i]]++;
    }
    start[0] = first;
    for (int k = 0; k <= OCTANTS; k++) {
        at[k] = start[k];
        start[k + 1] = start[k] + number[k];
    }
    for (size_t i = first; i < first + count; i++)
        b->moved[at[b->octant[i]]++] = b->order[i];
    memcpy(b->order + first, b->moved + first, count * sizeof *b->order);
}

/* Builds node number `at` from triangles first .. first + count - 1. */
static void build_node(spheres_build *b, size_t at, size_t first, size_t count, int level)
{
    if (cancel_asked())
        return;
    sphere_node s = {.first_block = (uint32_t)b->blocks};
    size_t start[OCTANTS + 2], octants = 0;
    shell_of(b, first, count, &s);
    b->depth = level > b->depth ? level : b->depth;
    for (int k = 0; k <= OCTANTS + 1; k++)
        start[k] = k == 0 ? first : first + count;
    if (b->h->kind == HIERARCHY_OCTANT && count > BLOCK && level < SPHERES_DEPTH_MAX)
        divide(b, first, count, &s, start);
    for (int k = 1; k <= OCTANTS; k++)
        octants += start[k + 1] > start[k];
    s.first_child = (uint32_t)b->nodes;
    s.children = (uint32_t)octants;
    s.blocks = (uint32_t)((start[1] - first + BLOCK - 1) / BLOCK);
    if (b->write) {
        b->h->spheres[at] = s;
        hierarchy_fill_blocks(b->h, b->order + first, start[1] - first, b->blocks);
    }
    b->blocks += s.blocks;
    b->nodes += octants;
    for (size_t k = 1, child = s.first_child; k <= OCTANTS; k++)
        if (start[k + 1] > start[k])
            build_node(b, child++, start[k], start[k + 1] - start[k], level + 1);
}

static void run_pass(spheres_build *b, bool write)
{
    const size_t count = b->h->of->triangle_count;
    b->write = write;
    b->nodes = 1;
    b->blocks = 0;
    b->depth = 0;
    for (size_t i = 0; i < count; i++)
        b->order[i] = (uint32_t)i;
    if (count)
        build_node(b, 0, 0, count, 1);
}

status hierarchy_build_spheres(hierarchy *h, diagnostic *why)
{
    const size_t count = h->of->triangle_count;
    spheres_build b = {.h = h};
    b.order = malloc((count + 1) * sizeof *b.order);
    b.moved = malloc((count + 1) * sizeof *b.moved);
    b.octant = malloc(count + 1);
    bool complete = b.order && b.moved && b.octant;
    if (complete) {
        run_pass(&b, false);
        h->spheres = cancel_asked() ? NULL : calloc(b.nodes, sizeof *h->spheres);
        complete = h->spheres && hierarchy_make_blocks(h, b.blocks);
    }
    if (complete) {
        run_pass(&b, true);
        complete = !cancel_asked();
        h->node_count = b.nodes;
        h->report.bytes =
            b.nodes * sizeof *h->spheres + b.blocks * (h->single ? sizeof(block_single) : sizeof(block_double));
        h->report.nodes = b.nodes;
        h->report.depth = b.depth;
        for (size_t i = 0; i < b.nodes; i++)
            h->report.leaves += h->spheres[i].blocks > 0;
    }
    free(b.order);
    free(b.moved);
    free(b.octant);
    return complete         ? STATUS_OK
           : cancel_asked() ? cancel_check(why)
                            : diagnose(why, STATUS_FAILURE, "use a smaller mesh",
                                       "out of memory for a hierarchy of %zu triangles", count);
}
