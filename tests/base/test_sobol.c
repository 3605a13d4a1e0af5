/* Tests of the scrambled Sobol points: elementary intervals, uniformity, means over scramblings, and the error of known
 * integrals. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "base/random.h"

enum { M_MAX = 10 };

/* The number of points per elementary interval of 2^a x 2^(m - a), for one aligned block of 2^m points. */
static void expect_net(uint64_t key, uint32_t block, int m, int a)
{
    static unsigned char count[1 << M_MAX];
    memset(count, 0, sizeof count);
    for (uint32_t i = 0; i < 1U << m; i++) {
        const sobol_point p = sobol_at((block << m) + i, key);
        const uint32_t x = a > 0 ? p.x >> (32 - a) : 0, y = a < m ? p.y >> (32 - (m - a)) : 0;
        count[x << (m - a) | y]++;
    }
    for (int i = 0; i < 1 << m; i++)
        if (count[i] != 1)
            fail_msg("key %d, block %u, m %d, 2^%d columns: interval %d has %d points", (int)key, block, m, a, i,
                     count[i]);
}

/* A (0, 2)-sequence: every aligned block of 2^m points is a (0, m, 2)-net (Niederreiter 1987). */
static void every_elementary_interval_has_one_point(void **state)
{
    (void)state;
    for (uint64_t key = 0; key < 40; key++)
        for (int m = 0; m <= M_MAX; m++)
            for (int a = 0; a <= m; a++)
                for (uint32_t block = 0; block < 3; block++)
                    expect_net(key * 0x100000001, block * (uint32_t)(key + 1), m, a);
}

/* Owen's scrambling keeps each point uniform: over many keys the cells of an 8 x 8 grid are hit equally often. The sum
 * of squares has 63 degrees of freedom; 126 is exceeded with a probability of 4e-6. */
static void each_point_is_uniform_over_the_keys(void **state)
{
    (void)state;
    enum { KEYS = 64000 };
    for (uint32_t index = 0; index < 20; index++) {
        int count[64] = {0};
        double chi_square = 0.0;
        for (uint64_t key = 0; key < KEYS; key++) {
            const sobol_point p = sobol_at(index * index * index, key);
            count[p.x >> 29 << 3 | p.y >> 29]++;
        }
        for (int i = 0; i < 64; i++)
            chi_square += (count[i] - KEYS / 64.0) * (count[i] - KEYS / 64.0) / (KEYS / 64.0);
        if (chi_square > 126.0)
            fail_msg("point %u: chi-square %.1f with 63 degrees of freedom", index, chi_square);
    }
}

/* Points of two keys are independent: under the same index their first bits, x and y, form 16 equal cells. */
static void the_points_of_two_keys_are_independent(void **state)
{
    (void)state;
    enum { KEYS = 64000 };
    int count[16] = {0};
    double chi_square = 0.0;
    for (uint64_t key = 0; key < KEYS; key++) {
        const sobol_point p = sobol_at(5, 2 * key), q = sobol_at(5, 2 * key + 1);
        count[p.x >> 31 << 3 | p.y >> 31 << 2 | q.x >> 31 << 1 | q.y >> 31]++;
    }
    for (int i = 0; i < 16; i++)
        chi_square += (count[i] - KEYS / 16.0) * (count[i] - KEYS / 16.0) / (KEYS / 16.0);
    assert_true(chi_square < 50.0); /* 15 degrees of freedom: 1e-5 */
}

typedef double function(double x, double y);

static double saddle(double x, double y)
{
    return x * y;
}

static double disc(double x, double y)
{
    return x * x + y * y < 1.0;
}

/* Root mean square error of the mean of n points over many keys; *off: the mean error in units of its own standard
 * error. */
static double rms_error(function *f, double integral, uint32_t n, double *off)
{
    enum { KEYS = 400 };
    double squares = 0.0, total = 0.0;
    for (uint64_t key = 0; key < KEYS; key++) {
        double sum = 0.0;
        for (uint32_t i = 0; i < n; i++) {
            const sobol_point p = sobol_at(i, key << 20 | n);
            sum += f(random_unit(p.x), random_unit(p.y));
        }
        const double error = sum / n - integral;
        squares += error * error, total += error;
    }
    *off = total / sqrt(squares);
    return sqrt(squares / KEYS);
}

/* The variance of a smooth function falls like n^-3 log n (Owen, "Scrambled net variance for integrals of smooth
 * functions", Annals of Statistics 25, 1997), that of a disc, where n^(1/2) of n cells are cut, like n^-3/2; random
 * numbers have n^-1 for both. */
static void errors_fall_at_the_known_rates(void **state)
{
    (void)state;
    static const struct {
        function *f;
        double integral, slope, random_256;
    } cases[] = {{saddle, 0.25, -1.5, 0.2205 / 16.0}, {disc, 0.785398163397448, -0.75, 0.4105 / 16.0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        double off[3];
        const double few = rms_error(cases[k].f, cases[k].integral, 16, &off[0]),
                     more = rms_error(cases[k].f, cases[k].integral, 256, &off[1]),
                     many = rms_error(cases[k].f, cases[k].integral, 4096, &off[2]);
        const double slope = log(many / few) / log(256.0);
        print_message("RMS error %.2g, %.2g, %.2g for 16, 256, 4096 points: slope %.2f\n", few, more, many, slope);
        assert_true(fabs(slope - cases[k].slope) < 0.1);
        assert_true(more < 0.35 * cases[k].random_256);
        for (int i = 0; i < 3; i++)
            assert_true(fabs(off[i]) < 4.0);
    }
}

/* Pure integer arithmetic: the same points on every machine. */
static void points_never_change(void **state)
{
    (void)state;
    uint64_t hash = 0;
    for (uint32_t i = 0; i < 1000; i++) {
        const sobol_point p = sobol_at(i * i, i);
        hash = sobol_mix(hash ^ ((uint64_t)p.x << 32 | p.y));
    }
    assert_true(hash == 0x1e0a66bdd45ab3a3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_elementary_interval_has_one_point),
        cmocka_unit_test(each_point_is_uniform_over_the_keys),
        cmocka_unit_test(the_points_of_two_keys_are_independent),
        cmocka_unit_test(errors_fall_at_the_known_rates),
        cmocka_unit_test(points_never_change),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
