/* All rows of a study on disk: rows.csv and the files of its shards, or likewise workers.csv or compare.csv, read and
 * verified. Equal rows in several files (after a merge) count once. Rows that cannot be trusted are left out and listed
 * as issues; rows of cells that the study does not have (any more) are left out and counted. Ownership:
 * row_files_destroy releases what row_files_read returns; other results point into it. */
#pragma once

#include "base/csv.h"
#include "study/rows/runs.h"
#include "study/study.h"

typedef enum row_kind { ROWS, WORKER_ROWS, COMPARE_ROWS } row_kind;

typedef struct row_ref {
    const csv *table;
    size_t row;
    size_t cell;             /* in the study as it is now */
    long repetition, worker; /* worker: 0 in rows.csv; compare.csv has no repetitions, workers or warm-ups */
    long run;                /* index in row_files.runs; below 0: the row has no known run */
    bool warmup;
    char environment[ENVIRONMENT_KEY]; /* 8 hex digits, or "unknown" */
} row_ref;

/* The row's value in the named column; "NA" and NaN if there is none. For many rows, look the column up once. */
const char *row_field(const row_ref *ref, const char *name);
double row_field_real(const row_ref *ref, const char *name);
/* The key of the row's environment, 8 hex digits, or "unknown". */
const char *row_environment(const row_ref *ref);

/* What is wrong with a row, or between rows. */
typedef enum row_fault {
    ROW_TORN,      /* an incomplete last line: the process was killed while writing it; not a problem */
    ROW_MARKED,    /* its film differs from the expected one; the row is in the list, with column marked = 1 */
    ROW_DAMAGED,   /* not a row: wrong number of fields, or values of a wrong type or out of range */
    ROW_EDITED,    /* its values do not agree with its checksum */
    ROW_MISPLACED, /* rows before it were removed, inserted or moved; the row itself is intact and in the list */
    ROW_MISSING,   /* rows at the end of a run are missing */
    ROW_DUPLICATE, /* the same repetition twice in one file, or with different values */
    ROW_DIFFERS,   /* a quantity that does not depend on the machine differs from the other rows of the cell */
    ROW_UNKNOWN    /* its run is not in runs.json, or the run's environment there was edited */
} row_fault;
typedef struct row_issue {
    row_fault fault;
    const char *path;
    long line; /* 0: the issue is not about one line */
    char text[200];
} row_issue;

typedef struct row_files {
    char **paths; /* rows.csv first if it exists, then the shards in order */
    csv **tables;
    size_t count;
    row_ref *rows; /* in the order of the files */
    size_t row_count;
    run_list *runs;
    row_issue *issues;
    size_t issue_count, fault_count; /* fault_count: issues other than ROW_TORN */
    size_t other_cells;              /* rows of cells that the study does not have */
} row_files;

/* row_file_path: the file of that kind in the folder of a study, such as rows.csv, or rows.shard-i-of-N.csv when
 * shards > 1; fresh memory, or NULL. row_file_stem: "rows", "workers", "compare". */
char *row_file_path(const char *folder, row_kind kind, long shard, long shards);
const char *row_file_stem(row_kind kind);
/* The header line of files of that kind; fresh memory, or NULL. */
char *row_file_header(const study *s, row_kind kind);

/* The existing files of that kind: rows.csv first, then the shards in order. The caller frees each and the array. */
status row_files_list(const char *folder, row_kind kind, char ***paths, size_t *count, diagnostic *why);

/* Columns are identified by name; files of other versions of the program are read as well. STATUS_BAD_INPUT if a file
 * lacks a required column or is of another study. Worker rows whose repetition has no row (the process was killed
 * between the two) are dropped. */
status row_files_read(const study *s, const char *results, row_kind kind, row_files **out, diagnostic *why);
void row_files_destroy(row_files *files);

/* Adds an issue; format as printf. */
__attribute__((format(printf, 5, 6))) status row_files_add_issue(row_files *files, row_fault fault, const char *path,
                                                                 long line, const char *format, ...);
/* Reports the first fault and the number of the others as STATUS_FAILURE, for commands to print; STATUS_OK without
 * faults. */
status row_files_judge(const row_files *files, diagnostic *why);

/* The environments of the rows, in the order of the first row of each; the caller frees the array. */
typedef struct row_environment_count {
    char key[ENVIRONMENT_KEY];
    size_t rows;          /* without warm-ups */
    const run_entry *run; /* its last run in row_files.runs, or NULL */
} row_environment_count;
status row_environments_find(const row_files *files, row_environment_count **out, size_t *count, diagnostic *why);
/* The key that an option chooses: "" for NULL, the key of row_environments_main for "main", otherwise the text.
 * STATUS_BAD_INPUT if no row is of that environment. */
status row_environments_choose(const row_files *files, const char *text, char key[ENVIRONMENT_KEY], diagnostic *why);
/* The key of the environment with most rows, the last among equals; "" without rows. */
status row_environments_main(const row_files *files, char key[ENVIRONMENT_KEY], diagnostic *why);

/* --- row_check.c: missing columns, and checks of rows against each other, across files; for row_read.c --- */

/* Fails if a file lacks a required column (`needed` in row_check.c). Other columns may be missing or added, in any
 * order. */
status row_check_columns(const csv *table, const char *path, row_kind kind, diagnostic *why);

/* Drops the later of two rows of one repetition (and worker). Unless it is the same row in another file, that is an
 * issue. */
status row_check_drop_twins(row_files *files, diagnostic *why);

/* Drops worker rows whose repetition has no row: the process was killed between the two writes. */
status row_check_drop_orphans(row_files *workers, const row_files *rows, diagnostic *why);

/* Quantities that depend only on the scene (QUANTITY_SAME) must be equal in all unmarked rows of a cell in one
 * environment: drops the rows that differ from most others, as issues. Marked rows become issues and stay. */
status row_check_quantities(row_files *files, diagnostic *why);

/* Which rows summaries use: no warm-ups, no marked rows, and none that a person excluded. results/<study>/excluded.csv
 * has a line with the reason for each excluded row, and is only ever appended to. Excluded rows stay in rows.csv and
 * count as measured, so that an unwelcome value cannot be measured again. Ownership: excluded_destroy releases what
 * excluded_read allocates. */

typedef struct excluded excluded;

/* A study without the file has an empty list. STATUS_BAD_INPUT, located in the file, if it is damaged. */
status excluded_read(const study *s, const char *results, excluded **out, diagnostic *why);
void excluded_destroy(excluded *list);

/* Whether the row is excluded. A line names its row by its checksum, or by its cell's identity, run, process
 * and repetition. A list that a person wrote may have only cell and repetition: then a line is for every row that has
 * these numbers in rows.csv, whatever the grid is now. */
bool excluded_has(const excluded *list, const row_ref *row);

/* Whether a row counts in summaries, and why not: a warm-up; its film is not the expected one; a person excluded it. */
typedef enum row_use { ROW_COUNTS, ROW_IS_WARMUP, ROW_IS_MARKED, ROW_IS_EXCLUDED } row_use;
row_use row_use_of(const excluded *without, const row_ref *row);

/* The number of lines of the list. */
size_t excluded_count(const excluded *list);

/* Appends the row, "CELL:REPETITION" or its checksum, and flushes the file to disk. CELL is the row's column in
 * rows.csv. STATUS_BAD_INPUT if no row or more than one matches, if CELL is another row's number in the present grid,
 * if the row is a warm-up or is excluded already, or if the reason is not one line of at most 500 characters. */
status excluded_add(const study *s, const char *results, const char *row, const char *reason, diagnostic *why);
