/* Powers and angles, only from + - * / and sqrt. */
#include "base/elementary.h"

#include "base/lanes.h"
#include <math.h>

double elementary_pow(double x, double y)
{
    return y == 0.0 ? 1.0 : x < 0.0 || x != x || y != y ? (double)NAN : elementary_pow_inline(x, y);
}

void elementary_sincos_deg(double degrees, double *sine, double *cosine)
{
    double quarter = floor(degrees / 90.0 + 0.5);
    double x = (degrees - 90.0 * quarter) * 0.017453292519943295769; /* the difference is exact */
    double s = elementary_sine_series(x), c = elementary_cosine_series(x);
    int turn = (int)(quarter - 4.0 * floor(quarter / 4.0));
    *sine = turn == 0 ? s : turn == 1 ? c : turn == 2 ? -s : -c;
    *cosine = turn == 0 ? c : turn == 1 ? -s : turn == 2 ? -c : s;
}

/* atan t for |t| <= tan(pi/8), by its Taylor series to the 43rd power. */
static double arctangent_series(double t)
{
    double s = t * t, p = 0.0;
    for (int k = 21; k >= 1; k--)
        p = s * ((k % 2 ? -1.0 : 1.0) / (2 * k + 1) + p);
    return t + t * p;
}

double elementary_atan2_deg(double y, double x)
{
    double ax = fabs(x), ay = fabs(y);
    if (ax == 0.0 && ay == 0.0)
        return 0.0;
    double low = lesser(ax, ay), high = greater(ax, ay), t = low / high;
    const double tan_22_5 = 0.41421356237309504880, degrees = 57.295779513082320877;
    double angle =
        t > tan_22_5 ? 45.0 + degrees * arctangent_series((low - high) / (low + high)) : degrees * arctangent_series(t);
    angle = ay > ax ? 90.0 - angle : angle;
    angle = x < 0.0 ? 180.0 - angle : angle;
    return y < 0.0 ? -angle : angle;
}
