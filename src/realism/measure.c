#include "realism/metrics.h"

#include <math.h>
#include <string.h>

void metrics_add(const metrics *m, realism_value value)
{
    if (m->report->count < REALISM_MAX)
        m->report->value[m->report->count++] = value;
}

void worst_take(worst_pair *w, double measured, double theory, double tolerance)
{
    /* A NaN counts as the worst measurement, whatever follows; where theory is NaN there is nothing to measure. */
    if (isnan(theory) || (w->any && isnan(w->measured)))
        return;
    if (!w->any || !(fabs(measured - theory) * w->tolerance <= fabs(w->measured - w->theory) * tolerance))
        *w = (worst_pair){measured, theory, tolerance, true};
}

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
static const struct arrangement_kind {
    bool (*is_there)(const scene *s);
    status (*measure)(const metrics *m, diagnostic *why);
} scene_geometries[] = {
    {prism_is_there, realism_prism}, {drop_is_there, realism_drop}, {stack_is_there, realism_stack}};

status realism_check(const scene *s, bool curves, diagnostic *why)
{
    setup unused;
    for (size_t i = 0; i < sizeof scene_geometries / sizeof scene_geometries[0] && !curves; i++)
        if (scene_geometries[i].is_there(s))
            return STATUS_OK;
    return setup_read(s, &unused, why);
}

typedef status measure_call(const metrics *m, diagnostic *why);
static measure_call *const of_vessel[] = {realism_edges,      realism_water_line, realism_lens, realism_interfaces,
                                          realism_balance,    realism_slab,       realism_gap,  realism_radiance,
                                          realism_absorption, realism_reversal};

static const realism_value *find_value(const realism_report *r, const char *metric)
{
    for (int i = 0; i < r->count; i++)
        if (strcmp(r->value[i].metric, metric) == 0)
            return &r->value[i];
    return NULL;
}

/* All metrics, or the groups up to that of metric. */
static status measure_until(const scene *traced, const scene *supposed, isa level, const char *metric,
                            realism_report *out, diagnostic *why)
{
    metrics m = {.traced = traced, .supposed = supposed, .level = level, .report = out};
    out->count = 0;
    for (size_t i = 0; i < sizeof scene_geometries / sizeof scene_geometries[0]; i++)
        if (scene_geometries[i].is_there(traced) && scene_geometries[i].is_there(supposed))
            return scene_geometries[i].measure(&m, why);
    TRY(setup_read(traced, &m.at, why));
    TRY(setup_read(supposed, &m.theory_at, why));
    for (size_t i = 0; i < sizeof of_vessel / sizeof of_vessel[0] && !(metric && find_value(out, metric)); i++)
        TRY(of_vessel[i](&m, why));
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
        return diagnose(why, STATUS_BAD_INPUT, "'cuvette realism SCENE' lists the metrics",
                        "the scene has no metric '%.64s'", metric);
    *out = *found;
    return STATUS_OK;
}
