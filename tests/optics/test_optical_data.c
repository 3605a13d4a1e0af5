/* Tests of measured data by wavelength: the monotone cubic against closed forms, and the bounds of its error; ranges;
 * and what is refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "optics/media.h"
#include "optics/optical_data.h"
#include "random_stream.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g is not %.17g within %g", a, b, tolerance);
}

/* A parabola is its own interpolant where it is steep enough: the slopes at the points are exact. */
static void a_parabola_is_reproduced(void **state)
{
    (void)state;
    static const double at[] = {1, 1.5, 3, 4, 4.25, 6};
    double point[2 * COUNT(at)];
    for (size_t i = 0; i < COUNT(at); i++)
        point[2 * i] = at[i], point[2 * i + 1] = 2.0 - 3.0 * at[i] - 0.5 * at[i] * at[i];
    for (double x = 1.0; x <= 6.0; x += 1.0 / 64)
        assert_near(curve_at(point, COUNT(at), x), 2.0 - 3.0 * x - 0.5 * x * x, 4e-14);
}

static void one_and_two_points_are_a_constant_and_a_line(void **state)
{
    (void)state;
    static const double one[] = {500, 1.5}, two[] = {400, 1.6, 600, 1.5};
    assert_near(curve_at(one, 1, 300), 1.5, 0);
    assert_near(curve_at(one, 1, 800), 1.5, 0);
    assert_near(curve_at(two, 2, 450), 1.575, 1e-15);
    assert_near(curve_at(two, 2, 399), 1.6, 0);
    assert_near(curve_at(two, 2, 601), 1.5, 0);
}

/* Random points: the curve passes through all, and between two stays between their values. */
static void the_curve_passes_its_points_and_never_overshoots(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int trial = 0; trial < 2000; trial++) {
        double point[2 * 12], x = random_real(&seed, 100, 400);
        const size_t count = 2 + (size_t)random_real(&seed, 0, 10.999);
        for (size_t i = 0; i < count; i++, x += random_real(&seed, 0.01, 90))
            point[2 * i] = x, point[2 * i + 1] = floor(random_real(&seed, -3, 3)) * random_real(&seed, 0, 1);
        for (size_t i = 0; i < count; i++)
            assert_near(curve_at(point, count, point[2 * i]), point[2 * i + 1], 0);
        for (size_t i = 0; i + 1 < count; i++) {
            const double *p = &point[2 * i], low = fmin(p[1], p[3]), high = fmax(p[1], p[3]);
            double before = p[1];
            for (int k = 1; k < 40; k++) {
                const double y = curve_at(point, count, p[0] + (p[2] - p[0]) * k / 40);
                assert_true(y >= low - 1e-15 && y <= high + 1e-15);
                assert_true((y - before) * (p[3] - p[1]) >= -1e-15);
                before = y;
            }
        }
    }
}

/* Sixteen points of SF11 over the visible range: linear interpolation is off by up to 6e-4, the curve by 5e-5. */
static void a_table_of_a_dense_flint_is_accurate(void **state)
{
    (void)state;
    const medium *flint = media_find("sf11");
    double point[2 * 16], worst = 0.0, of_lines = 0.0;
    for (int i = 0; i < 16; i++)
        point[2 * i] = 390.0 + 26.0 * i, point[2 * i + 1] = dispersion_index(&flint->law, 390.0 + 26.0 * i);
    for (double nm = 390.0; nm <= 780.0; nm += 1.0) {
        const double n = dispersion_index(&flint->law, nm);
        const int i = nm < 780.0 ? (int)((nm - 390.0) / 26.0) : 14;
        const double part = (nm - point[2 * i]) / 26.0;
        worst = fmax(worst, fabs(curve_at(point, 16, nm) - n));
        of_lines = fmax(of_lines, fabs(point[2 * i + 1] * (1 - part) + point[2 * i + 3] * part - n));
    }
    assert_true(of_lines > 5e-4);
    assert_true(worst < 1.2e-4);
}

static void a_law_ends_with_its_range(void **state)
{
    (void)state;
    const optical_data *d;
    const dispersion law = {DISPERSION_CAUCHY, 2, {1.5, 0.004}, 450, 650};
    static const double k[] = {400, 0, 500, 1e-6, 700, 3e-6};
    double low, high;
    assert_int_equal(optical_data_create(&law, (optical_curve){NULL, 0}, (optical_curve){k, 3}, &d, NULL), STATUS_OK);
    assert_true(optical_data_has_first(d) && optical_data_has_k(d));
    optical_data_range(d, &low, &high);
    assert_true(low == 450 && high == 650);
    assert_near(optical_data_at(d, 500), 1.5 + 0.004 / 0.25, 1e-15);
    assert_near(optical_data_at(d, 300), optical_data_at(d, 450), 0);
    assert_near(optical_data_at(d, 900), 1.5 + 0.004 / (0.65 * 0.65), 1e-15);
    assert_near(optical_data_k(d, 500), 1e-6, 0);
    assert_near(optical_data_k(d, 800), 3e-6, 0);
    optical_data_retain(d);
    optical_data_release(d);
    optical_data_release(d);
    optical_data_release(NULL);
}

static void wrong_data_are_refused(void **state)
{
    (void)state;
    static const double twice[] = {400, 1.5, 400, 1.6}, negative[] = {-1, 1.5}, endless[] = {400, (double)INFINITY},
                        absorbing[] = {400, -0.1}, good[] = {400, 1.5};
    static const struct {
        dispersion law;
        const double *first;
        size_t count;
        const double *second;
        size_t second_count;
        const char *what;
    } cases[] = {
        {{0}, NULL, 0, NULL, 0, "no data"},
        {{0}, twice, 2, NULL, 0, "400 nm after 400 nm"},
        {{0}, negative, 1, NULL, 0, "-1 nm after 0 nm"},
        {{0}, endless, 1, NULL, 0, "the value at 400 nm is inf"},
        {{0}, good, 1, absorbing, 1, "extinction index k at 400 nm is -0.1"},
        /* a resonance at 600 nm, below which n^2 is negative */
        {{DISPERSION_SELLMEIER, 2, {5, 0.36}, 400, 800}, NULL, 0, NULL, 0, "resonance at 600 nm"},
        /* n^2 is negative below 632 nm */
        {{DISPERSION_POLYNOMIAL, 3, {-0.4, 1, 2}, 400, 800}, NULL, 0, NULL, 0, "gives the index"},
        /* weak ones, between any samples */
        {{DISPERSION_SELLMEIER_FROM, 5, {1.2, 0.3, 0.01, 1e-9, 0.2916}, 400, 801},
         NULL,
         0,
         NULL,
         0,
         "resonance at 540 nm"},
        {{DISPERSION_GAS_FROM, 3, {0.5, 1e-9, 4}, 401, 800}, NULL, 0, NULL, 0, "resonance at 500 nm"},
        {{DISPERSION_EXOTIC, 6, {2, 1e-9, 0.25, 0, 0, 1}, 401, 800}, NULL, 0, NULL, 0, "resonance at 500 nm"},
        {{DISPERSION_TWO_RESONANCES, 9, {2, 0, 0, 0, 0, 1e-9, 0, 0.5, 2}, 401, 800},
         NULL,
         0,
         NULL,
         0,
         "resonance at 500 nm"},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        const optical_data *d;
        diagnostic why = {.what = ""};
        assert_int_equal(optical_data_create(cases[i].law.count ? &cases[i].law : NULL,
                                             (optical_curve){cases[i].first, cases[i].count},
                                             (optical_curve){cases[i].second, cases[i].second_count}, &d, &why),
                         STATUS_BAD_INPUT);
        assert_null(d);
        if (!strstr(why.what, cases[i].what))
            fail_msg("'%s' does not contain '%s'", why.what, cases[i].what);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_parabola_is_reproduced),
        cmocka_unit_test(one_and_two_points_are_a_constant_and_a_line),
        cmocka_unit_test(the_curve_passes_its_points_and_never_overshoots),
        cmocka_unit_test(a_table_of_a_dense_flint_is_accurate),
        cmocka_unit_test(a_law_ends_with_its_range),
        cmocka_unit_test(wrong_data_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
