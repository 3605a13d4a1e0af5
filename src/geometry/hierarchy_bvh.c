#include "geometry/hierarchy_bvh.h"

#include <stdlib.h>

/* Ranges of so few triangles are not split: they fill one block. */
enum { UNSPLIT = BLOCK, BRANCHES_AT_ONCE = 1024 };

/* Branches, many at a time. */
typedef struct store {
    struct store *before;
    size_t used;
    bvh_branch branches[BRANCHES_AT_ONCE];
} store;

typedef struct worker { store *branches; } worker;

static bvh_branch *new_branch(worker *w)
{
    if (!w->branches || w->branches->used == BRANCHES_AT_ONCE) {
        store *fresh = malloc(sizeof *fresh);
        if (!fresh)
            return NULL;
        fresh->before = w->branches;
        fresh->used = 0;
        w->branches = fresh;
    }
    return &w->branches->branches[w->branches->used++];
}

static void release_branches(worker *w)
{
    while (w->branches) {
        store *s = w->branches;
        w->branches = s->before;
        free(s);
    }
}

static bvh_branch *grow(worker *w, bvh_ref *refs, const bvh_range *range, int depth)
{
    bvh_branch *b = new_branch(w);
    if (!b)
        return NULL;
    memcpy(b->low, range->box.low, sizeof b->low);
    memcpy(b->high, range->box.high, sizeof b->high);
    b->first = range->first;
    b->count = range->count;
    b->half[0] = b->half[1] = NULL;
    if (range->count > UNSPLIT) {
        bvh_range half[2];
        bvh_split(refs, range, depth, half);
        for (int i = 0; i < 2; i++) {
            b->half[i] = grow(w, refs, &half[i], depth + 1);
            if (!b->half[i])
                return NULL;
        }
    }
    bvh_choose(b);
    return b;
}

static float float_below(double v)
{
    float f = (float)v;
    return (double)f > v ? nextafterf(f, -INFINITY) : f;
}

static float float_above(double v)
{
    float f = (float)v;
    return (double)f < v ? nextafterf(f, INFINITY) : f;
}

static double least(double a, double b, double c)
{
    double ab = a < b ? a : b;
    return ab < c ? ab : c;
}

static double most(double a, double b, double c)
{
    double ab = a > b ? a : b;
    return ab > c ? ab : c;
}

static bool same_place(const vec3 *a, const vec3 *b)
{
    return a->x == b->x && a->y == b->y && a->z == b->z;
}

/* A triangle with two corners in one place is hit by no ray and is left out. */
static bool refer(const mesh *m, uint32_t triangle, bvh_ref *r)
{
    const uint32_t *corner = m->triangles[triangle].corner;
    const vec3 *a = &m->vertices[corner[0]], *b = &m->vertices[corner[1]], *c = &m->vertices[corner[2]];
    if (same_place(a, b) || same_place(b, c) || same_place(c, a))
        return false;
    r->low[0] = float_below(least(a->x, b->x, c->x));
    r->low[1] = float_below(least(a->y, b->y, c->y));
    r->low[2] = float_below(least(a->z, b->z, c->z));
    r->low[3] = bvh_lane_of(triangle);
    r->high[0] = float_above(most(a->x, b->x, c->x));
    r->high[1] = float_above(most(a->y, b->y, c->y));
    r->high[2] = float_above(most(a->z, b->z, c->z));
    r->high[3] = 0.0f;
    return true;
}

static void refer_all(const mesh *m, bvh_ref *refs, bvh_range *all)
{
    *all = (bvh_range){.box = bvh_box_empty(), .centers = bvh_box_empty()};
    for (size_t i = 0; i < m->triangle_count; i++)
        if (refer(m, (uint32_t)i, &refs[all->count]))
            bvh_range_add(all, &refs[all->count++]);
}

status hierarchy_build_bvh(hierarchy *h, int threads, diagnostic *why)
{
    const mesh *m = h->of;
    bvh_ref *refs = aligned_alloc(64, (m->triangle_count * sizeof *refs + 63) / 64 * 64 + 64);
    if (!refs)
        return diagnose(why, STATUS_FAILURE, "", "out of memory");
    h->single = m->single;
    bvh_range all;
    refer_all(m, refs, &all);
    worker w = {0};
    bvh_branch *root = all.count ? grow(&w, refs, &all, 0) : NULL;
    status code = all.count && !root ? diagnose(why, STATUS_FAILURE, "", "out of memory") : bvh_gather(h, root, refs, threads, why);
    size_t block = h->single ? sizeof(block_single) : sizeof(block_double);
    h->report.bytes = sizeof *h + h->node_count * sizeof *h->nodes + h->block_count * block;
    release_branches(&w);
    free(refs);
    return code;
}
