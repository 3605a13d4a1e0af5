/* Resource usage of the process and the machine, read before and after some work and subtracted. */
#pragma once

#include <stdint.h>

/* Unknown values are NaN (reals) or -1 (integers), and are written as NA. */
typedef struct usage {
    double wall_s, cpu_s;   /* of the process; differences after usage_since */
    int64_t peak_rss_bytes; /* peak resident memory of the process so far; never a difference */
    int64_t voluntary_switches, involuntary_switches;
    double machine_busy_s; /* CPU seconds of all processes since boot (/proc/stat) */
    double machine_units;  /* processing units online */
} usage;

usage usage_now(void);
/* Resets the peak of resident memory, if the system allows it: Linux does. */
void usage_forget_peak(void);
/* The difference between an earlier reading and now. */
usage usage_since(const usage *before);
/* The share of the machine that other processes used during a difference, 0..1; NaN if unknown. /proc/stat ticks in 10
 * ms, so the value is imprecise for intervals below 0.1 s. */
double usage_others_share(const usage *difference);

/* Hardware counters of the calling thread and of threads that it starts later (perf_event_open), user mode only;
 * unavailable counts are -1. */
typedef struct hardware_counts {
    int64_t cycles, instructions, branch_misses, cache_misses;
} hardware_counts;
typedef struct hardware_counter hardware_counter;

/* Creates counters that start now and include threads started later. Without support from the kernel every count is -1.
 * Returns NULL when out of memory; the other functions accept NULL. Release with hardware_counter_destroy. */
hardware_counter *hardware_counter_create(void);
hardware_counts hardware_counter_read(const hardware_counter *counter);
/* The counts since an earlier reading. */
hardware_counts hardware_counts_since(const hardware_counter *counter, const hardware_counts *before);
void hardware_counter_destroy(hardware_counter *counter);

/* Reports what could disturb a measurement now: calls line with one short text for each ("governor powersave", "turbo
 * on", "load 3.2", "others use 40% of the machine"), never if nothing is found. The load is observed for sample_s
 * seconds (0: not at all, and nothing is reported about other processes). */
void usage_disturbances(double sample_s, void (*line)(void *context, const char *text), void *context);

/* What to do about such a disturbance; "" if nothing is known to help. Static text. */
const char *usage_advice(const char *disturbance);
