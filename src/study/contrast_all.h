/* The line of a comparison over all its cells: each cell counts once, by the processes that measured it. A process
 * need not have all cells: a grid may have grown between two runs, and shards have cells of their own. Processes
 * with the same cells are a stratum, and resamples draw within each, so that every resample has every cell (Davison
 * and Hinkley, Bootstrap Methods and their Application, 1997, 3.2). Private to study/contrast.c. */
#pragma once

#include "study/contrast_rows.h"

typedef struct contrast_all {
    level_interval ratio; /* logarithm of b over a, mean over the cells; no interval if a stratum has 2 or less */
    size_t values[2], processes[2]; /* of each side; all of its cells together */
    size_t fewest;                  /* processes in the smallest stratum of a side */
    size_t fewest_values;           /* of a cell, on the side with fewer */
    bool alternate;                 /* in each stratum; then the sides have the same strata, and are drawn together */
    double deviation;               /* of a process' or a pair's mean over the cells; NaN with several strata */
} contrast_all;

/* pairs: count cells of a and of b, all with rows on both sides. */
status contrast_all_make(const contrast_rows *a, const contrast_rows *b, const size_t (*pairs)[2], size_t count,
                         contrast_all *out, diagnostic *why);
