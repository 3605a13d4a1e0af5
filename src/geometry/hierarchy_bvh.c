/* The driver of the bvh builder: computes the references, builds the tree and collapses it. */
#include "base/cancel.h"
#include "base/array.h"
#include "geometry/hierarchy_bvh.h"

#include <stdlib.h>

enum { PIECE = 16384 }; /* triangles per task when references are computed */

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

/* A triangle with two corners at one position can never be hit and is left out. */
static bool make_reference(const mesh *m, uint32_t triangle, bvh_ref *r)
{
    const uint32_t *corner = m->triangles[triangle].corner;
    const vec3 *a = &m->vertices[corner[0]], *b = &m->vertices[corner[1]], *c = &m->vertices[corner[2]];
    if (same_place(a, b) || same_place(b, c) || same_place(c, a))
        return false;
    r->low[0] = bvh_float_below(least(a->x, b->x, c->x));
    r->low[1] = bvh_float_below(least(a->y, b->y, c->y));
    r->low[2] = bvh_float_below(least(a->z, b->z, c->z));
    r->low[3] = bvh_lane_of(triangle);
    r->high[0] = bvh_float_above(most(a->x, b->x, c->x));
    r->high[1] = bvh_float_above(most(a->y, b->y, c->y));
    r->high[2] = bvh_float_above(most(a->z, b->z, c->z));
    r->high[3] = 0.0f;
    return true;
}

typedef struct reference_job {
    const mesh *m;
    bvh_ref *refs;
    bvh_range *pieces; /* the references of each PIECE triangles; first is their position */
} reference_job;

static void read_piece(void *context, size_t index, int member)
{
    (void)member;
    const reference_job *r = context;
    if (cancel_asked())
        return;
    size_t first = index * PIECE, end = first + PIECE < r->m->triangle_count ? first + PIECE : r->m->triangle_count;
    bvh_range piece = {.box = bvh_box_empty(), .centers = bvh_box_empty(), .first = (uint32_t)first};
    for (size_t i = first; i < end; i++)
        if (make_reference(r->m, (uint32_t)i, &r->refs[first + piece.count]))
            bvh_range_add(&piece, &r->refs[first + piece.count++]);
    r->pieces[index] = piece;
}

static status read_triangles(const mesh *m, thread_team *t, bvh_ref *refs, bvh_range *all, diagnostic *why)
{
    size_t count = (m->triangle_count + PIECE - 1) / PIECE;
    reference_job r = {m, refs, aligned_alloc(64, (count + 1) * 64 * ((sizeof(bvh_range) + 63) / 64))};
    if (!r.pieces)
        return out_of_memory(why);
    thread_team_run(t, read_piece, &r, count);
    const status code = cancel_check(why); /* pieces may be missing */
    if (code != STATUS_OK)
        count = 0;
    *all = (bvh_range){.box = bvh_box_empty(), .centers = bvh_box_empty()};
    for (size_t i = 0; i < count; i++) {
        const bvh_range *piece = &r.pieces[i];
        if (all->count != piece->first)
            memmove(&refs[all->count], &refs[piece->first], piece->count * sizeof *refs);
        all->count += piece->count;
        bvh_box_add(&all->box, piece->box.low, piece->box.high);
        bvh_box_add(&all->centers, piece->centers.low, piece->centers.high);
    }
    free(r.pieces);
    return code;
}

static status build(hierarchy *h, thread_team *t, bvh_ref *refs, diagnostic *why)
{
    bvh_range all;
    TRY(read_triangles(h->of, t, refs, &all, why));
    h->referred = all.count;
    bvh_tree tree;
    status code = bvh_build_tree(&tree, t, refs, &all, why);
    THEN(code, bvh_collapse(h, tree.root, refs, t, why));
    bvh_free(&tree);
    if (code == STATUS_OK)
        bvh_find_reach(h);
    return code;
}

/* The number of threads for a build: no more than there are tasks. */
static int useful(int threads, size_t triangles)
{
    size_t most = triangles / TASK_TRIANGLES + 1;
    return (size_t)threads < most ? threads : (int)most;
}

status hierarchy_build_bvh(hierarchy *h, int threads, diagnostic *why)
{
    const mesh *m = h->of;
    h->single = m->single;
    const size_t bytes = (m->triangle_count + 2) / 2 * 2 * sizeof(bvh_ref);
    bvh_ref *refs = large_pages(aligned_alloc(64, bytes), bytes);
    thread_team *t = thread_team_create(useful(threads, m->triangle_count));
    status code = refs && t ? build(h, t, refs, why) : out_of_memory(why);
    thread_team_destroy(t);
    free(refs);
    size_t block = h->single ? sizeof(block_single) : sizeof(block_double);
    h->report.bytes = sizeof *h + h->node_count * sizeof *h->nodes + h->block_count * block;
    return code;
}
