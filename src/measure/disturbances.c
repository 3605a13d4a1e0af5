/* Disturbances by the machine's settings and load. */
#include "measure/usage.h"

#include "base/control_group.h"
#include "measure/proc_file.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct report {
    const char *root;
    disturbance_line line;
    void *context;
    bool *incomplete; /* a file that could not be read was reported: once is enough */
} report;

__attribute__((format(printf, 2, 3))) static void say(const report *to, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    to->line(to->context, text);
}

/* Reads a file. What a file contains that cannot be read, for lack of open files or for a broken disk, may disturb:
 * that is reported, once. */
static bool read_file(const report *to, const char *path, char *text, size_t size)
{
    if (proc_file_read(to->root, path, text, size))
        return true;
    const int reason = errno;
    if (*to->incomplete || (reason != EMFILE && reason != ENFILE && reason != ENOMEM && reason != EIO))
        return false;
    say(to, "unknown: %.96s cannot be read: %s", path, strerrordesc_np(reason));
    *to->incomplete = true;
    return false;
}

/* Reads the first word of a file; false if there is none. */
static bool read_word(const report *from, const char *path, char *word, size_t size)
{
    if (!read_file(from, path, word, size))
        return false;
    word[strcspn(word, " \t\n")] = '\0';
    return word[0] != '\0';
}

static bool reads_as(const report *from, const char *path, const char *expected)
{
    char word[64];
    return read_word(from, path, word, sizeof word) && strcmp(word, expected) == 0;
}

/* One more than the highest number of a unit, as in "0-3,8"; more than any has if that is not known. */
static int possible_units(const report *to)
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

/* Each policy directory is a group of units that share a frequency, with the number of one of them; only the first
 * governor other than "performance" is reported. */
static void check_governor(const report *to)
{
    const int units = possible_units(to);
    for (int i = 0; i < units; i++) {
        char path[96], governor[64];
        snprintf(path, sizeof path, "/sys/devices/system/cpu/cpufreq/policy%d/scaling_governor", i);
        if (read_word(to, path, governor, sizeof governor) && strcmp(governor, "performance") != 0) {
            say(to, "governor %s", governor);
            return;
        }
    }
}

static void check_settings(const report *to)
{
    check_governor(to);
    if (reads_as(to, "/sys/devices/system/cpu/intel_pstate/no_turbo", "0") ||
        reads_as(to, "/sys/devices/system/cpu/cpufreq/boost", "1"))
        say(to, "turbo on");
    if (reads_as(to, "/sys/devices/system/cpu/smt/active", "1"))
        say(to, "threads share cores (SMT on)");
}

static void check_hypervisor(const report *to)
{
    char text[8192]; /* longer than the entry of the first processor */
    read_file(to, "/proc/cpuinfo", text, sizeof text);
    const char *flags = strstr(text, "\nflags");
    const char *word = flags ? strstr(flags, " hypervisor") : NULL;
    const char *end = flags ? strchr(flags + 1, '\n') : NULL;
    if (word && (!end || word < end))
        say(to, "virtual machine: its hypervisor may run others on the same cores");
}

/* The tightest CPU quota of the control groups, in units. */
static void check_quota(const report *to)
{
    control_group_limits limits;
    const int error = control_group_read(to->root, &limits);
    if (error && !*to->incomplete) {
        say(to, "unknown: the control group cannot be read: %s", strerrordesc_np(error));
        *to->incomplete = true;
    }
    if (!limits.quota_us)
        return;
    const long long tenths = (limits.quota_us * 10 + limits.period_us / 2) / limits.period_us;
    say(to, "control group limits the process to %lld.%lld units", tenths / 10, tenths % 10);
}

static void check_load(const report *to)
{
    char word[64];
    if (!read_word(to, "/proc/loadavg", word, sizeof word))
        return;
    char *end;
    long whole = strtol(word, &end, 10); /* parsed as two integers: the kernel writes "0.52" whatever LC_NUMERIC is */
    long tenths = *end == '.' && end[1] >= '0' && end[1] <= '9' ? end[1] - '0' : 0;
    if (whole > 0 || tenths >= 3)
        say(to, "load %ld.%ld", whole, tenths);
}

static void check_swap(const report *to)
{
    char text[8192];
    read_file(to, "/proc/meminfo", text, sizeof text);
    int64_t total_kib = proc_file_field(text, "SwapTotal"), free_kib = proc_file_field(text, "SwapFree");
    if (free_kib >= 0 && total_kib - free_kib >= 1024)
        say(to, "swap in use, %lld MiB", (long long)(total_kib - free_kib) / 1024);
}

static void check_build(const report *to)
{
#if !defined(__OPTIMIZE__)
    say(to, "built without optimisation");
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    say(to, "built with a sanitizer");
#endif
    (void)to;
}

void disturbances_of_machine(const char *root, disturbance_line line, void *context)
{
    bool incomplete = false;
    const report to = {root, line, context, &incomplete};
    check_settings(&to);
    check_hypervisor(&to);
    check_quota(&to);
    check_load(&to);
    check_swap(&to);
}

void usage_disturbances(double sample_s, void (*line)(void *context, const char *text), void *context)
{
    bool incomplete = false;
    const report to = {"", line, context, &incomplete};
    disturbances_of_machine("", line, context);
    check_build(&to);
    if (!(sample_s > 0.0))
        return;
    usage before = usage_now();
    struct timespec pause = {.tv_sec = (time_t)sample_s};
    pause.tv_nsec = (long)((sample_s - (double)pause.tv_sec) * 1e9);
    nanosleep(&pause, NULL);
    usage passed = usage_since(&before);
    double fraction = usage_others_fraction(&passed);
    /* Less is within one tick of /proc/stat: 10 ms of half a second on one unit. */
    if (!isnan(fraction) && fraction >= 0.02)
        say(&to, "others use %ld%% of the machine", lround(100.0 * fraction));
}

const char *usage_advice(const char *disturbance)
{
    static const char *const advice[][2] = {
        {"governor ", "set the governor performance (cpupower frequency-set -g performance)"},
        {"turbo on", "the frequency depends on load and heat; switch turbo off to compare small differences"},
        {"threads share cores", "pin workers to cores (render.pin: scatter), or switch SMT off"},
        {"virtual machine", "look at steal_fraction in the rows; repeat at other times"},
        {"control group", "use at most that many threads, or raise the limit"},
        {"load ", "stop other programs, or measure with --wait-quiet"},
        {"swap in use", "close programs that use much memory"},
        {"built without", "measure with make (config=release)"},
        {"built with a sanitizer", "measure with make (config=release)"},
        {"others use", "stop other programs, or measure with --wait-quiet"},
        {"unknown: ", "raise the limit on open files (ulimit -n), or check the machine (dmesg)"},
    };
    for (size_t i = 0; i < sizeof advice / sizeof *advice; i++)
        if (strncmp(disturbance, advice[i][0], strlen(advice[i][0])) == 0)
            return advice[i][1];
    return "";
}
