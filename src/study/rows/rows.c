/* Writes rows.csv and workers.csv; name, unit, meaning and value of each column are defined in one place. */
#include "study/rows/rows.h"
#include "base/text.h"
#include "scene/model/open.h"
#include "scene/model/params.h"
#include "study/plan/grid.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

char *row_time(int64_t ms, char text[ROW_TIME_MAX])
{
    const int64_t part = (ms % 1000 + 1000) % 1000; /* a clock may be before 1970 */
    time_t seconds = (time_t)((ms - part) / 1000);
    struct tm utc;
    gmtime_r(&seconds, &utc);
    size_t size = strftime(text, ROW_TIME_MAX, "%Y-%m-%dT%H:%M:%S", &utc);
    snprintf(text + size, ROW_TIME_MAX - size, ".%03dZ", (int)part);
    return text;
}

void row_put_axes(csv_buffer *line, const study *s, const scene *setting)
{
    const char *path;
    for (size_t i = 0; (path = study_grid_path(s, i)); i++) {
        char *value = NULL;
        line->failed |= scene_get(setting, path, &value, NULL) == STATUS_FAILURE; /* out of memory */
        csv_text(line, value);
        free(value);
    }
}

/* "480000;95458;...": from depth 0 to the last depth with a ray. */
static void put_by_depth(csv_buffer *line, const quantity_value *v)
{
    char text[(COUNTERS_DEPTH_MAX + 1) * 21 + 1];
    size_t last = v->size - 1, size = 0;
    while (last > 0 && v->list[last] == 0)
        last--;
    for (size_t depth = 0; depth <= last; depth++)
        size += (size_t)snprintf(text + size, sizeof text - size, depth ? ";%" PRIu64 : "%" PRIu64, v->list[depth]);
    csv_text(line, text);
}

void row_put(csv_buffer *line, const quantity *q, const job_account *account, int worker)
{
    const quantity_value v = q->read(account, worker);
    switch (q->type) {
    case QUANTITY_COUNT:
    case QUANTITY_NUMBER:
    case QUANTITY_TRUTH: csv_count(line, v.count); break;
    case QUANTITY_REAL:
    case QUANTITY_COLOR: csv_real(line, v.real[0]); break;
    case QUANTITY_HASH: csv_hash(line, v.hash); break;
    case QUANTITY_WORD: csv_text(line, v.word); break;
    case QUANTITY_DEPTHS: put_by_depth(line, &v); break;
    case QUANTITY_SOLIDS:
        for (size_t i = 0; i < scene_solid_count(account->of); i++)
            csv_count(line, i < v.size ? (int64_t)v.list[i] : -1);
        break;
    }
}

static void put_time(csv_buffer *line, const study_row *r)
{
    char text[ROW_TIME_MAX];
    csv_text(line, row_time(r->account->ended_ms, text));
}

static void put_verdict(csv_buffer *line, noise_verdict verdict)
{
    if (verdict == NOISE_NOT_KNOWN)
        csv_text(line, NULL);
    else
        csv_count(line, verdict == NOISE_DISTURBED);
}

/* The columns that are not in job/quantities.h: name, unit, meaning and writer in one place, so that header, dictionary
 * and row always agree. The last macro argument uses line and r (the row). */
#define CELL_COLUMNS(X)                                                                                              \
    X("study", "", "name of the study", csv_text(line, r->s->name))                                                  \
    X("identity", "", "hash of everything that determines the cell's film and measurement, 16 hex digits",           \
      csv_hash(line, r->s->identity[r->cell]))                                                                       \
    X("cell", "", "number of the grid point when it was measured, the last axis fastest",                            \
      csv_count(line, (int64_t)r->cell))                                                                             \
    X("repetition", "", "number of the frame in the cell, from 0, including warm-ups; a resumed run warms up again", \
      csv_count(line, r->repetition))                                                                                \
    X("warmup", "", "1: warm-up, before the cell's first measured frame in its process; not in summaries",           \
      csv_count(line, r->warmup))

#define ORDER_COLUMNS(X)                                                                 \
    X("order", "", "running number of the row in the file that it was first written to", \
      csv_count(line, (int64_t)r->order))                                                \
    X("time_utc", "", "end of the frame, ISO 8601", put_time(line, r))

#define AXIS_COLUMNS(X)                                                                  \
    X("<axis>", "of the parameter", "value of each parameter of the grid, in its order", \
      row_put_axes(line, r->s, r->account->of))

/* Columns after film_hash. */
#define FILM_COLUMNS(X)                                                                                                \
    X("film_expected", "",                                                                                             \
      "film_hash of the first row of all cells that must have the same film, because they differ only in performance " \
      "parameters (threads, pool, schedule, tile, pin, hierarchies)",                                                  \
      csv_hash(line, r->film_expected))                                                                                \
    X("marked", "", "1: film_hash differs from film_expected; do not use this row",                                    \
      csv_count(line, job_account_hash(r->account) != r->film_expected))                                               \
    X("disturbed", "",                                                                                                 \
      "1: others_fraction, steal_fraction, frequency_drop or stalled_fraction exceeded its bound (key "                \
      "disturbed of the study) when the row was measured; summaries apply the present bounds",                         \
      put_verdict(line, r->disturbed))

/* The columns before film_hash. */
#define LEADING_COLUMNS(X) CELL_COLUMNS(X) ORDER_COLUMNS(X) AXIS_COLUMNS(X)

#define DESCRIBE(name, unit, meaning, put) visit(context, &(row_column){name, unit, meaning});
#define PUT(name, unit, meaning, put) put;

static void visit_quantity(const quantity *q, row_column_visitor *visit, void *context)
{
    char name[64];
    snprintf(name, sizeof name, q->type == QUANTITY_SOLIDS ? "%s.<solid>" : "%s", q->name);
    if (q->column)
        visit(context, &(row_column){name, q->unit, q->meaning});
}

static void visit_leading_columns(row_column_visitor *visit, void *context)
{
    LEADING_COLUMNS(DESCRIBE)
}

static void visit_film_columns(row_column_visitor *visit, void *context)
{
    FILM_COLUMNS(DESCRIBE)
}

static void visit_origin(row_column_visitor *visit, void *context)
{
    ROW_ORIGIN(DESCRIBE)
}

void row_each_column(row_column_visitor *visit, void *context)
{
    visit_leading_columns(visit, context);
    for (size_t i = 0; i < frame_quantity_count; i++) {
        visit_quantity(&frame_quantities[i], visit, context);
        if (i == 0)
            visit_film_columns(visit, context);
    }
    visit_origin(visit, context);
}

void worker_each_column(row_column_visitor *visit, void *context)
{
    CELL_COLUMNS(DESCRIBE)
    AXIS_COLUMNS(DESCRIBE)
    for (size_t i = 0; i < worker_quantity_count; i++)
        visit_quantity(&worker_quantities[i], visit, context);
    visit_origin(visit, context);
}

typedef struct header {
    csv_buffer *line;
    const study *s;
} header;

static void put_name(void *context, const row_column *column)
{
    const header *h = context;
    csv_buffer *line = h->line;
    const char *name = column->name, *bracket = strchr(name, '<'), *path;
    if (!bracket) {
        csv_text(line, name);
    } else if (strcmp(bracket, "<axis>") == 0) {
        for (size_t k = 0; (path = study_grid_path(h->s, k)); k++)
            csv_text(line, path);
    } else {
        for (size_t k = 0; k < scene_solid_count(h->s->base); k++) {
            char *text = text_format("%.*s%s", (int)(bracket - name), name, scene_solid_name(h->s->base, (int)k));
            line->failed |= !text;
            csv_text(line, text);
            free(text);
        }
    }
}

void row_columns_header(csv_buffer *line, const study *s, row_columns *each)
{
    each(put_name, &(header){line, s});
    csv_end(line);
}

static void put_leading_columns(csv_buffer *line, const study_row *r)
{
    LEADING_COLUMNS(PUT)
}

static void put_film_columns(csv_buffer *line, const study_row *r)
{
    FILM_COLUMNS(PUT)
}

static void put_origin(csv_buffer *line, const study_row *r)
{
    ROW_ORIGIN(PUT)
}

void row_write(csv_buffer *line, const study_row *r)
{
    put_leading_columns(line, r);
    for (size_t i = 0; i < frame_quantity_count; i++) {
        if (frame_quantities[i].column)
            row_put(line, &frame_quantities[i], r->account, -1);
        if (i == 0)
            put_film_columns(line, r);
    }
    put_origin(line, r);
    csv_end(line);
}

void worker_rows_write(csv_buffer *line, const study_row *r)
{
    for (int worker = 0; worker < r->account->result->worker_count; worker++) {
        CELL_COLUMNS(PUT)
        AXIS_COLUMNS(PUT)
        for (size_t i = 0; i < worker_quantity_count; i++)
            if (worker_quantities[i].column)
                row_put(line, &worker_quantities[i], r->account, worker);
        put_origin(line, r);
        csv_end(line);
    }
}
