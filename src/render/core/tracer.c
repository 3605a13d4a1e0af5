/* The batch loop of a tracer: which queue is traced next, sorting of hits, shadow rays. */
#include "render/core/tracer.h"

#include "base/cancel.h"
#include "measure/clock.h"
#include "render/camera/camera_kernels.h"
#include "render/shade/path_kernels.h"
#include "render/shade/shading.h"
#include <stdlib.h>
#include <string.h>

tracer *tracer_create(isa level)
{
    static const geometry_kernels *const geometry[ISA_COUNT] = ISA_ARRAY(geometry_kernels);
    static const shade_kernels *const shade[ISA_COUNT] = ISA_ARRAY(shade_kernels);
    static const path_kernels *const path[ISA_COUNT] = ISA_ARRAY(path_kernels);
    static const camera_kernels *const eyes[ISA_COUNT] = ISA_ARRAY(camera_kernels);
    tracer *t = aligned_alloc(64, (sizeof(tracer) + 63) / 64 * 64);
    if (!t)
        return NULL;
    memset(t, 0, offsetof(tracer, batch));
    t->geometry = geometry[level];
    t->shade = shade[level];
    t->path = path[level];
    t->camera = eyes[level];
    return t;
}

static void forget_integrator(tracer *t)
{
    if (t->rule && t->rule->end)
        t->rule->end(t->own);
    t->own = NULL;
}

void tracer_destroy(tracer *t)
{
    if (!t)
        return;
    for (int d = 0; d < t->queues.made; d++)
        queue_destroy(&t->queues.waiting[d]);
    free(t->queues.waiting);
    free(t->marks);
    absorption_end(t);
    mesh_end(t);
    radiance_end(t);
    layered_end(t);
    crystals_end(t);
    footprints_end(t);
    forget_integrator(t);
    queue_destroy(&t->queues.shadows);
    free(t);
}

/* A queue must hold less than one waiting batch plus two children for every ray of a batch; where crystals are, four,
 * and a batch more: the two branches that they replace are appended with weight 0 and removed. */
enum { WAITING = 3 * BATCH + LANES_MAX, WAITING_CRYSTALS = (CRYSTAL_RAYS_MAX + 2) * BATCH + LANES_MAX };

static int waiting_of(bool crystals)
{
    return crystals ? WAITING_CRYSTALS : WAITING;
}

/* Deep rays wait until there are many: they are then traced to their ends, in batches that stay full for long. */
enum { DEEP_AT_ONCE = 16 * BATCH };

static bool goes_deep(int depth_limit)
{
    return depth_limit > DEPTH_DEEP;
}

static int capacity_of(int queue, int depth_limit, bool crystals)
{
    return waiting_of(crystals) + (goes_deep(depth_limit) && queue >= DEPTH_DEEP ? DEEP_AT_ONCE : 0);
}

static int queue_count(int depth_limit)
{
    return (depth_limit < DEPTH_DEEP + 1 ? depth_limit : DEPTH_DEEP + 1) + 1;
}

uint64_t tracer_bytes(int64_t depth, bool crystals, bool footprints)
{
    uint64_t sum = sizeof(tracer) + (footprints ? sizeof(footprint_work) : 0);
    for (int i = 0; i < queue_count((int)depth); i++) {
        const int capacity = capacity_of(i, (int)depth, crystals);
        sum += queue_bytes(capacity) + (footprints ? (uint64_t)capacity * sizeof(ray_footprint) : 0);
    }
    return sum;
}

/* Queues that are large enough are kept. */
static bool make_queues(tracer *t, int depth_limit, bool crystals)
{
    const int count = queue_count(depth_limit);
    ray_queue *grown =
        count > t->queues.made ? realloc(t->queues.waiting, (size_t)count * sizeof *grown) : t->queues.waiting;
    if (!grown)
        return false;
    t->queues.waiting = grown;
    for (; t->queues.made < count; t->queues.made++)
        memset(&grown[t->queues.made], 0, sizeof *grown);
    for (int i = 0; i < count; i++) {
        const int capacity = capacity_of(i, depth_limit, crystals);
        if (grown[i].capacity >= capacity)
            continue;
        queue_destroy(&grown[i]);
        if (!queue_create(&grown[i], capacity))
            return false;
    }
    return true;
}

static void drop_all(tracer *t)
{
    for (int d = 0; d < t->queues.made; d++)
        t->queues.waiting[d].count = 0;
    t->queues.shadows.count = 0;
}

static bool take_integrator(tracer *t)
{
    const integrator *rule = t->target.rule ? t->target.rule : integrator_for(&t->target.frame_plan->render);
    if (rule != t->rule)
        forget_integrator(t);
    t->rule = rule;
    return !rule->begin || rule->begin(t);
}

/* One mark for each primitive and each priority index: see hit_groups_make. */
static bool make_marks(tracer *t, const scene_geometry *a)
{
    const size_t count = (size_t)a->primitive_count + (size_t)a->region_count + 1;
    int16_t *grown = count > t->mark_count ? realloc(t->marks, count * sizeof *grown) : t->marks;
    if (!grown)
        return false;
    t->marks = grown;
    for (; t->mark_count < count; t->mark_count++)
        grown[t->mark_count] = -1;
    return true;
}

bool tracer_begin(tracer *t, const tracer_target *target)
{
    const plan *p = target->frame_plan;
    const render_settings *r = &p->render;
    t->target = *target;
    t->queues.depth_limit = (int)r->depth;
    /* In a spectral film each wavelength has its own camera ray, with its share of the weight. */
    t->least_weight = r->spectrum == SPECTRUM_SPECTRAL ? r->min_weight / (double)r->wavelengths : r->min_weight;
    /* A batch waits; a rough surface samples each light up to three times (path_rough.c), a medium twice more. */
    const int shadows_at_once = BATCH * (1 + ((p->energy  ? 4
                                               : p->rough ? 3
                                                          : 1) +
                                              (p->scatter ? 2 : 0)) *
                                                 p->light_count);
    if (t->queues.shadows.capacity < shadows_at_once) {
        queue_destroy(&t->queues.shadows);
        if (!queue_create(&t->queues.shadows, shadows_at_once))
            return false;
    }
    if (!make_queues(t, t->queues.depth_limit, p->crystals != NULL) || !make_marks(t, p->geometry) || !mesh_begin(t) ||
        !radiance_begin(t) || !layered_begin(t) || !crystals_begin(t) || !footprints_begin(t) || !take_integrator(t) ||
        !absorption_begin(t, p->geometry->attenuates && t->rule->traced))
        return false;
    t->by_sample_key = t->rule->by_sample || r->spectrum == SPECTRUM_SPECTRAL || p->basic || scene_has_soft_shadows(r);
    drop_all(t);
    memset(&t->account.counters, 0, sizeof t->account.counters);
    t->account.visibility_ns = 0;
    t->account.overflow = 0;
    return true;
}

void tracer_expose_to(tracer *t, film *img)
{
    t->target.img = img;
}

const ray_counters *tracer_counters(const tracer *t)
{
    return &t->account.counters;
}

double tracer_visibility_s(const tracer *t)
{
    return 1e-9 * (double)t->account.visibility_ns;
}

bool tracer_overflowed(const tracer *t)
{
    return t->account.overflow < 0;
}

/* The continuation of a depth buffer's view behind a layer does not count as another ray. */
static bool is_counted(const tracer *t, int depth)
{
    return depth == 0 || t->rule->traced;
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

static void trace_batch(tracer *t, int depth)
{
    const plan *p = t->target.frame_plan;
    ray_queue *q = tracer_queue_at(t, depth);
    int first;
    const ray_batch rays = queue_take(q, &first);
    t->queues.depth = depth;
    if (is_counted(t, depth))
        COUNT(t->account.counters.by_depth[depth < COUNTERS_DEPTH_MAX ? depth : COUNTERS_DEPTH_MAX] +=
              (uint64_t)rays.count);
    if (depth == 0)
        COUNT(t->account.counters.camera += (uint64_t)rays.count);
    if (t->batch.scratch.segments)
        absorption_announce(t, q, first, rays.count);
    const int64_t began_ns = visibility_begins(t);
    t->rule->intersect(t, q, first, depth, &rays);
    visibility_ends(t, began_ns);
    if (t->batch.scratch.segments) {
        absorption_exempt_sky(t);
        absorption_dim(t, q, first, rays.count);
    }
    hit_groups *groups = &t->batch.groups;
    hit_groups_make(&t->batch.hits, rays.count, p->alike, t->marks, t->marks + p->geometry->primitive_count, groups);
    if (groups->missed > 0)
        t->rule->background(t, q, first, groups->miss, groups->missed);
    for (int g = 0, together; g < groups->count; g += together) {
        const int kind = p->alike[groups->group[g].priority_index];
        for (together = 1; g + together < groups->count; together++)
            if (p->alike[groups->group[g + together].priority_index] != kind)
                break;
        shading_groups(t, depth, first, &groups->group[g], together);
    }
}

static void trace_shadows(tracer *t)
{
    const plan *p = t->target.frame_plan;
    ray_queue *q = &t->queues.shadows;
    int first;
    const ray_batch rays = queue_take(q, &first);
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
    shading_expose_shares(t, q, first, rays.count, t->batch.transmitted);
}

void tracer_run_batch(tracer *t, int depth)
{
    const tracer_target *target = &t->target;
    if (!target->pixel_ns && !target->pixel_rays) {
        depth < 0 ? trace_shadows(t) : trace_batch(t, depth);
        return;
    }
    const ray_queue *q = depth < 0 ? &t->queues.shadows : tracer_queue_at(t, depth);
    ray_queue view = *q;
    int first;
    const int count = queue_take(&view, &first).count;
    int64_t began = clock_wall_ns();
    depth < 0 ? trace_shadows(t) : trace_batch(t, depth);
    double share = (double)(clock_wall_ns() - began) / count;
    for (int i = first; i < first + count; i++) {
        if (target->pixel_rays && (depth < 0 || is_counted(t, depth)))
            target->pixel_rays[sample_key_pixel(q->sample_key[i])] += 1.0;
        if (target->pixel_ns)
            target->pixel_ns[sample_key_pixel(q->sample_key[i])] += share;
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

/* The deepest depth whose rays wait for a full batch only. */
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

/* The number of rays made at once: those of as many whole pixels as fit into a batch, or a full batch if a pixel has
 * more rays than that. */
static int rays_at_once(int64_t each)
{
    return each >= BATCH ? BATCH : (int)(BATCH / each * each);
}

int tracer_camera_rays(tracer *t, int x, int y)
{
    const int count = (int)t->rule->sampling(&t->target.frame_plan->render).rays;
    camera_rays_enqueue(t, y, x, 0, count);
    return count;
}

/* Runs the integrator's preparation of a piece; each of its pixels gets an equal share of the time. */
static void begin_piece(tracer *t, const span *piece)
{
    const int64_t began = t->target.pixel_ns ? clock_wall_ns() : 0;
    t->rule->piece(t, piece);
    if (!t->target.pixel_ns)
        return;
    const double pixels = (double)(piece->x1 - piece->x0) * (double)(piece->y1 - piece->y0),
                 share = (double)(clock_wall_ns() - began) / pixels;
    for (int y = piece->y0; y < piece->y1; y++)
        for (int x = piece->x0; x < piece->x1; x++)
            t->target.pixel_ns[(int64_t)y * t->target.frame_plan->render.width + x] += share;
}

/* The size of the blocks of pixels whose rays fill a batch: square blocks for meshes, because nearby rays take the same
 * path through their hierarchies; otherwise a row. */
typedef struct pixel_block {
    int width, height;
} pixel_block;
static pixel_block block_of(const plan *p, const span *piece, int64_t each)
{
    const bool by_hierarchy = p->geometry->meshes || p->geometry->tree;
    if (by_hierarchy && each == 1)
        return (pixel_block){16, BATCH / 16};
    if (by_hierarchy && each == 4)
        return (pixel_block){8, BATCH / 32};
    return (pixel_block){piece->x1 - piece->x0, 1};
}

/* Traces pixels of a row with an equal number of rays; false when cancelled. */
static bool trace_pixels(tracer *t, int y, int x0, int x1, int64_t each)
{
    const int64_t all = each * (x1 - x0);
    const int at_once = rays_at_once(each);
    for (int64_t ray = 0; ray < all; ray += at_once) {
        camera_rays_enqueue(t, y, x0, ray, all - ray < at_once ? (int)(all - ray) : at_once);
        while (run_full(t))
            if (cancel_asked())
                return false;
    }
    return true;
}

/* Traces a row of a block; false when cancelled. */
static bool trace_row(tracer *t, int y, int x0, int x1, int64_t each)
{
    const plan *p = t->target.frame_plan;
    if (!p->draws.by_pixel)
        return trace_pixels(t, y, x0, x1, each);
    for (int x = x0; x < x1; x++)
        if (!trace_pixels(t, y, x, x + 1, path_count(&p->draws, (int64_t)y * p->render.width + x)))
            return false;
    return true;
}

void tracer_span(tracer *t, const span *piece, atomic_uint_fast64_t *begun)
{
    if (t->rule->piece)
        begin_piece(t, piece);
    const int64_t each = t->rule->sampling(&t->target.frame_plan->render).rays;
    const pixel_block block = block_of(t->target.frame_plan, piece, each);
    for (int top = piece->y0; top < piece->y1; top += block.height) {
        const int bottom = top + block.height < piece->y1 ? top + block.height : piece->y1;
        for (int left = piece->x0; left < piece->x1; left += block.width) {
            const int right = left + block.width < piece->x1 ? left + block.width : piece->x1;
            for (int y = top; y < bottom; y++)
                if (!trace_row(t, y, left, right, each))
                    return;
        }
        atomic_fetch_add_explicit(begun, (uint64_t)(piece->x1 - piece->x0) * (uint64_t)(bottom - top),
                                  memory_order_relaxed);
    }
}

/* When no full batch is left, the shallowest rays go first: their children refill the deeper queues. */
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
    drop_all(t);
}
