/* `cuvette fit`: finds the parameters of a study with a section `fit`, and reports them with their intervals,
 * sensitivities and tolerances, as text or JSON. */
#include "study/fit/fit.h"
#include "base/json_build.h"
#include "base/number.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/scene_input.h"
#include "cli/terminal.h"
#include "report/json.h"
#include "scene/file/write.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct fit_request {
    const char *file, *results, *output;
    bool json, quiet;
} fit_request;

static const command_option options[] = {
    {"results", 'r', "DIR", "write to DIR/STUDY/ instead of results/STUDY/",
     OPTION_FILLS(option_text, fit_request, results)},
    {"output", 'o', "FILE", "write the scene with the best parameters to FILE",
     OPTION_FILLS(option_text, fit_request, output)},
    {"json", 0, NULL, "print one JSON object with all digits", OPTION_FILLS(option_flag, fit_request, json)},
    {"quiet", 'q', NULL, "print errors only", OPTION_FILLS(option_flag, fit_request, quiet)},
    OPTION_MEMORY,
    {0},
};

static const command_form form = {
    .options = options,
    .synopsis = "STUDY",
    .arguments_at = offsetof(fit_request, file),
    .argument_limit = 1,
    .excess = "unexpected argument '%.128s'",
    .excess_remedy = "fit takes one study",
    .about =
        "Choose parameters of a scene so that measured quantities meet targets, or one is least: the section fit of "
        "the study file STUDY. Report them with their intervals, sensitivities and tolerances.\vEach evaluation is "
        "a row of results/STUDY/fit.csv. An interrupted or killed fit goes on where it stopped when it is run "
        "again.\nFor example:\n"
        "  cuvette fit experiments/fits/index_of_water.study\n"
        "  cuvette fit experiments/fits/achromat.study -o achromat.yaml",
};

/* --- progress --- */

typedef struct fit_progress {
    progress_line line;
    double limit; /* evaluations of all stages */
    char label[64];
} fit_progress;

static void show_progress(void *context, size_t evaluations, double best)
{
    fit_progress *p = context;
    snprintf(p->label, sizeof p->label, "evaluation %zu, merit %.4g", evaluations, best);
    progress_draw(&p->line, fmin((double)evaluations / p->limit, 1.0));
}

/* --- intervals --- */

static const char *interval_kind(const fit_result *r, size_t i)
{
    return r->has_profile[i] ? "profile, 95%" : r->has_interval ? "linear, 95%" : "none";
}

static double interval_end(const fit_result *r, size_t i, int side)
{
    return r->has_profile[i] ? r->profile[i][side]
           : r->has_interval ? r->best.x[i] + (side ? r->half[i] : -r->half[i])
                             : (double)NAN;
}

/* "1.32 .. 1.35 linear"; an end that is only the parameter's bound is in brackets. */
static const char *interval_text(const fit_result *r, size_t i, char text[96])
{
    const double ends[2] = {interval_end(r, i, 0), interval_end(r, i, 1)}, within = 0.05 * (ends[1] - ends[0]);
    size_t used = 0;
    text[0] = '-', text[1] = '\0';
    for (int side = 0; side < 2 && !isnan(within); side++) {
        char end[NUMBER_TEXT_MAX];
        const bool open = r->has_profile[i] && r->open[i][side];
        number_format_within(ends[side], within, end);
        used += (size_t)snprintf(text + used, 96 - used, open ? "%s[%s]" : "%s%s", side ? " .. " : "", end);
    }
    if (!isnan(within) && !r->has_profile[i])
        snprintf(text + used, 96 - used, " linear");
    return text;
}

/* --- JSON --- */

static json_t *parameter_json(const fit *f, const fit_result *r, size_t i)
{
    const fit_parameter *p = &f->parameters[i];
    json_t *o = json_object(), *list = json_array();
    json_add_as(&o, "name", json_of_text(p->name));
    json_add_as(&o, "value", json_of_real(r->best.x[i]));
    json_add_as(&o, "from", json_of_real(p->from));
    json_add_as(&o, "to", json_of_real(p->to));
    json_add_as(&o, "at_bound", json_boolean(r->derivative.at_bound[i]));
    json_add_as(&o, "error", json_of_real(r->has_interval ? r->error[i] : (double)NAN));
    json_add_as(&o, "interval", json_of_text(interval_kind(r, i)));
    json_add_as(&o, "low", json_of_real(interval_end(r, i, 0)));
    json_add_as(&o, "high", json_of_real(interval_end(r, i, 1)));
    json_add_as(&o, "low_at_bound", json_boolean(r->has_profile[i] && r->open[i][0]));
    json_add_as(&o, "high_at_bound", json_boolean(r->has_profile[i] && r->open[i][1]));
    json_add_as(&o, "tolerance_down", json_of_real(r->tolerance[i][0]));
    json_add_as(&o, "tolerance_up", json_of_real(r->tolerance[i][1]));
    for (size_t k = 0; k < f->parameter_count; k++)
        json_add(&list, json_of_real(r->has_interval ? r->correlation[i][k] : (double)NAN));
    json_add_as(&o, "correlation", list);
    return o;
}

static json_t *target_json(const fit *f, const fit_result *r, size_t i)
{
    const fit_target *t = &f->targets[i];
    json_t *o = json_object(), *derivatives = json_object();
    json_add_as(&o, "name", json_of_text(t->name));
    json_add_as(&o, "quantity", json_of_text(t->of.name));
    json_add_as(&o, "measured", json_of_real(r->best.values[i]));
    if (f->goal == FIT_TARGETS) {
        json_add_as(&o, "value", json_of_real(t->value));
        json_add_as(&o, "sigma", json_of_real(t->sigma > 0.0 ? t->sigma : (double)NAN));
        json_add_as(&o, "weight", json_of_real(t->weight));
    }
    for (size_t k = 0; k < f->parameter_count; k++)
        json_add_as(&derivatives, f->parameters[k].name, json_of_real(r->derivative.by[i][k]));
    json_add_as(&o, "derivatives", derivatives);
    return o;
}

static json_t *result_json(const fit_run *run, const fit_result *r)
{
    static const char *const goals[] = {"targets", "minimise", "maximise"};
    const fit *f = fit_run_of(run);
    json_t *o = json_object(), *parameters = json_array(), *targets = json_array();
    for (size_t i = 0; i < f->parameter_count; i++)
        json_add(&parameters, parameter_json(f, r, i));
    for (size_t i = 0; i < f->target_count; i++)
        json_add(&targets, target_json(f, r, i));
    json_add_as(&o, "schema", json_integer(1));
    json_add_as(&o, "study", json_of_text(f->s->name));
    json_add_as(&o, "goal", json_of_text(goals[f->goal]));
    json_add_as(&o, "evaluations", json_integer((json_int_t)fit_run_evaluations(run)));
    json_add_as(&o, "ended", json_of_text(r->ended));
    json_add_as(&o, "merit", json_of_real(r->best.merit));
    json_add_as(&o, "freedom", json_integer(r->freedom));
    json_add_as(&o, "worsening", json_of_real(r->worsening));
    json_add_as(&o, "parameters", parameters);
    json_add_as(&o, "targets", targets);
    return o;
}

/* --- text --- */

static const char *text_of(double value, const char *format, char text[32])
{
    if (isnan(value))
        return "-";
    snprintf(text, 32, format, value);
    return text;
}

static void print_parameters(const fit *f, const fit_result *r)
{
    char interval[96], down[32], up[32];
    bool open = false;
    printf("\n%-24s %16s  %-33s %11s %11s\n", "parameter", "value", "95% interval", "down", "up");
    for (size_t i = 0; i < f->parameter_count; i++) {
        printf("%-24s %16.10g  %-33s %11s %11s%s\n", f->parameters[i].name, r->best.x[i], interval_text(r, i, interval),
               text_of(r->tolerance[i][0], "%.4g", down), text_of(r->tolerance[i][1], "%+.4g", up),
               r->derivative.at_bound[i] ? "  at its bound" : "");
        open = open || (r->has_profile[i] && (r->open[i][0] || r->open[i][1]));
    }
    if (open)
        printf("[ ]: the parameter's bound, at which the targets still allow it\n");
    if (r->worsening > 0.0)
        printf("down, up: the change of one parameter that worsens the merit by %g\n", r->worsening);
}

static void print_targets(const fit *f, const fit_result *r)
{
    char measured[32], off[32];
    const bool wanted = f->goal == FIT_TARGETS;
    printf("\n%-24s %16s %16s %12s\n", wanted ? "target" : "quantity", "measured", wanted ? "wanted" : "",
           wanted ? "off by" : "");
    for (size_t i = 0; i < f->target_count; i++) {
        const fit_target *t = &f->targets[i];
        const double difference = r->best.values[i] - t->value;
        if (!wanted)
            printf("%-24s %16.10g\n", t->name, r->best.values[i]);
        else if (t->sigma > 0.0)
            printf("%-24s %16.10g %16.10g %12s sigma\n", t->name, r->best.values[i], t->value,
                   text_of(difference / t->sigma, "%+.3f", off));
        else
            printf("%-24s %16s %16.10g %12s\n", t->name, text_of(r->best.values[i], "%.10g", measured), t->value,
                   text_of(difference, "%+.3g", off));
    }
    printf("\n%-24s %-24s %14s\n", "sensitivity of", "to", "derivative");
    for (size_t i = 0; i < f->target_count; i++)
        for (size_t k = 0; k < f->parameter_count; k++)
            printf("%-24s %-24s %14s\n", f->targets[i].name, f->parameters[k].name,
                   text_of(r->derivative.by[i][k], "%.6g", off));
}

static void print_text(const fit_run *run, const fit_result *r, const char *results)
{
    const fit *f = fit_run_of(run);
    printf("%s: %zu evaluations, %zu of them new rows of %s/%s/fit.csv\n", f->s->name, fit_run_evaluations(run),
           fit_run_new(run), results, f->s->name);
    printf("merit%s: %.6g", f->goal == FIT_TARGETS ? ", sum of weighted squares" : "", r->best.merit);
    if (f->goal == FIT_TARGETS && r->freedom > 0)
        printf(" with %ld degree%s of freedom", r->freedom, r->freedom == 1 ? "" : "s");
    printf("; the search ended: %s\n", r->ended);
    print_parameters(f, r);
    print_targets(f, r);
}

/* --- the command --- */

static void note_rows(const fit_run *run, const char *results)
{
    char text[400];
    if (fit_run_set_aside(run) == 0)
        return;
    snprintf(text, sizeof text,
             "%s: %zu rows of %.200s/%.64s/fit.csv are of another scene, other quantities or another build, or were "
             "edited; they are kept and not used",
             fit_run_of(run)->s->name, fit_run_set_aside(run), results, fit_run_of(run)->s->name);
    terminal_note(text);
}

static void note_idle_parameters(const fit *f, const fit_result *r)
{
    char text[300];
    for (size_t i = 0; i < f->parameter_count; i++) {
        bool acts = false;
        for (size_t k = 0; k < f->target_count; k++)
            acts = acts || r->derivative.by[k][i] != 0.0;
        snprintf(
            text, sizeof text,
            "%s: %.64s changes nothing that is measured near the best point: it has no effect, or step is too small",
            f->s->name, f->parameters[i].name);
        if (!acts)
            terminal_note(text);
    }
}

/* The merit is chi-squared if each target has a sigma. By the cube root of chi-squared over its degrees of freedom,
 * which is nearly normal (Wilson and Hilferty, PNAS 17, 1931), values this large have a probability below 0.001. */
static void note_misfit(const fit *f, const fit_result *r)
{
    const double spread = 2.0 / (9.0 * (double)r->freedom);
    size_t worst = 0;
    double most = 0.0;
    for (size_t i = 0; i < f->target_count; i++) {
        const double off = fabs(r->best.values[i] - f->targets[i].value) / f->targets[i].sigma;
        if (!(f->targets[i].sigma > 0.0))
            return;
        if (off > most)
            worst = i, most = off;
    }
    if (r->freedom <= 0 || !(cbrt(r->best.merit / (double)r->freedom) - (1.0 - spread) > 3.09 * sqrt(spread)))
        return;
    char text[400];
    snprintf(text, sizeof text,
             "%s: chi-squared is %.4g with %ld degrees of freedom, far too large, so that the intervals mean nothing: "
             "the model, a value or a sigma is wrong; %.64s is off by %.3g sigma",
             f->s->name, r->best.merit, r->freedom, f->targets[worst].name, most);
    terminal_note(text);
}

/* What is doubtful about the intervals. */
static void note_profiles(const fit *f, const fit_result *r)
{
    char text[400];
    if (r->has_better) {
        snprintf(text, sizeof text,
                 "%s: the search missed a better point, which a profile found: merit %.6g instead of %.6g; choose a "
                 "start nearer to it, or a global method first",
                 f->s->name, r->better.merit, r->best.merit);
        terminal_note(text);
    }
    if (r->profile_lacking > 0) {
        snprintf(text, sizeof text,
                 "%s: %zu of %zu intervals are linear, since profiles need more than %ld evaluations; raise "
                 "evaluations, or choose interval: linear",
                 f->s->name, r->profile_lacking, f->parameter_count, f->evaluations);
        terminal_note(text);
    }
}

static status write_scene(const fit *f, const fit_result *r, const char *path, diagnostic *why)
{
    scene *s = NULL;
    status code = fit_scene(f, r->best.x, 0, &s, why);
    THEN(code, scene_write(s, path, false, why));
    scene_destroy(s);
    return code;
}

static status report_interrupted(const fit_run *run, diagnostic *why)
{
    return diagnose_at(why, fit_run_of(run)->s->path, STATUS_INTERRUPTED, "run it again to resume",
                       "interrupted; its %zu new rows are kept", fit_run_new(run));
}

static status search_and_report(const fit_request *request, fit_run *run, fit_progress *progress, diagnostic *why)
{
    const fit *f = fit_run_of(run);
    fit_result *r = calloc(1, sizeof *r);
    status code = r ? fit_search(run, r, why) : out_of_memory(why);
    THEN(code, fit_spread(run, r, why));
    progress_erase(&progress->line);
    if (code == STATUS_INTERRUPTED)
        code = report_interrupted(run, why);
    if (code == STATUS_OK && !request->quiet)
        note_idle_parameters(f, r), note_misfit(f, r), note_profiles(f, r);
    if (code == STATUS_OK && request->output)
        code = write_scene(f, r, request->output, why);
    if (code == STATUS_OK && request->json)
        code = json_print(result_json(run, r), why);
    else if (code == STATUS_OK && !request->quiet)
        print_text(run, r, request->results);
    free(r);
    return code;
}

static status run_fit(const fit_request *request, const fit *f, diagnostic *why)
{
    fit_progress progress = {.limit = (double)f->evaluations * (double)(f->stage_count + 1)};
    const fit_options settings = {.results = request->results, .progressed = show_progress, .context = &progress};
    fit_run *run = NULL;
    progress_start(&progress.line, progress.label);
    progress.line.enabled = progress.line.enabled && !request->quiet;
    status code = fit_run_begin(f, &settings, &run, why);
    if (code == STATUS_OK && !request->quiet)
        note_rows(run, request->results);
    THEN(code, search_and_report(request, run, &progress, why));
    fit_run_end(run);
    return code;
}

status command_fit(int argc, char **argv, diagnostic *why)
{
    fit_request request = {.results = "results"};
    fit *f = NULL;
    isa level;
    TRY(command_form_read(&form, argc, argv, &request, why));
    if (!request.file)
        return options_wrong("fit", NULL, why, "give a study file, such as experiments/fits/index_of_water.study",
                             "no study is given");
    TRY(scene_input_isa(&level, why));
    status code = fit_read(request.file, &f, why);
    THEN(code, run_fit(&request, f, why));
    fit_destroy(f);
    return code;
}
