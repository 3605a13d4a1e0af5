/* Rounding to single precision, kept as a double. Not written as (double)(float)x: gcc 12 drops both conversions where
 * it makes vectors of straight-line code (-O2 and above). Pure; cannot fail. */
#pragma once

/* The nearest float; |x| at most FLT_MAX. */
static inline double single_round(double x)
{
    volatile float single = (float)x;
    return (double)single;
}
