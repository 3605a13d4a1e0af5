/* Hierarchies of all kinds: their build, those that a mesh owns, and their update after a move. */
#include "geometry/hierarchy/layout.h"

#include "base/budget.h"
#include "base/cancel.h"
#include "geometry/mesh/mesh_private.h"
#include <stdlib.h>
#include <time.h>

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static status build(hierarchy *h, int threads, diagnostic *why)
{
    switch (h->kind) {
    case HIERARCHY_NONE: return hierarchy_build_none(h, why);
    case HIERARCHY_SPHERE:
    case HIERARCHY_OCTANT: return hierarchy_build_spheres(h, why);
    case HIERARCHY_BVH: return hierarchy_build_bvh(h, threads, why);
    case HIERARCHY_KIND_COUNT: break;
    }
    return diagnose(why, STATUS_BAD_INPUT, "choose none, sphere, octant or bvh", "unknown hierarchy kind %d",
                    (int)h->kind);
}

/* Bytes per triangle of a hierarchy and its builder, estimated from the sizes of blocks, nodes and references. */
static uint64_t bytes_per_triangle(hierarchy_kind kind, bool single)
{
    const uint64_t block = (single ? sizeof(block_single) : sizeof(block_double)) / BLOCK;
    switch (kind) {
    case HIERARCHY_NONE: return block + sizeof(uint32_t);
    case HIERARCHY_SPHERE:
    case HIERARCHY_OCTANT: return 4 * block + 40;
    case HIERARCHY_BVH: return 2 * block + 120;
    case HIERARCHY_KIND_COUNT: break;
    }
    return 0;
}

status hierarchy_build(const mesh *m, hierarchy_kind kind, int threads, hierarchy **out, diagnostic *why)
{
    *out = NULL;
    TRY(memory_budget_check(m->triangle_count * bytes_per_triangle(kind, m->single), "use a smaller mesh", why,
                            "the hierarchy of %zu triangles", m->triangle_count));
    hierarchy *h = calloc(1, sizeof *h);
    if (!h)
        return diagnose(why, STATUS_FAILURE, "free some memory", "out of memory for a hierarchy");
    h->of = m;
    h->kind = kind;
    h->single = m->single;
    h->report.threads = 1;
    const double begun = now_s();
    const status s = build(h, threads, why);
    if (s != STATUS_OK) {
        hierarchy_destroy(h);
        return s;
    }
    h->built_cost = hierarchy_cost(h);
    h->report.build_s = now_s() - begun;
    *out = h;
    return STATUS_OK;
}

void hierarchy_destroy(hierarchy *h)
{
    if (!h)
        return;
    free(h->blocks);
    free(h->nodes);
    free(h->spheres);
    free(h);
}

hierarchy_report hierarchy_describe(const hierarchy *h)
{
    return h->report;
}

/* Refits a hierarchy owned by its mesh. false: it must be rebuilt. */
static bool follow_by_refit(hierarchy *h, double ratio, hierarchy_update_counts *moves)
{
    const double begun = now_s();
    const bool fits = hierarchy_refit(h);
    const double cost = fits ? hierarchy_cost(h) : 0.0;
    const bool cheap = fits && cost <= ratio * h->built_cost;
    if (fits) {
        const double growth = h->built_cost > 0.0 ? cost / h->built_cost : cost > 0.0 ? (double)INFINITY : 1.0;
        moves->growth = growth > moves->growth ? growth : moves->growth;
    }
    moves->refitted += cheap;
    moves->refit_s += now_s() - begun;
    return cheap;
}

static status follow_by_build(hierarchy **stored, int threads, hierarchy_update_counts *moves, diagnostic *why)
{
    const mesh *m = (*stored)->of;
    const hierarchy_kind kind = (*stored)->kind;
    const double begun = now_s();
    hierarchy_destroy(*stored); /* before the build, so that only one hierarchy is in memory at a time */
    const status s = hierarchy_build(m, kind, threads, stored, why);
    moves->rebuilt += s == STATUS_OK;
    moves->build_s += now_s() - begun;
    return s;
}

status hierarchy_update(const mesh *m, double ratio, int threads, hierarchy_update_counts *out, diagnostic *why)
{
    hierarchy_update_counts moves = {0};
    status s = STATUS_OK;
    pthread_mutex_lock(&m->shared->mutex);
    for (int kind = 0; kind < HIERARCHY_KIND_COUNT && s == STATUS_OK; kind++) {
        hierarchy *stored = __atomic_load_n(&m->shared->hierarchies[kind], __ATOMIC_ACQUIRE);
        if (!stored || follow_by_refit(stored, ratio, &moves))
            continue;
        s = follow_by_build(&stored, threads, &moves, why);
        __atomic_store_n(&m->shared->hierarchies[kind], stored, __ATOMIC_RELEASE);
    }
    for (int kind = 0; kind < HIERARCHY_KIND_COUNT && s != STATUS_OK; kind++)
        hierarchy_destroy(
            __atomic_exchange_n(&m->shared->hierarchies[kind], NULL,
                                __ATOMIC_ACQ_REL)); /* the other hierarchies are for the vertices before the move */
    pthread_mutex_unlock(&m->shared->mutex);
    if (out)
        *out = moves;
    return s;
}

status hierarchy_of_mesh(const mesh *m, hierarchy_kind kind, int threads, const hierarchy **out, diagnostic *why)
{
    *out = NULL;
    if (kind < HIERARCHY_NONE || kind >= HIERARCHY_KIND_COUNT)
        return diagnose(why, STATUS_BAD_INPUT, "choose none, sphere, octant or bvh", "unknown hierarchy kind %d",
                        (int)kind);
    hierarchy **stored = &m->shared->hierarchies[kind], *h = __atomic_load_n(stored, __ATOMIC_ACQUIRE);
    status s = STATUS_OK;
    if (!h) {
        pthread_mutex_lock(&m->shared->mutex);
        h = __atomic_load_n(stored, __ATOMIC_ACQUIRE);
        if (!h) {
            s = hierarchy_build(m, kind, threads, &h, why);
            if (s == STATUS_OK) {
                m->shared->destroy = hierarchy_destroy;
                __atomic_store_n(stored, h, __ATOMIC_RELEASE);
            }
        }
        pthread_mutex_unlock(&m->shared->mutex);
    }
    *out = h;
    return s;
}
