/* The filled vessel as a lens for horizontal rays: deviation of a ray off its axis, optical power, dispersion.
 *
 * Tolerances: an angle is good to about 1e-15, and to 1e-13 near the rim, where rays graze the wall. Power is
 * extrapolated from offsets down to a 160th of the radius: 1e-15 divided by that, amplified by the extrapolation. */
#include "realism/metrics.h"

#include "optics/media.h"
#include "scene/model/medium.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <math.h>

#define ANGLE_TOLERANCE 1e-11
#define POWER_TOLERANCE 1e-10 /* of 1 / radius */
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

static status add_deviation(const metrics *m, trial *t, diagnostic *why)
{
    const theory_shells c = setup_shells(&m->theory_at);
    const double reach = 0.98 * theory_shells_reach(&c);
    worst_pair worst = {NAN, NAN, false};
    status code = STATUS_OK;
    for (int i = 1; i <= OFFSETS && code == STATUS_OK; i++) {
        const double offset = reach * i / OFFSETS;
        double measured = NAN;
        code = lens_deviation(t->p, &t->tree, &m->at, offset, &measured, why);
        worst_take(&worst, measured, theory_shells_deviation(&c, offset));
    }
    metrics_add(m,
                (realism_value){"lens.deviation",
                                "deviation of a ray by the filled vessel; largest error for 64 offsets from its axis",
                                "rad", worst.measured, worst.theory, ANGLE_TOLERANCE});
    return code;
}

/* The limit of deviation / offset, an even function of the offset: Richardson extrapolation from halved offsets, as in
 * Romberg's method (Press and others, Numerical Recipes, 3rd ed., 4.3). */
static status paraxial_power(const metrics *m, trial *t, double *power, diagnostic *why)
{
    double value[LEVELS];
    status code = STATUS_OK;
    for (int i = 0; i < LEVELS && code == STATUS_OK; i++) {
        const double offset = 0.1 * m->at.inner / (double)(1 << i);
        double measured = NAN;
        code = lens_deviation(t->p, &t->tree, &m->at, offset, &measured, why);
        value[i] = measured / offset;
    }
    for (int order = 1; order < LEVELS; order++)
        for (int i = LEVELS - 1; i >= order; i--)
            value[i] += (value[i] - value[i - 1]) / (pow(4.0, order) - 1.0);
    *power = value[LEVELS - 1];
    return code;
}

static status add_power(const metrics *m, trial *t, diagnostic *why)
{
    const theory_shells c = setup_shells(&m->theory_at);
    const double theory = theory_shells_power(&c), tolerance = POWER_TOLERANCE / c.outer;
    double measured = NAN;
    const status code = paraxial_power(m, t, &measured, why);
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
static status deviation_at_line(const metrics *m, double lambda_nm, double *measured, double *theory, diagnostic *why)
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
    trial_end(&t);
    return code;
}

static status add_dispersion(const metrics *m, diagnostic *why)
{
    const double lines[3] = {LINE_HYDROGEN_F_NM, LINE_HELIUM_D_NM, LINE_HYDROGEN_C_NM};
    double measured[3], theory[3];
    for (int i = 0; i < 3; i++)
        TRY(deviation_at_line(m, lines[i], &measured[i], &theory[i], why));
    const char *none = isnan(theory[0] + theory[1] + theory[2]) ? "the ray does not enter the core" : NULL;
    metrics_add(m, (realism_value){"dispersion.d",
                                   none ? none : "deviation of a ray halfway from axis to rim, water in BK7, d line",
                                   "rad", measured[1], theory[1], ANGLE_TOLERANCE});
    metrics_add(m, (realism_value){"dispersion.F-C",
                                   none ? none : "angular dispersion: deviation at the F line minus that at the C line",
                                   "rad", measured[0] - measured[2], theory[0] - theory[2], ANGLE_TOLERANCE});
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
