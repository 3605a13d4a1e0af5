/* The monotone cubic through points (curve.h). */
#include "optics/curve.h"

#include <math.h>

static double secant(const double *point, size_t i)
{
    return (point[2 * i + 3] - point[2 * i + 1]) / (point[2 * i + 2] - point[2 * i]);
}

/* The slope that keeps the sides with secants a and b monotone: of their sign and at most three times each; 0 where the
 * values turn. */
static double limited(double slope, double a, double b)
{
    const double most = 3.0 * fmin(fabs(a), fabs(b));
    if (!(a * b > 0.0))
        return 0.0;
    return a > 0.0 ? fmin(fmax(slope, 0.0), most) : fmax(fmin(slope, 0.0), -most);
}

static double slope_at(const double *point, size_t count, size_t i)
{
    if (count == 2)
        return secant(point, 0);
    const size_t left = i == 0 ? 0 : i == count - 1 ? count - 3 : i - 1; /* of the parabola's three points */
    const double a = secant(point, left), b = secant(point, left + 1),
                 bend = (b - a) / (point[2 * left + 4] - point[2 * left]);
    const double slope = a + bend * (2.0 * point[2 * i] - point[2 * left] - point[2 * left + 2]);
    if (i > 0 && i < count - 1)
        return limited(slope, a, b);
    const double beside = i == 0 ? a : b;
    return limited(slope, beside, beside);
}

double curve_at(const double *point, size_t count, double x)
{
    size_t low = 0, high = count - 1;
    if (!(x > point[0]))
        return point[1];
    if (!(x < point[2 * high]))
        return point[2 * high + 1];
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        *(x < point[2 * middle] ? &high : &low) = middle;
    }
    const double *p = point + 2 * low, width = p[2] - p[0], t = (x - p[0]) / width, u = 1.0 - t;
    const double first = slope_at(point, count, low), last = slope_at(point, count, high);
    return u * u * ((1.0 + 2.0 * t) * p[1] + t * width * first) + t * t * ((1.0 + 2.0 * u) * p[3] - u * width * last);
}
