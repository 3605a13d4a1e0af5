/* In how many passes, and how coarse, a scene is painted so that the first one comes soon: reckoned from how fast
 * pictures came so far. Pure. */
#pragma once

#include "scene/model/render_settings.h"
#include <stdbool.h>

enum { PASSES_MAX = 6 };
typedef struct pass_plan {
    int count;
    int shrink[PASSES_MAX];  /* so many times less wide and high; 1 for the last */
    bool single[PASSES_MAX]; /* one sample (path) a pixel; false for the last */
} pass_plan;

/* Camera rays of a frame, wavelengths counted, of that shrinkage. */
double passes_work(const render_settings *r, int shrink, bool single);

/* rate: work a second as it was last; 0 for unknown. first_s: how long the first pass may take. */
pass_plan passes_plan(const render_settings *r, double rate, double first_s);

/* The settings of one pass. */
render_settings passes_settings(const render_settings *r, int shrink, bool single);
