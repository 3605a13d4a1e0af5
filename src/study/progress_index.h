/* What has been measured so far, by cell: read from the rows on disk, kept up to date while a study runs.
 * Ownership: progress_index_read gives, progress_index_destroy releases. */
#pragma once

#include "study/study.h"

typedef struct progress_index_cell {
    size_t rows, counted, marked; /* counted: those that are no warm-ups */
    long next_repetition;         /* after the highest one that is there */
    bool film_known;              /* of those that share one film (study_cell_film) the first cell keeps it: */
    uint64_t film_expected;       /* that of their first row */
    double *wall_s;               /* of the counted rows */
} progress_index_cell;

typedef struct progress_index {
    const study *s;
    progress_index_cell *cells;
    size_t cell_count, rows, marked;
} progress_index;

/* What a new row says. */
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

/* The film that a cell must have: that of the first row of all cells that share it, or film_hash when there is none. */
uint64_t progress_index_film(const progress_index *l, size_t cell, uint64_t film_hash);

/* Has the cell its repetitions: the most there may be, or the least there must be and an interval as narrow as
 * asked for? */
bool progress_index_cell_done(const progress_index *l, size_t cell);
