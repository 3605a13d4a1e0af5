/* All rows of a study on disk: rows.csv and the files of shards, or the same of workers.csv or compare.csv, read and
 * checked. Equal rows in several files (after a merge) count once. Ownership: row_files_read gives, row_files_destroy
 * releases; results point into it. */
#pragma once

#include "study/csv.h"
#include "study/study.h"

typedef enum row_kind { ROWS, WORKER_ROWS, COMPARE_ROWS } row_kind;

typedef struct row_ref {
    const csv *table;
    size_t row;
    size_t cell;
    long repetition, worker; /* worker: 0 in rows.csv; compare.csv has no repetitions, workers or warm-ups */
    bool warmup;
} row_ref;

/* The row's value in the named column; "NA" and NaN if there is none. */
const char *row_field(const row_ref *ref, const char *name);
double row_field_real(const row_ref *ref, const char *name);

typedef struct row_files {
    char **paths; /* rows.csv first if it exists, then the shards in order */
    csv **tables;
    size_t count;
    row_ref *rows; /* in the order of the files */
    size_t row_count;
} row_files;

/* study_folder: results/<name>. row_file_path: the file of that kind in it, such as rows.csv, or
 * rows.shard-i-of-N.csv when shards > 1. Fresh memory, or NULL. */
char *study_folder(const study *s, const char *results);
char *row_file_path(const char *folder, row_kind kind, long shard, long shards);
/* The header line of files of that kind; fresh memory, or NULL. */
char *row_file_header(const study *s, row_kind kind);

/* Columns are identified by name; files of other versions of the program are read as well. STATUS_BAD_INPUT if a file
 * is damaged or lacks an identifying column, if rows have another meaning than the study (study/accepted.h), or if two
 * files have one repetition with different values. Worker rows whose repetition has no row (the process was killed
 * between the two) are dropped. */
status row_files_read(const study *s, const char *results, row_kind kind, row_files **out, diagnostic *why);
void row_files_destroy(row_files *files);
