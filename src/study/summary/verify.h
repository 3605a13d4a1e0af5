/* Verification of rows: `study verify` verifies every row in rows.csv, workers.csv and compare.csv, and `study films`
 * compares films and ray counts with those of another results folder, cell by cell, to see whether another machine or
 * build computes the same. Ownership: study_films_release frees the list. */
#pragma once

#include "study/study.h"

typedef struct study_verdict {
    size_t rows, faults;
    diagnostic first; /* the first fault; what is empty without one */
} study_verdict;

/* Writes one line per issue, "FILE:LINE: KIND: TEXT"; after the issues of rows.csv, one line for each environment; and
 * last a line with the numbers of rows and faults. */
status study_verify(const study *s, const char *results, FILE *out, study_verdict *verdict, diagnostic *why);

/* The differences between the present environment and the environment of the latest rows that were measured in another
 * one; "" if there are no such rows, or if they cannot be read. */
void study_environment_difference(const study *s, const char *results, char *text, size_t size);

typedef struct study_films {
    size_t compared, same; /* cells with rows in both folders, and those with one film and equal counts in all rows */
    size_t distinct;       /* number of different films of the compared cells */
    size_t *different;     /* cells, in order */
    size_t different_count;
    bool other_processor; /* the rows of the two folders are of unlike processors */
    char processor[160];  /* of the folder `against`; "unknown" if it has no run */
} study_films;

/* Rows that cannot be trusted (study/rows/row_files.h) are left out; marked ones are not. */
status study_films_compare(const study *s, const char *results, const char *against, study_films *out, diagnostic *why);
void study_films_release(study_films *films);
