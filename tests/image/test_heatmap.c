/* Tests of false-colour images: the colour map, the font, the colour bar under the image. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "image/codec.h"
#include "image/heatmap.h"
#include "image/image.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static bool pixel_is(const image *img, int x, int y, int red, int green, int blue)
{
    const float *pixel = img->pixel + ((size_t)y * (size_t)img->width + (size_t)x) * 3;
    return (int)codec_quantize(pixel[0], 255) == red && (int)codec_quantize(pixel[1], 255) == green &&
           (int)codec_quantize(pixel[2], 255) == blue;
}

/* The number of pixels with the colour of text in a rectangle. */
static int ink_in(const image *img, int left, int right, int top, int bottom)
{
    int count = 0;
    for (int y = top; y < bottom; y++)
        for (int x = left; x < right; x++)
            count += pixel_is(img, x, y, 34, 34, 34);
    return count;
}

static image *draw(const double *values, int width, int height, const char *title)
{
    image *img;
    assert_int_equal(heatmap_create(values, width, height, title, &img, NULL), STATUS_OK);
    assert_non_null(img);
    return img;
}

static double *make_values(int width, int height, double largest)
{
    double *values = malloc((size_t)width * (size_t)height * sizeof *values);
    assert_non_null(values);
    for (int i = 0; i < width * height; i++)
        values[i] = largest * i / (width * height - 1);
    return values;
}

/* ---- colours ---- */

static void viridis_has_its_published_colors(void **state)
{
    (void)state;
    static const struct {
        double t;
        unsigned char rgb[3];
    } cases[] = {
        /* matplotlib's table, rounded */
        {0.0, {68, 1, 84}},
        {23 / 255.0, {72, 33, 115}},
        {51 / 255.0, {65, 68, 135}},
        {102 / 255.0, {42, 120, 142}},
        {128 / 255.0, {33, 145, 140}},
        {153 / 255.0, {34, 168, 132}},
        {204 / 255.0, {122, 209, 81}},
        {252 / 255.0, {246, 230, 32}},
        {1.0, {253, 231, 37}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        unsigned char rgb[3];
        heatmap_color(cases[i].t, rgb);
        for (int channel = 0; channel < 3; channel++)
            assert_in_range(rgb[channel] + 1, cases[i].rgb[channel], cases[i].rgb[channel] + 2);
    }
}

static void colors_are_clamped(void **state)
{
    (void)state;
    static const double low[] = {-1.0, -INFINITY, (double)NAN, -0.0}, high[] = {1.0, 2.0, INFINITY};
    unsigned char rgb[3];
    for (size_t i = 0; i < 4; i++) {
        heatmap_color(low[i], rgb);
        assert_true(rgb[0] == 68 && rgb[1] == 1 && rgb[2] == 84);
    }
    for (size_t i = 0; i < 3; i++) {
        heatmap_color(high[i], rgb);
        assert_true(rgb[0] == 253 && rgb[1] == 231 && rgb[2] == 37);
    }
}

/* Luminance, Y of Rec. 709: larger values are always brighter, also in grey print. */
static void larger_values_are_brighter(void **state)
{
    (void)state;
    double before = -1.0;
    for (int i = 0; i <= 255; i++) {
        unsigned char rgb[3];
        heatmap_color(i / 255.0, rgb);
        double luminance = 0.2126 * srgb_decode(rgb[0] / 255.0) + 0.7152 * srgb_decode(rgb[1] / 255.0) +
                           0.0722 * srgb_decode(rgb[2] / 255.0);
        assert_true(luminance > before - 1e-3);
        before = luminance;
    }
}

/* ---- font ---- */

static void print_glyph(char character, char drawn[FONT_HEIGHT * (FONT_WIDTH + 1) + 1])
{
    for (int row = 0; row < FONT_HEIGHT; row++) {
        for (int column = 0; column < FONT_WIDTH; column++)
            *drawn++ = font_dot(character, column, row) ? '#' : '.';
        *drawn++ = '\n';
    }
    *drawn = 0;
}

static void glyphs_have_the_expected_pixels(void **state)
{
    (void)state;
    char drawn[FONT_HEIGHT * (FONT_WIDTH + 1) + 1];
    print_glyph('2', drawn);
    assert_string_equal(drawn, ".###.\n#...#\n....#\n...#.\n..#..\n.#...\n#####\n.....\n");
    print_glyph('p', drawn);
    assert_string_equal(drawn, ".....\n.....\n####.\n#...#\n#...#\n####.\n#....\n#....\n");
}

static void glyphs_differ(void **state)
{
    (void)state;
    static char drawn[95][FONT_HEIGHT * (FONT_WIDTH + 1) + 1];
    for (int i = 0; i < 95; i++) {
        print_glyph((char)(' ' + i), drawn[i]);
        for (int j = 0; j < i; j++)
            assert_string_not_equal(drawn[i], drawn[j]);
    }
    char other[FONT_HEIGHT * (FONT_WIDTH + 1) + 1];
    static const char unprintable[] = {'\n', '\x7f', (char)0xff, (char)0x80, 0};
    for (int i = 0; i < 5; i++) {
        print_glyph(unprintable[i], other);
        assert_string_equal(other, drawn['?' - ' ']);
    }
    assert_false(font_dot('#', -1, 0) || font_dot('#', 5, 0) || font_dot('#', 0, -1) || font_dot('#', 0, 8));
}

/* ---- images ---- */

static void values_are_mapped_to_colors(void **state)
{
    (void)state;
    double *values = make_values(300, 20, 118.0);
    image *img = draw(values, 300, 20, "rays per pixel");
    assert_int_equal(img->width, 300);
    assert_true(img->height > 20 + 30);
    assert_true(pixel_is(img, 0, 0, 68, 1, 84));
    assert_true(pixel_is(img, 299, 19, 253, 231, 37));
    for (int i = 0; i < 300 * 20; i += 7) {
        unsigned char rgb[3];
        heatmap_color(values[i] / 118.0, rgb);
        assert_true(pixel_is(img, i % 300, i / 300, rgb[0], rgb[1], rgb[2]));
    }
    image_destroy(img);
    free(values);
}

static void narrow_images_are_centred(void **state)
{
    (void)state;
    double *values = make_values(40, 10, 1.0);
    image *img = draw(values, 40, 10, "x");
    assert_int_equal(img->width, 240);
    assert_true(pixel_is(img, 99, 0, 255, 255, 255));
    assert_true(pixel_is(img, 100, 0, 68, 1, 84));
    assert_true(pixel_is(img, 139, 9, 253, 231, 37));
    assert_true(pixel_is(img, 140, 9, 255, 255, 255));
    image_destroy(img);
    free(values);
}

/* Finds text in the colour bar by drawing it with the font at one pixel a dot. */
static bool shows(const image *img, int top, const char *text)
{
    int width = (int)strlen(text) * FONT_ADVANCE - 1;
    for (int y = top; y + FONT_HEIGHT <= img->height; y++) {
        for (int x = 0; x + width <= img->width; x++) {
            bool same = true;
            for (int i = 0; i < width * FONT_HEIGHT && same; i++) {
                int column = i % width, row = i / width;
                bool dot = font_dot(text[column / FONT_ADVANCE], column % FONT_ADVANCE, row);
                same = dot == pixel_is(img, x + column, y + row, 34, 34, 34);
            }
            if (same)
                return true;
        }
    }
    return false;
}

static void check_color_bar(double largest, const char *const numbers[5])
{
    double *values = make_values(300, 3, largest);
    image *img = draw(values, 300, 3, "cost, in rays");
    assert_true(shows(img, 3, "cost, in rays"));
    for (int i = 0; i < 5; i++)
        if (!shows(img, 3, numbers[i]))
            fail_msg("the key up to %g does not show %s", largest, numbers[i]);
    assert_false(shows(img, 3, "cost, in rayz"));
    image_destroy(img);
    free(values);
}

static void the_color_bar_is_labelled_at_quarters_of_the_range(void **state)
{
    (void)state;
    check_color_bar(118.0, (const char *const[]){"0", "29.5", "59", "88.5", "118"});
    check_color_bar(1.0, (const char *const[]){"0", "0.25", "0.5", "0.75", "1"});
    check_color_bar(1234.0, (const char *const[]){"0", "308.5", "617", "925.5", "1234"});
    check_color_bar(12345678.0, (const char *const[]){"0", "3.086M", "6.173M", "9.259M", "12.35M"});
    check_color_bar(50000.0, (const char *const[]){"0", "12.5k", "25k", "37.5k", "50k"});
    check_color_bar(0.004, (const char *const[]){"0", "1m", "2m", "3m", "4m"});
    check_color_bar(9999.99, (const char *const[]){"0", "2500", "5000", "7500", "10000"});
    check_color_bar(2e-6, (const char *const[]){"0", "0.5u", "1u", "1.5u", "2u"});
}

static void integer_values_have_integer_labels(void **state)
{
    (void)state;
    static const struct {
        double largest;
        const char *shown, *hidden;
    } cases[] = {
        {118, "30", "29.5"}, {118, "118", "88.5"}, {3, "2", "1.5"}, {1, "1", "0.5"}, {50000, "12.5k", "12500"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double values[300];
        for (int x = 0; x < 300; x++)
            values[x] = x % 2 * cases[i].largest;
        image *img = draw(values, 300, 1, "");
        assert_true(shows(img, 1, "0") && shows(img, 1, cases[i].shown));
        assert_false(shows(img, 1, cases[i].hidden));
        image_destroy(img);
    }
}

static void the_scale_ignores_a_few_outliers(void **state)
{
    (void)state;
    double values[1200];
    for (int i = 0; i < 1200; i++)
        values[i] = i * 7 % 1200 / 2.0 + 0.25;
    values[0] = 1e9;
    image *img = draw(values, 300, 4, "t"); /* 6 of 1200 values are above the percentile: the outlier, and 5 more */
    assert_true(shows(img, 4, ">=597.3"));
    assert_true(pixel_is(img, 0, 0, 253, 231, 37));
    unsigned char rgb[3];
    heatmap_color(values[1] / 597.25, rgb);
    assert_true(pixel_is(img, 1, 0, rgb[0], rgb[1], rgb[2]));
    image_destroy(img);
    values[0] = 1190; /* not twice as much */
    img = draw(values, 300, 4, "t");
    assert_true(shows(img, 4, "1190") && !shows(img, 4, ">=1190"));
    image_destroy(img);
    for (int i = 0; i < 1200; i++)
        values[i] = i == 7 ? 5 : -0.0; /* the percentile is 0 */
    img = draw(values, 300, 4, "t");
    assert_true(shows(img, 4, "5") && pixel_is(img, 7, 0, 253, 231, 37) && pixel_is(img, 8, 0, 68, 1, 84));
    image_destroy(img);
}

static void a_long_title_is_truncated(void **state)
{
    (void)state;
    double *values = make_values(240, 3, 1.0);
    image *img = draw(values, 240, 3, "a title that is much longer than the image is wide");
    assert_true(shows(img, 3, "a title that is much longer than t..."));
    image_destroy(img);
    char huge[2000];
    memset(huge, 'W', sizeof huge);
    huge[sizeof huge - 1] = 0;
    img = draw(values, 240, 3, huge);
    image_destroy(img);
    img = draw(values, 240, 3, "");
    image_destroy(img);
    free(values);
}

static void an_image_of_zeros_is_valid(void **state)
{
    (void)state;
    static const double zeros[240 * 2] = {0};
    image *img = draw(zeros, 240, 2, "none");
    assert_true(pixel_is(img, 0, 0, 68, 1, 84) && pixel_is(img, 239, 1, 68, 1, 84));
    assert_true(shows(img, 2, "0") && shows(img, 2, "none"));
    image_destroy(img);
}

static void text_is_scaled_with_the_image(void **state)
{
    (void)state;
    double *values = make_values(1600, 2, 1.0);
    for (int i = 0; i < 1600 * 2; i++) /* both images have the same numbers at their scales */
        values[i] = i % 5 / 4.0;
    image *small = draw(values, 400, 2, "title"), *large = draw(values, 1600, 2, "title");
    assert_int_equal((large->height - 2), 4 * (small->height - 2));
    assert_int_equal(ink_in(large, 0, 1600, 2, large->height), 16 * ink_in(small, 0, 400, 2, small->height));
    image_destroy(small);
    image_destroy(large);
    free(values);
}

static void invalid_values_and_sizes_are_refused(void **state)
{
    (void)state;
    static const double bad[] = {(double)NAN, INFINITY, -1.0, -INFINITY};
    image *img;
    diagnostic why = {0};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const double values[4] = {0.0, 1.0, bad[i], 2.0};
        assert_int_equal(heatmap_create(values, 2, 2, "x", &img, &why), STATUS_BAD_INPUT);
        assert_null(img);
        assert_non_null(strstr(why.what, "value 2"));
    }
    const double value = 1.0;
    assert_int_equal(heatmap_create(&value, 0, 1, "x", &img, &why), STATUS_BAD_INPUT);
    assert_int_equal(heatmap_create(&value, 1, -1, "x", &img, &why), STATUS_BAD_INPUT);
    assert_int_equal(heatmap_create(&value, 65537, 1, "x", &img, &why), STATUS_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(viridis_has_its_published_colors),
        cmocka_unit_test(colors_are_clamped),
        cmocka_unit_test(larger_values_are_brighter),
        cmocka_unit_test(glyphs_have_the_expected_pixels),
        cmocka_unit_test(glyphs_differ),
        cmocka_unit_test(values_are_mapped_to_colors),
        cmocka_unit_test(narrow_images_are_centred),
        cmocka_unit_test(the_color_bar_is_labelled_at_quarters_of_the_range),
        cmocka_unit_test(integer_values_have_integer_labels),
        cmocka_unit_test(the_scale_ignores_a_few_outliers),
        cmocka_unit_test(a_long_title_is_truncated),
        cmocka_unit_test(an_image_of_zeros_is_valid),
        cmocka_unit_test(text_is_scaled_with_the_image),
        cmocka_unit_test(invalid_values_and_sizes_are_refused),
    };
    return cmocka_run_group_tests_name("heatmap", tests, NULL, NULL);
}
