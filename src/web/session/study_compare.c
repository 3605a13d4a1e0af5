/* Compares two runs of one study, cell by cell. */
#include "measure/statistics.h"
#include "report/json.h"
#include "study/excluded.h"
#include "study/row_files.h"
#include "study/grid.h"
#include "web/api/study_json.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The rows of one run, sorted by cell. */
typedef struct sorted_rows {
    row_files *files;
    excluded *without;
    size_t at; /* the first row of the next cell */
    double *values;
} sorted_rows;

typedef struct cell_times {
    summary wall;
    const char *film; /* NULL without a row */
} cell_times;

static int compare_places(const void *a, const void *b)
{
    const row_ref *x = a, *y = b;
    if (x->cell != y->cell)
        return x->cell < y->cell ? -1 : 1;
    if (x->table != y->table)
        return x->table < y->table ? -1 : 1;
    return (x->row > y->row) - (x->row < y->row);
}

static status sort_rows(const study *s, const char *results, sorted_rows *out, diagnostic *why)
{
    *out = (sorted_rows){0};
    TRY(row_files_read(s, results, ROWS, &out->files, why));
    TRY(excluded_read(s, results, &out->without, why));
    qsort(out->files->rows, out->files->row_count, sizeof *out->files->rows, compare_places);
    out->values = malloc((out->files->row_count + 1) * sizeof *out->values);
    return out->values ? STATUS_OK : out_of_memory(why);
}

static void release(sorted_rows *rows)
{
    excluded_destroy(rows->without);
    row_files_destroy(rows->files);
    free(rows->values);
}

/* As in a summary: without warm-up rows, marked and excluded rows. */
static cell_times take_cell(sorted_rows *rows, size_t cell)
{
    size_t count = 0;
    const char *film = NULL;
    for (; rows->at < rows->files->row_count && rows->files->rows[rows->at].cell == cell; rows->at++) {
        const row_ref *ref = &rows->files->rows[rows->at];
        film = film ? film : row_field(ref, "film_expected");
        const double wall_s = row_field_real(ref, "wall_s");
        if (!ref->warmup && strcmp(row_field(ref, "marked"), "0") == 0 && !isnan(wall_s) &&
            !excluded_has(rows->without, ref))
            rows->values[count++] = wall_s;
    }
    return (cell_times){summarize(rows->values, count), film};
}

static json_t *times_json(const cell_times *t)
{
    return json_pack("{s:o, s:o, s:o, s:I}", "median", json_of_real(t->wall.median), "low",
                     json_of_real(t->wall.median_low), "high", json_of_real(t->wall.median_high), "n",
                     (json_int_t)t->wall.count);
}

static json_t *cell_json(const study *s, size_t cell, const cell_times *a, const cell_times *b)
{
    json_t *json = json_pack("{s:I}", "cell", (json_int_t)cell);
    for (size_t axis = 0; axis < s->axis_count; axis++) {
        const study_point *point = &s->axes[axis].points[study_cell_point(s, cell, axis)];
        for (size_t i = 0; i < point->count; i++)
            json_object_set_new(json, point->paths[i], json_of_text(point->values[i]));
    }
    json_object_update_new(json,
                           json_pack("{s:o, s:o, s:o, s:o}", "a", times_json(a), "b", times_json(b), "ratio",
                                     json_of_real(b->wall.median / a->wall.median), "same_film",
                                     a->film && b->film ? json_boolean(strcmp(a->film, b->film) == 0) : json_null()));
    return json;
}

static json_t *paths_json(const study *s)
{
    json_t *paths = json_array();
    const char *path;
    for (size_t i = 0; (path = study_grid_path(s, i)); i++)
        json_array_append_new(paths, json_of_text(path));
    return paths;
}

status study_json_compare(const study *s, const char *results, const char *other, json_t **out, diagnostic *why)
{
    sorted_rows a = {0}, b = {0};
    *out = NULL;
    status code = sort_rows(s, results, &a, why);
    THEN(code, sort_rows(s, other, &b, why));
    json_t *cells = code == STATUS_OK ? json_array() : NULL;
    for (size_t cell = 0; cells && cell < study_cell_count(s) && cell < STUDY_JSON_CELLS_MAX; cell++) {
        const cell_times times_a = take_cell(&a, cell), times_b = take_cell(&b, cell);
        json_array_append_new(cells, cell_json(s, cell, &times_a, &times_b));
    }
    if (cells && !(*out = json_pack("{s:o, s:o, s:I}", "columns", paths_json(s), "cells", cells, "count",
                                    (json_int_t)study_cell_count(s))))
        code = out_of_memory(why);
    else if (code == STATUS_OK && !cells)
        code = out_of_memory(why);
    release(&a);
    release(&b);
    return code;
}
