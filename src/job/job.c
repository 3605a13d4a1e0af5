/* Loading and rendering frames under supervision: limits, measurements. */
#include "job/job.h"
#include "base/budget.h"
#include "base/cancel.h"
#include "base/os_process.h"
#include "measure/clock.h"
#include "measure/usage.h"
#include "scene/model/scene.h"

#include <inttypes.h>
#include <stdlib.h>
#include <time.h>

/* --- the mesh cache --- */

void mesh_cache_clear(mesh_cache *cache)
{
    while (cache->count > 0)
        scene_destroy(cache->scenes[--cache->count]);
}

static size_t triangles_of(const scene *s)
{
    size_t sum = 0;
    for (size_t i = 0; i < s->mesh_count; i++)
        sum += s->meshes[i].data ? s->meshes[i].data->triangle_count : 0;
    return sum;
}

/* True if the scene already has all meshes that the cache could provide. */
static bool has_all_meshes(const scene *s)
{
    bool all = true;
    for (size_t i = 0; i < s->mesh_count; i++)
        all &= s->meshes[i].data || (s->meshes[i].source == MESH_SLIME && !s->render.keep);
    return all;
}

/* A full cache is cleared. The cells of a study repeat in cycles, for which evicting the oldest scene would be no
 * better. */
static void add_to_cache(mesh_cache *cache, const scene *s)
{
    size_t triangles = triangles_of(s);
    for (size_t i = 0; i < cache->count; i++)
        triangles += triangles_of(cache->scenes[i]);
    if (cache->count == MESH_CACHE_SCENES || triangles > MESH_CACHE_TRIANGLES)
        mesh_cache_clear(cache);
    scene *copy = scene_clone(s); /* if this fails, the meshes are merely built again */
    if (copy)
        cache->scenes[cache->count++] = copy;
}

status mesh_cache_load(mesh_cache *cache, scene *s, const load_watch *watch, diagnostic *why)
{
    for (size_t i = 0; i < cache->count; i++)
        scene_retain_meshes(s, cache->scenes[i]);
    const bool new_ones = !has_all_meshes(s);
    const status code = scene_load_until(s, watch, why);
    if (code == STATUS_OK && new_ones)
        add_to_cache(cache, s);
    return code;
}

/* --- jobs --- */

struct job {
    isa level;
    job_settings settings;
    renderer *renderer;
    topology *machine;          /* NULL until needed: reading it takes longer than many frames */
    hardware_counter *hardware; /* NULL unless measured */
    instruction_dumps dumps;    /* used if the program runs under callgrind */
    noise_window noise;         /* empty unless measured */
    mesh_cache meshes;          /* empty unless keeps_meshes */
};

status job_create(const job_settings *settings, job **out, diagnostic *why)
{
    *out = NULL;
    job *j = calloc(1, sizeof *j);
    if (!j)
        return out_of_memory(why);
    j->settings = *settings;
    if (settings->measured) {
        j->hardware = hardware_counter_create(); /* before the pool: it counts only threads that start after it */
        const noise_reading first = noise_read("");
        noise_window_add(&j->noise, &first);
    }
    status code = STATUS_OK;
    if (settings->level)
        j->level = *settings->level;
    else
        code = isa_choose(&j->level, why);
    THEN(code, renderer_create(j->level, NULL, &j->renderer, why));
    if (code == STATUS_OK)
        *out = j;
    else
        job_destroy(j);
    return code;
}

void job_destroy(job *j)
{
    if (!j)
        return;
    mesh_cache_clear(&j->meshes);
    renderer_destroy(j->renderer);
    topology_destroy(j->machine);
    if (j->hardware)
        hardware_counter_destroy(j->hardware);
    free(j);
}

isa job_isa(const job *j)
{
    return j->level;
}

status job_machine(job *j, const topology **out, diagnostic *why)
{
    const status code = j->machine ? STATUS_OK : topology_create(&j->machine, why);
    *out = j->machine;
    return code;
}

/* --- loading --- */

status job_load(job *j, scene *s, const load_watch *watch, diagnostic *why)
{
    TRY(cancel_check(why));
    return j->settings.keeps_meshes ? mesh_cache_load(&j->meshes, s, watch, why) : scene_load_until(s, watch, why);
}

/* --- frames --- */

/* The frames that are being rendered. */
typedef struct work {
    job *job;
    const render_options *requested;
    size_t frame, frames; /* current frame, total number */
    double begun_s;       /* start of this frame */
    cancel_token late;    /* set when this frame exceeds job_settings.time_s */
} work;

static void report_progress(void *context, double fraction)
{
    work *w = context;
    const double limit_s = w->job->settings.time_s;
    if (limit_s > 0.0 && clock_wall_s() - w->begun_s > limit_s)
        cancel_set(&w->late);
    else if (w->requested->progress)
        w->requested->progress(w->requested->context, ((double)w->frame + fraction) / (double)w->frames);
}

static void report_tile(void *context, const film *img, int x0, int y0, int x1, int y1)
{
    const work *w = context;
    w->requested->tile_done(w->requested->context, img, x0, y0, x1, y1);
}

static status check_quota(const job *j, const scene *s, const render_options *requested, diagnostic *why)
{
    const uint64_t quota = j->settings.memory_bytes, needed = renderer_result_bytes(s, requested);
    TRY(memory_budget_check(needed + renderer_tracing_bytes(s), "render a smaller image, with fewer threads or maps",
                            why, "a frame of %lld x %lld pixels", (long long)s->render.width,
                            (long long)s->render.height));
    if (quota == 0 || needed <= quota)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "render a smaller image, or request fewer maps",
                    "the film and its maps need %" PRIu64 " bytes, more than the quota of %" PRIu64, needed, quota);
}

/* The unmeasured preparation of a frame. */
static status prepare(job *j, const scene *s, const render_options *requested, diagnostic *why)
{
    const topology *machine = NULL;
    status code = cancel_check(why);
    THEN(code, check_quota(j, s, requested, why));
    if (code == STATUS_OK && s->render.pin != PIN_RULE_NONE)
        code = job_machine(j, &machine, why);
    if (code != STATUS_OK)
        return code;
    if (machine)
        renderer_set_machine(j->renderer, machine);
    return renderer_prepare(j->renderer, s, why);
}

/* Renders the tiles of this process and, where processes share the frame, adds those of the others. */
static status render_tiles(work *w, const scene *s, render_options *options, render_result **out, diagnostic *why)
{
    const job_distribution *sharing = w->job->settings.sharing;
    if (sharing) {
        TRY(sharing->begin(sharing->context, s, options, &options->source, why));
        options->progress = NULL;
    }
    const status rendered = renderer_render(w->job->renderer, s, options, out, why);
    return sharing ? sharing->end(sharing->context, rendered, *out, why) : rendered;
}

/* Renders one frame, with or without the maps. */
static status render_frame(work *w, const scene *s, bool maps, render_result **out, diagnostic *why)
{
    render_options options = {.usage = w->requested->usage,
                              .progress = report_progress,
                              .progress_s = w->requested->progress_s,
                              .watch_s = instruction_dumps_exist() ? 0.9 : 0,
                              .context = w,
                              .source = w->requested->source};
    if (w->requested->tile_done)
        options.tile_done = report_tile;
    if (maps) {
        options.pixel_rays = w->requested->pixel_rays;
        options.pixel_time = w->requested->pixel_time;
        options.pixel_cut = w->requested->pixel_cut;
        options.timeline = w->requested->timeline;
        options.layers = w->requested->layers;
    }
    w->begun_s = clock_wall_s();
    *out = NULL;
    cancel_clear(&w->late);
    cancel_begin(&w->late);
    const status code = render_tiles(w, s, &options, out, why);
    cancel_end(&w->late);
    if (code != STATUS_INTERRUPTED)
        return code;
    if (!cancel_is_set(&w->late))
        return diagnose(why, code, "", "interrupted");
    render_result_destroy(*out);
    *out = NULL;
    return diagnose(why, STATUS_FAILURE, "render less, or allow more time", "the frame is not finished after %.3g s",
                    w->job->settings.time_s);
}

/* Replaces the account's result by the new one. An interrupted frame does not replace a complete one. */
static status keep_result(job_account *a, render_result *result, status ended, diagnostic *why)
{
    if (ended == STATUS_INTERRUPTED && a->result) {
        render_result_destroy(result);
        return ended;
    }
    const uint64_t hash = a->result ? film_hash(result->img) : 0;
    if (a->result && job_account_hash(a) != hash) {
        render_result_destroy(result);
        return diagnose(why, STATUS_FAILURE, "report this as a bug, with the scene",
                        "two frames of the same scene differ");
    }
    render_result_destroy(a->result);
    a->result = result;
    a->film_hash = hash;
    return ended;
}

static status render_one(work *w, const scene *s, bool maps, job_account *a, diagnostic *why)
{
    render_result *result = NULL;
    status code = render_frame(w, s, maps, &result, why);
    if (!result)
        return code;
    const double wall_s = result->wall_s, cpu_s = result->cpu_s;
    code = keep_result(a, result, code, why);
    if (code == STATUS_OK) {
        a->wall_s[a->count] = wall_s;
        a->cpu_s[a->count++] = cpu_s;
    }
    return code;
}

/* Moves the maps of one additional frame into the result of the last measured one, whose times stay undisturbed. */
static status add_maps(work *w, const scene *s, job_account *a, diagnostic *why)
{
    render_result *result = NULL, *measured = a->result;
    const status code = render_frame(w, s, true, &result, why);
    if (code == STATUS_OK) {
        const render_result bare = *measured;
        measured->pixel_rays = result->pixel_rays, result->pixel_rays = bare.pixel_rays;
        measured->pixel_ns = result->pixel_ns, result->pixel_ns = bare.pixel_ns;
        measured->pixel_cut = result->pixel_cut, result->pixel_cut = bare.pixel_cut;
        measured->events = result->events, result->events = bare.events;
        measured->event_count = result->event_count, result->event_count = bare.event_count;
        measured->layers = result->layers, result->layers = bare.layers;
    }
    render_result_destroy(result);
    return code;
}

static int64_t now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

/* Returns the noise since a time, and adds a reading to the window. */
static machine_noise noise_since(job *j, double since_s)
{
    const noise_reading now = noise_read("");
    const machine_noise noise = noise_window_since(&j->noise, since_s, &now);
    noise_window_add(&j->noise, &now);
    return noise;
}

/* Idle units run slowly, so the frequency between frames says nothing about frames. */
machine_noise job_noise(job *j)
{
    machine_noise noise = noise_since(j, INFINITY);
    noise.frequency_drop = NAN;
    return noise;
}

static double stalled_fraction(const render_result *r)
{
    double wall_s = 0, longest_s = 0, cpu_s = 0;
    for (int i = 0; r && i < r->worker_count; i++) {
        wall_s += r->workers[i].wall_s;
        longest_s = fmax(longest_s, r->workers[i].wall_s);
        cpu_s += r->workers[i].cpu_s;
    }
    return r ? noise_stalled(r->worker_count, os_usable_units(), wall_s, longest_s, cpu_s) : NAN;
}

/* The counters are read last before the frames and first after them, so that they cover little else. */
static status measure_all(work *w, const scene *s, size_t count, bool maps, job_account *a, diagnostic *why)
{
    job *j = w->job;
    const bool measured = j->settings.measured;
    hardware_counts counted = a->hardware;
    usage used = a->spent;
    if (j->settings.fresh_peak)
        usage_reset_peak();
    double began_s = NAN;
    if (measured) {
        const noise_reading before = noise_read("");
        noise_window_add(&j->noise, &before);
        began_s = before.wall_s;
        used = usage_now();
        counted = hardware_counter_read(j->hardware);
    }
    status code = STATUS_OK;
    for (; code == STATUS_OK && w->frame < count; w->frame++)
        code = render_one(w, s, maps, a, why);
    if (measured) {
        a->hardware = hardware_counts_since(j->hardware, &counted);
        a->spent = usage_since(&used);
        a->noise = noise_since(j, began_s);
        a->noise.stalled_fraction = stalled_fraction(a->result);
        /* Callgrind runs one thread at a time, so the noise is meaningless; the counts cannot be disturbed. */
        if (instruction_dumps_exist()) {
            a->hardware.instructions = instruction_dumps_next(&j->dumps);
            a->noise = noise_unknown();
        }
        a->film_hash = a->result ? job_account_hash(a) : 0;
    }
    a->ended_ms = now_ms();
    return code;
}

status job_repeat(job *j, const scene *s, size_t frames, const render_options *options, job_account *out,
                  diagnostic *why)
{
    static const render_options none = {.progress = NULL};
    const render_options *requested = options ? options : &none;
    const bool maps = requested->pixel_rays || requested->pixel_time || requested->pixel_cut || requested->timeline ||
                      requested->layers;
    const bool extra = frames > 1 && maps;
    work w = {.job = j, .requested = requested, .frames = frames + extra};
    status code = job_account_begin(s, j->level, frames, out, why);
    THEN(code, prepare(j, s, requested, why));
    THEN(code, measure_all(&w, s, frames, maps && !extra, out, why));
    if (code == STATUS_OK && extra)
        code = add_maps(&w, s, out, why);
    out->complete = code == STATUS_OK;
    return code;
}

status job_render(job *j, const scene *s, const render_options *options, job_account *out, diagnostic *why)
{
    return job_repeat(j, s, 1, options, out, why);
}
