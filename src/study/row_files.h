/* All the rows of a study that are on disk: rows.csv and the shards' files, or the same of workers.csv or compare.csv,
 * read and checked. Rows that several files hold alike (after a merge) count once. Ownership: row_files_read gives,
 * row_files_destroy releases; what it gives points into it. */
#pragma once

#include "study/csv.h"
#include "study/study.h"

typedef enum row_kind { ROWS, WORKER_ROWS, COMPARE_ROWS } row_kind;

typedef struct row_ref {
    const csv *table;
    size_t row;
    size_t cell;
    long repetition, worker; /* worker: 0 in rows.csv; compare.csv has neither, nor warm-ups */
    bool warmup;
} row_ref;

/* What the row has in the column of that name; "NA" and NaN where there is none. */
const char *row_field(const row_ref *ref, const char *name);
double row_field_real(const row_ref *ref, const char *name);

typedef struct row_files {
    char **paths; /* rows.csv first if it is there, then the shards in order */
    csv **tables;
    size_t count;
    row_ref *rows; /* in the files' order */
    size_t row_count;
} row_files;

/* results/<name>; results/<name>/rows.csv, or rows.shard-i-of-N.csv when shards > 1. Fresh memory, or NULL. */
char *study_folder(const study *s, const char *results);
char *row_file_path(const char *folder, row_kind kind, long shard, long shards);
/* The header line of that kind of file; fresh memory, or NULL. */
char *row_file_header(const study *s, row_kind kind);

/* Columns are known by their names; those of another version of the program are read too. STATUS_BAD_INPUT when a file
 * is damaged or lacks a column that says of what its rows are, when rows mean something else than the study does
 * (study/accepted.h), or when one repetition stands in two files with different values. Worker rows whose repetition
 * has no row (a process was killed between the two) are left out. */
status row_files_read(const study *s, const char *results, row_kind kind, row_files **out, diagnostic *why);
void row_files_destroy(row_files *files);
