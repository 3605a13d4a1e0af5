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

/* Checksums of rows: the column `checksum`, the last one of a new file. Eight hex digits hash the row's values by
 * column name; eight more hash these digits and the checksum of the previous row of the same run (for the first row,
 * the run's id). The first part detects an edited row, the second a row that was removed, inserted or moved. Both
 * ignore NA and the order of the columns, so that a file may get more columns. They detect accidents and careless
 * edits, not forgery. */

enum { CHECKSUM_TEXT = 17 };

/* Hashes of the names of a header's columns, without the column `checksum`; checksum_columns_free releases. */
typedef struct checksum_columns {
    uint64_t *name; /* 0: the column checksum */
    size_t count;
} checksum_columns;

status checksum_columns_create(char *const *names, size_t count, checksum_columns *out, diagnostic *why);
void checksum_columns_free(checksum_columns *c);

/* A hash of the values of a row, which has c->count fields; checksum_content is its upper half, the first part. */
uint64_t checksum_values(const checksum_columns *c, char *const *fields);
uint32_t checksum_content(const checksum_columns *c, char *const *fields);
/* The second part; previous: the text of the previous row's checksum, or the run's id for the first row. */
uint32_t checksum_chain(const char *previous, uint32_t content);
/* Write "1234567890abcdef", and read it; false if the text is not a checksum. */
void checksum_text(uint32_t content, uint32_t chain, char text[CHECKSUM_TEXT]);
bool checksum_parse(const char *text, uint32_t *content, uint32_t *chain);

/* Fills in the checksums of complete lines whose field checksum is NA, and updates previous. */
status checksum_lines(const checksum_columns *c, char previous[CHECKSUM_TEXT], csv_buffer *lines, diagnostic *why);
