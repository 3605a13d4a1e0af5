/* Tests of sets of primitives in 64 bits against sets as arrays of truth values. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "base/worker_pool.h"
#include "geometry/regions/set_table.h"
#include "random_stream.h"

enum { MEMBERS = 300 };

static void assert_set(const set_table *t, uint64_t set, const bool *expected)
{
    set_members m;
    set_table_members(t, set, &m);
    int count = 0;
    for (int p = 0; p < MEMBERS; p++) {
        assert_int_equal(set_table_has(t, set, p), expected[p]);
        if (expected[p])
            assert_int_equal(m.primitive[count++], p);
    }
    assert_int_equal(m.count, count);
}

static void members_are_added_and_removed(void **state)
{
    (void)state;
    uint64_t seed = 11;
    set_table *t = set_table_create();
    for (int trial = 0; trial < 20; trial++) {
        bool expected[MEMBERS] = {false};
        uint64_t set = 0;
        for (int step = 0; step < 400; step++) {
            const int p = random_below(&seed, step < 300 ? MEMBERS : 8);
            expected[p] = random_below(&seed, 2);
            set = set_table_put(t, set, p, expected[p]);
            if (step % 40 == 0)
                assert_set(t, set, expected);
        }
        for (int p = 0; p < MEMBERS; p++)
            set = set_table_put(t, set, p, false);
        assert_true(set == 0);
    }
    assert_false(set_table_failed(t));
    set_table_destroy(t);
}

static void equal_sets_are_equal_numbers(void **state)
{
    (void)state;
    set_table *t = set_table_create();
    for (int size = 0; size < 40; size++) {
        uint64_t up = 0, down = 0;
        for (int k = 0; k < size; k++) {
            up = set_table_put(t, up, 50000 * k, true);
            down = set_table_put(t, down, 50000 * (size - 1 - k), true);
        }
        assert_true(up == down);
        assert_true(set_table_knows(t, up));
        assert_true(set_table_put(t, up, 7, true) != up);
    }
    assert_false(set_table_knows(t, UINT64_MAX));
    set_table_destroy(t);
}

typedef struct crowd {
    set_table *t;
    uint64_t made[4][1000];
} crowd;

static void make_sets(void *context, size_t worker, int member)
{
    crowd *c = context;
    (void)member;
    for (int k = 0; k < 1000; k++) {
        const int at = (k + 250 * (int)worker) % 1000;
        uint32_t members[6];
        for (int m = 0; m < 6; m++)
            members[m] = (uint32_t)(at + 1000 * m);
        c->made[worker][at] = set_table_of(c->t, members, 6);
    }
}

static void threads_agree_on_the_sets(void **state)
{
    (void)state;
    static crowd c;
    c.t = set_table_create();
    thread_team *team = thread_team_create(4);
    assert_non_null(team);
    thread_team_run(team, make_sets, &c, 4);
    thread_team_destroy(team);
    for (int k = 0; k < 1000; k++) {
        set_members m;
        set_table_members(c.t, c.made[0][k], &m);
        assert_int_equal(m.count, 6);
        assert_int_equal(m.primitive[5], k + 5000);
        for (int worker = 1; worker < 4; worker++)
            assert_true(c.made[worker][k] == c.made[0][k]);
    }
    set_table_destroy(c.t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(members_are_added_and_removed),
        cmocka_unit_test(equal_sets_are_equal_numbers),
        cmocka_unit_test(threads_agree_on_the_sets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
