/* The choice of the render passes from the measured speed. */
#include "web/live/passes.h"
#include "scene/model/work.h"

#include <math.h>

/* The rate before any measurement: a scene of moderate depth on one slow core. */
static const double rate_unknown = 1e6;

enum { SHRINK_MAX = 32, STEP = 4 }; /* of the coarsest pass; from one pass to the next */

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
        int shrink = 1;
        while (shrink < SHRINK_MAX && passes_work(r, shrink, true) / speed > first_s)
            shrink *= 2;
        for (; shrink > 1; shrink /= shrink > STEP ? STEP : shrink)
            put(&plan, shrink, true);
        if (many)
            put(&plan, 1, true);
    }
    put(&plan, 1, false);
    return plan;
}
