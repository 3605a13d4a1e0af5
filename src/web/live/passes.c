/* The choice of the render passes from the measured speed. */
#include "web/live/passes.h"
#include "scene/model/work.h"
#include "web/live/adaptive_resolution.h"

#include <math.h>

/* The rate before any measurement: a scene of moderate depth on one slow core. */
static const double rate_unknown = 1e6;

enum { STEP = 4 }; /* from one pass to the next */

/* Photons of a pass: a share like that of its pixels, a quarter of all in one of single samples. A photon costs about
 * ten camera rays. */
enum { PHOTONS_MIN = 2000, SINGLE_SHARE = 4 };
#define PHOTON_COST 10.0

static int64_t photons_of(int64_t all, int shrink, bool single)
{
    const int64_t share = (int64_t)shrink * shrink * (single ? SINGLE_SHARE : 1), part = all / share;
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

static void put(pass_plan *plan, int shrink, bool single)
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
        for (int shrink = resolution_shrinks[step]; shrink > 1; shrink /= shrink > STEP ? STEP : shrink)
            put(&plan, shrink, true);
        if (many)
            put(&plan, 1, true);
    }
    put(&plan, 1, false);
    return plan;
}
