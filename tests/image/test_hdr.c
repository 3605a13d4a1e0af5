#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "base/text.h"
#include "image/codec.h"
#include "lint/lint.h"
#include "random_stream.h"
#include "render_fixture.h"
#include <unistd.h>

/* Tests of Radiance's HDR files, written here as Ward describes them: plain pixels, old and new run lengths, each order
 * of rows and columns, and the lines of the header; and of skies that are such files. */

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

typedef struct buffer {
    unsigned char bytes[1 << 16];
    size_t size;
} buffer;

static void add(buffer *to, const void *bytes, size_t size)
{
    assert_true(to->size + size <= sizeof to->bytes);
    memcpy(to->bytes + to->size, bytes, size);
    to->size += size;
}

static void add_text(buffer *to, const char *text)
{
    add(to, text, strlen(text));
}

static void add_byte(buffer *to, int value)
{
    add(to, &(unsigned char){(unsigned char)value}, 1);
}

static void start(buffer *to, const char *lines, const char *resolution)
{
    to->size = 0;
    add_text(to, "#?RADIANCE\n");
    add_text(to, lines);
    add_text(to, "\n");
    add_text(to, resolution);
    add_text(to, "\n");
}

static image *read_hdr(const buffer *file)
{
    image *img = NULL;
    diagnostic why = {.what = ""};
    if (codec_hdr_read(file->bytes, file->size, &img, &why) != STATUS_OK)
        fail_msg("%s", why.what);
    return img;
}

static void refused(const buffer *file, const char *word)
{
    image *img = (image *)1;
    diagnostic why = {.what = ""};
    assert_int_equal(codec_hdr_read(file->bytes, file->size, &img, &why), STATUS_BAD_INPUT);
    assert_null(img);
    if (!strstr(why.what, word) || !why.remedy[0])
        fail_msg("'%s; %s' has no '%s'", why.what, why.remedy, word);
}

/* ---- pixels ---- */

enum { WIDTH = 200, HEIGHT = 5 };
typedef unsigned char pixels[HEIGHT][WIDTH][4];

/* Parts of equal and of changing pixels; none has the mantissas 1, 1, 1, which the old way reserves. */
static void fill(pixels p)
{
    uint64_t seed = 11;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int c = 0; c < 4; c++)
                p[y][x][c] = (unsigned char)(x / 30 % 2 && x % 30 ? p[y][x - 1][c]
                                             : c == 3             ? 100 + random_below(&seed, 50)
                                                                  : 3 + random_below(&seed, 250));
    memset(p[1][7], 0, 4); /* exponent 0 is black whatever the mantissas */
    memset(p[2][9], 200, 3), p[2][9][3] = 0;
}

static void are_the_pixels(const image *img, pixels p)
{
    assert_true(img->width == WIDTH && img->height == HEIGHT);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int c = 0; c < 3; c++) {
                const unsigned char *rgbe = p[y][x];
                const double right = rgbe[3] ? rgbe[c] / 256.0 * pow(2.0, rgbe[3] - 128) : 0.0;
                assert_true((double)img->pixel[(y * WIDTH + x) * 3 + c] == right);
            }
}

static bool same_pixel(const unsigned char *a, const unsigned char *b)
{
    return memcmp(a, b, 4) == 0;
}

static void add_old_runs(buffer *to, const unsigned char row[WIDTH][4])
{
    for (int x = 0; x < WIDTH;) {
        int count = 0;
        add(to, row[x++], 4);
        while (x + count < WIDTH && same_pixel(row[x - 1], row[x + count]))
            count++;
        if (count > 0)
            add(to, (unsigned char[]){1, 1, 1, (unsigned char)count}, 4);
        x += count;
    }
}

static void add_new_runs(buffer *to, const unsigned char row[WIDTH][4])
{
    add(to, (unsigned char[]){2, 2, WIDTH >> 8, WIDTH & 255}, 4);
    for (int c = 0; c < 4; c++)
        for (int x = 0; x < WIDTH;) {
            int count = 1;
            while (x + count < WIDTH && count < 127 && row[x + count][c] == row[x][c])
                count++;
            if (count > 2) {
                add_byte(to, 128 + count);
                add_byte(to, row[x][c]);
            } else {
                add_byte(to, count);
                for (int i = 0; i < count; i++)
                    add_byte(to, row[x + i][c]);
            }
            x += count;
        }
}

static void each_way_of_storing_pixels_is_read(void **state)
{
    (void)state;
    static pixels p;
    static buffer file;
    fill(p);
    for (int way = 0; way < 4; way++) {
        start(&file, "FORMAT=32-bit_rle_rgbe\n", "-Y 5 +X 200");
        for (int y = 0; y < HEIGHT; y++) {
            const int how = way < 3 ? way : y % 3; /* each row may have its own */
            if (how == 0)
                add(&file, p[y], sizeof p[y]);
            else if (how == 1)
                add_old_runs(&file, (const unsigned char(*)[4])p[y]);
            else
                add_new_runs(&file, (const unsigned char(*)[4])p[y]);
        }
        image *img = read_hdr(&file);
        are_the_pixels(img, p);
        image_destroy(img);
        for (size_t size = 0; size < file.size; size += 1 + size / 100) {
            static buffer cut;
            memcpy(cut.bytes, file.bytes, size);
            cut.size = size;
            refused(&cut, size < 49 ? "" : "in row");
        }
    }
}

/* Counts above 255 need several repetitions: the second is in units of 256. */
static void long_old_runs_are_read(void **state)
{
    (void)state;
    static buffer file;
    start(&file, "", "-Y 1 +X 600");
    add(&file, (unsigned char[]){128, 64, 32, 129, 1, 1, 1, 0x57, 1, 1, 1, 2}, 12);
    image *img = read_hdr(&file);
    for (int x = 0; x < 600; x++)
        assert_true(img->pixel[3 * x] == 1.0F && img->pixel[3 * x + 1] == 0.5F && img->pixel[3 * x + 2] == 0.25F);
    image_destroy(img);
    file.bytes[file.size - 1] = 3;
    refused(&file, "damaged in row 0");
    start(&file, "", "-Y 1 +X 4");
    add(&file, (unsigned char[]){1, 1, 1, 4}, 4);
    refused(&file, "row 0"); /* nothing to repeat */
    start(&file, "", "-Y 1 +X 8");
    add(&file, (unsigned char[]){2, 2, 0, 9, 136, 1, 136, 1, 136, 1, 136, 1}, 12);
    refused(&file, "row 0"); /* another width */
    file.bytes[file.size - 9] = 8;
    file.bytes[file.size - 8] = 137;
    refused(&file, "row 0"); /* a run beyond the row */
}

static void each_order_of_rows_and_columns_is_turned_upright(void **state)
{
    (void)state;
    static const struct {
        const char *resolution, *upright;
    } kinds[] = {
        {"-Y 2 +X 3", "abc/def"},  {"-Y 2 -X 3", "cba/fed"},  {"+Y 2 -X 3", "fed/cba"},  {"+Y 2 +X 3", "def/abc"},
        {"+X 2 -Y 3", "ad/be/cf"}, {"-X 2 -Y 3", "da/eb/fc"}, {"-X 2 +Y 3", "fc/eb/da"}, {"+X 2 +Y 3", "cf/be/ad"},
    };
    for (size_t k = 0; k < COUNT(kinds); k++) {
        static buffer file;
        start(&file, "FORMAT=32-bit_rle_rgbe\n", kinds[k].resolution);
        for (int i = 0; i < 6; i++)
            add(&file, (unsigned char[]){(unsigned char)(8 * i), 5, 5, 136}, 4);
        image *img = read_hdr(&file);
        assert_int_equal(img->width, k < 4 ? 3 : 2);
        for (int i = 0; i < 6; i++)
            assert_true(img->pixel[3 * i] ==
                        (float)(8 * (kinds[k].upright[i / img->width * (img->width + 1) + i % img->width] - 'a')));
        image_destroy(img);
    }
}

/* ---- the header ---- */

static void has_pixel(const char *lines, double r, double g, double b, double tolerance)
{
    static buffer file;
    start(&file, lines, "-Y 1 +X 1");
    add(&file, (unsigned char[]){128, 64, 32, 130}, 4); /* 2, 1, 0.5 */
    image *img = read_hdr(&file);
    const double right[3] = {r, g, b};
    for (int c = 0; c < 3; c++)
        if (!(fabs((double)img->pixel[c] - right[c]) <= tolerance))
            fail_msg("%s: channel %d is %g, not %g", lines, c, (double)img->pixel[c], right[c]);
    image_destroy(img);
}

static void the_lines_of_the_header_apply(void **state)
{
    (void)state;
    has_pixel("", 2, 1, 0.5, 0);
    has_pixel("# a comment\nVIEW= -vtl\nSOFTWARE=x\nPIXASPECT=2\nGAMMA=1.0\r\n", 2, 1, 0.5, 0);
    has_pixel("EXPOSURE=4\n", 0.5, 0.25, 0.125, 0);
    has_pixel("EXPOSURE=4\nEXPOSURE= 0.5\nCOLORCORR=1 2 0.25\n", 1, 0.25, 1, 0);
    has_pixel("PRIMARIES=0.64 0.33 0.30 0.60 0.15 0.06 0.3127 0.3290\n", 2, 1, 0.5, 0);
    /* ITU-R BT.2087-0 */
    has_pixel("PRIMARIES= .708 .292 .170 .797 .131 .046 .3127 .3290\n", 2 * 1.6605 - 0.5876 - 0.0364,
              -2 * 0.1246 + 1.1329 - 0.00415, -2 * 0.0182 - 0.1006 + 0.5 * 1.1187, 3e-4);
    /* CIE XYZ to sRGB: IEC 61966-2-1, 5.2 */
    has_pixel("FORMAT=32-bit_rle_xyze\n", 3.2406 * 2 - 1.5372 - 0.4986 / 2, fmax(0, -0.9689 * 2 + 1.8758 + 0.0415 / 2),
              0.0557 * 2 - 0.2040 + 1.0570 / 2, 1e-3);
}

/* Finite, though the matrix enlarges the largest values that a file can have. */
static void the_largest_values_stay_finite(void **state)
{
    (void)state;
    static buffer file;
    start(&file, "EXPOSURE=0.5\nPRIMARIES= .708 .292 .170 .797 .131 .046 .3127 .3290\n", "-Y 1 +X 1");
    add(&file, (unsigned char[]){255, 0, 0, 255}, 4);
    image *img = read_hdr(&file);
    for (int c = 0; c < 3; c++)
        assert_true(isfinite(img->pixel[c]) && img->pixel[c] >= 0.0F);
    image_destroy(img);
}

static void wrong_headers_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *lines, *resolution, *word;
    } kinds[] = {
        {"FORMAT=32-bit_rle_luv\n", "-Y 1 +X 1", "unknown format 32-bit_rle_luv"},
        {"GAMMA=2.2\n", "-Y 1 +X 1", "gamma 2.2"},
        {"EXPOSURE=0\n", "-Y 1 +X 1", "EXPOSURE=0"},
        {"EXPOSURE=x\n", "-Y 1 +X 1", "EXPOSURE=x"},
        {"COLORCORR=1 2\n", "-Y 1 +X 1", "COLORCORR=1 2"},
        {"PRIMARIES=0 0 0 0 0 0 0 0\n", "-Y 1 +X 1", "span no colours"},
        {"", "-Y 1", "no resolution"},
        {"", "-Y 1 -Y 1", "no resolution"},
        {"", "-Y 0 +X 1", "1 x 0 pixels"},
        {"", "-Y 99999 +X 1", "1 x 99999 pixels"},
        {"", "-Y 65536 +X 4096", "in only"},
        {"EXPOSURE=1e-30\nEXPOSURE=1e-30\n", "-Y 1 +X 1", "too large"},
    };
    for (size_t k = 0; k < COUNT(kinds); k++) {
        static buffer file;
        start(&file, kinds[k].lines, kinds[k].resolution);
        add(&file, (unsigned char[]){128, 64, 32, 130}, 4);
        refused(&file, kinds[k].word);
    }
}

static void corrupted_files_are_read_or_refused(void **state)
{
    (void)state;
    static pixels p;
    static buffer file;
    uint64_t seed = 5;
    fill(p);
    start(&file, "FORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n", "-Y 5 +X 200");
    for (int y = 0; y < HEIGHT; y++)
        y % 2 ? add_old_runs(&file, (const unsigned char(*)[4])p[y])
              : add_new_runs(&file, (const unsigned char(*)[4])p[y]);
    for (int k = 0; k < 5000; k++) {
        unsigned char *copy = malloc(file.size); /* of exact size, so that instruments see a read beyond its end */
        image *img;
        diagnostic why = {0};
        assert_non_null(copy);
        memcpy(copy, file.bytes, file.size);
        for (int change = 0; change < 1 + k % 6; change++)
            copy[2 + random_below(&seed, k % 2 ? 60 : (int)file.size - 2)] = (unsigned char)random_below(&seed, 256);
        const status code = codec_hdr_read(copy, file.size, &img, &why);
        assert_true(code == STATUS_OK ? img != NULL : code == STATUS_BAD_INPUT && !img && why.what[0]);
        if (code == STATUS_OK)
            image_destroy(img);
        free(copy);
    }
}

/* ---- skies and textures ---- */

static char path[] = "/tmp/test_hdr_XXXXXX";

static void put_file(const void *bytes, size_t size)
{
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(bytes, 1, size, out), size);
    assert_int_equal(fclose(out), 0);
}

static scene *scene_of(const char *format, ...) __attribute__((format(printf, 1, 2)));
static scene *scene_of(const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return scene_from(text);
}

static void get_center(const char *settings, float rgb[3])
{
    scene *s = scene_of("render: {width: 3, height: 3}\ncamera: {position: [0, 0, 0], target: [0, 0, 1], fov_deg: 1}\n"
                        "background: {image: %s, %s}\n",
                        path, settings);
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    render_result *r = render(s);
    film_read(r->img, 1, 1, 2, 2, rgb, 3);
    render_result_destroy(r);
    scene_destroy(s);
}

/* A pixel of radiance 2, 1, 0.5: the film has it times the brightness. */
static void a_sky_has_its_radiance_times_its_brightness(void **state)
{
    (void)state;
    static const double brightness[] = {1, 0.25, 0, 3};
    static buffer file;
    start(&file, "EXPOSURE=2\n", "-Y 1 +X 1");
    add(&file, (unsigned char[]){128, 64, 32, 131}, 4);
    put_file(file.bytes, file.size);
    for (size_t k = 0; k < COUNT(brightness); k++) {
        char text[64];
        float rgb[3];
        snprintf(text, sizeof text, "brightness: %g", brightness[k]);
        get_center(text, rgb);
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)rgb[c] - brightness[k] * 2 / (1 << c)) < 1e-6);
    }
}

static void load_fails(scene *s, const char *what, const char *remedy)
{
    diagnostic why = {0};
    assert_int_equal(scene_load(s, &why), STATUS_BAD_INPUT);
    if (!strstr(why.what, what) || !strstr(why.remedy, remedy))
        fail_msg("'%s; %s' has no '%s' or '%s'", why.what, why.remedy, what, remedy);
    scene_destroy(s);
}

static void a_sun_that_is_too_bright_is_told_with_its_remedy(void **state)
{
    (void)state;
    static buffer file;
    diagnostic why = {0};
    start(&file, "", "-Y 1 +X 1");
    add(&file, (unsigned char[]){128, 0, 0, 146}, 4); /* 131072 */
    put_file(file.bytes, file.size);
    load_fails(scene_of("background: {image: %s}\n", path),
               "is 131072 at column 0, row 0 from the top; it can be at most 65536",
               "set background.brightness to at most 0.47, or");
    scene *s = scene_of("background: {image: %s, brightness: 0.47}\n", path);
    worked(scene_load(s, &why), &why);
    assert_int_equal(scene_set(s, "background.brightness", "0.6", &why), STATUS_OK);
    assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT); /* after loading, too */
    scene_destroy(s);
}

static void put_pfm(const float values[4][3])
{
    unsigned char bytes[64] = "PF\n4 1\n-1.0\n";
    for (int i = 0; i < 12; i++) {
        uint32_t word;
        memcpy(&word, &values[i / 3][i % 3], 4);
        for (int k = 0; k < 4; k++)
            bytes[12 + 4 * i + k] = (unsigned char)(word >> 8 * k);
    }
    put_file(bytes, 12 + 48);
}

typedef struct notes {
    int count;
    char text[NOTE_TEXT_MAX], place[NOTE_PLACE_MAX];
} notes;

static void take_note(void *of, const scene_note *note)
{
    notes *n = of;
    if (!strstr(note->text, "negative"))
        return;
    n->count++;
    memcpy(n->text, note->text, sizeof n->text);
    memcpy(n->place, note->place, sizeof n->place);
}

/* As resampling makes them: 0, with a note. */
static void small_negative_values_are_zero(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "background: {image: ", "textures: {t: {file: ", "textures: {t: {space: linear, file: "};
    put_pfm((const float[4][3]){{10, 1, 2}, {-1, 3, 4}, {5, -0.01F, 7}, {8, 9, 9}});
    for (size_t k = 0; k < COUNT(texts); k++) {
        scene *s = scene_of("%s%s%s\n", texts[k], path, k ? "}}" : "}");
        diagnostic why = {0};
        notes found = {0};
        worked(scene_load(s, &why), &why);
        scene_hints(s, &(note_sink){take_note, &found});
        assert_int_equal(found.count, 1);
        assert_string_equal(found.text, "2 small negative values, down to -1, are read as 0");
        assert_string_equal(found.place, k ? "t.file" : "background.image");
        if (k == 0)
            assert_true(s->background.img->pixel[3] == 0.0F && s->background.img->pixel[4] == 3.0F);
        else
            assert_true(texture_sample(s->textures[0].data, 0.375, 0.5, 0.0).x == 0.0);
        scene_destroy(s);
    }
}

static void larger_negative_values_are_refused(void **state)
{
    (void)state;
    put_pfm((const float[4][3]){{10, 1, 2}, {-1.01F, 3, 4}, {5, -0.01F, 7}, {8, 9, 9}});
    load_fails(scene_of("background: {image: %s}\n", path), "column 1, row 0 from the top is negative: -1.01",
               "values from 0");
    load_fails(scene_of("textures: {t: {file: %s}}\n", path), "column 1, row 0 from the top is negative: -1.01",
               "values from 0");
}

static int make_file(void **state)
{
    (void)state;
    const int handle = mkstemp(path);
    return handle < 0 ? -1 : close(handle);
}

static int remove_file(void **state)
{
    (void)state;
    return unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_way_of_storing_pixels_is_read),
        cmocka_unit_test(long_old_runs_are_read),
        cmocka_unit_test(each_order_of_rows_and_columns_is_turned_upright),
        cmocka_unit_test(the_lines_of_the_header_apply),
        cmocka_unit_test(the_largest_values_stay_finite),
        cmocka_unit_test(wrong_headers_are_refused),
        cmocka_unit_test(corrupted_files_are_read_or_refused),
        cmocka_unit_test(a_sky_has_its_radiance_times_its_brightness),
        cmocka_unit_test(a_sun_that_is_too_bright_is_told_with_its_remedy),
        cmocka_unit_test(small_negative_values_are_zero),
        cmocka_unit_test(larger_negative_values_are_refused),
    };
    return cmocka_run_group_tests(tests, make_file, remove_file);
}
