/* What the rows of a study say: summary, comparison, figure. */
#include "engine/engine_private.h"
#include "engine/study_private.h"

#include "base/text.h"
#include "report/json.h"
#include "study/summary/contrast.h"
#include "study/plot/plot.h"
#include "study/summary/summary.h"
#include <stdlib.h>
#include <string.h>

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
    code = study_summary_of(s->of, engine_results(results), &options, writer.stream, &verdict, &inner);
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
    code = row_list_write(s ? s->of : NULL, engine_results(results), environment, writer.stream, &verdict, &inner);
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
    status code = side_read(s->of, a, engine_results(results), &one, &inner);
    THEN(code, side_read(s->of, b, engine_results(results), &other, &inner));
    THEN(code, contrast_make(s->of, &one, &other, &(contrast_options){.column = column}, &found, &verdict, &inner));
    THEN(code, write_comparison(s->of, found, out, &inner));
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
    *out = (plot_request){.results = engine_results(given->results),
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
    THEN(code, study_plot_write(s->of, &request, base, &inner));
    THEN(code, study_plot_draw(base, format, draw_limit_s, &inner));
    return engine_report(code, &inner, why);
}
