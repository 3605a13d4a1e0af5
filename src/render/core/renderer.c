/* The frame loop of the renderer: workers take pieces, their accounts are collected into a result. */
#include "render/core/renderer.h"

#include "base/cancel.h"
#include "base/array.h"
#include "base/worker_pool.h"
#include "measure/clock.h"
#include "render/caustics/caustics.h"
#include "render/core/path_counts.h"
#include "render/core/plan.h"
#include "render/core/schedule.h"
#include "render/core/tracer_pool.h"
#include "render/integrators/integrator.h"
#include "render/shade/footprints.h"
#include "scene/model/scene.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct renderer {
    const topology *machine;
    worker_pool *threads;
    tracer_pool *tracers;
};

#define WATCH_S 0.02
enum { STACK_BYTES = 512 * 1024 }; /* not the usual 8 MiB: a pool may have a thousand threads */

typedef struct event_list {
    tile_event *event;
    size_t count, capacity;
} event_list;

/* Data that one worker writes during a frame, on its own cache lines. */
typedef struct worker_account {
    _Alignas(64) worker_report report;
    event_list events;
    atomic_uint_fast64_t pixels; /* begun; read by watch */
    bool out_of_memory, misplaced, out_of_range;
    film *piece;      /* of the piece that a source gave it, or NULL */
    double *variance; /* of that piece, or NULL */
} worker_account;

typedef struct frame {
    renderer *owner;
    const scene *s;
    const render_options *options;
    const plan *frame_plan;
    const film *img;
    const integrator *rule;
    int shares;                /* of the film */
    void *state;               /* the integrator's state for the frame */
    void (*step)(void *state); /* the current step of its pre-pass */
    caustics *photons;         /* or NULL */
    const caustics_step *photon_step;
    schedule pieces;
    worker_account *accounts;
    double began_s, asked_s; /* asked_s: when progress was called last */
} frame;

status renderer_create(isa level, const topology *machine, renderer **out, diagnostic *why)
{
    renderer *r = calloc(1, sizeof *r);
    if (r) {
        r->threads = worker_pool_create(STACK_BYTES);
        r->tracers = tracer_pool_create(level);
        r->machine = machine;
    }
    if (!r || !r->threads || !r->tracers) {
        renderer_destroy(r);
        return out_of_memory(why);
    }
    *out = r;
    return STATUS_OK;
}

void renderer_destroy(renderer *r)
{
    if (!r)
        return;
    worker_pool_destroy(r->threads);
    tracer_pool_destroy(r->tracers);
    free(r);
}

void renderer_set_machine(renderer *r, const topology *machine)
{
    r->machine = machine;
}

status renderer_prepare(renderer *r, const scene *s, diagnostic *why)
{
    return s->render.pool ? worker_pool_reserve(r->threads, scene_threads(&s->render), why) : STATUS_OK;
}

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
static bool take_place(const frame *f, int worker)
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

static void note_tile(const frame *f, worker_account *d, int worker, const span *piece, double began_s)
{
    event_list *l = &d->events;
    if (GROW(l->event, l->capacity, l->count + 1))
        l->event[l->count++] = (tile_event){worker, piece->x0, piece->y0, piece->x1, piece->y1, began_s, since(f)};
    else
        d->out_of_memory = true;
}

static bool next_piece(frame *f, int worker, uint64_t taken, span *out)
{
    const piece_source *source = f->options ? f->options->source : NULL;
    worker_pool_pause(f->owner->threads);
    return !cancel_asked() &&
           (source ? source->next(source->context, worker, out) : schedule_next(&f->pieces, worker, taken, out));
}

/* Traces a piece of a source to its last ray, and passes it on. */
static void trace_for_source(frame *f, tracer *t, worker_account *d, const span *piece)
{
    const piece_source *source = f->options->source;
    film_begin_piece(d->piece, (int)f->s->render.width, piece->x0, piece->y0, piece->x1, piece->y1, f->shares);
    tracer_expose_to(t, d->piece);
    tracer_span(t, piece, &d->pixels);
    tracer_finish(t);
    if (cancel_asked())
        return;
    d->out_of_range |= !film_merge_shares(d->piece, d->variance);
    source->done(source->context, piece, d->piece, d->variance);
}

/* Traces a piece into the frame's film. */
static void trace_piece(frame *f, tracer *t, worker_account *d, const span *piece)
{
    tracer_span(t, piece, &d->pixels);
    if (!f->options || !f->options->piece_done)
        return;
    tracer_finish(t);
    if (!cancel_asked())
        f->options->piece_done(f->options->context, f->img, piece->x0, piece->y0, piece->x1, piece->y1);
}

/* Traces one piece after another; rays that do not fill a batch at the end of a piece wait for the rays of the next
 * one. */
static void trace_pieces(frame *f, int worker, worker_account *d, span piece)
{
    const bool timeline = f->options && f->options->timeline, by_source = f->options && f->options->source;
    const double began_s = since(f);
    tracer *t = tracer_pool_take(f->owner->tracers);
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
            trace_for_source(f, t, d, &piece);
        else
            trace_piece(f, t, d, &piece);
        d->report.tiles++;
        if (timeline)
            note_tile(f, d, worker, &piece, tile_began_s);
    } while (next_piece(f, worker, d->report.tiles, &piece));
    tracer_finish(t);
    if (timeline && d->events.count > 0)
        d->events.event[d->events.count - 1].end_s = since(f);
    d->report.busy_s = since(f) - began_s;
    d->report.visibility_s = tracer_visibility_s(t) - visibility_s;
    d->report.camera = c->camera - camera_rays, d->report.reflect = c->reflect - reflect;
    d->report.refract = c->refract - refract, d->report.shadow = c->shadow - shadow;
    tracer_pool_return(f->owner->tracers, t);
}

static void work(void *context, int worker)
{
    frame *f = context;
    worker_account *d = &f->accounts[worker];
    const double began_s = since(f), cpu_s = clock_thread_cpu_s();
    const bool measured = f->options && f->options->usage;
    const thread_usage before = measured ? thread_usage_now() : thread_usage_unknown();
    d->misplaced = !take_place(f, worker);
    span piece;
    if (next_piece(f, worker, 0, &piece))
        trace_pieces(f, worker, d, piece);
    d->report.start_s = began_s;
    d->report.pu = topology_current_pu();
    d->report.usage = measured ? thread_usage_since(&before) : before;
    d->report.cpu_s = clock_thread_cpu_s() - cpu_s;
    d->report.wall_s = since(f) - began_s;
}

/* Called every watch_s: whoever cancels need not wait for the next progress. */
static void watch(void *context)
{
    frame *f = context;
    cancel_asked(); /* the workers only see what is set */
    const render_options *o = f->options;
    if (!o || !o->progress || since(f) - f->asked_s < (o->progress_s > 0 ? o->progress_s : 0.1))
        return;
    f->asked_s = since(f);
    uint64_t begun = 0;
    for (int i = 0; i < (int)f->s->render.threads; i++)
        begun += atomic_load_explicit(&f->accounts[i].pixels, memory_order_relaxed);
    double share = (double)begun / ((double)f->s->render.width * (double)f->s->render.height);
    o->progress(o->context, share);
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

static bool join_events(const worker_account *accounts, int count, render_result *result)
{
    size_t total = 0;
    for (int i = 0; i < count; i++)
        total += accounts[i].events.count;
    result->events = calloc(total + 1, sizeof *result->events);
    if (!result->events)
        return false;
    for (int i = 0; i < count; i++)
        for (size_t k = 0; k < accounts[i].events.count; k++)
            result->events[result->event_count++] = accounts[i].events.event[k];
    qsort(result->events, total, sizeof *result->events, compare_events);
    return true;
}

/* Rays that search for their nearest interface are tested against every visible solid, shadow rays against those that
 * cast shadows; solids of the solid tree are not counted. */
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

/* From the tracer's units (render/core/tracer.h) to the mean of RGB, relative to the pixel's camera rays, which have
 * half the weight behind an analyser. */
static void scale_cut(const plan *p, render_result *result)
{
    const size_t pixels = (size_t)result->img->width * (size_t)result->img->height;
    const double begins = p->analyser == ANALYSER_NONE ? 1.0 : 0.5;
    for (size_t i = 0; i < pixels; i++)
        result->pixel_cut[i] /= 3.0 * COUNTERS_CUT_ONE * begins;
}

/* Collects the results of the workers' accounts. */
static status collect(frame *f, bool in_range, render_result *result, diagnostic *why)
{
    const int count = (int)f->s->render.threads;
    bool out_of_memory = scene_geometry_failed(f->frame_plan->geometry), misplaced = false;
    for (int i = 0; i < count; i++) {
        worker_account *d = &f->accounts[i];
        d->report.waiting_s = result->wall_s - d->report.busy_s;
        d->report.visibility_s = f->frame_plan->geometry->meshes ? d->report.visibility_s : NAN;
        result->workers[i] = d->report;
        out_of_memory |= d->out_of_memory;
        misplaced |= d->misplaced;
        in_range &= !d->out_of_range;
    }
    const bool overflow = tracer_pool_collect(f->owner->tracers, &result->counters) || !in_range;
    if (f->rule->traced)
        count_tests(f->frame_plan, &result->counters);
    if (f->options && f->options->timeline)
        out_of_memory |= !join_events(f->accounts, count, result);
    if (out_of_memory)
        return diagnose(why, STATUS_FAILURE, "use fewer threads or less depth", "out of memory while tracing");
    if (misplaced)
        return diagnose(why, STATUS_FAILURE, "set render.pin to none",
                        "a worker cannot be bound to its processing unit");
    if (overflow)
        return diagnose(why, STATUS_BAD_INPUT, "lower the lights' intensity, the colours or the sky",
                        "the radiance exceeds the film's range (262144 in one contribution, 524288 in a pixel)");
    return cancel_asked() ? STATUS_INTERRUPTED : STATUS_OK;
}

/* A map of zeros that are really written, so that no pixel's time includes the allocation of a page; compilers turn
 * malloc and memset into calloc, which writes nothing. */
static double *make_map(size_t pixels)
{
    double *map = malloc(pixels * sizeof *map);
    if (map)
        explicit_bzero(map, pixels * sizeof *map);
    return map;
}

int renderer_replicates(const scene *s)
{
    const integrator *rule = integrator_for(&s->render);
    return rule->shares ? rule->shares(&s->render) : 1;
}

uint64_t renderer_result_bytes(const scene *s, const render_options *options)
{
    const uint64_t shares = (uint64_t)renderer_replicates(s),
                   pixels = (uint64_t)s->render.width * (uint64_t)s->render.height;
    const uint64_t maps =
        options ? (uint64_t)options->pixel_rays + (uint64_t)options->pixel_time + (uint64_t)options->pixel_cut : 0;
    const uint64_t named = options && options->layers && integrator_traits_of(&s->render)->layers ? layers_bytes() : 0;
    if (options && options->source)
        return (uint64_t)s->render.threads * (uint64_t)options->source->side * (uint64_t)options->source->side *
               (3 * sizeof(int64_t) * shares + (shares > 1 ? 3 * sizeof(double) : 0));
    return pixels *
           (named + 3 * sizeof(int64_t) * shares + (shares > 1 ? 3 * sizeof(double) : 0) + maps * sizeof(double));
}

uint64_t renderer_tracing_bytes(const scene *s)
{
    return (uint64_t)scene_threads(&s->render) *
               tracer_bytes(s->render.depth, scene_crystals(s) > 0, footprints_are_followed(&s->render)) +
           caustics_bytes(&s->render);
}

static film_space space_of(const scene *s)
{
    return s->render.spectrum == SPECTRUM_SPECTRAL ? FILM_XYZ : FILM_RGB;
}

status renderer_film(const scene *s, film **img, double **variance, diagnostic *why)
{
    *variance = NULL;
    TRY(film_create((int)s->render.width, (int)s->render.height, 1, space_of(s), img, why));
    if (renderer_replicates(s) == 1 || (*variance = make_map(3 * (size_t)s->render.width * (size_t)s->render.height)))
        return STATUS_OK;
    film_destroy(*img);
    *img = NULL;
    return out_of_memory(why);
}

static status make_result(const scene *s, const render_options *options, render_result **out, diagnostic *why)
{
    const size_t pixels = (size_t)s->render.width * (size_t)s->render.height;
    render_result *result = calloc(1, sizeof *result);
    if (!result)
        return out_of_memory(why);
    result->replicates = renderer_replicates(s);
    result->few.solid = -1;
    const bool by_source = options && options->source;
    status code = by_source ? STATUS_OK
                            : film_create((int)s->render.width, (int)s->render.height, renderer_replicates(s),
                                          space_of(s), &result->img, why);
    if (code == STATUS_OK) {
        result->worker_count = (int)s->render.threads;
        result->workers = calloc((size_t)result->worker_count, sizeof *result->workers);
        bool missing = !result->workers;
        if (options && options->pixel_rays)
            missing |= !(result->pixel_rays = make_map(pixels));
        if (options && options->pixel_time)
            missing |= !(result->pixel_ns = make_map(pixels));
        if (options && options->pixel_cut)
            missing |= !(result->pixel_cut = make_map(pixels));
        if (options && options->layers && integrator_traits_of(&s->render)->layers)
            missing |= !(result->layers = layers_create((int)s->render.width, (int)s->render.height));
        if (renderer_replicates(s) > 1 && !by_source)
            missing |= !(result->variance = make_map(3 * pixels));
        if (missing)
            code = diagnose(why, STATUS_FAILURE, "render a smaller image", "out of memory");
    }
    if (code != STATUS_OK) {
        render_result_destroy(result);
        return code;
    }
    *out = result;
    return STATUS_OK;
}

static worker_account *make_accounts(int count)
{
    worker_account *accounts = aligned_alloc(64, (size_t)count * sizeof *accounts);
    if (accounts)
        memset(accounts, 0, (size_t)count * sizeof *accounts);
    return accounts;
}

/* Films of one piece for each worker of a frame whose pieces come from a source. */
static status make_piece_films(const scene *s, int side, worker_account *accounts, diagnostic *why)
{
    const int shares = renderer_replicates(s);
    for (int i = 0; i < (int)s->render.threads; i++) {
        TRY(film_create(side, side, shares, space_of(s), &accounts[i].piece, why));
        if (shares > 1 && !(accounts[i].variance = make_map(3 * (size_t)side * (size_t)side)))
            return out_of_memory(why);
    }
    return STATUS_OK;
}

static void destroy_accounts(worker_account *accounts, int count)
{
    for (int i = 0; accounts && i < count; i++) {
        free(accounts[i].events.event);
        free(accounts[i].variance);
        film_destroy(accounts[i].piece);
    }
    free(accounts);
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
    f->photon_step->together(f->photons, worker);
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
        TRY(caustics_steps[k].alone(f->photons, why));
    }
    if (f->photons) {
        caustics_count(f->photons, &result->counters);
        result->few = caustics_count_few(f->photons);
    }
    return STATUS_OK;
}

/* Runs the integrator's steps that precede all pieces of the image. */
static status run_steps(frame *f, int count, diagnostic *why)
{
    status code = STATUS_OK;
    for (const integrator_step *step = f->rule->steps; step && step->together && code == STATUS_OK; step++) {
        f->step = step->together;
        code = worker_pool_run(f->owner->threads, count, f->s->render.pool, run_step, NULL, 0.0, f, why);
        if (code == STATUS_OK && step->alone)
            code = step->alone(f->state, why);
    }
    return code;
}

static status run_frame(renderer *r, const scene *s, const render_options *options, plan *p, void *state,
                        render_result *result, diagnostic *why)
{
    const int count = (int)s->render.threads;
    frame *f = aligned_alloc(64, (sizeof *f + 63) / 64 * 64);
    worker_account *accounts = make_accounts(count);
    if (f)
        memset(f, 0, sizeof *f);
    const tracer_target target = {.frame_plan = p,
                                  .img = result->img,
                                  .pixel_rays = result->pixel_rays,
                                  .pixel_ns = result->pixel_ns,
                                  .pixel_cut = result->pixel_cut,
                                  .state = state,
                                  .layers = result->layers};
    bool has_memory = f && accounts && tracer_pool_begin(r->tracers, count, &target);
    status code = has_memory ? renderer_prepare(r, s, why) : out_of_memory(why);
    if (options && options->source)
        THEN(code, make_piece_films(s, options->source->side, accounts, why));
    if (code == STATUS_OK) {
        f->owner = r;
        f->s = s;
        f->options = options;
        f->frame_plan = p;
        f->img = result->img;
        f->shares = renderer_replicates(s);
        f->rule = integrator_for(&s->render);
        f->state = state;
        f->accounts = accounts;
        schedule_start(&f->pieces, &s->render);
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
            const bool in_range = !result->img || film_merge_shares(result->img, result->variance);
            code = collect(f, in_range, result, why);
            if (code == STATUS_OK && f->rule->finish)
                code = f->rule->finish(state, &result->meshes, why);
        }
    }
    destroy_accounts(accounts, count);
    if (f)
        caustics_destroy(f->photons);
    free(f);
    return code;
}

/* counts: the number of paths of each pixel, or NULL. */
static status render_with_threads(renderer *r, const scene *s, const render_options *options, const uint32_t *counts,
                                  render_result **out, diagnostic *why)
{
    status code = scene_check(s, why);
    plan *p = NULL;
    void *state = NULL;
    render_result *result = NULL;
    if (code == STATUS_OK && s->background.kind == BACKGROUND_IMAGE && !s->background.img)
        code = diagnose(why, STATUS_FAILURE, "call scene_load first", "the sky's image is not loaded");
    THEN(code, plan_build(s, &p, why));
    if (code == STATUS_OK)
        p->draws.by_pixel = counts;
    const integrator *rule = code == STATUS_OK ? integrator_for(&s->render) : NULL;
    if (rule && rule->prepare)
        code = rule->prepare(p, &state, why);
    THEN(code, make_result(s, options, &result, why));
    if (code == STATUS_OK) {
        result->meshes = p->meshes;
        code = run_frame(r, s, options, p, state, result, why);
    }
    if (rule && rule->release)
        rule->release(state);
    plan_destroy(p);
    if (code != STATUS_OK && code != STATUS_INTERRUPTED) {
        render_result_destroy(result);
        return code;
    }
    *out = result;
    return code;
}

/* A pilot has no progress of its own. */
static void watch_pilot(void *context, double share_done)
{
    render_options *const *options = context;
    (void)share_done;
    (*options)->progress((*options)->context, 0.0);
}

static void add_pilot(render_result *result, const render_result *pilot)
{
    ray_counters_add(&result->counters, &pilot->counters);
    result->wall_s += pilot->wall_s;
    result->cpu_s += pilot->cpu_s;
    for (int i = 0; i < result->worker_count; i++) {
        worker_report *to = &result->workers[i];
        const worker_report *from = &pilot->workers[i];
        to->wall_s += from->wall_s, to->cpu_s += from->cpu_s, to->busy_s += from->busy_s;
        to->visibility_s += from->visibility_s, to->waiting_s += from->waiting_s, to->tiles += from->tiles;
        to->camera += from->camera, to->reflect += from->reflect;
        to->refract += from->refract, to->shadow += from->shadow;
    }
}

/* A pilot, then the frame with the number of paths that it gives each pixel. */
static status render_by_error(renderer *r, const scene *s, const render_options *options, render_result **out,
                              diagnostic *why)
{
    scene first = *s; /* borrows what s owns */
    first.render = path_counts_pilot(&s->render);
    render_options watched = {.context = &options};
    if (options && options->progress)
        watched.progress = watch_pilot, watched.progress_s = options->progress_s;
    render_result *pilot = NULL;
    uint32_t *counts = NULL;
    status code = render_with_threads(r, &first, &watched, NULL, &pilot, why);
    if (code == STATUS_INTERRUPTED) {
        *out = pilot;
        return code;
    }
    THEN(code, path_counts_create(&s->render, pilot, &counts, why));
    THEN(code, render_with_threads(r, s, options, counts, out, why));
    if (code == STATUS_OK)
        add_pilot(*out, pilot);
    free(counts);
    render_result_destroy(pilot);
    return code;
}

/* `auto` is resolved once, so that all parts of a frame agree on the number of workers. */
status renderer_render(renderer *r, const scene *s, const render_options *options, render_result **out, diagnostic *why)
{
    scene resolved = *s; /* borrows what s owns */
    resolved.render.threads = scene_threads(&s->render);
    if (path_counts_apply(&s->render))
        return render_by_error(r, &resolved, options, out, why);
    return render_with_threads(r, &resolved, options, NULL, out, why);
}
