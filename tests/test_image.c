/* Tests of images: the sRGB curve, and reading and writing of PNG, JPEG and PFM, complete and damaged. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/file.h"
#include "base/os_process.h"
#include "base/text.h"
#include "image/codec.h"
#include "image/image.h"
#include <dirent.h>
#include <math.h>
#include <png.h>
#include <jpeglib.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[4096];

static int make_folder(void **state)
{
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/cuvette-image-XXXXXX", base && *base ? base : "/tmp");
    return mkdtemp(folder) ? 0 : -1;
}

/* Empties the folder; returns the number of files that were in it. */
static int empty_folder(void)
{
    DIR *entries = opendir(folder);
    int count = 0;
    for (struct dirent *entry; entries && (entry = readdir(entries));) {
        char *path = text_format("%s/%s", folder, entry->d_name);
        count += unlink(path) == 0;
        free(path);
    }
    if (entries)
        closedir(entries);
    return count;
}

static int remove_folder(void **state)
{
    (void)state;
    empty_folder();
    rmdir(folder);
    return 0;
}

static char *in_folder(const char *name)
{
    char *path = text_format("%s/%s", folder, name);
    assert_non_null(path);
    return path;
}

typedef struct blob {
    char *bytes;
    size_t size;
} blob;

static blob get(const char *path)
{
    blob b;
    assert_int_equal(file_read(path, SIZE_MAX, &b.bytes, &b.size, NULL), STATUS_OK);
    return b;
}

static void put(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g is not %.17g within %g", value, expected, tolerance);
}

static uint32_t next_random(uint32_t *state)
{
    *state ^= *state << 13; /* xorshift32, Marsaglia 2003 */
    *state ^= *state >> 17;
    return *state ^= *state << 5;
}

static bool same_float(float a, float b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* A smooth image with some grain. */
static image *make_image(int width, int height)
{
    image *img;
    uint32_t random = 12345;
    assert_int_equal(image_create(width, height, &img, NULL), STATUS_OK);
    for (int i = 0; i < width * height * 3; i++) {
        int x = i / 3 % width, y = i / 3 / width;
        double wave = 0.5 + 0.4 * sin(0.2 * x + i % 3) * cos(0.15 * y);
        img->pixel[i] = (float)(wave + 0.05 * (next_random(&random) % 1000) / 1000.0);
    }
    return img;
}

/* ---- sRGB ---- */

static void srgb_has_its_published_values(void **state)
{
    (void)state;
    assert_close(srgb_encode(0.5), 0.735356983052449, 1e-12);
    assert_close(srgb_encode(0.18), 0.461356129500442, 1e-12);
    assert_close(srgb_decode(0.5), 0.214041140482232, 1e-12);
    assert_close(srgb_encode(0.0031308), 12.92 * 0.0031308, 1e-15);
    assert_close(srgb_encode(nextafter(0.0031308, 1)), 12.92 * 0.0031308,
                 5e-8); /* the step of the standard's own definition */
    assert_close(srgb_decode(0.04045), 0.04045 / 12.92, 1e-15);
    assert_close(srgb_decode(1.0), 1.0, 1e-14);
    assert_true(srgb_decode(0.0) == 0.0 && srgb_encode(0.0) == 0.0 && srgb_encode(1.0) == 1.0);
    assert_true(srgb_encode(-3.0) == 0.0 && srgb_encode(7.0) == 1.0 && srgb_encode(INFINITY) == 1.0);
    assert_true(srgb_encode((double)NAN) == 0.0);
    static const struct {
        float linear;
        unsigned byte;
    } bytes[] = {
        {0.5f, 188}, {0.18f, 118}, {0.25f, 137}, {0.75f, 225}, {0.1f, 89},
        {0.01f, 25}, {0.001f, 3},  {1.0f, 255},  {0.0f, 0},
    };
    for (size_t i = 0; i < sizeof bytes / sizeof *bytes; i++)
        assert_int_equal(codec_quantize(bytes[i].linear, 255), bytes[i].byte);
}

static void srgb_agrees_with_libm(void **state)
{
    (void)state;
    for (int i = 0; i <= 10000; i++) {
        double x = i / 10000.0;
        double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
        double decoded = x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
        assert_close(srgb_encode(x), encoded, 1e-14);
        assert_close(srgb_decode(x), decoded, 1e-14);
        assert_close(srgb_decode(srgb_encode(x)), x, 1e-7);
    }
}

static void the_byte_table_rounds_like_the_curve(void **state)
{
    (void)state;
    codec_bytes table;
    codec_bytes_prepare(&table);
    uint32_t random = 99;
    for (int i = 0; i < 100000; i++) {
        float value = (float)(next_random(&random) / 4294967296.0 * 1.1 - 0.05);
        assert_int_equal(codec_byte(&table, value), codec_quantize(value, 255));
    }
    for (int byte = 1; byte < 256; byte++) {
        assert_int_equal(codec_byte(&table, table.least[byte]), byte);
        assert_int_equal(codec_quantize(nextafterf(table.least[byte], 0.0f), 255), byte - 1);
        assert_int_equal(codec_byte(&table, nextafterf(table.least[byte], 0.0f)), byte - 1);
    }
    assert_int_equal(codec_byte(&table, NAN), 0);
    assert_int_equal(codec_byte(&table, INFINITY), 255);
    assert_int_equal(codec_byte(&table, -INFINITY), 0);
}

static void the_format_follows_the_file_name_extension(void **state)
{
    (void)state;
    assert_int_equal(image_format_of("a/b.png"), IMAGE_PNG);
    assert_int_equal(image_format_of("A.PNG"), IMAGE_PNG);
    assert_int_equal(image_format_of("x.y.jpg"), IMAGE_JPEG);
    assert_int_equal(image_format_of("x.JpEg"), IMAGE_JPEG);
    assert_int_equal(image_format_of("x.pfm"), IMAGE_PFM);
    assert_int_equal(image_format_of("-"), IMAGE_PNG);
    assert_int_equal(image_format_of("/dev/null"), IMAGE_PNG);
    static const char *const unknown[] = {"", "png", ".png", "x.gif", "x.png.gz", "x.png/", "x."};
    for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++)
        assert_int_equal(image_format_of(unknown[i]), IMAGE_UNKNOWN);
}

static void image_sizes_are_limited(void **state)
{
    (void)state;
    image *img;
    diagnostic why = {0};
    assert_int_equal(image_create(65536, 1, &img, NULL), STATUS_OK);
    assert_true(img->pixel[65536 * 3 - 1] == 0.0f);
    image_destroy(img);
    image_destroy(NULL);
    static const int sizes[][2] = {{0, 1}, {1, 0}, {-1, 5}, {65537, 1}, {1, 65537}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        assert_int_equal(image_create(sizes[i][0], sizes[i][1], &img, &why), STATUS_BAD_INPUT);
        assert_null(img);
    }
}

/* ---- round trips ---- */

/* Every encoded value, three times, is read back unchanged. */
static void check_png_depth(int bits, int width, int height)
{
    unsigned maximum = (1u << bits) - 1;
    image *img, *back;
    int file_bits = 0;
    char *path = in_folder("depth.png");
    assert_int_equal(image_create(width, height, &img, NULL), STATUS_OK);
    for (int i = 0; i < width * height * 3; i++)
        img->pixel[i] = (float)srgb_decode((double)((unsigned)i % (maximum + 1)) / maximum);
    assert_int_equal(image_write(img, path, bits, NULL), STATUS_OK);
    assert_int_equal(image_read(path, &back, &file_bits, NULL), STATUS_OK);
    assert_int_equal(file_bits, bits);
    assert_int_equal(back->width, width);
    assert_int_equal(back->height, height);
    for (int i = 0; i < width * height * 3; i++)
        assert_true(same_float(back->pixel[i], img->pixel[i]));
    image_destroy(img);
    image_destroy(back);
    free(path);
}

static void png_keeps_every_value(void **state)
{
    (void)state;
    check_png_depth(8, 256, 1);
    check_png_depth(8, 3, 171);
    check_png_depth(16, 256, 256);
}

static void values_out_of_range_are_clamped(void **state)
{
    (void)state;
    static const float values[6] = {NAN, -1.0f, 2.0f, INFINITY, -INFINITY, 0.5f};
    static const float expected[6] = {0, 0, 1, 1, 0, 0.5f};
    for (int bits = 8; bits <= 16; bits += 8) {
        image *img, *back;
        char *path = in_folder("clamp.png");
        assert_int_equal(image_create(2, 1, &img, NULL), STATUS_OK);
        memcpy(img->pixel, values, sizeof values);
        assert_int_equal(image_write(img, path, bits, NULL), STATUS_OK);
        assert_int_equal(image_read(path, &back, NULL, NULL), STATUS_OK);
        for (int i = 0; i < 6; i++)
            assert_float_equal(back->pixel[i], expected[i], bits == 8 ? 0.003f : 2e-5f);
        image_destroy(img);
        image_destroy(back);
        free(path);
    }
}

static void check_same_bytes(const char *name, int bits)
{
    image *img = make_image(61, 47);
    char *path = in_folder(name);
    assert_int_equal(image_write(img, path, bits, NULL), STATUS_OK);
    blob first = get(path);
    assert_int_equal(image_write(img, path, bits, NULL), STATUS_OK);
    blob second = get(path);
    assert_int_equal(first.size, second.size);
    assert_memory_equal(first.bytes, second.bytes, first.size);
    free(first.bytes);
    free(second.bytes);
    free(path);
    image_destroy(img);
}

static void the_same_image_gives_the_same_bytes(void **state)
{
    (void)state;
    check_same_bytes("a.png", 8);
    check_same_bytes("a.png", 16);
    check_same_bytes("a.jpg", 8);
    check_same_bytes("a.pfm", 8);
}

static void png_has_an_srgb_chunk_and_no_time(void **state)
{
    (void)state;
    image *img = make_image(20, 10);
    char *path = in_folder("chunks.png"), names[64] = "";
    assert_int_equal(image_write(img, path, 8, NULL), STATUS_OK);
    blob file = get(path);
    for (size_t at = 8; at + 12 <= file.size;) {
        const unsigned char *b = (const unsigned char *)file.bytes + at;
        strncat(names, (const char *)b + 4, 4);
        at += 12 + ((size_t)b[0] << 24 | (size_t)b[1] << 16 | (size_t)b[2] << 8 | b[3]);
    }
    assert_string_equal(names, "IHDRsRGBIDATIEND");
    free(file.bytes);
    free(path);
    image_destroy(img);
}

static void jpeg_is_close_to_the_original(void **state)
{
    (void)state;
    image *img = make_image(50, 33), *back;
    char *path = in_folder("a.jpeg");
    int bits = 0;
    for (int i = 0; i < 50 * 33 * 3; i++) /* compared without the grain */
        img->pixel[i] = (float)(0.5 + 0.4 * sin(0.1 * (i / 3 % 50) + i % 3));
    assert_int_equal(image_write(img, path, 8, NULL), STATUS_OK);
    assert_int_equal(image_read(path, &back, &bits, NULL), STATUS_OK);
    assert_int_equal(bits, 8);
    assert_true(back->width == 50 && back->height == 33);
    for (int i = 0; i < 50 * 33 * 3; i++) {
        double difference = srgb_encode((double)img->pixel[i]) - srgb_encode((double)back->pixel[i]);
        assert_true(fabs(difference) < 8 / 255.0);
    }
    image_destroy(img);
    image_destroy(back);
    free(path);
}

static void pfm_keeps_every_bit(void **state)
{
    (void)state;
    image *img, *back;
    int bits = 0;
    char *path = in_folder("a.pfm");
    static const float values[12] = {0.0f, -0.0f,  1e-45f, 3.4e38f,    -3.4e38f, 1.0f,
                                     0.1f, 1e-10f, -5.0f,  1234567.0f, 0.5f,     2.0f};
    assert_int_equal(image_create(2, 2, &img, NULL), STATUS_OK);
    memcpy(img->pixel, values, sizeof values);
    assert_int_equal(image_write(img, path, 8, NULL), STATUS_OK);
    assert_int_equal(image_read(path, &back, &bits, NULL), STATUS_OK);
    assert_int_equal(bits, 32);
    assert_memory_equal(back->pixel, values, sizeof values);
    blob file = get(path);
    assert_int_equal(file.size, 12 + 48);
    assert_memory_equal(file.bytes, "PF\n2 2\n-1.0\n", 12);
    assert_memory_equal(file.bytes + 12, "\xcd\xcc\xcc\x3d", 4); /* 0.1f, little-endian: the lowest row comes first */
    free(file.bytes);
    image_destroy(img);
    image_destroy(back);
    free(path);
}

/* ---- PFM written by hand ---- */

static status read_bytes(const void *bytes, size_t size, image **out, diagnostic *why)
{
    char *path = in_folder("by_hand");
    put(path, bytes, size);
    status code = image_read(path, out, NULL, why);
    free(path);
    return code;
}

static void pfm_is_read_in_either_byte_order(void **state)
{
    (void)state;
    static const char big[] = "PF\n1 2\n1.0\n"
                              "\x3f\x80\0\0"
                              "\x40\0\0\0"
                              "\x40\x40\0\0"
                              "\x40\x80\0\0"
                              "\x40\xa0\0\0"
                              "\x40\xc0\0\0";
    static const char grey_big[] = "Pf\n2 1\n0.5\n"
                                   "\x3f\x80\0\0"
                                   "\x40\0\0\0";
    static const char grey_little[] = "Pf\r\n2 1 -2\n"
                                      "\0\0\x80\x3f"
                                      "\0\0\0\x40";
    image *img;
    assert_int_equal(read_bytes(big, sizeof big - 1, &img, NULL), STATUS_OK);
    static const float expected[6] = {4, 5, 6, 1, 2, 3};
    assert_memory_equal(img->pixel, expected, sizeof expected);
    image_destroy(img);
    static const float grey[6] = {1, 1, 1, 2, 2, 2};
    assert_int_equal(read_bytes(grey_big, sizeof grey_big - 1, &img, NULL), STATUS_OK);
    assert_memory_equal(img->pixel, grey, sizeof grey);
    image_destroy(img);
    assert_int_equal(read_bytes(grey_little, sizeof grey_little - 1, &img, NULL), STATUS_OK);
    assert_memory_equal(img->pixel, grey, sizeof grey);
    image_destroy(img);
}

static void invalid_pfm_is_refused(void **state)
{
    (void)state;
#define bad(text)             \
    {                         \
        text, sizeof text - 1 \
    }
    static const struct {
        const char *bytes;
        size_t size;
    } cases[] = {
        bad(""),
        bad("P"),
        bad("PF"),
        bad("PF\n"),
        bad("PF\n1"),
        bad("PF\n1 1"),
        bad("PF\n1 1\n-1.0"),
        bad("PF\n1 1\n-1.0\n"),
        bad("Pf\n1 1\n-1\n\0\0\0"),
        bad("Pf\n1 1\n-1\n\0\0\0\0\0"),
        bad("Pf\n0 1\n-1\n"),
        bad("Pf\n-1 1\n-1\n\0\0\0\0"),
        bad("Pf\n1 1\n0\n\0\0\0\0"),
        bad("Pf\n1 1\nnan\n\0\0\0\0"),
        bad("Pf\n1.0 1\n-1\n\0\0\0\0"),
        bad("Pf\n1 1 -1,0\n\0\0\0\0"),
        bad("Pf\n65536 65536\n-1\n\0\0\0\0"),
        bad("Pf\n65537 1\n-1\n\0\0\0\0"),
        bad("Pf\n99999999999999999999 1\n-1\n\0\0\0\0"),
        bad("Pf\n4611686018427387904 4\n-1\n"),
        bad("Pf\n1 1\n-1\n\0\0\xc0\x7f"),
        bad("Pf\n1 1\n-1\n\0\0\x80\x7f"),
        bad("PX\n1 1\n-1\n\0\0\0\0"),
        bad("Pf\n1 1111111111111111111111111111111111111111\n-1\n\0\0\0\0"),
        bad("unknown image format"),
    };
#undef bad
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        image *img;
        diagnostic why = {0};
        assert_int_equal(read_bytes(cases[i].bytes, cases[i].size, &img, &why), STATUS_BAD_INPUT);
        assert_null(img);
        assert_non_null(strstr(why.file, "/by_hand"));
        assert_true(why.what[0] != 0);
    }
}

/* ---- PNG of every kind, written by libpng itself ---- */

typedef struct png_kind {
    int color, depth, interlace;
    bool transparent;
} png_kind;

enum { KIND_WIDTH = 13, KIND_HEIGHT = 11 };

static int channels_of(int color)
{
    int colors = color == PNG_COLOR_TYPE_RGB || color == PNG_COLOR_TYPE_RGBA ? 3 : 1;
    return colors + (color == PNG_COLOR_TYPE_GRAY_ALPHA || color == PNG_COLOR_TYPE_RGBA);
}

/* The sample of a pixel and channel, and the same with the palette applied: 0..2^depth - 1. */
static unsigned sample_at(const png_kind *kind, int x, int y, int channel)
{
    uint32_t random = (uint32_t)(1 + x * 7919 + y * 104729 + channel * 1299709);
    next_random(&random);
    next_random(&random);
    return random & ((1u << kind->depth) - 1);
}

static png_color palette_entry(unsigned index)
{
    return (png_color){(png_byte)(index * 37), (png_byte)(255 - index), (png_byte)(index * 91 + 5)};
}

static void pack_row(const png_kind *kind, int y, unsigned char *row)
{
    int channels = channels_of(kind->color), bit = 0;
    memset(row, 0, KIND_WIDTH * 8);
    for (int i = 0; i < KIND_WIDTH * channels; i++, bit += kind->depth) {
        unsigned value = sample_at(kind, i / channels, y, i % channels);
        if (kind->depth == 16) {
            row[bit / 8] = (unsigned char)(value >> 8);
            row[bit / 8 + 1] = (unsigned char)value;
        } else {
            row[bit / 8] |= (unsigned char)(value << (8 - kind->depth - bit % 8));
        }
    }
}

static void write_kind(const png_kind *kind, const char *path)
{
    FILE *file = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    assert_true(file && info); /* an error of libpng aborts the test */
    png_init_io(png, file);
    png_set_IHDR(png, info, KIND_WIDTH, KIND_HEIGHT, kind->depth, kind->color, kind->interlace, 0, 0);
    png_color palette[256];
    png_byte alphas[256];
    for (unsigned i = 0; i < 256; i++) {
        palette[i] = palette_entry(i);
        alphas[i] = (png_byte)(i * 53);
    }
    if (kind->color == PNG_COLOR_TYPE_PALETTE)
        png_set_PLTE(png, info, palette, 1 << kind->depth);
    png_color_16 key = {0, 0, 0, 0, 0};
    key.gray = key.red = (png_uint_16)sample_at(kind, 2, 3, 0);
    key.green = (png_uint_16)sample_at(kind, 2, 3, 1);
    key.blue = (png_uint_16)sample_at(kind, 2, 3, 2);
    if (kind->transparent)
        png_set_tRNS(png, info, alphas, 1 << kind->depth, &key);
    png_write_info(png, info);
    unsigned char rows[KIND_HEIGHT][KIND_WIDTH * 8], *pointers[KIND_HEIGHT];
    for (int y = 0; y < KIND_HEIGHT; y++) {
        pack_row(kind, y, rows[y]);
        pointers[y] = rows[y];
    }
    png_write_image(png, pointers);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    assert_int_equal(fclose(file), 0);
}

static double expected_channel(const png_kind *kind, int x, int y, int channel)
{
    double full = (1u << kind->depth) - 1, alpha = 1.0;
    int channels = channels_of(kind->color);
    unsigned first = sample_at(kind, x, y, 0);
    if (kind->color == PNG_COLOR_TYPE_PALETTE) {
        png_color entry = palette_entry(first);
        double value = (channel == 0 ? entry.red : channel == 1 ? entry.green : entry.blue) / 255.0;
        return srgb_decode(value) * (kind->transparent ? (first * 53 & 255) / 255.0 : 1.0);
    }
    if (channels % 2 == 0) {
        alpha = sample_at(kind, x, y, channels - 1) / full;
    } else if (kind->transparent) {
        bool same = true;
        for (int c = 0; c < channels; c++)
            same = same && sample_at(kind, x, y, c) == sample_at(kind, 2, 3, c);
        alpha = same ? 0.0 : 1.0;
    }
    return alpha * srgb_decode(sample_at(kind, x, y, channels >= 3 ? channel : 0) / full);
}

static void check_kind(const png_kind *kind)
{
    char *path = in_folder("kind.png");
    image *img;
    int bits = 0;
    write_kind(kind, path);
    assert_int_equal(image_read(path, &img, &bits, NULL), STATUS_OK);
    assert_int_equal(bits, kind->depth == 16 ? 16 : 8);
    assert_true(img->width == KIND_WIDTH && img->height == KIND_HEIGHT);
    for (int i = 0; i < KIND_WIDTH * KIND_HEIGHT * 3; i++) {
        double expected = expected_channel(kind, i / 3 % KIND_WIDTH, i / 3 / KIND_WIDTH, i % 3);
        assert_true(fabs((double)img->pixel[i] - expected) < 1e-7);
    }
    image_destroy(img);
    free(path);
}

static void png_of_every_kind_is_read(void **state)
{
    (void)state;
    int checked = 0;
    static const int colors[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_PALETTE,
                                 PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGBA};
    for (size_t c = 0; c < sizeof colors / sizeof *colors; c++) {
        for (int depth = 1; depth <= 16; depth *= 2) {
            bool few = colors[c] == PNG_COLOR_TYPE_GRAY || (colors[c] == PNG_COLOR_TYPE_PALETTE && depth <= 8);
            bool plain = channels_of(colors[c]) % 2 == 1;
            bool legal = few || (depth >= 8 && colors[c] != PNG_COLOR_TYPE_PALETTE);
            for (int variant = 0; variant < 4 && legal; variant++) {
                png_kind kind = {colors[c], depth, variant & 1 ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, variant & 2};
                if (plain || !kind.transparent) {
                    check_kind(&kind);
                    checked++;
                }
            }
        }
    }
    assert_int_equal(checked, 15 * 2 + 11 * 2); /* 15 legal pairs of colour and depth, 11 of them with tRNS */
}

static void huge_png_is_refused(void **state)
{
    (void)state;
    static const struct {
        png_uint_32 width, height;
    } sizes[] = {
        {70000, 1},
        {1, 70000},
        {65536, 65536},
        {2000000000, 2000000000},
    };
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        char *path = in_folder("huge.png");
        FILE *file = fopen(path, "wb");
        png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
        png_infop info = png_create_info_struct(png);
        assert_true(file && info); /* an error of libpng aborts the test */
        png_init_io(png, file);
        png_set_user_limits(png, 0x7fffffff, 0x7fffffff);
        png_set_IHDR(png, info, sizes[i].width, sizes[i].height, 1, PNG_COLOR_TYPE_GRAY, 0, 0, 0);
        png_write_info(png, info);
        png_destroy_write_struct(&png, &info);
        fclose(file);
        image *img;
        diagnostic why = {0};
        assert_int_equal(image_read(path, &img, NULL, &why), STATUS_BAD_INPUT);
        assert_null(img);
        assert_string_equal(why.file, path);
        free(path);
    }
}

/* A file of kilobytes whose header declares gigabytes. */
static void write_bomb(const char *path, png_uint_32 side, int bits, int color, int interlaced)
{
    FILE *file = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    assert_true(file && info); /* an error of libpng aborts the test */
    png_init_io(png, file);
    png_set_IHDR(png, info, side, side, bits, color, interlaced, 0, 0);
    png_set_filter(png, 0, PNG_FILTER_NONE);
    png_write_info(png, info);
    int passes = png_set_interlace_handling(png);
    unsigned char *row = calloc(png_get_rowbytes(png, info), 1);
    assert_non_null(row);
    for (png_uint_32 y = 0; y < side * (png_uint_32)passes; y++)
        png_write_row(png, row);
    png_write_end(png, info);
    free(row);
    png_destroy_write_struct(&png, &info);
    fclose(file);
}

static void decompression_bombs_are_refused(void **state)
{
    (void)state;
    static const struct {
        png_uint_32 side;
        int bits, color, interlaced;
    } bombs[] = {
        {16384, 1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE},
        {8192, 1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_ADAM7},
        {4200, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE},
    };
    struct rusage before, after;
    char *path = in_folder("bomb.png");
    for (size_t i = 0; i < sizeof bombs / sizeof *bombs; i++) {
        write_bomb(path, bombs[i].side, bombs[i].bits, bombs[i].color, bombs[i].interlaced);
        image *img;
        diagnostic why = {0};
        getrusage(RUSAGE_SELF, &before);
        assert_int_equal(image_read(path, &img, NULL, &why), STATUS_BAD_INPUT);
        getrusage(RUSAGE_SELF, &after);
        assert_null(img);
        assert_non_null(strstr(why.what, "the image has"));
        assert_true(after.ru_maxrss - before.ru_maxrss < 64 << 10);
    }
    /* Sixteen million pixels of one colour are still a valid image. */
    write_bomb(path, 4000, 8, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE);
    image *img;
    assert_int_equal(image_read(path, &img, NULL, NULL), STATUS_OK);
    image_destroy(img);
    free(path);
}

/* ---- JPEG of other kinds ---- */

static void write_jpeg_kind(const char *path, J_COLOR_SPACE space, int channels, bool progressive, int subsampling)
{
    FILE *file = fopen(path, "wb");
    struct jpeg_compress_struct cinfo;
    struct jpeg_error_mgr errors;
    assert_non_null(file);
    cinfo.err = jpeg_std_error(&errors);
    jpeg_create_compress(&cinfo);
    jpeg_stdio_dest(&cinfo, file);
    cinfo.image_width = 40;
    cinfo.image_height = 30;
    cinfo.input_components = channels;
    cinfo.in_color_space = space;
    jpeg_set_defaults(&cinfo);
    jpeg_set_quality(&cinfo, 95, TRUE);
    cinfo.comp_info[0].h_samp_factor = cinfo.comp_info[0].v_samp_factor = subsampling;
    if (progressive)
        jpeg_simple_progression(&cinfo);
    jpeg_start_compress(&cinfo, TRUE);
    while (cinfo.next_scanline < cinfo.image_height) {
        unsigned char row[40 * 4];
        for (int i = 0; i < 40 * channels; i++)
            row[i] = (unsigned char)(60 + i / channels * 3 + (int)cinfo.next_scanline);
        JSAMPROW rows = row;
        jpeg_write_scanlines(&cinfo, &rows, 1);
    }
    jpeg_finish_compress(&cinfo);
    jpeg_destroy_compress(&cinfo);
    assert_int_equal(fclose(file), 0);
}

static void jpeg_of_other_kinds_is_read(void **state)
{
    (void)state;
    static const struct {
        J_COLOR_SPACE space;
        int channels, subsampling;
        bool progressive;
    } kinds[] = {
        {JCS_GRAYSCALE, 1, 1, false}, {JCS_GRAYSCALE, 1, 1, true}, {JCS_RGB, 3, 2, false},
        {JCS_RGB, 3, 1, true},        {JCS_RGB, 3, 2, true},
    };
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        char *path = in_folder("kind.jpg");
        image *img;
        write_jpeg_kind(path, kinds[k].space, kinds[k].channels, kinds[k].progressive, kinds[k].subsampling);
        assert_int_equal(image_read(path, &img, NULL, NULL), STATUS_OK);
        assert_true(img->width == 40 && img->height == 30);
        for (int i = 0; i < 40 * 30 * 3; i++) {
            double expected = (60 + i / 3 % 40 * 3 + i / 3 / 40) / 255.0;
            assert_true(fabs(srgb_encode((double)img->pixel[i]) - expected) < 6 / 255.0);
        }
        image_destroy(img);
        free(path);
    }
}

/* A valid file whose frame header then declares another size (SOF, ITU-T T.81, B.2.2): height and width follow the
 * precision. */
static void jpeg_with_a_false_size_is_refused(void **state)
{
    (void)state;
    static const unsigned char sizes[][4] = {
        {0xff, 0xdc, 0xff, 0xdc}, {0x0f, 0xff, 0xff, 0xdc}, {0xff, 0xdc, 0, 40}, {0, 0, 0, 40}, {0, 30, 0, 0}};
    char *path = in_folder("size.jpg");
    for (int progressive = 0; progressive < 2; progressive++) {
        for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
            write_jpeg_kind(path, JCS_RGB, 3, progressive, 1);
            blob b = get(path);
            size_t at = 0;
            while (at + 9 < b.size && !((unsigned char)b.bytes[at] == 0xff &&
                                        (unsigned char)b.bytes[at + 1] == (progressive ? 0xc2 : 0xc0)))
                at++;
            assert_true(at + 9 < b.size);
            memcpy(b.bytes + at + 5, sizes[i], 4);
            put(path, b.bytes, b.size);
            free(b.bytes);
            struct rusage before, after;
            image *img;
            getrusage(RUSAGE_SELF, &before);
            assert_int_equal(image_read(path, &img, NULL, NULL), STATUS_BAD_INPUT);
            getrusage(RUSAGE_SELF, &after);
            assert_null(img);
            assert_true(after.ru_maxrss - before.ru_maxrss < 64 << 10);
        }
    }
    free(path);
}

static void cmyk_jpeg_is_refused(void **state)
{
    (void)state;
    char *path = in_folder("cmyk.jpg");
    image *img;
    diagnostic why = {0};
    write_jpeg_kind(path, JCS_CMYK, 4, false, 1);
    assert_int_equal(image_read(path, &img, NULL, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "neither grey nor RGB"));
    free(path);
}

/* ---- damage ---- */

/* checked: every bit is under a checksum */
typedef struct victim {
    const char *name;
    blob file;
    bool checked;
} victim;

enum { VICTIMS = 7 };

static void make_victims(victim victims[VICTIMS])
{
    static const char *const names[VICTIMS] = {"8.png",           "16.png",   "interlaced.png", "baseline.jpg",
                                               "progressive.jpg", "grey.jpg", "a.pfm"};
    image *img = make_image(19, 14);
    for (int i = 0; i < VICTIMS; i++) {
        char *path = in_folder(names[i]);
        if (i == 2)
            write_kind(&(png_kind){PNG_COLOR_TYPE_RGBA, 8, PNG_INTERLACE_ADAM7, false}, path);
        else if (i == 4 || i == 5)
            write_jpeg_kind(path, i == 4 ? JCS_RGB : JCS_GRAYSCALE, i == 4 ? 3 : 1, i == 4, 1);
        else
            assert_int_equal(image_write(img, path, i == 1 ? 16 : 8, NULL), STATUS_OK);
        victims[i] = (victim){names[i], get(path), i <= 2};
        free(path);
    }
    image_destroy(img);
}

/* Never a partial image: either a refusal that names the file, or an image of the full size. */
static status check_damaged(const void *bytes, size_t size)
{
    image *img;
    diagnostic why = {0};
    status code = read_bytes(bytes, size, &img, &why);
    if (code == STATUS_OK) {
        assert_non_null(img);
        image_destroy(img);
    } else {
        assert_int_equal(code, STATUS_BAD_INPUT);
        assert_null(img);
        assert_non_null(strstr(why.file, "/by_hand"));
        assert_true(why.what[0] != 0 && !strchr(why.what, '\n'));
    }
    return code;
}

static void truncated_files_are_refused(void **state)
{
    (void)state;
    victim victims[VICTIMS];
    int cut = 0;
    make_victims(victims);
    for (int v = 0; v < VICTIMS; v++) {
        size_t size = victims[v].file.size;
        assert_int_equal(check_damaged(victims[v].file.bytes, size), STATUS_OK);
        size_t step = size / 250 + 1;
        for (size_t length = 0; length < size; length += length + 40 < size ? step : 1, cut++)
            if (check_damaged(victims[v].file.bytes, length) == STATUS_OK)
                fail_msg("%s cut to %zu of %zu bytes is read", victims[v].name, length, size);
        free(victims[v].file.bytes);
    }
    assert_true(cut > 1000);
}

static void corrupted_files_are_refused_or_read_whole(void **state)
{
    (void)state;
    victim victims[VICTIMS];
    uint32_t random = 4711;
    make_victims(victims);
    for (int v = 0; v < VICTIMS; v++) {
        for (int trial = 0; trial < 300; trial++) {
            size_t at = trial < 40 ? (size_t)trial : next_random(&random) % victims[v].file.size;
            char *byte = &victims[v].file.bytes[at], before = *byte;
            *byte = (char)((unsigned char)*byte ^ (1 + next_random(&random) % 255));
            if (check_damaged(victims[v].file.bytes, victims[v].file.size) == STATUS_OK && victims[v].checked)
                fail_msg("%s with byte %zu changed is read", victims[v].name, at);
            *byte = before;
        }
        free(victims[v].file.bytes);
    }
}

static void files_with_many_corruptions_are_refused_or_read_whole(void **state)
{
    (void)state;
    victim victims[VICTIMS];
    uint32_t random = 815;
    make_victims(victims);
    for (int v = 0; v < VICTIMS; v++) {
        char *copy = malloc(victims[v].file.size);
        assert_non_null(copy);
        for (int trial = 0; trial < 100; trial++) {
            memcpy(copy, victims[v].file.bytes, victims[v].file.size);
            for (int change = 0; change < 8; change++)
                copy[next_random(&random) % victims[v].file.size] = (char)next_random(&random);
            check_damaged(copy, victims[v].file.size);
        }
        free(copy);
        free(victims[v].file.bytes);
    }
}

/* ---- failing writes ---- */

static void wrong_requests_are_refused(void **state)
{
    (void)state;
    image *img = make_image(4, 4), *wide, *back;
    diagnostic why = {0};
    char *gif = in_folder("x.gif"), *png = in_folder("x.png"), *jpg = in_folder("x.jpg");
    char *lost = in_folder("none/x.png");
    assert_int_equal(image_write(img, gif, 8, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.file, gif);
    assert_int_equal(image_write(img, png, 12, &why), STATUS_BAD_INPUT);
    assert_int_equal(image_write(img, lost, 8, &why), STATUS_FAILURE);
    assert_string_equal(why.file, lost);
    assert_int_equal(image_create(65536, 1, &wide, NULL), STATUS_OK);
    assert_int_equal(image_write(wide, jpg, 8, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.file, jpg);
    assert_int_equal(image_write(wide, png, 16, &why), STATUS_OK);
    assert_int_equal(image_read(png, &back, NULL, &why), STATUS_OK);
    assert_int_equal(back->width, 65536);
    image_destroy(wide);
    assert_int_equal(image_read(lost, &wide, NULL, &why), STATUS_BAD_INPUT);
    assert_null(wide);
    assert_int_equal(image_write(img, "/dev/null", 8, NULL), STATUS_OK);
    assert_int_equal(image_write(img, "/dev/full", 8, &why), STATUS_FAILURE);
    assert_int_equal(empty_folder(), 1);
    image_destroy(back);
    image_destroy(img);
    free(gif);
    free(png);
    free(jpg);
    free(lost);
}

static void a_full_disk_keeps_the_old_image(void **state)
{
    (void)state;
    static const char *const names[] = {"full.png", "full.jpg", "full.pfm"};
    image *small = make_image(5, 5), *large = make_image(200, 150);
    struct rlimit before, limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    os_signals_as_errors();
    for (int i = 0; i < 3; i++) {
        char *path = in_folder(names[i]);
        diagnostic why = {0};
        assert_int_equal(image_write(small, path, 8, NULL), STATUS_OK);
        blob old = get(path);
        limit = before;
        limit.rlim_cur = 9000;
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
        status code = image_write(large, path, 8, &why);
        setrlimit(RLIMIT_FSIZE, &before);
        assert_int_equal(code, STATUS_FAILURE);
        assert_string_equal(why.file, path);
        assert_true(strstr(why.what, "cannot write") == why.what);
        blob after = get(path);
        assert_int_equal(old.size, after.size);
        assert_memory_equal(old.bytes, after.bytes, old.size);
        free(old.bytes);
        free(after.bytes);
        assert_int_equal(empty_folder(), 1);
        free(path);
    }
    image_destroy(small);
    image_destroy(large);
}

#define file_test(f) cmocka_unit_test_setup_teardown(f, make_folder, remove_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(srgb_has_its_published_values),
        cmocka_unit_test(srgb_agrees_with_libm),
        cmocka_unit_test(the_byte_table_rounds_like_the_curve),
        cmocka_unit_test(the_format_follows_the_file_name_extension),
        cmocka_unit_test(image_sizes_are_limited),
        file_test(png_keeps_every_value),
        file_test(values_out_of_range_are_clamped),
        file_test(the_same_image_gives_the_same_bytes),
        file_test(png_has_an_srgb_chunk_and_no_time),
        file_test(jpeg_is_close_to_the_original),
        file_test(pfm_keeps_every_bit),
        file_test(pfm_is_read_in_either_byte_order),
        file_test(invalid_pfm_is_refused),
        file_test(png_of_every_kind_is_read),
        file_test(huge_png_is_refused),
        file_test(decompression_bombs_are_refused),
        file_test(jpeg_with_a_false_size_is_refused),
        file_test(jpeg_of_other_kinds_is_read),
        file_test(cmyk_jpeg_is_refused),
        file_test(truncated_files_are_refused),
        file_test(corrupted_files_are_refused_or_read_whole),
        file_test(files_with_many_corruptions_are_refused_or_read_whole),
        file_test(wrong_requests_are_refused),
        file_test(a_full_disk_keeps_the_old_image),
    };
    return cmocka_run_group_tests_name("image", tests, NULL, NULL);
}
