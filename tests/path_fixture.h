/* Images of the path tracer compared with expected values: within the confidence interval that the renderer reports.
 * Eight replicates give a standard error with seven degrees of freedom, four one with three; Student's t, two-sided
 * (Abramowitz and Stegun, table 26.10). Each call asserts that it succeeded. */
#pragma once

#include "scene/model/scene.h"
#include "render_fixture.h"
#include <math.h>

#define ROUNDINGS 1e-10 /* of the film's units and of weights of 1 / paths */

typedef struct estimate {
    double value, standard_error;
    double t_95, t_9999; /* half the width of the intervals of 95% and 99.99%, in standard errors */
    /* Relative: a random choice of probability p is made for p n or p n + 1 of n Sobol points, often for the same
     * number in all replicates, which then do not show the error. */
    double step;
} estimate;

static inline estimate estimate_of(double value, double variance, int replicates)
{
    const bool eight = replicates == 8;
    assert_true(eight || replicates == 4);
    return (estimate){value, sqrt(variance), eight ? 2.365 : 3.182, eight ? 7.885 : 28.0, eight ? 0.0 : 1e-3};
}

static inline estimate estimate_at(const render_result *r, int x, int y, int channel)
{
    const size_t at = ((size_t)y * (size_t)r->img->width + (size_t)x) * 3 + (size_t)channel;
    return estimate_of((double)r->img->sum[at] / FILM_ONE, r->variance[at], r->replicates);
}

/* The mean of an image of one pixel, in one channel. */
static inline estimate look_by_chance(const scene *s, int channel)
{
    render_result *r = render(s);
    assert_non_null(r->variance);
    const estimate e = estimate_at(r, 0, 0, channel);
    render_result_destroy(r);
    return e;
}

static inline void expect_estimate(estimate e, double expected)
{
    if (!(fabs(e.value - expected) <= e.t_9999 * e.standard_error + e.step * fabs(expected) + ROUNDINGS))
        fail_msg("%.9g +- %.2g instead of %.9g", e.value, e.standard_error, expected);
}

/* Statistics over many values: the number inside their own 95% interval, and the mean deviation of all in units of its
 * standard error. */
typedef struct agreement {
    int count, inside;
    double off, variance;
} agreement;

/* unseen: the tolerance for a value whose layers do not differ: ROUNDINGS where nothing is random, otherwise the weight
 * of rare events none of which was sampled, about 10 / paths. */
static inline void agreement_add(agreement *a, estimate e, double expected, double unseen)
{
    if (e.standard_error < 1e-9) {
        if (!(fabs(e.value - expected) <= unseen))
            fail_msg("%.9g for certain instead of %.9g", e.value, expected);
        return;
    }
    a->count++;
    a->inside += fabs(e.value - expected) <= e.t_95 * e.standard_error;
    a->off += e.value - expected;
    a->variance += e.standard_error * e.standard_error;
}

static inline double agreement_share(const agreement *a)
{
    return (double)a->inside / a->count;
}
static inline double agreement_off(const agreement *a)
{
    return a->off / sqrt(a->variance);
}

/* The film of random paths against that of whole trees. */
static inline agreement agree(scene *s, const char *settings, double unseen)
{
    set_all(s, settings);
    set(s, "render.integrator=whitted");
    render_result *tree = render(s);
    set(s, "render.integrator=path");
    render_result *chance = render(s);
    assert_non_null(chance->variance);
    agreement a = {0};
    for (int y = 0; y < tree->img->height; y++)
        for (int x = 0; x < tree->img->width; x++)
            for (int c = 0; c < 3; c++)
                agreement_add(&a, estimate_at(chance, x, y, c), film_value(tree->img, x, y, c), unseen);
    render_result_destroy(tree);
    render_result_destroy(chance);
    return a;
}

/* With 512 paths. For rare events the interval covers less often than its nominal probability; hence 90 of 100, not
 * 95. */
static inline void expect_mean_of_trees(scene *s, const char *settings)
{
    const agreement a = agree(s, settings, 10.0 / 512.0);
    print_message("%s: %d values, %.1f%% in their 95%% interval, mean off by %.2f standard errors\n", settings, a.count,
                  100.0 * agreement_share(&a), agreement_off(&a));
    assert_true(a.count > 500);
    assert_true(agreement_share(&a) > 0.90 && agreement_share(&a) < 0.985);
    assert_true(fabs(agreement_off(&a)) < 4.0);
}
