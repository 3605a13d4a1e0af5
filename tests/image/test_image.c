/* Tests of images: the sRGB curve, files that read back as they were written, and writing that fails. */
#include "image_files.h"

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
    assert_int_equal(image_format_of("x.exr"), IMAGE_EXR);
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
    check_same_bytes("a.exr", 8);
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
    static const char *const names[] = {"full.png", "full.jpg", "full.pfm", "full.exr"};
    image *small = make_image(5, 5), *large = make_image(200, 150);
    struct rlimit before, limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    os_signals_as_errors();
    for (int i = 0; i < 4; i++) {
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
        file_test(wrong_requests_are_refused),
        file_test(a_full_disk_keeps_the_old_image),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
