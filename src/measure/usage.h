/* What a stretch of work cost the process and the machine: taken before and after, then subtracted. */
#pragma once

#include <stdint.h>

/* Absent values are NaN (reals) or -1 (integers), and are written as NA. */
typedef struct usage {
    double wall_s, cpu_s;   /* of the process; a difference after usage_since */
    int64_t peak_rss_bytes; /* highest resident memory of the process so far; never a difference */
    int64_t voluntary_switches, involuntary_switches;
    double machine_busy_s; /* CPU seconds used by everyone since boot (/proc/stat) */
    double machine_units;  /* processing units online */
} usage;

usage usage_now(void);
/* Has the highest resident memory count from here on, where the system lets that be: Linux does. */
void usage_forget_peak(void);
/* What passed between an earlier reading and now. */
usage usage_since(const usage *before);
/* Share of the machine that others used during a difference, 0..1; NaN if unknown. /proc/stat ticks in 10 ms, so
 * stretches under 0.1 s say little. */
double usage_others_share(const usage *difference);

/* Hardware counters of the calling thread and the threads it starts later (perf_event_open), user mode only;
 * values that the kernel does not give are -1. */
typedef struct hardware_counts {
    int64_t cycles, instructions, branch_misses, cache_misses;
} hardware_counts;
typedef struct hardware_counter hardware_counter;

/* Never fails: where the kernel gives nothing every count is -1. Counts from here on, and threads started after it was
 * created. NULL when there is no memory, which the other two take. Release with hardware_counter_destroy. */
hardware_counter *hardware_counter_create(void);
hardware_counts hardware_counter_read(const hardware_counter *counter);
/* What was counted since an earlier reading. */
hardware_counts hardware_counts_since(const hardware_counter *counter, const hardware_counts *before);
void hardware_counter_destroy(hardware_counter *counter);

/* What could disturb a measurement now: one short line each ("governor powersave", "turbo on", "load 3.2",
 * "others use 40% of the machine"). Calls line for each, never when nothing is found; sample_s seconds are spent
 * looking at the load (0: none, and nothing is said of others). */
void usage_disturbances(double sample_s, void (*line)(void *context, const char *text), void *context);
