/* Tests of the PNG encoder: what libpng decodes, the structure of the file, the same bytes for any number of threads,
 * its size, and the rounding of the 16-bit curve. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "image/codec.h"
#include "image/image.h"
#include "render_fixture.h"
#include "whole.h"
#include <math.h>
#include <png.h>
#include <sched.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

typedef enum content { BLACK, SMOOTH, NOISE, CONTENTS } content;

static uint32_t next_random(uint32_t *state)
{
    *state ^= *state << 13; /* xorshift32, Marsaglia 2003 */
    *state ^= *state >> 17;
    return *state ^= *state << 5;
}

static image *make_image(int width, int height, content what)
{
    image *img;
    uint32_t random = 2463534242u;
    assert_int_equal(image_create(width, height, &img, NULL), STATUS_OK);
    for (int i = 0; what != BLACK && i < width * height * 3; i++) {
        const double x = i / 3 % width, y = i / 3 / width;
        img->pixel[i] = (float)(what == NOISE ? next_random(&random) / 4294967295.0
                                              : 0.5 + 0.4 * sin(0.02 * x + i % 3) * cos(0.015 * y));
    }
    return img;
}

typedef struct blob {
    unsigned char *bytes;
    size_t size;
} blob;

static blob encode(const image *img, int bits, bool fast)
{
    blob b;
    assert_int_equal(image_encode(img, IMAGE_PNG, bits, fast, &b.bytes, &b.size, NULL), STATUS_OK);
    return b;
}

static uint32_t big_endian(const unsigned char *b)
{
    return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

typedef struct cursor {
    blob file;
    size_t at;
} cursor;

static void take(png_structp png, png_bytep to, size_t count)
{
    cursor *c = png_get_io_ptr(png);
    assert_true(count <= c->file.size - c->at);
    memcpy(to, c->file.bytes + c->at, count);
    c->at += count;
}

static _Noreturn void on_error(png_structp png, png_const_charp message)
{
    (void)png;
    fail_msg("libpng: %s", message);
    abort();
}

/* Warnings too are failures. */
static void on_warning(png_structp png, png_const_charp message)
{
    on_error(png, message);
}

/* libpng decodes every sample to the correctly rounded value of the curve. */
static void check_samples(const image *img, int bits, blob file)
{
    cursor c = {file, 0};
    const size_t count = (size_t)img->width * 3;
    const unsigned maximum = (1u << bits) - 1;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, on_error, on_warning);
    png_infop info = png_create_info_struct(png);
    unsigned char *row = malloc(count * 2);
    png_set_read_fn(png, &c, take);
    png_read_info(png, info);
    assert_int_equal(png_get_image_width(png, info), img->width);
    assert_int_equal(png_get_image_height(png, info), img->height);
    assert_int_equal(png_get_bit_depth(png, info), bits);
    assert_int_equal(png_get_color_type(png, info), PNG_COLOR_TYPE_RGB);
    for (int y = 0; y < img->height; y++) {
        png_read_row(png, row, NULL);
        for (size_t i = 0; i < count; i++) {
            const unsigned got = bits == 8 ? row[i] : (unsigned)row[2 * i] << 8 | row[2 * i + 1];
            if (got != codec_quantize(img->pixel[(size_t)y * count + i], maximum))
                fail_msg("%d x %d, %d bits: row %d, value %zu", img->width, img->height, bits, y, i);
        }
    }
    png_read_end(png, NULL);
    assert_int_equal(c.at, file.size);
    png_destroy_read_struct(&png, &info, NULL);
    free(row);
}

static void libpng_decodes_every_sample(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {1, 7}, {7, 1}, {2, 3}, {61, 47}, {3, 20000}, {20000, 3}, {640, 431}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (content what = 0; what < CONTENTS; what++)
            for (int mode = 0; mode < 4; mode++) {
                const int bits = mode % 2 ? 16 : 8;
                image *img = make_image(sizes[i][0], sizes[i][1], what);
                const blob file = encode(img, bits, mode >= 2);
                check_samples(img, bits, file);
                free(file.bytes);
                image_destroy(img);
            }
}

/* More bands than are compressed at a time: 8 rows of 65536 pixels are one band each, 100 rows more than a wave. */
static void long_images_are_whole(void **state)
{
    (void)state;
    image *img = make_image(65536, 100, SMOOTH);
    const blob file = encode(img, 8, true);
    check_samples(img, 8, file);
    free(file.bytes);
    image_destroy(img);
}

/* The chunks are IHDR, sRGB, one IDAT a band, IEND; together the IDATs are one zlib stream, without anything after it.
 * */
static void the_bands_are_one_zlib_stream(void **state)
{
    (void)state;
    image *img = make_image(800, 300, SMOOTH);
    const blob file = encode(img, 8, false);
    char names[256] = "";
    z_stream z = {0};
    unsigned char raw[4096];
    size_t total = 0;
    int result = Z_OK;
    assert_int_equal(inflateInit(&z), Z_OK);
    for (size_t at = 8; at + 12 <= file.size;) {
        const unsigned char *b = file.bytes + at;
        const size_t size = big_endian(b);
        strncat(names, (const char *)b + 4, 4);
        assert_int_equal(big_endian(b + 8 + size), crc32(0, b + 4, (uInt)size + 4));
        if (memcmp(b + 4, "IDAT", 4) == 0) {
            assert_int_equal(result, Z_OK);
            z.next_in = (unsigned char *)(uintptr_t)b + 8;
            z.avail_in = (uInt)size;
            do {
                z.next_out = raw;
                z.avail_out = sizeof raw;
                result = inflate(&z, Z_NO_FLUSH);
                total += sizeof raw - z.avail_out;
            } while (result == Z_OK && z.avail_out == 0);
            assert_int_equal(z.avail_in, 0);
            result = result == Z_BUF_ERROR ? Z_OK : result; /* all input was read */
        }
        at += 12 + size;
    }
    assert_int_equal(result, Z_STREAM_END); /* zlib has compared the checksum */
    assert_int_equal(total, 300 * (1 + 800 * 3));
    /* 131072 / 2400 rounds up to 55 rows: 6 bands */
    assert_string_equal(names, "IHDRsRGBIDATIDATIDATIDATIDATIDATIEND");
    inflateEnd(&z);
    free(file.bytes);
    image_destroy(img);
}

/* On a machine with one processing unit both files are made by one thread. */
static void any_number_of_threads_gives_the_same_bytes(void **state)
{
    (void)state;
    cpu_set_t all, one;
    assert_int_equal(sched_getaffinity(0, sizeof all, &all), 0);
    CPU_ZERO(&one);
    for (size_t i = 0; CPU_COUNT(&one) == 0; i++)
        if (CPU_ISSET(i, &all))
            CPU_SET(i, &one);
    for (int mode = 0; mode < 4; mode++) {
        image *img = make_image(800, 600, mode == 3 ? NOISE : SMOOTH);
        const int bits = mode % 2 ? 16 : 8;
        const blob many = encode(img, bits, mode == 2), again = encode(img, bits, mode == 2);
        assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
        const blob single = encode(img, bits, mode == 2);
        assert_int_equal(sched_setaffinity(0, sizeof all, &all), 0);
        assert_int_equal(many.size, single.size);
        assert_memory_equal(many.bytes, single.bytes, single.size);
        assert_int_equal(many.size, again.size);
        assert_memory_equal(many.bytes, again.bytes, again.size);
        free(many.bytes);
        free(again.bytes);
        free(single.bytes);
        image_destroy(img);
    }
}

static void put(png_structp png, png_bytep bytes, size_t count)
{
    (void)bytes;
    *(size_t *)png_get_io_ptr(png) += count;
}

static void flush(png_structp png)
{
    (void)png;
}

/* The size of the file that libpng writes with its own filters at level 6. */
static size_t size_by_libpng(const image *img, int bits)
{
    size_t size = 0;
    const size_t count = (size_t)img->width * 3;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, on_error, on_warning);
    png_infop info = png_create_info_struct(png);
    unsigned char *row = malloc(count * 2);
    png_set_write_fn(png, &size, put, flush);
    png_set_IHDR(png, info, (png_uint_32)img->width, (png_uint_32)img->height, bits, PNG_COLOR_TYPE_RGB, 0, 0, 0);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_compression_level(png, 6);
    png_write_info(png, info);
    for (int y = 0; y < img->height; y++) {
        for (size_t i = 0; i < count; i++) {
            const unsigned value = codec_quantize(img->pixel[(size_t)y * count + i], bits == 8 ? 255 : 65535);
            if (bits == 8)
                row[i] = (unsigned char)value;
            else
                row[2 * i] = (unsigned char)(value >> 8), row[2 * i + 1] = (unsigned char)value;
        }
        png_write_row(png, row);
    }
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    free(row);
    return size;
}

/* A shipped scene at half its width and height. */
static image *render_shipped(const char *name)
{
    char path[128];
    scene *s = NULL;
    diagnostic why = {0};
    image *img = NULL;
    snprintf(path, sizeof path, "experiments/scenes/%s.yaml", name);
    worked(scene_read(path, &s, &why), &why);
    s->render.width /= 2;
    s->render.height /= 2;
    render_result *result = render(s);
    worked(film_image(result->img, &img, &why), &why);
    render_result_destroy(result);
    scene_destroy(s);
    return img;
}

static void files_are_hardly_larger_than_those_of_libpng(void **state)
{
    (void)state;
    static const char *const scenes[] = {"rod", "shapes", "prism"};
    for (size_t i = 0; i < (is_whole() ? sizeof scenes / sizeof *scenes : 1); i++) {
        image *img = render_shipped(scenes[i]);
        for (int bits = 8; bits <= 16; bits += 8) {
            const blob file = encode(img, bits, false);
            const size_t other = size_by_libpng(img, bits);
            if ((double)file.size > 1.10 * (double)other)
                fail_msg("%s, %d bits: %zu bytes, libpng %zu", scenes[i], bits, file.size, other);
            free(file.bytes);
        }
        image_destroy(img);
    }
}

static unsigned encode_word(const codec_words *table, float linear)
{
    unsigned char bytes[2];
    codec_words_encode(table, &linear, 1, bytes);
    return (unsigned)bytes[0] << 8 | bytes[1];
}

static void the_word_table_rounds_like_the_curve(void **state)
{
    (void)state;
    codec_words *table = codec_words_create();
    assert_non_null(table);
    static const float special[] = {0.0f,   -0.0f,    1.0f,      2.0f,       -1.0f,       NAN,
                                    1e-45f, INFINITY, -INFINITY, 0.0031308f, 0.00313081f, 0.0031307f};
    for (size_t i = 0; i < sizeof special / sizeof *special; i++)
        assert_int_equal(encode_word(table, special[i]), codec_quantize(special[i], 65535));
    for (unsigned word = 1; word < 65536; word++) { /* floats around the boundary to the next lower word */
        float value = (float)srgb_decode((word - 0.5) / 65535.0);
        for (int i = 0; i < 3; i++)
            value = nextafterf(value, 0.0f);
        for (int i = 0; i < 6; i++, value = nextafterf(value, 2.0f))
            assert_int_equal(encode_word(table, value), codec_quantize(value, 65535));
    }
    uint32_t random = 99;
    for (int i = 0; i < 300000; i++) {
        const float value = (float)(next_random(&random) / 4294967296.0 * 1.1 - 0.05);
        assert_int_equal(encode_word(table, value), codec_quantize(value, 65535));
    }
    free(table);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(libpng_decodes_every_sample),
        cmocka_unit_test(long_images_are_whole),
        cmocka_unit_test(the_bands_are_one_zlib_stream),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bytes),
        cmocka_unit_test(files_are_hardly_larger_than_those_of_libpng),
        cmocka_unit_test(the_word_table_rounds_like_the_curve),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
