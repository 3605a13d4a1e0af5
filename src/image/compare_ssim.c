/* Structural similarity: Wang, Bovik, Sheikh, Simoncelli, Image Quality Assessment: From Error Visibility to Structural
 * Similarity, IEEE Transactions on Image Processing 13(4), 2004: eq. 13 with the statistics of eqs. 14 to 16 under
 * their 11 x 11 Gaussian of sigma 1.5, K1 = 0.01, K2 = 0.03, L = 1, and the mean of eq. 17 over all windows inside the
 * image. Along a side shorter than 11 pixels the window is as long as that side, with a centred Gaussian of sum 1. */
#include "image/compare_parts.h"

#include "base/cancel.h"
#include <stdlib.h>

enum { WINDOW = 11, MEAN_A = 0, MEAN_B, SQUARE_A, SQUARE_B, PRODUCT, SUMS };

/* A plane per windowed sum, and two scratch planes. */
typedef struct statistics {
    int width, height;
    size_t count;
    double *sums[SUMS], *terms, *scratch;
} statistics;

static void gather(statistics *s, const double *a, const double *b, const convolve_taps *across,
                   const convolve_taps *down)
{
    const double *const factors[SUMS][2] = {{a, NULL}, {b, NULL}, {a, a}, {b, b}, {a, b}};
    for (int sum = 0; sum < SUMS; sum++) {
        const double *first = factors[sum][0], *second = factors[sum][1];
        for (size_t i = 0; i < s->count && !cancel_asked_at(i); i++)
            s->terms[i] = second ? first[i] * second[i] : first[i];
        convolve_add(s->terms, s->width, s->height, across, down, 1.0, s->scratch, s->sums[sum]);
    }
}

/* Eq. 13 for one window. */
static double similarity(const statistics *s, size_t at)
{
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    double a = s->sums[MEAN_A][at], b = s->sums[MEAN_B][at];
    double variance_a = s->sums[SQUARE_A][at] - a * a, variance_b = s->sums[SQUARE_B][at] - b * b;
    double covariance = s->sums[PRODUCT][at] - a * b;
    return (2 * a * b + c1) * (2 * covariance + c2) / ((a * a + b * b + c1) * (variance_a + variance_b + c2));
}

status compare_ssim(const double *a, const double *b, int width, int height, double *mean, diagnostic *why)
{
    statistics s = {.width = width, .height = height, .count = (size_t)width * (size_t)height};
    double *planes = calloc(s.count, (SUMS + 2) * sizeof *planes);
    if (!planes)
        return diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for the structural similarity");
    for (int sum = 0; sum < SUMS; sum++)
        s.sums[sum] = planes + (size_t)sum * s.count;
    s.terms = planes + SUMS * s.count;
    s.scratch = s.terms + s.count;
    convolve_taps across = convolve_gaussian(width < WINDOW ? width : WINDOW, 1.5);
    convolve_taps down = convolve_gaussian(height < WINDOW ? height : WINDOW, 1.5);
    gather(&s, a, b, &across, &down);
    int columns = width - across.count + 1, rows = height - down.count + 1;
    double sum = 0.0;
    for (int y = 0; y < rows && !cancel_asked(); y++)
        for (int x = 0; x < columns; x++)
            sum += similarity(&s, (size_t)(y + down.before) * (size_t)width + (size_t)(x + across.before));
    *mean = sum / ((double)rows * columns);
    free(planes);
    return cancel_check(why);
}
