/* Tests of lamps' spectra against Wien's law, the CIE's chromaticities, and Balmer's formula. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "optics/spectrum.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* Wien's displacement law: the maximum is at c2 / (4.965114231744276 T), the root of x = 5 (1 - e^-x). */
static void a_black_body_is_brightest_by_wien(void **state)
{
    (void)state;
    for (double temperature_k = 4000.0; temperature_k <= 7000.0; temperature_k += 500.0) {
        const double peak_nm = 1.4388e7 / (4.965114231744276 * temperature_k);
        const double peak = planck_relative(peak_nm, temperature_k);
        for (double off = 1e-3; off < 0.2; off *= 2.0) {
            assert_true(planck_relative(peak_nm * (1.0 + off), temperature_k) < peak);
            assert_true(planck_relative(peak_nm * (1.0 - off), temperature_k) < peak);
        }
        /* the curve is even there to first order */
        const double right = planck_relative(peak_nm * 1.0001, temperature_k) / peak - 1.0,
                     left = planck_relative(peak_nm * 0.9999, temperature_k) / peak - 1.0;
        assert_near(right, left, 1e-3 * fabs(right));
    }
}

/* Far below the peak Wien's approximation holds, far above it Rayleigh's and Jeans's, B ~ T / lambda^4. */
static void a_black_body_has_its_limits(void **state)
{
    (void)state;
    const double cold = planck_relative(400.0, 500.0);
    assert_near(cold / (pow(560.0 / 400.0, 5.0) * exp(-1.4388e7 / 500.0 * (1.0 / 400.0 - 1.0 / 560.0))), 1.0, 1e-12);
    const double x = 1.4388e7 / 1e5; /* over nm: e^z - 1 = z (1 + z / 2 + z^2 / 6 + z^3 / 24 ...) */
    double series[2];
    for (int i = 0; i < 2; i++) {
        const double z = x / (i ? 560.0 : 780.0);
        series[i] = z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0 * (1.0 + z / 5.0 * (1.0 + z / 6.0)))));
    }
    assert_near(planck_relative(780.0, 1e5) / (pow(560.0 / 780.0, 5.0) * series[1] / series[0]), 1.0, 1e-7);
}

static void chromaticity(double temperature_k, double *x, double *y)
{
    double xyz[3] = {0.0, 0.0, 0.0}, sum = 0.0;
    for (int nm = 380; nm < 780; nm++) {
        double w[3];
        observer_weights(nm + 0.5, w);
        for (int c = 0; c < 3; c++)
            xyz[c] += w[c] * planck_relative(nm + 0.5, temperature_k);
    }
    for (int c = 0; c < 3; c++)
        sum += xyz[c];
    *x = xyz[0] / sum, *y = xyz[1] / sum;
}

/* Illuminant A is a black body of 2856 K (CIE 15:2018, table T.3: 0.44758, 0.40745); the others are of Wyszecki and
 * Stiles, Color Science, 2nd ed., table 1(3.11). */
static void black_bodies_have_the_published_chromaticities(void **state)
{
    (void)state;
    static const double published[][3] = {
        {2000.0, 0.5267, 0.4133}, {2856.0, 0.44758, 0.40745}, {5000.0, 0.3451, 0.3516}, {10000.0, 0.2807, 0.2884}};
    for (int i = 0; i < 4; i++) {
        double x, y;
        chromaticity(published[i][0], &x, &y);
        assert_near(x, published[i][1], 3e-4);
        assert_near(y, published[i][2], 3e-4);
    }
}

/* 1 / lambda = R_H (1 / 4 - 1 / n^2) in vacuum, with the index of air 1.00028 (1.000276 to 1.000283 over the range);
 * fine structure widens H alpha to 0.014 nm, which the formula does not have. */
static void hydrogen_has_balmers_lines(void **state)
{
    (void)state;
    spectral_line lines[LAMP_LINES_MAX];
    const int count = lamp_lines(LAMP_HYDROGEN, 0.0, lines);
    assert_int_equal(count, 5);
    for (int k = 0; k < count; k++) {
        const double n = 7.0 - k, vacuum_nm = 1e9 / (1.0967758e7 * (0.25 - 1.0 / (n * n)));
        assert_near(lines[k].nm, vacuum_nm / 1.00028, 0.01);
    }
}

/* The D lines differ by the spin-orbit splitting of 3p, 17.196 cm^-1, and D2 is twice as strong. */
static void sodium_has_the_doublet(void **state)
{
    (void)state;
    spectral_line lines[LAMP_LINES_MAX];
    assert_int_equal(lamp_lines(LAMP_SODIUM, 0.0, lines), 2);
    assert_near(1e7 / lines[0].nm - 1e7 / lines[1].nm, 17.196 * 1.00028, 0.02);
    assert_near(lines[0].power / lines[1].power, 2.0, 1e-12);
}

static void all_lamps_are_as_bright(void **state)
{
    (void)state;
    for (lamp_spectrum kind = LAMP_SODIUM; kind <= LAMP_LINE; kind++) {
        spectral_line lines[LAMP_LINES_MAX];
        const int count = lamp_lines(kind, 632.8, lines);
        double luminance = 0.0;
        for (int k = 0; k < count; k++) {
            double w[3];
            observer_weights(lines[k].nm, w);
            luminance += w[1] * lines[k].power;
            assert_true(lines[k].power > 0.0 && (k == 0 || lines[k].nm > lines[k - 1].nm));
        }
        assert_near(luminance, 1.0, 1e-12);
    }
    double luminance = 0.0;
    for (int tenth = 3800; tenth < 7800; tenth++) { /* steps of 0.1 nm against the 1 nm of the scale */
        double w[3];
        observer_weights(0.1 * tenth + 0.05, w);
        luminance += w[1] * planck_relative(0.1 * tenth + 0.05, 3000.0) / 4000.0;
    }
    assert_near(luminance * black_body_scale(3000.0), 1.0, 1e-6);
}

/* The colour keeps Y = 1, lies on the line from white to the lamp's chromaticity, and at the gamut's border. */
static void colors_are_brought_into_the_gamut(void **state)
{
    (void)state;
    double rgb[3], xyz[3], w[3], white[3];
    linear_srgb_to_xyz((const double[3]){1.0, 1.0, 1.0}, white);
    for (double nm = 430.0; nm <= 680.0; nm += 10.0) {
        lamp_rgb(LAMP_LINE, 5000.0, nm, rgb);
        linear_srgb_to_xyz(rgb, xyz);
        observer_weights(nm, w);
        assert_near(xyz[1], 1.0, 1e-12);
        assert_near(fmin(rgb[0], fmin(rgb[1], rgb[2])), 0.0, 1e-14 * fmax(rgb[0], fmax(rgb[1], rgb[2])));
        const double u = xyz[0] - white[0], v = xyz[2] - white[2], a = w[0] / w[1] - white[0],
                     b = w[2] / w[1] - white[2];
        assert_near(u * b - v * a, 0.0, 1e-9 * (fabs(a * v) + fabs(b * u) + 1e-3)); /* collinear */
        assert_true(u * a + v * b > 0.0);
    }
    lamp_rgb(LAMP_BLACK_BODY, 6500.0, 0.0, rgb); /* near white, inside the gamut */
    linear_srgb_to_xyz(rgb, xyz);
    assert_near(xyz[1], 1.0, 1e-12);
    assert_true(rgb[0] > 0.9 && rgb[2] > 0.9 && rgb[0] < 1.1 && rgb[2] < 1.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_black_body_is_brightest_by_wien),
        cmocka_unit_test(a_black_body_has_its_limits),
        cmocka_unit_test(black_bodies_have_the_published_chromaticities),
        cmocka_unit_test(hydrogen_has_balmers_lines),
        cmocka_unit_test(sodium_has_the_doublet),
        cmocka_unit_test(all_lamps_are_as_bright),
        cmocka_unit_test(colors_are_brought_into_the_gamut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
