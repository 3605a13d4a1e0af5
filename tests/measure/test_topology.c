/* Tests of the machine's topology: placement of workers by each policy, on described machines and on this one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "measure/topology.h"

#include <errno.h>
#include <sched.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

static bool refuses;

/* Takes the place of the C library's function. */
int sched_setaffinity(pid_t thread, size_t size, const cpu_set_t *set)
{
    errno = EINVAL;
    return refuses ? -1 : (int)syscall(SYS_sched_setaffinity, thread, size, set);
}

static topology *described(const char *text)
{
    topology *machine = NULL;
    diagnostic why;
    assert_int_equal(topology_from_synthetic(text, &machine, &why), STATUS_OK);
    return machine;
}

static void assert_places(const topology *machine, pin_policy policy, int count, const int *expected)
{
    for (int i = 0; i < count; i++)
        assert_int_equal(topology_place(machine, policy, i, count), expected[i]);
}

/* Two packages of four cores of two threads, numbered along the tree: core c has the units 2c and 2c + 1. */
static void placement_on_two_packages_by_each_policy(void **state)
{
    (void)state;
    topology *machine = described("pack:2 core:4 pu:2");
    assert_int_equal(topology_pu_count(machine), 16);
    assert_int_equal(topology_core_count(machine), 8);
    assert_int_equal(topology_package_count(machine), 2);

    static const int along[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    for (int count = 1; count <= 16; count++)
        assert_places(machine, PIN_COMPACT, count, along);

    assert_places(machine, PIN_SCATTER, 1, (int[]){0});
    assert_places(machine, PIN_SCATTER, 2, (int[]){0, 8});        /* one per package */
    assert_places(machine, PIN_SCATTER, 3, (int[]){0, 4, 8});     /* the first package takes the odd one */
    assert_places(machine, PIN_SCATTER, 4, (int[]){0, 4, 8, 12}); /* every other core */
    assert_places(machine, PIN_SCATTER, 8, (int[]){0, 2, 4, 6, 8, 10, 12, 14});
    assert_places(machine, PIN_SCATTER, 10, (int[]){0, 2, 4, 6, 8, 10, 12, 14, 1, 9}); /* and again one per package */
    assert_places(machine, PIN_SCATTER, 16, (int[]){0, 2, 4, 6, 8, 10, 12, 14, 1, 3, 5, 7, 9, 11, 13, 15});
    topology_destroy(machine);
}

/* As Linux numbers most machines: first the first threads of all cores, then the second ones. */
static void placement_uses_the_numbers_of_the_operating_system(void **state)
{
    (void)state;
    topology *machine = described("pack:1 core:4 pu:2(indexes=0,4,1,5,2,6,3,7)");
    assert_places(machine, PIN_COMPACT, 8, (int[]){0, 4, 1, 5, 2, 6, 3, 7});
    assert_places(machine, PIN_SCATTER, 2, (int[]){0, 2});
    assert_places(machine, PIN_SCATTER, 4, (int[]){0, 1, 2, 3});
    assert_places(machine, PIN_SCATTER, 8, (int[]){0, 1, 2, 3, 4, 5, 6, 7});
    topology_destroy(machine);
}

static void placement_wraps_around_with_more_workers_than_units(void **state)
{
    (void)state;
    topology *machine = described("pack:1 core:2 pu:2");
    assert_places(machine, PIN_COMPACT, 10, (int[]){0, 1, 2, 3, 0, 1, 2, 3, 0, 1});
    assert_places(machine, PIN_SCATTER, 10, (int[]){0, 2, 1, 3, 0, 2, 1, 3, 0, 2});
    for (int i = 0; i < 1024; i++)
        assert_int_equal(topology_place(machine, PIN_NONE, i, 1024), -1);
    topology_destroy(machine);
}

/* Whatever the tree: count workers on distinct units, and no core twice while another has none. */
static void assert_scatter_is_fair(const topology *machine, int threads_a_core)
{
    int units = topology_pu_count(machine), cores = topology_core_count(machine);
    for (int count = 1; count <= units; count++) {
        int on_core[64] = {0}, on_unit[64] = {0}, used = 0;
        for (int i = 0; i < count; i++) {
            int unit = topology_place(machine, PIN_SCATTER, i, count);
            assert_true(unit >= 0 && unit < 64);
            assert_int_equal(on_unit[unit]++, 0);
            used += on_core[unit / threads_a_core]++ == 0;
            if (i >= cores)
                assert_int_equal(used, cores);
            else
                assert_int_equal(used, i + 1);
        }
    }
}

static void scatter_uses_every_core_once_before_any_twice(void **state)
{
    (void)state;
    static const struct {
        const char *tree;
        int threads;
    } trees[] = {{"pack:2 core:4 pu:2", 2},
                 {"pack:3 core:5 pu:4", 4},
                 {"pack:4 l3:2 core:3 pu:1", 1},
                 {"numa:2 core:3 pu:2", 2}};
    for (size_t i = 0; i < sizeof trees / sizeof trees[0]; i++) {
        topology *machine = described(trees[i].tree);
        assert_scatter_is_fair(machine, trees[i].threads);
        topology_destroy(machine);
    }
}

/* Package 0 keeps one thread a core, package 1 both: by weight alone, package 1 would take 5 of 8 workers. */
static void scatter_is_balanced_on_unequal_packages(void **state)
{
    (void)state;
    topology *machine = described("pack:2 core:4 pu:2");
    diagnostic why;
    assert_int_equal(topology_restrict(machine, "0,2,4,6,8-15", &why), STATUS_OK);
    assert_int_equal(topology_pu_count(machine), 12);
    assert_int_equal(topology_core_count(machine), 8);
    assert_scatter_is_fair(machine, 2);
    assert_places(machine, PIN_SCATTER, 8, (int[]){0, 2, 4, 6, 8, 10, 12, 14});
    assert_places(machine, PIN_SCATTER, 12, (int[]){0, 2, 4, 6, 8, 10, 12, 14, 9, 11, 13, 15});
    assert_places(machine, PIN_COMPACT, 6, (int[]){0, 2, 4, 6, 8, 9});
    topology_destroy(machine);
}

static void placement_uses_only_the_restricted_units(void **state)
{
    (void)state;
    topology *machine = described("pack:2 core:4 pu:2");
    diagnostic why;
    assert_int_equal(topology_restrict(machine, "6,7,12", &why), STATUS_OK);
    assert_int_equal(topology_pu_count(machine), 3);
    assert_int_equal(topology_core_count(machine), 2);
    assert_int_equal(topology_package_count(machine), 2);
    assert_places(machine, PIN_COMPACT, 4, (int[]){6, 7, 12, 6});
    assert_places(machine, PIN_SCATTER, 4, (int[]){6, 12, 7, 6});

    assert_int_equal(topology_restrict(machine, "0-3", &why), STATUS_BAD_INPUT);
    assert_int_equal(topology_restrict(machine, "six", &why), STATUS_BAD_INPUT);
    assert_int_equal(topology_pu_count(machine), 3);
    assert_int_equal(topology_bind_thread(machine, 12, &why), STATUS_OK);
    assert_int_equal(topology_bind_thread(machine, 11, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "11"));
    topology_destroy(machine);
}

static void invalid_descriptions_are_refused(void **state)
{
    (void)state;
    static const char *const bad[] = {"", "pack:", "pack:0 pu:2", "cup:2 rod:1", "pu:2 core:2", "pack:2 core:x"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        topology *machine = (topology *)&machine;
        diagnostic why;
        assert_int_equal(topology_from_synthetic(bad[i], &machine, &why), STATUS_BAD_INPUT);
        assert_null(machine);
        assert_true(why.what[0] != '\0' && why.remedy[0] != '\0');
    }
    assert_int_equal(topology_from_synthetic("", &(topology *){NULL}, NULL), STATUS_BAD_INPUT);
}

static void texts_describe_the_machine(void **state)
{
    (void)state;
    topology *machine = described("pack:1 l3:1(size=32MB) l2:2(size=1MB) core:1 pu:2");
    char *text = topology_summary(machine), *xml = topology_xml(machine);
    assert_non_null(text);
    assert_ptr_equal(strstr(text, "1 package, 2 cores, 4 threads, L2 "), text);
    assert_non_null(strstr(text, "L3 "));
    assert_non_null(xml);
    assert_non_null(strstr(xml, "<topology"));
    free(text);
    free(xml);
    assert_int_equal(topology_restrict(machine, "1", NULL), STATUS_OK);
    text = topology_summary(machine);
    assert_ptr_equal(strstr(text, "1 package, 1 core, 1 thread (of the machine's 4)"), text);
    free(text);
    topology_destroy(machine);
}

static void threads_are_bound_on_this_machine(void **state)
{
    (void)state;
    topology *machine = NULL;
    diagnostic why;
    cpu_set_t own, now;
    assert_int_equal(sched_getaffinity(0, sizeof own, &own), 0);
    assert_int_equal(topology_create(&machine, &why), STATUS_OK);
    assert_int_equal(topology_pu_count(machine), CPU_COUNT(&own));
    for (int i = 0; i < topology_pu_count(machine); i++) {
        int unit = topology_place(machine, PIN_COMPACT, i, topology_pu_count(machine));
        assert_true(CPU_ISSET((size_t)unit, &own));
        assert_int_equal(topology_bind_thread(machine, unit, &why), STATUS_OK);
        assert_int_equal(topology_current_pu(), unit);
        assert_int_equal(sched_getaffinity(0, sizeof now, &now), 0);
        assert_true(CPU_COUNT(&now) == 1 && CPU_ISSET((size_t)unit, &now));
    }
    assert_int_equal(topology_bind_thread(machine, -1, &why), STATUS_OK);
    assert_int_equal(sched_getaffinity(0, sizeof now, &now), 0);
    assert_true(CPU_EQUAL(&now, &own));
    assert_int_equal(topology_bind_thread(machine, 1 << 20, &why), STATUS_BAD_INPUT);
    refuses = true;
    assert_int_equal(topology_bind_thread(machine, topology_place(machine, PIN_COMPACT, 0, 1), &why), STATUS_FAILURE);
    assert_non_null(strstr(why.what, "cannot bind a thread to processing unit"));
    assert_int_equal(topology_bind_thread(machine, -1, &why), STATUS_FAILURE);
    assert_string_equal(why.what, "cannot allow a thread all processing units of the process: Invalid argument");
    refuses = false;

    char *xml = topology_xml(machine);
    char *name = strstr(xml, "\"HostName\"");
    assert_true(!name || strncmp(name, "\"HostName\" value=\"\"", 19) == 0);
    free(xml);
    topology_destroy(machine);
}

static void the_binding_of_the_process_is_respected(void **state)
{
    (void)state;
    cpu_set_t own, one;
    assert_int_equal(sched_getaffinity(0, sizeof own, &own), 0);
    int last = -1;
    for (int i = 0; i < CPU_SETSIZE; i++)
        if (CPU_ISSET((size_t)i, &own))
            last = i;
    CPU_ZERO(&one);
    CPU_SET((size_t)last, &one);
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
    topology *machine = NULL;
    status made = topology_create(&machine, NULL);
    assert_int_equal(sched_setaffinity(0, sizeof own, &own), 0);

    assert_int_equal(made, STATUS_OK);
    assert_int_equal(topology_pu_count(machine), 1);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(topology_place(machine, PIN_COMPACT, i, 5), last);
        assert_int_equal(topology_place(machine, PIN_SCATTER, i, 5), last);
    }
    topology_destroy(machine);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(placement_on_two_packages_by_each_policy),
        cmocka_unit_test(placement_uses_the_numbers_of_the_operating_system),
        cmocka_unit_test(placement_wraps_around_with_more_workers_than_units),
        cmocka_unit_test(scatter_uses_every_core_once_before_any_twice),
        cmocka_unit_test(scatter_is_balanced_on_unequal_packages),
        cmocka_unit_test(placement_uses_only_the_restricted_units),
        cmocka_unit_test(invalid_descriptions_are_refused),
        cmocka_unit_test(texts_describe_the_machine),
        cmocka_unit_test(threads_are_bound_on_this_machine),
        cmocka_unit_test(the_binding_of_the_process_is_respected),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
