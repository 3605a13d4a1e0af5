/* What the best point is worth: sensitivities, intervals of the parameters, tolerances.
 *
 * With targets, the covariance of the parameters is (J^T W J)^-1, J the derivatives of the targets and W their weights
 * (Bates and Watts, Nonlinear Regression Analysis, 1988, 2.2): linear in the parameters, so its interval is good where
 * the targets are nearly linear within it. With standard deviations of all targets it is absolute, and the interval
 * that of the normal distribution; with weights it is scaled by the residuals, and Student's t.
 *
 * The profile of a parameter is the least merit that the others allow while it has a value. Its 95 % interval is where
 * the profile exceeds the best merit by no more than the quantile of chi-squared with one degree of freedom, if there
 * are standard deviations (Venzon and Moolgavkar, Appl. Stat. 37, 1988), with weights that of F(1, freedom) times the
 * mean square of the residuals (Bates and Watts, 6.1). For linear targets it is the linear interval. */
#include "base/cancel.h"
#include "measure/statistics.h"
#include "study/fit/fit.h"
#include <math.h>
#include <string.h>

static double range_of(const fit *f, size_t i)
{
    return f->parameters[i].to - f->parameters[i].from;
}

/* --- intervals --- */

/* A larger standard error, in ranges of the parameter, is that of derivatives which are only rounding errors. */
#define ERROR_RANGES_MAX 1e3

/* The quantile of the interval, and the factor of the covariance; false if errors are not known. */
static bool error_scale(const fit *f, const fit_result *out, double *quantile, double *factor)
{
    bool absolute = true;
    for (size_t i = 0; i < f->target_count; i++)
        absolute = absolute && f->targets[i].sigma > 0.0;
    *factor = absolute ? 1.0 : out->best.merit / (double)out->freedom;
    *quantile = absolute           ? normal_quantile(0.975)
                : out->freedom > 0 ? student_t_975((size_t)out->freedom)
                                   : (double)NAN;
    return absolute || out->freedom > 0;
}

static void find_intervals(const fit *f, fit_result *out)
{
    fit_matrix a = {{0}};
    double scale[FIT_PARAMETERS_MAX], quantile, factor;
    const size_t n = f->parameter_count;
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < n; k++)
            for (size_t t = 0; t < f->target_count; t++)
                a[i][k] += f->targets[t].weight * out->derivative.by[t][i] * out->derivative.by[t][k];
    for (size_t i = 0; i < n; i++)
        scale[i] = sqrt(a[i][i]);
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < n; k++)
            a[i][k] /= scale[i] * scale[k];
    out->has_interval = error_scale(f, out, &quantile, &factor) && fit_invert(n, a);
    for (size_t i = 0; i < n && out->has_interval; i++)
        out->has_interval = sqrt(factor * a[i][i]) / scale[i] < ERROR_RANGES_MAX * range_of(f, i);
    for (size_t i = 0; i < n; i++) {
        out->error[i] = out->has_interval ? sqrt(factor * a[i][i]) / scale[i] : (double)NAN;
        out->half[i] = quantile * out->error[i];
        for (size_t k = 0; k < n; k++)
            out->correlation[i][k] = out->has_interval ? a[i][k] / sqrt(a[i][i] * a[k][k]) : (double)NAN;
    }
}

/* --- crossings --- */

/* Of a change of a parameter: below 0 where it is within the limit, above where it is beyond. -1 for no change. */
typedef status excess_function(void *context, double change, double *excess, diagnostic *why);

/* The change at which the excess is 0, to within `near` of it or 1e-6 of the change: steps from `first` that double
 * until it is beyond, then regula falsi with halved ends (Dowell and Jarratt, BIT 11, 1971). NaN if `room` is first. */
static status find_crossing(excess_function *excess, void *context, double first, double room, double near, double *out,
                            diagnostic *why)
{
    double low = 0.0, high = fmin(first, room), at_low = -1.0, at_high = 0.0;
    *out = NAN;
    for (;;) {
        if (!(high > 0.0))
            return STATUS_OK;
        TRY(excess(context, high, &at_high, why));
        if (at_high >= 0.0)
            break;
        if (high >= room)
            return STATUS_OK;
        low = high, at_low = at_high;
        high = fmin(2.0 * high, room);
    }
    int kept = 0; /* the end that stayed: -1 low, 1 high */
    for (int step = 0; step < 60 && high - low > 1e-6 * high; step++) {
        double middle = low + (high - low) * at_low / (at_low - at_high), at;
        if (!(middle > low && middle < high))
            middle = 0.5 * (low + high);
        TRY(excess(context, middle, &at, why));
        if (fabs(at) <= near) {
            low = high = middle;
        } else if (at > 0.0) {
            high = middle, at_high = at;
            at_low *= kept == -1 ? 0.5 : 1.0;
            kept = -1;
        } else {
            low = middle, at_low = at;
            at_high *= kept == 1 ? 0.5 : 1.0;
            kept = 1;
        }
    }
    *out = 0.5 * (low + high);
    return STATUS_OK;
}

/* One parameter in one direction. */
typedef struct excursion {
    fit_run *r;
    fit_result *out;
    size_t i;
    int side;
    double rise;                     /* of the merit at the limit */
    double path[FIT_PARAMETERS_MAX]; /* of the others, by the change of this one: where the next refit starts */
    size_t spent_at;                 /* evaluations of the run at which profiles end */
    bool spent;
} excursion;

static double room_of(const excursion *e)
{
    const fit_parameter *p = &fit_run_of(e->r)->parameters[e->i];
    return fabs((e->side ? p->to : p->from) - e->out->best.x[e->i]);
}

/* Exactly the bound, where the change reaches it. */
static double moved_to(const excursion *e, double change)
{
    const fit_parameter *p = &fit_run_of(e->r)->parameters[e->i];
    if (change >= room_of(e))
        return e->side ? p->to : p->from;
    return e->out->best.x[e->i] + (e->side ? change : -change);
}

/* --- profiles --- */

/* What a refit need not gain any more, as a fraction of the rise: the interval changes by half of it. */
#define REFIT_ENOUGH 1e-6

/* The least merit with the parameter there, from where the path leads, or else from the best values of the others.
 * *out: its merit is NaN if nothing can be measured. */
static status refit(const excursion *e, double change, fit_evaluation *out, diagnostic *why)
{
    const fit *f = fit_run_of(e->r);
    const char *ended;
    for (int attempt = 0; attempt < 2; attempt++) {
        const fit_evaluation *start = NULL;
        double x[FIT_PARAMETERS_MAX];
        for (size_t k = 0; k < f->parameter_count; k++) {
            const double to = e->out->best.x[k] + (attempt == 0 ? change * e->path[k] : 0.0);
            x[k] = k == e->i ? moved_to(e, change) : fmin(fmax(to, f->parameters[k].from), f->parameters[k].to);
        }
        TRY(fit_evaluate(e->r, "profile", x, &start, NULL, why));
        *out = *start;
        if (!isnan(out->merit))
            break;
    }
    if (f->parameter_count == 1 || isnan(out->merit))
        return STATUS_OK;
    return fit_damped(e->r, "profile", e->i, REFIT_ENOUGH * e->rise, out, &ended, why);
}

/* By how much the root of the profile's rise exceeds that at the limit, as a fraction: nearly linear in the change. */
static status exceed_profile(void *context, double change, double *excess, diagnostic *why)
{
    excursion *e = context;
    fit_result *out = e->out;
    fit_evaluation at;
    *excess = 0.0; /* which ends the search for the crossing */
    if (e->spent || (e->spent = fit_run_evaluations(e->r) >= e->spent_at))
        return STATUS_OK;
    TRY(cancel_check(why));
    TRY(refit(e, change, &at, why));
    for (size_t k = 0; k < fit_run_of(e->r)->parameter_count && !isnan(at.merit); k++)
        e->path[k] = (at.x[k] - out->best.x[k]) / change;
    const double rise = at.merit - out->best.merit;
    if (rise < -1e-3 * e->rise && !(out->has_better && out->better.merit <= at.merit))
        out->better = at, out->has_better = true;
    *excess = isnan(rise) ? 1.0 : sqrt(fmax(rise, 0.0) / e->rise) - 1.0;
    return STATUS_OK;
}

static status find_profile(fit_run *r, fit_result *out, size_t i, double rise, size_t spent_at, diagnostic *why)
{
    const fit *f = fit_run_of(r);
    excursion e = {.r = r, .out = out, .i = i, .rise = rise, .spent_at = spent_at};
    for (e.side = 0; e.side < 2; e.side++) {
        const double first = out->has_interval ? out->half[i] : 0.01 * range_of(f, i);
        double change;
        for (size_t k = 0; k < f->parameter_count; k++)
            e.path[k] = !out->has_interval
                            ? 0.0
                            : (e.side ? 1.0 : -1.0) * out->correlation[i][k] * out->error[k] / out->error[i];
        TRY(find_crossing(exceed_profile, &e, first, room_of(&e), 1e-6, &change, why));
        out->open[i][e.side] = isnan(change);
        out->profile[i][e.side] = moved_to(&e, isnan(change) ? room_of(&e) : change);
    }
    out->has_profile[i] = !e.spent;
    out->profile_lacking += e.spent;
    return STATUS_OK;
}

static status find_profiles(fit_run *r, fit_result *out, diagnostic *why)
{
    const fit *f = fit_run_of(r);
    const size_t spent_at = fit_run_evaluations(r) + (size_t)f->evaluations;
    double quantile, factor;
    if (f->goal != FIT_TARGETS || f->linear || !error_scale(f, out, &quantile, &factor))
        return STATUS_OK;
    const double rise = quantile * quantile * factor;
    for (size_t i = 0; i < f->parameter_count && rise > 0.0; i++)
        TRY(find_profile(r, out, i, rise, spent_at, why));
    return STATUS_OK;
}

/* --- tolerances --- */

/* By default the worsening is 1 with standard deviations: one standard error of a parameter, while the others stay. */
static double worsening_of(const fit *f, const fit_result *out)
{
    double quantile, factor;
    if (f->worsening > 0.0)
        return f->worsening;
    if (f->goal != FIT_TARGETS)
        return 0.1 * fabs(out->best.merit);
    return f->targets[0].sigma > 0.0 && error_scale(f, out, &quantile, &factor) && factor == 1.0 ? 1.0 : 0.0;
}

/* By how much the merit at the change exceeds the limit; what cannot be measured exceeds it. */
static status exceed_worsening(void *context, double change, double *excess, diagnostic *why)
{
    const excursion *c = context;
    const fit_evaluation *e = NULL;
    double x[FIT_PARAMETERS_MAX];
    memcpy(x, c->out->best.x, sizeof x);
    x[c->i] = moved_to(c, change);
    TRY(fit_evaluate(c->r, "tolerance", x, &e, NULL, why));
    *excess = isnan(e->merit) ? 1.0 : (e->merit - c->out->best.merit) / c->rise - 1.0;
    return STATUS_OK;
}

static status find_tolerance(fit_run *r, fit_result *out, size_t i, int side, diagnostic *why)
{
    const fit *f = fit_run_of(r);
    excursion e = {.r = r, .out = out, .i = i, .side = side, .rise = out->worsening};
    double change;
    TRY(find_crossing(exceed_worsening, &e, f->step * range_of(f, i), room_of(&e), 1e-9, &change, why));
    out->tolerance[i][side] = side ? change : -change;
    return STATUS_OK;
}

status fit_spread(fit_run *r, fit_result *out, diagnostic *why)
{
    const fit *f = fit_run_of(r);
    out->freedom = (long)f->target_count - (long)f->parameter_count;
    out->has_interval = false;
    TRY(fit_jacobian(r, "derivative", FIT_NONE_HELD, out->best.x, &out->derivative, why));
    if (f->goal == FIT_TARGETS)
        find_intervals(f, out);
    TRY(find_profiles(r, out, why));
    out->worsening = worsening_of(f, out);
    for (size_t i = 0; i < f->parameter_count; i++)
        for (int side = 0; side < 2; side++) {
            out->tolerance[i][side] = NAN;
            if (out->worsening > 0.0)
                TRY(find_tolerance(r, out, i, side, why));
        }
    return STATUS_OK;
}
