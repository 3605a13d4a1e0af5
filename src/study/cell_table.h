/* Lines of a table that is kept of each cell: study, cell and the cell's values of the grid in front, so that the
 * tables of all cells can be strung together. Tab separated, NA for what there is none of. Errors stay in the stream.
 */
#ifndef CUVETTE_STUDY_CELL_TABLE_H
#define CUVETTE_STUDY_CELL_TABLE_H

#include "study/study.h"
#include <stdio.h>

/* The whole first line; rest: the other columns' names. */
void cell_table_header(const study *s, const char *rest, FILE *out);
/* A line's beginning, up to the grid's last value. */
void cell_table_begin(const study *s, size_t cell, FILE *out);
/* A tab and a number, with as many digits as read back the same. */
void cell_table_number(FILE *out, double value);

#endif
