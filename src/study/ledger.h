/* What has been measured so far, by cell: read from the rows on disk, kept up to date while a study runs.
 * Ownership: ledger_read gives, ledger_destroy releases. */
#pragma once

#include "study/study.h"

typedef struct ledger_cell {
    size_t rows, counted, marked; /* counted: those that are no warm-ups */
    long next_repetition;         /* after the highest one that is there */
    bool film_known;              /* of those that share one film (study_cell_film) the first cell keeps it: */
    uint64_t film_expected;       /* that of their first row */
    double *wall_s;               /* of the counted rows */
} ledger_cell;

typedef struct ledger {
    const study *s;
    ledger_cell *cells;
    size_t cell_count, rows, marked;
} ledger;

/* What a new row says. */
typedef struct ledger_entry {
    size_t cell;
    long repetition;
    bool warmup;
    uint64_t film_hash;
    double wall_s;
} ledger_entry;

status ledger_read(const study *s, const char *results, ledger **out, diagnostic *why);
status ledger_add(ledger *l, const ledger_entry *entry, diagnostic *why);
void ledger_destroy(ledger *l);

/* The film that a cell must have: that of the first row of all cells that share it, or film_hash when there is none. */
uint64_t ledger_film(const ledger *l, size_t cell, uint64_t film_hash);

/* Has the cell its repetitions: the most there may be, or the least there must be and an interval as narrow as
 * asked for? */
bool ledger_cell_done(const ledger *l, size_t cell);
