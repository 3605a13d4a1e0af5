/* What the calling thread did in an interval: it ran, it waited for a processing unit although it could run, or it was
 * blocked (by a lock, a semaphore, a page from the disk). On more threads than units, the second is the price of their
 * number. Read at the start and at the end by the thread itself; a reading takes some 10 microseconds, because it opens
 * a file of /proc. Ownership: plain values. Errors: none; unknown values are NaN (reals) or -1 (integers), and are
 * written as NA. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

typedef struct thread_usage {
    double wall_s;     /* monotonic clock; the length of the interval after thread_usage_since */
    double running_s;  /* CPU time of the thread */
    double runnable_s; /* waiting for a processing unit: Linux, /proc/thread-self/schedstat */
    double blocked_s;  /* wall_s - running_s - runnable_s; NaN before thread_usage_since */
    int64_t voluntary_switches, involuntary_switches; /* getrusage, RUSAGE_THREAD */
} thread_usage;

thread_usage thread_usage_unknown(void);
thread_usage thread_usage_now(void);
/* The difference between an earlier reading of this thread and now. */
thread_usage thread_usage_since(const thread_usage *before);

/* Reads a file schedstat: nanoseconds of running and of waiting while runnable, and the number of time slices (Linux,
 * Documentation/scheduler/sched-stats.rst). False if it is something else, or three zeros: a kernel that does not
 * measure it writes these. */
bool thread_usage_parse(const char *schedstat, double *runnable_s);
