/* The choice of the render passes from the measured speed. */
#include "web/live/passes.h"
#include "scene/model/work.h"
#include "web/live/adaptive_resolution.h"

#include <math.h>

/* The rate before any measurement: a scene of moderate depth on one slow core. */
static const double rate_unknown = 1e6;

enum { STEP = 4 }; /* from one pass to the next */

render_settings passes_settings(const render_settings *r, int shrink, bool single)
{
    render_settings pass = *r;
    pass.width = (r->width + shrink - 1) / shrink;
    pass.height = (r->height + shrink - 1) / shrink;
    if (single)
        pass.samples = pass.paths = 1;
    return pass;
}

double passes_work(const render_settings *r, int shrink, bool single)
{
    const render_settings pass = passes_settings(r, shrink, single);
    return scene_camera_rays(&pass);
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
