/* Tests of the statistics, and of the rates of false claims and of missed differences, against published tables and
 * closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "measure/design.h"
#include "measure/statistics.h"
#include "random_stream.h"

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

/* The rates of false claims and of missed differences against closed forms for normal samples. */

static void close_to(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.12g instead of %.12g", value, expected);
}

/* Four standard errors of a share of that many trials. */
static void is_share(double share, double expected, double trials)
{
    close_to(share, expected, 4 * sqrt(expected * (1 - expected) / trials));
}

/* Box and Muller, 1958. */
static double normal(uint64_t *seed)
{
    const double u = random_real(seed, 1e-300, 1), v = random_real(seed, 0, 1);
    return sqrt(-2 * log(u)) * cos(6.283185307179586 * v);
}

enum { PROCESSES_MAX = 400, VALUES_MAX = 4000 };
typedef struct drawn {
    double values[VALUES_MAX];
    size_t start[PROCESSES_MAX + 1];
    level_sample sample;
} drawn;

static void draw_sample(drawn *d, uint64_t *seed, size_t processes, size_t repetitions, double mean, double between,
                        double within)
{
    for (size_t p = 0; p < processes; p++) {
        const double centre = mean + between * normal(seed);
        d->start[p] = p * repetitions;
        for (size_t i = 0; i < repetitions; i++)
            d->values[p * repetitions + i] = centre + within * normal(seed);
    }
    d->start[processes] = processes * repetitions;
    d->sample = (level_sample){d->values, d->start, processes};
}

/* The share of pairs of samples, each of one process, of which the rule claims that they differ; above: that b is
 * larger. */
static double rate_of(design_rule rule, size_t repetitions, double between, double within, double shift, size_t trials,
                      double *above)
{
    static drawn a, b;
    uint64_t seed = 1000 * (uint64_t)rule + repetitions;
    size_t claims = 0, larger = 0;
    for (size_t i = 0; i < trials; i++) {
        int claim;
        draw_sample(&a, &seed, 1, repetitions, 0, between, within);
        draw_sample(&b, &seed, 1, repetitions, shift, between, within);
        assert_int_equal(design_claim(rule, &a.sample, &b.sample, false, 0.05, i, &claim, NULL), STATUS_OK);
        claims += claim != 0;
        larger += claim > 0;
    }
    if (above)
        *above = (double)larger / (double)trials;
    return (double)claims / (double)trials;
}

/* The difference of two values of deviation s is normal with s sqrt(2). */
static void one_value_claims_as_the_normal_law_says(void **state)
{
    (void)state;
    const double s = 0.05, z = log(1.05) / (s * sqrt(2.0));
    is_share(rate_of(DESIGN_EFFECT, 1, 0, s, 0, 20000, NULL), 2 * normal_below(-z), 20000);
    is_share(rate_of(DESIGN_EFFECT, 1, 0.04, 0.03, 0, 20000, NULL), 2 * normal_below(-z), 20000); /* 3, 4, 5 */
    double above;
    close_to(rate_of(DESIGN_SIGN, 1, 0, s, log(1.1), 20000, &above), 1, 0);
    is_share(above, normal_below(log(1.1) / (s * sqrt(2.0))), 20000);
}

/* The rate of a t test of independent normal values is its level. */
static void independent_values_have_the_level_of_the_test(void **state)
{
    (void)state;
    is_share(rate_of(DESIGN_T, 2, 0, 1, 0, 20000, NULL), 0.05, 20000);
    is_share(rate_of(DESIGN_T, 3, 0, 1, 0, 20000, NULL), 0.05, 20000);
    is_share(rate_of(DESIGN_T, 10, 0, 1, 0, 20000, NULL), 0.05, 20000);
}

/* Student's distribution for 4 degrees of freedom: Abramowitz and Stegun 26.7.4. */
static double student_4_below(double t)
{
    const double s = t / sqrt(4 + t * t), c2 = 4 / (4 + t * t);
    return 0.5 + 0.5 * s * (1 + 0.5 * c2);
}

/* Repetitions in one process each: the difference of the means has the variance 2 (between + within / n), but the test
 * sees 2 within / n, so that its t is too large by sqrt(1 + n between / within). */
static void correlated_repetitions_claim_more_as_computed(void **state)
{
    (void)state;
    close_to(student_4_below(2.776445105), 0.975, 1e-9); /* Abramowitz and Stegun, table 26.10 */
    for (double between = 0.5; between <= 4; between *= 2) {
        const double t = 2.776445105 / sqrt(1 + 3 * between * between);
        is_share(rate_of(DESIGN_T, 3, between, 1, 0, 20000, NULL), 2 * (1 - student_4_below(t)), 20000);
    }
}

static double choose(int n, int k)
{
    double c = 1;
    for (int i = 1; i <= k; i++)
        c *= (double)(n - k + i) / i;
    return c;
}

/* Whatever the distribution: of all orders of n values of a and n of b, those where n - k + 1 of one side come before
 * the k-th of the other. k = 1 for n = 6, 2 for n = 10. */
static void disjoint_intervals_are_as_rare_as_their_orders(void **state)
{
    (void)state;
    is_share(rate_of(DESIGN_MEDIANS, 6, 0, 1, 0, 60000, NULL), 2 / choose(12, 6), 60000);
    const double orders = 10 * choose(9, 8) + 11 * choose(8, 8); /* 9 or 10 before the second */
    is_share(rate_of(DESIGN_MEDIANS, 10, 0, 1, 0, 60000, NULL), 2 * orders / choose(20, 10), 60000);
    size_t inside = 0;
    uint64_t seed = 5;
    for (int i = 0; i < 20000; i++) {
        double values[6];
        for (int k = 0; k < 6; k++)
            values[k] = normal(&seed);
        const summary s = summarize(values, 6);
        inside += s.median_low <= 0 && 0 <= s.median_high;
    }
    is_share((double)inside / 20000, 31.0 / 32, 20000);
}

/* Clopper and Pearson; the rule of three: Hanley and Lippman-Hand, JAMA 249, 1983. */
static void intervals_of_shares_are_those_of_tables(void **state)
{
    (void)state;
    close_to(binomial_interval(0, 10).high, 1 - pow(0.025, 0.1), 1e-12);
    close_to(binomial_interval(10, 10).low, pow(0.025, 0.1), 1e-12);
    close_to(binomial_interval(0, 10).low, 0, 0);
    close_to(binomial_interval(10, 100).low, 0.04900, 5e-6);
    close_to(binomial_interval(10, 100).high, 0.17622, 5e-6);
    close_to(beta_quantile(0.95, 1, 1000), 3.0 / 1000, 1e-5);
    assert_true(isnan(binomial_interval(0, 0).share));
    for (double p = 0.05; p < 1; p += 0.15) { /* the exact coverage, over all outcomes of 20 trials */
        double covered = 0;
        for (int k = 0; k <= 20; k++) {
            const fraction_interval i = binomial_interval(k, 20);
            covered += i.low <= p && p <= i.high ? choose(20, k) * pow(p, k) * pow(1 - p, 20 - k) : 0;
        }
        assert_true(covered >= 0.95);
    }
}

static design_tally try(const level_sample *a, const level_sample *b, bool shared, design d, size_t draws)
{
    design_tally tally;
    const design_population of = {a, b, shared};
    assert_int_equal(design_try(&of, &d, ~0u, draws, 0.05, 1, &tally, NULL), STATUS_OK);
    return tally;
}

static void studies_are_drawn_from_the_population(void **state)
{
    (void)state;
    static drawn a, b;
    uint64_t seed = 9;
    draw_sample(&a, &seed, 400, 3, 0, 0, 1);
    const design_tally t = try(&a.sample, &a.sample, true, (design){1, 3, DESIGN_APART}, 4000);
    assert_int_equal(t.draws, 4000);
    assert_int_equal(t.independent, 200);
    is_share((double)(t.larger[DESIGN_T] + t.smaller[DESIGN_T]) / 4000, 0.05, 200);
    is_share((double)t.larger[DESIGN_SIGN] / 4000, 0.5, 200);

    /* Repetitions that are copies: ten of them claim whatever their process says. */
    draw_sample(&a, &seed, 60, 10, 0, 1, 0);
    const design_tally copies = try(&a.sample, &a.sample, true, (design){1, 10, DESIGN_TURNS}, 500);
    assert_int_equal(copies.independent, 30);
    assert_int_equal(copies.larger[DESIGN_MEDIANS] + copies.smaller[DESIGN_MEDIANS], 500);
    assert_int_equal(copies.larger[DESIGN_T] + copies.smaller[DESIGN_T], 500);

    /* In the same processes the difference remains, and each rule finds it. */
    b = a;
    b.sample = (level_sample){b.values, b.start, 60};
    for (size_t i = 0; i < 600; i++)
        b.values[i] += 0.1;
    const design_tally together = try(&a.sample, &b.sample, true, (design){10, 1, DESIGN_TOGETHER}, 200);
    assert_int_equal(together.independent, 6);
    assert_int_equal(together.larger[DESIGN_SIGN], 200);
    assert_int_equal(together.larger[DESIGN_RATIO], 200);
}

static void what_cannot_be_drawn_has_no_rate(void **state)
{
    (void)state;
    static drawn a, b;
    uint64_t seed = 2;
    draw_sample(&a, &seed, 5, 4, 0, 1, 1);
    draw_sample(&b, &seed, 7, 4, 0, 1, 1);
    assert_int_equal(try(&a.sample, &a.sample, true, (design){3, 1, DESIGN_APART}, 10).draws, 0);
    assert_int_equal(try(&a.sample, &a.sample, true, (design){1, 5, DESIGN_APART}, 10).draws, 0);
    assert_int_equal(try(&a.sample, &a.sample, true, (design){1, 1, DESIGN_TOGETHER}, 10).draws, 0);
    assert_int_equal(try(&a.sample, &b.sample, false, (design){1, 1, DESIGN_TURNS}, 10).draws, 0);
    assert_int_equal(try(&a.sample, &b.sample, false, (design){2, 4, DESIGN_APART}, 10).independent, 2);
    assert_false(design_has_rule(&(design){1, 1, DESIGN_APART}, DESIGN_T));
    assert_false(design_has_rule(&(design){2, 10, DESIGN_APART}, DESIGN_RATIO));
    assert_true(design_has_rule(&(design){3, 2, DESIGN_APART}, DESIGN_RATIO));
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
        cmocka_unit_test(one_value_claims_as_the_normal_law_says),
        cmocka_unit_test(independent_values_have_the_level_of_the_test),
        cmocka_unit_test(correlated_repetitions_claim_more_as_computed),
        cmocka_unit_test(disjoint_intervals_are_as_rare_as_their_orders),
        cmocka_unit_test(intervals_of_shares_are_those_of_tables),
        cmocka_unit_test(studies_are_drawn_from_the_population),
        cmocka_unit_test(what_cannot_be_drawn_has_no_rate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
