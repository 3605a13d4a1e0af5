/* The summary of a study for people: the few columns that one looks at first, aligned. Programs read the whole one,
 * tab separated (study/summary.h). */
#ifndef CUVETTE_CLI_STUDY_TABLE_H
#define CUVETTE_CLI_STUDY_TABLE_H

#include "base/status.h"
#include <stdio.h>

/* Cell, axes, n, median and 95% interval of the wall time, median of the CPU time, rays and marked rows, from the text
 * that study_summary writes; tsv is cut apart in the course of it. */
status study_table_print(FILE *out, char *tsv, diagnostic *why);

#endif
