/* Quantiles of the distributions that intervals and powers need. Pure; no allocation. */
#pragma once

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

/* The 95% interval of a probability, of which hits of count independent trials speak; it covers at least 95% (Clopper
 * and Pearson, Biometrika 26, 1934). hits may be a fraction: a mean over trials that overlap. NaN without a trial. */
typedef struct share_interval {
    double share, low, high;
} share_interval;
share_interval binomial_interval(double hits, double count);
