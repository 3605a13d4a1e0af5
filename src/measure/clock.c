/* Clocks on clock_gettime, and measurements of their resolution. */
#include "measure/clock.h"

#include <time.h>

enum { QUALITY_STEPS = 200 };                     /* steps of a clock, of which the smallest is reported */
static const int64_t quality_limit_ns = 20000000; /* time limit for one clock: a coarse one may tick only every 10 ms */

static int64_t read_ns(clockid_t clock)
{
    struct timespec t;
    if (clock_gettime(clock, &t) != 0)
        return 0;
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

static double read_s(clockid_t clock)
{
    return (double)read_ns(clock) * 1e-9;
}

double clock_wall_s(void)
{
    return read_s(CLOCK_MONOTONIC);
}

struct timespec clock_after(double seconds)
{
    const int64_t at_ns = clock_wall_ns() + (int64_t)(seconds * 1e9);
    return (struct timespec){(time_t)(at_ns / 1000000000), (long)(at_ns % 1000000000)};
}

int64_t clock_wall_ns(void)
{
    return read_ns(CLOCK_MONOTONIC);
}

double clock_thread_cpu_s(void)
{
    return read_s(CLOCK_THREAD_CPUTIME_ID);
}

double clock_process_cpu_s(void)
{
    return read_s(CLOCK_PROCESS_CPUTIME_ID);
}

static clock_quality quality(clockid_t clock)
{
    int64_t begin = clock_wall_ns(), end = begin, tick = 0, last = read_ns(clock);
    int64_t readings = 0;
    for (int steps = 0; steps < QUALITY_STEPS && end - begin < quality_limit_ns;) {
        int64_t now = read_ns(clock);
        if (now > last) {
            if (tick == 0 || now - last < tick)
                tick = now - last;
            steps++;
        }
        last = now;
        readings++;
        if (readings % 16 == 0)
            end = clock_wall_ns();
    }

    enum { COST_READINGS = 1000 };
    begin = clock_wall_ns();
    for (int i = 0; i < COST_READINGS; i++)
        last = read_ns(clock);
    end = clock_wall_ns();

    struct timespec resolution;
    if (tick == 0 && clock_getres(clock, &resolution) == 0) /* no tick was seen: use the kernel's value */
        tick = (int64_t)resolution.tv_sec * 1000000000 + resolution.tv_nsec;
    return (clock_quality){.tick_s = (double)tick * 1e-9, .overhead_s = (double)(end - begin) * 1e-9 / COST_READINGS};
}

clock_quality clock_wall_quality(void)
{
    return quality(CLOCK_MONOTONIC);
}

clock_quality clock_thread_cpu_quality(void)
{
    return quality(CLOCK_THREAD_CPUTIME_ID);
}
