/* Beer-Lambert law: rays run inside the liquid to the rod over known lengths; -ln(transmittance) over length is a line
 * whose slope is the absorption coefficient (Hecht, Optics, 5th ed., eq. 4.78 with the coefficient of power). A liquid
 * without absorption is given coefficients.
 *
 * Tolerance: an error of a length or of exp and log is one of each -ln(transmittance); the slope of the line weighs
 * them by the distances of their lengths from the mean. */
#include "realism/metrics.h"

#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include <math.h>

enum { LENGTHS = 9 };

scene *attenuation_scene(const scene *s, const setup *at)
{
    scene *copy = arrange_empty(s);
    if (!copy)
        return NULL;
    solid *liquid = &copy->solids[at->liquid];
    liquid->visible = 1;
    liquid->shape.position = vec3_make(0.0, 0.0, 0.0);
    /* The rod's face is at x = 0 exactly, so that lengths have no rounding error from its position. */
    const double width = 0.1 * liquid->shape.radius;
    solid *rod = &copy->solids[at->rod];
    rod->visible = 1;
    rod->shape = box_at(vec3_make(width / 2.0, liquid->shape.height / 2.0, 0.0),
                        vec3_make(width, liquid->shape.height / 2.0, width));
    if (!material_absorbs(&liquid->surface)) {
        const double one = 1.0 / (liquid->shape.radius * s->render.unit_m);
        liquid->surface.absorb_per_m = vec3_make(one, one / 2.0, one / 4.0);
    }
    return copy;
}

/* Along x to the rod, at half height. */
status attenuation_point(trial *t, const setup *at, double length, double transmittance[3], diagnostic *why)
{
    const solid_shape *liquid = &t->s->solids[at->liquid].shape;
    const vec3 from = vec3_make(-length, liquid->height / 2.0, 0.0);
    const status code = probe_path(t->p, from, vec3_make(1.0, 0.0, 0.0), -1, &t->tree, why);
    const ray_node *first = &t->tree.node[0];
    for (int c = 0; c < 3 && code == STATUS_OK; c++)
        transmittance[c] = first->end == RAY_END_HIT && first->hit.solid == at->rod ? first->hit.transmittance[c] : NAN;
    return code;
}

double attenuation_reach(const trial *t, const setup *at)
{
    const vec3 a = material_absorption(&t->s->solids[at->liquid].surface);
    const double most = fmax(a.x, fmax(a.y, a.z)) * t->s->render.unit_m;
    return fmin(0.95 * t->s->solids[at->liquid].shape.radius, 20.0 / most); /* not longer than the liquid allows */
}

/* Slopes of the least squares lines through the points (length, -ln transmittance). */
static status fit_slopes(const metrics *m, trial *t, double reach, double slope[3], double off[3], diagnostic *why)
{
    double mean_x = 0.0, xx = 0.0, x[LENGTHS], y[3][LENGTHS];
    status code = STATUS_OK;
    for (int i = 0; i < LENGTHS && code == STATUS_OK; i++) {
        double kept[3] = {NAN, NAN, NAN};
        x[i] = reach * (i + 1) / LENGTHS;
        code = attenuation_point(t, &m->at, x[i], kept, why);
        x[i] *= t->s->render.unit_m;
        mean_x += x[i] / LENGTHS;
        for (int c = 0; c < 3; c++)
            y[c][i] = -log(kept[c]);
    }
    if (code != STATUS_OK)
        return code;
    slope[0] = slope[1] = slope[2] = off[0] = off[1] = off[2] = 0.0;
    for (int i = 0; i < LENGTHS; i++) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        for (int c = 0; c < 3; c++) {
            slope[c] += (x[i] - mean_x) * y[c][i];
            /* of exp and log; of their arguments */
            off[c] += fabs(x[i] - mean_x) * bound_difference(BOUND_FORM) * (1.0 + 2.0 * fabs(y[c][i]));
        }
    }
    for (int c = 0; c < 3; c++) {
        slope[c] /= xx;
        off[c] = off[c] / xx + bound_gamma(BOUND_FORM) * fabs(slope[c]);
    }
    return STATUS_OK;
}

static status compare_slopes(const metrics *m, worst_pair *worst, diagnostic *why)
{
    scene *supposed = attenuation_scene(m->supposed, &m->theory_at);
    if (!supposed)
        return out_of_memory(why);
    const vec3 a = material_absorption(&supposed->solids[m->theory_at.liquid].surface);
    scene_destroy(supposed);
    const double theory[3] = {a.x, a.y, a.z};
    double slope[3] = {NAN, NAN, NAN}, off[3] = {NAN, NAN, NAN};
    trial t;
    status code = trial_start(&t, attenuation_scene(m->traced, &m->at), m->level, why);
    if (code == STATUS_OK) {
        code = fit_slopes(m, &t, attenuation_reach(&t, &m->at), slope, off, why);
        for (int c = 0; c < 3; c++)
            worst_take(worst, slope[c], theory[c], off[c]);
    }
    trial_end(&t);
    return code;
}

status realism_absorption(const metrics *m, diagnostic *why)
{
    worst_pair worst = WORST_NONE;
    const bool exists = m->theory_at.liquid >= 0 && m->at.liquid >= 0;
    const status code = exists ? compare_slopes(m, &worst, why) : STATUS_OK;
    metrics_add(m, (realism_value){
                       "absorption.slope",
                       exists ? "slope of -ln(transmittance) over length in the liquid; largest error of three channels"
                              : "there is no liquid",
                       "1/m", worst.measured, worst.theory, worst.tolerance});
    return code;
}
