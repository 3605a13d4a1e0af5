/* A frame: first photons and the integrator's steps, then workers render tiles; their counts and times are collected
 * into a result. */
#include "render/frame/tracers.h"

#include "base/array.h"
#include "base/cancel.h"
#include "measure/clock.h"
#include "render/frame/caustics.h"
#include "scene/model/scene.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WATCH_S 0.02

typedef struct event_list {
    tile_event *event;
    size_t count, capacity;
} event_list;

/* Data that one worker writes during a frame, on cache lines that no other worker writes. */
typedef struct worker_state {
    _Alignas(64) worker_report report;
    event_list events;
    atomic_uint_fast64_t pixels; /* pixels begun; read by watch */
    bool out_of_memory, misplaced, out_of_range;
    film *tile;       /* film of the tile from a tile source, or NULL */
    double *variance; /* of the values of `tile`, or NULL */
} worker_state;

typedef struct frame {
    renderer *owner;
    const scene *s;
    const render_options *options;
    const plan *frame_plan;
    const film *img;
    const integrator *frame_integrator;
    int replicates;            /* of the film */
    void *state;               /* the integrator's state for the frame */
    void (*step)(void *state); /* the current step of the integrator's pre-pass */
    caustics *photons;         /* or NULL */
    const caustics_step *photon_step;
    schedule tiles;
    worker_state *workers;
    double began_s, progress_s; /* progress_s: when progress was called last */
} frame;

/* --- workers --- */

static pin_policy policy_of(const scene *s)
{
    switch ((pin_rule)s->render.pin) {
    case PIN_RULE_NONE: break;
    case PIN_RULE_COMPACT: return PIN_COMPACT;
    case PIN_RULE_SCATTER: return PIN_SCATTER;
    }
    return PIN_NONE;
}

/* Binds the worker's thread to its processing unit; threads of a persistent pool remember their unit. False if the
 * thread cannot be bound. */
static bool bind_worker(const frame *f, int worker)
{
    static _Thread_local int bound_to = -1;
    if (!f->owner->machine)
        return true;
    int pu = topology_place(f->owner->machine, policy_of(f->s), worker, (int)f->s->render.threads);
    if (pu == bound_to)
        return true;
    if (topology_bind_thread(f->owner->machine, pu, NULL) != STATUS_OK)
        return false;
    bound_to = pu;
    return true;
}

static double since(const frame *f)
{
    return clock_wall_s() - f->began_s;
}

static void note_tile(const frame *f, worker_state *d, int worker, const image_tile *tile, double began_s)
{
    event_list *l = &d->events;
    if (GROW(l->event, l->capacity, l->count + 1))
        l->event[l->count++] = (tile_event){worker, tile->x0, tile->y0, tile->x1, tile->y1, began_s, since(f)};
    else
        d->out_of_memory = true;
}

static bool next_tile(frame *f, int worker, uint64_t taken, image_tile *out)
{
    const tile_source *source = f->options ? f->options->source : NULL;
    worker_pool_pause(f->owner->threads);
    return !cancel_asked() &&
           (source ? source->next(source->context, worker, out) : schedule_next(&f->tiles, worker, taken, out));
}

/* Renders a tile from a tile source completely, and returns it to the source. */
static void render_for_source(frame *f, tracer *t, worker_state *d, const image_tile *tile)
{
    const tile_source *source = f->options->source;
    film_begin_tile(d->tile, (int)f->s->render.width, tile->x0, tile->y0, tile->x1, tile->y1, f->replicates);
    tracer_expose_to(t, d->tile);
    tracer_render_tile(t, tile, &d->pixels);
    tracer_finish(t);
    if (cancel_asked())
        return;
    d->out_of_range |= !film_merge_replicates(d->tile, d->variance);
    source->done(source->context, tile, d->tile, d->variance);
}

/* Renders a tile into the frame's film. */
static void render_tile(frame *f, tracer *t, worker_state *d, const image_tile *tile)
{
    tracer_render_tile(t, tile, &d->pixels);
    if (!f->options || !f->options->tile_done)
        return;
    tracer_finish(t);
    if (!cancel_asked())
        f->options->tile_done(f->options->context, f->img, tile->x0, tile->y0, tile->x1, tile->y1);
}

/* Renders one tile after another; rays that do not fill a batch at the end of a tile wait for the rays of the next
 * tile. */
static void render_tiles(frame *f, int worker, worker_state *d, image_tile tile)
{
    const bool timeline = f->options && f->options->timeline, by_source = f->options && f->options->source;
    const double began_s = since(f);
    tracer *t = tracer_pool_acquire(f->owner->tracers);
    if (!t) {
        d->out_of_memory = true;
        return;
    }
    const ray_counters *c = tracer_counters(t);
    const double visibility_s = tracer_visibility_s(t);
    const uint64_t camera_rays = c->camera, reflect = c->reflect, refract = c->refract, shadow = c->shadow;
    do {
        double tile_began_s = timeline ? since(f) : 0.0;
        if (by_source)
            render_for_source(f, t, d, &tile);
        else
            render_tile(f, t, d, &tile);
        d->report.tiles++;
        if (timeline)
            note_tile(f, d, worker, &tile, tile_began_s);
    } while (next_tile(f, worker, d->report.tiles, &tile));
    tracer_finish(t);
    if (timeline && d->events.count > 0)
        d->events.event[d->events.count - 1].end_s = since(f);
    d->report.busy_s = since(f) - began_s;
    d->report.visibility_s = tracer_visibility_s(t) - visibility_s;
    d->report.camera = c->camera - camera_rays, d->report.reflect = c->reflect - reflect;
    d->report.refract = c->refract - refract, d->report.shadow = c->shadow - shadow;
    tracer_pool_release(f->owner->tracers, t);
}

static void work(void *context, int worker)
{
    frame *f = context;
    worker_state *d = &f->workers[worker];
    const double began_s = since(f), cpu_s = clock_thread_cpu_s();
    const bool measured = f->options && f->options->usage;
    const thread_usage before = measured ? thread_usage_now() : thread_usage_unknown();
    d->misplaced = !bind_worker(f, worker);
    image_tile tile;
    if (next_tile(f, worker, 0, &tile))
        render_tiles(f, worker, d, tile);
    d->report.start_s = began_s;
    d->report.pu = topology_current_pu();
    d->report.usage = measured ? thread_usage_since(&before) : before;
    d->report.cpu_s = clock_thread_cpu_s() - cpu_s;
    d->report.wall_s = since(f) - began_s;
}

/* Called every watch_s, so that a cancellation does not wait for the next progress report. */
static void watch(void *context)
{
    frame *f = context;
    cancel_asked(); /* calls the token's ask and sets the token; workers do not call ask */
    const render_options *o = f->options;
    if (!o || !o->progress || since(f) - f->progress_s < (o->progress_s > 0 ? o->progress_s : 0.1))
        return;
    f->progress_s = since(f);
    uint64_t begun = 0;
    for (int i = 0; i < (int)f->s->render.threads; i++)
        begun += atomic_load_explicit(&f->workers[i].pixels, memory_order_relaxed);
    double fraction = (double)begun / ((double)f->s->render.width * (double)f->s->render.height);
    o->progress(o->context, fraction);
}

static double watch_s(const render_options *o)
{
    const double usual_s = o && o->watch_s > 0 ? o->watch_s : WATCH_S;
    return o && o->progress && o->progress_s > 0 && o->progress_s < usual_s ? o->progress_s : usual_s;
}

static int compare_events(const void *a, const void *b)
{
    const tile_event *x = a, *y = b;
    if (x->begin_s != y->begin_s)
        return x->begin_s < y->begin_s ? -1 : 1;
    return (x->worker > y->worker) - (x->worker < y->worker);
}

static bool join_events(const worker_state *workers, int count, render_result *result)
{
    size_t total = 0;
    for (int i = 0; i < count; i++)
        total += workers[i].events.count;
    result->events = calloc(total + 1, sizeof *result->events);
    if (!result->events)
        return false;
    for (int i = 0; i < count; i++)
        for (size_t k = 0; k < workers[i].events.count; k++)
            result->events[result->event_count++] = workers[i].events.event[k];
    qsort(result->events, total, sizeof *result->events, compare_events);
    return true;
}

/* Rays that search for their nearest interface are tested against every visible solid; shadow rays against those that
 * cast shadows, or against every visible solid if the surroundings absorb. Solids of the solid tree are not counted. */
static void count_tests(const plan *p, ray_counters *c)
{
    const uint64_t nearest = c->camera + c->reflect + c->refract;
    for (int k = 0; k < p->geometry->direct_region_count; k++) {
        const region *b = &p->geometry->regions[p->geometry->direct_regions[k]];
        if (b->solid >= COUNTERS_SOLID_MAX)
            continue;
        c->tests[b->solid] =
            nearest + (region_casts_shadow(b, p->solid_shadows) || p->geometry->regions[0].attenuates ? c->shadow : 0);
    }
}

/* Converts pixel_cut from the tracer's units (render/tracer/tracer.h) to the mean of RGB, relative to the pixel's
 * camera rays, which an analyser halves. */
static void scale_cut(const plan *p, render_result *result)
{
    const size_t pixels = (size_t)result->img->width * (size_t)result->img->height;
    const double camera_weight = p->analyser == ANALYSER_NONE ? 1.0 : 0.5;
    for (size_t i = 0; i < pixels; i++)
        result->pixel_cut[i] /= 3.0 * COUNTERS_CUT_ONE * camera_weight;
}

/* Collects the results of the workers. */
static status collect(frame *f, bool in_range, render_result *result, diagnostic *why)
{
    const int count = (int)f->s->render.threads;
    bool out_of_memory = scene_geometry_failed(f->frame_plan->geometry), misplaced = false;
    for (int i = 0; i < count; i++) {
        worker_state *d = &f->workers[i];
        d->report.waiting_s = result->wall_s - d->report.busy_s;
        d->report.visibility_s = f->frame_plan->geometry->meshes ? d->report.visibility_s : NAN;
        result->workers[i] = d->report;
        out_of_memory |= d->out_of_memory;
        misplaced |= d->misplaced;
        in_range &= !d->out_of_range;
    }
    const bool overflow = tracer_pool_collect(f->owner->tracers, &result->counters) || !in_range;
    if (f->frame_integrator->traced)
        count_tests(f->frame_plan, &result->counters);
    if (f->options && f->options->timeline)
        out_of_memory |= !join_events(f->workers, count, result);
    if (out_of_memory)
        return diagnose(why, STATUS_FAILURE, "use fewer threads or less depth", "out of memory while rendering");
    if (misplaced)
        return diagnose(why, STATUS_FAILURE, "set render.pin to none",
                        "a worker cannot be bound to its processing unit");
    if (overflow)
        return diagnose(why, STATUS_BAD_INPUT, "lower the lights' intensity, the colours or the sky",
                        "the radiance exceeds the film's range (262144 in one contribution, 524288 in a pixel)");
    return cancel_asked() ? STATUS_INTERRUPTED : STATUS_OK;
}

/* --- a frame --- */

status renderer_prepare(renderer *r, const scene *s, diagnostic *why)
{
    return s->render.pool ? worker_pool_reserve(r->threads, scene_threads(&s->render), why) : STATUS_OK;
}

static worker_state *make_worker_states(int count)
{
    worker_state *workers = aligned_alloc(64, (size_t)count * sizeof *workers);
    if (workers)
        memset(workers, 0, (size_t)count * sizeof *workers);
    return workers;
}

/* Creates a film of one tile for each worker of a frame whose tiles come from a source. */
static status make_tile_films(const scene *s, int side, worker_state *workers, diagnostic *why)
{
    const int replicates = renderer_replicates(s);
    for (int i = 0; i < (int)s->render.threads; i++) {
        TRY(film_create(side, side, replicates, render_film_space(s), &workers[i].tile, why));
        if (replicates > 1 && !(workers[i].variance = render_map_create(3 * (size_t)side * (size_t)side)))
            return out_of_memory(why);
    }
    return STATUS_OK;
}

static void destroy_worker_states(worker_state *workers, int count)
{
    for (int i = 0; workers && i < count; i++) {
        free(workers[i].events.event);
        free(workers[i].variance);
        film_destroy(workers[i].tile);
    }
    free(workers);
}

static void run_step(void *context, int worker)
{
    const frame *f = context;
    (void)worker;
    f->step(f->state);
}

static void run_photon_step(void *context, int worker)
{
    const frame *f = context;
    f->photon_step->parallel(f->photons, worker);
}

static status trace_photons(frame *f, int count, plan *p, isa level, render_result *result, diagnostic *why)
{
    if (!scene_has_caustics(&p->render))
        return STATUS_OK;
    TRY(caustics_create(p, level, count, &f->photons, why));
    for (int k = 0; k < CAUSTICS_STEPS && f->photons; k++) {
        f->photon_step = &caustics_steps[k];
        TRY(worker_pool_run(f->owner->threads, count, f->s->render.pool, run_photon_step, watch, watch_s(f->options), f,
                            why));
        TRY(caustics_steps[k].serial(f->photons, why));
    }
    if (f->photons) {
        caustics_count(f->photons, &result->counters);
        result->few = caustics_find_shortage(f->photons);
    }
    return STATUS_OK;
}

/* Runs the integrator's steps that precede all tiles. */
static status run_steps(frame *f, int count, diagnostic *why)
{
    status code = STATUS_OK;
    for (const integrator_step *step = f->frame_integrator->steps; step && step->parallel && code == STATUS_OK;
         step++) {
        f->step = step->parallel;
        code = worker_pool_run(f->owner->threads, count, f->s->render.pool, run_step, NULL, 0.0, f, why);
        if (code == STATUS_OK && step->serial)
            code = step->serial(f->state, why);
    }
    return code;
}

status frame_run(renderer *r, const scene *s, const render_options *options, plan *p, void *state,
                 render_result *result, diagnostic *why)
{
    const int count = (int)s->render.threads;
    frame *f = aligned_alloc(64, (sizeof *f + 63) / 64 * 64);
    worker_state *workers = make_worker_states(count);
    if (f)
        memset(f, 0, sizeof *f);
    const tracer_target target = {.frame_plan = p,
                                  .img = result->img,
                                  .pixel_rays = result->pixel_rays,
                                  .pixel_ns = result->pixel_ns,
                                  .pixel_cut = result->pixel_cut,
                                  .state = state,
                                  .layers = result->layers};
    bool has_memory = f && workers && tracer_pool_begin(r->tracers, count, &target);
    status code = has_memory ? renderer_prepare(r, s, why) : out_of_memory(why);
    if (options && options->source)
        THEN(code, make_tile_films(s, options->source->side, workers, why));
    if (code == STATUS_OK) {
        f->owner = r;
        f->s = s;
        f->options = options;
        f->frame_plan = p;
        f->img = result->img;
        f->replicates = renderer_replicates(s);
        f->frame_integrator = integrator_for(&s->render);
        f->state = state;
        f->workers = workers;
        schedule_start(&f->tiles, &s->render);
        const double cpu_s = clock_process_cpu_s();
        f->began_s = clock_wall_s();
        code = trace_photons(f, count, p, tracer_pool_level(r->tracers), result, why);
        THEN(code, run_steps(f, count, why));
        THEN(code, worker_pool_run(r->threads, count, s->render.pool, work, watch, watch_s(options), f, why));
        result->wall_s = clock_wall_s() - f->began_s;
        result->cpu_s = clock_process_cpu_s() - cpu_s;
        if (result->pixel_cut)
            scale_cut(p, result);
        if (code == STATUS_OK) {
            const bool in_range = !result->img || film_merge_replicates(result->img, result->variance);
            code = collect(f, in_range, result, why);
            if (code == STATUS_OK && f->frame_integrator->finish)
                code = f->frame_integrator->finish(state, &result->meshes, why);
        }
    }
    destroy_worker_states(workers, count);
    if (f)
        caustics_destroy(f->photons);
    free(f);
    return code;
}
