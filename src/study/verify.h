/* `study verify`: every row of a study checked, in rows.csv, workers.csv and compare.csv. */
#pragma once

#include "study/study.h"

typedef struct study_verdict {
    size_t rows, faults;
    diagnostic first; /* the first fault; what is empty without one */
} study_verdict;

/* Writes one line per issue, "FILE:LINE: KIND: TEXT", then one line for each environment, and a last line with the
 * number of rows. */
status study_verify(const study *s, const char *results, FILE *out, study_verdict *verdict, diagnostic *why);

/* What distinguishes the present environment from that of the last rows of another one; "" if unknown. */
void study_environment_difference(const study *s, const char *results, char *text, size_t size);
