/* Flat surfaces: single interfaces between the scene's media, slabs, and empty gaps. */
#include "realism/metrics.h"

#include "scene/model/scene.h"
#include <math.h>

/* --- interfaces --- */

/* Single interfaces between the scene's media: critical angles and reflectances.
 *
 * Tolerances: a relative error e of sin i or cos i moves the critical angle by e tan i or e cot i, to which half of the
 * bisection's last interval is added. The tolerances of reflectances are bound_reflectances. */

#define CRITICAL_WIDTH 1e-14 /* of the bisection's last interval */
enum { ANGLES = 900 };       /* steps of 0.1 degrees */

status interface_measure(probe *p, ray_tree *tree, double start_y, double angle, interface_reflectances *out,
                         diagnostic *why)
{
    const vec3 down = vec3_make(sin(angle), start_y > 0.0 ? -cos(angle) : cos(angle), 0.0);
    const status code = probe_path(p, vec3_make(0.0, start_y, 0.0), down, 0, tree, why);
    const ray_hit *hit = &tree->node[0].hit;
    *out = (interface_reflectances){0.0, 0.0, 0.0};
    /* Between media with equal indices there is no interface: the ray continues to the next surface. */
    if (code != STATUS_OK || tree->node[0].end != RAY_END_HIT || fabs(hit->point.y) > 0.5)
        return code;
    const bool reflected = tree->count > 1 && tree->node[1].kind == RAY_REFLECT;
    const double arrived = tree->node[0].throughput[0] * hit->transmittance[0];
    *out = (interface_reflectances){hit->R_s, hit->R_p, reflected ? tree->node[1].throughput[0] / arrived : 0.0};
    return STATUS_OK;
}

typedef struct crossing {
    const char *critical, *s, *p, *mean;
    setup_medium from, to;
} crossing;
static const crossing crossings[] = {
    {"critical.vessel", "fresnel.vessel.s", "fresnel.vessel.p", "fresnel.vessel", SETUP_OUTSIDE, SETUP_VESSEL},
    {"critical.liquid", "fresnel.liquid.s", "fresnel.liquid.p", "fresnel.liquid", SETUP_OUTSIDE, SETUP_LIQUID},
    {"critical.wall", "fresnel.wall.s", "fresnel.wall.p", "fresnel.wall", SETUP_VESSEL, SETUP_LIQUID},
};
static const char *const critical_what[] = {"critical angle between vessel and surroundings",
                                            "critical angle between liquid and surroundings",
                                            "critical angle between the vessel's wall and liquid"};

static status bisect_critical(trial *t, double start_y, double *angle, diagnostic *why)
{
    double low = 0.0, high = M_PI / 2.0 - 1e-9;
    while (high - low > CRITICAL_WIDTH) {
        const double middle = (low + high) / 2.0;
        const vec3 d = vec3_make(sin(middle), start_y > 0.0 ? -cos(middle) : cos(middle), 0.0);
        TRY(probe_path(t->p, vec3_make(0.0, start_y, 0.0), d, -1, &t->tree, why));
        if (t->tree.node[0].end == RAY_END_HIT && t->tree.node[0].hit.tir)
            high = middle;
        else
            low = middle;
    }
    *angle = (low + high) / 2.0;
    return STATUS_OK;
}

static bool has_media(const metrics *m, const crossing *at)
{
    return at->to != SETUP_LIQUID || (m->theory_at.liquid >= 0 && m->at.liquid >= 0);
}

static double critical_tolerance(double angle)
{
    return 0.5 * CRITICAL_WIDTH + bound_difference(BOUND_REFLECTANCES) * (tan(angle) + 1.0 / tan(angle)) +
           bound_difference(BOUND_FORM) * angle;
}

/* Adds a critical angle, measured from the optically denser side. */
static status add_critical(const metrics *m, int which, diagnostic *why)
{
    setup_medium from = crossings[which].from, to = crossings[which].to;
    const double *n = m->theory_at.n;
    if (n[from] < n[to]) {
        from = crossings[which].to;
        to = crossings[which].from;
    }
    const bool filled = has_media(m, &crossings[which]);
    const double theory = filled ? theory_critical_angle(n[from], n[to]) : NAN;
    const bool exists = !isnan(theory);
    const char *const none =
        filled ? "the media have equal refractive indices: there is no total reflection" : "there is no liquid";
    double measured = NAN, start_y;
    status code = STATUS_OK;
    if (exists) {
        trial t;
        scene *s = arrange_interface(m->traced, &m->at, from, to, &start_y);
        code = trial_start(&t, s, m->level, why);
        THEN(code, bisect_critical(&t, start_y, &measured, why));
        trial_end(&t);
    }
    metrics_add(m, (realism_value){crossings[which].critical, exists ? critical_what[which] : none, "rad", measured,
                                   theory, critical_tolerance(theory)});
    return code;
}

static status compare_reflectances(const metrics *m, const crossing *at, worst_pair worst[3], diagnostic *why)
{
    trial t;
    double start_y = 0.0;
    const double *n = m->theory_at.n;
    scene *s = arrange_interface(m->traced, &m->at, at->from, at->to, &start_y);
    status code = trial_start(&t, s, m->level, why);
    for (int i = 0; i < ANGLES && code == STATUS_OK; i++) {
        const double angle = 0.1 * i * DEGREE;
        interface_reflectances seen;
        code = interface_measure(t.p, &t.tree, start_y, angle, &seen, why);
        const reflectance_bound off = bound_reflectances(angle, 0.0, n[at->from], n[at->to]);
        worst_pair_add(&worst[0], seen.R_s, theory_fresnel_s(angle, n[at->from], n[at->to]), off.R_s);
        worst_pair_add(&worst[1], seen.R_p, theory_fresnel_p(angle, n[at->from], n[at->to]), off.R_p);
        worst_pair_add(&worst[2], seen.R, theory_fresnel(angle, n[at->from], n[at->to]), off.R);
    }
    trial_end(&t);
    return code;
}

static status add_fresnel(const metrics *m, int which, diagnostic *why)
{
    const crossing *at = &crossings[which];
    const bool exists = has_media(m, at);
    worst_pair worst[3] = {WORST_NONE, WORST_NONE, WORST_NONE};
    const status code = exists ? compare_reflectances(m, at, worst, why) : STATUS_OK;
    const char *const none = exists ? NULL : "there is no liquid";
    metrics_add(m, (realism_value){at->s, none ? none : "reflectance, s-polarised; largest error for 0 to 89.9 degrees",
                                   "", worst[0].measured, worst[0].theory, worst[0].tolerance});
    metrics_add(m, (realism_value){at->p, none ? none : "reflectance, p-polarised", "", worst[1].measured,
                                   worst[1].theory, worst[1].tolerance});
    metrics_add(m, (realism_value){at->mean, none ? none : "reflectance, unpolarised", "", worst[2].measured,
                                   worst[2].theory, worst[2].tolerance});
    return code;
}

status realism_interfaces(const metrics *m, diagnostic *why)
{
    for (int i = 0; i < 3; i++)
        TRY(add_critical(m, i, why));
    for (int i = 0; i < 3; i++)
        TRY(add_fresnel(m, i, why));
    return STATUS_OK;
}

/* --- slabs --- */

/* Convergence with depth: a slab of the vessel's medium in front of a surface that emits radiance 1. A ray at 40
 * degrees sees (1 - R)^2 (1 + R^2 + R^4 + ...), and a recursion depth truncates that series: the first term needs depth
 * 2, each further one two more. For unpolarised light this is the series of the mean R if each interface uses the mean,
 * and the mean of the two series if rays carry their polarisation, which is physically correct.
 *
 * Tolerance: half a unit of the film for each term, the rounding of its factors, and the bound of R times the largest
 * derivative of the series by R, 2, at both faces. */

#define SLAB_ANGLE (40.0 * M_PI / 180.0)
enum { DEPTH_MAX = 12 };

static scene *slab_scene(const scene *s, const setup *at, int depth, bool polarised)
{
    scene *copy = arrange_shining(s, at, box_at(vec3_make(0.0, 0.0, 0.0), vec3_make(10.0, 0.1, 10.0)), -1.0);
    if (!copy)
        return NULL;
    copy->render.depth = depth;
    copy->render.polarisation = polarised;
    return copy;
}

status slab_measure(const metrics *m, int depth, bool polarised, double *transmitted, diagnostic *why)
{
    trial t;
    status code = trial_start(&t, slab_scene(m->traced, &m->at, depth, polarised), m->level, why);
    if (code == STATUS_OK)
        code =
            probe_ray(t.p, vec3_make(0.0, 1.0, 0.0), vec3_make(sin(SLAB_ANGLE), -cos(SLAB_ANGLE), 0.0), &t.tree, why);
    if (code == STATUS_OK)
        *transmitted = t.tree.radiance[0];
    trial_end(&t);
    return code;
}

double slab_theory(const metrics *m, int depth, bool polarised)
{
    const double n_from = m->theory_at.n[SETUP_OUTSIDE], n_to = m->theory_at.n[SETUP_VESSEL];
    if (n_from == n_to)
        return 1.0; /* without an interface no depth is needed */
    const double R_s = theory_fresnel_s(SLAB_ANGLE, n_from, n_to), R_p = theory_fresnel_p(SLAB_ANGLE, n_from, n_to);
    return polarised ? (theory_slab(R_s, depth / 2) + theory_slab(R_p, depth / 2)) / 2.0
                     : theory_slab((R_s + R_p) / 2.0, depth / 2);
}

static double tolerance_at(const metrics *m, int depth)
{
    const double n_from = m->theory_at.n[SETUP_OUTSIDE], n_to = m->theory_at.n[SETUP_VESSEL];
    const reflectance_bound off = bound_reflectances(SLAB_ANGLE, bound_difference(BOUND_TURN), n_from, n_to);
    return (depth / 2 + 1) * BOUND_FILM + bound_difference(BOUND_FORM * (depth + 1)) +
           2.0 * 2.0 * fmax(off.R, fmax(off.R_s, off.R_p));
}

status realism_slab(const metrics *m, diagnostic *why)
{
    static const char *const names[] = {"slab.depth", "slab.depth_polarised"};
    static const char *const what[] = {
        "radiance behind a slab at 40 degrees; largest error for depths 0 to 12",
        "radiance behind a slab at 40 degrees with render.polarisation=on; largest error for depths 0 to 12"};
    status code = STATUS_OK;
    for (int polarised = 0; polarised < 2 && code == STATUS_OK; polarised++) {
        const bool exists = !polarised || !scene_has_constant_weights(&m->traced->render);
        worst_pair worst = WORST_NONE;
        for (int depth = 0; depth <= DEPTH_MAX && code == STATUS_OK && exists; depth++) {
            double measured = NAN;
            code = slab_measure(m, depth, polarised, &measured, why);
            worst_pair_add(&worst, measured, slab_theory(m, depth, polarised), tolerance_at(m, depth));
        }
        metrics_add(m, (realism_value){names[polarised],
                                       exists ? what[polarised] : "constant weights have no polarisation", "",
                                       worst.measured, worst.theory, worst.tolerance});
    }
    return code;
}

/* --- gaps --- */

/* An empty gap between the vessel's medium and an opaque surface of radiance 1, seen from within the medium: the
 * radiance is 1 - R below the critical angle and 0 above it, however narrow the gap (in contact it would be 1). A
 * distant solid that no ray hits changes nothing.
 *
 * Depth 1, so that nothing returns from the medium's other face. Tolerance: half a unit of the film, and the bound of R
 * at that angle. */

static const double narrow = 1e-7, wide = 1e-3; /* scene units */

static scene *gap_scene(const scene *s, const setup *at, double gap, bool far_solid)
{
    scene *copy = arrange_shining(s, at, box_at(vec3_make(0.0, 0.5, 0.0), vec3_make(100.0, 1.0, 100.0)), -gap);
    if (!copy)
        return NULL;
    copy->solids[at->vessel].priority = 2, copy->solids[at->rod].priority = 0;
    if (far_solid) {
        solid *far = &copy->solids[at->liquid];
        far->visible = 1;
        far->priority = 9;
        far->shape = ball_at(vec3_make(0.0, 1e5, 0.0), 1.0);
    }
    copy->render.depth = 1;
    return copy;
}

/* With basic radiance the camera, inside the vessel's medium, also sees a factor of the square of the index. */
static double gap_theory(const metrics *m, double angle, double *tolerance)
{
    const double n_from = m->theory_at.n[SETUP_VESSEL], n_to = m->theory_at.n[SETUP_OUTSIDE], ratio = n_from / n_to;
    const double gain = scene_has_basic_radiance(&m->supposed->render) ? ratio * ratio : 1.0,
                 off = bound_reflectances(angle, 0.0, n_from, n_to).R;
    *tolerance = BOUND_FILM + gain * (off + bound_difference(BOUND_FORM));
    return gain * (n_from == n_to ? 1.0 : 1.0 - theory_fresnel(angle, n_from, n_to));
}

static status measure_gap(const metrics *m, double gap, bool far_solid, worst_pair *worst, diagnostic *why)
{
    trial t;
    status code = trial_start(&t, gap_scene(m->traced, &m->at, gap, far_solid), m->level, why);
    for (int degrees = 0; degrees <= 85 && code == STATUS_OK; degrees += 5) {
        const double angle = degrees * M_PI / 180.0;
        code = probe_ray(t.p, vec3_make(0.0, 0.5, 0.0), vec3_make(sin(angle), -cos(angle), 0.0), &t.tree, why);
        double tolerance;
        const double theory = gap_theory(m, angle, &tolerance);
        worst_pair_add(worst, code == STATUS_OK ? t.tree.radiance[0] : NAN, theory, tolerance);
    }
    trial_end(&t);
    return code;
}

status realism_gap(const metrics *m, diagnostic *why)
{
    static const char *const names[] = {"gap.empty", "gap.far_solid"};
    static const char *const what[] = {
        "radiance through an empty gap of 1e-7; largest error for 0 to 85 degrees",
        "radiance through a gap of 0.001, with a solid at distance 100000 that no ray hits"};
    const bool fresnel =
        !scene_has_constant_weights(&m->traced->render) && m->traced->render.transmission == TRANSMISSION_REFRACT;
    status code = STATUS_OK;
    for (int far_solid = 0; far_solid < 2 && code == STATUS_OK; far_solid++) {
        const bool third = !far_solid || m->at.liquid >= 0;
        worst_pair worst = WORST_NONE;
        if (fresnel && third)
            code = measure_gap(m, far_solid ? wide : narrow, far_solid, &worst, why);
        const char *line = !fresnel ? "constant weights have no critical angle"
                           : !third ? "there is no liquid to place far away"
                                    : what[far_solid];
        metrics_add(m, (realism_value){names[far_solid], line, "", worst.measured, worst.theory, worst.tolerance});
    }
    return code;
}
