/* The entry points of the hierarchy kernels: prepare the query and choose the traversal. */
#include "geometry/hierarchy_query.h"

/* Tests all triangles in order. */
static void walk_blocks(const hierarchy *h, ray_query *q, enum query_mode mode)
{
    if (h->single)
        query_blocks(q, h, mode, true, 0, h->block_count);
    else
        query_blocks(q, h, mode, false, 0, h->block_count);
}

static void walk(const hierarchy *h, ray_query *q, enum query_mode mode)
{
    switch (h->kind) {
    case HIERARCHY_BVH: KERNEL(walk_bvh)(h, q, mode); break;
    case HIERARCHY_SPHERE:
    case HIERARCHY_OCTANT: KERNEL(walk_spheres)(h, q, mode); break;
    case HIERARCHY_NONE: walk_blocks(h, q, mode); break;
    case HIERARCHY_EMBREE:
    case HIERARCHY_KIND_COUNT: break;
    }
}

static void nearest(const hierarchy *h, const mesh_ray *ray, mesh_hit *hit)
{
    ray_query q;
    if (h->kind == HIERARCHY_EMBREE) {
        hierarchy_embree_nearest(h, ray, hit);
    } else {
        if (query_start(&q, ray) && h->block_count)
            walk(h, &q, QUERY_NEAREST);
        query_finish(&q, hit);
    }
}

static bool any(const hierarchy *h, const mesh_ray *ray)
{
    ray_query q;
    if (h->kind == HIERARCHY_EMBREE)
        return hierarchy_embree_any(h, ray);
    if (query_start(&q, ray) && h->block_count)
        walk(h, &q, QUERY_ANY);
    return q.best != TRIANGLE_NONE;
}

static void all(const hierarchy *h, const mesh_ray *ray, mesh_visit *visit, void *context)
{
    ray_query q;
    if (h->kind == HIERARCHY_EMBREE) {
        hierarchy_embree_all(h, ray, visit, context);
    } else if (query_start(&q, ray) && h->block_count) {
        q.visit = visit;
        q.context = context;
        walk(h, &q, QUERY_ALL);
    }
}

static void boxes(const hierarchy *h, const mesh_ray *ray, box_visit *visit, void *context)
{
    ray_query q;
    if (query_start(&q, ray) && h->kind == HIERARCHY_BVH && h->block_count) {
        q.visit_box = visit;
        q.context = context;
        walk(h, &q, QUERY_BOXES);
    }
}

/* Starts up to TOGETHER rays; `ready` lists those that can hit something. */
static int start_all(const hierarchy *h, const mesh_ray *rays, int count, ray_query *queries, ray_query **ready)
{
    int n = 0;
    for (int i = 0; i < count; i++)
        if (query_start(&queries[i], &rays[i]) && h->block_count)
            ready[n++] = &queries[i];
    return n;
}

static void go_together(const hierarchy *h, const mesh_ray *rays, int count, enum query_mode mode, ray_query *queries)
{
    ray_query *ready[TOGETHER];
    const int n = start_all(h, rays, count, queries, ready);
    if (h->kind == HIERARCHY_BVH) {
        KERNEL(walk_bvh_together)(h, ready, n, mode);
        return;
    }
    for (int i = 0; i < n; i++)
        walk(h, ready[i], mode);
}

static void nearest_batch(const hierarchy *h, const mesh_ray *rays, int count, mesh_hit *hits)
{
    for (int i = 0; h->kind == HIERARCHY_EMBREE && i < count; i++)
        hierarchy_embree_nearest(h, &rays[i], &hits[i]);
    for (int first = 0; h->kind != HIERARCHY_EMBREE && first < count; first += TOGETHER) {
        const int n = count - first < TOGETHER ? count - first : TOGETHER;
        ray_query queries[TOGETHER];
        go_together(h, rays + first, n, QUERY_NEAREST, queries);
        for (int i = 0; i < n; i++)
            query_finish(&queries[i], &hits[first + i]);
    }
}

static void any_batch(const hierarchy *h, const mesh_ray *rays, int count, bool *hit)
{
    for (int i = 0; h->kind == HIERARCHY_EMBREE && i < count; i++)
        hit[i] = hierarchy_embree_any(h, &rays[i]);
    for (int first = 0; h->kind != HIERARCHY_EMBREE && first < count; first += TOGETHER) {
        const int n = count - first < TOGETHER ? count - first : TOGETHER;
        ray_query queries[TOGETHER];
        go_together(h, rays + first, n, QUERY_ANY, queries);
        for (int i = 0; i < n; i++)
            hit[first + i] = queries[i].best != TRIANGLE_NONE;
    }
}

const hierarchy_kernels KERNEL(hierarchy_kernels) = {nearest, any, all, boxes, nearest_batch, any_batch};
