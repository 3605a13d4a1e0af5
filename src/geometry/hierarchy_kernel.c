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
    case HIERARCHY_KIND_COUNT: break;
    }
}

static void nearest(const hierarchy *h, const mesh_ray *ray, mesh_hit *hit)
{
    ray_query q;
    if (query_start(&q, ray) && h->block_count)
        walk(h, &q, QUERY_NEAREST);
    query_finish(&q, hit);
}

static bool any(const hierarchy *h, const mesh_ray *ray)
{
    ray_query q;
    if (query_start(&q, ray) && h->block_count)
        walk(h, &q, QUERY_ANY);
    return q.best != TRIANGLE_NONE;
}

static void all(const hierarchy *h, const mesh_ray *ray, mesh_visit *visit, void *context)
{
    ray_query q;
    if (query_start(&q, ray) && h->block_count) {
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

static void nearest_batch(const hierarchy *h, const mesh_ray *rays, int count, mesh_hit *hits)
{
    if (h->kind != HIERARCHY_BVH)
        for (int i = 0; i < count; i++)
            nearest(h, &rays[i], &hits[i]);
    for (int first = 0; h->kind == HIERARCHY_BVH && first < count; first += TOGETHER)
        KERNEL(walk_bvh_together)
    (h, rays + first, count - first < TOGETHER ? count - first : TOGETHER, QUERY_NEAREST, hits + first, NULL);
}

static void any_batch(const hierarchy *h, const mesh_ray *rays, int count, bool *hit)
{
    if (h->kind != HIERARCHY_BVH)
        for (int i = 0; i < count; i++)
            hit[i] = any(h, &rays[i]);
    for (int first = 0; h->kind == HIERARCHY_BVH && first < count; first += TOGETHER)
        KERNEL(walk_bvh_together)
    (h, rays + first, count - first < TOGETHER ? count - first : TOGETHER, QUERY_ANY, NULL, hit + first);
}

const hierarchy_kernels KERNEL(hierarchy_kernels) = {nearest, any, all, boxes, nearest_batch, any_batch};
