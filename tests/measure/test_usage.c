/* Tests of clocks, resource usage, hardware counters and disturbances, on recorded files and on this machine. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "measure/clock.h"
#include "measure/machine_noise.h"
#include "measure/proc_file.h"
#include "measure/usage.h"
#include <ftw.h>
#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static void proc_stat_is_read(void **state)
{
    (void)state;
    /* user 100, nice 20, system 30, idle 1000, iowait 50, irq 4, softirq 5, steal 60, guest 70 (within user), 0 */
    static const char text[] = "cpu  100 20 30 1000 50 4 5 60 70 0\n"
                               "cpu0 50 10 15 500 25 2 3 30 35 0\n"
                               "cpu1 50 10 15 500 25 2 2 30 35 0\n"
                               "intr 12345 0 9 cpu2 1\n"
                               "ctxt 99\n";
    proc_stat machine;
    assert_true(proc_stat_parse(text, 100.0, &machine));
    assert_near(machine.busy_s, 2.19, 1e-12);
    assert_near(machine.idle_s, 10.5, 1e-12);
    assert_int_equal(machine.units, 2);
}

/* Two units, 10 ms ticks: in one second 50 ticks of others, 20 of them steal, and 30 of this process. */
static void noise_is_the_rest_of_the_machine(void **state)
{
    (void)state;
    const noise_reading before = {.wall_s = 10, .busy_s = 100, .steal_s = 5, .process_s = 1, .units = 2};
    const noise_reading after = {
        .wall_s = 11, .busy_s = 100.8, .steal_s = 5.2, .process_s = 1.3, .units = 2, .frequency_hz = 2e9};
    const machine_noise noise = noise_between(&before, &after);
    assert_true(fabs(noise.others_fraction - 0.25) < 1e-12);
    assert_true(fabs(noise.steal_fraction - 0.1) < 1e-12);
    assert_true(noise.frequency_hz == 2e9);
    const noise_reading unknown = {.wall_s = 11, .busy_s = NAN, .steal_s = NAN, .process_s = 1.3, .units = NAN};
    assert_true(isnan(noise_between(&before, &unknown).others_fraction));
    assert_true(isnan(noise_between(&before, &unknown).steal_fraction));
}

/* A short interval looks back half a second, a long one to its beginning, whatever readings lie between. */
static void the_window_looks_back_half_a_second(void **state)
{
    (void)state;
    noise_window w = {.count = 0};
    assert_true(isnan(noise_window_since(&w, 0, &(noise_reading){.wall_s = 1}).others_fraction));
    noise_reading at = {.units = 1, .process_s = 0};
    for (int i = 0; i <= 3000; i++) { /* others are busy in every second from 1 s to 1.5 s after its start */
        at.wall_s = 0.001 * i;
        at.busy_s = floor(at.wall_s) * 0.5 + fmin(at.wall_s - floor(at.wall_s), 0.5);
        if (i < 3000)
            noise_window_add(&w, &at);
        assert_true(w.count <= NOISE_READINGS);
    }
    /* At 3 s: the last half second was quiet, the last 0.75 s had a third of use. */
    assert_true(noise_window_since(&w, 2.999, &at).others_fraction < 0.13);
    assert_true(fabs(noise_window_since(&w, 2.25, &at).others_fraction - 1.0 / 3) < 0.06);
}

static void rules_never_look_at_times(void **state)
{
    (void)state;
    const noise_rule usual = noise_rule_default(), all = {0.1, 0.01, 0.2, 0.5}, none = {NAN, NAN, NAN, NAN};
    static const struct {
        machine_noise noise;
        noise_verdict usual, all;
    } cases[] = {
        {{0.05, 0, 2e9, 0, NAN}, NOISE_UNDISTURBED, NOISE_UNDISTURBED},
        {{0.051, 0, 2e9, 0, NAN}, NOISE_DISTURBED, NOISE_UNDISTURBED},
        {{0.2, 0, 2e9, 0, NAN}, NOISE_DISTURBED, NOISE_DISTURBED},
        {{0, 0.02, 2e9, 0, NAN}, NOISE_UNDISTURBED, NOISE_DISTURBED},
        {{0, 0, 1.5e9, 0.25, NAN}, NOISE_UNDISTURBED, NOISE_DISTURBED},
        {{0, 0, 1.7e9, 0.15, NAN}, NOISE_UNDISTURBED, NOISE_UNDISTURBED},
        {{NAN, 0.02, NAN, NAN, NAN}, NOISE_NOT_KNOWN, NOISE_DISTURBED},
        {{NAN, NAN, NAN, NAN, NAN}, NOISE_NOT_KNOWN, NOISE_NOT_KNOWN},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bool broken[NOISE_KINDS];
        assert_int_equal(noise_judge(&usual, &cases[i].noise, broken), cases[i].usual);
        assert_int_equal(broken[NOISE_OTHERS], cases[i].usual == NOISE_DISTURBED);
        assert_int_equal(noise_judge(&all, &cases[i].noise, NULL), cases[i].all);
        assert_int_equal(noise_judge(&none, &cases[i].noise, NULL), NOISE_NOT_KNOWN);
    }
}

/* The highest frequency so far is that of frames; a lower one is a drop. */
static void frequencies_drop_from_the_highest(void **state)
{
    (void)state;
    noise_window w = {.count = 0};
    static const double hz[] = {2e9, 2.5e9, 2e9, NAN, 2.5e9}, drop[] = {0, 0, 0.2, NAN, 0};
    for (int i = 0; i < 5; i++) {
        const noise_reading at = {.wall_s = i, .units = 1, .frequency_hz = hz[i]};
        noise_window_add(&w, &at);
        const double found = noise_window_since(&w, i, &at).frequency_drop;
        assert_true(isnan(drop[i]) ? isnan(found) : fabs(found - drop[i]) < 1e-12);
    }
}

static void noise_is_read_from_any_root(void **state)
{
    (void)state;
    char root[] = "/tmp/cuvette-noise-XXXXXX", line[1600];
    assert_non_null(mkdtemp(root));
    snprintf(line, sizeof line,
             "mkdir -p %s/proc %s/sys/devices/system/cpu/cpu0/cpufreq %s/sys/devices/system/cpu/cpu1/cpufreq && "
             "echo 'cpu  100 0 50 800 50 0 0 25 0 0\ncpu0 1\ncpu1 1' >%s/proc/stat && "
             "echo 2000000 >%s/sys/devices/system/cpu/cpu0/cpufreq/scaling_cur_freq && "
             "echo 3000000 >%s/sys/devices/system/cpu/cpu1/cpufreq/scaling_cur_freq",
             root, root, root, root, root, root);
    assert_int_equal(system(line), 0);
    const noise_reading r = noise_read(root);
    const double tick_s = 1.0 / (double)sysconf(_SC_CLK_TCK);
    assert_true(fabs(r.busy_s - 175 * tick_s) < 1e-9 && fabs(r.steal_s - 25 * tick_s) < 1e-9);
    assert_true(r.units == 2 && r.frequency_hz == 3e9);
    snprintf(line, sizeof line, "rm -r %s/sys %s/proc/stat && echo 'cpu MHz : 2500.123' >%s/proc/cpuinfo", root, root,
             root);
    assert_int_equal(system(line), 0);
    const noise_reading other = noise_read(root);
    assert_true(isnan(other.busy_s) && isnan(other.units) && other.frequency_hz == 2.5e9);
    snprintf(line, sizeof line, "rm -r %s", root);
    assert_int_equal(system(line), 0);
}

static void every_disturbance_has_advice(void **state)
{
    (void)state;
    static const char *const texts[] = {"governor powersave",
                                        "turbo on",
                                        "threads share cores (SMT on)",
                                        "load 3.2",
                                        "control group limits the process to 1.5 units",
                                        "swap in use, 12 MiB",
                                        "others use 40% of the machine",
                                        "built with a sanitizer"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        assert_true(strlen(disturbance_advice(texts[i])) > 10);
    assert_string_equal(disturbance_advice("something else"), "");
}

static void proc_stat_of_other_machines(void **state)
{
    (void)state;
    proc_stat machine;
    assert_true(proc_stat_parse("cpu 1 2 3 4", 1.0, &machine)); /* Linux 2.4: four counts, and no last newline */
    assert_near(machine.busy_s, 6.0, 0.0);
    assert_int_equal(machine.units, 0);
    static const char *const bad[] = {"",
                                      "\n\n",
                                      "cpu",
                                      "cpu ",
                                      "cpu  1 2 3\n",
                                      "cpu  0 0 0 0 0 0 0 0 0 0\ncpu0 0 0 0 0\n",
                                      "cpu0 1 2 3 4\n",
                                      "cpu  a b c d\n",
                                      "intr 1 2 3 4 5\n",
                                      "cpu  -1 2 3 4\n"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        assert_false(proc_stat_parse(bad[i], 100.0, &machine));
    assert_false(proc_stat_parse("cpu  1 2 3 4\n", 0.0, &machine));
}

static void fields_of_proc_files_are_found(void **state)
{
    (void)state;
    static const char text[] = "Name:\tcuvette\nVmHWM:\t    1234 kB\nVmHWMx:\t 9 kB\nEmpty:\n";
    assert_int_equal(proc_file_field(text, "VmHWM"), 1234);
    assert_int_equal(proc_file_field(text, "Vm"), -1);
    assert_int_equal(proc_file_field(text, "Name"), -1);
    assert_int_equal(proc_file_field("", "Name"), -1);
    char read[8];
    assert_false(proc_file_read("/nowhere", "/file", read, sizeof read));
    assert_string_equal(read, "");
    assert_true(proc_file_read("/proc", "/self/status", read, sizeof read));
    assert_int_equal(strlen(read), sizeof read - 1);
}

static void the_share_of_other_processes_is_computed(void **state)
{
    (void)state;
    /* 2 s on 4 units are 8 s; 3 of the 5 busy seconds belong to other processes */
    const noise_reading before = {.units = 4.0};
    noise_reading after = {.wall_s = 2.0, .process_s = 2.0, .busy_s = 5.0, .units = 4.0};
    assert_near(noise_between(&before, &after).others_fraction, 0.375, 1e-15);
    after.busy_s = 1.99;
    assert_near(noise_between(&before, &after).others_fraction, 0.0, 0.0);
    after.busy_s = 20.0;
    assert_near(noise_between(&before, &after).others_fraction, 1.0, 0.0);
    after.busy_s = NAN;
    assert_true(isnan(noise_between(&before, &after).others_fraction));
    after.busy_s = 5.0;
    after.wall_s = 0.0;
    assert_true(isnan(noise_between(&before, &after).others_fraction));
}

static void *burn(void *context)
{
    double end = clock_thread_cpu_s() + 0.02;
    while (clock_thread_cpu_s() < end)
        *(volatile int *)context += 1;
    return NULL;
}

static void cpu_time_includes_all_threads(void **state)
{
    (void)state;
    usage before = usage_now();
    pthread_t other;
    int spins[2] = {0, 0};
    assert_int_equal(pthread_create(&other, NULL, burn, &spins[0]), 0);
    burn(&spins[1]);
    pthread_join(other, NULL);
    struct timespec pause = {.tv_nsec = 1000000};
    nanosleep(&pause, NULL);
    usage d = usage_since(&before);
    assert_true(d.cpu_s >= 0.039); /* both burn loops are measured by CPU clocks */
    assert_true(d.wall_s > 0.0 && d.wall_s < before.wall_s + d.wall_s);
    assert_true(d.voluntary_switches >= 1 && d.involuntary_switches >= 0);
}

static void missing_values_stay_missing_in_a_difference(void **state)
{
    (void)state;
    usage before = usage_now();
    before.voluntary_switches = -1;
    usage d = usage_since(&before);
    assert_int_equal(d.voluntary_switches, -1);
}

/* --- one thread --- */

static void schedstat_is_read(void **state)
{
    (void)state;
    double runnable_s = 0.0;
    assert_true(thread_usage_parse("2500000000 1250000000 42\n", &runnable_s));
    assert_near(runnable_s, 1.25, 1e-12);
    assert_true(thread_usage_parse("0 106848 1\n", &runnable_s)); /* a new thread: its running time lags */
    assert_near(runnable_s, 106848e-9, 1e-15);
    static const char *const bad[] = {"", "\n", "0 0 0\n", "1 2\n", "a b c\n", "-"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        assert_false(thread_usage_parse(bad[i], &runnable_s));
}

static pthread_barrier_t all_begin;

static void *burn_and_sleep(void *context)
{
    int spins = 0;
    const thread_usage before = thread_usage_now();
    pthread_barrier_wait(&all_begin);
    burn(&spins);
    nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
    *(thread_usage *)context = thread_usage_since(&before);
    return NULL;
}

/* Each of the four threads on one unit needs 20 ms of it, so one that ends last waits for the other three. */
static void a_thread_runs_waits_for_a_unit_or_is_blocked(void **state)
{
    (void)state;
    enum { THREADS = 4 };
    pthread_t threads[THREADS];
    thread_usage made[THREADS];
    cpu_set_t all, one;
    assert_int_equal(sched_getaffinity(0, sizeof all, &all), 0);
    CPU_ZERO(&one);
    for (size_t i = 0; CPU_COUNT(&one) == 0; i++)
        if (CPU_ISSET(i, &all))
            CPU_SET(i, &one);
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0); /* threads inherit it */
    assert_int_equal(pthread_barrier_init(&all_begin, NULL, THREADS), 0);
    for (int i = 0; i < THREADS; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, burn_and_sleep, &made[i]), 0);
    for (int i = 0; i < THREADS; i++)
        assert_int_equal(pthread_join(threads[i], NULL), 0);
    pthread_barrier_destroy(&all_begin);
    assert_int_equal(sched_setaffinity(0, sizeof all, &all), 0);
    double longest_s = 0.0;
    for (int i = 0; i < THREADS; i++) {
        const thread_usage *u = &made[i];
        assert_true(u->running_s >= 0.02 && u->wall_s >= 0.04);
        assert_true(u->voluntary_switches >= 1 && u->involuntary_switches >= 0);
        if (isnan(u->runnable_s)) /* not Linux, or without schedstat */
            return;
        assert_true(u->blocked_s >= 0.019);
        assert_near(u->running_s + u->runnable_s + u->blocked_s, u->wall_s, 1e-4);
        longest_s = fmax(longest_s, u->runnable_s);
    }
    assert_true(longest_s >= 0.03);
}

static void unknown_usage_of_a_thread_stays_unknown(void **state)
{
    (void)state;
    const thread_usage none = thread_usage_unknown(), d = thread_usage_since(&none);
    assert_true(isnan(d.wall_s) && isnan(d.running_s) && isnan(d.runnable_s) && isnan(d.blocked_s));
    assert_int_equal(d.voluntary_switches, -1);
    assert_int_equal(d.involuntary_switches, -1);
}

static void peak_memory_does_not_decrease_after_freeing(void **state)
{
    (void)state;
    enum { BYTES = 48 << 20 };
    int64_t before = usage_now().peak_rss_bytes;
    assert_true(before > 0);
    char *block = malloc(BYTES);
    assert_non_null(block);
    memset(block, 1, BYTES);
    assert_int_equal(block[BYTES / 2], 1);
    free(block);
    usage later = usage_now();
    assert_true(later.peak_rss_bytes >= BYTES && later.peak_rss_bytes >= before);
    assert_int_equal(usage_since(&later).peak_rss_bytes >= later.peak_rss_bytes, 1); /* not a difference */
}

static void assert_grows(int64_t first, int64_t second)
{
    assert_true((first == -1 && second == -1) || (first >= 0 && second > first));
}

static void hardware_counters_increase_or_are_unavailable(void **state)
{
    (void)state;
    hardware_counter *counter = hardware_counter_create();
    assert_non_null(counter);
    int spins = 0;
    burn(&spins);
    hardware_counts first = hardware_counter_read(counter);
    pthread_t other;
    assert_int_equal(pthread_create(&other, NULL, burn, &spins), 0);
    pthread_join(other, NULL);
    hardware_counts second = hardware_counter_read(counter);
    assert_grows(first.cycles, second.cycles);
    assert_grows(first.instructions, second.instructions);
    assert_true(second.branch_misses >= first.branch_misses && first.branch_misses >= -1);
    assert_true(second.cache_misses >= first.cache_misses && first.cache_misses >= -1);
    hardware_counter_destroy(counter);

    hardware_counts none = hardware_counter_read(NULL);
    assert_true(none.cycles == -1 && none.instructions == -1 && none.branch_misses == -1 && none.cache_misses == -1);
    hardware_counter_destroy(NULL);
}

/* --- a machine made of files --- */

static void put(const char *root, const char *path, const char *text)
{
    char full[512];
    snprintf(full, sizeof full, "%s%s", root, path);
    for (char *slash = strchr(full + strlen(root) + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        mkdir(full, 0777);
        *slash = '/';
    }
    FILE *file = fopen(full, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static int remove_entry(const char *path, const struct stat *s, int kind, struct FTW *where)
{
    (void)s, (void)kind, (void)where;
    return remove(path);
}

static void collect(void *context, const char *text)
{
    char *all = context;
    strcat(strcat(all, text), "\n");
}

static char *make_root(char *root, size_t size)
{
    const char *parent = getenv("TMPDIR");
    snprintf(root, size, "%s/cuvette-usage-XXXXXX", parent ? parent : "/tmp");
    assert_non_null(mkdtemp(root));
    return root;
}

static void disturbances_of_the_machine_are_reported(void **state)
{
    (void)state;
    char root[256], message[2048] = "";
    make_root(root, sizeof root);
    put(root, "/sys/devices/system/cpu/cpufreq/policy0/scaling_governor", "performance\n");
    put(root, "/sys/devices/system/cpu/cpufreq/policy4/scaling_governor", "powersave\n");
    put(root, "/sys/devices/system/cpu/possible", "0-1,4\n");
    put(root, "/sys/devices/system/cpu/intel_pstate/no_turbo", "0\n");
    put(root, "/sys/devices/system/cpu/smt/active", "1\n");
    put(root, "/sys/fs/cgroup/cpu.max", "150000 100000\n");
    put(root, "/proc/cpuinfo", "processor\t: 0\nflags\t\t: fpu sse2 hypervisor lahf_lm\n");
    put(root, "/proc/loadavg", "3.25 1.00 0.50 1/200 4242\n");
    put(root, "/proc/meminfo", "MemTotal: 8000000 kB\nSwapTotal:  4096000 kB\nSwapFree:  1024000 kB\n");
    disturbances_of_machine(root, collect, message);
    assert_string_equal(message, "governor powersave\n"
                                 "turbo on\n"
                                 "threads share cores (SMT on)\n"
                                 "virtual machine: its hypervisor may run other guests on the same cores\n"
                                 "control group limits the process to 1.5 units\n"
                                 "load 3.2\n"
                                 "swap in use, 3000 MiB\n");
    assert_int_equal(nftw(root, remove_entry, 8, FTW_DEPTH | FTW_PHYS), 0);
}

static void no_disturbances_are_reported_for_a_quiet_machine(void **state)
{
    (void)state;
    char root[256], message[2048] = "";
    make_root(root, sizeof root);
    put(root, "/sys/devices/system/cpu/cpufreq/policy0/scaling_governor", "performance\n");
    put(root, "/sys/devices/system/cpu/intel_pstate/no_turbo", "1\n");
    put(root, "/sys/devices/system/cpu/cpufreq/boost", "0\n");
    put(root, "/sys/devices/system/cpu/smt/active", "0\n");
    put(root, "/sys/fs/cgroup/cpu.max", "max 100000\n");
    put(root, "/proc/cpuinfo", "processor\t: 0\nflags\t\t: fpu sse2\nbugs : hypervisor\n");
    put(root, "/proc/loadavg", "0.12 1.00 0.50 1/200 4242\n");
    put(root, "/proc/meminfo", "MemTotal: 8000000 kB\nSwapTotal:  4096000 kB\nSwapFree:  4096000 kB\n");
    disturbances_of_machine(root, collect, message);
    assert_string_equal(message, "");
    assert_int_equal(nftw(root, remove_entry, 8, FTW_DEPTH | FTW_PHYS), 0);
    disturbances_of_machine("/nowhere", collect, message); /* a system without /proc and /sys */
    assert_string_equal(message, "");
}

/* Files that no process can open for want of descriptors are not taken for ones that show nothing. */
static void files_that_cannot_be_read_are_reported_once(void **state)
{
    (void)state;
    char root[256], message[2048] = "";
    struct rlimit all, none;
    make_root(root, sizeof root);
    put(root, "/sys/devices/system/cpu/cpufreq/policy0/scaling_governor", "performance\n");
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &all), 0);
    none = all;
    none.rlim_cur = 0;
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &none), 0);
    disturbances_of_machine(root, collect, message);
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &all), 0);
    assert_string_equal(message, "unknown: /sys/devices/system/cpu/possible cannot be read: Too many open files\n");
    assert_string_not_equal(disturbance_advice(message), "");
    assert_int_equal(nftw(root, remove_entry, 8, FTW_DEPTH | FTW_PHYS), 0);
}

static void disturbances_of_this_machine_are_reported_as_lines(void **state)
{
    (void)state;
    char message[4096] = "";
    disturbances_report(0.05, collect, message);
    assert_null(strstr(message, "\n\n"));
}

/* Clocks: monotonic, per thread and per process. */

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
static void use_cpu_time(double (*clock_s)(void))
{
    double end = clock_s() + 0.02;
    while (clock_s() < end)
        continue;
}

static void *burn_in_thread(void *context)
{
    (void)context;
    use_cpu_time(clock_thread_cpu_s);
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
        cmocka_unit_test(proc_stat_is_read),
        cmocka_unit_test(noise_is_the_rest_of_the_machine),
        cmocka_unit_test(the_window_looks_back_half_a_second),
        cmocka_unit_test(rules_never_look_at_times),
        cmocka_unit_test(frequencies_drop_from_the_highest),
        cmocka_unit_test(noise_is_read_from_any_root),
        cmocka_unit_test(every_disturbance_has_advice),
        cmocka_unit_test(proc_stat_of_other_machines),
        cmocka_unit_test(fields_of_proc_files_are_found),
        cmocka_unit_test(the_share_of_other_processes_is_computed),
        cmocka_unit_test(cpu_time_includes_all_threads),
        cmocka_unit_test(missing_values_stay_missing_in_a_difference),
        cmocka_unit_test(schedstat_is_read),
        cmocka_unit_test(a_thread_runs_waits_for_a_unit_or_is_blocked),
        cmocka_unit_test(unknown_usage_of_a_thread_stays_unknown),
        cmocka_unit_test(peak_memory_does_not_decrease_after_freeing),
        cmocka_unit_test(hardware_counters_increase_or_are_unavailable),
        cmocka_unit_test(disturbances_of_the_machine_are_reported),
        cmocka_unit_test(no_disturbances_are_reported_for_a_quiet_machine),
        cmocka_unit_test(files_that_cannot_be_read_are_reported_once),
        cmocka_unit_test(disturbances_of_this_machine_are_reported_as_lines),
        cmocka_unit_test(the_wall_clock_is_monotonic),
        cmocka_unit_test(thread_clock_counts_its_own_thread),
        cmocka_unit_test(sleeping_takes_wall_time_and_no_cpu_time),
        cmocka_unit_test(clock_tick_and_overhead_are_positive),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
