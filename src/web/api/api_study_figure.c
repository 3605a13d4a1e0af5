/* API: the figure of a study, which `cuvette study plot` would draw, made in a temporary folder; and the comparison of
 * two sides of a study (runs, cells, or values of an axis), as `cuvette study compare` prints it. */
#include "base/cancel.h"
#include "base/file.h"
#include "base/text.h"
#include "study/plot/plot.h"
#include "study/summary/contrast.h"
#include "web/api/api.h"
#include "web/session/studies.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double draw_limit_s = 50; /* below the minute that a page waits for a reply */
enum { FIGURE_MAX = 64 << 20 };

/* --- the request --- */

static const struct {
    const char *format, *type;
} formats[] = {{"svg", "image/svg+xml"}, {"png", "image/png"}, {"pdf", "application/pdf"}};
enum { FORMAT_COUNT = sizeof formats / sizeof *formats };

static status read_format(call *c, size_t *which)
{
    const char *text = http_query_value(c->request, "format");
    for (*which = 0; text && *which < FORMAT_COUNT; ++*which)
        if (strcmp(text, formats[*which].format) == 0)
            return STATUS_OK;
    *which = 0;
    return text ? api_refuse(c, 400, "unknown format", "use ?format=svg, png or pdf") : STATUS_OK;
}

static status read_log(call *c, plot_log *log)
{
    static const char *const words[] = {"auto", "none", "x", "y", "xy"};
    static const plot_log meaning[] = {PLOT_LOG_AUTO, PLOT_LOG_NONE, PLOT_LOG_X, PLOT_LOG_Y, PLOT_LOG_XY};
    const char *text = http_query_value(c->request, "log");
    for (size_t i = 0; text && i < sizeof words / sizeof *words; i++)
        if (strcmp(text, words[i]) == 0) {
            *log = meaning[i];
            return STATUS_OK;
        }
    return text ? api_refuse(c, 400, "unknown scale", "use ?log=none, x, y or xy") : STATUS_OK;
}

/* The option's value; NULL if it is missing or empty. */
static const char *option(const call *c, const char *key)
{
    const char *text = http_query_value(c->request, key);
    return text && text[0] ? text : NULL;
}

/* --- the drawing --- */

static void remove_files(const char *directory, const char *base)
{
    static const char *const endings[] = {"gp", "tsv", "svg", "png", "pdf"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        char *path = text_format("%s.%s", base, endings[i]);
        if (path)
            unlink(path);
        free(path);
    }
    rmdir(directory);
}

static status make_folder(const lab *l, char **directory, diagnostic *why)
{
    *directory = text_format("%s/cuvette-figure-XXXXXX", lab_temporary_folder(l));
    if (!*directory)
        return out_of_memory(why);
    if (mkdtemp(*directory))
        return STATUS_OK;
    const int error = errno;
    free(*directory);
    *directory = NULL;
    return diagnose(why, STATUS_FAILURE, "set TMPDIR to a folder that can be written",
                    "cannot create a temporary folder: %s", strerrordesc_np(error));
}

/* Draws the figure and reads it back. */
static status make_figure(call *c, const study *s, const plot_request *request, const char *format, char **bytes,
                          size_t *size)
{
    char *directory = NULL;
    TRY(make_folder(c->l, &directory, &c->why));
    char *base = text_format("%s/%s", directory, s->name), *file = text_format("%s/%s.%s", directory, s->name, format);
    status code = base && file ? STATUS_OK : out_of_memory(&c->why);
    THEN(code, study_plot_write(s, request, base, &c->why));
    cancel_token token = {.ask = studies_ending, .context = c->l->studies};
    cancel_begin(&token);
    THEN(code, study_plot_draw(base, format, draw_limit_s, &c->why));
    cancel_end(&token);
    THEN(code, file_read(file, FIGURE_MAX, bytes, size, &c->why));
    remove_files(directory, base ? base : "");
    free(file);
    free(base);
    free(directory);
    return code;
}

static status draw(call *c, const study *s)
{
    lab *l = c->l;
    size_t which = 0, size = 0;
    char *bytes = NULL;
    plot_request request = {
        .results = l->settings.results, .x = option(c, "x"), .y = option(c, "y"), .by = option(c, "by")};
    TRY(read_format(c, &which));
    TRY(read_log(c, &request.log));
    if (studies_runs(l->studies, NULL))
        return api_refuse(c, 409, "a study is measuring, and drawing would disturb it",
                          "save the figure after the study has ended, or stop it");
    if (!studies_begin_drawing(l->studies))
        return api_refuse(c, 409, "figures are already being drawn", "wait until they are finished");
    const status code = make_figure(c, s, &request, formats[which].format, &bytes, &size);
    studies_end_drawing(l->studies);
    return code == STATUS_OK ? api_send(c, formats[which].type, bytes, size) : code;
}

status api_study_figure(call *c)
{
    study *s;
    status code = api_read_study(c, &s);
    THEN(code, draw(c, s));
    study_destroy(s);
    return code;
}

/* The path of the results folder `run`; STATUS_BAD_INPUT if it holds no rows of the study. */
static status read_run(call *c, const char *run, const study *s, char **results)
{
    char *rows = text_format("%s/%s/rows.csv", run, s->name);
    status code = rows ? folder_path(c->l->files, rows, true, results, &c->why) : out_of_memory(&c->why);
    if (code == STATUS_OK) {
        (*results)[strlen(*results) - strlen(rows) + strlen(run)] = 0;
        code = study_check_results(c->l, *results, s->name, &c->why);
    }
    free(rows);
    return code;
}

/* Reads a side of a comparison. side_read accepts any results folder, so a side with another folder than the
 * laboratory's is refused afterwards. */
static status read_side(call *c, const study *s, const char *key, study_side *side)
{
    const char *results = c->l->settings.results, *text = http_query_value(c->request, key);
    TRY(side_read(s, text, results, side, &c->why));
    if (side->results == results)
        return STATUS_OK;
    return api_refuse(c, 400, "a side names a results folder", "use ?with=FOLDER to compare with a folder");
}

static status compare(call *c, const study *s, const study_side *a, const study_side *b)
{
    contrast *found = NULL;
    TRY(contrast_make(s, a, b, &(contrast_options){.column = NULL}, &found, NULL, &c->why));
    json_t *json = contrast_json(s, found, STUDY_JSON_CELLS_MAX);
    contrast_destroy(found);
    return json ? api_reply_json(c, json) : out_of_memory(&c->why);
}

static status compare_runs(call *c, const study *s, const char *with)
{
    char *other = NULL;
    TRY(read_run(c, with, s, &other));
    const study_side a = side_of_folder(c->l->settings.results), b = side_of_folder(other);
    const status code = compare(c, s, &a, &b);
    free(other);
    return code;
}

static status compare_sides(call *c, const study *s)
{
    study_side a = {.text = NULL}, b = {.text = NULL};
    status code = read_side(c, s, "a", &a);
    THEN(code, read_side(c, s, "b", &b));
    THEN(code, compare(c, s, &a, &b));
    side_release(&a);
    side_release(&b);
    return code;
}

status api_study_compare(call *c)
{
    const char *with = http_query_value(c->request, "with");
    const bool sides = http_query_value(c->request, "a") && http_query_value(c->request, "b");
    study *s;
    if (!sides && (!with || !with[0]))
        return api_refuse(c, 400, "neither 'with' nor 'a' and 'b' are given",
                          "add ?with=FOLDER, one of the study's runs, or ?a=SIDE&b=SIDE, such as a=cell=0&b=cell=1");
    TRY(api_read_study(c, &s));
    const status code = sides ? compare_sides(c, s) : compare_runs(c, s, with);
    study_destroy(s);
    return code;
}
