/* API: the figure of a study, drawn as by `cuvette study plot`, in a temporary folder. */
#include "base/cancel.h"
#include "base/file.h"
#include "base/text.h"
#include "study/plot/plot.h"
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

static status take_format(call *c, size_t *which)
{
    const char *text = http_query_value(c->request, "format");
    for (*which = 0; text && *which < FORMAT_COUNT; ++*which)
        if (strcmp(text, formats[*which].format) == 0)
            return STATUS_OK;
    *which = 0;
    return text ? api_refuse(c, 400, "unknown format", "use ?format=svg, png or pdf") : STATUS_OK;
}

static status take_log(call *c, plot_log *log)
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

/* An empty value is none. */
static const char *option(const call *c, const char *key)
{
    const char *text = http_query_value(c->request, key);
    return text && text[0] ? text : NULL;
}

/* --- the drawing --- */

static void remove_files(const char *room, const char *base)
{
    static const char *const endings[] = {"gp", "tsv", "svg", "png", "pdf"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        char *path = text_format("%s.%s", base, endings[i]);
        if (path)
            unlink(path);
        free(path);
    }
    rmdir(room);
}

static status make_folder(const lab *l, char **room, diagnostic *why)
{
    *room = text_format("%s/cuvette-figure-XXXXXX", lab_temporary_folder(l));
    if (!*room)
        return out_of_memory(why);
    if (mkdtemp(*room))
        return STATUS_OK;
    const int error = errno;
    free(*room);
    *room = NULL;
    return diagnose(why, STATUS_FAILURE, "set TMPDIR to a folder that can be written",
                    "no temporary folder can be made: %s", strerrordesc_np(error));
}

/* Draws the figure and reads it back. */
static status make_figure(call *c, const study *s, const plot_request *request, const char *format, char **bytes,
                          size_t *size)
{
    char *room = NULL;
    TRY(make_folder(c->l, &room, &c->why));
    char *base = text_format("%s/%s", room, s->name), *file = text_format("%s/%s.%s", room, s->name, format);
    status code = base && file ? STATUS_OK : out_of_memory(&c->why);
    THEN(code, study_plot_write(s, request, base, &c->why));
    cancel_token token = {.ask = studies_ending, .context = c->l->studies};
    cancel_begin(&token);
    THEN(code, study_plot_draw(base, format, draw_limit_s, &c->why));
    cancel_end(&token);
    THEN(code, file_read(file, FIGURE_MAX, bytes, size, &c->why));
    remove_files(room, base ? base : "");
    free(file);
    free(base);
    free(room);
    return code;
}

static status draw(call *c, const study *s)
{
    lab *l = c->l;
    size_t which = 0, size = 0;
    char *bytes = NULL;
    plot_request request = {
        .results = l->settings.results, .x = option(c, "x"), .y = option(c, "y"), .by = option(c, "by")};
    TRY(take_format(c, &which));
    TRY(take_log(c, &request.log));
    if (studies_runs(l->studies, NULL))
        return api_refuse(c, 409, "a study is measuring, and drawing would disturb it",
                          "save the figure after it has ended, or stop it");
    if (!studies_begin_drawing(l->studies))
        return api_refuse(c, 409, "figures are already being drawn", "wait until they are finished");
    const status code = make_figure(c, s, &request, formats[which].format, &bytes, &size);
    studies_end_drawing(l->studies);
    return code == STATUS_OK ? api_send(c, formats[which].type, bytes, size) : code;
}

status api_study_figure(call *c)
{
    study *s;
    status code = api_take_study(c, &s);
    THEN(code, draw(c, s));
    study_destroy(s);
    return code;
}
