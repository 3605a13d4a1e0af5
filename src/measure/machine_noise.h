/* What the rest of the machine did during a measurement: other processes, the hypervisor, the clock frequency; and what
 * was done to this process. Differences between two readings of /proc and /sys. The counters there tick in 10 ms, so a
 * difference over less than half a second means little: a noise_window keeps the readings that are needed to look back
 * that far. Plain values, nothing to release. Unknown values are NaN. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef struct noise_reading {
    double wall_s;          /* monotonic */
    double busy_s, steal_s; /* CPU seconds of all processes since boot; of them, those that the hypervisor withheld */
    double own_s;           /* CPU seconds of this process */
    double units;           /* processing units online */
    double frequency_hz;    /* the present clock frequency, the highest of the units: idle ones are slow */
} noise_reading;

typedef struct machine_noise {
    double others_fraction;  /* of the machine, 0..1: busy but not with this process; includes steal */
    double steal_fraction;   /* of the machine, 0..1 */
    double frequency_hz;     /* at the end */
    double frequency_drop;   /* fraction by which that is below the highest one so far, 0..1 */
    double stalled_fraction; /* of the time of the workers, 0..1: see noise_stalled */
} machine_noise;

/* Reads /proc/stat, /sys/devices/system/cpu/cpuN/cpufreq (or /proc/cpuinfo) below root, "" for this machine. */
noise_reading noise_read(const char *root);
/* frequency_drop is NaN: it depends on earlier readings. */
machine_noise noise_between(const noise_reading *before, const noise_reading *after);
/* All unknown. */
machine_noise noise_unknown(void);

/* The fraction of the time of `workers` threads in which they did not run, of wall_s and cpu_s over all of them:
 * stopped (Ctrl-Z), frozen or throttled by their control group, or held up by others. Threads that compute all the time
 * run all the time. More of them than units wait for one another: then longest_s, the wall time of the longest, is what
 * one unit must have computed at least, and the fraction is a lower bound. NaN without workers. */
double noise_stalled(int workers, int units, double wall_s, double longest_s, double cpu_s);

#define NOISE_WINDOW_S 0.5
enum { NOISE_READINGS = 16 };

/* The last readings, at least a thirtieth of a window apart. */
typedef struct noise_window {
    noise_reading reading[NOISE_READINGS];
    size_t count;
    double fastest_hz; /* of all readings at the end of an interval; 0: none */
} noise_window;

/* Adds a reading; readings that are older than necessary are dropped. */
void noise_window_add(noise_window *w, const noise_reading *now);
/* The noise up to now of an interval that began at since_s (wall_s of a reading), or of NOISE_WINDOW_S if that is
 * longer: from the latest sufficiently old reading, or the oldest one. noise_unknown without a reading. */
machine_noise noise_window_since(noise_window *w, double since_s, const noise_reading *now);

/* A rule that calls a measurement disturbed: it is, if one of these is above its bound. The rule never looks at the
 * measured time. NaN: not part of the rule. */
typedef struct noise_rule {
    double others_fraction, steal_fraction, frequency_drop, stalled_fraction;
} noise_rule;

/* others_fraction above 0.05, or stalled_fraction above 0.1: on a quiet machine that is below 0.03. */
noise_rule noise_rule_default(void);

typedef enum noise_kind { NOISE_OTHERS, NOISE_STEAL, NOISE_FREQUENCY, NOISE_STALLED, NOISE_KINDS } noise_kind;
typedef enum noise_verdict { NOISE_UNDISTURBED, NOISE_DISTURBED, NOISE_NOT_KNOWN } noise_verdict;
/* Not known if nothing that the rule looks at is. broken, by noise_kind, may be NULL: which parts are. */
noise_verdict noise_judge(const noise_rule *rule, const machine_noise *noise, bool broken[NOISE_KINDS]);
