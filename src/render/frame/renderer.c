/* The renderer: its threads and tracers; a frame's render, and the pilot render before it under render.error. */
#include "render/frame/renderer.h"

#include "base/elementary.h"
#include "render/frame/tracers.h"
#include "scene/model/scene.h"
#include <stdlib.h>

enum { STACK_BYTES = 512 * 1024 }; /* not the usual 8 MiB: a pool may have a thousand threads */

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

/* --- the number of random paths of each pixel, from a pilot --- */

render_settings path_counts_pilot(const render_settings *r)
{
    render_settings pilot = *r;
    pilot.paths = PILOT_PATHS;
    pilot.error = 0.0;
    pilot.seed = r->seed + ((int64_t)1 << 31); /* above the largest seed of a scene */
    return pilot;
}

/* The pilot's variance at a pixel: the mean over channels and the 3 x 3 pixels around it, because a single pixel's
 * estimate is too noisy, and is often 0 where light is rare. */
static double variance_around(const render_result *pilot, int x, int y)
{
    const int width = pilot->img->width, height = pilot->img->height;
    double sum = 0.0;
    int count = 0;
    for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < height; v++)
        for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < width; u++) {
            const double *value = &pilot->variance[3 * ((size_t)v * (size_t)width + (size_t)u)];
            sum += value[0] + value[1] + value[2];
            count += 3;
        }
    return sum / count;
}

/* The number of paths for the requested error. The variance of independent paths falls like n^-1; in measurements, the
 * variance of sobol falls at least like n^-1.25. The number is doubled until it suffices, because sobol is best with
 * powers of two. */
static int64_t paths_for(double variance, const render_settings *r, int64_t replicates)
{
    const double excess = variance / (r->error * r->error),
                 wanted =
                     PILOT_PATHS * (r->sampler == SAMPLER_SOBOL && excess > 0.0 ? elementary_pow(excess, 0.8) : excess);
    int64_t count = replicates;
    while (count < PILOT_PATHS || ((double)count < wanted && count < r->paths))
        count *= 2;
    return count < r->paths ? count : r->paths;
}

status path_counts_create(const render_settings *r, const render_result *pilot, uint32_t **out, diagnostic *why)
{
    const int width = pilot->img->width, height = pilot->img->height;
    const int64_t replicates = path_sampling_of(r).replicates;
    uint32_t *counts = malloc((size_t)width * (size_t)height * sizeof *counts);
    if (!counts)
        return out_of_memory(why);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            counts[(size_t)y * (size_t)width + (size_t)x] =
                (uint32_t)paths_for(variance_around(pilot, x, y), r, replicates);
    *out = counts;
    return STATUS_OK;
}

/* --- renders --- */

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
    const integrator *method = code == STATUS_OK ? integrator_for(&s->render) : NULL;
    if (method && method->prepare)
        code = method->prepare(p, &state, why);
    THEN(code, render_result_create(s, options, &result, why));
    if (code == STATUS_OK) {
        result->meshes = p->meshes;
        code = frame_run(r, s, options, p, state, result, why);
    }
    if (method && method->release)
        method->release(state);
    plan_destroy(p);
    if (code != STATUS_OK && code != STATUS_INTERRUPTED) {
        render_result_destroy(result);
        return code;
    }
    *out = result;
    return code;
}

/* A pilot's progress is reported as 0. */
static void watch_pilot(void *context, double fraction_done)
{
    render_options *const *options = context;
    (void)fraction_done;
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

/* Renders a pilot, then the frame with the numbers of paths per pixel that follow from it. */
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

/* render.threads=auto is resolved once, so that all parts of a frame agree on the number of workers. */
status renderer_render(renderer *r, const scene *s, const render_options *options, render_result **out, diagnostic *why)
{
    scene resolved = *s; /* borrows what s owns */
    resolved.render.threads = scene_threads(&s->render);
    if (path_counts_apply(&s->render))
        return render_by_error(r, &resolved, options, out, why);
    return render_with_threads(r, &resolved, options, NULL, out, why);
}
