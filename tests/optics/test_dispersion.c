/* Tests of the dispersion laws against their formulas, at values computed by hand, and of their checks. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "optics/dispersion.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(fabsl((long double)(a) - (long double)(b)) <= (long double)(tolerance))

/* The formulas again, with libm's powers in long double. */
static long double expected(const dispersion *law, long double lambda_nm)
{
    const double *c = law->coefficient;
    const long double L = lambda_nm / 1000.0L;
    const int odd = law->count % 2;
    long double sum = odd ? c[0] : 0.0L;
    for (int i = odd; i + 1 < law->count; i += 2) {
        switch (law->kind) {
        case DISPERSION_SELLMEIER:
        case DISPERSION_SELLMEIER_FROM: sum += c[i] * powl(L, 2) / (powl(L, 2) - c[i + 1]); break;
        case DISPERSION_SELLMEIER_LENGTHS: sum += c[i] * powl(L, 2) / (powl(L, 2) - powl(c[i + 1], 2)); break;
        case DISPERSION_POLYNOMIAL:
        case DISPERSION_CAUCHY_POWERS: sum += c[i] * powl(L, c[i + 1]); break;
        case DISPERSION_GAS:
        case DISPERSION_GAS_FROM: sum += c[i] / (c[i + 1] - powl(L, -2)); break;
        case DISPERSION_CAUCHY: sum += c[i] * powl(L, -2 * i) + c[i + 1] * powl(L, -2 * (i + 1)); break;
        case DISPERSION_CONSTANT:
        case DISPERSION_TABLE:
        case DISPERSION_CURVE: fail(); break;
        case DISPERSION_TWO_RESONANCES:
        case DISPERSION_HERZBERGER:
        case DISPERSION_RETRO:
        case DISPERSION_EXOTIC: break; /* below */
        }
    }
    switch (law->kind) {
    case DISPERSION_SELLMEIER:
    case DISPERSION_SELLMEIER_FROM:
    case DISPERSION_SELLMEIER_LENGTHS: return sqrtl(1.0L + sum);
    case DISPERSION_POLYNOMIAL: return sqrtl(sum);
    case DISPERSION_GAS:
    case DISPERSION_GAS_FROM: return 1.0L + sum;
    case DISPERSION_TWO_RESONANCES:
        sum = c[0] + c[1] * powl(L, c[2]) / (L * L - powl(c[3], c[4])) +
              c[5] * powl(L, c[6]) / (L * L - powl(c[7], c[8]));
        for (int i = 9; i < law->count; i += 2)
            sum += c[i] * powl(L, c[i + 1]);
        return sqrtl(sum);
    case DISPERSION_HERZBERGER: {
        const long double M = 1.0L / (L * L - 0.028L);
        return c[0] + c[1] * M + c[2] * M * M + c[3] * powl(L, 2) + c[4] * powl(L, 4) + c[5] * powl(L, 6);
    }
    case DISPERSION_RETRO: {
        const long double q = c[0] + c[1] * L * L / (L * L - c[2]) + c[3] * L * L;
        return sqrtl((1 + 2 * q) / (1 - q));
    }
    case DISPERSION_EXOTIC: return sqrtl(c[0] + c[1] / (L * L - c[2]) + c[3] * (L - c[4]) / (powl(L - c[4], 2) + c[5]));
    case DISPERSION_CONSTANT:
    case DISPERSION_CAUCHY_POWERS:
    case DISPERSION_CAUCHY:
    case DISPERSION_TABLE:
    case DISPERSION_CURVE: break;
    }
    return sum;
}

static const dispersion laws[] = {
    {DISPERSION_CONSTANT, 1, {1.4691}, 0, 0},
    {DISPERSION_SELLMEIER, 6, {1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653}, 0, 0},
    {DISPERSION_SELLMEIER, 2, {1.25, -0.02}, 0, 0},
    {DISPERSION_SELLMEIER_LENGTHS, 6, {0.6961663, 0.0684043, 0.4079426, 0.1162414, 0.8974794, 9.896161}, 0, 0},
    {DISPERSION_POLYNOMIAL,
     13,
     {2.1778, 0.0061209, 2, -0.0015004, 4, 0.023678, -2, -0.0042137, -4, 0.00073417, -6, -0.000045042, -8},
     0,
     0},
    {DISPERSION_POLYNOMIAL, 5, {2.2, 0.01, 3, -0.00000005, -16}, 0, 0},
    {DISPERSION_CAUCHY_POWERS, 5, {1.5130, -0.003169, 2, 0.003962, -2}, 0, 0},
    {DISPERSION_CAUCHY_POWERS, 1, {1.5}, 0, 0},
    {DISPERSION_CAUCHY, 1, {1.4}, 0, 0},
    {DISPERSION_CAUCHY, 2, {1.502, 0.00459}, 0, 0},
    {DISPERSION_CAUCHY, 5, {1.45, 0.004, 0.0001, -0.00002, 0.000003}, 0, 0},
    {DISPERSION_GAS, 4, {0.05792105, 238.0185, 0.00167917, 57.362}, 0, 0},
    {DISPERSION_SELLMEIER_FROM, 3, {0.4, 1.1, 0.012}, 0, 0},
    {DISPERSION_GAS_FROM, 3, {0.0002, 0.05792105, 238.0185}, 0, 0},
    {DISPERSION_POLYNOMIAL, 5, {2.2, 0.01, 2.5, 0.02, -3.5}, 0, 0},
    {DISPERSION_TWO_RESONANCES, 11, {2.1, 1.2, 2, 0.15, 2, 0.02, 0, 0.2, 1.5, -0.01, 2}, 0, 0},
    {DISPERSION_HERZBERGER, 6, {1.4, 0.005, -0.0001, -0.002, 0.00003, -0.000001}, 0, 0},
    {DISPERSION_RETRO, 4, {0.3, 0.05, 0.02, -0.001}, 0, 0},
    {DISPERSION_EXOTIC, 6, {2.1, 0.01, 0.02, 0.001, 0.3, 0.05}, 0, 0},
};

static void laws_agree_with_their_formulas(void **state)
{
    (void)state;
    for (size_t k = 0; k < COUNT(laws); k++) {
        assert_int_equal(dispersion_check(&laws[k], NULL), STATUS_OK);
        if (laws[k].kind == DISPERSION_CONSTANT)
            continue;
        for (double lambda_nm = 380.0; lambda_nm <= 780.0; lambda_nm += 0.7)
            assert_near(dispersion_index(&laws[k], lambda_nm), expected(&laws[k], lambda_nm), 4e-15);
    }
}

/* A law's array is longer than its count. */
static void what_follows_the_coefficients_is_not_read(void **state)
{
    (void)state;
    const dispersion table = {DISPERSION_TABLE, 6, {300.0, 1.52, 500.0, 1.51, 900.0, 1.5}, 0, 0};
    for (size_t k = 0; k <= COUNT(laws); k++) {
        const dispersion *law = k < COUNT(laws) ? &laws[k] : &table;
        dispersion followed = *law;
        for (int i = law->count; i < DISPERSION_TERMS_MAX; i++)
            followed.coefficient[i] = i % 2 ? 0.3 : 1e6;
        assert_int_equal(dispersion_check(&followed, NULL), STATUS_OK);
        for (double lambda_nm = 380.0; lambda_nm <= 1000.0; lambda_nm += 10.0)
            assert_true(dispersion_index(&followed, lambda_nm) == dispersion_index(law, lambda_nm));
    }
}

/* Values computed by hand, at 500 nm or 1 um; each would differ under another law's formula. */
static void laws_equal_values_computed_by_hand(void **state)
{
    (void)state;
    const struct {
        dispersion law;
        double lambda_nm, n;
    } easy[] = {
        {{DISPERSION_CONSTANT, 1, {1.5}, 0, 0}, 500.0, 1.5},
        {{DISPERSION_SELLMEIER, 2, {3.75, -0.0625}, 0, 0}, 500.0, 2.0}, /* 1 + 3.75 * 0.25 / 0.3125 */
        {{DISPERSION_SELLMEIER, 2, {6.0, 0.25}, 0, 0}, 1000.0, 3.0},    /* 1 + 6 / 0.75 */
        {{DISPERSION_SELLMEIER_LENGTHS, 2, {6.0, 0.5}, 0, 0}, 1000.0, 3.0},
        {{DISPERSION_POLYNOMIAL, 5, {1.0, 4.0, 2.0, 0.5, -2.0}, 0, 0}, 500.0, 2.0}, /* 1 + 4 / 4 + 0.5 * 4 */
        {{DISPERSION_CAUCHY_POWERS, 5, {1.0, 1.0, 3.0, 0.125, -1.0}, 0, 0}, 500.0, 1.375},
        {{DISPERSION_CAUCHY, 3, {1.0, 0.0625, 0.03125}, 0, 0}, 500.0, 1.75}, /* 1 + 4 / 16 + 16 / 32 */
        {{DISPERSION_GAS, 4, {0.5, 6.0, 1.0, 12.0}, 0, 0}, 500.0, 1.375},    /* 1 + 0.5 / 2 + 1 / 8 */
        {{DISPERSION_GAS_FROM, 3, {0.25, 0.5, 6.0}, 0, 0}, 500.0, 1.5},
        {{DISPERSION_SELLMEIER_FROM, 3, {2.0, 6.0, 0.0}, 0, 0}, 1000.0, 3.0}, /* 1 + 2 + 6 */
        /* 1 + 6 L^2 / (L^2 - 0.5^2) at 1 um, without the second */
        {{DISPERSION_TWO_RESONANCES, 9, {1.0, 6.0, 2.0, 0.5, 2.0, 0, 0, 0, 0}, 0, 0}, 1000.0, 3.0},
        {{DISPERSION_RETRO, 4, {0.25, 0.1875, 0.25, 0.0}, 0, 0}, 1000.0, 2.0}, /* q = 1/2: n^2 = 4 */
        {{DISPERSION_EXOTIC, 6, {1.0, 2.25, 0.25, 2.0, 0.0, 1.0}, 0, 0}, 1000.0, 2.2360679774997896964}, /* 1 + 3 + 1 */
    };
    for (size_t k = 0; k < COUNT(easy); k++)
        assert_true(dispersion_index(&easy[k].law, easy[k].lambda_nm) == easy[k].n);
}

static void tables_are_linear_between_their_points(void **state)
{
    (void)state;
    const dispersion table = {DISPERSION_TABLE, 6, {400.0, 1.5, 500.0, 1.25, 700.0, 1.125}, 0, 0};
    assert_int_equal(dispersion_check(&table, NULL), STATUS_OK);
    const double wanted[][2] = {{380.0, 1.5},     {400.0, 1.5},    {425.0, 1.4375}, {450.0, 1.375}, {500.0, 1.25},
                                {550.0, 1.21875}, {600.0, 1.1875}, {700.0, 1.125},  {780.0, 1.125}};
    for (size_t k = 0; k < COUNT(wanted); k++)
        assert_true(dispersion_index(&table, wanted[k][0]) == wanted[k][1]);
    assert_near(dispersion_index(&table, nextafter(500.0, 0.0)), 1.25, 1e-12);
    assert_near(dispersion_index(&table, 500.5), 1.2496875, 1e-15);
    const dispersion point = {DISPERSION_TABLE, 2, {589.3, 1.33}, 0, 0};
    assert_int_equal(dispersion_check(&point, NULL), STATUS_OK);
    assert_true(dispersion_index(&point, 400.0) == 1.33 && dispersion_index(&point, 589.3) == 1.33 &&
                dispersion_index(&point, 700.0) == 1.33);
}

/* n = A + B / L^2 has V = (A - 1 + B / L_d^2) / (B / L_F^2 - B / L_C^2). */
static void the_abbe_number_of_a_cauchy_law_has_its_closed_form(void **state)
{
    (void)state;
    const long double d = 0.5875618L, F = 0.4861327L, C = 0.6562725L, A = 1.5L, B = 0.004L;
    const dispersion law = {DISPERSION_CAUCHY, 2, {1.5, 0.004}, 0, 0};
    assert_near(dispersion_abbe_number(&law), (A - 1 + B / (d * d)) / (B / (F * F) - B / (C * C)), 1e-11);
    assert_true(isinf(dispersion_abbe_number(&laws[0])));
    const dispersion vacuum = {DISPERSION_CONSTANT, 1, {1.0}, 0, 0};
    assert_true(isinf(dispersion_abbe_number(&vacuum)));
}

static void coverage_is_the_given_range(void **state)
{
    (void)state;
    dispersion law = {DISPERSION_CAUCHY, 1, {1.5}, 400.0, 700.0};
    assert_true(dispersion_covers(&law, 400.0, 700.0));
    assert_true(dispersion_covers(&law, 500.0, 500.0));
    assert_false(dispersion_covers(&law, 399.9, 700.0));
    assert_false(dispersion_covers(&law, 400.0, 700.1));
    law.low_nm = law.high_nm = 0.0;
    assert_true(dispersion_covers(&law, 1.0, 1e6));
    law.low_nm = law.high_nm = 589.3;
    assert_true(dispersion_covers(&law, 589.3, 589.3));
    assert_false(dispersion_covers(&law, 589.3, 589.4));
    const dispersion table = {DISPERSION_TABLE, 4, {400.0, 1.5, 500.0, 1.25}, 0, 0};
    assert_true(dispersion_covers(&table, 400.0, 500.0));
    assert_false(dispersion_covers(&table, 399.0, 500.0));
    assert_false(dispersion_covers(&table, 400.0, 501.0));
}

static void invalid_laws_are_refused_with_a_reason(void **state)
{
    (void)state;
    const struct {
        dispersion law;
        const char *what, *remedy;
    } bad[] = {
        {{(dispersion_kind)DISPERSION_KIND_COUNT, 1, {1.5}, 0, 0}, "unknown dispersion law", ""},
        {{DISPERSION_CONSTANT, 0, {0}, 0, 0}, "0 numbers do not fit the dispersion law 'constant'", "one number"},
        {{DISPERSION_CONSTANT, -1, {0}, 0, 0}, "-1 numbers", "one number"},
        {{DISPERSION_CONSTANT, 2, {1.5, 1.5}, 0, 0}, "2 numbers", "one number"},
        {{DISPERSION_SELLMEIER, 3, {1.0, 0.01, 1.0}, 0, 0},
         "3 numbers do not fit the dispersion law 'sellmeier'",
         "um^2"},
        {{DISPERSION_SELLMEIER_LENGTHS, 1, {1.0}, 0, 0},
         "1 numbers do not fit the dispersion law 'sellmeier-lengths'",
         "um"},
        {{DISPERSION_POLYNOMIAL, 2, {2.0, 0.1}, 0, 0}, "2 numbers", "its power"},
        {{DISPERSION_CAUCHY_POWERS, 4, {1.5, 0.1, 2.0, 0.1}, 0, 0}, "4 numbers", "its power"},
        {{DISPERSION_CAUCHY, 0, {0}, 0, 0}, "0 numbers", "um^4"},
        {{DISPERSION_GAS, 3, {0.1, 2.0, 0.1}, 0, 0}, "3 numbers", "um^-2"},
        {{DISPERSION_TABLE, 3, {400.0, 1.5, 500.0}, 0, 0}, "3 numbers", "ascending"},
        {{DISPERSION_CAUCHY, 33, {1.5}, 0, 0}, "at most 32 numbers, not 33", "um^4"},
        {{DISPERSION_CAUCHY, 2, {1.5, NAN}, 0, 0}, "number 2 of the dispersion law 'cauchy' is not finite", "finite"},
        {{DISPERSION_CONSTANT, 1, {INFINITY}, 0, 0}, "number 1", "finite"},
        {{DISPERSION_CONSTANT, 1, {1.5}, 700.0, 400.0}, "700..400 nm is not a range", "lower"},
        {{DISPERSION_CONSTANT, 1, {1.5}, 0.0, 400.0}, "0..400 nm is not a range", "above 0"},
        {{DISPERSION_CONSTANT, 1, {1.5}, NAN, 400.0}, "nan..400 nm is not a range", "above 0"},
        {{DISPERSION_CONSTANT, 1, {1.5}, 300.0, INFINITY}, "300..inf nm is not a range", "above 0"},
        {{DISPERSION_POLYNOMIAL, 3, {2.0, 0.1, 16.5}, 0, 0}, "the exponent 16.5", "power from -16 to 16"},
        {{DISPERSION_CAUCHY_POWERS, 3, {1.5, 0.1, -17.0}, 0, 0}, "the exponent -17", "power"},
        {{DISPERSION_TABLE, 4, {500.0, 1.5, 500.0, 1.5}, 0, 0}, "500 nm after 500 nm", "ascending"},
        {{DISPERSION_TABLE, 6, {400.0, 1.5, 600.0, 1.5, 500.0, 1.5}, 0, 0}, "500 nm after 600 nm", "ascending"},
        {{DISPERSION_TABLE, 2, {0.0, 1.5}, 0, 0}, "0 nm after 0 nm", "above 0"},
        {{DISPERSION_TABLE, 6, {100.0, 0.05, 400.0, 1.5, 500.0, 1.5}, 0, 0}, "the index 0.05", "pairs"},
        {{DISPERSION_TABLE, 4, {400.0, 1.5, 500.0, 100.1}, 0, 0}, "a table of indices has the index 100.1", "pairs"},
        /* samples at whole nanometres miss these */
        {{DISPERSION_SELLMEIER, 2, {1e-9, 0.30030400}, 0, 0}, "a resonance at 548 nm", "um^2"},
        {{DISPERSION_SELLMEIER_LENGTHS, 2, {1e-9, 0.5505}, 0, 0}, "a resonance at 550.5 nm", "um"},
        {{DISPERSION_SELLMEIER_LENGTHS, 2, {1e-9, -0.5505}, 0, 0}, "a resonance at 550.5 nm", "um"},
        {{DISPERSION_GAS, 2, {1e-9, 3.2998}, 0, 0}, "a resonance at 550.", "um^-2"},
        /* both ends of the visible belong to it; the last one's index falls below 0.1 at 780 nm alone */
        {{DISPERSION_SELLMEIER_LENGTHS, 2, {1e-9, 0.38}, 0, 0}, "a resonance at 380 nm", "um"},
        {{DISPERSION_SELLMEIER_LENGTHS, 2, {1e-9, 0.78}, 0, 0}, "a resonance at 780 nm", "um"},
        {{DISPERSION_CAUCHY_POWERS, 3, {1.0, -0.905 / 0.0187708, 16.0}, 0, 0}, "at 780 nm", "its power"},
        {{DISPERSION_SELLMEIER, 2, {-3.0, 0.01}, 0, 0}, "no real index at 380 nm", "um^2"},
        {{DISPERSION_POLYNOMIAL, 3, {-2.0, 4.0, 2.0}, 0, 0}, "no real index at 380 nm", "power"},
        {{DISPERSION_CONSTANT, 1, {0.09}, 0, 0}, "the index 0.09 at 380 nm", "one number"},
        {{DISPERSION_CONSTANT, 1, {101.0}, 0, 0}, "the index 101 at 380 nm", "one number"},
        {{DISPERSION_CAUCHY, 2, {1.5, -0.5}, 0, 0}, "the index -", "um^4"},
    };
    for (size_t k = 0; k < COUNT(bad); k++) {
        diagnostic why = {0};
        assert_int_equal(dispersion_check(&bad[k].law, &why), STATUS_BAD_INPUT);
        if (!strstr(why.what, bad[k].what) || !strstr(why.remedy, bad[k].remedy))
            fail_msg("\"%s; %s\" lacks \"%s\" or \"%s\"", why.what, why.remedy, bad[k].what, bad[k].remedy);
        assert_int_equal(dispersion_check(&bad[k].law, NULL), STATUS_BAD_INPUT);
    }
}

/* A term with zero weight, as catalogues pad short laws, and resonances just outside the visible. */
static void laws_at_the_limits_are_accepted(void **state)
{
    (void)state;
    const dispersion good[] = {
        {DISPERSION_SELLMEIER, 4, {1.25, 0.01, 0.0, 0.0}, 0, 0},
        {DISPERSION_SELLMEIER_LENGTHS, 2, {0.00001, 0.3799}, 0, 0},
        {DISPERSION_SELLMEIER_LENGTHS, 2, {0.00001, 0.7801}, 0, 0},
        {DISPERSION_CONSTANT, 1, {0.1}, 0, 0},
        {DISPERSION_CONSTANT, 1, {100.0}, 589.3, 589.3},
        {DISPERSION_CAUCHY_POWERS, 5, {1.5, 0.0, 16.0, 0.0, -16.0}, 0, 0},
        {DISPERSION_CAUCHY, DISPERSION_TERMS_MAX, {1.5}, 0, 0},
    };
    for (size_t k = 0; k < COUNT(good); k++)
        assert_int_equal(dispersion_check(&good[k], NULL), STATUS_OK);
}

static void every_kind_has_its_own_name_and_formula(void **state)
{
    (void)state;
    for (int i = 0; i < DISPERSION_KIND_COUNT; i++) {
        assert_non_null(dispersion_name((dispersion_kind)i));
        assert_non_null(dispersion_formula((dispersion_kind)i));
        for (int k = 0; k < i; k++) {
            assert_string_not_equal(dispersion_name((dispersion_kind)i), dispersion_name((dispersion_kind)k));
            assert_string_not_equal(dispersion_formula((dispersion_kind)i), dispersion_formula((dispersion_kind)k));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(laws_agree_with_their_formulas),
        cmocka_unit_test(what_follows_the_coefficients_is_not_read),
        cmocka_unit_test(laws_equal_values_computed_by_hand),
        cmocka_unit_test(tables_are_linear_between_their_points),
        cmocka_unit_test(the_abbe_number_of_a_cauchy_law_has_its_closed_form),
        cmocka_unit_test(coverage_is_the_given_range),
        cmocka_unit_test(invalid_laws_are_refused_with_a_reason),
        cmocka_unit_test(laws_at_the_limits_are_accepted),
        cmocka_unit_test(every_kind_has_its_own_name_and_formula),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
