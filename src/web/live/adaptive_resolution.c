/* The steps of the adaptive resolution, with hysteresis. */
#include "web/live/adaptive_resolution.h"

const int resolution_shrinks[RESOLUTION_STEPS] = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32};

enum { STEPS = 8 }; /* of a live frame: the slime is still seen in the coarsest */

int adaptive_resolution_divisor(const adaptive_resolution *p)
{
    return resolution_shrinks[p->step];
}

/* The ratio of the pixel counts of two steps. */
static double growth(int from, int to)
{
    const double ratio = (double)resolution_shrinks[from] / resolution_shrinks[to];
    return ratio * ratio;
}

static void go(adaptive_resolution *p, int step)
{
    p->frame_s *= growth(p->step, step);
    p->step = step;
}

void adaptive_resolution_update(adaptive_resolution *p, double wall_s, double wanted_s)
{
    /* The weight of the newest frame; the share of the wanted time above which the resolution drops, and the predicted
     * share below which it rises. The gap between both prevents oscillation. */
    const double recent = 0.3, late = 1.3, early = 0.8;
    p->frame_s = p->frame_s > 0.0 ? p->frame_s + recent * (wall_s - p->frame_s) : wall_s;
    if (p->frame_s > late * wanted_s && p->step < STEPS - 1)
        go(p, p->step + 1);
    else if (p->step > 0 && p->frame_s * growth(p->step, p->step - 1) < early * wanted_s)
        go(p, p->step - 1);
}
