/* The resolution of the images before the final one, and of live frames. Pure functions.
 *
 * Passes of a still scene: their number and resolution are chosen from the measured speed, so that the first image
 * appears quickly. Live frames of a moving scene: the resolution drops when frames exceed their time and rises
 * when there is time left, one step at a time, with hysteresis. */
#pragma once

#include "scene/model/render_settings.h"

#include <stdbool.h>

/* The factors by which width and height are divided, finest first. */
enum { RESOLUTION_STEPS = 10 };
extern const int resolution_shrinks[RESOLUTION_STEPS];

/* --- passes --- */

enum { PASSES_MAX = 6 };
typedef struct pass_plan {
    int count;
    int shrink[PASSES_MAX];  /* the factor by which width and height are divided; 1 for the last */
    bool single[PASSES_MAX]; /* one sample (path) per pixel; false for the last */
} pass_plan;

/* The work of a pass: camera rays times wavelengths; a photon counts as about ten camera rays. */
double passes_work(const render_settings *r, int shrink, bool single);

/* rate: the latest work per second; 0 for unknown. first_s: the time limit of the first pass. */
pass_plan passes_plan(const render_settings *r, double rate, double first_s);

/* The settings of one pass. */
render_settings passes_settings(const render_settings *r, int shrink, bool single);

/* --- live frames --- */

typedef struct adaptive_resolution {
    int step;       /* index of the resolution step; 0 is the finest */
    double frame_s; /* smoothed frame time; 0: unknown */
} adaptive_resolution;

/* The factor by which width and height are divided. */
int adaptive_resolution_divisor(const adaptive_resolution *resolution);

/* Updates the step: a frame at the current step took wall_s and may take wanted_s. */
void adaptive_resolution_update(adaptive_resolution *resolution, double wall_s, double wanted_s);
