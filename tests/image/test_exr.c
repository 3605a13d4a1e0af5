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
#include <math.h>
#include <zlib.h>

/* Tests of OpenEXR. Files that are read are written here, and files that are written are read here, byte by byte after
 * "OpenEXR File Layout" (openexr.com), without the library. */

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

/* ---- files, written by hand ---- */

enum { UINT, HALF, FLOAT };
enum { UNCOMPRESSED, ZIP = 3, DWAA = 8, COMPRESSIONS };
static const int lines_of_chunk[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
enum { FILE_MAX = 1 << 16, VERSION = 2, FLAG_TILED = 0x200 };

typedef struct exr_file {
    unsigned char bytes[FILE_MAX];
    size_t size;
} exr_file;

/* What a file has. data, display: left, top, right, bottom, inclusive. names: sorted. tile: side, 0 for scan lines.
 * step: of the channels RY and BY. values: of each channel everywhere (FLOAT), instead of value_at.
 * lacking: bytes that chunks lack, as if they were compressed. */
typedef struct exr_kind {
    int type, data[4], display[4], tile, step, compression, lacking;
    const char *names[8];
    const float *chromaticities, *values;
} exr_kind;

static void put(exr_file *f, const void *bytes, size_t size)
{
    assert_true(f->size + size <= FILE_MAX);
    memcpy(f->bytes + f->size, bytes, size);
    f->size += size;
}

static void put_number(exr_file *f, uint64_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        put(f, &(unsigned char){(unsigned char)(value >> 8 * i)}, 1);
}

static void put_float(exr_file *f, float value)
{
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    put_number(f, word, 4);
}

static void put_word(exr_file *f, const char *word)
{
    put(f, word, strlen(word) + 1);
}

static void put_attribute(exr_file *f, const char *name, const char *type, size_t size)
{
    put_word(f, name);
    put_word(f, type);
    put_number(f, size, 4);
}

static void put_box(exr_file *f, const char *name, const int box[4])
{
    put_attribute(f, name, "box2i", 16);
    for (int i = 0; i < 4; i++)
        put_number(f, (uint32_t)box[i], 4);
}

static int step_of(const exr_kind *k, const char *name)
{
    return k->step && name[1] == 'Y' ? k->step : 1;
}

static void put_channels(exr_file *f, const exr_kind *k)
{
    size_t size = 1;
    for (int i = 0; k->names[i]; i++)
        size += strlen(k->names[i]) + 17;
    put_attribute(f, "channels", "chlist", size);
    for (int i = 0; k->names[i]; i++) {
        put_word(f, k->names[i]);
        put_number(f, (unsigned)k->type, 4);
        put_number(f, 0, 4);
        put_number(f, (unsigned)step_of(k, k->names[i]), 4);
        put_number(f, (unsigned)step_of(k, k->names[i]), 4);
    }
    put_number(f, 0, 1);
}

static void put_header(exr_file *f, const exr_kind *k)
{
    put_number(f, 20000630, 4);
    put_number(f, VERSION | (k->tile ? FLAG_TILED : 0), 4);
    put_channels(f, k);
    if (k->chromaticities) {
        put_attribute(f, "chromaticities", "chromaticities", 32);
        for (int i = 0; i < 8; i++)
            put_float(f, k->chromaticities[i]);
    }
    put_attribute(f, "compression", "compression", 1), put_number(f, (unsigned)k->compression, 1);
    put_box(f, "dataWindow", k->data);
    put_box(f, "displayWindow", k->display);
    put_attribute(f, "lineOrder", "lineOrder", 1), put_number(f, 0, 1);
    put_attribute(f, "pixelAspectRatio", "float", 4), put_float(f, 1);
    put_attribute(f, "screenWindowCenter", "v2f", 8), put_number(f, 0, 8);
    put_attribute(f, "screenWindowWidth", "float", 4), put_float(f, 1);
    if (k->tile) {
        put_attribute(f, "tiles", "tiledesc", 9);
        put_number(f, (unsigned)k->tile, 4), put_number(f, (unsigned)k->tile, 4), put_number(f, 0, 1);
    }
    put_number(f, 0, 1);
}

/* A whole number below 2048, which each type holds exactly, for each channel and position. */
static int value_at(char channel, int x, int y)
{
    return channel == 'A' ? (x + y + 3000) % 3 : 1 + ((x + 1000) * 37 + (y + 1000) * 101 + channel * 29) % 2000;
}

static unsigned half_of(int whole)
{
    int exponent = 0;
    while (whole >> (exponent + 1))
        exponent++;
    return whole ? (unsigned)(exponent + 15) << 10 | ((unsigned)whole << 10 >> exponent & 1023U) : 0;
}

static void put_value(exr_file *f, int type, int whole)
{
    if (type == FLOAT)
        put_float(f, (float)whole);
    else
        put_number(f, type == HALF ? half_of(whole) : (unsigned)whole, type == HALF ? 2 : 4);
}

/* The lines y0 <= y < y1 of the columns x0 <= x < x1; returns their number of bytes. */
static size_t put_lines(exr_file *f, const exr_kind *k, int x0, int y0, int x1, int y1)
{
    const size_t before = f->size;
    for (int y = y0; y < y1; y++)
        for (int i = 0; k->names[i]; i++) {
            const int step = step_of(k, k->names[i]);
            const char *letter = strrchr(k->names[i], '.');
            for (int x = x0; x < x1 && y % step == 0; x += step)
                if (k->values)
                    put_float(f, k->values[i]);
                else
                    put_value(f, k->type, value_at(letter ? letter[1] : k->names[i][0], x, y));
        }
    return f->size - before;
}

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

static void set_number(exr_file *f, size_t at, uint64_t value, int bytes)
{
    exr_file patch = {.size = 0};
    put_number(&patch, value, bytes);
    memcpy(f->bytes + at, patch.bytes, patch.size);
}

static exr_file *make(const exr_kind *k)
{
    exr_file *f = calloc(1, sizeof *f);
    assert_non_null(f);
    const int width = k->data[2] - k->data[0] + 1, height = k->data[3] - k->data[1] + 1;
    const int side = k->tile ? k->tile : width, lines = k->tile ? k->tile : lines_of_chunk[k->compression];
    put_header(f, k);
    const size_t table = f->size;
    if (width > FILE_MAX) /* refused before its lines are read */
        return f;
    size_t chunk = 0;
    put_number(f, 0, 8), f->size = table + 8 * (size_t)(((width - 1) / side + 1) * ((height - 1) / lines + 1));
    for (int y = 0; y < height; y += lines)
        for (int x = 0; x < width; x += side, chunk++) {
            set_number(f, table + 8 * chunk, f->size, 8);
            if (k->tile)
                put_number(f, (unsigned)(x / side), 4), put_number(f, (unsigned)(y / lines), 4), put_number(f, 0, 8);
            else
                put_number(f, (uint32_t)(k->data[1] + y), 4);
            const size_t at = f->size;
            put_number(f, 0, 4);
            const size_t bytes = put_lines(f, k, k->data[0] + x, k->data[1] + y, k->data[0] + smaller(x + side, width),
                                           k->data[1] + smaller(y + lines, height));
            set_number(f, at, bytes - (size_t)k->lacking, 4);
        }
    return f;
}

/* ---- reading ---- */

static image *read_file(const exr_file *f)
{
    image *img = NULL;
    diagnostic why = {0};
    int bits;
    worked(image_decode(f->bytes, f->size, IMAGE_LIGHT, &img, &bits, &why), &why);
    assert_int_equal(bits, 32);
    return img;
}

static bool covers(const int box[4], int x, int y)
{
    return x >= box[0] && y >= box[1] && x <= box[2] && y <= box[3];
}

/* letters: the channels that must appear as red, green, blue, and alpha if there is a fourth. */
static void is_read(const exr_kind *k, const char *letters)
{
    exr_file *f = make(k);
    image *img = read_file(f);
    assert_int_equal(img->width, k->display[2] - k->display[0] + 1);
    assert_int_equal(img->height, k->display[3] - k->display[1] + 1);
    assert_true((img->alpha != NULL) == (letters[3] == 'A'));
    for (int y = 0; y < img->height; y++)
        for (int x = 0; x < img->width; x++) {
            const int column = k->display[0] + x, line = k->display[1] + y;
            const bool inside = covers(k->data, column, line);
            const size_t at = (size_t)(y * img->width + x);
            const int alpha = letters[3] && inside ? value_at('A', column, line) : 1; /* 0, 1 or 2: 2 counts as 1 */
            for (int c = 0; c < 3; c++)
                assert_true(img->pixel[3 * at + (size_t)c] ==
                            (inside ? (float)value_at(letters[c], column, line) : 0.0F));
            if (img->alpha)
                assert_true(img->alpha[at] == (inside && alpha > 0 ? 1.0F : 0.0F));
        }
    image_destroy(img);
    free(f);
}

static void every_type_window_and_tile_is_read(void **state)
{
    (void)state;
    static const int windows[][8] = {
        {0, 0, 12, 9, 0, 0, 12, 9},
        {-3, -5, 9, 4, -3, -5, 9, 4},
        {2, 3, 6, 5, 0, 0, 12, 9},
        {-4, -4, 20, 20, 0, 0, 12, 9},
        {5, -6, 30, 4, 0, 0, 12, 9},
        {20, 20, 25, 25, 0, 0, 12, 9},
        {1000, 2000, 1004, 2003, 998, 1999, 1002, 2001},
    };
    static const int tiles[] = {0, 1, 4, 64};
    for (size_t w = 0; w < COUNT(windows); w++)
        for (size_t t = 0; t < COUNT(tiles); t++)
            for (int type = UINT; type <= FLOAT; type++)
                for (int alpha = 0; alpha < 2; alpha++) {
                    exr_kind k = {.type = type, .tile = tiles[t], .names = {"A", "B", "G", "R", "Z"}};
                    memcpy(k.data, windows[w], sizeof k.data);
                    memcpy(k.display, windows[w] + 4, sizeof k.display);
                    if (!alpha)
                        k.names[0] = "B", k.names[1] = "G", k.names[2] = "R", k.names[3] = NULL;
                    is_read(&k, alpha ? "RGBA" : "RGB");
                }
}

/* A chunk that compression would not shrink is stored as it is. */
static void chunks_that_were_not_compressed_are_read(void **state)
{
    (void)state;
    for (int compression = UNCOMPRESSED; compression < COMPRESSIONS; compression++)
        for (int type = UINT; type <= FLOAT; type++)
            is_read(&(exr_kind){.type = type,
                                .data = {0, 0, 12, 69},
                                .display = {0, 0, 12, 69},
                                .compression = compression,
                                .names = {"A", "B", "G", "R"}},
                    "RGBA");
}

#define PLAIN .type = HALF, .data = {0, 0, 5, 3}, .display = {0, 0, 5, 3}

static void colours_are_chosen_by_the_rule(void **state)
{
    (void)state;
    is_read(&(exr_kind){PLAIN, .names = {"B", "G", "R", "a.B", "a.G", "a.R"}}, "RGB");
    is_read(&(exr_kind){PLAIN, .names = {"Y", "b.R", "view.left.A", "view.left.B", "view.left.G", "view.left.R"}},
            "RGBA");
    is_read(&(exr_kind){PLAIN, .names = {"A", "Y", "depth.Z"}}, "YYYA");
    is_read(&(exr_kind){PLAIN, .names = {"B", "Y"}}, "YYY");
    is_read(&(exr_kind){PLAIN, .names = {"depth.Z"}}, "ZZZ");
}

static void colours_are_divided_by_alpha(void **state)
{
    (void)state;
    const float values[] = {0.25F, 0.125F, -0.5F, 3.0F};
    exr_file *f = make(&(exr_kind){.type = FLOAT, .names = {"A", "B", "G", "R"}, .values = values});
    image *img = read_file(f);
    assert_true(img->alpha[0] == 0.25F && img->pixel[0] == 12.0F && img->pixel[1] == -2.0F && img->pixel[2] == 0.5F);
    image_destroy(img);
    free(f);
}

/* With CIE XYZ as primaries the values are X, Y and Z: white of D65 is white. */
static void primaries_become_those_of_srgb(void **state)
{
    (void)state;
    static const float srgb[] = {0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F},
                       xyz[] = {1, 0, 0, 1, 0, 0, 1.0F / 3, 1.0F / 3},
                       line[] = {0.1F, 0.1F, 0.2F, 0.2F, 0.3F, 0.3F, 0.3F, 0.3F},
                       white[] = {0.3583F / 0.3290F, 1.0F, 0.3127F / 0.3290F}; /* Z, Y, X of D65: B, G, R */
    is_read(&(exr_kind){PLAIN, .names = {"B", "G", "R"}, .chromaticities = srgb}, "RGB");
    exr_file *f = make(&(exr_kind){.type = FLOAT, .names = {"B", "G", "R"}, .chromaticities = xyz, .values = white});
    image *img = read_file(f);
    for (int c = 0; c < 3; c++)
        assert_float_equal(img->pixel[c], 1.0F, 1e-6F);
    image_destroy(img);
    free(f);
    f = make(&(exr_kind){PLAIN, .names = {"B", "G", "R"}, .chromaticities = line});
    image *none = NULL;
    diagnostic why = {0};
    assert_int_equal(codec_exr_read(f->bytes, f->size, &none, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "on one line"));
    free(f);
}

/* Chroma that is the same everywhere stays so between its samples, up to the sum of the filter's weights. */
static void chroma_becomes_colour(void **state)
{
    (void)state;
    static const float values[] = {-0.25F, 0.5F, 4.0F};
    exr_file *f = make(&(exr_kind){.type = FLOAT,
                                   .data = {-2, 0, 37, 35},
                                   .display = {1, 2, 36, 33},
                                   .names = {"BY", "RY", "Y"},
                                   .step = 2,
                                   .values = values});
    image *img = read_file(f);
    for (int i = 0; i < img->width * img->height; i++) {
        const float *rgb = img->pixel + 3 * i;
        assert_float_equal(rgb[0], 6.0F, 1e-4F); /* (RY + 1) Y */
        assert_float_equal(rgb[2], 3.0F, 1e-4F);
        assert_float_equal(0.2126F * rgb[0] + 0.7152F * rgb[1] + 0.0722F * rgb[2], 4.0F, 1e-3F); /* BT.709 */
    }
    image_destroy(img);
    free(f);
}

/* ---- refused files ---- */

static void refused(const unsigned char *bytes, size_t size, const char *word)
{
    image *img = (image *)1;
    diagnostic why = {0};
    char message[DIAGNOSTIC_TEXT_MAX];
    unsigned char *copy = malloc(size ? size : 1); /* of exact size, so that the address sanitizer sees reads beyond */
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    assert_int_equal(codec_exr_read(copy, size, &img, &why), STATUS_BAD_INPUT);
    assert_null(img);
    diagnostic_text(&why, message, sizeof message);
    if (!strstr(message, word) || strchr(message, '\n') || !why.remedy[0])
        fail_msg("'%s' has no '%s'", message, word);
    free(copy);
}

static void what_cannot_be_shown_is_refused_with_the_reason(void **state)
{
    (void)state;
    static const struct {
        exr_kind kind;
        const char *word;
    } kinds[] = {
        {{PLAIN, .names = {"X", "Z"}}, "no layer of it has channels R, G and B"},
        {{PLAIN, .names = {"RY"}, .step = 2}, "every 2 columns and 2 lines"},
        {{PLAIN, .names = {"B", "G", "R"}, .compression = DWAA, .lacking = 1}, "DWAA"},
        {{PLAIN, .names = {"B", "G", "R"}, .compression = ZIP, .lacking = 1}, "is damaged"},
        {{.type = HALF, .data = {0, 0, 70000, 0}, .display = {0, 0, 5, 5}, .names = {"Y"}}, "70001"},
    };
    for (size_t i = 0; i < COUNT(kinds); i++) {
        exr_file *f = make(&kinds[i].kind);
        refused(f->bytes, f->size, kinds[i].word);
        free(f);
    }
}

static void values_that_are_not_finite_are_refused(void **state)
{
    (void)state;
    exr_file *f = make(&(exr_kind){PLAIN, .names = {"Y"}});
    f->size -= 2;
    put_number(f, 0x7C00, 2); /* infinity */
    refused(f->bytes, f->size, "column 5, row 3 from the top is not a finite number");
    free(f);
}

static void truncated_and_corrupted_files_are_read_or_refused(void **state)
{
    (void)state;
    static const exr_kind kinds[] = {{PLAIN, .names = {"A", "B", "G", "R"}}, {PLAIN, .tile = 4, .names = {"Y"}}};
    for (size_t i = 0; i < COUNT(kinds); i++) {
        exr_file *f = make(&kinds[i]);
        for (size_t size = 0; size < f->size; size++)
            refused(f->bytes, size, "");
        for (size_t at = 0; at < f->size; at++)
            for (int bit = 0; bit < 8; bit++) {
                image *img = NULL;
                diagnostic why = {0};
                f->bytes[at] ^= (unsigned char)(1 << bit);
                const status code = codec_exr_read(f->bytes, f->size, &img, &why);
                assert_true(code == STATUS_OK ? img != NULL : !img && why.what[0] && why.remedy[0]);
                image_destroy(img);
                f->bytes[at] ^= (unsigned char)(1 << bit);
            }
        free(f);
    }
}

/* ---- written files, read by hand ---- */

typedef struct found {
    const unsigned char *at, *end;
    const char *names[32]; /* sorted */
    int count, width, height;
    float *values; /* [channel][pixel] */
    char text[64];
} found;

static uint64_t number_at(const unsigned char *at, int bytes)
{
    uint64_t value = 0;
    for (int i = 0; i < bytes; i++)
        value |= (uint64_t)at[i] << 8 * i;
    return value;
}

static void find_channels(found *o, const unsigned char *at)
{
    for (; *at; at += strlen((const char *)at) + 17) {
        o->names[o->count++] = (const char *)at;
        const unsigned char *about = at + strlen((const char *)at) + 1;
        assert_int_equal(number_at(about, 4), FLOAT);
        assert_int_equal(number_at(about + 8, 4), 1);
    }
}

static const unsigned char *read_header(found *o, const unsigned char *at)
{
    assert_int_equal(number_at(at, 4), 20000630);
    assert_int_equal(number_at(at + 4, 4), VERSION);
    for (at += 8; *at;) {
        const char *name = (const char *)at, *type = name + strlen(name) + 1;
        const unsigned char *size = (const unsigned char *)type + strlen(type) + 1, *value = size + 4;
        at = value + number_at(size, 4);
        if (strcmp(name, "channels") == 0)
            find_channels(o, value);
        if (strcmp(name, "dataWindow") == 0)
            o->width = (int)number_at(value + 8, 4) + 1, o->height = (int)number_at(value + 12, 4) + 1;
        if (strcmp(name, "compression") == 0)
            assert_int_equal(*value, ZIP);
        if (strcmp(name, "Cuvette scene") == 0)
            snprintf(o->text, sizeof o->text, "%.*s", (int)(at - value), (const char *)value);
    }
    return at + 1;
}

/* ZIP: deflate, then sums of neighbouring bytes, then the two halves of the bytes in turn. */
static void unpack(const unsigned char *packed, size_t size, unsigned char *bytes, size_t count)
{
    unsigned char *sums = malloc(count);
    uLongf got = count;
    assert_non_null(sums);
    if (size == count) { /* not worth it */
        memcpy(bytes, packed, count);
        free(sums);
        return;
    }
    assert_int_equal(uncompress(sums, &got, packed, size), Z_OK);
    assert_int_equal(got, count);
    for (size_t i = 1; i < count; i++)
        sums[i] = (unsigned char)(sums[i - 1] + sums[i] - 128);
    for (size_t i = 0; i < count; i++)
        bytes[i] = sums[i % 2 ? (count + 1) / 2 + i / 2 : i / 2];
    free(sums);
}

static found read_written(const unsigned char *bytes, size_t size)
{
    found o = {.count = 0};
    const unsigned char *table = read_header(&o, bytes);
    const size_t pixels = (size_t)o.width * (size_t)o.height;
    unsigned char *lines = malloc(16 * (size_t)o.width * (size_t)o.count * 4);
    o.values = malloc(pixels * (size_t)o.count * sizeof *o.values);
    assert_true(lines && o.values);
    for (int y0 = 0; y0 < o.height; y0 += 16, table += 8) {
        const unsigned char *chunk = bytes + number_at(table, 8);
        const int height = smaller(16, o.height - y0);
        assert_true(chunk + 8 <= bytes + size && chunk + 8 + number_at(chunk + 4, 4) <= bytes + size);
        assert_int_equal(number_at(chunk, 4), y0);
        unpack(chunk + 8, (size_t)number_at(chunk + 4, 4), lines, (size_t)(height * o.width * o.count) * 4);
        const unsigned char *at = lines;
        for (int y = y0; y < y0 + height; y++)
            for (int c = 0; c < o.count; c++)
                for (int x = 0; x < o.width; x++, at += 4) {
                    const uint32_t word = (uint32_t)number_at(at, 4);
                    memcpy(&o.values[(size_t)c * pixels + (size_t)(y * o.width + x)], &word, 4);
                }
    }
    free(lines);
    return o;
}

static float twice(const void *of, size_t pixel)
{
    return 2.0F * ((const float *)of)[pixel];
}

static image *random_image(int width, int height)
{
    image *img = NULL;
    diagnostic why = {0};
    uint64_t seed = 7;
    worked(image_create(width, height, &img, &why), &why);
    for (int i = 0; i < 3 * width * height; i++)
        img->pixel[i] = (float)ldexp(random_real(&seed, -0.25, 0.75), random_below(&seed, 60) - 30);
    return img;
}

static void written_values_names_and_texts_are_exact(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {7, 16}, {33, 17}, {64, 50}};
    for (size_t s = 0; s < COUNT(sizes); s++) {
        image *img = random_image(sizes[s][0], sizes[s][1]), *back = NULL;
        const image_channel channels[] = {{"depth.Z", twice, img->pixel}, {"Aux.V", twice, img->pixel + 1}};
        const image_text text = {"Cuvette scene", "solids: {}"};
        image_rows rows = image_rows_of(img);
        unsigned char *bytes = NULL, *again = NULL;
        size_t size, size_again;
        diagnostic why = {0};
        rows.channels = channels, rows.channel_count = COUNT(channels);
        rows.texts = &text, rows.text_count = 1;
        worked(image_encode_rows(&rows, IMAGE_EXR, 8, false, &bytes, &size, &why), &why);
        worked(image_encode_rows(&rows, IMAGE_EXR, 8, false, &again, &size_again, &why), &why);
        assert_true(size == size_again && memcmp(bytes, again, size) == 0);
        found o = read_written(bytes, size);
        static const char *const names[] = {"Aux.V", "B", "G", "R", "depth.Z"};
        assert_int_equal(o.count, 5);
        assert_string_equal(o.text, "solids: {}");
        const size_t pixels = (size_t)(o.width * o.height);
        assert_true(o.width == img->width && o.height == img->height);
        for (int c = 0; c < 5; c++)
            assert_string_equal(o.names[c], names[c]);
        for (size_t i = 0; i < pixels; i++) {
            for (size_t c = 0; c < 3; c++)
                assert_true(o.values[(3 - c) * pixels + i] == img->pixel[3 * i + c]);
            assert_true(o.values[i] == 2.0F * img->pixel[i + 1]);
            assert_true(o.values[4 * pixels + i] == 2.0F * img->pixel[i]);
        }
        worked(image_decode(bytes, size, IMAGE_LIGHT, &back, NULL, &why), &why);
        assert_memory_equal(back->pixel, img->pixel, 3 * pixels * sizeof(float));
        char *kept = NULL;
        worked(image_text_read(bytes, size, "Cuvette scene", 100, &kept, &why), &why);
        assert_string_equal(kept, "solids: {}");
        free(kept);
        assert_int_equal(image_text_read(bytes, size, "Cuvette scene", 5, &kept, &why), STATUS_BAD_INPUT);
        assert_null(kept);
        free(o.values), free(bytes), free(again);
        image_destroy(img);
        image_destroy(back);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type_window_and_tile_is_read),
        cmocka_unit_test(chunks_that_were_not_compressed_are_read),
        cmocka_unit_test(colours_are_chosen_by_the_rule),
        cmocka_unit_test(colours_are_divided_by_alpha),
        cmocka_unit_test(primaries_become_those_of_srgb),
        cmocka_unit_test(chroma_becomes_colour),
        cmocka_unit_test(what_cannot_be_shown_is_refused_with_the_reason),
        cmocka_unit_test(values_that_are_not_finite_are_refused),
        cmocka_unit_test(truncated_and_corrupted_files_are_read_or_refused),
        cmocka_unit_test(written_values_names_and_texts_are_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
