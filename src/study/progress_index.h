/* The measured repetitions by cell: read from the rows on disk, updated while a study runs. Ownership:
 * progress_index_read allocates, progress_index_destroy releases. */
#pragma once

#include "study/study.h"

typedef struct progress_index_cell {
    size_t rows, counted, marked; /* counted: repetitions that are not warm-ups */
    long next_repetition;         /* one more than the highest existing number */
    bool film_known;              /* stored at the first of the cells that share one film (study_cell_film): */
    uint64_t film_expected;       /* film hash of their first row */
    double *wall_s;               /* of the counted rows */
} progress_index_cell;

typedef struct progress_index {
    const study *s;
    progress_index_cell *cells;
    size_t cell_count, rows, marked;
} progress_index;

/* Adds a new row. */
typedef struct progress_index_entry {
    size_t cell;
    long repetition;
    bool warmup;
    uint64_t film_hash;
    double wall_s;
} progress_index_entry;

status progress_index_read(const study *s, const char *results, progress_index **out, diagnostic *why);
status progress_index_add(progress_index *l, const progress_index_entry *entry, diagnostic *why);
void progress_index_destroy(progress_index *l);

/* The film hash that a cell must have: that of the first row of all cells that share it, or film_hash if there is none.
 * */
uint64_t progress_index_film(const progress_index *l, size_t cell, uint64_t film_hash);

/* Whether the cell has enough repetitions: the maximum, or at least the minimum and a sufficiently narrow interval. */
bool progress_index_cell_done(const progress_index *l, size_t cell);
