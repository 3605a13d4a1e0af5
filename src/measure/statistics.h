/* Summaries of repeated measurements with confidence intervals, and the quantiles that these need. Pure; no
 * allocation. */
#pragma once

#include <stddef.h>

/* ---- summaries ---- */

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

/* The 95% interval of a probability, from hits in count independent trials; it covers at least 95% (Clopper and
 * Pearson, Biometrika 26, 1934). hits need not be an integer: it may be a mean over draws. NaN without a trial. */
typedef struct fraction_interval {
    double share, low, high;
} fraction_interval;
fraction_interval binomial_interval(double hits, double count);

/* ---- quantiles ---- */

/* The 97.5% quantile of Student's t (95% lie between -t and t) for 1 or more degrees of freedom, to 1e-9; NaN for 0. */
double student_t_975(size_t degrees_of_freedom);

/* The p quantile of the normal distribution, 0 < p < 1; its relative error is below 1e-12. */
double normal_quantile(double p);
/* The probability that a normal variable is at most x. */
double normal_below(double x);
/* The p quantile of Student's t for 1 or more degrees of freedom, 0 < p < 1, to 1e-9. */
double student_quantile(double p, double degrees_of_freedom);
/* The p quantile of chi-squared, 0 < p < 1, degrees > 0, to 1e-9. */
double chi_squared_quantile(double p, double degrees_of_freedom);
/* The p quantile of the beta distribution, 0 < p < 1, a, b > 0, to 1e-12. */
double beta_quantile(double p, double a, double b);

/* ---- how many pairs of processes a comparison needs ---- */

/* The number of pairs with which a two-sided test at 5% finds a difference with the given probability, for normally
 * distributed differences of pairs with that standard deviation: the smallest n with n >= (t(0.975, n - 1) + t(power, n
 * - 1))^2 (deviation / difference)^2 (Montgomery, Design and Analysis of Experiments, 2.4.2, with quantiles of t
 * instead of operating curves). At least 3; 0 if it is more than 10000 or unknown. */
size_t power_pairs(double deviation, double difference, double power);

/* The upper confidence limit of a standard deviation that was estimated from `count` values. The estimate of a pilot
 * study is itself too small in half of all cases. */
double power_upper_deviation(double deviation, size_t count, double probability);
