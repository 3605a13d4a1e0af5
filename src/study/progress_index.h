/* The measured repetitions by cell: read from the rows on disk, updated while a study runs. Ownership:
 * progress_index_read allocates, progress_index_destroy releases. */
#pragma once

#include "study/environment.h"
#include "study/study.h"

/* The film that a build of the program makes of the cells that share it. Another build may be an improvement. */
typedef struct progress_index_expected {
    uint64_t build, film_hash;
} progress_index_expected;

typedef struct progress_index_cell {
    size_t rows, counted, marked;  /* counted: repetitions of the environment that are not warm-ups; rows: all */
    size_t disturbed, undisturbed; /* of the counted rows; the others are not known */
    long next_repetition;          /* one more than the highest existing number */
    /* Of the first row of each build, stored at the first of the cells that share one film (study_cell_film). */
    progress_index_expected *film;
    size_t film_count;
    double *wall_s; /* of the counted rows */
} progress_index_cell;

typedef struct progress_index {
    const study *s;
    char environment[ENVIRONMENT_KEY]; /* whose rows count; "": all */
    long shard, shards;                /* as in the filter */
    progress_index_cell *cells;
    size_t cell_count, rows, marked, warmups, disturbed;
    size_t elsewhere;                       /* rows of other environments */
    size_t other_cells;                     /* rows of cells that the study does not have */
    size_t fault_count;                     /* rows that fail a check, or are missing (study/row_files.h) */
    diagnostic fault;                       /* the first one */
    char last_environment[ENVIRONMENT_KEY]; /* of the last row of another environment; "" without one */
} progress_index;

/* Adds a new row. */
typedef struct progress_index_entry {
    size_t cell;
    long repetition;
    bool warmup;
    noise_verdict disturbed;
    uint64_t film_hash, build;
    double wall_s;
    const char *environment;
    bool of_other_shard;
} progress_index_entry;

/* The rows that count. */
typedef struct progress_index_filter {
    const char *environment; /* the key of that whose rows count, or "" for all */
    long shard, shards;      /* shards > 1: only those of the shard's runs, and its part of the repetitions */
} progress_index_filter;
status progress_index_read(const study *s, const char *results, const progress_index_filter *filter,
                           progress_index **out, diagnostic *why);
/* The smallest and the largest number of repetitions of a cell: all, or the part of a shard. */
long progress_index_least(const progress_index *l);
long progress_index_most(const progress_index *l);
/* The least number, with a relative_width; otherwise the same. */
long progress_index_least(const progress_index *l);
status progress_index_add(progress_index *l, const progress_index_entry *entry, diagnostic *why);
void progress_index_destroy(progress_index *l);

/* The film hash that a cell must have: that of the first row by that build of all cells that share it, or film_hash if
 * there is none. progress_index_build: the present build. */
uint64_t progress_index_film(const progress_index *l, size_t cell, uint64_t build, uint64_t film_hash);
uint64_t progress_index_build(void);

/* Whether the cell has enough repetitions: the maximum, or at least the minimum and a sufficiently narrow interval. */
bool progress_index_cell_done(const progress_index *l, size_t cell);
