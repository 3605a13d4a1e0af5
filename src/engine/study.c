/* Studies: reading, cells, running, and the evaluation of their rows: summary, comparison, figure. */
#include "study/study.h"
#include "base/text.h"
#include "engine/engine_private.h"
#include "report/json.h"
#include "study/plot/plot.h"
#include "study/rows/rows.h"
#include "study/summary/contrast.h"
#include "study/summary/summary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct cuvette_study {
    study *study;
};

void cuvette_text_destroy(char *text)
{
    free(text);
}

cuvette_status cuvette_study_read(const char *path, cuvette_study **out, cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    ENGINE_NEED(path);
    cuvette_study *made = calloc(1, sizeof *made);
    const status code = made ? study_read(path, &made->study, &inner) : out_of_memory(&inner);
    if (code == STATUS_OK)
        *out = made;
    else
        free(made);
    return engine_report(code, &inner, why);
}

void cuvette_study_destroy(cuvette_study *s)
{
    if (!s)
        return;
    study_destroy(s->study);
    free(s);
}

const char *cuvette_study_name(const cuvette_study *s)
{
    return s ? s->study->name : NULL;
}

const char *cuvette_study_title(const cuvette_study *s)
{
    return !s ? NULL : s->study->title ? s->study->title : "";
}

size_t cuvette_study_cells(const cuvette_study *s)
{
    return s ? study_cell_count(s->study) : 0;
}

long cuvette_study_processes(const cuvette_study *s)
{
    return s ? study_processes(s->study) : 0;
}

static status check_cell(const cuvette_study *s, size_t cell, diagnostic *why)
{
    const size_t count = study_cell_count(s->study);
    return cell < count ? STATUS_OK
                        : diagnose(why, STATUS_BAD_INPUT, "count cells from 0",
                                   "the study has %zu cells, but no cell %zu", count, cell);
}

cuvette_status cuvette_study_scene(const cuvette_study *s, size_t cell, cuvette_scene **out, cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    ENGINE_NEED_NAMED(s, "study");
    scene *made = NULL;
    status code = check_cell(s, cell, &inner);
    THEN(code, study_cell_scene(s->study, cell, &made, &inner));
    return code == STATUS_OK ? engine_own_scene(made, out, why) : engine_report(code, &inner, why);
}

cuvette_status cuvette_study_each_value(const cuvette_study *s, size_t cell,
                                        bool (*visit)(void *context, const char *path, const char *value),
                                        void *context, cuvette_diagnostic *why)
{
    ENGINE_ENTER();
    ENGINE_NEED_NAMED(s, "study");
    ENGINE_NEED_NAMED(visit, "visit");
    const status code = check_cell(s, cell, &inner);
    bool wants_more = code == STATUS_OK;
    for (size_t axis = 0; wants_more && axis < s->study->axis_count; axis++) {
        const study_point *point = &s->study->axes[axis].points[study_cell_point(s->study, cell, axis)];
        for (size_t i = 0; wants_more && i < point->count; i++) {
            float_environment_leave(&host);
            wants_more = visit(context, point->paths[i], point->values[i]);
            float_environment_enter(&host);
        }
    }
    return engine_report(code, &inner, why);
}

/* The results folder: "results" for NULL. */
static const char *results_folder(const char *results)
{
    return results ? results : "results";
}

cuvette_status cuvette_study_state(const cuvette_study *s, const char *results, cuvette_study_progress *out,
                                   cuvette_diagnostic *why)
{
    ENGINE_ENTER();
    ENGINE_NEED_NAMED(s, "study");
    ENGINE_NEED(out);
    study_progress found;
    const status code = study_status(s->study, results_folder(results), &found, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    cuvette_study_progress result = {.cells = found.cells,
                                     .cells_done = found.cells_done,
                                     .rows = found.rows - found.warmups,
                                     .warmups = found.warmups,
                                     .marked = found.rows_marked,
                                     .disturbed = found.rows_disturbed,
                                     .rows_elsewhere = found.rows_elsewhere,
                                     .rows_other_cells = found.rows_other_cells,
                                     .faults = found.faults};
    memcpy(result.environment, found.environment, sizeof result.environment);
    memcpy(result.fault, found.fault.what, sizeof result.fault);
    return engine_copy_struct(&result, sizeof result, out, why);
}

/* A run in progress. */
typedef struct run_call {
    const cuvette_run *run;
    host_progress host;
    double left_s;
} run_call;

static bool report_progress(void *context, double fraction)
{
    const run_call *c = context;
    return c->run->progress(c->run->context, fraction, c->left_s);
}

static void note_moment(void *context, const study_frame_progress *now)
{
    run_call *c = context;
    const double of_frame = now->stage == STUDY_MEASURING ? now->share : 0.0;
    c->left_s = now->left_s;
    engine_report_if_due(
        &c->host, now->frames_all ? fmin(1.0, ((double)now->frames_done + of_frame) / (double)now->frames_all) : 1.0);
}

static void pass_news(void *context, const char *text)
{
    run_call *c = context;
    float_environment_leave(c->host.host);
    c->run->news(c->run->context, text);
    float_environment_enter(c->host.host);
}

static status check_run(const cuvette_study *s, const cuvette_run *run, diagnostic *why)
{
    const long processes = study_processes(s->study);
    if (run->size < sizeof *run) /* there is no earlier version yet */
        return diagnose(why, STATUS_BAD_INPUT, "set it to sizeof(cuvette_run)",
                        "the run's size is %zu, which is too small", run->size);
    if (run->process < 0 || run->process > processes)
        return diagnose(why, STATUS_BAD_INPUT, "use 0, or a number from 1 to this number of processes",
                        "the study has %ld processes, but no process %ld", processes, run->process);
    return STATUS_OK;
}

cuvette_status cuvette_study_run(const cuvette_study *s, const cuvette_run *run, size_t *rows, cuvette_diagnostic *why)
{
    ENGINE_ENTER();
    ENGINE_NEED_NAMED(s, "study");
    ENGINE_NEED(run);
    size_t made = 0;
    run_call call = {.run = run, .host = {.context = &call, .host = &host}, .left_s = NAN};
    status code = check_run(s, run, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    const study_options options = {.results = results_folder(run->results),
                                   .process = run->process,
                                   .any_environment = run->any_environment,
                                   .progressed = note_moment,
                                   .news = run->news ? pass_news : NULL,
                                   .wait_quiet_s = run->wait_quiet_s,
                                   .context = &call};
    call.host.callback = run->progress ? report_progress : NULL;
    engine_begin_progress(&call.host);
    code = study_run(s->study, &options, &made, &inner);
    engine_end_progress(&call.host);
    if (rows)
        *rows = made;
    return engine_report(code, &inner, why);
}

typedef struct column_call {
    bool (*visit)(void *context, const cuvette_column *one);
    void *context;
    float_environment *host;
    bool wants_more;
} column_call;

static void pass_column(void *context, const row_column *column)
{
    column_call *c = context;
    const cuvette_column one = {column->name, column->unit, column->meaning};
    if (!c->wants_more)
        return;
    float_environment_leave(c->host);
    c->wants_more = c->visit(c->context, &one);
    float_environment_enter(c->host);
}

cuvette_status cuvette_each_column(bool (*visit)(void *context, const cuvette_column *one), void *context,
                                   cuvette_diagnostic *why)
{
    ENGINE_ENTER();
    ENGINE_NEED_NAMED(visit, "visit");
    row_each_column(pass_column, &(column_call){visit, context, &host, true});
    return CUVETTE_OK;
}

/* --- evaluation of the rows --- */

static const double draw_limit_s = 300;

/* Passes the first fault of the rows to the caller: *out stays NULL without one. */
static status put_fault(const diagnostic *verdict, char **out, diagnostic *why)
{
    if (!out || !verdict->what[0])
        return STATUS_OK;
    *out = strdup(verdict->what);
    return *out ? STATUS_OK : out_of_memory(why);
}

cuvette_status cuvette_study_summary(const cuvette_study *s, const char *results, const char *environment, char **out,
                                     char **fault, cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    if (fault)
        *fault = NULL;
    ENGINE_NEED_NAMED(s, "study");
    const summary_options options = {.environment = environment};
    diagnostic verdict = {.what = ""};
    text_writer writer;
    status code = text_writer_open(&writer, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    code = study_summary_of(s->study, results_folder(results), &options, writer.stream, &verdict, &inner);
    code = text_writer_end(&writer, code, out, NULL, &inner);
    THEN(code, put_fault(&verdict, fault, &inner));
    return engine_report(code, &inner, why);
}

cuvette_status cuvette_study_rows(const cuvette_study *s, const char *results, const char *environment, char **out,
                                  char **fault, cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    if (fault)
        *fault = NULL;
    if (!s)
        ENGINE_NEED(results);
    diagnostic verdict = {.what = ""};
    text_writer writer;
    status code = text_writer_open(&writer, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    code = row_list_write(s ? s->study : NULL, results_folder(results), environment, writer.stream, &verdict, &inner);
    code = text_writer_end(&writer, code, out, NULL, &inner);
    THEN(code, put_fault(&verdict, fault, &inner));
    return engine_report(code, &inner, why);
}

static status write_comparison(const study *s, const contrast *c, char **out, diagnostic *why)
{
    text_writer writer;
    TRY(text_writer_open(&writer, why));
    const status code = json_put(writer.stream, contrast_json(s, c, SIZE_MAX), why);
    return text_writer_end(&writer, code, out, NULL, why);
}

cuvette_status cuvette_study_compare(const cuvette_study *s, const char *results, const char *a, const char *b,
                                     const char *column, char **out, char **fault, cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    if (fault)
        *fault = NULL;
    ENGINE_NEED_NAMED(s, "study");
    ENGINE_NEED(a, b);
    study_side one = {.text = NULL}, other = {.text = NULL};
    contrast *found = NULL;
    diagnostic verdict = {.what = ""};
    status code = side_read(s->study, a, results_folder(results), &one, &inner);
    THEN(code, side_read(s->study, b, results_folder(results), &other, &inner));
    THEN(code, contrast_make(s->study, &one, &other, &(contrast_options){.column = column}, &found, &verdict, &inner));
    THEN(code, write_comparison(s->study, found, out, &inner));
    THEN(code, put_fault(&verdict, fault, &inner));
    contrast_destroy(found);
    side_release(&one);
    side_release(&other);
    return engine_report(code, &inner, why);
}

static status read_plot(const cuvette_plot *given, plot_request *out, diagnostic *why)
{
    static const char *const words[] = {"none", "x", "y", "xy"};
    static const plot_log scales[] = {PLOT_LOG_NONE, PLOT_LOG_X, PLOT_LOG_Y, PLOT_LOG_XY};
    if (given->size < sizeof *given) /* there is no earlier version yet */
        return diagnose(why, STATUS_BAD_INPUT, "set it to sizeof(cuvette_plot)",
                        "the plot's size is %zu, which is too small", given->size);
    *out = (plot_request){.results = results_folder(given->results),
                          .x = given->x,
                          .y = given->y,
                          .by = given->by,
                          .where = given->where,
                          .where_count = given->where ? given->where_count : 0,
                          .published = given->published,
                          .images = given->images};
    bool known = !given->log;
    for (size_t i = 0; given->log && i < sizeof words / sizeof *words; i++)
        if (strcmp(given->log, words[i]) == 0)
            out->log = scales[i], known = true;
    return known ? STATUS_OK
                 : diagnose(why, STATUS_BAD_INPUT, "use x, y, xy or none", "unknown scale '%.64s'", given->log);
}

cuvette_status cuvette_study_plot(const cuvette_study *s, const cuvette_plot *plot, const char *base,
                                  const char *format, cuvette_diagnostic *why)
{
    ENGINE_ENTER();
    ENGINE_NEED_NAMED(s, "study");
    ENGINE_NEED(plot, base, format);
    plot_request request;
    status code = strcmp(format, "png") == 0 || strcmp(format, "svg") == 0 || strcmp(format, "pdf") == 0
                      ? STATUS_OK
                      : diagnose(&inner, STATUS_BAD_INPUT, "use png, svg or pdf", "unknown format '%.64s'", format);
    THEN(code, read_plot(plot, &request, &inner));
    THEN(code, study_plot_write(s->study, &request, base, &inner));
    THEN(code, study_plot_draw(base, format, draw_limit_s, &inner));
    return engine_report(code, &inner, why);
}
