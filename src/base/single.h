/* Rounding to single precision, with the result as a double. Not written as (double)(float)x: gcc 12 drops both
 * conversions when it vectorises straight-line code (-O2 and above). Pure; cannot fail. */
#pragma once

/* The nearest float; |x| at most FLT_MAX. */
static inline double single_round(double x)
{
    volatile float single = (float)x;
    return (double)single;
}
