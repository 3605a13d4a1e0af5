/* Photons before a frame: tracing them, and the map of those that arrived. */
#include "render/caustics/caustics.h"

#include "render/caustics/photon_rule.h"
#include "render/core/tracer_pool.h"
#include "render/core/tracer_private.h"

#include <stdlib.h>
#include <string.h>

/* Photons that a worker traces at once, and the widest disc as a share of what makes the caustic. */
enum { CHUNK = 4096 };
#define WIDEST 0.1
/* The narrowest disc's radius in pixels, as the camera sees it without deflection. */
#define LEAST_PIXELS 0.5

struct caustics {
    plan *of;      /* refers to the map */
    plan settings; /* of the photons' frame: a copy of the plan, which owns what it refers to */
    emission *from;
    photon_frame frame;
    tracer_pool *tracers;
    photon_list *found; /* by worker */
    int workers;
    photon_map *map;
    atomic_int_fast64_t next; /* the first photon, then the first block of the map, that no worker has taken */
    const atomic_bool *stop;
};

static bool stopped(const caustics *c)
{
    return atomic_load_explicit(c->stop, memory_order_relaxed) || atomic_load(&c->frame.out_of_memory);
}

status caustics_create(plan *p, isa level, int workers, const atomic_bool *stop, caustics **out, diagnostic *why)
{
    *out = NULL;
    caustics *c = calloc(1, sizeof *c);
    if (!c)
        return out_of_memory(why);
    c->of = p;
    c->settings = *p;
    c->settings.render.depth = PHOTON_DEPTH;
    c->settings.render.min_weight = 0.0;
    c->settings.light_count = 0; /* no shadow rays */
    c->workers = workers;
    c->stop = stop;
    c->found = calloc((size_t)workers, sizeof *c->found);
    c->tracers = tracer_pool_create(level);
    const bool sizes = integrator_traits_of(&p->render)->by_chance || scene_has_soft_shadows(&p->render);
    status code =
        c->found && c->tracers ? emission_create(p, p->render.photons, sizes, &c->from, why) : out_of_memory(why);
    if (code == STATUS_OK && emission_count(c->from) > 0) {
        c->frame.from = c->from;
        const tracer_target target = {.frame_plan = &c->settings, .state = &c->frame, .rule = &integrator_of_photons};
        if (!tracer_pool_begin(c->tracers, workers, &target))
            code = out_of_memory(why);
    }
    if (code != STATUS_OK || emission_count(c->from) == 0) {
        caustics_destroy(c);
        return code;
    }
    *out = c;
    return STATUS_OK;
}

void caustics_destroy(caustics *c)
{
    if (!c)
        return;
    if (c->of->photons == c->map)
        c->of->photons = NULL;
    for (int i = 0; c->found && i < c->workers; i++)
        free(c->found[i].list);
    free(c->found);
    photon_map_destroy(c->map);
    tracer_pool_destroy(c->tracers);
    emission_destroy(c->from);
    free(c);
}

/* --- steps --- */

static void trace(caustics *c, tracer *t, int64_t first, int64_t end, photon_list *found)
{
    for (int64_t i = first; i < end && !stopped(c); i += BATCH) {
        photon_rule_emit(t, i, i + BATCH < end ? i + BATCH : end, found);
        tracer_run_full(t, c->stop);
    }
    tracer_finish(t, c->stop);
}

static void trace_together(caustics *c, int worker)
{
    const int64_t count = emission_count(c->from);
    for (int64_t first; !stopped(c) && (first = atomic_fetch_add(&c->next, CHUNK)) < count;) {
        tracer *t = tracer_pool_take(c->tracers);
        if (!t) {
            atomic_store(&c->frame.out_of_memory, true);
            return;
        }
        trace(c, t, first, first + CHUNK < count ? first + CHUNK : count, &c->found[worker]);
        tracer_pool_return(c->tracers, t);
    }
}

static status sort_alone(caustics *c, diagnostic *why)
{
    if (atomic_load(&c->frame.out_of_memory) || scene_geometry_failed(c->settings.geometry))
        return diagnose(why, STATUS_FAILURE, "use fewer photons (render.photons)", "out of memory for photons");
    if (stopped(c))
        return STATUS_OK;
    status code = photon_map_create(c->found, (size_t)c->workers, &c->map, why);
    code = code == STATUS_INTERRUPTED ? STATUS_OK : code; /* without a map; the frame stops */
    for (int i = 0; i < c->workers; i++) {
        free(c->found[i].list);
        memset(&c->found[i], 0, sizeof c->found[i]);
    }
    atomic_store(&c->next, 0);
    return code;
}

static photon_limits limits_of(const caustics *c)
{
    const camera_frame *view = &c->settings.view;
    const camera_pixel pixel = camera_pixel_of(view, &c->settings.render);
    const double least = LEAST_PIXELS * fmin(pixel.across, pixel.down);
    return (photon_limits){WIDEST * emission_extent(c->from), view->parallel ? least : 0.0,
                           view->parallel ? 0.0 : least, view->eye};
}

static void spread_together(caustics *c, int worker)
{
    (void)worker;
    const int64_t count = c->map ? (int64_t)photon_map_count(c->map) : 0;
    const photon_limits limits = limits_of(c);
    for (int64_t first; !stopped(c) && (first = atomic_fetch_add(&c->next, PHOTON_BLOCK)) < count;)
        photon_map_spread(c->map, (size_t)first, &limits);
}

static status finish_alone(caustics *c, diagnostic *why)
{
    (void)why;
    if (c->map && !stopped(c) && photon_map_finish(c->map))
        c->of->photons = c->map;
    return STATUS_OK;
}

const caustics_step caustics_steps[CAUSTICS_STEPS] = {{trace_together, sort_alone}, {spread_together, finish_alone}};

void caustics_count(const caustics *c, ray_counters *counters)
{
    ray_counters sum;
    memset(&sum, 0, sizeof sum);
    tracer_pool_collect(c->tracers, &sum);
    for (int d = 0; d <= PHOTON_DEPTH; d++)
        counters->photon += sum.by_depth[d];
    counters->cut_photon += sum.cut_photon;
}

uint64_t caustics_bytes(const render_settings *r)
{
    return r->caustics == CAUSTICS_PHOTONS ? (uint64_t)r->photons * photon_map_bytes() : 0;
}
