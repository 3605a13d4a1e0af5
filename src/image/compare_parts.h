/* The measures of compare.h that use neighbourhoods, one file each. Their images and planes have passed compare_check.
 * Ownership: everything is the caller's. Errors: STATUS_FAILURE without memory. */
#pragma once

#include "image/image.h"

/* STATUS_BAD_INPUT unless the sizes are equal and no channel is NaN. */
status compare_check(const image *a, const image *b, diagnostic *why);

/* Mean structural similarity of two planes of encoded luma, 0..1. */
status compare_ssim(const double *a, const double *b, int width, int height, double *mean, diagnostic *why);

/* Writes the FLIP error of each pixel, 0..1, to errors, width * height values. */
status compare_flip(const image *a, const image *b, double *errors, diagnostic *why);

/* The colour space of FLIP: conversion relative to white, and distance. */

/* Luminance and two opponent colours, red-green and yellow-blue: YCxCz without its scales and offset, which filters of
 * sum 1 preserve. Linear in rgb, which is clamped to 0..1 first. */
void flip_opponent(const float rgb[3], double opponent[3]);
/* Back to linear RGB, clamped to 0..1, and from there to CIELAB with Hunt's adjustment. */
void flip_hunt_lab(const double opponent[3], double lab[3]);
/* HyAB distance between green and blue, the most distant colours of the RGB cube, raised to the power 0.7. */
double flip_farthest(void);
/* The distance of two colours of flip_hunt_lab, mapped to 0..1. */
double flip_color_error(const double a[3], const double b[3], double farthest);
