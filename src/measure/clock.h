/* Clocks, in seconds (and the wall clock in nanoseconds). wall: CLOCK_MONOTONIC; thread CPU: CLOCK_THREAD_CPUTIME_ID;
 * process CPU: CLOCK_PROCESS_CPUTIME_ID. Pure reads; cannot fail on Linux. */
#pragma once

#include <stdint.h>
#include <time.h>

double clock_wall_s(void);
int64_t clock_wall_ns(void);
double clock_thread_cpu_s(void);
double clock_process_cpu_s(void);

/* The CLOCK_MONOTONIC time in `seconds` from now, for pthread_cond_clockwait. */
struct timespec clock_after(double seconds);

/* The resolution of a clock, measured now: the smallest step seen, and the cost of one reading, in seconds. */
typedef struct clock_quality {
    double tick_s, overhead_s;
} clock_quality;
clock_quality clock_wall_quality(void);
clock_quality clock_thread_cpu_quality(void);
