/* The choice of the render passes from the measured speed, and the steps of the adaptive resolution, with
 * hysteresis. */
#include "web/live/passes.h"
#include "scene/model/scene.h"

#include <math.h>

const int resolution_shrinks[RESOLUTION_STEPS] = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32};

/* --- passes --- */

/* The work per second (passes_work) before any measurement: a scene of moderate depth on one slow core. */
static const double rate_unknown = 1e6;

enum { PASS_STEP = 4 }; /* ratio of the widths of a pass and the one before */

/* Photons of a pass: reduced like its pixels, and to a quarter in a pass with single samples. A photon costs about ten
 * camera rays. */
enum { PHOTONS_MIN = 2000, SINGLE_DIVISOR = 4 };
#define PHOTON_COST 10.0

static int64_t photons_of(int64_t all, int shrink, bool single)
{
    const int64_t divisor = (int64_t)shrink * shrink * (single ? SINGLE_DIVISOR : 1), part = all / divisor;
    return part > PHOTONS_MIN ? part : all < PHOTONS_MIN ? all : PHOTONS_MIN;
}

render_settings passes_settings(const render_settings *r, int shrink, bool single)
{
    render_settings pass = *r;
    pass.width = (r->width + shrink - 1) / shrink;
    pass.height = (r->height + shrink - 1) / shrink;
    pass.photons = photons_of(r->photons, shrink, single);
    if (single)
        pass.samples = pass.paths = 1;
    return pass;
}

double passes_work(const render_settings *r, int shrink, bool single)
{
    const render_settings pass = passes_settings(r, shrink, single);
    return scene_camera_rays(&pass) + (scene_has_caustics(r) ? PHOTON_COST * (double)pass.photons : 0.0);
}

static void add_pass(pass_plan *plan, int shrink, bool single)
{
    plan->shrink[plan->count] = shrink;
    plan->single[plan->count] = single;
    plan->count++;
}

pass_plan passes_plan(const render_settings *r, double rate, double first_s)
{
    pass_plan plan = {.count = 0};
    const double speed = rate > 0.0 ? rate : rate_unknown;
    const bool many = r->samples > 1 || integrator_traits_of(r)->by_chance;
    if (passes_work(r, 1, false) / speed > first_s) {
        int step = 0;
        while (step < RESOLUTION_STEPS - 1 && passes_work(r, resolution_shrinks[step], true) / speed > first_s)
            step++;
        for (int shrink = resolution_shrinks[step]; shrink > 1; shrink /= shrink > PASS_STEP ? PASS_STEP : shrink)
            add_pass(&plan, shrink, true);
        if (many)
            add_pass(&plan, 1, true);
    }
    add_pass(&plan, 1, false);
    return plan;
}

/* --- the live frames --- */

enum { LIVE_STEPS = 8 }; /* the slime is still visible at the coarsest of these steps */

int adaptive_resolution_divisor(const adaptive_resolution *resolution)
{
    return resolution_shrinks[resolution->step];
}

/* The ratio of the pixel counts of two steps. */
static double growth(int from, int to)
{
    const double ratio = (double)resolution_shrinks[from] / resolution_shrinks[to];
    return ratio * ratio;
}

static void set_step(adaptive_resolution *resolution, int step)
{
    resolution->frame_s *= growth(resolution->step, step);
    resolution->step = step;
}

void adaptive_resolution_update(adaptive_resolution *resolution, double wall_s, double wanted_s)
{
    /* The weight of the newest frame; the fraction of the wanted time above which the resolution drops, and the
     * predicted fraction below which it rises. The gap between both prevents oscillation. */
    const double recent = 0.3, late = 1.3, early = 0.8;
    resolution->frame_s =
        resolution->frame_s > 0.0 ? resolution->frame_s + recent * (wall_s - resolution->frame_s) : wall_s;
    if (resolution->frame_s > late * wanted_s && resolution->step < LIVE_STEPS - 1)
        set_step(resolution, resolution->step + 1);
    else if (resolution->step > 0 &&
             resolution->frame_s * growth(resolution->step, resolution->step - 1) < early * wanted_s)
        set_step(resolution, resolution->step - 1);
}
