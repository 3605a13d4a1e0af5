/* What disturbed a measurement: other processes, the hypervisor, the clock frequency, and stops of this process. Values
 * are differences between two readings of /proc and /sys, whose counters tick every 10 ms, so a difference over less
 * than half a second means little: a noise_window keeps the readings that are needed to look back that far. Plain
 * values, nothing to release. Unknown values are NaN. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef struct noise_reading {
    double wall_s;          /* monotonic */
    double busy_s, steal_s; /* CPU seconds since boot: busy, and of these withheld by the hypervisor */
    double process_s;       /* CPU seconds of this process */
    double units;           /* processing units online */
    double frequency_hz;    /* the present clock frequency, the highest of the units: idle ones are slow */
} noise_reading;

typedef struct machine_noise {
    double others_fraction;  /* of the machine, 0..1: busy with other processes; includes steal */
    double steal_fraction;   /* of the machine, 0..1 */
    double frequency_hz;     /* at the end */
    double frequency_drop;   /* fraction by which frequency_hz is below the highest so far, 0..1 */
    double stalled_fraction; /* of the workers' time, 0..1: see noise_stalled */
} machine_noise;

/* Reads /proc/stat, /sys/devices/system/cpu/cpuN/cpufreq (or /proc/cpuinfo) below root, "" for this machine. */
noise_reading noise_read(const char *root);
/* frequency_drop is NaN: it depends on earlier readings. */
machine_noise noise_between(const noise_reading *before, const noise_reading *after);
/* All unknown. */
machine_noise noise_unknown(void);

/* The fraction of the time of `workers` threads in which they did not run although they had work: stopped (Ctrl-Z),
 * frozen or throttled by their control group, or delayed by other processes. wall_s and cpu_s are sums over the
 * workers. More workers than units wait for one another: then longest_s, the longest wall time of a worker, is the
 * least that one unit must have computed, and the fraction is a lower bound. NaN without workers. */
double noise_stalled(int workers, int units, double wall_s, double longest_s, double cpu_s);

#define NOISE_WINDOW_S 0.5
enum { NOISE_READINGS = 16 };

/* The last readings; any three successive ones cover at least NOISE_WINDOW_S / 8. */
typedef struct noise_window {
    noise_reading reading[NOISE_READINGS];
    size_t count;
    double fastest_hz; /* the highest frequency at the end of an interval; 0: none */
} noise_window;

/* Adds a reading; readings that are older than necessary are dropped. */
void noise_window_add(noise_window *w, const noise_reading *now);
/* The noise from since_s (wall_s of a reading) until `now`, or during the last NOISE_WINDOW_S if that is longer. It
 * starts at the latest reading that is old enough, or else at the oldest. noise_unknown without a reading. */
machine_noise noise_window_since(noise_window *w, double since_s, const noise_reading *now);

/* Bounds; a measurement is disturbed if one of these values exceeds its bound. The measured time plays no role. NaN: no
 * bound. */
typedef struct noise_rule {
    double others_fraction, steal_fraction, frequency_drop, stalled_fraction;
} noise_rule;

/* The bounds are 0.05 for others_fraction, and 0.1 for stalled_fraction, which stays below 0.03 on a quiet machine. */
noise_rule noise_rule_default(void);

typedef enum noise_kind { NOISE_OTHERS, NOISE_STEAL, NOISE_FREQUENCY, NOISE_STALLED, NOISE_KINDS } noise_kind;
typedef enum noise_verdict { NOISE_UNDISTURBED, NOISE_DISTURBED, NOISE_NOT_KNOWN } noise_verdict;
/* NOISE_NOT_KNOWN if all values that have a bound are unknown. exceeded, unless NULL: by kind, whether the value is
 * above its bound. */
noise_verdict noise_judge(const noise_rule *rule, const machine_noise *noise, bool exceeded[NOISE_KINDS]);
