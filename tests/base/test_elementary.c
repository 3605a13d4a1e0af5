/* Tests of the error bounds of the elementary functions: powers, sines and angles. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/elementary.h"
#include "base/lanes.h"
#include "random_stream.h"

#define assert_near(a, b, tolerance) assert_true(fabsl((long double)(a) - (long double)(b)) <= (tolerance))
#define PI_L 3.14159265358979323846264338327950288L

/* The reference is libm in 64-bit mantissas, which valgrind does not emulate. */
static void need_long_double(void)
{
    volatile long double one = 1.0L, little = 0x1p-60L;
    if (one + little == one)
        skip();
}

/* |pow - x^y| / x^y <= 4e-16 (2 + |y log2 x|), zero below 2^-1000, 2^1000 above. */
static void check_power(double x, double y)
{
    long double t = (long double)y * log2l((long double)x), expected = powl((long double)x, (long double)y);
    double got = elementary_pow(x, y);
    assert_true(got == elementary_pow_inline(x, y));
    if (t < -1001.0L)
        assert_true(got == 0.0);
    else if (t > 1001.0L)
        assert_true(got >= 0x1p999 && got <= 0x1p1001);
    else if (t > -999.0L && t < 999.0L)
        assert_true(fabsl((long double)got - expected) <= 4e-16L * (2.0L + fabsl(t)) * expected);
}

static void power_keeps_its_bound_over_the_range(void **state)
{
    (void)state;
    need_long_double();
    uint64_t seed = 1;
    /* Drawn in separate statements: the evaluation order of a call's arguments is unspecified. */
    for (int i = 0; i < 200000; i++) {
        const double dim = random_real(&seed, 0.0, 1.0), shininess = random_real(&seed, 0.0, 200.0);
        check_power(dim, shininess); /* as highlights use it */
        const double wide = exp2(random_real(&seed, -1000.0, 1000.0)), small = random_real(&seed, -3.0, 3.0);
        check_power(wide, small); /* over the whole range */
        const double near_one = 1.0 + random_real(&seed, -1e-6, 1e-6), large = random_real(&seed, 0.0, 1e6);
        check_power(near_one, large); /* log x near 0 */
        const double halved = random_real(&seed, 1.4142, 1.4143), either = random_real(&seed, -9.0, 9.0);
        check_power(halved, either); /* where the mantissa is halved */
    }
    check_power(0.70378209561803062, 101.52557517459427); /* the worst of 24 million: 3.2e-16 */
}

static void power_is_exact_at_special_arguments(void **state)
{
    (void)state;
    assert_true(elementary_pow(0.0, 0.0) == 1.0);
    assert_true(elementary_pow(0.0, 80.0) == 0.0);
    assert_true(elementary_pow(7.5, 0.0) == 1.0);
    assert_true(elementary_pow(1.0, 1e5) == 1.0);
    assert_true(elementary_pow(1.0, -1e5) == 1.0);
    assert_true(elementary_pow(0x1p-1074, 2.0) == 0.0);
    assert_true(elementary_pow(1e-30, 1e5) == 0.0);
    assert_true(elementary_pow(nextafter(1.0, 0.0), 1e5) < 1.0);
    assert_true(elementary_pow(0.5, 999.0) == 0x1p-999);
    assert_true(elementary_pow(0.5, 1002.0) == 0.0);
    assert_true(elementary_pow(2.0, 1e9) == 0x1p1000);
    assert_true(elementary_pow(0.25, -0.5) == 2.0);
    for (int y = 1; y <= 60; y++)
        assert_true(elementary_pow(2.0, y) == ldexp(1.0, y));
    assert_true(isnan(elementary_pow(-1.0, 2.0)));
    assert_true(isnan(elementary_pow((double)NAN, 2.0)));
    assert_true(isnan(elementary_pow(2.0, (double)NAN)));
}

/* The bound given in base/elementary.h: 3e-14 at x^y = 1e-30. */
static void power_of_a_dim_highlight_keeps_its_bound(void **state)
{
    (void)state;
    need_long_double();
    uint64_t seed = 2;
    for (int i = 0; i < 20000; i++) {
        double x = random_real(&seed, 0.01, 0.99), y = -30.0 / log10(x);
        long double expected = powl((long double)x, (long double)y);
        assert_true(fabsl((long double)elementary_pow(x, y) - expected) <= 3e-14L * expected);
    }
}

static void check_angle(double degrees)
{
    double s, c;
    elementary_sincos_deg(degrees, &s, &c);
    long double reduced = fmodl((long double)degrees, 360.0L) * (PI_L / 180.0L);
    assert_near(s, sinl(reduced), 3e-16L);
    assert_near(c, cosl(reduced), 3e-16L);
    assert_near((long double)s * (long double)s + (long double)c * (long double)c, 1.0L, 1e-15L);
}

static void sine_and_cosine_keep_their_bound(void **state)
{
    (void)state;
    need_long_double();
    uint64_t seed = 3;
    for (int i = 0; i < 200000; i++) {
        check_angle(random_real(&seed, -360.0, 360.0));
        check_angle(random_real(&seed, -1e6, 1e6));
        check_angle(random_real(&seed, -1e-6, 1e-6));
    }
    for (int k = -7200; k <= 7200; k++) {
        check_angle(k);
        check_angle(k + 0.5);
        check_angle(nextafter(k, 1e9));
        check_angle(nextafter(k, -1e9));
    }
    check_angle(1e6);
    check_angle(-1e6);
}

static void sine_and_cosine_are_exact_at_right_angles(void **state)
{
    (void)state;
    static const double sines[4] = {0.0, 1.0, 0.0, -1.0};
    for (int k = -11111; k <= 11111; k++) {
        double s, c;
        elementary_sincos_deg(90.0 * k, &s, &c);
        int turn = (k % 4 + 4) % 4;
        assert_true(s == sines[turn]);
        assert_true(c == sines[(turn + 1) % 4]);
    }
}

static void check_direction(double y, double x)
{
    long double expected = atan2l((long double)y, (long double)x) * (180.0L / PI_L);
    assert_near(elementary_atan2_deg(y, x), expected, 1e-13L);
}

static void angle_of_a_point_keeps_its_bound(void **state)
{
    (void)state;
    need_long_double();
    uint64_t seed = 4;
    for (int i = 0; i < 200000; i++) {
        check_direction(random_real(&seed, -1.0, 1.0), random_real(&seed, -1.0, 1.0));
        check_direction(random_real(&seed, -1.0, 1.0) * 1e-12, random_real(&seed, -1.0, 1.0));
        check_direction(random_real(&seed, -1.0, 1.0), random_real(&seed, -1.0, 1.0) * 1e-12);
        double a = random_real(&seed, -180.0, 180.0), s, c;
        elementary_sincos_deg(a, &s, &c);
        check_direction(s, c);
    }
    check_direction(1e300, -1e300);
    check_direction(1e-300, -1e-300);
    check_direction(1e-300, 1e300);
}

static void angle_of_a_point_is_exact_on_the_axes(void **state)
{
    (void)state;
    assert_true(elementary_atan2_deg(0.0, 0.0) == 0.0);
    assert_true(elementary_atan2_deg(0.0, 2.0) == 0.0);
    assert_true(elementary_atan2_deg(2.0, 0.0) == 90.0);
    assert_true(elementary_atan2_deg(-2.0, 0.0) == -90.0);
    assert_true(elementary_atan2_deg(0.0, -2.0) == 180.0);
    assert_true(elementary_atan2_deg(3.0, 3.0) == 45.0);
    assert_true(elementary_atan2_deg(3.0, -3.0) == 135.0);
    assert_true(elementary_atan2_deg(-3.0, -3.0) == -135.0);
    assert_true(elementary_atan2_deg(-3.0, 3.0) == -45.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(power_keeps_its_bound_over_the_range),
        cmocka_unit_test(power_is_exact_at_special_arguments),
        cmocka_unit_test(power_of_a_dim_highlight_keeps_its_bound),
        cmocka_unit_test(sine_and_cosine_keep_their_bound),
        cmocka_unit_test(sine_and_cosine_are_exact_at_right_angles),
        cmocka_unit_test(angle_of_a_point_keeps_its_bound),
        cmocka_unit_test(angle_of_a_point_is_exact_on_the_axes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
