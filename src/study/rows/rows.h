/* The rows of a study, rows.csv and workers.csv, and the only code that writes them. Their columns are those of rows.c
 * and the quantities of job/quantities.h; results/README.md is their dictionary. Pure except for memory; a csv_buffer
 * that ran out of memory has failed set. */
#pragma once

#include "base/csv.h"
#include "job/quantities.h"
#include "study/study.h"

/* A name in angle brackets represents several columns: "<axis>" one for each path of the grid, "first_hits.<solid>" one
 * for each solid of the scene. */
typedef struct row_column {
    const char *name, *unit, *meaning;
} row_column;

/* Calls visit for each column of a table, in order. */
typedef void row_column_visitor(void *context, const row_column *column);
typedef void row_columns(row_column_visitor *visit, void *context);

row_columns row_each_column, worker_each_column;

/* One repetition. Everything is borrowed. */
typedef struct study_row {
    const study *s;
    size_t cell;
    long repetition; /* number in the cell, including warm-ups */
    bool warmup;
    size_t order; /* number in the file */
    uint64_t film_expected;
    noise_verdict disturbed;    /* by the study's rule */
    const char *run;            /* id of the run (study/rows/runs.h) */
    int process;                /* number of the process within the run, from 0 */
    const job_account *account; /* of the frame */
} study_row;

/* The version of the row format: 2 has identities, runs and checksums; earlier rows lack them. */
enum { ROW_SCHEMA = 2 };

/* Append a line of rows.csv; the lines of workers.csv, one per worker. The last field, checksum, is NA; run_append in
 * study/run/run_state.c fills in the checksums. */
void row_write(csv_buffer *line, const study_row *r);
void worker_rows_write(csv_buffer *line, const study_row *r);

/* Append a header line of these columns; the values of the grid's parameters, a field each; a quantity of a frame
 * (worker: -1) or of a worker. */
void row_columns_header(csv_buffer *line, const study *s, row_columns *each);
void row_put_axes(csv_buffer *line, const study *s, const scene *setting);
void row_put(csv_buffer *line, const quantity *q, const job_account *account, int worker);

/* The names and meanings of the columns at the end of every table. */
#define ROW_ORIGIN(X)                                                                                              \
    X("schema", "", "version of the row format", csv_count(line, ROW_SCHEMA))                                      \
    X("run", "", "id of the run, 16 hex digits; runs.json has its environment", csv_text(line, r->run))            \
    X("process", "", "number of the process within the run, from 0", csv_count(line, r->process))                  \
    X("checksum", "", "8 hex digits for the values of the row, 8 for its place after the previous row of its run", \
      csv_text(line, NULL))

/* "2026-01-31T12:00:00.250Z"; text holds ROW_TIME_MAX. */
enum { ROW_TIME_MAX = 32 };
char *row_time(int64_t ms, char text[ROW_TIME_MAX]);
