/* Repeated measurements on two levels: repetitions within processes. Times of one process are more alike than times of
 * several, because memory layout, address randomisation and placement differ, so that repetitions in only one process
 * lead to intervals that are too narrow (Kalibera and Jones, Rigorous benchmarking in reasonable time, ISMM 2013).
 * Pure, except that level_bootstrap allocates its resamples. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* values[start[p]] .. values[start[p + 1] - 1] are of process p; start has processes + 1 elements. */
typedef struct level_sample {
    const double *values;
    const size_t *start;
    size_t processes;
} level_sample;

/* The centre of a sample: the mean over processes of the median in each. For logarithms of times it is the logarithm of
 * a typical time, and differences are logarithms of ratios. */
double level_centre(const level_sample *sample);

/* An estimate with its 95% interval; low and high are NaN if there is none. */
typedef struct level_interval {
    double value, low, high;
} level_interval;

/* A statistic of two samples, or of one if b is NULL; it is also computed for resamples. */
typedef double level_statistic(const level_sample *a, const level_sample *b, void *context);

/* The statistic with the interval of a hierarchical bootstrap: processes are drawn with replacement, each with all of
 * its repetitions. Drawing their repetitions again would count the variance of repetitions twice (Davison and Hinkley,
 * Bootstrap Methods and their Application, 1997, 3.8; Ren et al., Nonparametric bootstrapping for hierarchical data,
 * Journal of Applied Statistics 37, 2010). If there is one process, its repetitions are drawn. paired: process i of
 * both ran at about the same time, so the same process of both is drawn; needs equal numbers. From 10 processes on it
 * is the expanded percentile interval, which has the width of Student's t; for fewer, Student's t with the bootstrap's
 * standard error (Hesterberg, What teachers should know about the bootstrap, The American Statistician 69, 2015). seed
 * makes it reproducible. No interval for fewer than 6 values in all, or fewer than 3 processes if there is more than
 * one. */
status level_bootstrap(const level_sample *a, const level_sample *b, bool paired, level_statistic *statistic,
                       void *context, uint64_t seed, level_interval *out, diagnostic *why);
/* The parts of level_bootstrap, for statistics with other samples (study/summary/contrast_parts.h). level_draw: a
 * number below count, the same for the same arguments; stream: equal for samples that are drawn as pairs.
 * level_set_interval: the interval of out->value from LEVEL_RESAMPLES resampled values, of samples of `draws`
 * processes; reorders them. */
enum { LEVEL_RESAMPLES = 2000 };
size_t level_draw(uint64_t seed, uint32_t round, uint32_t stream, uint32_t process, size_t count);
void level_set_interval(double *values, size_t draws, level_interval *out);

/* The difference of the centres of two samples of logarithms: the logarithm of a ratio. */
double level_difference(const level_sample *a, const level_sample *b, void *unused);

/* The values that a quantity can have; its interval is cut to them, which costs no coverage. */
typedef enum level_range {
    LEVEL_REAL,         /* any number, such as the logarithm of a time */
    LEVEL_POSITIVE,     /* above 0, such as a time */
    LEVEL_NOT_NEGATIVE, /* 0 or above, such as a time of waiting */
    LEVEL_FRACTION      /* 0 to 1 */
} level_range;

/* The median of all values with its interval: processes are drawn as in level_bootstrap. For 3 to 9 processes the
 * interval is Student's t; for a positive quantity it is computed from logarithms, so that it is symmetric in ratios
 * and never reaches 0. Other intervals are cut at 0, except for LEVEL_REAL, and for a fraction also at 1. If a value is
 * outside `range`, a wider range is used. With fewer than 3 processes or 6 values, the interval comes from order
 * statistics (measure/statistics.h), as if all values were independent. */
status level_median(const level_sample *s, level_range range, uint64_t seed, level_interval *out, diagnostic *why);
