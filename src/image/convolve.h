/* Convolution of a plane of doubles with separable filters: along the rows, then along the columns. Outside the plane
 * its border pixels are repeated. Pure functions; cannot fail. Ownership: planes belong to the caller, width * height
 * values, rows from the top. */
#pragma once

enum { CONVOLVE_TAPS_MAX = 32 };

/* weight[i] is the weight of the value i - before pixels to the right (or below): a correlation, as is usual for image
 * filters. */
typedef struct convolve_taps {
    int count, before;
    double weight[CONVOLVE_TAPS_MAX];
} convolve_taps;

/* A centred Gaussian of count taps with sum 1. 1 <= count <= CONVOLVE_TAPS_MAX. */
convolve_taps convolve_gaussian(int count, double sigma);

/* Adds scale times the filtered plane to out. The three planes must not overlap; scratch then holds the plane filtered
 * along the rows. */
void convolve_add(const double *plane, int width, int height, const convolve_taps *across, const convolve_taps *down,
                  double scale, double *scratch, double *out);
