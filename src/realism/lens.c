/* Paths through the filled vessel: it is a lens for horizontal rays and for an arrow behind it, and paths are
 * reversible. */
#include "realism/metrics.h"

#include "base/random.h"
#include "optics/media.h"
#include "scene/model/medium.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <math.h>

/* --- the lens --- */

/* The filled vessel as a lens for horizontal rays: deviation of a ray off its axis, optical power, dispersion.
 *
 * Tolerances: for an angle, the bound of its path. Power is extrapolated from deviations at offsets down to an 80th of
 * the radius; its tolerance is the same combination of their bounds with positive coefficients, plus the remainder of
 * the closed form's extrapolation. */

enum { OFFSETS = 64, LEVELS = 5 };

status lens_deviation(probe *p, ray_tree *tree, const setup *at, double offset, double *radians, diagnostic *why)
{
    const vec3 from = vec3_make(at->x + offset, (at->low + at->high) / 2.0, at->z - 4.0 * at->outer);
    TRY(probe_path(p, from, vec3_make(0.0, 0.0, 1.0), -1, tree, why));
    const ray_node *last = &tree->node[tree->count - 1];
    *radians = last->end == RAY_END_SKY ? atan2(-last->direction.x, last->direction.z)
                                        : NAN; /* positive towards the axis, which is in the direction -x */
    return STATUS_OK;
}

/* The tolerance of the angle just measured: the bound of its path, and the rounding of the angle. */
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
        worst_pair_add(&worst, measured, theory_shells_deviation(&c, offset),
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

/* The deviation of a ray halfway to the rim at one spectral line, with water in BK7. */
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

/* --- the arrow --- */

/* An arrow behind a glass of water: solids named vessel, liquid and arrow (experiments/scenes/arrow.yaml). The eye is
 * at the camera's distance from the axis, on the level of the middle of the liquid. A line of sight near the axis meets
 * the arrow's plane behind the glass at a distance from the axis that is a fraction of the distance without the glass;
 * if the fraction is negative, the arrow appears reversed. */

#define OFFSET 1e-4 /* distance from the axis over the inner radius */

bool arrow_is_there(const scene *s)
{
    return scene_find_solid(s, "arrow") >= 0 && scene_find_solid(s, "vessel") >= 0 &&
           scene_find_solid(s, "liquid") >= 0;
}

/* The distance from the axis at which the path, refracted by the glass, meets the plane. */
static status place_of(trial *t, const setup *at, double eye, double offset, double behind, double *place,
                       diagnostic *why)
{
    const double sine = offset / eye;
    const vec3 from = vec3_make(at->x, (at->low + at->high) / 2.0, at->z - eye);
    TRY(probe_path(t->p, from, vec3_make(sine, 0.0, sqrt(1.0 - sine * sine)), -1, &t->tree, why));
    const ray_node *last = &t->tree.node[t->tree.count - 1];
    const double distance = (at->z + behind - last->origin.z) / last->direction.z;
    *place = last->end == RAY_END_SKY ? last->origin.x + distance * last->direction.x - at->x : NAN;
    return STATUS_OK;
}

status arrow_curve(const metrics *m, realism_points *out, diagnostic *why)
{
    setup at;
    TRY(setup_read_glass(m->traced, &at, why));
    const vec3 from = m->traced->camera.position;
    const double eye = hypot(from.x - at.x, from.z - at.z), offset = OFFSET * at.inner;
    const theory_shells c = setup_shells(&at);
    if (eye <= at.outer)
        return diagnose(why, STATUS_BAD_INPUT, "move the camera away from the vessel", "the eye is inside 'vessel'");
    trial t;
    status code = trial_start(&t, arrange_vessel(m->traced, &at), m->level, why);
    for (int i = 11; i <= 100 && code == STATUS_OK; i++) {
        const double behind = 0.1 * i * at.outer, without = (eye + behind) * tan(asin(offset / eye));
        double place = NAN;
        code = place_of(&t, &at, eye, offset, behind, &place, why);
        curve_add(out, behind, place / without, theory_shells_place(&c, eye, behind, offset) / without);
    }
    trial_end(&t);
    return code;
}

/* --- reversed paths --- */

/* Reversed paths: light returns along the path that it came, and an interface has the same transmittance from both
 * sides (Stokes relations; Hecht, Optics, 5th ed., 4.10). Random paths through the vessel, refracted or reflected once,
 * are traced to their end and back. The reversed path ends on the first ray of the path, and has the same throughput.
 * (Radiance has an additional factor n^2 in a medium; both ends are outside, where it cancels, and the tracer's
 * throughput omits it.) Paths near grazing incidence are excluded: errors grow there as 1 / cos.
 *
 * Tolerance: the bound of the reversed path, which includes the path's errors at each surface (bound_difference). */

#define LEAST_COSINE 0.1
enum { PATHS = 2000, HITS_MAX = 12 };

typedef struct test_path {
    vec3 from, along;
    int reflect_at;
} test_path;

static test_path random_path(const setup *at, uint32_t number)
{
    const random_words a = random_at(10, number, 0, 0, 0), b = random_at(10, number, 1, 0, 0);
    const double turn = 2.0 * M_PI * random_unit(a.word[0]), middle = (at->low + at->high) / 2.0;
    const vec3 from =
        vec3_make(at->x + 3.0 * at->outer * cos(turn), middle + (random_unit(a.word[1]) - 0.3) * 3.0 * at->outer,
                  at->z + 3.0 * at->outer * sin(turn));
    const double aside = at->outer * (2.0 * random_unit(a.word[2]) - 1.0);
    const vec3 to = vec3_make(at->x - aside * sin(turn), at->low + (at->high - at->low) * random_unit(a.word[3]),
                              at->z + aside * cos(turn));
    const test_path w = {from, vec3_normalize(vec3_sub(to, from)), (int)(b.word[0] % 4) - 1};
    return w;
}

/* The number of surfaces of the path; -1 if it does not leave the vessel, meets more than HITS_MAX surfaces, or grazes
 * one. There are no surfaces between media with equal indices. */
static int surfaces(const ray_tree *tree)
{
    const int hits = (int)tree->count - 1;
    if (hits > HITS_MAX || tree->node[hits].end != RAY_END_SKY)
        return -1;
    for (int i = 0; i < hits; i++) {
        const ray_hit *h = &tree->node[i].hit;
        if (h->cos_i < LEAST_COSINE || (!h->tir && h->cos_t < LEAST_COSINE))
            return -1;
    }
    return hits;
}

/* The surface at which the path was reflected; -1 if it left before the requested reflection. */
static int reflected_at(const ray_tree *tree, int reflection)
{
    return reflection >= 0 && reflection + 1 < (int)tree->count && tree->node[reflection + 1].kind == RAY_REFLECT
               ? reflection
               : -1;
}

/* A path and its reversal: the throughput of each, the distance by which the reversal misses the path's origin, and the
 * bounds. */
typedef struct round_trip {
    double forth, back, miss;
    path_bound off;
    bool done;
} round_trip;

static status trace_back(trial *forth, trial *back, const setup *at, uint32_t number, round_trip *out, diagnostic *why)
{
    const test_path w = random_path(at, number);
    *out = (round_trip){NAN, NAN, NAN, {0.0, 0.0, 0.0}, false};
    status code = probe_path(forth->p, w.from, w.along, w.reflect_at, &forth->tree, why);
    const int hits = code == STATUS_OK ? surfaces(&forth->tree) : -1;
    if (hits < 0)
        return code;
    const ray_node *last = &forth->tree.node[hits];
    const int reflection = reflected_at(&forth->tree, w.reflect_at);
    const vec3 start = vec3_add(last->origin, vec3_scale(last->direction, 3.0 * at->outer));
    TRY(probe_path(back->p, start, vec3_scale(last->direction, -1.0), reflection < 0 ? -1 : hits - 1 - reflection,
                   &back->tree, why));
    const ray_node *home = &back->tree.node[back->tree.count - 1];
    const vec3 away = vec3_sub(w.from, home->origin);
    out->done = true;
    out->forth = last->throughput[0];
    if ((int)back->tree.count - 1 != hits || home->end != RAY_END_SKY)
        return STATUS_OK; /* another path: back and miss stay NaN */
    out->back = home->throughput[0];
    out->miss = vec3_length(vec3_cross(away, home->direction));
    out->off = bound_path(&back->tree, 1.0 / at->inner);
    out->off.across += out->off.heading * vec3_length(away);
    return STATUS_OK;
}

status realism_reversal(const metrics *m, diagnostic *why)
{
    trial forth, back = {0};
    worst_pair ratio = WORST_NONE, miss = WORST_NONE;
    status code = trial_start(&forth, arrange_vessel(m->supposed, &m->theory_at), m->level, why);
    THEN(code, trial_start(&back, arrange_vessel(m->traced, &m->at), m->level, why));
    for (uint32_t i = 0; i < PATHS && code == STATUS_OK; i++) {
        round_trip r;
        code = trace_back(&forth, &back, &m->theory_at, i, &r, why);
        if (r.done && r.forth > 0.0) {
            worst_pair_add(&ratio, r.back / r.forth, 1.0, r.off.weight);
            worst_pair_add(&miss, r.miss, 0.0, r.off.across);
        }
    }
    trial_end(&forth);
    trial_end(&back);
    metrics_add(
        m, (realism_value){"reversal.throughput",
                           "throughput of a reversed path over that of the path; largest error of about 1000 paths", "",
                           ratio.measured, ratio.theory, ratio.tolerance});
    metrics_add(m, (realism_value){"reversal.path", "distance by which the reversed path misses the origin of the path",
                                   "scene units", miss.measured, miss.theory, miss.tolerance});
    return code;
}
