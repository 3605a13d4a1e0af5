/* The films and ray counts of a study in two results folders, cell by cell: whether another machine, build or time made
 * the same. Ownership: study_films_release frees the list. */
#pragma once

#include "study/study.h"

typedef struct study_films {
    size_t compared, same; /* cells with rows in both folders, and those with one film and equal counts in all rows */
    size_t distinct;       /* films of the compared cells */
    size_t *different;     /* cells, in order */
    size_t different_count;
    bool other_processor; /* the rows of the two folders are of unlike processors */
    char processor[160];  /* of the folder that is compared with; "unknown" without one */
} study_films;

/* Rows that cannot be trusted (study/row_files.h) are left out; marked ones are not. */
status study_films_compare(const study *s, const char *results, const char *against, study_films *out, diagnostic *why);
void study_films_release(study_films *films);
