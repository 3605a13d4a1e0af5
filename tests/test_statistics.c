/* Tests of the statistics against published tables and closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "measure/statistics.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))
#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

/* Percentiles of the t distribution, NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.2 (three decimals), and
 * the same quantiles to more digits, Abramowitz and Stegun, table 26.10. */
static void the_t_quantile_agrees_with_tables(void **state)
{
    (void)state;
    static const struct {
        size_t freedom;
        double t, tolerance;
    } table[] = {{1, 12.7062047, 1e-6},
                 {2, 4.3026527, 1e-6},
                 {3, 3.1824463, 1e-6},
                 {4, 2.7764451, 1e-6},
                 {5, 2.5705818, 1e-6},
                 {10, 2.2281389, 1e-6},
                 {20, 2.0859634, 1e-6},
                 {30, 2.0422725, 1e-6},
                 {60, 2.0002978, 1e-6},
                 {120, 1.9799304, 1e-6},
                 {6, 2.447, 5e-4},
                 {7, 2.365, 5e-4},
                 {8, 2.306, 5e-4},
                 {9, 2.262, 5e-4},
                 {15, 2.131, 5e-4},
                 {25, 2.060, 5e-4},
                 {50, 2.009, 5e-4},
                 {100, 1.984, 5e-4},
                 {1000000000, 1.9599640, 1e-6}};
    for (size_t i = 0; i < COUNT(table); i++)
        assert_near(student_t_975(table[i].freedom), table[i].t, table[i].tolerance);
    assert_true(isnan(student_t_975(0)));
}

/* Two closed forms: v = 1 is Cauchy's distribution; for v = 2, F(t) = 1/2 + t / (2 sqrt(2 + t^2)). */
static void the_t_quantile_agrees_with_closed_forms(void **state)
{
    (void)state;
    assert_near(student_t_975(1), tan(3.14159265358979323846 * 0.475), 1e-11);
    assert_near(student_t_975(2), 1.9 / sqrt(2.0 * 0.975 * 0.025) / 2.0, 1e-12);
}

static void the_t_quantile_decreases_continuously(void **state)
{
    (void)state;
    for (size_t v = 2; v < 400; v++) {
        double before = student_t_975(v - 1), here = student_t_975(v), after = student_t_975(v + 1);
        assert_true(after < here);
        assert_true(before - here > after - here); /* convex; a step where the method changes would break it */
        if (v > 3)
            assert_true(before - here < 2.0 * (here - after));
    }
}

/* Critical values of the two-sided sign test at 5%, Dixon and Mood, JASA 41 (1946) 557-566, table 1: r or fewer of the
 * rarer sign reject. The interval reaches from the (r+1)-th smallest to the (r+1)-th largest value. */
static void median_interval_agrees_with_the_sign_test(void **state)
{
    (void)state;
    static const struct {
        size_t n, r;
    } table[] = {{6, 0},  {7, 0},  {8, 0},   {9, 1},   {10, 1},  {11, 1},  {12, 2},  {15, 3},  {17, 4},  {20, 5},
                 {25, 7}, {30, 9}, {35, 11}, {40, 13}, {45, 15}, {50, 17}, {60, 21}, {80, 30}, {100, 39}};
    double values[100];
    for (size_t i = 0; i < COUNT(table); i++) {
        size_t n = table[i].n;
        for (size_t j = 0; j < n; j++)
            values[j] = (double)(n - j);
        summary s = summarize(values, n);
        assert_true(s.median_low == (double)(table[i].r + 1));
        assert_true(s.median_high == (double)(n - table[i].r));
    }
}

static void too_few_values_have_no_interval(void **state)
{
    (void)state;
    double values[] = {5.0, 4.0, 3.0, 2.0, 1.0};
    summary five = summarize(values, 5);
    assert_true(five.median == 3.0 && isnan(five.median_low) && isnan(five.median_high));
    summary one = summarize(values, 1);
    assert_true(one.count == 1 && one.mean == 1.0 && one.median == 1.0 && one.minimum == 1.0 && one.maximum == 1.0);
    assert_true(isnan(one.deviation) && isnan(one.mean_low) && isnan(one.mean_high));
    assert_true(isnan(summary_relative_width(&one)));
    summary none = summarize(NULL, 0);
    assert_true(none.count == 0 && isnan(none.mean) && isnan(none.median) && isnan(none.minimum));
}

/* Student, The probable error of a mean, Biometrika 6 (1908), p. 20: additional hours of sleep gained by ten patients.
 * Mean 1.58; the 95% interval 0.7001142 to 2.4598858 is the one printed for R's data set `sleep` by t.test. */
static void the_summary_of_students_sleep_data_equals_published_values(void **state)
{
    (void)state;
    double hours[] = {1.2, 2.4, 1.3, 1.3, 0.0, 1.0, 1.8, 0.8, 4.6, 1.4};
    summary s = summarize(hours, COUNT(hours));
    assert_int_equal(s.count, 10);
    assert_near(s.mean, 1.58, 1e-12);
    assert_near(s.deviation, 1.229995, 1e-6);
    assert_near(s.mean_low, 0.7001142, 1e-7);
    assert_near(s.mean_high, 2.4598858, 1e-7);
    assert_near(summary_relative_width(&s), (2.4598858 - 0.7001142) / 1.58, 1e-6);
    assert_near(s.median, 1.3, 1e-12);
    assert_true(s.minimum == 0.0 && s.maximum == 4.6);
    assert_true(s.median_low == 0.8 && s.median_high == 2.4); /* ranks 2 and 9 */
    for (size_t i = 1; i < COUNT(hours); i++)
        assert_true(hours[i - 1] <= hours[i]);
}

/* n where 2^-n is zero in doubles. The rank 1938 is from exact integers: the sum of C(4000, j), j < 1938, is at most
 * 2^4000 / 40, and with j = 1938 it is more. */
static void median_interval_of_many_values(void **state)
{
    (void)state;
    enum { MANY = 4000 };
    static double values[MANY];
    for (size_t i = 0; i < MANY; i++)
        values[i] = (double)((i * 1009) % MANY) + 1.0;
    summary s = summarize(values, MANY);
    assert_true(s.median == 2000.5);
    assert_true(s.median_low == 1938.0 && s.median_high == 2063.0);
}

static void nan_propagates_to_the_results(void **state)
{
    (void)state;
    double values[] = {1.0, NAN, 2.0, 3.0, 4.0, 5.0, 6.0};
    summary s = summarize(values, COUNT(values));
    assert_true(isnan(s.mean) && isnan(s.median) && isnan(s.minimum) && isnan(s.median_low));
    double zeros[] = {-1.0, 1.0};
    s = summarize(zeros, 2);
    assert_true(s.mean == 0.0 && isnan(summary_relative_width(&s)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_t_quantile_agrees_with_tables),
        cmocka_unit_test(the_t_quantile_agrees_with_closed_forms),
        cmocka_unit_test(the_t_quantile_decreases_continuously),
        cmocka_unit_test(median_interval_agrees_with_the_sign_test),
        cmocka_unit_test(too_few_values_have_no_interval),
        cmocka_unit_test(the_summary_of_students_sleep_data_equals_published_values),
        cmocka_unit_test(median_interval_of_many_values),
        cmocka_unit_test(nan_propagates_to_the_results),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
