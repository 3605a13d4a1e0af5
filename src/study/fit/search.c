/* The search for the best parameters, by the algorithms of NLopt (Johnson, The NLopt nonlinear-optimization package):
 * Nelder and Mead, Comput. J. 7 (1965); Rowan's subplex (1990); Powell's BOBYQA (2009) and COBYLA (1994); DIRECT of
 * Jones, Perttunen and Stuckman, J. Optim. Theory Appl. 79 (1993); controlled random search of Kaelo and Ali (2006).
 * None needs derivatives. All work on parameters as fractions of their ranges. NLopt requests the same points whenever
 * it gets the same values, so that a search that is repeated with the rows of an earlier one goes on where it ended. */
#include "base/cancel.h"
#include "base/elementary.h"
#include "study/fit/fit.h"
#include <math.h>
#include <nlopt.h>

/* The first step, as a fraction of the range. */
#define FIRST_STEP 0.1

typedef struct search {
    fit_run *r;
    const fit *f;
    fit_method method;
    fit_evaluation best;
    double worst; /* of the merits so far */
    nlopt_opt optimiser;
    status code;
    diagnostic *why;
} search;

/* Simplex methods do not see bounds: NLopt would clip their points there, and a simplex that has shrunk onto a bound
 * does not leave it. They get coordinates c of the fraction (1 - cos 180 c) / 2 instead, which fold at the bounds. */
static bool is_folded(fit_method method)
{
    return method == FIT_NELDER_MEAD || method == FIT_SBPLX;
}

static double fraction_of(fit_method method, double c)
{
    double sine, cosine;
    elementary_sincos_deg(180.0 * fmod(c, 2.0), &sine, &cosine);
    return is_folded(method) ? 0.5 - 0.5 * cosine : c;
}

static double coordinate_of(fit_method method, double fraction)
{
    const double sine = 2.0 * sqrt(fraction * (1.0 - fraction)), cosine = 1.0 - 2.0 * fraction;
    return is_folded(method) ? elementary_atan2_deg(sine, cosine) / 180.0 : fraction;
}

static void place(const search *s, const double *coordinates, double *x)
{
    for (size_t i = 0; i < s->f->parameter_count; i++) {
        const fit_parameter *p = &s->f->parameters[i];
        const double fraction = fraction_of(s->method, coordinates[i]);
        x[i] = fmin(fmax(p->from + fraction * (p->to - p->from), p->from), p->to);
    }
}

/* Where nothing can be measured the merit is far above the worst that was. NLopt's quadratic models need finite
 * values. */
static double merit_or_penalty(search *s, const fit_evaluation *e)
{
    if (isnan(e->merit))
        return s->worst + 10.0 * fabs(s->worst) + 1.0;
    if (e->merit < s->best.merit)
        s->best = *e;
    s->worst = fmax(s->worst, e->merit);
    return e->merit;
}

static double objective(unsigned n, const double *coordinates, double *gradient, void *context)
{
    search *s = context;
    const fit_evaluation *e = NULL;
    double x[FIT_PARAMETERS_MAX];
    (void)n, (void)gradient;
    place(s, coordinates, x);
    THEN(s->code, fit_evaluate(s->r, fit_method_words[s->method], x, &e, NULL, s->why));
    THEN(s->code, cancel_check(s->why));
    if (s->code == STATUS_OK)
        return merit_or_penalty(s, e);
    nlopt_force_stop(s->optimiser);
    return s->worst;
}

static nlopt_algorithm algorithm_of(fit_method method)
{
    switch (method) {
    case FIT_NELDER_MEAD: return NLOPT_LN_NELDERMEAD;
    case FIT_SBPLX: return NLOPT_LN_SBPLX;
    case FIT_BOBYQA: return NLOPT_LN_BOBYQA;
    case FIT_COBYLA: return NLOPT_LN_COBYLA;
    case FIT_DIRECT: return NLOPT_GN_DIRECT_L;
    case FIT_CRS: return NLOPT_GN_CRS2_LM;
    case FIT_DAMPED:
    case FIT_METHOD_COUNT: break;
    }
    return NLOPT_LN_NELDERMEAD;
}

static const char *why_ended(nlopt_result result)
{
    switch ((int)result) {
    case NLOPT_XTOL_REACHED: return "its steps are below the precision";
    case NLOPT_MAXEVAL_REACHED: return "it has made its number of evaluations";
    case NLOPT_ROUNDOFF_LIMITED: return "rounding errors allow no better point";
    case NLOPT_STOPVAL_REACHED: return "all targets are met exactly";
    default: return result > 0 ? "it has converged" : "NLopt found no way on";
    }
}

static status run_stage(search *s, const char **ended)
{
    const fit *f = s->f;
    const unsigned count = (unsigned)f->parameter_count;
    double coordinates[FIT_PARAMETERS_MAX], least;
    nlopt_opt o = s->optimiser = nlopt_create(algorithm_of(s->method), count);
    if (!o)
        return out_of_memory(s->why);
    for (size_t i = 0; i < f->parameter_count; i++) {
        const fit_parameter *p = &f->parameters[i];
        coordinates[i] = coordinate_of(s->method, fmin(fmax((s->best.x[i] - p->from) / (p->to - p->from), 0.0), 1.0));
    }
    nlopt_srand((unsigned long)f->seed);
    const double bounds[2] = {is_folded(s->method) ? -HUGE_VAL : 0.0, is_folded(s->method) ? HUGE_VAL : 1.0};
    const bool ready = nlopt_set_min_objective(o, objective, s) > 0 && nlopt_set_lower_bounds1(o, bounds[0]) > 0 &&
                       nlopt_set_upper_bounds1(o, bounds[1]) > 0 && nlopt_set_xtol_rel(o, 0.0) > 0 &&
                       nlopt_set_xtol_abs1(o, f->precision) > 0 && nlopt_set_maxeval(o, (int)f->evaluations) > 0 &&
                       nlopt_set_initial_step1(o, FIRST_STEP) > 0 &&
                       (f->goal != FIT_TARGETS || nlopt_set_stopval(o, 0.0) > 0);
    const nlopt_result result = ready ? nlopt_optimize(o, coordinates, &least) : NLOPT_OUT_OF_MEMORY;
    nlopt_destroy(o);
    *ended = why_ended(result);
    if (s->code == STATUS_OK && (result == NLOPT_OUT_OF_MEMORY || result == NLOPT_INVALID_ARGS))
        return out_of_memory(s->why);
    return s->code;
}

static status start_error(const fit *f, const fit_evaluation *e, const diagnostic *reason, diagnostic *why)
{
    size_t lacking = 0;
    while (lacking + 1 < f->target_count && !isnan(e->values[lacking]))
        lacking++;
    if (reason->line > 0) { /* one quantity's own, with its place */
        if (why)
            *why = *reason;
        return STATUS_BAD_INPUT;
    }
    diagnose(why, STATUS_BAD_INPUT,
             reason->remedy[0] ? reason->remedy : "choose another start, at which rays arrive and it is in view",
             "%.64s cannot be measured at the start%s%.400s", f->targets[lacking].name, reason->what[0] ? ": " : "",
             reason->what);
    diagnostic_locate(why, f->s->path, f->targets[lacking].of.line, f->targets[lacking].of.column);
    return STATUS_BAD_INPUT;
}

status fit_search(fit_run *r, fit_result *out, diagnostic *why)
{
    const fit *f = fit_run_of(r);
    const fit_evaluation *e = NULL;
    double x[FIT_PARAMETERS_MAX];
    diagnostic reason = {.what = ""};
    for (size_t i = 0; i < f->parameter_count; i++)
        x[i] = f->parameters[i].start;
    TRY(fit_evaluate(r, "start", x, &e, &reason, why));
    if (isnan(e->merit))
        return start_error(f, e, &reason, why);
    search s = {.r = r, .f = f, .best = *e, .worst = e->merit, .why = why};
    for (size_t i = 0; i < f->stage_count; i++) {
        s.method = f->stages[i];
        TRY(s.method == FIT_DAMPED
                ? fit_damped(r, fit_method_words[FIT_DAMPED], FIT_NONE_HELD, 0.0, &s.best, &out->ended, why)
                : run_stage(&s, &out->ended));
    }
    out->best = s.best;
    return STATUS_OK;
}
