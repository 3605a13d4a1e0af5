/* One row file: its lines to row_refs, with the checks of single rows and of their chain. For study/row_files.c. */
#pragma once

#include "study/row_files.h"

/* From the identities of a study's cells to their numbers. Without a known grid (study.identity is NULL) every identity
 * is a cell, and its own number. row_cells_free releases. */
typedef struct row_cells {
    bool any;
    struct row_cell {
        uint64_t identity;
        size_t cell;
    } * sorted;
    size_t count;
} row_cells;
status row_cells_create(const study *s, row_kind kind, row_cells *out, diagnostic *why);
void row_cells_free(row_cells *c);

/* What is known of the rows of a run while files are read. */
typedef struct row_chain {
    size_t rows, most;              /* in the current file; in any file */
    char last[RUN_ID], end[RUN_ID]; /* the last check in the current file; that of the file with the most rows */
} row_chain;

typedef struct row_reader {
    const study *s;
    row_kind kind;
    row_files *into;
    row_cells cells;
    row_chain *chain; /* of each run */
} row_reader;

/* Appends the usable rows of a table to into->rows, which has room, and issues about the others. */
status row_read_table(row_reader *r, const csv *table, const char *path, diagnostic *why);
/* Adds issues for rows missing at the end of runs, after all tables were read. */
status row_read_seals(row_reader *r, diagnostic *why);
