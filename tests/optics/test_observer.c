/* Tests of the standard observer, D65 and the sRGB matrices against published values. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "optics/spectrum.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* XYZ of observer_d65 times reflectance over low .. high, as the mean of the weights. Simpson's rule on every 5 nm is
 * exact for a constant reflectance. */
static void daylight_xyz(int low_nm, int high_nm, double xyz[3])
{
    xyz[0] = xyz[1] = xyz[2] = 0.0;
    for (int nm = low_nm; nm < high_nm; nm += 5) {
        for (int k = 0; k < 3; k++) {
            double lambda_nm = nm + 2.5 * k, weights[3];
            observer_weights(lambda_nm, weights);
            for (int i = 0; i < 3; i++)
                xyz[i] += (k == 1 ? 4.0 : 1.0) * 5.0 / 6.0 * weights[i] * observer_d65(lambda_nm) /
                          (OBSERVER_HIGH_NM - OBSERVER_LOW_NM);
        }
    }
}

/* CIE 15:2018, table 6 (Wyszecki and Stiles, Color Science, 2nd ed., table I(3.3.1)). */
static void matching_functions_have_their_published_values(void **state)
{
    (void)state;
    static const struct {
        double lambda_nm, xyz[3];
    } known[] = {
        {400, {0.01431, 0.000396, 0.06785}},
        {445, {0.34806, 0.0298, 1.7826}},
        {500, {0.0049, 0.3230, 0.2720}},
        {520, {0.06327, 0.7100, 0.07825}},
        {555, {0.51205, 1.0000, 0.00575}},
        {560, {0.5945, 0.9950, 0.0039}},
        {600, {1.0622, 0.6310, 0.0008}},
        {650, {0.2835, 0.1070, 0.0}},
        {700, {0.011359, 0.004102, 0.0}},
        {780, {0.00004151, 0.00001499, 0.0}},
        {360, {0.0001299, 0.000003917, 0.0006061}},
    };
    for (size_t k = 0; k < COUNT(known); k++) {
        double xyz[3];
        observer_xyz(known[k].lambda_nm, xyz);
        for (int i = 0; i < 3; i++)
            assert_near(xyz[i], known[k].xyz[i], 5e-7);
    }
}

/* The sums that CIE 15:2004, table T.4, prints below its columns: 380 .. 780 nm at 5 nm. */
static void sums_of_the_matching_functions_are_equal_and_published(void **state)
{
    (void)state;
    double sum[3] = {0.0, 0.0, 0.0}, xyz[3], highest = 0.0, highest_nm = 0.0;
    for (int nm = 380; nm <= 780; nm += 5) {
        observer_xyz(nm, xyz);
        for (int i = 0; i < 3; i++)
            sum[i] += xyz[i];
        if (xyz[1] > highest) {
            highest = xyz[1];
            highest_nm = nm;
        }
    }
    assert_near(sum[0], 21.371524, 2e-6);
    assert_near(sum[1], 21.371327, 2e-6);
    assert_near(sum[2], 21.371540, 2e-6);
    assert_true(highest == 1.0 && highest_nm == 555.0);
}

static void tables_are_linear_between_entries_and_zero_outside(void **state)
{
    (void)state;
    double xyz[3], low[3], high[3];
    observer_xyz(600.0, low);
    observer_xyz(605.0, high);
    observer_xyz(601.0, xyz);
    for (int i = 0; i < 3; i++)
        assert_near(xyz[i], 0.8 * low[i] + 0.2 * high[i], 1e-15);
    assert_near(observer_d65(604.0), 0.2 * observer_d65(600.0) + 0.8 * observer_d65(605.0), 1e-15);
    const double outside[] = {359.999, 830.001, 0.0, -1.0, 1e300, -1e300, (double)INFINITY, (double)NAN};
    for (size_t k = 0; k < COUNT(outside); k++) {
        observer_xyz(outside[k], xyz);
        assert_true(xyz[0] == 0.0 && xyz[1] == 0.0 && xyz[2] == 0.0 && observer_d65(outside[k]) == 0.0);
    }
    observer_xyz(830.0, xyz);
    assert_near(xyz[1], 4.5181e-7, 1e-12);
}

/* ISO/CIE 11664-2, table 1: relative to 100 at 560 nm. */
static void daylight_has_its_published_values(void **state)
{
    (void)state;
    static const double known[][2] = {{360, 46.6383}, {380, 49.9755}, {400, 82.7549}, {450, 117.008},
                                      {460, 117.812}, {500, 109.354}, {560, 100.0},   {600, 90.0062},
                                      {650, 80.0268}, {700, 71.6091}, {780, 63.3828}, {830, 60.3125}};
    for (size_t k = 0; k < COUNT(known); k++)
        assert_near(100.0 * observer_d65(known[k][0]) / observer_d65(560.0), known[k][1], 1e-9);
}

/* CIE 15:2018, table 3: x = 0.31272, y = 0.32903; the white point of IEC 61966-2-1 is 0.3127, 0.3290. */
static void daylight_has_its_published_chromaticity(void **state)
{
    (void)state;
    double xyz[3];
    for (int range = 0; range < 2; range++) {
        daylight_xyz(range ? 360 : OBSERVER_LOW_NM, range ? 830 : OBSERVER_HIGH_NM, xyz);
        double sum = xyz[0] + xyz[1] + xyz[2];
        assert_near(xyz[0] / sum, 0.31272, 1e-4);
        assert_near(xyz[1] / sum, 0.32903, 1e-4);
    }
}

static void the_share_of_daylight_outside_the_sampled_range_is_small(void **state)
{
    (void)state;
    static const double most[3] = {5.8e-5, 2.8e-6, 2.3e-4};
    double all[3], sampled[3];
    daylight_xyz(360, 830, all);
    daylight_xyz(OBSERVER_LOW_NM, OBSERVER_HIGH_NM, sampled);
    for (int i = 0; i < 3; i++)
        assert_true(sampled[i] < all[i] && 1.0 - sampled[i] / all[i] < most[i]);
}

static void a_white_reflectance_gives_white(void **state)
{
    (void)state;
    double xyz[3], rgb[3];
    daylight_xyz(OBSERVER_LOW_NM, OBSERVER_HIGH_NM, xyz);
    assert_near(xyz[1], 1.0, 1e-12);
    xyz_to_linear_srgb(xyz, rgb);
    for (int i = 0; i < 3; i++)
        assert_near(rgb[i], 1.0, 1e-12);
}

/* With evenly spread wavelengths, as a renderer samples them; the equal-energy spectrum has x = y = 1/3. */
static void the_mean_of_the_weights_is_the_colour_of_a_spectrum(void **state)
{
    (void)state;
    const int samples = 100000;
    double constant[3] = {0.0, 0.0, 0.0}, daylight[3] = {0.0, 0.0, 0.0}, rgb[3], weights[3];
    for (int k = 0; k < samples; k++) {
        double lambda_nm = OBSERVER_LOW_NM + (OBSERVER_HIGH_NM - OBSERVER_LOW_NM) * (k + 0.5) / samples;
        observer_weights(lambda_nm, weights);
        for (int i = 0; i < 3; i++) {
            constant[i] += weights[i] / samples;
            daylight[i] += weights[i] * observer_d65(lambda_nm) / samples;
        }
    }
    assert_near(constant[1], 1.0, 1e-8);
    assert_near(constant[0], 1.0, 2e-4);
    assert_near(constant[2], 1.0, 2e-4);
    xyz_to_linear_srgb(daylight, rgb);
    for (int i = 0; i < 3; i++)
        assert_near(rgb[i], 1.0, 1e-8);
}

/* IEC 61966-2-1, and the primaries of ITU-R BT.709, which hold exactly. */
static void the_primaries_have_srgbs_chromaticities(void **state)
{
    (void)state;
    static const double published[3][3] = {
        {0.4124, 0.2126, 0.0193}, {0.3576, 0.7152, 0.1192}, {0.1805, 0.0722, 0.9505}};
    static const double chromaticity[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
    for (int k = 0; k < 3; k++) {
        double rgb[3] = {k == 0, k == 1, k == 2}, xyz[3];
        linear_srgb_to_xyz(rgb, xyz);
        for (int i = 0; i < 3; i++)
            assert_near(xyz[i], published[k][i], 1e-3);
        double sum = xyz[0] + xyz[1] + xyz[2];
        assert_near(xyz[0] / sum, chromaticity[k][0], 1e-15);
        assert_near(xyz[1] / sum, chromaticity[k][1], 1e-15);
    }
}

static void the_two_matrices_are_inverse(void **state)
{
    (void)state;
    double last[4] = {0.1, 0.2, 0.3, -7.0}; /* in place, and of three numbers only */
    xyz_to_linear_srgb(last, last);
    linear_srgb_to_xyz(last, last);
    assert_true(fabs(last[0] - 0.1) < 1e-15 && fabs(last[2] - 0.3) < 1e-15 && last[3] == -7.0);
    const double rgb[3] = {0.2, -0.7, 3.0};
    double xyz[3], back[3], in_place[3] = {0.2, -0.7, 3.0};
    linear_srgb_to_xyz(rgb, xyz);
    xyz_to_linear_srgb(xyz, back);
    linear_srgb_to_xyz(in_place, in_place);
    for (int i = 0; i < 3; i++) {
        assert_near(back[i], rgb[i], 1e-14);
        assert_true(in_place[i] == xyz[i]);
    }
}

/* The locus is at these chromaticities (Wyszecki and Stiles, table I(3.3.1)); none of its colours is in the gamut, and
 * each has negative components for distant primaries. */
static void single_wavelengths_are_on_the_spectral_locus(void **state)
{
    (void)state;
    static const struct {
        double lambda_nm, x, y;
        int least; /* component of linear sRGB */
    } known[] = {{460, 0.1440, 0.0297, 1}, {480, 0.0913, 0.1327, 0}, {520, 0.0743, 0.8338, 0},
                 {560, 0.3731, 0.6245, 2}, {600, 0.6270, 0.3725, 2}, {700, 0.7347, 0.2653, 1}};
    for (size_t k = 0; k < COUNT(known); k++) {
        double xyz[3], rgb[3];
        observer_xyz(known[k].lambda_nm, xyz);
        double sum = xyz[0] + xyz[1] + xyz[2];
        assert_near(xyz[0] / sum, known[k].x, 1e-4);
        assert_near(xyz[1] / sum, known[k].y, 1e-4);
        xyz_to_linear_srgb(xyz, rgb);
        for (int i = 0; i < 3; i++)
            assert_true(rgb[known[k].least] <= rgb[i]);
        assert_true(rgb[known[k].least] < 0.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matching_functions_have_their_published_values),
        cmocka_unit_test(sums_of_the_matching_functions_are_equal_and_published),
        cmocka_unit_test(tables_are_linear_between_entries_and_zero_outside),
        cmocka_unit_test(daylight_has_its_published_values),
        cmocka_unit_test(daylight_has_its_published_chromaticity),
        cmocka_unit_test(the_share_of_daylight_outside_the_sampled_range_is_small),
        cmocka_unit_test(a_white_reflectance_gives_white),
        cmocka_unit_test(the_mean_of_the_weights_is_the_colour_of_a_spectrum),
        cmocka_unit_test(the_primaries_have_srgbs_chromaticities),
        cmocka_unit_test(the_two_matrices_are_inverse),
        cmocka_unit_test(single_wavelengths_are_on_the_spectral_locus),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
