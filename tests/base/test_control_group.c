/* Tests of base/os_process.h with recorded files of /proc and /sys: version 1 and 2, nested groups, slices of
 * systemd, containers; and of the environment of a run, which the limits are part of. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/file.h"
#include "base/os_process.h"
#include "measure/machine_noise.h"
#include "measure/usage.h"
#include "study/rows/environment.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct machine {
    char root[64];
} machine;

static int make_root(void **state)
{
    machine *m = malloc(sizeof *m);
    strcpy(m->root, "/tmp/cuvette-group-XXXXXX");
    *state = m;
    return mkdtemp(m->root) ? 0 : 1;
}

static int remove_root(void **state)
{
    machine *m = *state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf %s", m->root);
    const int code = system(command);
    free(m);
    return code;
}

static void put(const machine *m, const char *path, const char *text)
{
    char whole[300], folder[300];
    snprintf(whole, sizeof whole, "%s%s", m->root, path);
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(whole, '/') - whole), whole);
    assert_int_equal(file_make_directory(folder, NULL), STATUS_OK);
    assert_int_equal(file_write(whole, text, NULL), STATUS_OK);
}

static control_group_limits read_limits(const machine *m)
{
    control_group_limits limits;
    assert_int_equal(control_group_read(m->root, &limits), 0);
    return limits;
}

static void collect(void *context, const char *text)
{
    strcat(strcat(context, text), "\n");
}

static void expect(const machine *m, long long quota, long long period, uint64_t memory, const char *said)
{
    char lines[1000] = "";
    run_environment e;
    const control_group_limits limits = read_limits(m);
    assert_int_equal(limits.quota_us, quota);
    assert_int_equal(limits.period_us, period);
    assert_true(limits.memory_bytes == memory);
    disturbances_of_machine(m->root, collect, lines);
    assert_string_equal(lines, said);
    assert_int_equal(environment_read(m->root, ISA_BASE, &e, NULL), STATUS_OK);
}

static void without_files_nothing_is_limited(void **state)
{
    expect(*state, 0, 0, UINT64_MAX, "");
}

/* systemd-run -p CPUQuota=20% -p MemoryMax=1G: a scope in a slice; the slice may be tighter. */
static void slices_of_systemd_limit(void **state)
{
    const machine *m = *state;
    put(m, "/proc/self/cgroup", "0::/user.slice/run-1.scope\n");
    put(m, "/sys/fs/cgroup/user.slice/cpu.max", "max 100000\n");
    put(m, "/sys/fs/cgroup/user.slice/run-1.scope/cpu.max", "20000 100000\n");
    put(m, "/sys/fs/cgroup/user.slice/run-1.scope/memory.max", "1073741824\n");
    expect(m, 20000, 100000, 1073741824, "control group limits the process to 0.2 units\n");
    put(m, "/sys/fs/cgroup/user.slice/cpu.max", "5000 50000\n");
    put(m, "/sys/fs/cgroup/user.slice/memory.max", "536870912\n");
    expect(m, 5000, 50000, 536870912, "control group limits the process to 0.1 units\n");
    put(m, "/proc/self/cgroup", "0::/\n");
    expect(m, 0, 0, UINT64_MAX, "");
}

/* Version 1 has a tree for each controller, or for several; -1 and a number near 2^63 are no limits. */
static void version_one_limits(void **state)
{
    const machine *m = *state;
    put(m, "/proc/self/cgroup", "12:cpuset:/\n5:cpu,cpuacct:/outer/inner\n4:memory:/job\n1:name=systemd:/x\n");
    put(m, "/sys/fs/cgroup/cpu/outer/inner/cpu.cfs_quota_us", "-1\n");
    put(m, "/sys/fs/cgroup/cpu/outer/inner/cpu.cfs_period_us", "100000\n");
    put(m, "/sys/fs/cgroup/memory/job/memory.limit_in_bytes", "9223372036854771712\n");
    expect(m, 0, 0, UINT64_MAX, "");
    put(m, "/sys/fs/cgroup/cpu/outer/cpu.cfs_quota_us", "150000\n");
    put(m, "/sys/fs/cgroup/cpu/outer/cpu.cfs_period_us", "100000\n");
    put(m, "/sys/fs/cgroup/memory/memory.limit_in_bytes", "2147483648\n");
    expect(m, 150000, 100000, 2147483648, "control group limits the process to 1.5 units\n");
    put(m, "/sys/fs/cgroup/cpu/outer/inner/cpu.cfs_quota_us", "30000\n");
    expect(m, 30000, 100000, 2147483648, "control group limits the process to 0.3 units\n");
}

/* The path is that of the host, and the tree begins at the container's own group. */
static void containers_limit(void **state)
{
    const machine *m = *state;
    put(m, "/proc/self/cgroup", "5:cpu,cpuacct:/docker/0123abcd\n0::/system.slice/docker-0123abcd.scope\n");
    put(m, "/sys/fs/cgroup/cpu/cpu.cfs_quota_us", "50000\n");
    put(m, "/sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
    expect(m, 50000, 100000, UINT64_MAX, "control group limits the process to 0.5 units\n");
    put(m, "/sys/fs/cgroup/cpu.max", "25000 100000\n");
    expect(m, 25000, 100000, UINT64_MAX, "control group limits the process to 0.3 units\n");
}

static void environment_of(const machine *m, run_environment *e)
{
    assert_int_equal(environment_read(m->root, ISA_BASE, e, NULL), STATUS_OK);
}

/* Quota, memory and the units of the affinity mask, not only their number, tell environments apart. */
static void limits_are_part_of_the_environment(void **state)
{
    const machine *m = *state;
    run_environment whole, quota, memory, first, second, typed_first, typed_second;
    put(m, "/sys/devices/system/cpu/online", "0-3\n");
    put(m, "/proc/self/status", "Name:\tcuvette\nCpus_allowed_list:\t0-3\n");
    put(m, "/proc/self/cgroup", "5:cpu,cpuacct:/a\n4:memory:/a\n");
    environment_of(m, &whole);
    put(m, "/sys/fs/cgroup/cpu/a/cpu.cfs_quota_us", "20000\n");
    put(m, "/sys/fs/cgroup/cpu/a/cpu.cfs_period_us", "100000\n");
    environment_of(m, &quota);
    assert_string_not_equal(whole.key, quota.key);
    put(m, "/sys/fs/cgroup/cpu/a/cpu.cfs_quota_us", "-1\n");
    put(m, "/sys/fs/cgroup/memory/a/memory.limit_in_bytes", "1000000000\n");
    environment_of(m, &memory);
    assert_string_not_equal(whole.key, memory.key);
    put(m, "/sys/fs/cgroup/memory/a/memory.limit_in_bytes", "9223372036854771712\n");
    put(m, "/proc/self/status", "Name:\tcuvette\nCpus_allowed_list:\t0\n");
    environment_of(m, &first);
    put(m, "/proc/self/status", "Name:\tcuvette\nCpus_allowed_list:\t1\n");
    environment_of(m, &second);
    assert_string_not_equal(first.key, second.key);
    assert_string_not_equal(first.key, whole.key);

    /* Nodes that are declared alike stay alike, whichever units a scheduler gives. */
    setenv("CUVETTE_NODE_TYPE", "small", 1);
    environment_of(m, &typed_second);
    put(m, "/proc/self/status", "Name:\tcuvette\nCpus_allowed_list:\t0\n");
    environment_of(m, &typed_first);
    unsetenv("CUVETTE_NODE_TYPE");
    assert_string_equal(typed_first.key, typed_second.key);
}

/* A worker that ran 0.18 s of 2.2 s was stopped; with more workers than units the longest one counts. */
static void stalled_workers_are_disturbed(void **state)
{
    (void)state;
    const noise_rule rule = noise_rule_default();
    machine_noise noise = noise_unknown();
    bool broken[NOISE_KINDS];
    assert_true(isnan(noise_stalled(0, 2, 1.0, 1.0, 1.0)));
    assert_true(fabs(noise_stalled(1, 2, 2.2, 2.2, 0.18) - (1 - 0.18 / 2.2)) < 1e-12);
    assert_true(noise_stalled(2, 2, 2.0, 1.0, 2.0) == 0.0 && noise_stalled(2, 2, 2.0, 1.0, 2.001) == 0.0);
    assert_true(fabs(noise_stalled(2, 2, 2.0, 1.0, 1.5) - 0.25) < 1e-12);
    assert_true(noise_stalled(64, 2, 64.0, 1.0, 1.9) == 0.0); /* they waited for one another */
    assert_true(fabs(noise_stalled(64, 2, 128.0, 2.0, 0.5) - 0.75) < 1e-12);
    noise.others_fraction = 0.0;
    noise.stalled_fraction = 0.05;
    assert_int_equal(noise_judge(&rule, &noise, broken), NOISE_UNDISTURBED);
    noise.stalled_fraction = 0.5;
    assert_int_equal(noise_judge(&rule, &noise, broken), NOISE_DISTURBED);
    assert_true(broken[NOISE_STALLED] && !broken[NOISE_OTHERS]);
}

int main(void)
{
#define WITH_ROOT(test) cmocka_unit_test_setup_teardown(test, make_root, remove_root)
    const struct CMUnitTest tests[] = {
        WITH_ROOT(without_files_nothing_is_limited),
        WITH_ROOT(slices_of_systemd_limit),
        WITH_ROOT(version_one_limits),
        WITH_ROOT(containers_limit),
        WITH_ROOT(limits_are_part_of_the_environment),
        cmocka_unit_test(stalled_workers_are_disturbed),
    };
    return cmocka_run_group_tests_name("control_group", tests, NULL, NULL);
}
