/* How many pairs of processes a comparison needs. Pure. */
#pragma once

#include <stddef.h>

/* The number of pairs with which a two-sided test at 5% finds a difference with the given probability, for normally
 * distributed differences of pairs with that standard deviation: the smallest n with n >= (t(0.975, n - 1) + t(power, n
 * - 1))^2 (deviation / difference)^2 (Montgomery, Design and Analysis of Experiments, 2.4.2, with quantiles of t
 * instead of operating curves). At least 3; 0 if it is more than 10000 or unknown. */
size_t power_pairs(double deviation, double difference, double power);

/* An upper limit of a standard deviation that was estimated from count values: it is below it with the given
 * probability. A pilot's own estimate is too small in half of all cases. */
double power_upper_deviation(double deviation, size_t count, double probability);
