/* Convolution with separable filters. */
#include "image/compare_parts.h"

#include "base/cancel.h"
#include "base/elementary.h"
#include <stddef.h>
#include <string.h>

#define E 2.7182818284590452

convolve_taps convolve_gaussian(int count, double sigma)
{
    convolve_taps taps = {.count = count, .before = (count - 1) / 2};
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        double x = i - (count - 1) / 2.0;
        taps.weight[i] = elementary_pow(E, -x * x / (2.0 * sigma * sigma));
        sum += taps.weight[i];
    }
    for (int i = 0; i < count; i++)
        taps.weight[i] /= sum;
    return taps;
}

static int within(int i, int count)
{
    return i < 0 ? 0 : i < count ? i : count - 1;
}

/* out += weight * shifted row, with repeated border values. */
static void add_shifted_row(const double *restrict row, int width, int shift, double weight, double *restrict out)
{
    int first = shift < 0 ? within(-shift, width + 1) : 0;
    int last = shift > 0 ? within(width - shift, width + 1) : width;
    for (int x = 0; x < first; x++)
        out[x] += weight * row[0];
    for (int x = first; x < last; x++)
        out[x] += weight * row[x + shift];
    for (int x = last; x < width; x++)
        out[x] += weight * row[width - 1];
}

void convolve_add(const double *plane, int width, int height, const convolve_taps *across, const convolve_taps *down,
                  double scale, double *scratch, double *out)
{
    size_t stride = (size_t)width;
    for (int y = 0; y < height && !cancel_asked(); y++) {
        memset(scratch + (size_t)y * stride, 0, stride * sizeof *scratch);
        for (int i = 0; i < across->count; i++)
            add_shifted_row(plane + (size_t)y * stride, width, i - across->before, across->weight[i],
                            scratch + (size_t)y * stride);
    }
    for (int y = 0; y < height && !cancel_asked(); y++) {
        for (int i = 0; i < down->count; i++) {
            const double *row = scratch + (size_t)within(y + i - down->before, height) * stride;
            add_shifted_row(row, width, 0, scale * down->weight[i], out + (size_t)y * stride);
        }
    }
}
