/* Tests of base/budget.h: what is free by made-up files of /proc and /sys, the refusal, sizes as text. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/budget.h"
#include "base/file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MIB ((uint64_t)1 << 20)

static char root[] = "/tmp/cuvette-budget-XXXXXX";

static void put(const char *path, const char *text)
{
    char whole[300], folder[300];
    snprintf(whole, sizeof whole, "%s%s", root, path);
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(whole, '/') - whole), whole);
    assert_int_equal(file_make_directory(folder, NULL), STATUS_OK);
    assert_int_equal(file_write(whole, text, NULL), STATUS_OK);
}

static void drop(const char *path)
{
    char whole[300];
    snprintf(whole, sizeof whole, "%s%s", root, path);
    assert_int_equal(unlink(whole), 0);
}

static int make_root(void **state)
{
    (void)state;
    return mkdtemp(root) ? 0 : 1;
}

static int remove_root(void **state)
{
    char command[300];
    (void)state;
    snprintf(command, sizeof command, "rm -rf %s", root);
    return system(command);
}

static void the_least_of_all_limits_counts(void **state)
{
    (void)state;
    const uint64_t all = UINT64_MAX;
    assert_true(memory_budget_free(root, all) == all); /* nothing can be read: nothing limits */
    assert_true(memory_budget_free(root, 7 * MIB) == 7 * MIB);
    put("/proc/meminfo", "MemTotal: 900000 kB\nMemFree: 100 kB\nMemAvailable:   102400 kB\n");
    assert_true(memory_budget_free(root, all) == 100 * MIB);
    assert_true(memory_budget_free(root, 7 * MIB) == 7 * MIB);

    put("/proc/self/cgroup", "0::/outer/inner\n");
    put("/sys/fs/cgroup/outer/inner/memory.max", "max\n");
    assert_true(memory_budget_free(root, all) == 100 * MIB);
    put("/sys/fs/cgroup/outer/memory.max", "83886080\n");
    assert_true(memory_budget_free(root, all) == 80 * MIB); /* the group around it limits */
    put("/sys/fs/cgroup/outer/memory.current", "62914560\n");
    assert_true(memory_budget_free(root, all) == 20 * MIB);
    put("/sys/fs/cgroup/outer/memory.stat", "anon 1\nactive_file 2\ninactive_file 10485760\n");
    assert_true(memory_budget_free(root, all) == 30 * MIB); /* such pages can be dropped */
    put("/sys/fs/cgroup/outer/inner/memory.max", "8388608\n");
    put("/sys/fs/cgroup/outer/inner/memory.current", "9437184\n");
    assert_true(memory_budget_free(root, all) == 0);

    put("/proc/self/cgroup", "5:cpu,cpuacct:/job\n4:memory:/job\n0::/\n");
    assert_true(memory_budget_free(root, all) == 100 * MIB);
    put("/sys/fs/cgroup/memory/job/memory.limit_in_bytes", "52428800\n");
    put("/sys/fs/cgroup/memory/job/memory.usage_in_bytes", "20971520\n");
    put("/sys/fs/cgroup/memory/job/memory.stat", "inactive_file 1048576\ntotal_inactive_file 10485760\n");
    assert_true(memory_budget_free(root, all) == 40 * MIB);
    drop("/proc/meminfo");
    assert_true(memory_budget_free(root, all) == 40 * MIB);
}

static void too_large_a_request_is_refused_with_its_estimate(void **state)
{
    (void)state;
    bool chosen = true;
    diagnostic why = {0};
    const uint64_t left = memory_budget_left(&chosen);
    assert_false(chosen);
    assert_true(left > 0);
    if (left < UINT64_MAX / 2) {
        assert_int_equal(memory_budget_check(2 * left, "use less", &why, "%d things", 3), STATUS_BAD_INPUT);
        assert_non_null(strstr(why.what, "3 things needs about "));
        assert_non_null(strstr(why.what, "three quarters of what is free"));
        assert_string_equal(why.remedy, "use less, or set --memory-limit");
    }
    assert_int_equal(memory_budget_check(MIB, "", &why, "little"), STATUS_OK);
    memory_budget_set(1);
    assert_int_equal(memory_budget_check(MIB, "use less", &why, "it"), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "it needs about 1 MiB of memory, more than the 0 bytes that --memory-limit leaves");
    assert_string_equal(why.remedy, "use less, or raise --memory-limit");
    memory_budget_set((uint64_t)1 << 62);
    assert_true(memory_budget_left(&chosen) > (uint64_t)1 << 61 && chosen);
    assert_int_equal(memory_budget_check((uint64_t)1 << 61, "", &why, "it"), STATUS_OK); /* more than is free */
    memory_budget_set(0);
}

static void sizes_are_read_and_written(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        uint64_t bytes;
    } good[] = {
        {"1", 1},      {"500M", 500 * MIB},      {"500m", 500 * MIB}, {"4G", 4096 * MIB}, {"1.5GiB", 1536 * MIB},
        {"2kb", 2048}, {"1T", (uint64_t)1 << 40}};
    static const char *const bad[] = {"", "M", "0", "-1", "1x", "1MM", "1 M", "1e9", "inf", "9999999T", "1..5"};
    char text[MEMORY_TEXT_MAX];
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        uint64_t bytes = 0;
        assert_true(memory_parse(good[i].text, &bytes));
        assert_true(bytes == good[i].bytes);
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        uint64_t bytes = 77;
        assert_false(memory_parse(bad[i], &bytes));
        assert_true(bytes == 77);
    }
    assert_string_equal(memory_text(999, text), "999 bytes");
    assert_string_equal(memory_text(1000, text), "0.977 KiB");
    assert_string_equal(memory_text(1536 * MIB, text), "1.5 GiB");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_least_of_all_limits_counts),
        cmocka_unit_test(too_large_a_request_is_refused_with_its_estimate),
        cmocka_unit_test(sizes_are_read_and_written),
    };
    return cmocka_run_group_tests(tests, make_root, remove_root);
}
