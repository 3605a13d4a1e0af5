/* Readings of the machine's load, and the rule that calls a measurement disturbed. */
#include "measure/machine_noise.h"

#include "measure/clock.h"
#include "measure/proc_file.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Units share frequencies in groups; more files would cost more than a small frame. */
enum { UNITS_READ = 16, PROC_STAT_MAX = 65536, CPUINFO_MAX = 16384 };

static double frequency_of_sysfs(const char *root)
{
    double most = 0;
    for (int unit = 0; unit < UNITS_READ; unit++) {
        char path[96], text[32];
        snprintf(path, sizeof path, "/sys/devices/system/cpu/cpu%d/cpufreq/scaling_cur_freq", unit);
        if (!proc_file_read(root, path, text, sizeof text))
            break;
        most = fmax(most, (double)strtoll(text, NULL, 10) * 1e3);
    }
    return most > 0 ? most : NAN;
}

/* "cpu MHz\t\t: 2445.406"; parsed as integers, because the kernel writes a point whatever LC_NUMERIC is. */
static double frequency_of_cpuinfo(const char *root)
{
    char text[CPUINFO_MAX];
    double most = 0;
    if (!proc_file_read(root, "/proc/cpuinfo", text, sizeof text))
        return NAN;
    for (const char *at = text; (at = strstr(at, "cpu MHz")) != NULL; at++) {
        const char *colon = strchr(at, ':');
        if (!colon)
            break;
        most = fmax(most, (double)strtoll(colon + 1, NULL, 10) * 1e6);
    }
    return most > 0 ? most : NAN;
}

noise_reading noise_read(const char *root)
{
    char text[PROC_STAT_MAX];
    proc_stat machine;
    noise_reading r = {.busy_s = NAN, .steal_s = NAN, .units = NAN};
    if (proc_file_read(root, "/proc/stat", text, sizeof text) &&
        proc_stat_parse(text, (double)sysconf(_SC_CLK_TCK), &machine)) {
        r.busy_s = machine.busy_s;
        r.steal_s = machine.steal_s;
        r.units = machine.units;
    }
    const double hz = frequency_of_sysfs(root);
    r.frequency_hz = isnan(hz) ? frequency_of_cpuinfo(root) : hz;
    r.process_s = clock_process_cpu_s();
    r.wall_s = clock_wall_s();
    return r;
}

machine_noise noise_unknown(void)
{
    return (machine_noise){NAN, NAN, NAN, NAN, NAN};
}

/* Rounding to ticks can exceed either end. */
static double fraction(double part_s, double capacity_s)
{
    return capacity_s > 0 && !isnan(part_s) ? fmin(fmax(part_s / capacity_s, 0.0), 1.0) : NAN;
}

machine_noise noise_between(const noise_reading *before, const noise_reading *after)
{
    const double capacity_s = (after->wall_s - before->wall_s) * after->units;
    const double others_s = (after->busy_s - before->busy_s) - (after->process_s - before->process_s);
    const double steal_s = after->steal_s - before->steal_s;
    return (machine_noise){fraction(others_s, capacity_s), fraction(steal_s, capacity_s), after->frequency_hz, NAN,
                           NAN};
}

/* --- window --- */

void noise_window_add(noise_window *w, const noise_reading *now)
{
    const double apart_s = 2 * NOISE_WINDOW_S / NOISE_READINGS;
    if (w->count > 1 && now->wall_s - w->reading[w->count - 2].wall_s < apart_s)
        w->count--; /* *now replaces the last reading */
    if (w->count == NOISE_READINGS) {
        memmove(w->reading, w->reading + 1, (NOISE_READINGS - 1) * sizeof *w->reading);
        w->count--;
    }
    w->reading[w->count++] = *now;
}

machine_noise noise_window_since(noise_window *w, double since_s, const noise_reading *now)
{
    const double latest_s = fmin(since_s, now->wall_s - NOISE_WINDOW_S);
    size_t i = w->count;
    if (i == 0)
        return noise_unknown();
    while (i > 1 && w->reading[i - 1].wall_s > latest_s)
        i--;
    machine_noise noise = noise_between(&w->reading[i - 1], now);
    if (now->frequency_hz > w->fastest_hz)
        w->fastest_hz = now->frequency_hz;
    noise.frequency_drop = isnan(now->frequency_hz) ? NAN : 1.0 - now->frequency_hz / w->fastest_hz;
    return noise;
}

double noise_stalled(int workers, int units, double wall_s, double longest_s, double cpu_s)
{
    const double could_s = workers <= units ? wall_s : longest_s;
    return workers > 0 && could_s > 0 ? fmax(0.0, 1.0 - cpu_s / could_s) : NAN;
}

/* --- rule --- */

noise_rule noise_rule_default(void)
{
    return (noise_rule){.others_fraction = 0.05, .steal_fraction = NAN, .frequency_drop = NAN, .stalled_fraction = 0.1};
}

noise_verdict noise_judge(const noise_rule *rule, const machine_noise *noise, bool exceeded[NOISE_KINDS])
{
    const double bound[NOISE_KINDS] = {rule->others_fraction, rule->steal_fraction, rule->frequency_drop,
                                       rule->stalled_fraction};
    const double value[NOISE_KINDS] = {noise->others_fraction, noise->steal_fraction, noise->frequency_drop,
                                       noise->stalled_fraction};
    noise_verdict verdict = NOISE_NOT_KNOWN;
    for (noise_kind kind = 0; kind < NOISE_KINDS; kind++) {
        const bool exceeds = value[kind] > bound[kind];
        if (exceeded)
            exceeded[kind] = exceeds;
        if (exceeds)
            verdict = NOISE_DISTURBED;
        else if (verdict == NOISE_NOT_KNOWN && !isnan(bound[kind]) && !isnan(value[kind]))
            verdict = NOISE_UNDISTURBED;
    }
    return verdict;
}
