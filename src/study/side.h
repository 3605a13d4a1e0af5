/* One side of a comparison (study/contrast.h): which rows of a study it has. Written as items separated by commas: a
 * results folder; PATH=VALUE for cells with that value; cell=N; environment=KEY; run=ID. "results-old" is a whole run,
 * "render.threads=2" a value of an axis, "other,environment=3d2be922" a part of another folder. Ownership: side_read
 * gives, side_release releases. */
#pragma once

#include "study/study.h"

typedef struct study_side {
    char *text;                              /* as given, cut into the items, which point into it */
    const char *given;                       /* borrowed: as given */
    const char *results, *environment, *run; /* environment, run: NULL without one */
    long cell;                               /* below 0: not given */
    size_t point[STUDY_AXES_MAX];            /* of each axis, or STUDY_SIDE_ANY */
} study_side;

#define STUDY_SIDE_ANY ((size_t)-1)

/* results: the folder unless the text names one. STATUS_BAD_INPUT for an unknown parameter or value, or a cell that the
 * study does not have; the remedy names those that exist. */
status side_read(const study *s, const char *text, const char *results, study_side *out, diagnostic *why);
/* A whole results folder, whatever its name is. Owns nothing. */
study_side side_of_folder(const char *results);
void side_release(study_side *side);

/* The cells of a and b that are compared with each other: those that agree in every axis that neither names. Pairs
 * (first of a, then of b) in the order of the grid. STATUS_BAD_INPUT if a side names a parameter and the other does
 * not. */
status side_cells(const study *s, const study_side *a, const study_side *b, size_t (**pairs)[2], size_t *count,
                  diagnostic *why);
