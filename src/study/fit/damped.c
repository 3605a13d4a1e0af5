/* Derivatives of the targets by central differences, and damped least squares: the steps of Gauss and Newton, shortened
 * until they improve the merit (Levenberg, Q. Appl. Math. 2, 1944; Marquardt, J. SIAM 11, 1963), the method of lens
 * design (Kidger, Fundamental Optical Design, 2001, chapter 9). Near a minimum each step gains digits where methods
 * without derivatives take hundreds of evaluations, but it needs targets that change smoothly. */
#include "base/cancel.h"
#include "study/fit/fit.h"
#include <math.h>
#include <string.h>

static double range_of(const fit *f, size_t i)
{
    return f->parameters[i].to - f->parameters[i].from;
}

status fit_jacobian(fit_run *r, const char *stage, size_t held, const double *x, fit_derivatives *out, diagnostic *why)
{
    const fit *f = fit_run_of(r);
    for (size_t i = 0; i < f->parameter_count; i++) {
        const fit_evaluation *at[2];
        const double bounds[2] = {f->parameters[i].from, f->parameters[i].to};
        out->at_bound[i] = false;
        for (size_t k = 0; k < f->target_count; k++)
            out->by[k][i] = 0.0;
        if (i == held)
            continue;
        for (int side = 0; side < 2; side++) {
            double moved[FIT_PARAMETERS_MAX];
            const double to = x[i] + (side ? 1.0 : -1.0) * f->step * range_of(f, i);
            memcpy(moved, x, f->parameter_count * sizeof *x);
            moved[i] = fmin(fmax(to, bounds[0]), bounds[1]);
            out->at_bound[i] = out->at_bound[i] || moved[i] == bounds[side];
            TRY(fit_evaluate(r, stage, moved, &at[side], NULL, why));
        }
        TRY(cancel_check(why));
        for (size_t k = 0; k < f->target_count; k++)
            out->by[k][i] = (at[1]->values[k] - at[0]->values[k]) / (at[1]->x[i] - at[0]->x[i]);
    }
    return STATUS_OK;
}

bool fit_invert(size_t n, fit_matrix a)
{
    fit_matrix inverse = {{0}};
    for (size_t i = 0; i < n; i++)
        inverse[i][i] = 1.0;
    for (size_t i = 0; i < n; i++) {
        if (!(a[i][i] > 1e-13))
            return false;
        const double pivot = a[i][i];
        for (size_t k = 0; k < n; k++)
            a[i][k] /= pivot, inverse[i][k] /= pivot;
        for (size_t row = 0; row < n; row++) {
            const double factor = a[row][i];
            for (size_t k = 0; row != i && k < n; k++)
                a[row][k] -= factor * a[i][k], inverse[row][k] -= factor * inverse[i][k];
        }
    }
    memcpy(a, inverse, sizeof inverse);
    return true;
}

/* The normal equations at a point, for parameters as fractions of their ranges: half the gradient of the merit, and
 * J^T W J scaled to a diagonal of 1. */
typedef struct normal_equations {
    fit_matrix a;
    double gradient[FIT_PARAMETERS_MAX], scale[FIT_PARAMETERS_MAX];
    bool free[FIT_PARAMETERS_MAX]; /* not held at a bound, and not without effect */
} normal_equations;

static void set_equations(const fit *f, const fit_evaluation *e, const fit_derivatives *d, normal_equations *out)
{
    *out = (normal_equations){.scale = {0}};
    for (size_t t = 0; t < f->target_count; t++)
        for (size_t i = 0; i < f->parameter_count; i++) {
            const double slope = d->by[t][i] * range_of(f, i), w = f->targets[t].weight;
            out->gradient[i] += w * slope * (e->values[t] - f->targets[t].value);
            for (size_t k = 0; k < f->parameter_count; k++)
                out->a[i][k] += w * slope * d->by[t][k] * range_of(f, k);
        }
    for (size_t i = 0; i < f->parameter_count; i++) {
        const fit_parameter *p = &f->parameters[i];
        const bool held =
            (e->x[i] <= p->from && out->gradient[i] > 0.0) || (e->x[i] >= p->to && out->gradient[i] < 0.0);
        out->scale[i] = sqrt(out->a[i][i]);
        out->free[i] = !held && isfinite(out->scale[i]) && out->scale[i] > 0.0 && isfinite(out->gradient[i]);
    }
    for (size_t i = 0; i < f->parameter_count; i++)
        for (size_t k = 0; k < f->parameter_count; k++)
            out->a[i][k] = !out->free[i] || !out->free[k] ? i == k : out->a[i][k] / (out->scale[i] * out->scale[k]);
}

/* The point after a step with that damping; returns the largest step as a fraction of a range, 0 if there is none.
 * *gain: by how much the merit would fall if the targets were linear. */
static double damped_step(const fit *f, const fit_evaluation *e, const normal_equations *n, double damping, double *x,
                          double *gain)
{
    fit_matrix a;
    double largest = 0.0;
    *gain = 0.0;
    memcpy(a, n->a, sizeof a);
    for (size_t i = 0; i < f->parameter_count; i++)
        a[i][i] += damping;
    if (!fit_invert(f->parameter_count, a))
        return 0.0;
    for (size_t i = 0; i < f->parameter_count; i++) {
        const fit_parameter *p = &f->parameters[i];
        double step = 0.0;
        for (size_t k = 0; k < f->parameter_count && n->free[i]; k++)
            step -= n->free[k] ? a[i][k] * n->gradient[k] / (n->scale[i] * n->scale[k]) : 0.0;
        x[i] = fmin(fmax(e->x[i] + step * range_of(f, i), p->from), p->to);
        *gain -= step != 0.0 ? n->gradient[i] * step : 0.0;
        largest = fmax(largest, fabs(x[i] - e->x[i]) / range_of(f, i));
    }
    return largest;
}

/* Raises the damping until a step improves the merit. *moved: the size of the step; 0: none does, or none is expected
 * to by more than `enough`. */
static status improve(fit_run *r, const char *stage, const normal_equations *n, double enough, double *damping,
                      fit_evaluation *best, double *moved, diagnostic *why)
{
    const fit *f = fit_run_of(r);
    for (; *damping < 1e12; *damping *= 10.0) {
        double x[FIT_PARAMETERS_MAX], gain;
        const fit_evaluation *e = NULL;
        *moved = damped_step(f, best, n, *damping, x, &gain);
        if (*moved > 0.0 && gain < enough)
            break;
        if (*moved == 0.0)
            continue;
        TRY(fit_evaluate(r, stage, x, &e, NULL, why));
        TRY(cancel_check(why));
        if (e->merit < best->merit) {
            *best = *e;
            *damping = fmax(0.1 * *damping, 1e-12);
            return STATUS_OK;
        }
        if (*moved < f->precision)
            break;
    }
    *moved = 0.0;
    return STATUS_OK;
}

status fit_damped(fit_run *r, const char *stage, size_t held, double enough, fit_evaluation *best, const char **ended,
                  diagnostic *why)
{
    const fit *f = fit_run_of(r);
    const size_t first = fit_run_evaluations(r);
    double damping = 1e-3, moved = 1.0;
    *ended = "its steps are below the precision";
    while (moved >= f->precision && best->merit > 0.0) {
        fit_derivatives d;
        normal_equations n;
        if (fit_run_evaluations(r) - first >= (size_t)f->evaluations) {
            *ended = "it has made its number of evaluations";
            return STATUS_OK;
        }
        TRY(fit_jacobian(r, stage, held, best->x, &d, why));
        set_equations(f, best, &d, &n);
        TRY(improve(r, stage, &n, enough, &damping, best, &moved, why));
    }
    return STATUS_OK;
}
