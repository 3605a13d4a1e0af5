/* Summaries of repeated measurements, with confidence intervals. Pure; no allocation. */
#pragma once

#include <stddef.h>

typedef struct summary {
    size_t count;
    double mean, median, minimum, maximum;
    double deviation;               /* sample standard deviation (n - 1); NaN for fewer than 2 values */
    double mean_low, mean_high;     /* 95% interval of the mean, Student's t; NaN for fewer than 2 values */
    double median_low, median_high; /* at least 95% interval of the median by order statistics (binomial); NaN for fewer
                                          than 6 values, where no such interval exists */
} summary;

/* Sorts values in place. Without values, or with a NaN among them, all fields except count are NaN. */
summary summarize(double *values, size_t count);

/* Width of the 95% interval of the mean, divided by the mean; NaN if unknown. */
double summary_relative_width(const summary *s);

/* The 97.5% quantile of Student's t (95% lie between -t and t) for 1 or more degrees of freedom, to 1e-9; NaN for 0. */
double student_t_975(size_t degrees_of_freedom);
