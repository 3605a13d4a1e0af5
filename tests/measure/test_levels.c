/* Tests of quantiles, variance components, the hierarchical bootstrap and powers against tables, closed forms and
 * simulations of normal samples. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "measure/levels.h"
#include "measure/statistics.h"
#include "random_stream.h"
#include "whole.h"
#include <math.h>
#include <string.h>

static void close_to(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.12g instead of %.12g", value, expected);
}

/* Abramowitz and Stegun, tables 26.5 (normal), 26.10 (t), 26.8 (chi-squared). */
static void quantiles_are_those_of_tables(void **state)
{
    (void)state;
    close_to(normal_quantile(0.975), 1.959963984540054, 1e-12);
    close_to(normal_quantile(0.001), -3.090232306167814, 1e-11);
    close_to(normal_below(1.0), 0.8413447460685429, 1e-14);
    close_to(student_quantile(0.975, 1), 12.706204736, 1e-8);
    close_to(student_quantile(0.95, 5), 2.015048373, 1e-8);
    close_to(student_quantile(0.995, 10), 3.169272673, 1e-8);
    for (size_t v = 1; v < 300; v += 7)
        close_to(student_quantile(0.975, (double)v), student_t_975(v), 1e-8);
    close_to(chi_squared_quantile(0.95, 1), 3.841458821, 1e-8);
    close_to(chi_squared_quantile(0.05, 10), 3.940299136, 1e-8);
    close_to(chi_squared_quantile(0.5, 2), 2 * log(2.0), 1e-10);
    close_to(chi_squared_quantile(0.99, 100), 135.806723, 1e-5);
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

/* Normal repetitions in normal processes around a mean. */
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

/* By hand: processes {1, 3} and {5, 7}. */
static void the_centre_is_the_mean_of_medians(void **state)
{
    (void)state;
    const double values[] = {1, 3, 5, 7};
    const size_t start[] = {0, 2, 4};
    close_to(level_centre(&(level_sample){values, start, 2}), 4, 1e-15);
}

static double centre(const level_sample *a, const level_sample *b, void *unused)
{
    (void)b;
    (void)unused;
    return level_centre(a);
}

/* The share of intervals that contain the true value, for few and many processes, and for one. */
static double coverage(size_t processes, size_t repetitions, bool two, bool paired, double between)
{
    static drawn a, b;
    uint64_t seed = 7 + processes;
    size_t inside = 0;
    const size_t trials = (size_t)(is_whole() ? 400 : 100);
    for (size_t trial = 0; trial < trials; trial++) {
        level_interval interval;
        draw_sample(&a, &seed, processes, repetitions, 0, between, 1);
        draw_sample(&b, &seed, processes, repetitions, two ? 0.5 : 0, between, 1);
        if (paired) /* drift that both have */
            for (size_t p = 0; p < processes; p++) {
                const double drift = 3 * normal(&seed);
                for (size_t i = a.start[p]; i < a.start[p + 1]; i++)
                    a.values[i] += drift, b.values[i] += drift;
            }
        assert_int_equal(level_bootstrap(&a.sample, two ? &b.sample : NULL, paired, two ? level_difference : centre,
                                         NULL, trial, &interval, NULL),
                         STATUS_OK);
        inside += interval.low <= (two ? 0.5 : 0) && (two ? 0.5 : 0) <= interval.high;
        assert_true(interval.low <= interval.value && interval.value <= interval.high);
    }
    return (double)inside / (double)trials;
}

/* Four standard errors of a share of 400 at 0.95 are 0.044, of 100 0.088. */
static void intervals_cover_the_truth(void **state)
{
    (void)state;
    static const struct {
        size_t processes, repetitions;
        bool two, paired;
        double between;
    } cases[] = {{3, 4, true, true, 3},   {4, 6, false, false, 1}, {5, 2, true, true, 3},  {8, 3, false, false, 2},
                 {20, 5, true, false, 1}, {6, 4, true, true, 0.5}, {10, 2, true, true, 1}, {1, 15, false, false, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double share =
            coverage(cases[i].processes, cases[i].repetitions, cases[i].two, cases[i].paired, cases[i].between);
        if (share < (is_whole() ? 0.905 : 0.86) || (is_whole() && share > 0.996))
            fail_msg("case %zu covers %.3f", i, share);
    }
}

/* Repetitions of one process alone say nothing about others: the same values without levels give intervals that miss.
 */
static void levels_matter(void **state)
{
    (void)state;
    static drawn d;
    uint64_t seed = 3;
    size_t inside = 0;
    for (size_t trial = 0; trial < 200; trial++) {
        level_interval interval;
        draw_sample(&d, &seed, 6, 10, 0, 1, 0.3);
        const size_t whole[] = {0, 60};
        const level_sample flat = {d.values, whole, 1};
        assert_int_equal(level_bootstrap(&flat, NULL, false, centre, NULL, trial, &interval, NULL), STATUS_OK);
        inside += interval.low <= 0 && 0 <= interval.high;
    }
    assert_true(inside < 160);
}

static void few_values_have_no_interval(void **state)
{
    (void)state;
    const double values[] = {1, 2, 3, 4, 5, 6};
    const size_t one[] = {0, 5}, two[] = {0, 3, 6};
    level_interval interval;
    assert_int_equal(level_bootstrap(&(level_sample){values, one, 1}, NULL, false, centre, NULL, 1, &interval, NULL),
                     STATUS_OK);
    assert_true(isnan(interval.low) && isnan(interval.high) && interval.value == 3);
    assert_int_equal(level_bootstrap(&(level_sample){values, two, 2}, NULL, false, centre, NULL, 1, &interval, NULL),
                     STATUS_OK);
    assert_true(isnan(interval.low));
}

static double pooled_median(const level_sample *a, const level_sample *b, void *unused)
{
    double copy[400];
    const size_t count = a->start[a->processes];
    (void)b;
    (void)unused;
    assert_true(count > 0 && count <= 400);
    memcpy(copy, a->values, count * sizeof *copy);
    return summarize(copy, count).median;
}

/* The fast median of resamples is that of the generic bootstrap; with one process it is that of order statistics. */
static void medians_are_resampled_by_process(void **state)
{
    (void)state;
    static drawn d;
    uint64_t seed = 11;
    level_interval fast, slow;
    size_t inside = 0, inside_without = 0;
    for (size_t processes = 3; processes < 14; processes++) {
        draw_sample(&d, &seed, processes, 3 + processes % 4, 0, 1, 1);
        assert_int_equal(level_median(&d.sample, LEVEL_REAL, 4, &fast, NULL), STATUS_OK);
        assert_int_equal(level_bootstrap(&d.sample, NULL, false, pooled_median, NULL, 4, &slow, NULL), STATUS_OK);
        close_to(fast.value, slow.value, 1e-14);
        close_to(fast.low, slow.low, 1e-12);
        close_to(fast.high, slow.high, 1e-12);
    }
    for (size_t trial = 0; trial < 400; trial++) {
        draw_sample(&d, &seed, 8, 6, 0, 1, 0.5);
        assert_int_equal(level_median(&d.sample, LEVEL_REAL, trial, &fast, NULL), STATUS_OK);
        inside += fast.low <= 0 && 0 <= fast.high;
        const size_t whole[] = {0, 48};
        assert_int_equal(level_median(&(level_sample){d.values, whole, 1}, LEVEL_REAL, trial, &slow, NULL), STATUS_OK);
        inside_without += slow.low <= 0 && 0 <= slow.high;
    }
    assert_true(inside >= 362); /* 0.905, as above */
    assert_true(inside_without < 300);
}

/* --- intervals of medians of times --- */

/* Times of processes around a typical time of 1, whose median is known in closed form or by symmetry. */
typedef double time_maker(uint64_t *seed, size_t process, size_t processes, double *of_process);

/* 3 % between processes, 3 % within: a quiet machine. */
static double normal_time(uint64_t *seed, size_t process, size_t processes, double *of_process)
{
    (void)process, (void)processes;
    return 1.0 + 0.03 * *of_process + 0.03 * normal(seed);
}

/* Log-normal with 50 % within and 50 % between: a busy machine; the median is exp(0). */
static double skewed_time(uint64_t *seed, size_t process, size_t processes, double *of_process)
{
    (void)process, (void)processes;
    return exp(0.5 * *of_process + 0.5 * normal(seed));
}

/* Half of the processes are 20 % slower (a memory layout); by symmetry of logarithms the median of all times is the
 * geometric mean of both modes. */
static double bimodal_time(uint64_t *seed, size_t process, size_t processes, double *of_process)
{
    (void)process, (void)processes;
    return exp((*of_process > 0 ? 1 : -1) * 0.5 * log(1.2) + 0.05 * normal(seed));
}

/* The machine gets slower by 10 % from the first process to the last; the median is that of the middle. */
static double drifting_time(uint64_t *seed, size_t process, size_t processes, double *of_process)
{
    const double at = ((double)process + 0.5) / (double)processes - 0.5;
    return exp(0.1 * at + 0.03 * *of_process + 0.03 * normal(seed));
}

/* The share of intervals with the true median, 1. None may reach 0. */
static double median_coverage(time_maker *make, size_t processes, size_t repetitions, size_t trials)
{
    static drawn d;
    uint64_t seed = 17 + processes;
    size_t inside = 0;
    for (size_t trial = 0; trial < trials; trial++) {
        for (size_t p = 0; p < processes; p++) {
            double of_process = normal(&seed);
            d.start[p] = p * repetitions;
            for (size_t i = 0; i < repetitions; i++)
                d.values[p * repetitions + i] = make(&seed, p, processes, &of_process);
        }
        d.start[processes] = processes * repetitions;
        level_interval interval;
        assert_int_equal(
            level_median(&(level_sample){d.values, d.start, processes}, LEVEL_POSITIVE, trial, &interval, NULL),
            STATUS_OK);
        assert_true(interval.low > 0 && interval.low <= interval.value && interval.value <= interval.high);
        inside += interval.low <= 1 && 1 <= interval.high;
    }
    return (double)inside / (double)trials;
}

static void intervals_of_times_cover_the_median(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        time_maker *make;
        double least; /* of the coverage, by number of processes below */
    } kinds[] = {{"normal", normal_time, 0.90},
                 {"skewed", skewed_time, 0.90},
                 {"bimodal", bimodal_time, 0.80},
                 {"drift", drifting_time, 0.90}};
    static const size_t processes[] = {3, 6, 12};
    const size_t trials = is_whole() ? 1000 : 100;
    for (size_t k = 0; k < 4; k++)
        for (size_t i = 0; i < 3; i++) {
            const double share = median_coverage(kinds[k].make, processes[i], 4, trials);
            print_message("%s times, %zu processes: %.1f %% of the intervals cover the median\n", kinds[k].name,
                          processes[i], 100 * share);
            if (share < kinds[k].least - (is_whole() ? 0 : 0.06))
                fail_msg("%s, %zu processes: %.3f", kinds[k].name, processes[i], share);
        }
}

/* Quantities that may be 0, and shares: the interval stays in their range, and has the value. */
static void intervals_stay_in_the_range_of_their_quantity(void **state)
{
    (void)state;
    static const size_t start[] = {0, 3, 6, 9};
    static const double waiting[] = {0, 0, 1, 0, 2, 9, 30, 0, 4}, shares[] = {0.9, 0.99, 1, 0.2, 0.95, 1, 0.5, 0.97, 1},
                        negative[] = {-1, 2, 3, 4, 5, 9, 1, 2, 8}, times[] = {1, 2, 3, 90, 80, 70, 1, 2, 3};
    level_interval of;
    assert_int_equal(level_median(&(level_sample){waiting, start, 3}, LEVEL_NOT_NEGATIVE, 1, &of, NULL), STATUS_OK);
    assert_true(of.low == 0 && of.value == 1 && of.high > 1);
    assert_int_equal(level_median(&(level_sample){shares, start, 3}, LEVEL_FRACTION, 1, &of, NULL), STATUS_OK);
    assert_true(of.low >= 0 && of.high == 1);
    /* a positive quantity that is 0 or negative was none */
    assert_int_equal(level_median(&(level_sample){waiting, start, 3}, LEVEL_POSITIVE, 1, &of, NULL), STATUS_OK);
    assert_true(of.low == 0);
    assert_int_equal(level_median(&(level_sample){negative, start, 3}, LEVEL_POSITIVE, 1, &of, NULL), STATUS_OK);
    assert_true(isfinite(of.low) && of.low < of.value);
    assert_int_equal(level_median(&(level_sample){times, start, 3}, LEVEL_REAL, 1, &of, NULL), STATUS_OK);
    assert_true(of.low < 0);
    const double below = of.value - of.low, above = of.high - of.value;
    assert_true(fabs(below - above) < 1e-9 * above); /* symmetric */
    assert_int_equal(level_median(&(level_sample){times, start, 3}, LEVEL_POSITIVE, 1, &of, NULL), STATUS_OK);
    assert_true(of.low > 0);
    close_to(of.value / of.low, of.high / of.value, 1e-9 * of.high); /* symmetric as a ratio */
}

static void the_bootstrap_is_reproducible(void **state)
{
    (void)state;
    static drawn d;
    uint64_t seed = 5;
    level_interval first, again, other;
    draw_sample(&d, &seed, 5, 5, 0, 1, 1);
    level_bootstrap(&d.sample, NULL, false, centre, NULL, 9, &first, NULL);
    level_bootstrap(&d.sample, NULL, false, centre, NULL, 9, &again, NULL);
    level_bootstrap(&d.sample, NULL, false, centre, NULL, 10, &other, NULL);
    assert_memory_equal(&first, &again, sizeof first);
    assert_true(first.low != other.low);
}

/* For many pairs (1.96 + 1.645)^2 s^2 / d^2 = 12.99 s^2 / d^2; for few, by simulated t tests. */
static void powers_are_reached(void **state)
{
    (void)state;
    close_to((double)power_pairs(10, 1, 0.95), 1302, 2);
    assert_int_equal(power_pairs(1000, 1, 0.95), 0);
    assert_int_equal(power_pairs(NAN, 1, 0.95), 0);
    assert_int_equal(power_pairs(0, 1, 0.95), 3);
    static const double deviations[] = {0.4, 1, 2};
    uint64_t seed = 11;
    for (size_t k = 0; k < 3; k++) {
        const size_t pairs = power_pairs(deviations[k], 1, 0.95);
        size_t found = 0;
        double values[200];
        assert_true(pairs < 200);
        for (size_t trial = 0; trial < 2000; trial++) {
            for (size_t i = 0; i < pairs; i++)
                values[i] = 1 + deviations[k] * normal(&seed);
            const summary s = summarize(values, pairs);
            found += s.mean_low > 0;
        }
        if (found < 1860 || found > 1990) /* 0.93: the approximation of the non-central t */
            fail_msg("deviation %g, %zu pairs: found in %zu of 2000", deviations[k], pairs, found);
    }
}

/* 90% of the limits from samples are above the true deviation. */
static void upper_deviations_are_limits(void **state)
{
    (void)state;
    uint64_t seed = 13;
    size_t above = 0;
    for (size_t trial = 0; trial < 2000; trial++) {
        double values[8];
        for (size_t i = 0; i < 8; i++)
            values[i] = normal(&seed);
        above += power_upper_deviation(summarize(values, 8).deviation, 8, 0.9) > 1;
    }
    close_to((double)above / 2000, 0.9, 0.027); /* four standard errors */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quantiles_are_those_of_tables),
        cmocka_unit_test(the_centre_is_the_mean_of_medians),
        cmocka_unit_test(intervals_cover_the_truth),
        cmocka_unit_test(levels_matter),
        cmocka_unit_test(few_values_have_no_interval),
        cmocka_unit_test(medians_are_resampled_by_process),
        cmocka_unit_test(intervals_of_times_cover_the_median),
        cmocka_unit_test(intervals_stay_in_the_range_of_their_quantity),
        cmocka_unit_test(the_bootstrap_is_reproducible),
        cmocka_unit_test(powers_are_reached),
        cmocka_unit_test(upper_deviations_are_limits),
    };
    return cmocka_run_group_tests_name("levels", tests, NULL, NULL);
}
