/* Studies as JSON: axes of the grid, summaries and rows. */
#include "web/api/study_json.h"
#include "base/text.h"
#include "report/json.h"
#include "scene/model/params.h"
#include "study/rows/row_files.h"
#include "study/summary/summary.h"
#include <stdlib.h>
#include <string.h>

/* --- the definition --- */

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

bool study_json_about(const study *s, json_t *into)
{
    json_t *axes = json_array();
    int bad = 0;
    for (size_t i = 0; i < s->axis_count; i++)
        bad |= json_array_append_new(axes, axis_json(s, &s->axes[i]));
    bad |= json_object_update_new(into, json_pack("{s:o, s:I, s:o}", "title", json_of_text(s->title), "cells",
                                                  (json_int_t)study_cell_count(s), "axes", axes));
    return !bad;
}

/* --- tables --- */

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

status study_summary_text(const study *s, const char *results, char **text, size_t *size, diagnostic *why)
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

status study_json_summary(const study *s, const char *results, json_t **out, diagnostic *why)
{
    char *text;
    *out = NULL;
    TRY(study_summary_text(s, results, &text, NULL, why));
    *out = text ? lines_json(text) : json_null();
    free(text);
    return *out ? STATUS_OK : out_of_memory(why);
}

/* The column names, or the fields of one row (of any file) in these columns. */
static json_t *row_json(const csv *columns, const row_ref *of)
{
    json_t *row = json_array();
    int bad = 0;
    for (size_t i = 0; columns && i < columns->column_count; i++) {
        const char *name = columns->header[i];
        const int column = of && of->table != columns ? csv_column(of->table, name) : (int)i;
        bad |= json_array_append_new(row, json_of_text(of ? csv_field(of->table, of->row, column) : name));
    }
    return json_if(row, !bad);
}

status study_json_rows(const study *s, const char *results, size_t from, json_t **out, diagnostic *why)
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
