/* The batch loop of a tracer: choice of the next queue, grouping of hits, shadow rays. */
#include "render/frame/tracers.h"

#include "base/cancel.h"
#include "measure/clock.h"
#include "render/shade/exposure.h"
#include "render/shade/kernels.h"
#include "render/shade/media.h"
#include "render/shade/shading.h"
#include "render/tracer/tracer.h"

/* In a depth buffer, the view's continuation behind a layer is not counted as another ray. */
static bool is_counted(const tracer *t, int depth)
{
    return depth == 0 || t->frame_integrator->traced;
}

static int64_t visibility_begins(const tracer *t)
{
    return t->target.frame_plan->geometry->meshes ? clock_wall_ns() : 0;
}

static void visibility_ends(tracer *t, int64_t began_ns)
{
    if (t->target.frame_plan->geometry->meshes)
        t->account.visibility_ns += clock_wall_ns() - began_ns;
}

static void run_rays(tracer *t, int depth)
{
    const plan *p = t->target.frame_plan;
    ray_queue *q = tracer_queue_at(t, depth);
    int first;
    const ray_batch rays = queue_pop(q, &first);
    t->queues.depth = depth;
    if (is_counted(t, depth))
        COUNT(t->account.counters.by_depth[depth < COUNTERS_DEPTH_MAX ? depth : COUNTERS_DEPTH_MAX] +=
              (uint64_t)rays.count);
    if (depth == 0)
        COUNT(t->account.counters.camera += (uint64_t)rays.count);
    if (t->batch.scratch.segments)
        absorption_announce(t, q, first, rays.count);
    const int64_t began_ns = visibility_begins(t);
    t->frame_integrator->intersect(t, q, first, depth, &rays);
    visibility_ends(t, began_ns);
    if (t->batch.scratch.segments) {
        absorption_exempt_sky(t);
        absorption_dim(t, q, first, rays.count);
    }
    hit_groups *groups = &t->batch.groups;
    t->grouping->list(&t->batch.hits, rays.count, p->shading_class, t->marks, t->marks + p->geometry->primitive_count,
                      groups);
    if (groups->missed > 0)
        t->frame_integrator->background(t, q, first, groups->miss, groups->missed);
    /* Passes runs of groups of one class to shading_groups, which decides which of them can be combined. */
    for (int g = 0, run; g < groups->count; g += run) {
        const int shading_class = p->shading_class[groups->group[g].priority_index];
        for (run = 1; g + run < groups->count; run++)
            if (p->shading_class[groups->group[g + run].priority_index] != shading_class)
                break;
        shading_groups(t, depth, first, &groups->group[g], run);
    }
}

static void run_shadow_rays(tracer *t)
{
    const plan *p = t->target.frame_plan;
    ray_queue *q = &t->queues.shadows;
    int first;
    const ray_batch rays = queue_pop(q, &first);
    COUNT(t->account.counters.shadow += (uint64_t)rays.count);
    if (p->geometry->attenuates)
        absorption_announce(t, q, first, rays.count);
    radiance_begin_shadows(t, &rays, q->sample_key + first);
    const int64_t began_ns = visibility_begins(t);
    t->geometry->shadow(p->geometry, &rays, p->solid_shadows, &t->batch.scratch, t->batch.transmitted);
    visibility_ends(t, began_ns);
    if (p->geometry->attenuates) {
        absorption_exempt_suns(t);
        absorption_dim(t, q, first, rays.count);
    }
    radiance_end_shadows(t);
    shading_expose_shadow_rays(t, q, first, rays.count, t->batch.transmitted);
}

void tracer_run_batch(tracer *t, int depth)
{
    const tracer_target *target = &t->target;
    if (!target->pixel_ns && !target->pixel_rays) {
        depth < 0 ? run_shadow_rays(t) : run_rays(t, depth);
        return;
    }
    const ray_queue *q = depth < 0 ? &t->queues.shadows : tracer_queue_at(t, depth);
    ray_queue view = *q;
    int first;
    const int count = queue_pop(&view, &first).count;
    int64_t began = clock_wall_ns();
    depth < 0 ? run_shadow_rays(t) : run_rays(t, depth);
    double fraction = (double)(clock_wall_ns() - began) / count;
    for (int i = first; i < first + count; i++) {
        if (target->pixel_rays && (depth < 0 || is_counted(t, depth)))
            target->pixel_rays[sample_key_pixel(q->sample_key[i])] += 1.0;
        if (target->pixel_ns)
            target->pixel_ns[sample_key_pixel(q->sample_key[i])] += fraction;
    }
}

/* Traces all deep rays to their ends, depth by depth. */
static void run_deep(tracer *t)
{
    for (int depth = DEPTH_DEEP; tracer_queue_at(t, depth)->count > 0; depth++)
        while (tracer_queue_at(t, depth)->count > 0) {
            if (cancel_asked())
                return;
            tracer_run_batch(t, depth);
            while (t->queues.shadows.count >= BATCH)
                tracer_run_batch(t, -1);
        }
}

/* The largest depth whose rays wait only for a full batch; deeper rays wait for DEEP_AT_ONCE. */
static int deepest(const tracer *t)
{
    return goes_deep(t->queues.depth_limit) ? DEPTH_DEEP - 1 : t->queues.depth_limit;
}

/* Traces the deepest full batch, shadow rays first; returns false when there is none. */
static bool run_full(tracer *t)
{
    if (t->queues.shadows.count >= BATCH) {
        tracer_run_batch(t, -1);
        return true;
    }
    if (goes_deep(t->queues.depth_limit) && t->queues.waiting[DEPTH_DEEP].count >= DEEP_AT_ONCE) {
        run_deep(t);
        return true;
    }
    for (int d = deepest(t); d >= 0; d--) {
        if (t->queues.waiting[d].count >= BATCH) {
            tracer_run_batch(t, d);
            return true;
        }
    }
    return false;
}

void tracer_run_full(tracer *t)
{
    while (!cancel_asked() && run_full(t))
        ;
}

/* The number of camera rays enqueued at once: the rays of as many pixels as fit into a batch, or a full batch if a
 * pixel has more rays. */
static int rays_at_once(int64_t rays_per_pixel)
{
    return rays_per_pixel >= BATCH ? BATCH : (int)(BATCH / rays_per_pixel * rays_per_pixel);
}

int tracer_camera_rays(tracer *t, int x, int y)
{
    const int count = (int)t->frame_integrator->sampling(&t->target.frame_plan->render).rays;
    camera_rays_enqueue(t, y, x, 0, count);
    return count;
}

/* Runs the integrator's preparation of a tile; each of its pixels gets an equal part of the time. */
static void begin_tile(tracer *t, const image_tile *tile)
{
    const int64_t began = t->target.pixel_ns ? clock_wall_ns() : 0;
    t->frame_integrator->tile(t, tile);
    if (!t->target.pixel_ns)
        return;
    const double pixels = (double)(tile->x1 - tile->x0) * (double)(tile->y1 - tile->y0),
                 fraction = (double)(clock_wall_ns() - began) / pixels;
    for (int y = tile->y0; y < tile->y1; y++)
        for (int x = tile->x0; x < tile->x1; x++)
            t->target.pixel_ns[(int64_t)y * t->target.frame_plan->render.width + x] += fraction;
}

/* The size of the blocks of pixels whose rays fill a batch: square blocks for meshes, because nearby rays traverse the
 * same parts of their hierarchies; otherwise a row. */
typedef struct pixel_block {
    int width, height;
} pixel_block;
static pixel_block block_of(const plan *p, const image_tile *tile, int64_t rays_per_pixel)
{
    const bool by_hierarchy = p->geometry->meshes || p->geometry->tree;
    if (by_hierarchy && rays_per_pixel == 1)
        return (pixel_block){16, BATCH / 16};
    if (by_hierarchy && rays_per_pixel == 4)
        return (pixel_block){8, BATCH / 32};
    return (pixel_block){tile->x1 - tile->x0, 1};
}

/* Renders pixels of a row with an equal number of rays; false when cancelled. */
static bool render_pixels(tracer *t, int y, int x0, int x1, int64_t rays_per_pixel)
{
    const int64_t all = rays_per_pixel * (x1 - x0);
    const int at_once = rays_at_once(rays_per_pixel);
    for (int64_t ray = 0; ray < all; ray += at_once) {
        camera_rays_enqueue(t, y, x0, ray, all - ray < at_once ? (int)(all - ray) : at_once);
        while (run_full(t))
            if (cancel_asked())
                return false;
    }
    return true;
}

/* Renders a row of a block; false when cancelled. */
static bool render_row(tracer *t, int y, int x0, int x1, int64_t rays_per_pixel)
{
    const plan *p = t->target.frame_plan;
    if (!p->draws.by_pixel)
        return render_pixels(t, y, x0, x1, rays_per_pixel);
    for (int x = x0; x < x1; x++)
        if (!render_pixels(t, y, x, x + 1, path_count(&p->draws, (int64_t)y * p->render.width + x)))
            return false;
    return true;
}

void tracer_render_tile(tracer *t, const image_tile *tile, atomic_uint_fast64_t *begun)
{
    if (t->frame_integrator->tile)
        begin_tile(t, tile);
    const int64_t rays_per_pixel = t->frame_integrator->sampling(&t->target.frame_plan->render).rays;
    const pixel_block block = block_of(t->target.frame_plan, tile, rays_per_pixel);
    for (int top = tile->y0; top < tile->y1; top += block.height) {
        const int bottom = top + block.height < tile->y1 ? top + block.height : tile->y1;
        for (int left = tile->x0; left < tile->x1; left += block.width) {
            const int right = left + block.width < tile->x1 ? left + block.width : tile->x1;
            for (int y = top; y < bottom; y++)
                if (!render_row(t, y, left, right, rays_per_pixel))
                    return;
        }
        atomic_fetch_add_explicit(begun, (uint64_t)(tile->x1 - tile->x0) * (uint64_t)(bottom - top),
                                  memory_order_relaxed);
    }
}

/* When no full batch is left, the shallowest rays are traced first, because their children refill the deeper queues. */
void tracer_finish(tracer *t)
{
    for (int d = 0; d <= deepest(t) && !cancel_asked(); d++) {
        while (t->queues.waiting[d].count > 0 && !cancel_asked())
            tracer_run_batch(t, d);
        while (run_full(t) && !cancel_asked())
            ;
    }
    if (goes_deep(t->queues.depth_limit))
        run_deep(t);
    while (t->queues.shadows.count > 0 && !cancel_asked())
        tracer_run_batch(t, -1);
    tracer_discard(t);
}
