/* Convolution of a plane of doubles with separable filters: along the rows, then along the columns. Border values are
 * repeated outside the plane. Pure; cannot fail. Ownership: planes are the caller's, width * height values, rows from
 * the top. */
#pragma once

enum { CONVOLVE_TAPS_MAX = 32 };

/* weight[i] applies to the value i - before positions to the right (or below): a correlation, as usual for image
 * filters. */
typedef struct convolve_taps {
    int count, before;
    double weight[CONVOLVE_TAPS_MAX];
} convolve_taps;

/* A Gaussian at count positions, centred, with sum 1. 1 <= count <= CONVOLVE_TAPS_MAX. */
convolve_taps convolve_gaussian(int count, double sigma);

/* Adds scale times the filtered plane to out. The three planes do not overlap; scratch is overwritten. */
void convolve_add(const double *plane, int width, int height, const convolve_taps *across, const convolve_taps *down,
                  double scale, double *scratch, double *out);
