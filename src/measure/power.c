#include "measure/power.h"
#include "measure/quantiles.h"
#include <math.h>

enum { PAIRS_LEAST = 3, PAIRS_MOST = 10000 };

/* The pairs that are sufficient if n are taken for the quantiles. */
static double needed(double n, double ratio, double power)
{
    const double sum = student_quantile(0.975, n - 1) + student_quantile(power, n - 1);
    return sum * sum * ratio * ratio;
}

size_t power_pairs(double deviation, double difference, double power)
{
    const double ratio = deviation / fabs(difference);
    if (!(ratio >= 0) || needed(PAIRS_MOST, ratio, power) > PAIRS_MOST)
        return 0;
    size_t low = PAIRS_LEAST, high = PAIRS_MOST; /* needed(n) falls with n */
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (needed((double)middle, ratio, power) <= (double)middle)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

double power_upper_deviation(double deviation, size_t count, double probability)
{
    const double freedom = (double)count - 1;
    return count > 1 ? deviation * sqrt(freedom / chi_squared_quantile(1.0 - probability, freedom)) : NAN;
}
