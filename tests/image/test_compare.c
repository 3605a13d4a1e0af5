/* Tests of image comparison: closed forms, and independent programs on images computed by formulas. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "image/codec.h"
#include "image/compare.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The test images: linear light k / 256 with an integer k, 0 to 256, that depends on position, channel and variant (0
 * for a, 1 for b), so that floats hold it exactly and another program can compute the same. */
typedef int formula(int x, int y, int channel, int variant);

static int ramp(int x, int y, int channel, int variant)
{
    int right = x + variant;
    return channel == 0 ? 4 * right : channel == 1 ? 5 * y : 2 * right + 2 * y;
}

static int checker(int x, int y, int channel, int variant)
{
    static const int colors[2][3] = {{25, 200, 128}, {230, 40, 128}};
    return colors[((x + 3 * variant) / 8 + y / 8) & 1][channel];
}

static int disc(int x, int y, int channel, int variant)
{
    static const int inside[3] = {220, 180, 40}, outside[3] = {20, 60, 110};
    int dx = x - 48 - 4 * variant, dy = y - 30 - variant;
    return dx * dx + dy * dy <= 17 * 17 ? inside[channel] : outside[channel];
}

static int hashed(int x, int y, int channel)
{
    uint32_t h = (uint32_t)x * 374761393u + (uint32_t)y * 668265263u + (uint32_t)channel * 2246822519u;
    h = (h ^ (h >> 13)) * 1274126177u;
    return (int)((h ^ (h >> 16)) & 255);
}

static int grain(int x, int y, int channel, int variant)
{
    int k = hashed(x, y, channel) + (variant ? hashed(x, y, channel + 3) % 33 - 16 : 0);
    return k < 0 ? 0 : k > 256 ? 256 : k;
}

static image *make(int width, int height, formula *of, int variant)
{
    image *img;
    assert_int_equal(image_create(width, height, &img, NULL), STATUS_OK);
    for (int i = 0; i < 3 * width * height; i++)
        img->pixel[i] = (float)of(i / 3 % width, i / 3 / width, i % 3, variant) / 256.0f;
    return img;
}

static image *constant(int width, int height, double linear)
{
    image *img;
    assert_int_equal(image_create(width, height, &img, NULL), STATUS_OK);
    for (int i = 0; i < 3 * width * height; i++)
        img->pixel[i] = (float)linear;
    return img;
}

static image_comparison compare(const image *a, const image *b)
{
    image_comparison c;
    diagnostic why = {0};
    assert_int_equal(image_compare(a, b, &c, &why), STATUS_OK);
    return c;
}

/* Compares and frees both images. */
static image_comparison compare_once(image *a, image *b)
{
    image_comparison c = compare(a, b);
    image_destroy(a);
    image_destroy(b);
    return c;
}

static void assert_near(double value, double expected, double within)
{
    if (!(fabs(value - expected) <= within))
        fail_msg("%.12g is not %.12g within %g", value, expected, within);
}

/* Sources of the numbers, all computed in double precision from the formulas above, encoded by IEC 61966-2-1. mse,
 * psnr, largest, share: NumPy 1.24.2, array expressions. ssim: scikit-image 0.19.3, structural_similarity(luma a, luma
 * b, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=1); where a side is under 11, which it
 * refuses, NumPy by the definition in compare_parts.c, window by window, with central moments. The two agree to 1e-12
 * where both are available. flip: the authors' Python implementation (github.com/NVlabs/flip, python/flip_api.py at
 * 313517b, compute_ldrflip), float64 in place of float32, and for its cv.filter2D SciPy 1.10.1's
 * ndimage.correlate(mode='nearest'), both explicit two-dimensional sums. */
typedef struct expectation {
    formula *of;
    int width, height;
    double mse, psnr_db, ssim, flip, largest;
    int largest_x, largest_y;
    double differing_fraction;
} expectation;

static const expectation expectations[] = {
    {ramp, 64, 48, 0.000201205595606, 36.9635994555, 0.999865705879, 0.0679367240169, 0.131499413538, 0, 0, 1},
    {checker, 97, 61, 0.0726024986084, 11.3904843284, 0.403010886203, 0.562376275448, 0.608740693504, 5, 0,
     0.371134020619},
    {disc, 97, 61, 0.00890586314515, 20.5032398288, 0.804421185228, 0.127466864791, 0.625758415861, 48, 13,
     0.0469832685483},
    {grain, 64, 48, 0.00191376546681, 27.1811128637, 0.983334047748, 0.0731984010034, 0.27730417691, 44, 7, 1},
    {grain, 97, 61, 0.00195465395023, 27.0893011848, 0.982434714651, 0.0734159691613, 0.27730417691, 44, 7, 1},
    {grain, 11, 11, 0.00190067004138, 27.2109327064, 0.988007736272, 0.0857366811361, 0.229271132427, 9, 4, 1},
    {grain, 10, 10, 0.00209302574993, 26.7922542862, 0.989716972294, 0.0765235143508, 0.229271132427, 9, 4, 1},
    {grain, 40, 6, 0.0019576822726, 27.0825779182, 0.981909739106, 0.0810875708614, 0.268487248063, 23, 4, 1},
    {grain, 7, 5, 0.00221134865681, 26.553427781, 0.987915062998, 0.109507201482, 0.218203216064, 3, 2, 1},
    {grain, 1, 1, 0.0149869930778, 18.2428549328, 0.995277663708, 0.27845931009, 0.206468988225, 0, 0, 1},
};

static void every_measure_equals_independent_programs(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof expectations / sizeof *expectations; i++) {
        const expectation *e = &expectations[i];
        image_comparison c = compare_once(make(e->width, e->height, e->of, 0), make(e->width, e->height, e->of, 1));
        print_message("%d x %d: ssim off by %.1e, flip by %.1e\n", e->width, e->height, c.ssim - e->ssim,
                      c.flip - e->flip);
        assert_near(c.mse, e->mse, 1e-10);
        assert_near(c.psnr_db, e->psnr_db, 1e-8);
        assert_near(c.ssim, e->ssim, 1e-10);
        assert_near(c.flip, e->flip, 1e-7);
        assert_near(c.largest, e->largest, 1e-10);
        assert_int_equal(c.largest_x, e->largest_x);
        assert_int_equal(c.largest_y, e->largest_y);
        assert_near(c.differing_fraction, e->differing_fraction, 1e-10);
    }
}

static void every_measure_is_symmetric(void **state)
{
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        const expectation *e = &expectations[i];
        image *a = make(e->width, e->height, e->of, 0), *b = make(e->width, e->height, e->of, 1);
        image_comparison one = compare(a, b), other = compare(b, a);
        assert_memory_equal(&one, &other, sizeof one);
        image_destroy(a);
        image_destroy(b);
    }
}

static void an_image_is_identical_to_itself(void **state)
{
    (void)state;
    image *a = make(97, 61, grain, 0);
    image_comparison c = compare(a, a);
    image_destroy(a);
    assert_true(c.mse == 0 && isinf(c.psnr_db) && c.psnr_db > 0);
    assert_near(c.ssim, 1.0, 1e-12);
    assert_true(c.flip == 0 && c.largest == 0 && c.differing_fraction == 0 && c.largest_x == 0 && c.largest_y == 0);
}

/* A known offset of the encoded values: mse is its square, psnr follows by definition; the variances of two constants
 * are 0, so that the similarity is (2 a b + C1) / (a^2 + b^2 + C1), Wang et al. eq. 6. */
static void constants_have_closed_forms(void **state)
{
    (void)state;
    const double encoded_a = 0.3, encoded_b = 0.5, c1 = 1e-4;
    image_comparison c = compare_once(constant(32, 20, srgb_decode(0.3)), constant(32, 20, srgb_decode(0.5)));
    assert_near(c.mse, 0.04, 1e-7); /* floats of the linear light have 24 bits */
    assert_near(c.psnr_db, 10.0 * log10(25.0), 1e-5);
    assert_near(c.largest, 0.2, 1e-7);
    double expected = (2 * encoded_a * encoded_b + c1) / (encoded_a * encoded_a + encoded_b * encoded_b + c1);
    assert_near(c.ssim, expected, 1e-7);
    assert_true(c.differing_fraction == 1);
}

/* Two grey images of constant lightness: without chroma, HyAB is the difference of the lightnesses; the filters leave
 * constants unchanged and detect no features. Linear 1 and 0.18418651851 have L* 100 and 50. The distance to the power
 * 0.7 is below the knee of 0.4 times that of green and blue, (203.3016558)^0.7 by their CIELAB values (87.7362,
 * -75.6099, 72.9812) and (32.2982, 25.5781, -34.8364), Hunt-adjusted. */
static void flip_of_greys_is_their_lightness_difference(void **state)
{
    (void)state;
    double middle = (66.0 / 116.0) * (66.0 / 116.0) * (66.0 / 116.0);
    image_comparison c = compare_once(constant(30, 30, 1.0), constant(30, 30, middle));
    double distance = pow(50.0, 0.7), knee = 0.4 * pow(203.3016558, 0.7);
    assert_near(c.flip, 0.95 * distance / knee, 1e-6);
}

static void flip_of_green_and_blue_is_one(void **state)
{
    (void)state;
    image *green = constant(12, 12, 0), *blue = constant(12, 12, 0);
    for (int i = 0; i < 144; i++)
        green->pixel[3 * i + 1] = blue->pixel[3 * i + 2] = 1.0f;
    assert_near(compare_once(green, blue).flip, 1.0, 1e-12);
}

static void a_single_differing_pixel_is_located(void **state)
{
    (void)state;
    image *a = make(64, 48, grain, 0), *b = make(64, 48, grain, 0);
    float *pixel = b->pixel + 3 * (17 * 64 + 41);
    double before = srgb_encode(pixel[1]), after = srgb_encode(before > 0.5 ? 0.0 : 1.0);
    pixel[1] = (float)after;
    image_comparison c = compare_once(a, b);
    double difference = fabs(after - before);
    assert_int_equal(c.largest_x, 41);
    assert_int_equal(c.largest_y, 17);
    assert_near(c.largest, difference, 1e-12);
    assert_near(c.mse, difference * difference / (64 * 48 * 3), 1e-15);
    assert_near(c.differing_fraction, 1.0 / (64 * 48), 1e-15);
    assert_true(c.ssim < 1 && c.flip > 0);
}

/* A quarter of an 8-bit step. */
static void differences_below_an_8_bit_step_still_have_an_error(void **state)
{
    (void)state;
    image_comparison c =
        compare_once(constant(20, 20, srgb_decode(100.0 / 255)), constant(20, 20, srgb_decode(100.25 / 255)));
    assert_true(c.differing_fraction == 0);
    assert_near(c.largest, 0.25 / 255, 1e-7);
    assert_true(c.flip > 0);
}

static void values_beyond_the_displays_range_are_clamped(void **state)
{
    (void)state;
    image *a = constant(16, 16, 1.5), *b = constant(16, 16, (double)INFINITY);
    a->pixel[0] = -3.0f;
    b->pixel[0] = 0.0f;
    image_comparison c = compare_once(a, b);
    assert_true(c.mse == 0 && c.flip == 0 && c.largest == 0 && c.differing_fraction == 0);
    assert_near(c.ssim, 1.0, 1e-12);
}

static void different_sizes_are_refused(void **state)
{
    (void)state;
    image *a = constant(16, 12, 0.5), *b = constant(12, 16, 0.5), *map = a;
    image_comparison c;
    diagnostic why = {0};
    assert_int_equal(image_compare(a, b, &c, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "an image of 16 x 12 pixels cannot be compared with one of 12 x 16");
    assert_int_equal(image_compare_map(a, b, &map, NULL), STATUS_BAD_INPUT);
    assert_null(map);
    image_destroy(a);
    image_destroy(b);
}

static void a_nan_pixel_is_refused_and_located(void **state)
{
    (void)state;
    image *a = constant(16, 12, 0.5), *b = constant(16, 12, 0.5), *map = a;
    image_comparison c;
    diagnostic why = {0};
    b->pixel[3 * (7 * 16 + 5) + 2] = NAN;
    assert_int_equal(image_compare(a, b, &c, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "pixel 5,7 of the second image is not a number");
    assert_int_equal(image_compare(b, a, &c, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "pixel 5,7 of the first image is not a number");
    assert_int_equal(image_compare_map(a, b, &map, NULL), STATUS_BAD_INPUT);
    assert_null(map);
    image_destroy(a);
    image_destroy(b);
}

static void assert_color(const image *map, int x, int y, int red, int green, int blue)
{
    const float *pixel = map->pixel + 3 * (y * map->width + x);
    const int expected[3] = {red, green, blue};
    for (int channel = 0; channel < 3; channel++) {
        int difference = (int)codec_quantize(pixel[channel], 255) - expected[channel];
        if (abs(difference) > 1)
            fail_msg("channel %d at %d,%d is off by %d", channel, x, y, difference);
    }
}

/* Colours of matplotlib 3.6.3's magma at 255 times the error, interpolated linearly between the two nearest, to one
 * step; the error, in the comment of each line, is by the implementation of FLIP above. */
static void the_error_map_has_magma_colors(void **state)
{
    (void)state;
    image *a = make(97, 61, disc, 0), *b = make(97, 61, disc, 1), *map;
    assert_int_equal(image_compare_map(a, b, &map, NULL), STATUS_OK);
    assert_int_equal(map->width, 97);
    assert_int_equal(map->height, 61);
    assert_color(map, 0, 0, 0, 0, 4);         /* 0 */
    assert_color(map, 27, 30, 77, 17, 123);   /* 0.242821 */
    assert_color(map, 50, 47, 171, 51, 124);  /* 0.474206 */
    assert_color(map, 48, 13, 241, 96, 93);   /* 0.665982 */
    assert_color(map, 31, 30, 254, 192, 133); /* 0.869832 */
    assert_color(map, 34, 22, 252, 239, 177); /* 0.970260 */
    image_destroy(map);
    image_destroy(a);
    image_destroy(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_measure_equals_independent_programs),
        cmocka_unit_test(every_measure_is_symmetric),
        cmocka_unit_test(an_image_is_identical_to_itself),
        cmocka_unit_test(constants_have_closed_forms),
        cmocka_unit_test(flip_of_greys_is_their_lightness_difference),
        cmocka_unit_test(flip_of_green_and_blue_is_one),
        cmocka_unit_test(a_single_differing_pixel_is_located),
        cmocka_unit_test(differences_below_an_8_bit_step_still_have_an_error),
        cmocka_unit_test(values_beyond_the_displays_range_are_clamped),
        cmocka_unit_test(different_sizes_are_refused),
        cmocka_unit_test(a_nan_pixel_is_refused_and_located),
        cmocka_unit_test(the_error_map_has_magma_colors),
    };
    return cmocka_run_group_tests_name("comparison of images", tests, NULL, NULL);
}
