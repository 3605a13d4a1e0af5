/* The measured cost of each pixel of a frame, from a grey image in text (PGM, P2; measure.sh writes it) with the
 * comments
 *   # unit NS     nanoseconds of the value 1
 *   # paths N     paths a pixel of the measured frame (1 without random paths)
 * scaled to a frame of any size: a pixel costs what the pixel at its place in the map costs. */
#pragma once

#include "base/status.h"

typedef struct cost_map {
    int width, height;
    double paths;
    double *before; /* (width + 1) * (height + 1): nanoseconds of all pixels above and left of a corner */
} cost_map;

/* *m is to be released. */
status cost_map_read(const char *path, cost_map *m, diagnostic *why);
void cost_map_release(cost_map *m);

/* Mean nanoseconds of a pixel in a rectangle of the frame; sides are fractions of the frame's, from 0 to 1. */
double cost_map_mean_ns(const cost_map *m, double x0, double y0, double x1, double y1);
