/* How coarse the frames of a film that moves are, so that each takes about as long as it may: coarser when they come
 * too late, finer when there is time, a step at a time and no to and fro. Pure. */
#pragma once

typedef struct adaptive_resolution {
    int step;       /* of the steps of coarseness; 0 is the finest */
    double frame_s; /* what a frame takes now, smoothed; 0: not known */
} adaptive_resolution;

/* So many times less wide and high. */
int adaptive_resolution_divisor(const adaptive_resolution *p);

/* A frame of that coarseness took wall_s, and may take wanted_s. */
void adaptive_resolution_update(adaptive_resolution *p, double wall_s, double wanted_s);
