#include "geometry/hierarchy_private.h"

#include "geometry/mesh_share.h"
#include <stdlib.h>
#include <time.h>

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* All triangles as they come. */
static status build_none(hierarchy *h, diagnostic *why)
{
    const size_t count = h->of->triangle_count;
    uint32_t *order = malloc((count + 1) * sizeof *order);
    const bool made = order && hierarchy_make_blocks(h, (count + BLOCK - 1) / BLOCK);
    if (made) {
        for (size_t i = 0; i < count; i++)
            order[i] = (uint32_t)i;
        hierarchy_fill_blocks(h, order, count, 0);
        h->report.bytes = h->block_count * (h->single ? sizeof(block_single) : sizeof(block_double));
        h->report.leaves = 1;
    }
    free(order);
    return made ? STATUS_OK : diagnose(why, STATUS_FAILURE, "use a smaller mesh", "out of memory for %zu triangles", count);
}

static status build(hierarchy *h, int threads, diagnostic *why)
{
    switch (h->kind) {
    case HIERARCHY_NONE:
        return build_none(h, why);
    case HIERARCHY_SPHERE:
    case HIERARCHY_OCTANT:
        return hierarchy_build_spheres(h, why);
    case HIERARCHY_BVH:
        return hierarchy_build_bvh(h, threads, why);
    case HIERARCHY_EMBREE:
        return hierarchy_build_embree(h, threads, why);
    case HIERARCHY_KIND_COUNT:
        break;
    }
    return diagnose(why, STATUS_BAD_INPUT, "choose none, sphere, octant, bvh or embree", "there is no hierarchy of kind %d", (int)h->kind);
}

status hierarchy_build(const mesh *m, hierarchy_kind kind, int threads, hierarchy **out, diagnostic *why)
{
    *out = NULL;
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
    h->report.build_s = now_s() - begun;
    *out = h;
    return STATUS_OK;
}

void hierarchy_destroy(hierarchy *h)
{
    if (!h)
        return;
    if (h->foreign)
        hierarchy_embree_destroy(h);
    free(h->blocks);
    free(h->nodes);
    free(h->spheres);
    free(h);
}

hierarchy_report hierarchy_describe(const hierarchy *h)
{
    return h->report;
}

bool hierarchy_has(hierarchy_kind kind)
{
    return kind >= HIERARCHY_NONE && kind < HIERARCHY_KIND_COUNT && (kind != HIERARCHY_EMBREE || hierarchy_embree_there());
}

status hierarchy_of_mesh(const mesh *m, hierarchy_kind kind, int threads, const hierarchy **out, diagnostic *why)
{
    *out = NULL;
    if (kind < HIERARCHY_NONE || kind >= HIERARCHY_KIND_COUNT)
        return diagnose(why, STATUS_BAD_INPUT, "choose none, sphere, octant, bvh or embree", "there is no hierarchy of kind %d", (int)kind);
    hierarchy **kept = &m->share->hierarchies[kind], *h = __atomic_load_n(kept, __ATOMIC_ACQUIRE);
    status s = STATUS_OK;
    if (!h) {
        pthread_mutex_lock(&m->share->mutex);
        h = __atomic_load_n(kept, __ATOMIC_ACQUIRE);
        if (!h) {
            s = hierarchy_build(m, kind, threads, &h, why);
            if (s == STATUS_OK) {
                m->share->destroy = hierarchy_destroy;
                __atomic_store_n(kept, h, __ATOMIC_RELEASE);
            }
        }
        pthread_mutex_unlock(&m->share->mutex);
    }
    *out = h;
    return s;
}
