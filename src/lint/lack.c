#include "lint/lack.h"

#include <limits.h>
#include <math.h>

static double mean_of_pixel(const probe_image *of, size_t pixel)
{
    const float *rgb = of->rgb + 3 * pixel;
    return ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3.0;
}

static double apart(const probe_image *one, const probe_image *two, size_t pixel)
{
    double sum = 0.0;
    for (size_t c = 0; c < 3; c++)
        sum += fabs((double)one->rgb[3 * pixel + c] - (double)two->rgb[3 * pixel + c]);
    return sum / 3.0;
}

lack lack_of(size_t pixels, const probe_image *at, const probe_image *deepest)
{
    const double n = (double)pixels, cut = lack_cut(pixels, deepest);
    double radiance = 0.0, sum = 0.0, squares = 0.0, largest = 0.0;
    for (size_t i = 0; i < pixels; i++)
        radiance += mean_of_pixel(deepest, i) / n;
    radiance = fmax(radiance, (double)PROBE_DARK);
    for (size_t i = 0; i < pixels; i++) {
        const double one = apart(at, deepest, i) / radiance + (double)deepest->cut[i];
        sum += one, squares += one * one;
        largest = fmax(largest, (double)at->cut[i]);
    }
    const double mean = sum / n;
    return (lack){mean, cut, cut / radiance, sqrt(fmax(0.0, squares / n - mean * mean) / n), largest};
}

double lack_cut(size_t pixels, const probe_image *of)
{
    double sum = 0.0;
    for (size_t i = 0; i < pixels; i++)
        sum += (double)of->cut[i];
    return sum / (double)pixels;
}

double lack_decay(double before, double after, int levels)
{
    return before > after ? pow(after / before, 1.0 / levels) : 1.0;
}

int lack_depth_enough(int depth, double bound, double decay)
{
    if (bound <= LACK_ACCEPTED)
        return depth;
    if (isnan(decay))
        return 2 * depth;
    if (decay == 1.0)
        return INT_MAX;
    const double levels = decay > 0.0 ? ceil(log(LACK_ACCEPTED / bound) / log(decay)) : 1.0;
    return levels < 1000.0 ? depth + (int)levels : INT_MAX;
}
