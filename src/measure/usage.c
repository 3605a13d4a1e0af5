/* Readings of resource usage from getrusage, /proc and clocks: of the process and of one thread; and
 * the instructions that callgrind counted. */
#include "measure/usage.h"

#include "measure/clock.h"
#include "measure/proc_file.h"
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

static int64_t difference(int64_t before, int64_t after)
{
    return before < 0 || after < 0 ? -1 : after - before;
}

/* ---- the process ---- */

/* VmHWM rather than ru_maxrss: the latter survives exec, so that a small program started by a large one would appear
 * large. */
static int64_t peak_rss_bytes(int64_t maxrss_kib)
{
    char text[4096];
    int64_t kib = -1;
    if (proc_file_read("", "/proc/self/status", text, sizeof text))
        kib = proc_file_field(text, "VmHWM");
    if (kib < 0)
        kib = maxrss_kib;
    return kib < 0 ? -1 : kib * 1024;
}

usage usage_now(void)
{
    usage u = {0};
    struct rusage r;
    if (getrusage(RUSAGE_SELF, &r) == 0) {
        u.voluntary_switches = r.ru_nvcsw;
        u.involuntary_switches = r.ru_nivcsw;
        u.peak_rss_bytes = peak_rss_bytes(r.ru_maxrss);
    } else {
        u.voluntary_switches = u.involuntary_switches = -1;
        u.peak_rss_bytes = peak_rss_bytes(-1);
    }
    u.cpu_s = clock_process_cpu_s();
    u.wall_s = clock_wall_s();
    return u;
}

/* Linux resets the peak resident memory when 5 is written to this file (proc(5)). */
void usage_reset_peak(void)
{
    int fd = open("/proc/self/clear_refs", O_WRONLY | O_CLOEXEC);
    if (fd < 0)
        return;
    ssize_t written = write(fd, "5", 1);
    (void)written;
    close(fd);
}

usage usage_since(const usage *before)
{
    usage u = usage_now();
    u.wall_s -= before->wall_s;
    u.cpu_s -= before->cpu_s;
    u.voluntary_switches = difference(before->voluntary_switches, u.voluntary_switches);
    u.involuntary_switches = difference(before->involuntary_switches, u.involuntary_switches);
    return u;
}

/* ---- a thread ---- */

bool thread_usage_parse(const char *schedstat, double *runnable_s)
{
    uint64_t running_ns, runnable_ns, slices;
    if (sscanf(schedstat, "%" SCNu64 " %" SCNu64 " %" SCNu64, &running_ns, &runnable_ns, &slices) != 3)
        return false;
    if (running_ns == 0 && runnable_ns == 0 && slices == 0)
        return false;
    *runnable_s = (double)runnable_ns * 1e-9;
    return true;
}

thread_usage thread_usage_unknown(void)
{
    return (thread_usage){(double)NAN, (double)NAN, (double)NAN, (double)NAN, -1, -1};
}

static void read_switches(thread_usage *u)
{
#ifdef RUSAGE_THREAD
    struct rusage r;
    if (getrusage(RUSAGE_THREAD, &r) == 0) {
        u->voluntary_switches = r.ru_nvcsw;
        u->involuntary_switches = r.ru_nivcsw;
    }
#else
    (void)u;
#endif
}

/* Running time comes from the thread's clock: it counts the same as schedstat, which lags by up to a tick (4 ms). */
thread_usage thread_usage_now(void)
{
    char text[128];
    thread_usage u = thread_usage_unknown();
    if (proc_file_read("", "/proc/thread-self/schedstat", text, sizeof text))
        (void)thread_usage_parse(text, &u.runnable_s);
    read_switches(&u);
    u.running_s = clock_thread_cpu_s();
    u.wall_s = clock_wall_s();
    return u;
}

thread_usage thread_usage_since(const thread_usage *before)
{
    thread_usage u = thread_usage_now();
    u.wall_s -= before->wall_s;
    u.running_s -= before->running_s;
    u.runnable_s -= before->runnable_s;
    u.voluntary_switches = difference(before->voluntary_switches, u.voluntary_switches);
    u.involuntary_switches = difference(before->involuntary_switches, u.involuntary_switches);
    const double rest_s = u.wall_s - u.running_s - u.runnable_s;
    u.blocked_s = rest_s < 0.0 ? 0.0 : rest_s; /* the clocks are read one after another; NaN remains */
    return u;
}

/* --- instructions: the files of callgrind, PATH.1, PATH.2, ...; a line "totals: N" has the sum --- */

static const char *path_of_dumps(void)
{
    const char *path = getenv(INSTRUCTION_DUMPS_VARIABLE);
    return path && path[0] ? path : NULL;
}

bool instruction_dumps_exist(void)
{
    return path_of_dumps() != NULL;
}

static int64_t read_total(const char *path)
{
    char line[512];
    int64_t total = -1;
    FILE *file = fopen(path, "re");
    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, "totals: %" SCNd64, &total) == 1)
            break;
    if (file)
        fclose(file);
    return total;
}

int64_t instruction_dumps_next(instruction_dumps *dumps)
{
    const char *path = path_of_dumps();
    char name[1024];
    int64_t total = -1;
    while (path && snprintf(name, sizeof name, "%s.%ld", path, dumps->last + 1) < (int)sizeof name &&
           access(name, R_OK) == 0) {
        dumps->last++;
        total = read_total(name);
        unlink(name);
    }
    return total;
}
