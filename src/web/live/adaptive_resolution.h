/* Adaptive resolution of the live frames: the resolution drops when frames take longer than their time and rises
 * when there is time left, one step at a time, with hysteresis. Pure functions. */
#pragma once

/* The factors by which width and height are divided, finest first. */
enum { RESOLUTION_STEPS = 10 };
extern const int resolution_shrinks[RESOLUTION_STEPS];

typedef struct adaptive_resolution {
    int step;       /* index of the resolution step; 0 is the finest */
    double frame_s; /* smoothed frame time; 0: unknown */
} adaptive_resolution;

/* The factor by which width and height are divided. */
int adaptive_resolution_divisor(const adaptive_resolution *p);

/* Updates the step: a frame at the current step took wall_s and may take wanted_s. */
void adaptive_resolution_update(adaptive_resolution *p, double wall_s, double wanted_s);
