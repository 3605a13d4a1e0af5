/* The times of the frames of an animation: frame k, counted from 0, shows the time start_s + k fps_den / fps_num.
 * Values; errors are STATUS_BAD_INPUT, not located, except those of scripts. */
#pragma once

#include "scene/model/open.h"
#include <stdint.h>

typedef struct frame_times {
    double start_s, duration_s; /* duration_s < 0: not given */
    int64_t fps_num, fps_den;   /* in lowest terms */
} frame_times;

/* Number of frames: duration_s times the frame rate, rounded, at least 1. */
int64_t frame_times_count(const frame_times *t);
double frame_times_at(const frame_times *t, int64_t frame);

/* A missing duration: up to two seconds after the end of the scripts of the scene's slimes, in which they come to rest;
 * without a script 4 s. */
status frame_times_choose(frame_times *t, const scene *s, diagnostic *why);
/* Checks that the slimes' motion up to the last frame is not too long. */
status frame_times_check_end(const frame_times *t, const scene *s, diagnostic *why);
