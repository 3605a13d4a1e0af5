#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "image/codec.h"
#include "random_stream.h"
#include "render_fixture.h"
#include <unistd.h>

/* Tests of BMP files, written here according to Microsoft's description of the format ("Bitmap Storage"), independently
 * of the reader: the pixels equal those of a PNG, and so does the film; a file that is damaged or not a 24-bit BMP is
 * refused with one line of error. */

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

typedef struct bmp_file {
    unsigned char *bytes;
    size_t size;
} bmp_file;

static void put_number(unsigned char *at, uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        at[i] = (unsigned char)(value >> 8 * i);
}

/* A value for each position and channel that differs between neighbours. */
static unsigned char value_at(int x, int y, int channel)
{
    return (unsigned char)(37 * x + 101 * y + 77 * channel + 5);
}

/* gap: bytes between headers and pixels, such as a palette or a profile, which a reader must skip. */
static bmp_file make_bmp(int width, int height, uint32_t header, uint32_t gap, bool from_top)
{
    const uint32_t row = ((uint32_t)width * 3 + 3) & ~3U, offset = 14 + header + gap,
                   size = offset + row * (uint32_t)height;
    bmp_file f = {calloc(size, 1), size};
    assert_non_null(f.bytes);
    memset(f.bytes + 14 + header, 0xEE, size - 14 - header); /* the padding may have any value */
    memcpy(f.bytes, "BM", 2);
    put_number(f.bytes + 2, size, 4);
    put_number(f.bytes + 10, offset, 4);
    put_number(f.bytes + 14, header, 4);
    put_number(f.bytes + 18, (uint32_t)width, 4);
    put_number(f.bytes + 22, from_top ? 0U - (uint32_t)height : (uint32_t)height, 4);
    put_number(f.bytes + 26, 1, 2);
    put_number(f.bytes + 28, 24, 2);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++) {
                const int line = from_top ? y : height - 1 - y;
                f.bytes[offset + row * (uint32_t)line + 3 * (uint32_t)x + 2 - (uint32_t)c] = value_at(x, y, c);
            }
    return f;
}

static void is_the_image(const bmp_file *f, int width, int height)
{
    image *img;
    diagnostic why = {0};
    worked(codec_bmp_read(f->bytes, f->size, &img, &why), &why);
    assert_int_equal(img->width, width);
    assert_int_equal(img->height, height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++)
                assert_true(img->pixel[(y * width + x) * 3 + c] == (float)srgb_decode(value_at(x, y, c) / 255.0));
    image_destroy(img);
}

static void every_width_header_and_order_is_read(void **state)
{
    (void)state;
    static const uint32_t headers[] = {40, 52, 56, 108, 124}, gaps[] = {0, 1, 1024};
    for (int width = 1; width <= 9; width++)
        for (size_t h = 0; h < COUNT(headers); h++)
            for (size_t g = 0; g < COUNT(gaps); g++)
                for (int from_top = 0; from_top < 2; from_top++) {
                    const bmp_file f = make_bmp(width, 5, headers[h], gaps[g], from_top);
                    is_the_image(&f, width, 5);
                    free(f.bytes);
                }
}

static void bytes_after_the_pixels_are_ignored(void **state)
{
    (void)state;
    bmp_file f = make_bmp(3, 2, 124, 0, false);
    unsigned char *longer = realloc(f.bytes, f.size + 77);
    assert_non_null(longer);
    memset(longer + f.size, 0xAB, 77);
    f = (bmp_file){longer, f.size + 77};
    put_number(f.bytes + 2, 0, 4); /* some writers omit the file's size */
    is_the_image(&f, 3, 2);
    f.size -= 77 + 3; /* the last row's padding may be missing */
    is_the_image(&f, 3, 2);
    free(f.bytes);
}

static void refused(const unsigned char *bytes, size_t size, const char *word, const char *remedy)
{
    image *img = (image *)1;
    diagnostic why = {0};
    char message[DIAGNOSTIC_TEXT_MAX];
    assert_int_equal(codec_bmp_read(bytes, size, &img, &why), STATUS_BAD_INPUT);
    assert_null(img);
    diagnostic_text(&why, message, sizeof message);
    if (!strstr(message, word) || !strstr(message, remedy) || strchr(message, '\n'))
        fail_msg("'%s' has no '%s' or '%s'", message, word, remedy);
}

static void unsupported_kinds_are_refused_with_a_remedy(void **state)
{
    (void)state;
    static const struct {
        int at, bytes;
        uint32_t value;
        const char *word;
    } kinds[] = {
        {28, 2, 1, "1 bits"},
        {28, 2, 8, "8 bits"},
        {28, 2, 16, "16 bits"},
        {28, 2, 32, "32 bits"},
        {30, 4, 1, "run-length"},
        {30, 4, 2, "run-length"},
        {30, 4, 3, "compression 3"},
        {30, 4, 4, "compression 4"},
        {14, 4, 12, "OS/2"},
        {14, 4, 64, "OS/2"},
        {14, 4, 16, "OS/2"},
        {14, 4, 39, "39 bytes"},
        {14, 4, 0xFFFFFFFFU, "4294967295 bytes"},
    };
    for (size_t k = 0; k < COUNT(kinds); k++) {
        bmp_file f = make_bmp(4, 3, 40, 100, false);
        put_number(f.bytes + kinds[k].at, kinds[k].value, kinds[k].bytes);
        refused(f.bytes, f.size, kinds[k].word, "save the file as an uncompressed 24-bit BMP, or as PNG");
        free(f.bytes);
    }
}

static void hostile_sizes_are_refused(void **state)
{
    (void)state;
    static const struct {
        int at;
        uint32_t value;
        const char *word;
    } sizes[] = {
        {18, 0, "0 x 3"},
        {18, 0xFFFFFFFFU, "-1 x 3"},
        {18, 0x7FFFFFFFU, "2147483647 x 3"},
        {22, 0, "4 x 0"},
        {22, 0x80000000U, "4 x 2147483648"},
        {22, 0x7FFFFFFFU, "4 x 2147483647"},
        {18, 65536, "truncated"},
        {22, 65536, "truncated"},
        {18, 65537, "65537 x 3"},
        {10, 0, "begin at byte 0"},
        {10, 53, "begin at byte 53"},
        {10, 0xFFFFFFFFU, "begin at byte 4294967295"},
        {10, 60, "truncated"},
    };
    for (size_t k = 0; k < COUNT(sizes); k++) {
        bmp_file f = make_bmp(4, 3, 40, 0, false);
        put_number(f.bytes + sizes[k].at, sizes[k].value, 4);
        refused(f.bytes, f.size, sizes[k].word, "");
        free(f.bytes);
    }
    bmp_file f = make_bmp(4, 3, 40, 0, false);
    put_number(f.bytes + 18, 65536, 4), put_number(f.bytes + 22, 4096, 4); /* 2^28 pixels without data */
    refused(f.bytes, f.size, "65536 x 4096", "");
    free(f.bytes);
}

static void truncated_files_are_refused(void **state)
{
    (void)state;
    const bmp_file f = make_bmp(5, 4, 124, 0, true);
    for (size_t size = 0; size < f.size - 1; size++) {
        unsigned char *cut =
            malloc(size ? size : 1); /* of exact size, so that the address sanitizer finds reads beyond its end */
        image *img;
        diagnostic why = {0};
        assert_non_null(cut);
        memcpy(cut, f.bytes, size);
        assert_int_equal(codec_bmp_read(cut, size, &img, &why), STATUS_BAD_INPUT);
        assert_non_null(strstr(why.what, "truncated"));
        free(cut);
    }
    free(f.bytes);
}

static void corrupted_files_are_read_or_refused(void **state)
{
    (void)state;
    uint64_t seed = 5;
    const bmp_file f = make_bmp(5, 4, 40, 0, false);
    unsigned char *copy = malloc(f.size);
    assert_non_null(copy);
    for (int k = 0; k < 20000; k++) {
        memcpy(copy, f.bytes, f.size);
        for (int change = 0; change < 1 + k % 6; change++)
            copy[2 + random_below(&seed, 52)] = (unsigned char)random_below(&seed, 256);
        image *img;
        diagnostic why = {0};
        const status code = codec_bmp_read(copy, f.size, &img, &why);
        assert_true(code == STATUS_OK ? img != NULL : code == STATUS_BAD_INPUT && !img && why.what[0]);
        if (code == STATUS_OK)
            image_destroy(img);
    }
    free(copy);
    free(f.bytes);
}

/* The film of a scene whose sky and texture are the given file. */
static uint64_t film_with(const char *path)
{
    char text[1024];
    snprintf(text, sizeof text,
             "render: {width: 32, height: 24}\nbackground: {image: %s}\ntextures: {t: {file: %s}, l: {file: %s, "
             "space: linear}}\n"
             "solids:\n  ball: {shape: sphere, ambient: 1, texture: t, reflectivity: 0.3, position: [-1, 1, 0]}\n"
             "  box: {shape: box, ambient: 1, texture: l, position: [1, 1, 0], rotation: [10, 20, 0]}\n",
             path, path, path);
    scene *s = scene_from(text);
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    render_result *r = render(s);
    const uint64_t hash = film_hash(r->img);
    render_result_destroy(r);
    scene_destroy(s);
    return hash;
}

static void same_pixels_give_the_same_film_as_png(void **state)
{
    (void)state;
    char bmp[] = "/tmp/test_bmp_XXXXXX.bmp", png[] = "/tmp/test_bmp_XXXXXX.png";
    const int handle = mkstemps(bmp, 4), other = mkstemps(png, 4);
    assert_true(handle >= 0 && other >= 0);
    close(other);
    const bmp_file f = make_bmp(13, 7, 108, 0, false);
    assert_int_equal(write(handle, f.bytes, f.size), (ssize_t)f.size);
    close(handle);
    image *img;
    diagnostic why = {0};
    int bits = 0;
    worked(image_read(bmp, &img, &bits, &why), &why);
    assert_true(bits == 8 && img->coded_bits == 8);
    worked(image_write(img, png, 8, &why), &why);
    image_destroy(img);
    assert_true(film_with(bmp) == film_with(png));
    unlink(bmp);
    unlink(png);
    free(f.bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_width_header_and_order_is_read),
        cmocka_unit_test(bytes_after_the_pixels_are_ignored),
        cmocka_unit_test(unsupported_kinds_are_refused_with_a_remedy),
        cmocka_unit_test(hostile_sizes_are_refused),
        cmocka_unit_test(truncated_files_are_refused),
        cmocka_unit_test(corrupted_files_are_read_or_refused),
        cmocka_unit_test(same_pixels_give_the_same_film_as_png),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
