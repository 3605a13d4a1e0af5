/* Disturbances by the machine's settings and load. */
#include "measure/usage.h"

#include "base/os_process.h"
#include "measure/machine_noise.h"
#include "measure/proc_file.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct sink {
    const char *root;
    disturbance_callback line;
    void *context;
    bool *incomplete; /* whether an unreadable file was reported; only the first one is */
} sink;

__attribute__((format(printf, 2, 3))) static void report(const sink *to, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    to->line(to->context, text);
}

/* Reads a file. A file that exists but cannot be read (too many open files, a broken disk) may hide a disturbance: the
 * first one is reported. */
static bool read_file(const sink *to, const char *path, char *text, size_t size)
{
    if (proc_file_read(to->root, path, text, size))
        return true;
    const int reason = errno;
    if (*to->incomplete || (reason != EMFILE && reason != ENFILE && reason != ENOMEM && reason != EIO))
        return false;
    report(to, "unknown: %.96s cannot be read: %s", path, strerrordesc_np(reason));
    *to->incomplete = true;
    return false;
}

/* Reads the first word of a file; false if there is none. */
static bool read_word(const sink *from, const char *path, char *word, size_t size)
{
    if (!read_file(from, path, word, size))
        return false;
    word[strcspn(word, " \t\n")] = '\0';
    return word[0] != '\0';
}

static bool reads_as(const sink *from, const char *path, const char *expected)
{
    char word[64];
    return read_word(from, path, word, sizeof word) && strcmp(word, expected) == 0;
}

/* One more than the highest number of a unit, as in "0-3,8"; UNITS_MAX if the file cannot be read. */
static int possible_units(const sink *to)
{
    enum { UNITS_MAX = 1024 };
    char text[128];
    if (!read_word(to, "/sys/devices/system/cpu/possible", text, sizeof text))
        return UNITS_MAX;
    const char *last = text + strlen(text);
    while (last > text && last[-1] >= '0' && last[-1] <= '9')
        last--;
    const long highest = strtol(last, NULL, 10);
    return highest < UNITS_MAX ? (int)highest + 1 : UNITS_MAX;
}

/* Each policy directory is a group of units that share a frequency, named after one of them; only the first governor
 * other than "performance" is reported. */
static void report_governor(const sink *to)
{
    const int units = possible_units(to);
    for (int i = 0; i < units; i++) {
        char path[96], governor[64];
        snprintf(path, sizeof path, "/sys/devices/system/cpu/cpufreq/policy%d/scaling_governor", i);
        if (read_word(to, path, governor, sizeof governor) && strcmp(governor, "performance") != 0) {
            report(to, "governor %s", governor);
            return;
        }
    }
}

static void report_settings(const sink *to)
{
    report_governor(to);
    if (reads_as(to, "/sys/devices/system/cpu/intel_pstate/no_turbo", "0") ||
        reads_as(to, "/sys/devices/system/cpu/cpufreq/boost", "1"))
        report(to, "turbo on");
    if (reads_as(to, "/sys/devices/system/cpu/smt/active", "1"))
        report(to, "threads share cores (SMT on)");
}

static void report_hypervisor(const sink *to)
{
    char text[8192]; /* longer than the entry of the first processor */
    read_file(to, "/proc/cpuinfo", text, sizeof text);
    const char *flags = strstr(text, "\nflags");
    const char *word = flags ? strstr(flags, " hypervisor") : NULL;
    const char *end = flags ? strchr(flags + 1, '\n') : NULL;
    if (word && (!end || word < end))
        report(to, "virtual machine: its hypervisor may run other guests on the same cores");
}

/* The tightest CPU quota of the control groups, in units. */
static void report_quota(const sink *to)
{
    control_group_limits limits;
    const int error = control_group_read(to->root, &limits);
    if (error && !*to->incomplete) {
        report(to, "unknown: the control group cannot be read: %s", strerrordesc_np(error));
        *to->incomplete = true;
    }
    if (!limits.quota_us)
        return;
    const long long tenths = (limits.quota_us * 10 + limits.period_us / 2) / limits.period_us;
    report(to, "control group limits the process to %lld.%lld units", tenths / 10, tenths % 10);
}

static void report_load(const sink *to)
{
    char word[64];
    if (!read_word(to, "/proc/loadavg", word, sizeof word))
        return;
    char *end;
    long ones = strtol(word, &end, 10); /* parsed as two integers: the kernel writes "0.52" whatever LC_NUMERIC is */
    long tenths = *end == '.' && end[1] >= '0' && end[1] <= '9' ? end[1] - '0' : 0;
    if (ones > 0 || tenths >= 3)
        report(to, "load %ld.%ld", ones, tenths);
}

static void report_swap(const sink *to)
{
    char text[8192];
    read_file(to, "/proc/meminfo", text, sizeof text);
    int64_t total_kib = proc_file_field(text, "SwapTotal"), free_kib = proc_file_field(text, "SwapFree");
    if (free_kib >= 0 && total_kib - free_kib >= 1024)
        report(to, "swap in use, %lld MiB", (long long)(total_kib - free_kib) / 1024);
}

static void report_build(const sink *to)
{
#if !defined(__OPTIMIZE__)
    report(to, "built without optimisation");
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    report(to, "built with a sanitizer");
#endif
    (void)to;
}

void disturbances_of_machine(const char *root, disturbance_callback line, void *context)
{
    bool incomplete = false;
    const sink to = {root, line, context, &incomplete};
    report_settings(&to);
    report_hypervisor(&to);
    report_quota(&to);
    report_load(&to);
    report_swap(&to);
}

void disturbances_report(double sample_s, void (*line)(void *context, const char *text), void *context)
{
    bool incomplete = false;
    const sink to = {"", line, context, &incomplete};
    disturbances_of_machine("", line, context);
    report_build(&to);
    if (!(sample_s > 0.0))
        return;
    const noise_reading before = noise_read("");
    struct timespec pause = {.tv_sec = (time_t)sample_s};
    pause.tv_nsec = (long)((sample_s - (double)pause.tv_sec) * 1e9);
    nanosleep(&pause, NULL);
    const noise_reading after = noise_read("");
    const double fraction = noise_between(&before, &after).others_fraction;
    /* A smaller fraction is within one tick of /proc/stat: 10 ms of half a second on one unit. */
    if (!isnan(fraction) && fraction >= 0.02)
        report(&to, "others use %ld%% of the machine", lround(100.0 * fraction));
}

const char *disturbance_advice(const char *disturbance)
{
    static const char *const advice[][2] = {
        {"governor ", "set the governor performance (cpupower frequency-set -g performance)"},
        {"turbo on", "the frequency depends on load and heat; switch turbo off to compare small differences"},
        {"threads share cores", "pin workers to cores (render.pin: scatter), or switch SMT off"},
        {"virtual machine", "look at steal_fraction in the rows; repeat at other times"},
        {"control group", "use no more threads than that, or raise the limit"},
        {"load ", "stop other programs, or measure with --wait-quiet"},
        {"swap in use", "close programs that use much memory"},
        {"built without", "measure with a release build (make config=release)"},
        {"built with a sanitizer", "measure with a release build (make config=release)"},
        {"others use", "stop other programs, or measure with --wait-quiet"},
        {"unknown: ", "raise the limit on open files (ulimit -n), or check the machine (dmesg)"},
    };
    for (size_t i = 0; i < sizeof advice / sizeof *advice; i++)
        if (strncmp(disturbance, advice[i][0], strlen(advice[i][0])) == 0)
            return advice[i][1];
    return "";
}
