/* Tests of the shuffled order of cells: it depends on seed and stream only, and is uniformly distributed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "study/plan/grid.h"

#include <stdbool.h>
#include <string.h>

enum { COUNT = 50 };

static void every_cell_occurs_once(void **state)
{
    (void)state;
    for (uint64_t stream = 0; stream < 100; stream++) {
        size_t order[COUNT];
        bool seen[COUNT] = {false};
        order_shuffle(7, stream, order, COUNT);
        for (size_t i = 0; i < COUNT; i++) {
            assert_true(order[i] < COUNT && !seen[order[i]]);
            seen[order[i]] = true;
        }
    }
}

static void orders_depend_on_seed_and_stream(void **state)
{
    (void)state;
    size_t a[COUNT], b[COUNT];
    order_shuffle(1, 0, a, COUNT);
    order_shuffle(1, 0, b, COUNT);
    assert_memory_equal(a, b, sizeof a);
    static const uint64_t other[][2] = {
        {1, 1}, {2, 0}, {UINT64_C(1) << 32 | 1, 0}, {1, UINT64_C(1) << 32}, {1, ORDER_STREAM_SHARDS}};
    for (size_t i = 0; i < sizeof other / sizeof other[0]; i++) {
        order_shuffle(other[i][0], other[i][1], b, COUNT);
        assert_memory_not_equal(a, b, sizeof a);
    }
}

/* The order of a published study must never change: expected values recorded once. */
static void the_orders_of_published_studies_do_not_change(void **state)
{
    (void)state;
    static const size_t known[9] = {7, 4, 5, 0, 6, 8, 2, 1, 3};
    size_t order[9];
    order_shuffle(1, 0, order, 9);
    assert_memory_equal(order, known, sizeof known);
}

/* 4! orders, 24000 draws: chi squared with 23 degrees of freedom exceeds 49.7 for one in 1000 seeds. */
static void orders_are_uniformly_distributed(void **state)
{
    (void)state;
    unsigned count[256] = {0};
    for (uint64_t stream = 0; stream < 24000; stream++) {
        size_t order[4];
        order_shuffle(12345, stream, order, 4);
        count[order[0] << 6 | order[1] << 4 | order[2] << 2 | order[3]]++;
    }
    double chi_squared = 0;
    size_t kinds = 0;
    for (size_t i = 0; i < 256; i++)
        if (count[i]) {
            double off = (double)count[i] - 1000;
            chi_squared += off * off / 1000;
            kinds++;
        }
    assert_int_equal(kinds, 24);
    assert_true(chi_squared < 49.7);
}

static void orders_of_no_and_one_cell(void **state)
{
    (void)state;
    size_t order[1] = {99};
    order_shuffle(1, 0, order, 0);
    assert_int_equal(order[0], 99);
    order_shuffle(1, 0, order, 1);
    assert_int_equal(order[0], 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_cell_occurs_once),
        cmocka_unit_test(orders_depend_on_seed_and_stream),
        cmocka_unit_test(the_orders_of_published_studies_do_not_change),
        cmocka_unit_test(orders_are_uniformly_distributed),
        cmocka_unit_test(orders_of_no_and_one_cell),
    };
    return cmocka_run_group_tests_name("order", tests, NULL, NULL);
}
