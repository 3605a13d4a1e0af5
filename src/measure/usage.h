/* Resources used by the process, a thread and the processor, as differences between readings before and after the work;
 * and what could disturb a measurement. Unknown values are NaN (reals) or -1 (integers), and are written as NA. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* ---- the process ---- */

typedef struct usage {
    double wall_s, cpu_s;   /* of the process; differences after usage_since */
    int64_t peak_rss_bytes; /* peak resident memory of the process so far; never a difference */
    int64_t voluntary_switches, involuntary_switches;
} usage;

usage usage_now(void);
/* Resets the peak of resident memory, if the system allows it: Linux does. */
void usage_reset_peak(void);
/* The difference between an earlier reading and now. */
usage usage_since(const usage *before);

/* ---- a thread ---- */

/* What the calling thread did in an interval: it ran, it waited for a processing unit although it could run, or it was
 * blocked (by a lock, a semaphore, a page from the disk). With more threads than units, some threads always wait. The
 * thread itself reads at the start and at the end; a reading takes some 10 microseconds, because it opens a file of
 * /proc. */
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
 * Documentation/scheduler/sched-stats.rst). False for other text, and for the three zeros of a kernel that does not
 * measure this. */
bool thread_usage_parse(const char *schedstat, double *runnable_s);

/* ---- hardware counters: hardware_counter.c ---- */

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

/* ---- disturbances: disturbances.c ---- */

/* Reports what could disturb a measurement now: calls line with one short text for each ("governor powersave", "turbo
 * on", "load 3.2", "others use 40% of the machine"), not at all if nothing is found. Other processes are observed for
 * sample_s seconds; 0: not at all, so that only the load average tells of them. */
void disturbances_report(double sample_s, void (*line)(void *context, const char *text), void *context);

/* What to do about such a disturbance; "" if nothing is known to help. Static text. */
const char *disturbance_advice(const char *disturbance);

typedef void (*disturbance_callback)(void *context, const char *text);

/* The settings (governor, turbo, threads per core, hypervisor, quota), load and swap by the files of /proc and /sys
 * below root: "" for this machine; tests have copies of other machines' files. */
void disturbances_of_machine(const char *root, disturbance_callback line, void *context);

/* Instructions of frames, counted by callgrind (valgrind), for machines with noisy clocks and no hardware counters: the
 * counts repeat within 0.03 % however busy the machine is. valgrind writes a dump whenever renderer_render returns,
 * with the counts since it was entered (INSTRUCTION_DUMPS_OPTIONS); these functions read and remove the dumps. `cuvette
 * study run --instructions` sets the variable. Plain values; nothing to release. */

/* The variable that has the path of the dumps, without their numbers. */
#define INSTRUCTION_DUMPS_VARIABLE "CUVETTE_CALLGRIND"
/* valgrind's options for the dumps, in addition to --callgrind-out-file=PATH. */
#define INSTRUCTION_DUMPS_OPTIONS "--tool=callgrind", "--zero-before=renderer_render", "--dump-after=renderer_render"

typedef struct instruction_dumps {
    long last; /* number of the last dump; start with 0 */
} instruction_dumps;

/* Whether the program runs under callgrind with such dumps. */
bool instruction_dumps_exist(void);

/* The instructions of the last frame, of all threads; -1 if there is no new dump. */
int64_t instruction_dumps_next(instruction_dumps *dumps);
