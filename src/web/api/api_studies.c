/* API: studies and their results: the section "Studies" of web/README.md; and the machine that they measure. */
#include "base/file.h"
#include "base/json_build.h"
#include "base/number.h"
#include "base/text.h"
#include "report/json.h"
#include "report/report.h"
#include "scene/model/params.h"
#include "study/rows/row_files.h"
#include "study/summary/summary.h"
#include "web/api/api.h"
#include "web/session/studies.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { STUDY_JSON_ROWS_MAX = 1000 };

/* --- studies as JSON. Values of rows and summaries are strings exactly as in the files, so no digit is lost. --- */

static const char *unit_of(const study *s, const char *path)
{
    param_place at;
    return param_place_find(s->base, path, &at, NULL) == STATUS_OK ? at.row->unit : "";
}

static json_t *axis_json(const study *s, const study_axis *axis)
{
    json_t *paths = json_array(), *units = json_array();
    int bad = 0;
    for (size_t i = 0; i < axis->points[0].count; i++) {
        bad |= json_array_append_new(paths, json_of_text(axis->points[0].paths[i]));
        bad |= json_array_append_new(units, json_of_text(unit_of(s, axis->points[0].paths[i])));
    }
    json_t *json = json_pack("{s:o, s:o, s:o, s:I}", "name", json_of_text(axis->name), "paths", paths, "units", units,
                             "count", (json_int_t)axis->count);
    return json_if(json, !bad);
}

/* Adds title, cells and axes: [{"name", "paths", "units", "count"}]; false when out of memory. */
static bool study_json_about(const study *s, json_t *into)
{
    json_t *axes = json_array();
    int bad = 0;
    for (size_t i = 0; i < s->axis_count; i++)
        bad |= json_array_append_new(axes, axis_json(s, &s->axes[i]));
    bad |= json_object_update_new(into, json_pack("{s:o, s:I, s:o}", "title", json_of_text(s->title), "cells",
                                                  (json_int_t)study_cell_count(s), "axes", axes));
    return !bad;
}

/* Splits a tab-separated line in place. */
static json_t *fields_json(char *line)
{
    json_t *fields = json_array();
    int bad = 0;
    for (char *field; (field = strsep(&line, "\t"));)
        bad |= json_array_append_new(fields, json_of_text(field));
    return json_if(fields, !bad);
}

static json_t *table_json(json_t *columns, json_t *rows, size_t count)
{
    return json_pack("{s:o, s:o, s:I}", "columns", columns, "rows", rows, "count", (json_int_t)count);
}

static json_t *lines_json(char *text)
{
    char *line = strsep(&text, "\n");
    json_t *columns = fields_json(line), *rows = json_array();
    size_t count = 0;
    int bad = 0;
    while ((line = strsep(&text, "\n")) && *line)
        if (count++ < STUDY_JSON_CELLS_MAX)
            bad |= json_array_append_new(rows, fields_json(line));
    return json_if(table_json(columns, rows, count), !bad);
}

/* The output of `cuvette study summary`, allocated memory; NULL without rows. */
static status study_summary_text(const study *s, const char *results, char **text, size_t *size, diagnostic *why)
{
    study_progress progress;
    *text = NULL;
    TRY(study_status(s, results, &progress, why));
    if (progress.rows == 0)
        return STATUS_OK;
    text_writer writer;
    TRY(text_writer_open(&writer, why));
    return text_writer_end(&writer, study_summary(s, results, writer.stream, why), text, size, why);
}

/* {"columns", "rows", "count"}: the output of `cuvette study summary`, limited to STUDY_JSON_CELLS_MAX cells; null
 * without rows. */
static status study_json_summary(const study *s, const char *results, json_t **out, diagnostic *why)
{
    char *text;
    *out = NULL;
    TRY(study_summary_text(s, results, &text, NULL, why));
    *out = text ? lines_json(text) : json_null();
    free(text);
    return *out ? STATUS_OK : out_of_memory(why);
}

/* The fields of a row, of any file, in these columns; source NULL: the names of the columns. */
static json_t *row_json(const csv *columns, const row_ref *source)
{
    json_t *row = json_array();
    int bad = 0;
    for (size_t i = 0; columns && i < columns->column_count; i++) {
        const char *name = columns->header[i];
        const int column = source && source->table != columns ? csv_column(source->table, name) : (int)i;
        bad |= json_array_append_new(row, json_of_text(source ? csv_field(source->table, source->row, column) : name));
    }
    return json_if(row, !bad);
}

/* {"columns", "rows", "count"}: the raw rows from row `from` on, at most STUDY_JSON_ROWS_MAX. */
static status study_json_rows(const study *s, const char *results, size_t from, json_t **out, diagnostic *why)
{
    row_files *files;
    *out = NULL;
    TRY(row_files_read(s, results, ROWS, &files, why));
    const csv *first = NULL;
    for (size_t i = 0; !first && i < files->count; i++)
        first = files->tables[i]->header ? files->tables[i] : NULL;
    json_t *rows = json_array();
    int bad = 0;
    for (size_t i = from; i < files->row_count && i - from < STUDY_JSON_ROWS_MAX; i++)
        bad |= json_array_append_new(rows, row_json(first, &files->rows[i]));
    *out = json_if(table_json(row_json(first, NULL), rows, files->row_count), !bad);
    row_files_destroy(files);
    return *out ? STATUS_OK : out_of_memory(why);
}

/* --- the list --- */

static void add_progress(const lab *l, const study *s, json_t **json)
{
    const char *results = l->settings.results;
    study_progress progress = {0};
    diagnostic why = {.what = ""};
    status code = study_check_results(l, results, s->name, &why);
    THEN(code, study_status(s, results, &progress, &why));
    json_add_all(json, json_pack("{s:I, s:I, s:I, s:I, s:I}", "cells_done", (json_int_t)progress.cells_done, "rows",
                                 (json_int_t)progress.rows, "warmups", (json_int_t)progress.warmups, "marked",
                                 (json_int_t)progress.rows_marked, "disturbed", (json_int_t)progress.rows_disturbed));
    if (code != STATUS_OK)
        json_add_as(json, "error", json_of_diagnostic(&why));
}

/* One study of the list; a study that cannot be read (s NULL) has its error. */
static json_t *study_json(const lab *l, const char *name, const char *file, const study *s, const diagnostic *why)
{
    json_t *json = json_pack("{s:o, s:o, s:b}", "name", json_of_text(name), "file", json_of_text(file), "running",
                             studies_runs(l->studies, name));
    if (json && s && study_json_about(s, json))
        add_progress(l, s, &json);
    if (json && !s)
        json_add_as(&json, "error", json_of_diagnostic(why));
    return json;
}

typedef struct listing {
    const lab *l;
    json_t *studies, *names; /* names: the studies so far, with their files */
} listing;

static bool list_study(void *context, const char *name, const char *file)
{
    listing *list = context;
    study *s = NULL;
    diagnostic why = {.what = ""};
    if (study_open(list->l, file, &s, &why) == STATUS_OK)
        name = s->name;
    const char *earlier = json_string_value(json_object_get(list->names, name));
    if (earlier) {
        diagnose(&why, STATUS_BAD_INPUT, "rename one of them", "the name is already used by %s", earlier);
        diagnostic_locate(&why, file, 0, 0);
    } else {
        json_object_set_new(list->names, name, json_string(file)); /* ignores names that are not UTF-8 */
    }
    json_add(&list->studies, study_json(list->l, name, file, earlier ? NULL : s, &why));
    study_destroy(s);
    return true;
}

status api_studies(call *c)
{
    const lab *l = c->l;
    listing list = {.l = l, .studies = json_array(), .names = json_object()};
    char *results = NULL;
    status code = study_each(l, list_study, &list, &c->why);
    THEN(code, folder_find(l->files, l->settings.results, &results, &c->why));
    api_reply_json(
        c, json_pack("{s:o, s:o}", "results", results ? json_of_text(results) : json_null(), "studies", list.studies));
    free(results);
    json_decref(list.names);
    return code;
}

/* Finds the study {name} of the path. *file is also set if the file exists but cannot be read. */
static status find_study(call *c, study **s, char **file)
{
    *s = NULL;
    *file = NULL;
    status code = study_find(c->l, http_path_value(c->request, "name"), file, &c->why);
    if (code == STATUS_OK && !*file)
        return api_refuse(c, 404, "no study has that name", "use a name that GET /api/studies lists");
    THEN(code, study_open(c->l, *file, s, &c->why));
    THEN(code, study_check_results(c->l, c->l->settings.results, (*s)->name, &c->why));
    if (code != STATUS_OK) {
        study_destroy(*s);
        *s = NULL;
    }
    return code;
}

status api_read_study(call *c, study **s)
{
    char *file;
    const status code = find_study(c, s, &file);
    free(file);
    return code;
}

/* Whether a run would write files; true also if existing files are damaged, since a run reports the damage. */
static status lacks_files(const lab *l, const study *s, bool *lacks, diagnostic *why)
{
    const status code = study_lacks_files(s, l->settings.results, lacks, why);
    *lacks |= code != STATUS_OK;
    return code == STATUS_BAD_INPUT ? STATUS_OK : code;
}

/* {"lacks_files", "runs", "figures", "drawable"}; s NULL, a study that cannot be read: false and empty lists. */
static status files_of(const lab *l, const study *s, json_t **out, diagnostic *why)
{
    json_t *runs = NULL, *figures = NULL, *drawable = NULL;
    bool lacks = false;
    status code = s ? lacks_files(l, s, &lacks, why) : STATUS_OK;
    if (s) {
        THEN(code, study_runs(l, s->name, &runs, why));
        THEN(code, figures_of(l, s->name, &figures, why));
        THEN(code, figures_drawable(l, s->name, &drawable, why));
    }
    *out = code != STATUS_OK
               ? NULL
               : json_pack("{s:b, s:o, s:o, s:o}", "lacks_files", lacks, "runs", s ? json_incref(runs) : json_array(),
                           "figures", s ? json_incref(figures) : json_array(), "drawable",
                           s ? json_incref(drawable) : json_array());
    json_decref(runs);
    json_decref(figures);
    json_decref(drawable);
    return *out || code != STATUS_OK ? code : out_of_memory(why);
}

/* A study that cannot be read is returned with its error. */
status api_study(call *c)
{
    const lab *l = c->l;
    study *s;
    char *file;
    status code = find_study(c, &s, &file);
    if (file && (code == STATUS_OK || code == STATUS_BAD_INPUT)) {
        json_t *json = study_json(l, http_path_value(c->request, "name"), file, s, &c->why), *summary = NULL,
               *lists = NULL;
        if (s && study_json_summary(s, l->settings.results, &summary, &c->why) != STATUS_OK)
            json_add_as(&json, "error", json_of_diagnostic(&c->why));
        json_add_as(&json, "summary", summary ? summary : json_null());
        if ((code = files_of(l, s, &lists, &c->why)) == STATUS_OK) {
            json_add_all(&json, lists);
            api_reply_json(c, json);
        } else {
            json_decref(json);
        }
    }
    study_destroy(s);
    free(file);
    return c->json ? STATUS_OK : code;
}

/* --- run and stop --- */

static status reply_run(call *c, status code)
{
    return code == STATUS_OK ? api_reply_json(c, studies_json(c->l->studies)) : code;
}

status api_study_run(call *c)
{
    study *s;
    TRY(api_read_study(c, &s));
    return reply_run(c, studies_start(c->l->studies, s, &c->why));
}

status api_study_stop(call *c)
{
    return reply_run(c, studies_stop(c->l->studies, http_path_value(c->request, "name"), &c->why));
}

/* --- results --- */

status api_study_rows(call *c)
{
    const char *text = http_query_value(c->request, "from");
    int64_t from = 0;
    study *s;
    if (text && (!number_parse_int(text, &from) || from < 0))
        return api_refuse(c, 400, "'from' is not a row number", "use ?from=N with N >= 0");
    status code = api_read_study(c, &s);
    THEN(code, study_json_rows(s, c->l->settings.results, (size_t)from, &c->json, &c->why));
    study_destroy(s);
    return code;
}

/* --- figures --- */

status api_figure(call *c)
{
    char *svg = NULL;
    size_t size = 0;
    const status code = figure_read(c->l, http_path_value(c->request, "name"), &svg, &size, &c->why);
    if (code == STATUS_BAD_INPUT)
        return api_refuse(c, 404, "no figure has that name", "use a name that GET /api/studies/{name} lists");
    return code == STATUS_OK ? api_send(c, "image/svg+xml", svg, size) : code;
}

static status draw(call *c, const study *s)
{
    lab *l = c->l;
    char *output = NULL;
    bool complete;
    if (studies_runs(l->studies, NULL))
        return api_refuse(c, 409, "a study is measuring, and drawing would disturb it",
                          "draw after the study has ended, or stop it");
    if (!studies_begin_drawing(l->studies))
        return api_refuse(c, 409, "figures are already being drawn", "wait until they are finished");
    json_t *figures = NULL;
    status code = figures_draw(l, s, &output, &complete, &c->why);
    studies_end_drawing(l->studies);
    THEN(code, figures_of(l, s->name, &figures, &c->why));
    if (code == STATUS_OK)
        api_reply_json(
            c, json_pack("{s:o, s:o, s:b}", "figures", figures, "said", json_of_text(output), "complete", complete));
    free(output);
    return code;
}

status api_study_draw(call *c)
{
    study *s;
    status code = api_read_study(c, &s);
    THEN(code, draw(c, s));
    study_destroy(s);
    return code;
}

/* --- the tables as files: the rows as on disk, the summary as `cuvette study summary` prints it --- */

enum { ROWS_MAX = 1 << 30 }; /* bytes */

static status refuse_without_rows(call *c)
{
    return api_refuse(c, 404, "the study has no rows yet", "measure it, or merge the rows of its shards, first");
}

status api_study_rows_csv(call *c)
{
    study *s;
    char *bytes = NULL;
    size_t size = 0;
    TRY(api_read_study(c, &s));
    char *path = text_format("%s/%s/rows.csv", c->l->settings.results, s->name);
    status code = path ? STATUS_OK : out_of_memory(&c->why);
    if (code == STATUS_OK && access(path, F_OK) != 0)
        code = refuse_without_rows(c);
    THEN(code, file_read_below(path, folder_real(c->l->files), ROWS_MAX, &bytes, &size, &c->why));
    free(path);
    study_destroy(s);
    return code == STATUS_OK ? api_send(c, "text/csv", bytes, size) : code;
}

status api_study_summary_tsv(call *c)
{
    study *s;
    char *text = NULL;
    size_t size = 0;
    TRY(api_read_study(c, &s));
    status code = study_summary_text(s, c->l->settings.results, &text, &size, &c->why);
    if (code == STATUS_OK && !text)
        code = refuse_without_rows(c);
    study_destroy(s);
    return code == STATUS_OK ? api_send(c, "text/tab-separated-values", text, size) : code;
}

/* --- the machine, as `cuvette machine` describes it --- */

status api_machine(call *c)
{
    machine_report report = {0};
    const status code = machine_measure(&report, &c->why);
    if (code == STATUS_OK)
        api_reply_json(c, machine_json(&report));
    machine_release(&report);
    return code;
}
