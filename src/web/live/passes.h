/* The plan of the render passes: their number and resolution, chosen from the measured speed so that the first image
 * appears quickly. Pure functions. */
#pragma once

#include "scene/model/render_settings.h"
#include <stdbool.h>

enum { PASSES_MAX = 6 };
typedef struct pass_plan {
    int count;
    int shrink[PASSES_MAX];  /* the factor by which width and height are divided; 1 for the last */
    bool single[PASSES_MAX]; /* one sample (path) per pixel; false for the last */
} pass_plan;

/* Camera rays of a pass, times wavelengths, and its photons as many of them as they cost. */
double passes_work(const render_settings *r, int shrink, bool single);

/* rate: the latest work per second; 0 for unknown. first_s: the time limit of the first pass. */
pass_plan passes_plan(const render_settings *r, double rate, double first_s);

/* The settings of one pass. */
render_settings passes_settings(const render_settings *r, int shrink, bool single);
