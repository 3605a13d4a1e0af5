/* Tests of the clocks: monotonic, per thread and per process. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "measure/clock.h"

#include <pthread.h>
#include <time.h>

static void the_wall_clock_is_monotonic(void **state)
{
    (void)state;
    int64_t last = clock_wall_ns();
    for (int i = 0; i < 10000; i++) {
        int64_t now = clock_wall_ns();
        assert_true(now >= last);
        last = now;
    }
    double before = (double)clock_wall_ns() * 1e-9, s = clock_wall_s(), after = (double)clock_wall_ns() * 1e-9;
    assert_true(before <= s + 1e-6 && s <= after + 1e-6); /* one clock in two units */
}

/* Runs until the clock has advanced by 20 ms, so that it ends on any machine whose clock runs. */
static void burn(double (*clock_s)(void))
{
    double end = clock_s() + 0.02;
    while (clock_s() < end)
        continue;
}

static void *burn_in_thread(void *context)
{
    (void)context;
    burn(clock_thread_cpu_s);
    return NULL;
}

static void thread_clock_counts_its_own_thread(void **state)
{
    (void)state;
    double mine = clock_thread_cpu_s(), all = clock_process_cpu_s();
    pthread_t other;
    assert_int_equal(pthread_create(&other, NULL, burn_in_thread, NULL), 0);
    pthread_join(other, NULL);
    mine = clock_thread_cpu_s() - mine;
    all = clock_process_cpu_s() - all;
    assert_true(mine >= 0.0);
    assert_true(all - mine >= 0.019); /* the other thread's CPU time counts for the process, not for this thread */
}

static void sleeping_takes_wall_time_and_no_cpu_time(void **state)
{
    (void)state;
    struct timespec pause = {.tv_nsec = 50000000};
    double wall = clock_wall_s(), cpu = clock_thread_cpu_s();
    nanosleep(&pause, NULL);
    wall = clock_wall_s() - wall;
    cpu = clock_thread_cpu_s() - cpu;
    assert_true(wall >= 0.0499);
    assert_true(cpu < wall);
}

static void clock_tick_and_overhead_are_positive(void **state)
{
    (void)state;
    clock_quality wall = clock_wall_quality(), cpu = clock_thread_cpu_quality();
    assert_true(wall.tick_s > 0.0 && wall.tick_s < 1.0);
    assert_true(wall.overhead_s > 0.0 && wall.overhead_s < 1.0);
    assert_true(cpu.tick_s > 0.0 && cpu.overhead_s > 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_wall_clock_is_monotonic),
        cmocka_unit_test(thread_clock_counts_its_own_thread),
        cmocka_unit_test(sleeping_takes_wall_time_and_no_cpu_time),
        cmocka_unit_test(clock_tick_and_overhead_are_positive),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
