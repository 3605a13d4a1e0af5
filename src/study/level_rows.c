#include "study/level_rows.h"
#include <math.h>
#include <stdlib.h>

typedef struct of_run {
    long run;
    size_t order; /* keeps equal runs in their order */
    double value;
} of_run;

static int by_run(const void *a, const void *b)
{
    const of_run *x = a, *y = b;
    if (x->run != y->run)
        return x->run < y->run ? -1 : 1;
    return (x->order > y->order) - (x->order < y->order);
}

status level_rows_median(const row_ref *const *rows, const double *values, size_t count, level_range range,
                         level_interval *out, diagnostic *why)
{
    of_run *sorted = malloc((count + 1) * sizeof *sorted);
    double *ordered = malloc((count + 1) * sizeof *ordered);
    size_t *start = malloc((count + 2) * sizeof *start), known = 0;
    status code = sorted && ordered && start ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK) {
        level_sample sample = {ordered, start, 0};
        for (size_t i = 0; i < count; i++)
            if (!isnan(values[i])) {
                sorted[known] = (of_run){rows[i]->run, known, values[i]};
                known++;
            }
        qsort(sorted, known, sizeof *sorted, by_run);
        for (size_t i = 0; i < known; i++) {
            if (i == 0 || sorted[i].run != sorted[i - 1].run)
                start[sample.processes++] = i;
            ordered[i] = sorted[i].value;
        }
        start[sample.processes] = known;
        code = level_median(&sample, range, 1, out, why);
    }
    free(start);
    free(ordered);
    free(sorted);
    return code;
}
