/* The filled vessel as a lens for horizontal rays: deviation of a ray off its axis, optical power, dispersion.
 *
 * Tolerances: an angle has the bound of its path. Power is extrapolated from deviations over offsets down to an 80th of
 * the radius: the same combination of their bounds with positive coefficients, and the closed form's own remainder. */
#include "realism/metrics.h"

#include "optics/media.h"
#include "scene/model/medium.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <math.h>

enum { OFFSETS = 64, LEVELS = 5 };

status lens_deviation(probe *p, ray_tree *tree, const setup *at, double offset, double *radians, diagnostic *why)
{
    const vec3 from = vec3_make(at->x + offset, (at->low + at->high) / 2.0, at->z - 4.0 * at->outer);
    TRY(probe_path(p, from, vec3_make(0.0, 0.0, 1.0), -1, tree, why));
    const ray_node *last = &tree->node[tree->count - 1];
    *radians = last->end == RAY_END_SKY ? atan2(-last->direction.x, last->direction.z)
                                        : NAN; /* towards the axis, in the direction -x */
    return STATUS_OK;
}

/* Of the angle just measured: that of its path, and the rounding of the angle itself. */
static double deviation_tolerance(const ray_tree *tree, const setup *at, double radians)
{
    const vec3 center = vec3_make(at->x, (at->low + at->high) / 2.0, at->z);
    return bound_around(tree, center) + bound_difference(BOUND_FORM) * fabs(radians);
}

static status add_deviation(const metrics *m, trial *t, diagnostic *why)
{
    const theory_shells c = setup_shells(&m->theory_at);
    const double reach = 0.98 * theory_shells_reach(&c);
    worst_pair worst = WORST_NONE;
    status code = STATUS_OK;
    for (int i = 1; i <= OFFSETS && code == STATUS_OK; i++) {
        const double offset = reach * i / OFFSETS;
        double measured = NAN;
        code = lens_deviation(t->p, &t->tree, &m->at, offset, &measured, why);
        worst_take(&worst, measured, theory_shells_deviation(&c, offset),
                   deviation_tolerance(&t->tree, &m->at, measured));
    }
    metrics_add(m,
                (realism_value){"lens.deviation",
                                "deviation of a ray by the filled vessel; largest error for 64 offsets from its axis",
                                "rad", worst.measured, worst.theory, worst.tolerance});
    return code;
}

/* The limit of deviation / offset, an even function of the offset: Richardson extrapolation from halved offsets, as in
 * Romberg's method (Press and others, Numerical Recipes, 3rd ed., 4.3). */
static void extrapolate(double value[LEVELS], double sign)
{
    for (int order = 1; order < LEVELS; order++)
        for (int i = LEVELS - 1; i >= order; i--)
            value[i] = (pow(4.0, order) * value[i] - sign * value[i - 1]) / (pow(4.0, order) - 1.0);
}

static status paraxial_power(const metrics *m, trial *t, double *power, double *tolerance, diagnostic *why)
{
    const theory_shells c = setup_shells(&m->theory_at);
    double value[LEVELS], off[LEVELS], closed[LEVELS];
    status code = STATUS_OK;
    for (int i = 0; i < LEVELS && code == STATUS_OK; i++) {
        const double offset = 0.2 * m->at.inner / (double)(1 << i);
        double measured = NAN;
        code = lens_deviation(t->p, &t->tree, &m->at, offset, &measured, why);
        value[i] = measured / offset;
        off[i] = deviation_tolerance(&t->tree, &m->at, measured) / offset;
        closed[i] = theory_shells_deviation(&c, offset) / offset;
    }
    extrapolate(value, 1.0);
    extrapolate(off, -1.0);
    extrapolate(closed, 1.0);
    *power = value[LEVELS - 1];
    *tolerance = off[LEVELS - 1] + fabs(closed[LEVELS - 1] - closed[LEVELS - 2]);
    return code;
}

static status add_power(const metrics *m, trial *t, diagnostic *why)
{
    const theory_shells c = setup_shells(&m->theory_at);
    const double theory = theory_shells_power(&c);
    double measured = NAN, tolerance = NAN;
    const status code = paraxial_power(m, t, &measured, &tolerance, why);
    /* An error e of the power is an error f^2 e of the focal length f. */
    const double size = fabs(theory) * c.outer;
    const bool focuses = size > 1e-4;
    metrics_add(m, (realism_value){"lens.power", "optical power of the filled vessel, near its axis", "1/scene unit",
                                   measured, theory, tolerance});
    metrics_add(m, (realism_value){"lens.focal_length",
                                   focuses ? "focal length, from the vessel's axis, for paraxial rays"
                                           : "the vessel does not focus",
                                   "scene units", focuses ? 1.0 / measured : NAN, focuses ? 1.0 / theory : NAN,
                                   tolerance / (theory * theory)});
    return code;
}

/* The same with water in BK7 at one spectral line, half way to the rim. */
static status deviation_at_line(const metrics *m, double lambda_nm, double *measured, double *theory, double *tolerance,
                                diagnostic *why)
{
    trial t;
    scene *s = arrange_vessel(m->traced, &m->at);
    status code = s ? scene_set(s, "vessel.medium", "bk7", why) : STATUS_OK;
    if (s && code == STATUS_OK && m->at.liquid >= 0)
        code = scene_set(s, "liquid.medium", "water", why);
    if (s)
        s->render.lambda_nm = lambda_nm;
    if (code != STATUS_OK) {
        scene_destroy(s);
        return code;
    }
    const double offset = 0.5 * m->theory_at.inner;
    theory_shells c = setup_shells(&m->theory_at);
    const index_law around = surrounding_index_law(&m->supposed->background);
    c.n_around = index_law_at(&around, lambda_nm);
    c.n_wall = medium_index(media_find("bk7"), lambda_nm);
    c.n_core = m->theory_at.liquid >= 0 ? medium_index(media_find("water"), lambda_nm) : c.n_around;
    *theory = offset < theory_shells_reach(&c) ? theory_shells_deviation(&c, offset) : NAN;
    code = trial_start(&t, s, m->level, why);
    THEN(code, lens_deviation(t.p, &t.tree, &m->at, offset, measured, why));
    *tolerance = deviation_tolerance(&t.tree, &m->at, *measured);
    trial_end(&t);
    return code;
}

static status add_dispersion(const metrics *m, diagnostic *why)
{
    const double lines[3] = {LINE_HYDROGEN_F_NM, LINE_HELIUM_D_NM, LINE_HYDROGEN_C_NM};
    double measured[3], theory[3], off[3];
    for (int i = 0; i < 3; i++)
        TRY(deviation_at_line(m, lines[i], &measured[i], &theory[i], &off[i], why));
    const char *none = isnan(theory[0] + theory[1] + theory[2]) ? "the ray does not enter the core" : NULL;
    metrics_add(m, (realism_value){"dispersion.d",
                                   none ? none : "deviation of a ray halfway from axis to rim, water in BK7, d line",
                                   "rad", measured[1], theory[1], off[1]});
    metrics_add(m, (realism_value){"dispersion.F-C",
                                   none ? none : "angular dispersion: deviation at the F line minus that at the C line",
                                   "rad", measured[0] - measured[2], theory[0] - theory[2], off[0] + off[2]});
    return STATUS_OK;
}

status realism_lens(const metrics *m, diagnostic *why)
{
    trial t;
    status code = trial_start(&t, arrange_vessel(m->traced, &m->at), m->level, why);
    THEN(code, add_deviation(m, &t, why));
    THEN(code, add_power(m, &t, why));
    trial_end(&t);
    return code == STATUS_OK ? add_dispersion(m, why) : code;
}
