/* Traces photons before a frame, and builds the map of the photons that arrive on matte surfaces. */
#include "render/frame/caustics.h"

#include "base/cancel.h"
#include "render/caustics/emission.h"
#include "render/frame/tracers.h"

#include <stdlib.h>
#include <string.h>

/* Photons that a worker traces at once, and the radius of the widest disc as a fraction of the extent of the solids
 * that make caustics. */
enum { CHUNK = 4096 };
#define WIDEST 0.1
/* Radius of the narrowest disc in pixels, as seen without deflection. */
#define LEAST_PIXELS 0.5

struct caustics {
    plan *frame_plan; /* the frame's plan, which refers to the map */
    plan settings;    /* the photons' plan: a shallow copy of frame_plan */
    emission *from;
    photon_frame frame;
    tracer_pool *tracers;
    photon_list *found; /* by worker */
    int workers;
    photon_map *map;
    atomic_int_fast64_t next; /* the next photon to trace, then the next photon of the map to spread */
};

static bool stopped(const caustics *c)
{
    return cancel_asked() || atomic_load(&c->frame.out_of_memory);
}

static status prepare(caustics *c, plan *p, diagnostic *why)
{
    const bool sizes = integrator_traits_of(&p->render)->by_chance || scene_has_soft_shadows(&p->render);
    c->found = calloc((size_t)c->workers, sizeof *c->found);
    if (!c->found || !c->tracers)
        return out_of_memory(why);
    TRY(emission_create(p, p->render.photons, sizes, &c->from, why));
    if (emission_count(c->from) == 0)
        return STATUS_OK;
    c->frame.from = c->from;
    c->frame.arrived = calloc((size_t)emission_target_count(c->from) + 1, sizeof *c->frame.arrived);
    const tracer_target target = {
        .frame_plan = &c->settings, .state = &c->frame, .integrator_override = &integrator_of_photons};
    if (!c->frame.arrived || !tracer_pool_begin(c->tracers, c->workers, &target))
        return out_of_memory(why);
    c->frame.is_pilot = emission_begin_pilot(c->from);
    return STATUS_OK;
}

status caustics_create(plan *p, isa level, int workers, caustics **out, diagnostic *why)
{
    *out = NULL;
    caustics *c = calloc(1, sizeof *c);
    if (!c)
        return out_of_memory(why);
    c->frame_plan = p;
    c->settings = *p;
    c->settings.render.depth = DEPTH_UNLIMITED;
    c->settings.render.min_weight = 0.0;
    c->settings.light_count = 0; /* no shadow rays */
    c->workers = workers;
    c->tracers = tracer_pool_create(level);
    status code = prepare(c, p, why);
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
    if (c->frame_plan->photons == c->map)
        c->frame_plan->photons = NULL;
    for (int i = 0; c->found && i < c->workers; i++)
        free(c->found[i].list);
    free(c->found);
    photon_map_destroy(c->map);
    tracer_pool_destroy(c->tracers);
    free(c->frame.arrived);
    emission_destroy(c->from);
    free(c);
}

/* --- steps --- */

static void trace(caustics *c, tracer *t, int64_t first, int64_t end, photon_list *found)
{
    for (int64_t i = first; i < end && !stopped(c); i += BATCH) {
        photon_integrator_emit(t, i, i + BATCH < end ? i + BATCH : end, found);
        tracer_run_full(t);
    }
    tracer_finish(t);
}

static void trace_photons(caustics *c, int worker)
{
    const int64_t count = emission_count(c->from);
    for (int64_t first; !stopped(c) && (first = atomic_fetch_add(&c->next, CHUNK)) < count;) {
        tracer *t = tracer_pool_acquire(c->tracers);
        if (!t) {
            atomic_store(&c->frame.out_of_memory, true);
            return;
        }
        trace(c, t, first, first + CHUNK < count ? first + CHUNK : count, &c->found[worker]);
        tracer_pool_release(c->tracers, t);
    }
}

static void trace_pilot(caustics *c, int worker)
{
    if (c->frame.is_pilot)
        trace_photons(c, worker);
}

static status end_pilot(caustics *c, diagnostic *why)
{
    const int targets = emission_target_count(c->from);
    if (!c->frame.is_pilot || stopped(c))
        return STATUS_OK;
    bool *delivers = calloc((size_t)targets + 1, sizeof *delivers);
    if (!delivers)
        return out_of_memory(why);
    for (int k = 0; k < targets; k++) {
        delivers[k] = atomic_load(&c->frame.arrived[k]) > 0;
        atomic_store(&c->frame.arrived[k], 0);
    }
    emission_end_pilot(c->from, delivers);
    free(delivers);
    c->frame.is_pilot = false;
    atomic_store(&c->next, 0);
    return STATUS_OK;
}

static status sort_photons(caustics *c, diagnostic *why)
{
    if (atomic_load(&c->frame.out_of_memory) || scene_geometry_failed(c->settings.geometry))
        return diagnose(why, STATUS_FAILURE, "use fewer photons (render.photons)", "out of memory for photons");
    if (stopped(c))
        return STATUS_OK;
    status code = photon_map_create(c->found, (size_t)c->workers, &c->map, why);
    code = code == STATUS_INTERRUPTED ? STATUS_OK : code; /* no map; the frame reports the cancellation */
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

static void spread_photons(caustics *c, int worker)
{
    (void)worker;
    const int64_t count = c->map ? (int64_t)photon_map_count(c->map) : 0;
    const photon_limits limits = limits_of(c);
    for (int64_t first; !stopped(c) && (first = atomic_fetch_add(&c->next, PHOTON_BLOCK)) < count;)
        photon_map_spread(c->map, (size_t)first, &limits);
}

static status finish_map(caustics *c, diagnostic *why)
{
    if (!c->map || stopped(c))
        return STATUS_OK;
    if (!photon_map_finish(c->map))
        return stopped(c) ? STATUS_OK : out_of_memory(why);
    c->frame_plan->photons = c->map;
    return STATUS_OK;
}

const caustics_step caustics_steps[CAUSTICS_STEPS] = {
    {trace_pilot, end_pilot}, {trace_photons, sort_photons}, {spread_photons, finish_map}};

void caustics_count(const caustics *c, ray_counters *counters)
{
    ray_counters sum;
    memset(&sum, 0, sizeof sum);
    tracer_pool_collect(c->tracers, &sum);
    for (int d = 0; d <= COUNTERS_DEPTH_MAX; d++)
        counters->photon += sum.by_depth[d];
}

/* A caustic of fewer photons is mostly noise; a caustic with a smaller fraction of the photons' light is negligible. */
enum { PHOTONS_ENOUGH = 1000 };
#define LIGHT_SEEN 1e-3

/* The light that a solid deflects to matte surfaces, and the number of its photons. */
static double light_by(const caustics *c, int number, int64_t *arrived)
{
    double sum = 0.0;
    *arrived = 0;
    for (int k = 0; k < emission_target_count(c->from); k++) {
        const int64_t count = atomic_load(&c->frame.arrived[k]);
        if (emission_target_solid(c->from, k) != number)
            continue;
        sum += emission_light(c->from, k, count);
        *arrived += count;
    }
    return sum;
}

photon_shortage caustics_find_shortage(const caustics *c)
{
    photon_shortage few = {.solid = -1, .arrived = PHOTONS_ENOUGH};
    double all = 0.0;
    for (int k = 0; k < emission_target_count(c->from); k++)
        all += emission_light(c->from, k, atomic_load(&c->frame.arrived[k]));
    for (int k = 0; k < emission_target_count(c->from); k++) {
        int64_t arrived;
        const int number = emission_target_solid(c->from, k);
        if (number >= 0 && light_by(c, number, &arrived) > LIGHT_SEEN * all && arrived < few.arrived)
            few.solid = number, few.arrived = arrived;
    }
    if (few.solid >= 0)
        few.enough = (c->settings.render.photons * PHOTONS_ENOUGH + few.arrived - 1) / few.arrived;
    return few;
}

uint64_t caustics_bytes(const render_settings *r)
{
    return r->caustics == CAUSTICS_PHOTONS ? (uint64_t)r->photons * photon_map_bytes() : 0;
}
