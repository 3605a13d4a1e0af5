/* Tests of the adaptive resolution: it settles quickly, at the finest step that the time allows, without
 * oscillation. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "web/live/passes.h"

static const double wanted_s = 0.03;

/* full_s: the time of a frame at full resolution. */
static int settle(adaptive_resolution *p, double full_s, int frames)
{
    for (int i = 0; i < frames; i++)
        adaptive_resolution_update(p, full_s / (adaptive_resolution_divisor(p) * adaptive_resolution_divisor(p)),
                                   wanted_s);
    return adaptive_resolution_divisor(p);
}

static void the_resolution_settles_at_the_finest_step_that_the_time_allows(void **state)
{
    (void)state;
    static const double full_s[] = {0.001, 0.02, 0.05, 0.1, 0.3, 1.0, 3.0};
    for (size_t i = 0; i < sizeof full_s / sizeof *full_s; i++)
        for (int first = 0; first < 8; first += 7) {
            adaptive_resolution p = {.step = first};
            const int shrink = settle(&p, full_s[i], 60);
            assert_true(full_s[i] / (shrink * shrink) <= 1.3 * wanted_s);
            assert_true(shrink == 1 || full_s[i] / (shrink * shrink) > 0.1 * wanted_s);
            for (int k = 0; k < 100; k++)
                assert_int_equal(settle(&p, full_s[i], 1), shrink);
        }
}

static void the_resolution_has_limits(void **state)
{
    (void)state;
    adaptive_resolution p = {.step = 3};
    assert_int_equal(settle(&p, 1e6, 100), 16);
    assert_int_equal(settle(&p, 0.0, 1000), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_resolution_settles_at_the_finest_step_that_the_time_allows),
                                       cmocka_unit_test(the_resolution_has_limits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
