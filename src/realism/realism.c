/* The lists of metrics and of curves; the curves of the vessel. */
#include "realism/realism.h"

#include "realism/metrics.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include <math.h>
#include <string.h>

double realism_error(const realism_value *v)
{
    return fabs(v->measured - v->theory);
}

bool realism_is_defined(const realism_value *v)
{
    return !isnan(v->theory);
}

bool realism_passes(const realism_value *v)
{
    return realism_error(v) <= v->tolerance;
}

status realism_measure(const scene *s, isa level, realism_report *out, diagnostic *why)
{
    return realism_measure_against(s, s, level, out, why);
}

/* Scenes other than the vessel, identified by the names of their solids. */
static const struct scene_kind {
    bool (*is_there)(const scene *s);
    status (*measure)(const metrics *m, diagnostic *why);
} scene_kinds[] = {{prism_is_there, realism_prism}, {drop_is_there, realism_drop}, {stack_is_there, realism_stack}};

status realism_check(const scene *s, bool curves, diagnostic *why)
{
    setup unused;
    for (size_t i = 0; i < sizeof scene_kinds / sizeof scene_kinds[0] && !curves; i++)
        if (scene_kinds[i].is_there(s))
            return STATUS_OK;
    return setup_read(s, &unused, why);
}

typedef status measure_call(const metrics *m, diagnostic *why);
static measure_call *const vessel_metrics[] = {realism_edges,      realism_water_line, realism_lens, realism_interfaces,
                                               realism_balance,    realism_slab,       realism_gap,  realism_radiance,
                                               realism_absorption, realism_reversal};

static const realism_value *find_value(const realism_report *r, const char *metric)
{
    for (int i = 0; i < r->count; i++)
        if (strcmp(r->value[i].metric, metric) == 0)
            return &r->value[i];
    return NULL;
}

/* Measures all metrics, or, if metric is given, only the groups up to the one that has it. */
static status measure_until(const scene *traced, const scene *supposed, isa level, const char *metric,
                            realism_report *out, diagnostic *why)
{
    metrics m = {.traced = traced, .supposed = supposed, .level = level, .report = out};
    out->count = 0;
    for (size_t i = 0; i < sizeof scene_kinds / sizeof scene_kinds[0]; i++)
        if (scene_kinds[i].is_there(traced) && scene_kinds[i].is_there(supposed))
            return scene_kinds[i].measure(&m, why);
    TRY(setup_read(traced, &m.at, why));
    TRY(setup_read(supposed, &m.theory_at, why));
    for (size_t i = 0; i < sizeof vessel_metrics / sizeof vessel_metrics[0] && !(metric && find_value(out, metric));
         i++)
        TRY(vessel_metrics[i](&m, why));
    return STATUS_OK;
}

status realism_measure_against(const scene *traced, const scene *supposed, isa level, realism_report *out,
                               diagnostic *why)
{
    return measure_until(traced, supposed, level, NULL, out, why);
}

status realism_measure_one(const scene *s, isa level, const char *metric, realism_value *out, diagnostic *why)
{
    realism_report report;
    TRY(measure_until(s, s, level, metric, &report, why));
    const realism_value *found = find_value(&report, metric);
    if (!found)
        return diagnose(why, STATUS_BAD_INPUT, "list the metrics with 'cuvette realism SCENE'",
                        "the scene has no metric '%.64s'", metric);
    *out = *found;
    return STATUS_OK;
}

/* --- curves --- */

typedef struct curve_labels {
    const char *name, *x, *y;
} curve_labels;
static const curve_labels labels[REALISM_CURVE_COUNT] = {
    [REALISM_CURVE_FRESNEL_S] = {"fresnel-s", "angle of incidence, deg", "reflectance, s-polarised"},
    [REALISM_CURVE_FRESNEL_P] = {"fresnel-p", "angle of incidence, deg", "reflectance, p-polarised"},
    [REALISM_CURVE_FRESNEL] = {"fresnel", "angle of incidence, deg", "reflectance of unpolarised light"},
    [REALISM_CURVE_DEVIATION] = {"deviation", "offset from the axis, scene units", "deviation, deg"},
    [REALISM_CURVE_DEPTH] = {"depth", "recursion depth", "transmittance of a slab at 40 deg"},
    [REALISM_CURVE_ABSORPTION] = {"absorption", "length, m", "transmittance of the liquid, red"},
    [REALISM_CURVE_EDGES] = {"edges", "index of the liquid", "displacement of the rod's left edge, px"},
    [REALISM_CURVE_MIRROR] = {"mirror", "angle of incidence, deg", "reflectance of the liquid's surface from below"},
    [REALISM_CURVE_APPARENT_DEPTH] = {"apparent-depth", "line of sight from the vertical, deg",
                                      "apparent depth over depth"},
    [REALISM_CURVE_PRISM] = {"prism", "angle of incidence, deg", "deviation, deg"},
    [REALISM_CURVE_RAINBOW] = {"rainbow", "offset over the drop's radius", "angle from the antisolar point, deg"},
    [REALISM_CURVE_PLATES] = {"plates", "angle of incidence, deg", "transmittance of two plates"},
    [REALISM_CURVE_MALUS] = {"malus", "angle of the analyser, deg", "transmittance of the polarisers"},
    [REALISM_CURVE_COIN] = {"coin", "index of the liquid", "least depth of the liquid, scene units"},
    [REALISM_CURVE_ARROW] = {"arrow", "distance of the arrow from the axis, scene units",
                             "position through the glass over position without it"},
    [REALISM_CURVE_SOAP] = {"soap", "thickness of the film, nm", "reflectance"},
};

const char *realism_curve_name(realism_curve which)
{
    return labels[which].name;
}

const char *realism_curve_x(realism_curve which)
{
    return labels[which].x;
}

const char *realism_curve_y(realism_curve which)
{
    return labels[which].y;
}

const char *realism_curve_parameter(realism_curve which)
{
    if (which == REALISM_CURVE_EDGES || which == REALISM_CURVE_COIN)
        return "liquid.ior";
    return which == REALISM_CURVE_DEPTH ? "render.depth" : NULL;
}

enum reflected { REFLECTED_S, REFLECTED_P, REFLECTED_BOTH };

/* Reflectances of one component or of unpolarised light, by the angle of incidence. */
static status reflectance_points(const metrics *m, setup_medium from, setup_medium to, enum reflected part,
                                 realism_points *out, diagnostic *why)
{
    static double (*const theory[])(double, double, double) = {theory_fresnel_s, theory_fresnel_p, theory_fresnel};
    double start_y = 0.0;
    trial t;
    scene *s = arrange_interface(m->traced, &m->at, from, to, &start_y);
    status code = trial_start(&t, s, m->level, why);
    for (int i = 0; i < 180 && code == STATUS_OK; i++) {
        const double angle = 0.5 * i * DEGREE;
        interface_reflectances seen;
        code = interface_measure(t.p, &t.tree, start_y, angle, &seen, why);
        const double measured[] = {seen.R_s, seen.R_p, seen.R};
        curve_add(out, 0.5 * i, measured[part], theory[part](angle, m->at.n[from], m->at.n[to]));
    }
    trial_end(&t);
    return code;
}

static status deviation_points(const metrics *m, realism_points *out, diagnostic *why)
{
    const theory_shells c = setup_shells(&m->theory_at);
    const double reach = 0.98 * theory_shells_reach(&c);
    trial t;
    status code = trial_start(&t, arrange_vessel(m->traced, &m->at), m->level, why);
    for (int i = 0; i <= 200 && code == STATUS_OK; i++) {
        const double offset = reach * i / 200.0;
        double measured = NAN;
        code = lens_deviation(t.p, &t.tree, &m->at, offset, &measured, why);
        curve_add(out, offset, measured / DEGREE, theory_shells_deviation(&c, offset) / DEGREE);
    }
    trial_end(&t);
    return code;
}

static status depth_points(const metrics *m, realism_points *out, diagnostic *why)
{
    status code = STATUS_OK;
    for (int depth = 0; depth <= 16 && code == STATUS_OK; depth++) {
        double measured = NAN;
        code = slab_measure(m, depth, false, &measured, why);
        curve_add(out, depth, measured, slab_theory(m, depth, false));
    }
    return code;
}

static status absorption_points(const metrics *m, realism_points *out, diagnostic *why)
{
    trial t;
    status code = trial_start(&t, attenuation_scene(m->traced, &m->at), m->level, why);
    if (code == STATUS_OK) {
        const double a = material_absorption(&t.s->solids[m->at.liquid].surface).x,
                     reach = attenuation_reach(&t, &m->at);
        for (int i = 1; i <= 100 && code == STATUS_OK; i++) {
            const double length = reach * i / 100.0, length_m = length * t.s->render.unit_m;
            double transmittances[3] = {NAN, NAN, NAN};
            code = attenuation_point(&t, &m->at, length, transmittances, why);
            curve_add(out, length_m, transmittances[0], exp(-a * length_m));
        }
    }
    trial_end(&t);
    return code;
}

static status edges_points(const metrics *m, realism_points *out, diagnostic *why)
{
    scene *s = scene_clone(m->traced);
    status code = s ? STATUS_OK : out_of_memory(why);
    metrics turned = *m;
    turned.traced = turned.supposed = s;
    for (int i = 0; i <= 60 && code == STATUS_OK; i++) {
        material *liquid = &s->solids[m->at.liquid].surface;
        double measured[2], theory[2];
        liquid->medium = MEDIUM_IOR;
        liquid->ior = 1.0 + 0.01 * i;
        turned.at.n[SETUP_LIQUID] = turned.theory_at.n[SETUP_LIQUID] = liquid->ior;
        code = edges_displacement(&turned, measured, theory, why);
        curve_add(out, liquid->ior, measured[0], theory[0]);
    }
    scene_destroy(s);
    return code;
}

/* Tangent of the angle from the vertical. */
static double slope_of(vec3 direction)
{
    return hypot(direction.x, direction.z) / fabs(direction.y);
}

/* The line of sight, extended below the surface, passes above the point: the ratio of the depths is the ratio of the
 * tangents. Straight down this is 0 / 0, so the first angle is small but not 0. */
static status apparent_depth_points(const metrics *m, realism_points *out, diagnostic *why)
{
    const double *n = m->at.n;
    double start_y = 0.0;
    trial t;
    scene *s = arrange_interface(m->traced, &m->at, SETUP_OUTSIDE, SETUP_LIQUID, &start_y);
    status code = trial_start(&t, s, m->level, why);
    for (int i = 0; i <= 85 && code == STATUS_OK; i++) {
        const double angle = (i ? i : 0.01) * DEGREE;
        const vec3 down = vec3_make(sin(angle), start_y > 0.0 ? -cos(angle) : cos(angle), 0.0);
        code = probe_path(t.p, vec3_make(0.0, start_y, 0.0), down, -1, &t.tree, why);
        const bool enters = code == STATUS_OK && t.tree.count > 1 && t.tree.node[1].kind == RAY_REFRACT;
        const double below = enters ? slope_of(t.tree.node[1].direction) : slope_of(down);
        curve_add(out, angle / DEGREE, below / slope_of(down),
                  theory_apparent_depth(angle, n[SETUP_OUTSIDE], n[SETUP_LIQUID]));
    }
    trial_end(&t);
    return code;
}

/* Curves of scenes other than the vessel. */
static const struct other_curve {
    realism_curve which;
    bool (*is_there)(const scene *s);
    status (*measure)(const metrics *m, realism_points *out, diagnostic *why);
    const char *lacks, *remedy;
} others[] = {
    {REALISM_CURVE_PRISM, prism_is_there, prism_curve, "no solids 'prism', 'left' and 'right'",
     "use the names and shapes of experiments/scenes/prism.yaml"},
    {REALISM_CURVE_RAINBOW, drop_is_there, drop_curve, "no sphere whose name begins with 'drop', and no rain",
     "set background.kind=rain, or use the names and shapes of experiments/scenes/rainbow.yaml"},
    {REALISM_CURVE_PLATES, stack_is_there, stack_curve, "no solids 'plate1' and 'plate2'",
     "use the names and shapes of experiments/scenes/plates.yaml"},
    {REALISM_CURVE_MALUS, filters_are_there, filters_curve, "no solids 'polariser' and 'analyser'",
     "use the names and shapes of experiments/scenes/malus.yaml"},
    {REALISM_CURVE_COIN, coin_is_there, coin_curve, "no cup 'cup', cylinder 'coin' and 'liquid'",
     "use the names and shapes of experiments/scenes/coin.yaml"},
    {REALISM_CURVE_ARROW, arrow_is_there, arrow_curve, "no solids 'vessel', 'liquid' and 'arrow'",
     "use the names and shapes of experiments/scenes/arrow.yaml"},
    {REALISM_CURVE_SOAP, soap_is_there, soap_curve, "no box 'film1' with a film",
     "use the names and shapes of experiments/scenes/soap.yaml"},
};

/* The row of a curve; NULL for the curves of the vessel. */
static const struct other_curve *other_of(realism_curve which)
{
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (others[i].which == which)
            return &others[i];
    return NULL;
}

/* The solids of a curve; at is filled for the curves of the vessel. */
static status find_solids(const scene *s, realism_curve which, setup *at, diagnostic *why)
{
    const struct other_curve *o = other_of(which);
    if (o && !o->is_there(s))
        return diagnose_at(why, s->path, STATUS_BAD_INPUT, o->remedy, "the scene has %s", o->lacks);
    if (o)
        return STATUS_OK;
    TRY(setup_read(s, at, why));
    const bool of_liquid = which == REALISM_CURVE_ABSORPTION || which == REALISM_CURVE_EDGES ||
                           which == REALISM_CURVE_MIRROR || which == REALISM_CURVE_APPARENT_DEPTH;
    if (of_liquid && at->liquid < 0)
        return diagnose(why, STATUS_BAD_INPUT, "add a cylinder named 'liquid'", "the curve '%s' requires a liquid",
                        labels[which].name);
    return STATUS_OK;
}

status realism_check_curve(const scene *s, realism_curve which, diagnostic *why)
{
    setup unused;
    return find_solids(s, which, &unused, why);
}

status realism_measure_curve(const scene *s, isa level, realism_curve which, realism_points *out, diagnostic *why)
{
    metrics m = {.traced = s, .supposed = s, .level = level};
    out->count = 0;
    TRY(find_solids(s, which, &m.at, why));
    m.theory_at = m.at;
    if (other_of(which))
        return other_of(which)->measure(&m, out, why);
    switch (which) {
    case REALISM_CURVE_FRESNEL_S:
    case REALISM_CURVE_FRESNEL_P:
    case REALISM_CURVE_FRESNEL:
        return reflectance_points(&m, SETUP_OUTSIDE, SETUP_VESSEL,
                                  (enum reflected)((int)which - (int)REALISM_CURVE_FRESNEL_S), out, why);
    case REALISM_CURVE_DEVIATION: return deviation_points(&m, out, why);
    case REALISM_CURVE_DEPTH: return depth_points(&m, out, why);
    case REALISM_CURVE_ABSORPTION: return absorption_points(&m, out, why);
    case REALISM_CURVE_EDGES: return edges_points(&m, out, why);
    case REALISM_CURVE_MIRROR: return reflectance_points(&m, SETUP_LIQUID, SETUP_OUTSIDE, REFLECTED_BOTH, out, why);
    case REALISM_CURVE_APPARENT_DEPTH: return apparent_depth_points(&m, out, why);
    case REALISM_CURVE_PRISM:
    case REALISM_CURVE_RAINBOW:
    case REALISM_CURVE_PLATES:
    case REALISM_CURVE_MALUS:
    case REALISM_CURVE_COIN:
    case REALISM_CURVE_ARROW:
    case REALISM_CURVE_SOAP:
    case REALISM_CURVE_COUNT: break;
    }
    return STATUS_OK;
}
