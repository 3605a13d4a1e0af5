/* What the best point is worth: sensitivities, intervals of the parameters, tolerances.
 *
 * With targets, the covariance of the parameters is (J^T W J)^-1, J the derivatives of the targets and W their weights
 * (Bates and Watts, Nonlinear Regression Analysis, 2.2): linear in the parameters, so its interval is good where the
 * targets are nearly linear within it. With standard deviations of all targets it is absolute, and the interval that of
 * the normal distribution; with weights it is scaled by the residuals, and Student's t. */
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
static status exceed(fit_run *r, const fit_result *out, size_t i, double change, double *excess, diagnostic *why)
{
    const fit_evaluation *e = NULL;
    double x[FIT_PARAMETERS_MAX];
    memcpy(x, out->best.x, sizeof x);
    x[i] += change;
    TRY(fit_evaluate(r, "tolerance", x, &e, NULL, why));
    *excess = isnan(e->merit) ? out->worsening : e->merit - out->best.merit - out->worsening;
    return STATUS_OK;
}

/* The change, in one direction, at which the merit is worse by out->worsening: steps that double until it is exceeded,
 * then regula falsi with halved ends (Dowell and Jarratt, BIT 11, 1971). NaN if the bound comes first. */
static status find_tolerance(fit_run *r, fit_result *out, size_t i, int side, diagnostic *why)
{
    const fit *f = fit_run_of(r);
    const double sign = side ? 1.0 : -1.0,
                 room = fabs((side ? f->parameters[i].to : f->parameters[i].from) - out->best.x[i]);
    double low = 0.0, high = fmin(f->step * range_of(f, i), room), at_low = -out->worsening, at_high = 0.0;
    out->tolerance[i][side] = NAN;
    for (;;) {
        if (!(high > 0.0))
            return STATUS_OK;
        TRY(exceed(r, out, i, sign * high, &at_high, why));
        if (at_high >= 0.0)
            break;
        if (high >= room)
            return STATUS_OK;
        low = high, at_low = at_high;
        high = fmin(2.0 * high, room);
    }
    int kept = 0; /* the end that stayed: -1 low, 1 high */
    for (int step = 0; step < 60 && high - low > 1e-6 * high; step++) {
        double middle = low + (high - low) * at_low / (at_low - at_high), excess;
        if (!(middle > low && middle < high))
            middle = 0.5 * (low + high);
        TRY(exceed(r, out, i, sign * middle, &excess, why));
        if (fabs(excess) <= 1e-9 * out->worsening) {
            low = high = middle;
        } else if (excess > 0.0) {
            high = middle, at_high = excess;
            at_low *= kept == -1 ? 0.5 : 1.0;
            kept = -1;
        } else {
            low = middle, at_low = excess;
            at_high *= kept == 1 ? 0.5 : 1.0;
            kept = 1;
        }
    }
    out->tolerance[i][side] = sign * 0.5 * (low + high);
    return STATUS_OK;
}

status fit_spread(fit_run *r, fit_result *out, diagnostic *why)
{
    const fit *f = fit_run_of(r);
    out->freedom = (long)f->target_count - (long)f->parameter_count;
    out->has_interval = false;
    TRY(fit_jacobian(r, "derivative", out->best.x, &out->derivative, why));
    if (f->goal == FIT_TARGETS)
        find_intervals(f, out);
    out->worsening = worsening_of(f, out);
    for (size_t i = 0; i < f->parameter_count; i++)
        for (int side = 0; side < 2; side++) {
            out->tolerance[i][side] = NAN;
            if (out->worsening > 0.0)
                TRY(find_tolerance(r, out, i, side, why));
        }
    return STATUS_OK;
}
