#include "render/tracer.h"

#include "measure/clock.h"
#include "render/shade.h"
#include "render/sky.h"
#include <stdlib.h>
#include <string.h>

struct tracer {
    const geometry_kernels *geometry;
    const shade_kernels *shade;
    tracer_target target;
    int depth_limit, queue_count;
    ray_queue *waiting;      /* by depth, 0 .. depth_limit */
    ray_queue shadows;
    ray_counters counters;
    int64_t overflow;        /* negative: a sum or contribution left the film's range */
    _Alignas(64) ray_scratch scratch; /* whole vectors on whole cache lines, here and below */
    _Alignas(64) hit_batch hits;
    _Alignas(64) group gathered;
    _Alignas(64) lit_group lit;
    _Alignas(64) branch_group branches;
    _Alignas(64) double transmitted[ROW];
    int list[PRIMITIVES_MAX + 2][ROW], listed[PRIMITIVES_MAX + 2]; /* see sort_by_primitive */
};

/* A build without counters compiles the statement and throws it away. */
#define COUNT(statement) ((void)(CUVETTE_COUNTERS ? (statement) : 0))

tracer *tracer_create(isa level)
{
    tracer *t = aligned_alloc(64, (sizeof(tracer) + 63) / 64 * 64);
    if (!t)
        return NULL;
    memset(t, 0, offsetof(tracer, scratch));
    t->geometry = level == ISA_AVX512 ? &geometry_kernels_avx512 : level == ISA_AVX2 ? &geometry_kernels_avx2 : &geometry_kernels_sse2;
    t->shade = level == ISA_AVX512 ? &shade_kernels_avx512 : level == ISA_AVX2 ? &shade_kernels_avx2 : &shade_kernels_sse2;
    return t;
}

void tracer_destroy(tracer *t)
{
    if (!t)
        return;
    for (int d = 0; d < t->queue_count; d++)
        queue_destroy(&t->waiting[d]);
    free(t->waiting);
    queue_destroy(&t->shadows);
    free(t);
}

/* Each depth gets at most two children for every ray of a batch, on top of less than a batch that waits. */
static bool make_queues(tracer *t, int depths)
{
    if (depths <= t->queue_count)
        return true;
    ray_queue *grown = realloc(t->waiting, (size_t)depths * sizeof *grown);
    if (!grown)
        return false;
    t->waiting = grown;
    for (; t->queue_count < depths; t->queue_count++)
        if (!queue_create(&grown[t->queue_count], 3 * BATCH + LANES_MAX))
            return false;
    return true;
}

bool tracer_begin(tracer *t, const tracer_target *target)
{
    t->target = *target;
    t->depth_limit = (int)target->scene->render.depth;
    int shadows_at_once = BATCH * (target->scene->light_count + 1);
    if (t->shadows.capacity < shadows_at_once) {
        queue_destroy(&t->shadows);
        if (!queue_create(&t->shadows, shadows_at_once))
            return false;
    }
    if (!make_queues(t, t->depth_limit + 1))
        return false;
    for (int d = 0; d < t->queue_count; d++)
        t->waiting[d].count = 0;
    t->shadows.count = 0;
    memset(&t->counters, 0, sizeof t->counters);
    t->overflow = 0;
    return true;
}

const ray_counters *tracer_counters(const tracer *t)
{
    return &t->counters;
}

bool tracer_overflowed(const tracer *t)
{
    return t->overflow < 0;
}

/* One channel of radiance, rounded to the film's unit. What is not in the film's range, NaN too, sets the flag. */
static int64_t in_film_units(tracer *t, double radiance)
{
    const double limit = 262144.0; /* half of what a channel holds */
    if (radiance >= 0.0 && radiance < limit)
        return (int64_t)(radiance * FILM_ONE + 0.5);
    t->overflow = -1;
    return 0;
}

static void expose(tracer *t, int64_t pixel, double r, double g, double b)
{
    int64_t *sum = &t->target.picture->sum[pixel * 3];
    const int64_t units[3] = {in_film_units(t, r), in_film_units(t, g), in_film_units(t, b)};
    for (int c = 0; c < 3; c++) {
        sum[c] = (int64_t)((uint64_t)sum[c] + (uint64_t)units[c]);
        t->overflow |= sum[c];
    }
}

static void expose_sky(tracer *t, int64_t pixel, vec3 direction, double wr, double wg, double wb)
{
    vec3 l = sky_radiance(t->target.scene->sky, direction);
    expose(t, pixel, wr * l.x, wg * l.y, wb * l.z);
}

static void expose_ambient(tracer *t, const material *m)
{
    const group *g = &t->gathered;
    vec3 a = vec3_scale(t->target.scene->sky->ambient, m->ambient);
    for (int i = 0; i < g->count; i++)
        expose(t, g->pixel[i], g->wr[i] * a.x * g->cr[i], g->wg[i] * a.y * g->cg[i], g->wb[i] * a.z * g->cb[i]);
}

/* A shadow ray is worth its while only if its light can change the film. */
static void put_shadow_rays_in_line(tracer *t)
{
    const group *g = &t->gathered;
    const lit_group *l = &t->lit;
    ray_queue *q = &t->shadows;
    int worth[ROW], count = 0;
    for (int i = 0; i < g->count; i++) {
        worth[count] = i;
        count -= (int)l->shows[i];
    }
    for (int k = 0; k < count; k++) {
        const int i = worth[k], at = q->count++;
        q->ox[at] = g->points.px[i], q->oy[at] = g->points.py[i], q->oz[at] = g->points.pz[i];
        q->dx[at] = l->lx[i], q->dy[at] = l->ly[i], q->dz[at] = l->lz[i];
        q->wr[at] = l->r[i], q->wg[at] = l->g[i], q->wb[at] = l->b[i];
        q->start[at] = g->points.face[i], q->pixel[at] = g->pixel[i], q->inside[at] = g->inside_before[i];
    }
}

static void local_light(tracer *t, const material *m)
{
    const plan *p = t->target.scene;
    if (m->ambient > 0.0)
        expose_ambient(t, m);
    if (m->diffuse == 0.0 && m->specular == 0.0)
        return;
    for (int k = 0; k < p->light_count; k++) {
        t->shade->direct(m, &p->lights[k], &t->gathered, &t->lit);
        if (p->render.shadows != SHADOWS_OFF) {
            put_shadow_rays_in_line(t);
            continue;
        }
        for (int i = 0; i < t->gathered.count; i++)
            expose(t, t->gathered.pixel[i], t->lit.r[i], t->lit.g[i], t->lit.b[i]);
    }
}

/* Branches that the depth limit cuts off: counted, and given what lies beyond it. */
static void cut_branches(tracer *t)
{
    const group *g = &t->gathered;
    const branch_group *b = &t->branches;
    const plan *p = t->target.scene;
    if (CUVETTE_COUNTERS) {
        cut_sum sum;
        t->shade->cut(g, b, &sum);
        t->counters.cut_depth += (uint64_t)sum.branches;
        for (int c = 0; c < 3; c++)
            t->counters.cut_depth_throughput[c] += sum.throughput[c];
    }
    if (p->render.beyond == BEYOND_BLACK)
        return;
    const bool uniform = p->sky->kind == BACKGROUND_UNIFORM; /* then directions do not matter */
    for (int i = 0; i < g->count; i++) {
        const double first = uniform ? b->reflect[i] + b->refract[i] : b->reflect[i], second = uniform ? 0.0 : b->refract[i];
        if (first > 0.0)
            expose_sky(t, g->pixel[i], vec3_make(b->rx[i], b->ry[i], b->rz[i]), g->wr[i] * first, g->wg[i] * first, g->wb[i] * first);
        if (second > 0.0)
            expose_sky(t, g->pixel[i], vec3_make(b->tx[i], b->ty[i], b->tz[i]), g->wr[i] * second, g->wg[i] * second, g->wb[i] * second);
    }
}

static int64_t cut_units(double throughput)
{
    return (int64_t)(throughput * COUNTERS_CUT_ONE + 0.5);
}

static bool too_light(tracer *t, const ray_queue *q, int i, double least)
{
    if (q->wr[i] >= least || q->wg[i] >= least || q->wb[i] >= least)
        return false;
    COUNT(t->counters.cut_weight++);
    COUNT(t->counters.cut_weight_throughput[0] += cut_units(q->wr[i]));
    COUNT(t->counters.cut_weight_throughput[1] += cut_units(q->wg[i]));
    COUNT(t->counters.cut_weight_throughput[2] += cut_units(q->wb[i]));
    return true;
}

/* Puts a kind of children in line: all of them at once, then the last one into each hole of those that do not exist or weigh
 * too little. Returns how many there are. */
static int put_children_in_line(tracer *t, int depth, const double *dx, const double *dy, const double *dz, const double *weight,
                                const uint64_t *inside)
{
    ray_queue *q = &t->waiting[depth];
    const double least = t->target.scene->render.min_weight;
    const int first = q->count;
    t->shade->append(&t->gathered, dx, dy, dz, weight, inside, q);
    for (int i = t->gathered.count - 1; i >= 0; i--)
        if (weight[i] == 0.0 || (least > 0.0 && too_light(t, q, first + i, least)))
            queue_move(q, first + i, --q->count);
    return q->count - first;
}

static void branch(tracer *t, int depth, const material *m, bool opaque)
{
    const plan *p = t->target.scene;
    group *g = &t->gathered;
    branch_group *b = &t->branches;
    if (opaque && m->reflectivity == 0.0)
        return;
    if (opaque || p->render.weights == WEIGHTS_CONSTANT)
        t->shade->constant_branches(m, opaque, g, b);
    else
        t->shade->fresnel_branches(m, g, b);
    if (!opaque)
        COUNT(t->counters.total_internal += (uint64_t)b->total);
    if (depth == t->depth_limit) {
        cut_branches(t);
        return;
    }
    int reflected = put_children_in_line(t, depth + 1, b->rx, b->ry, b->rz, b->reflect, g->inside_before);
    int refracted = put_children_in_line(t, depth + 1, b->tx, b->ty, b->tz, b->refract, g->inside_after);
    COUNT(t->counters.reflect += (uint64_t)reflected);
    COUNT(t->counters.refract += (uint64_t)refracted);
}

static void shade_group(tracer *t, int depth, int first, int met, int rank, const int *list, int count)
{
    const plan *p = t->target.scene;
    const primitive *surface = &p->solids->primitives[met];
    const material *m = p->materials[rank];
    group *g = &t->gathered;
    group_gather(&t->waiting[depth], first, &t->hits, p->ior, list, count, g);
    const ray_batch rays = {g->padded, g->ox, g->oy, g->oz, g->dx, g->dy, g->dz, g->start, g->inside_before};
    t->geometry->surface(surface, &rays, g->t, met, &g->points);
    const int owner = p->solids->bodies[rank].solid;
    COUNT(t->counters.hits[owner] += (uint64_t)count);
    if (depth == 0)
        COUNT(t->counters.first_hits[owner] += (uint64_t)count);
    t->shade->color(m, surface, g);
    local_light(t, m);
    branch(t, depth, m, p->solids->bodies[rank].opaque);
}

/* Rays by the primitive they met. Those that met another body's surface there (an opaque one behind a clear one's, or two in
 * one place) are listed last but one, those that met nothing last. */
static void sort_by_primitive(tracer *t, int count)
{
    const arrangement *a = t->target.scene->solids;
    const int foreign = a->primitive_count, none = foreign + 1;
    memset(t->listed, 0, ((size_t)none + 1) * sizeof *t->listed);
    for (int i = 0; i < count; i++) {
        const int met = (int)t->hits.crossed[i];
        const int at = met < 0 ? none : t->hits.surface[i] == a->primitives[met].rank ? met : foreign;
        t->list[at][t->listed[at]++] = i;
    }
}

/* The few rays on foreign surfaces, in groups of one primitive and one body. */
static void shade_foreign(tracer *t, int depth, int first)
{
    const int foreign = t->target.scene->solids->primitive_count;
    int *list = t->list[foreign], left = t->listed[foreign], same[BATCH];
    while (left > 0) {
        const int64_t met = t->hits.crossed[list[0]], rank = t->hits.surface[list[0]];
        int count = 0, others = 0;
        for (int k = 0; k < left; k++) {
            const int i = list[k];
            if (t->hits.crossed[i] == met && t->hits.surface[i] == rank)
                same[count++] = i;
            else
                list[others++] = i;
        }
        shade_group(t, depth, first, (int)met, (int)rank, same, count);
        left = others;
    }
}

static void trace_batch(tracer *t, int depth)
{
    const plan *p = t->target.scene;
    ray_queue *q = &t->waiting[depth];
    int first;
    const ray_batch rays = queue_take(q, &first);
    COUNT(t->counters.by_depth[depth] += (uint64_t)rays.count);
    if (depth == 0)
        COUNT(t->counters.camera += (uint64_t)rays.count);
    t->geometry->nearest(p->solids, &rays, &t->scratch, &t->hits);
    sort_by_primitive(t, rays.count);
    const int primitives = p->solids->primitive_count, none = primitives + 1;
    for (int k = 0; k < t->listed[none]; k++) {
        const int i = t->list[none][k], at = first + i;
        expose_sky(t, q->pixel[at], vec3_make(rays.dx[i], rays.dy[i], rays.dz[i]), q->wr[at], q->wg[at], q->wb[at]);
    }
    for (int met = 0; met < primitives; met++)
        if (t->listed[met] > 0)
            shade_group(t, depth, first, met, p->solids->primitives[met].rank, t->list[met], t->listed[met]);
    shade_foreign(t, depth, first);
}

static void trace_shadows(tracer *t)
{
    const plan *p = t->target.scene;
    ray_queue *q = &t->shadows;
    int first;
    const ray_batch rays = queue_take(q, &first);
    COUNT(t->counters.shadow += (uint64_t)rays.count);
    t->geometry->shadow(p->solids, &rays, p->render.shadows == SHADOWS_OPAQUE, &t->scratch, t->transmitted);
    for (int i = 0; i < rays.count; i++) {
        const double share = t->transmitted[i];
        const int at = first + i;
        if (share > 0.0)
            expose(t, q->pixel[at], share * q->wr[at], share * q->wg[at], share * q->wb[at]);
    }
}

/* Runs one batch of a queue (depth -1: shadow rays), and gives each pixel its share of the time and its rays if that is wanted. */
static void run_batch(tracer *t, int depth)
{
    const tracer_target *target = &t->target;
    if (!target->pixel_ns && !target->pixel_rays) {
        depth < 0 ? trace_shadows(t) : trace_batch(t, depth);
        return;
    }
    const ray_queue *q = depth < 0 ? &t->shadows : &t->waiting[depth];
    ray_queue view = *q;
    int first;
    const int count = queue_take(&view, &first).count;
    int64_t began = clock_wall_ns();
    depth < 0 ? trace_shadows(t) : trace_batch(t, depth);
    double share = (double)(clock_wall_ns() - began) / count;
    for (int i = first; i < first + count; i++) {
        if (target->pixel_rays)
            target->pixel_rays[q->pixel[i]] += 1.0;
        if (target->pixel_ns)
            target->pixel_ns[q->pixel[i]] += share;
    }
}

/* The deepest full batch, shadow rays before all; false when there is none. */
static bool run_full(tracer *t)
{
    if (t->shadows.count >= BATCH) {
        run_batch(t, -1);
        return true;
    }
    for (int d = t->depth_limit; d >= 0; d--) {
        if (t->waiting[d].count >= BATCH) {
            run_batch(t, d);
            return true;
        }
    }
    return false;
}

static bool stopped(const atomic_bool *stop)
{
    return atomic_load_explicit(stop, memory_order_relaxed);
}

/* The points of a pixel that are sampled: its centre, or (+-1/4, +-1/4) from it. */
static void put_camera_rays_in_line(tracer *t, int y, int x0, int x1, int samples)
{
    const plan *p = t->target.scene;
    ray_queue *q = &t->waiting[0];
    double u[ROW], v[ROW];
    const double across = 2.0 * p->view.half_width / (double)p->render.width, down = 2.0 * p->view.half_height / (double)p->render.height;
    int count = 0;
    const int at = q->count;
    for (int x = x0; x < x1; x++) {
        for (int s = 0; s < samples; s++, count++) {
            double sx = samples == 1 ? 0.5 : s % 2 ? 0.75 : 0.25, sy = samples == 1 ? 0.5 : s / 2 ? 0.75 : 0.25;
            u[count] = (x + sx) * across - p->view.half_width;
            v[count] = p->view.half_height - (y + sy) * down;
            const int i = at + count;
            q->ox[i] = p->view.eye.x, q->oy[i] = p->view.eye.y, q->oz[i] = p->view.eye.z;
            q->wr[i] = q->wg[i] = q->wb[i] = 1.0 / samples;
            q->start[i] = FACE_NONE;
            q->pixel[i] = (int64_t)y * p->render.width + x;
            q->inside[i] = p->eye_inside;
        }
    }
    t->shade->camera(&p->view, count, u, v, q->dx + at, q->dy + at, q->dz + at);
    q->count += count;
}

void tracer_span(tracer *t, const span *piece, const atomic_bool *stop)
{
    const int samples = (int)t->target.scene->render.samples, at_once = BATCH / samples;
    for (int y = piece->y0; y < piece->y1; y++) {
        for (int x = piece->x0; x < piece->x1; x += at_once) {
            put_camera_rays_in_line(t, y, x, x + at_once < piece->x1 ? x + at_once : piece->x1, samples);
            while (run_full(t))
                if (stopped(stop))
                    return;
        }
    }
}

/* With no full batch left anywhere, the shallowest rays go first: their children fill the deeper queues again. */
void tracer_finish(tracer *t, const atomic_bool *stop)
{
    for (int d = 0; d <= t->depth_limit && !stopped(stop); d++) {
        while (t->waiting[d].count > 0 && !stopped(stop))
            run_batch(t, d);
        while (run_full(t) && !stopped(stop))
            ;
    }
    while (t->shadows.count > 0 && !stopped(stop))
        run_batch(t, -1);
}
