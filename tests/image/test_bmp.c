#include <math.h>
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

/* Tests of BMP files, written here according to Microsoft's description of the format ("Bitmap Storage"),
 * independently of the reader: the pixels equal those of a PNG, and so does the film; a file that is damaged or of
 * an unsupported kind is refused with one line of error. */

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

static status read_bmp(const unsigned char *bytes, size_t size, image_values values, image **out, diagnostic *why)
{
    int bits = 0;
    const status code = codec_bmp_read(bytes, size, values, out, &bits, why);
    assert_true(code != STATUS_OK || bits == 8 || bits == 16);
    return code;
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
    worked(read_bmp(f->bytes, f->size, IMAGE_LIGHT, &img, &why), &why);
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
    assert_int_equal(read_bmp(bytes, size, IMAGE_LIGHT, &img, &why), STATUS_BAD_INPUT);
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
        {28, 2, 3, "3 bits"},
        {28, 2, 64, "64 bits"},
        {28, 2, 0, "0 bits"},
        {30, 4, 1, "24 bits per pixel, which is not supported with compression 1"},
        {30, 4, 2, "compression 2"},
        {30, 4, 3, "compression 3"},
        {30, 4, 7, "unsupported compression 7"},
        {14, 4, 39, "39 bytes"},
        {14, 4, 0xFFFFFFFFU, "4294967295 bytes"},
    };
    for (size_t k = 0; k < COUNT(kinds); k++) {
        bmp_file f = make_bmp(4, 3, 40, 100, false);
        put_number(f.bytes + kinds[k].at, kinds[k].value, kinds[k].bytes);
        refused(f.bytes, f.size, kinds[k].word, "save the file as a BMP of 24 bits, or as PNG");
        free(f.bytes);
    }
    bmp_file f = make_bmp(4, 3, 64, 100, false); /* of OS/2 */
    put_number(f.bytes + 30, 3, 4);
    refused(f.bytes, f.size, "Huffman", "as PNG");
    free(f.bytes);
}

/* ---- palettes, bit fields, run lengths ---- */

/* Headers of a kind, `before` bytes of masks or palette behind them, and `size` zero bytes of pixels. */
static bmp_file make_kind(int width, int height, uint32_t header, uint32_t bits, uint32_t compression, size_t before,
                          size_t size)
{
    const size_t offset = 14 + header + before;
    bmp_file f = {calloc(offset + size, 1), offset + size};
    assert_non_null(f.bytes);
    memcpy(f.bytes, "BM", 2);
    put_number(f.bytes + 10, (uint32_t)offset, 4);
    put_number(f.bytes + 14, header, 4);
    put_number(f.bytes + 18, (uint32_t)width, header == 12 ? 2 : 4);
    put_number(f.bytes + (header == 12 ? 20 : 22), (uint32_t)height, header == 12 ? 2 : 4);
    put_number(f.bytes + (header == 12 ? 24 : 28), bits, 2);
    if (header > 16)
        put_number(f.bytes + 30, compression, 4);
    return f;
}

static void put_palette(unsigned char *at, size_t count, size_t entry)
{
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            at[entry * i + 2 - (size_t)c] = value_at((int)i, 3, c);
}

static void is_color(const image *img, int x, int y, int color)
{
    for (int c = 0; c < 3; c++)
        assert_true(img->pixel[(y * img->width + x) * 3 + c] ==
                    (float)(color < 0 ? 0.0 : srgb_decode(value_at(color, 3, c) / 255.0)));
}

static void check_palette(int width, uint32_t header, uint32_t bits)
{
    const size_t entry = header == 12 ? 3 : 4, colors = (size_t)1 << bits, row = ((size_t)width * bits + 31) / 32 * 4;
    const int height = 3;
    bmp_file f = make_kind(width, height, header, bits, 0, entry * colors, row * 3);
    unsigned char *pixels = f.bytes + f.size - row * 3;
    image *img;
    diagnostic why = {0};
    put_palette(f.bytes + 14 + header, colors, entry);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) { /* the first pixel in the highest bits */
            const size_t bit = (size_t)x * bits;
            const unsigned index = value_at(x, y, 0) % (unsigned)colors;
            pixels[row * (size_t)(height - 1 - y) + bit / 8] |= (unsigned char)(index << (8 - bits - bit % 8));
        }
    worked(read_bmp(f.bytes, f.size, IMAGE_LIGHT, &img, &why), &why);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            is_color(img, x, y, value_at(x, y, 0) % (int)colors);
    image_destroy(img);
    free(f.bytes);
}

static void palettes_are_read(void **state)
{
    (void)state;
    static const uint32_t headers[] = {12, 16, 40, 64, 108}, bits[] = {1, 2, 4, 8};
    for (size_t h = 0; h < COUNT(headers); h++)
        for (size_t b = 0; b < COUNT(bits); b++)
            for (int width = 1; width <= 17; width += 2)
                check_palette(width, headers[h], bits[b]);
}

static void a_color_beyond_the_palette_is_damage(void **state)
{
    (void)state;
    bmp_file f = make_kind(4, 1, 40, 8, 0, 8, 4);
    f.bytes[f.size - 2] = 2;
    refused(f.bytes, f.size, "a pixel has color 2 of a palette of 2", "copy the file");
    put_number(f.bytes + 10, 54, 4);
    refused(f.bytes, f.size, "no palette", "copy the file");
    free(f.bytes);
}

static double field_of(uint32_t word, uint32_t mask)
{
    int low = 0;
    while (mask && !(mask >> low & 1))
        low++;
    return mask ? (double)((word & mask) >> low) / (double)(mask >> low) : 0.0;
}

/* headers and compression of each set of masks; alpha only where the header or the compression has its mask */
static void bit_fields_of_any_width_are_read(void **state)
{
    (void)state;
    static const struct {
        uint32_t header, bits, compression, mask[4];
        double tolerance; /* of coded values: fields of more than 16 bits are read to 16 */
    } kinds[] = {
        {40, 16, 0, {0x7c00, 0x03e0, 0x001f, 0}, 0},
        {40, 16, 3, {0xf800, 0x07e0, 0x001f, 0}, 0},
        {40, 16, 6, {0x0f00, 0x00f0, 0x000f, 0xf000}, 0},
        {56, 16, 3, {0x7c00, 0x03e0, 0x001f, 0x8000}, 0},
        {52, 16, 3, {0xff00, 0x00ff, 0, 0}, 0},
        {40, 32, 0, {0xff0000, 0xff00, 0xff, 0}, 0},
        {40, 32, 3, {0xff, 0xff00, 0xff0000, 0}, 0},
        {124, 32, 3, {0xff000000, 0xff0000, 0xff00, 0xff}, 0},
        {108, 32, 3, {0x3ff00000, 0xffc00, 0x3ff, 0xc0000000}, 0},
        {40, 32, 3, {0xfe000000, 0x01ffff80, 0x7f, 0}, 1.0 / 65535.0},
    };
    uint64_t seed = 3;
    for (size_t k = 0; k < COUNT(kinds); k++) {
        const size_t bytes = kinds[k].bits / 8, masks = kinds[k].header > 40 || kinds[k].compression == 0 ? 0
                                                        : kinds[k].compression == 3                       ? 12
                                                                                                          : 16;
        bmp_file f = make_kind(8, 1, kinds[k].header, kinds[k].bits, kinds[k].compression, masks, 8 * bytes);
        for (size_t c = 0; c < 4 && kinds[k].compression && 54 + 4 * c + 4 <= f.size - 8 * bytes; c++)
            put_number(f.bytes + 54 + 4 * c, kinds[k].mask[c], 4);
        uint32_t words[8];
        for (size_t x = 0; x < 8; x++) {
            words[x] = (uint32_t)random_bits(&seed) >> (bytes == 2 ? 16 : 0);
            put_number(f.bytes + f.size - (8 - x) * bytes, words[x], (int)bytes);
        }
        image *img;
        diagnostic why = {0};
        worked(read_bmp(f.bytes, f.size, IMAGE_CODED, &img, &why), &why);
        assert_true(!img->alpha == !kinds[k].mask[3]);
        for (size_t x = 0; x < 8; x++)
            for (size_t c = 0; c < (img->alpha ? 4 : 3); c++) {
                const double found = (double)(c < 3 ? img->pixel[3 * x + c] : img->alpha[x]),
                             right = field_of(words[x], kinds[k].mask[c]);
                if (!(fabs(found - right) <= kinds[k].tolerance + 1e-7))
                    fail_msg("kind %zu, channel %zu: %.9g is not %.9g", k, c, found, right);
            }
        image_destroy(img);
        free(f.bytes);
    }
    bmp_file f = make_kind(1, 1, 52, 32, 3, 0, 4);
    put_number(f.bytes + 54, 0x00ff00f0, 4);
    refused(f.bytes, f.size, "00ff00f0, are not adjacent", "as PNG");
    free(f.bytes);
}

/* 4 columns, 3 rows; a run, a jump, single values with padding, an end of row. '.' is a pixel that is skipped. */
static void run_lengths_are_read(void **state)
{
    (void)state;
    static const struct {
        uint32_t bits, compression, header;
        const char *rows[3]; /* from the top; each pixel's colour */
        size_t size;
        unsigned char code[32];
    } kinds[] = {
        {8, 1, 40, {"..55", "123.", "7777"}, 20, {4, 7, 0, 0, 0, 3, 1, 2, 3, 0xEE, 0, 0, 0, 2, 2, 0, 2, 5, 0, 1}},
        {4, 2, 40, {"1212", "345.", "7777"}, 14, {4, 0x77, 0, 0, 0, 3, 0x34, 0x50, 0, 0, 4, 0x12, 0, 1}},
    };
    for (size_t k = 0; k < COUNT(kinds); k++) {
        const size_t before = 4 * ((size_t)1 << kinds[k].bits);
        bmp_file f = make_kind(4, 3, kinds[k].header, kinds[k].bits, kinds[k].compression, before, kinds[k].size);
        unsigned char *code = f.bytes + f.size - kinds[k].size;
        put_palette(f.bytes + 14 + kinds[k].header, before / 4, 4);
        memcpy(code, kinds[k].code, kinds[k].size);
        image *img = NULL;
        diagnostic why = {0};
        worked(read_bmp(f.bytes, f.size, IMAGE_LIGHT, &img, &why), &why);
        for (int y = 0; y < 3; y++)
            for (int x = 0; x < 4; x++) {
                const char letter = kinds[k].rows[y][x];
                is_color(img, x, y, letter == '.' ? 0 : letter - '0');
                assert_true(img->alpha[4 * y + x] == (letter == '.' ? 0.0F : 1.0F));
            }
        image_destroy(img);
        free(f.bytes);
    }
}

/* Of OS/2: runs of blue, green, red, without a palette. */
static void run_lengths_of_colors_are_read(void **state)
{
    (void)state;
    static const unsigned char code[20] = {2, 1, 2, 3, 0, 0, 0, 3, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0xEE, 0, 1};
    static const unsigned char right[2][3] = {{7, 8, 9}, {3, 2, 1}};
    bmp_file f = make_kind(3, 2, 64, 24, 4, 0, sizeof code);
    image *img;
    diagnostic why = {0};
    memcpy(f.bytes + f.size - sizeof code, code, sizeof code);
    worked(read_bmp(f.bytes, f.size, IMAGE_CODED, &img, &why), &why);
    for (int y = 0; y < 2; y++)
        for (int c = 0; c < 3; c++)
            assert_true(img->pixel[9 * y + c] == (float)(right[y][c] / 255.0));
    assert_true(img->alpha[5] == 0.0F && img->alpha[4] == 1.0F);
    image_destroy(img);
    refused(f.bytes, f.size - 2, "truncated: 5 of 6 pixels", "copy the file");
    free(f.bytes);
}

static void runs_beyond_the_image_are_damage(void **state)
{
    (void)state;
    static const unsigned char codes[][8] = {
        {5, 1, 0, 1}, {0, 2, 3, 0, 2, 1, 0, 1}, {0, 2, 0, 3, 1, 1, 0, 1}, {0, 5, 1, 1, 1, 1, 1, 0}};
    for (size_t k = 0; k < COUNT(codes); k++) {
        bmp_file f = make_kind(4, 3, 40, 8, 1, 8, 8);
        memcpy(f.bytes + f.size - 8, codes[k], 8);
        refused(f.bytes, f.size, "a run leaves row", "copy the file");
        free(f.bytes);
    }
    bmp_file f = make_kind(4, -3, 40, 8, 1, 8, 8);
    refused(f.bytes, f.size, "begin at the bottom", "as PNG");
    free(f.bytes);
}

static void a_png_inside_is_read(void **state)
{
    (void)state;
    image *img, *back;
    unsigned char *png;
    size_t size;
    diagnostic why = {0};
    worked(image_create(5, 2, &img, &why), &why);
    for (int i = 0; i < 30; i++)
        img->pixel[i] = (float)srgb_decode(8 * i / 255.0);
    worked(image_encode(img, IMAGE_PNG, 8, false, &png, &size, &why), &why);
    bmp_file f = make_kind(5, 2, 40, 0, 5, 0, size);
    memcpy(f.bytes + 54, png, size);
    worked(read_bmp(f.bytes, f.size, IMAGE_LIGHT, &back, &why), &why);
    assert_memory_equal(back->pixel, img->pixel, 30 * sizeof *img->pixel);
    refused(f.bytes, 60, "PNG", "");
    image_destroy(img);
    image_destroy(back);
    free(f.bytes);
    free(png);
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
        assert_int_equal(read_bmp(cut, size, IMAGE_LIGHT, &img, &why), STATUS_BAD_INPUT);
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
        const status code = read_bmp(copy, f.size, IMAGE_LIGHT, &img, &why);
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
    assert_true(bits == 8);
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
        cmocka_unit_test(palettes_are_read),
        cmocka_unit_test(a_color_beyond_the_palette_is_damage),
        cmocka_unit_test(bit_fields_of_any_width_are_read),
        cmocka_unit_test(run_lengths_are_read),
        cmocka_unit_test(run_lengths_of_colors_are_read),
        cmocka_unit_test(runs_beyond_the_image_are_damage),
        cmocka_unit_test(a_png_inside_is_read),
        cmocka_unit_test(hostile_sizes_are_refused),
        cmocka_unit_test(truncated_files_are_refused),
        cmocka_unit_test(corrupted_files_are_read_or_refused),
        cmocka_unit_test(same_pixels_give_the_same_film_as_png),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
