/* Tests of the format of moving images, YUV4MPEG2. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "image/video.h"
#include <stdlib.h>
#include <string.h>

/* YUV4MPEG2: the header's text, the frame's bytes, and colours against Y'CbCr values computed by hand from the
 * coefficients of BT.601 and BT.709. */

typedef struct stream_bytes {
    char *text;
    size_t size;
} stream_bytes;

/* One frame of that image. */
static stream_bytes frame_of(const image *img)
{
    stream_bytes out = {0};
    FILE *stream = open_memstream(&out.text, &out.size);
    assert_non_null(stream);
    assert_int_equal(y4m_frame(stream, img, NULL), STATUS_OK);
    fclose(stream);
    return out;
}

static image *image_of(int width, int height)
{
    image *img;
    assert_int_equal(image_create(width, height, &img, NULL), STATUS_OK);
    return img;
}

static void put(image *img, int x, int y, double r, double g, double b)
{
    float *pixel = img->pixel + 3 * ((size_t)y * (size_t)img->width + (size_t)x);
    pixel[0] = (float)r;
    pixel[1] = (float)g;
    pixel[2] = (float)b;
}

static void fill(image *img, double r, double g, double b)
{
    for (int y = 0; y < img->height; y++)
        for (int x = 0; x < img->width; x++)
            put(img, x, y, r, g, b);
}

/* Every byte of an image of one colour. */
static void check_colour(int width, int height, double r, double g, double b, int luma, int blue, int red)
{
    image *img = image_of(width, height);
    fill(img, r, g, b);
    stream_bytes frame = frame_of(img);
    const size_t pixels = (size_t)width * (size_t)height,
                 chroma = (size_t)((width + 1) / 2) * (size_t)((height + 1) / 2);
    assert_int_equal(frame.size, 6 + pixels + 2 * chroma);
    assert_memory_equal(frame.text, "FRAME\n", 6);
    const unsigned char *bytes = (const unsigned char *)frame.text + 6;
    for (size_t i = 0; i < pixels; i++)
        assert_int_equal(bytes[i], luma);
    for (size_t i = 0; i < chroma; i++) {
        assert_int_equal(bytes[pixels + i], blue);
        assert_int_equal(bytes[pixels + chroma + i], red);
    }
    free(frame.text);
    image_destroy(img);
}

/* Y = 16 + 219 K, Cb = 128 + 224 (B - Y) / (2 (1 - K_B)), Cr = 128 + 224 (R - Y) / (2 (1 - K_R)) with B, R, Y from 0
 * to 1. BT.601: K = 0.299, 0.587, 0.114. Red: Y 81.48, Cb 128 - 224 0.299 / 1.772 = 90.20, Cr 240. Green: Y 144.55, Cb
 * 128 - 224 0.587 / 1.772 = 53.80, Cr 128 - 224 0.587 / 1.402 = 34.21. Blue: Y 40.97, Cb 240, Cr 128 - 224 0.114
 * / 1.402 = 109.79. */
static void colours_of_low_images_are_bt601(void **state)
{
    (void)state;
    check_colour(4, 2, 1, 1, 1, 235, 128, 128);
    check_colour(4, 2, 0, 0, 0, 16, 128, 128);
    check_colour(4, 2, 1, 0, 0, 81, 90, 240);
    check_colour(4, 2, 0, 1, 0, 145, 54, 34);
    check_colour(4, 2, 0, 0, 1, 41, 240, 110);
    check_colour(2, 718, 1, 0, 0, 81, 90, 240);
}

/* BT.709: K = 0.2126, 0.7152, 0.0722. Red: Y 62.56, Cb 128 - 224 0.2126 / 1.8556 = 102.34. Green: Y 172.63, Cb 128 -
 * 224 0.7152 / 1.8556 = 41.66, Cr 128 - 224 0.7152 / 1.5748 = 26.27. Blue: Y 31.81, Cr 128 - 224 0.0722 / 1.5748 =
 * 117.73. */
static void colours_of_high_images_are_bt709(void **state)
{
    (void)state;
    check_colour(2, 720, 1, 1, 1, 235, 128, 128);
    check_colour(2, 720, 0, 0, 0, 16, 128, 128);
    check_colour(2, 720, 1, 0, 0, 63, 102, 240);
    check_colour(2, 720, 0, 1, 0, 173, 42, 26);
    check_colour(2, 720, 0, 0, 1, 32, 240, 118);
}

/* Linear values are sRGB-encoded first: 0.2140411 is the byte 127.5 of 255, so 0.214 is 127; its grey is Y = 16 + 219
 * 127 / 255 = 125.07. Values out of range are clamped, NaN is black. */
static void pixels_are_srgb_encoded_before_conversion(void **state)
{
    (void)state;
    check_colour(2, 2, 0.214, 0.214, 0.214, 125, 128, 128);
    check_colour(2, 2, 7, 7, 7, 235, 128, 128);
    check_colour(2, 2, -1, -1, -1, 16, 128, 128);
    const double no_number = strtod("nan", NULL);
    check_colour(2, 2, no_number, no_number, no_number, 16, 128, 128);
}

/* 3 x 3: chroma 2 x 2, whose cells have 4, 2, 2 and 1 pixels. Red at 0,0; 2,0; 0,2 and 2,2 among black, so a quarter,
 * half, half and all of the red's -37.797 and +112: Cb 118.55, 109.10, 109.10, 90.20; Cr 156, 184, 184, 240. */
static void chroma_at_the_border_is_the_mean_of_existing_pixels(void **state)
{
    (void)state;
    image *img = image_of(3, 3);
    for (int y = 0; y < 3; y += 2)
        for (int x = 0; x < 3; x += 2)
            put(img, x, y, 1, 0, 0);
    stream_bytes frame = frame_of(img);
    static const unsigned char expected[] = {81, 16, 81, 16, 16, 16, 81, 16, 81, 119, 109, 109, 90, 156, 184, 184, 240};
    assert_int_equal(frame.size, 6 + sizeof expected);
    assert_memory_equal(frame.text + 6, expected, sizeof expected);
    free(frame.text);
    image_destroy(img);
}

static void odd_sizes_are_rounded_up(void **state)
{
    (void)state;
    check_colour(1, 1, 0, 0, 1, 41, 240, 110);
    check_colour(5, 1, 0, 1, 0, 145, 54, 34);
    check_colour(1, 7, 1, 0, 0, 81, 90, 240);
    check_colour(7, 721, 1, 0, 0, 63, 102, 240);
}

static void the_header_has_the_text_of_the_format(void **state)
{
    (void)state;
    stream_bytes out = {0};
    FILE *stream = open_memstream(&out.text, &out.size);
    assert_non_null(stream);
    assert_int_equal(y4m_begin(stream, 641, 48, 30000, 1001, NULL), STATUS_OK);
    fclose(stream);
    assert_string_equal(out.text, "YUV4MPEG2 W641 H48 F30000:1001 Ip A1:1 C420jpeg XCOLORRANGE=LIMITED\n");
    free(out.text);
}

static void invalid_sizes_and_frame_rates_are_refused(void **state)
{
    (void)state;
    diagnostic why = {0};
    assert_int_equal(y4m_begin(stdout, 0, 48, 25, 1, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "0 x 48"));
    assert_int_equal(y4m_begin(stdout, 64, 48, 25, 0, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "25/0"));
    assert_int_equal(y4m_begin(stdout, 64, 48, -25, 1, NULL), STATUS_BAD_INPUT);
}

static void only_names_of_the_format_are_known(void **state)
{
    (void)state;
    assert_true(y4m_is_named("film.y4m") && y4m_is_named("a.b/FILM.Y4M"));
    assert_true(!y4m_is_named("film.apng") && !y4m_is_named("y4m") && !y4m_is_named("film.y4m.png"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colours_of_low_images_are_bt601),
        cmocka_unit_test(colours_of_high_images_are_bt709),
        cmocka_unit_test(pixels_are_srgb_encoded_before_conversion),
        cmocka_unit_test(chroma_at_the_border_is_the_mean_of_existing_pixels),
        cmocka_unit_test(odd_sizes_are_rounded_up),
        cmocka_unit_test(the_header_has_the_text_of_the_format),
        cmocka_unit_test(invalid_sizes_and_frame_rates_are_refused),
        cmocka_unit_test(only_names_of_the_format_are_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
