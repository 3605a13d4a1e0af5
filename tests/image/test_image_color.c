/* Tests of the colour spaces and orientations in PNG and JPEG files, which are written here chunk by chunk: against
 * published matrices and closed forms. */
#include "image_files.h"
#include <zlib.h>

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

/* ---- writing ---- */

enum { FILE_MOST = 8192, WIDTH = 3, HEIGHT = 2 };

typedef struct buffer {
    unsigned char bytes[FILE_MOST];
    size_t size;
} buffer;

static void add(buffer *to, const void *bytes, size_t size)
{
    assert_true(to->size + size <= sizeof to->bytes);
    memcpy(to->bytes + to->size, bytes, size);
    to->size += size;
}

static void add_number(buffer *to, uint32_t value, int bytes)
{
    while (bytes-- > 0)
        add(to, &(unsigned char){(unsigned char)(value >> 8 * bytes)}, 1);
}

static void add_chunk(buffer *to, const char *type, const void *data, size_t size)
{
    add_number(to, (uint32_t)size, 4);
    const size_t from = to->size;
    add(to, type, 4);
    add(to, data, size);
    add_number(to, (uint32_t)crc32(0, to->bytes + from, (uInt)(size + 4)), 4);
}

/* 16-bit samples, r g b, of WIDTH x HEIGHT pixels. chunks: of the file, before the pixels. */
static buffer make_png(const unsigned short *samples, const buffer *chunks)
{
    buffer png = {.size = 0}, header = {.size = 0}, rows = {.size = 0};
    unsigned char packed[1024];
    uLongf packed_size = sizeof packed;
    add(&png, "\x89PNG\r\n\x1a\n", 8);
    add_number(&header, WIDTH, 4);
    add_number(&header, HEIGHT, 4);
    add(&header, "\x10\x02\0\0\0", 5);
    add_chunk(&png, "IHDR", header.bytes, header.size);
    if (chunks)
        add(&png, chunks->bytes, chunks->size);
    for (int y = 0; y < HEIGHT; y++) {
        add_number(&rows, 0, 1);
        for (int i = 0; i < 3 * WIDTH; i++)
            add_number(&rows, samples[3 * WIDTH * y + i], 2);
    }
    assert_int_equal(compress(packed, &packed_size, rows.bytes, rows.size), Z_OK);
    add_chunk(&png, "IDAT", packed, packed_size);
    add_chunk(&png, "IEND", "", 0);
    return png;
}

static const unsigned short samples[3 * WIDTH * HEIGHT] = {
    0, 0, 0, 65535, 65535, 65535, 32768, 26214, 19661, 13107, 13107, 13107, 45875, 45000, 44000, 30000, 32000, 31000};

static image *read_as(const buffer *file, image_values values)
{
    image *img = NULL;
    diagnostic why = {.what = ""};
    if (image_decode(file->bytes, file->size, values, &img, NULL, &why) != STATUS_OK)
        fail_msg("%s", why.what);
    return img;
}

static double power_of(double x, double exponent)
{
    return pow(x, exponent);
}
static double srgb_of(double x, double unused)
{
    (void)unused;
    return srgb_decode(x);
}
/* ITU-R BT.709-6, 1.2, inverted. */
static double bt709_of(double x, double unused)
{
    (void)unused;
    return x < 0.081 ? x / 4.5 : pow((x + 0.099) / 1.099, 1 / 0.45);
}

static const double same[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
/* ITU-R BT.2087-0, M2 inverted as in its annex: BT.2020 to BT.709. */
static const double of_2020[3][3] = {
    {1.6605, -0.5876, -0.0728}, {-0.1246, 1.1329, -0.0083}, {-0.0182, -0.1006, 1.1187}};
/* Display P3 to sRGB, CSS Color 4, sample code. */
static const double of_p3[3][3] = {
    {1.2249401763, -0.2249401763, 0}, {-0.0420569547, 1.0420569547, 0}, {-0.0196375546, -0.0786360456, 1.0982736001}};

static void has_colors(const image *img, double (*curve)(double, double), double exponent, const double m[3][3],
                       double tolerance)
{
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        for (int c = 0; c < 3; c++) {
            double right = 0.0;
            for (int k = 0; k < 3; k++)
                right += m[c][k] * curve(samples[3 * i + k] / 65535.0, exponent);
            assert_close((double)img->pixel[3 * i + c], right, tolerance);
        }
}

/* ---- chunks ---- */

typedef enum part { CICP_P3 = 1, CICP_709 = 2, ICC_P3 = 4, SRGB = 8, GAMMA = 16, CHROMA = 32, ICC_SRGB = 64 } part;

static void add_numbers(buffer *to, const char *type, const uint32_t *numbers, int count)
{
    buffer data = {.size = 0};
    for (int i = 0; i < count; i++)
        add_number(&data, numbers[i], 4);
    add_chunk(to, type, data.bytes, data.size);
}

/* ---- profiles ---- */

static void add_fixed(buffer *to, double value)
{
    add_number(to, (uint32_t)(int32_t)lrint(value * 65536), 4);
}

/* A profile of version 4 with one curve for all channels (ICC.1:2022, 7, 10.18: type 3) and the primaries as XYZ under
 * D50; or of grey values. */
static buffer make_profile(const double primaries[3][3], const double *curve, int numbers, const char *space)
{
    static const char *const tags[] = {"rXYZ", "gXYZ", "bXYZ", "rTRC", "gTRC", "bTRC", "kTRC"};
    buffer p = {.size = 0};
    const bool grey = strcmp(space, "GRAY") == 0;
    const uint32_t count = grey ? 1 : 6, start = 132 + 12 * count, curve_size = 12 + 4 * (uint32_t)numbers;
    add_number(&p, start + (grey ? 0 : 60) + curve_size, 4);
    add(&p, "none\4\0\0\0mntr", 12);
    add(&p, space, 4);
    add(&p, "XYZ ", 4);
    add(&p, "            acsp", 16);
    while (p.size < 128)
        add_number(&p, 0, 1);
    add_number(&p, count, 4);
    for (uint32_t i = 0; i < count; i++) {
        const bool is_curve = grey || i >= 3;
        add(&p, tags[grey ? 6 : i], 4);
        add_number(&p, is_curve ? start + (grey ? 0 : 60) : start + 20 * i, 4);
        add_number(&p, is_curve ? curve_size : 20, 4);
    }
    for (int i = 0; i < 3 && !grey; i++) {
        add(&p, "XYZ \0\0\0\0", 8);
        for (int k = 0; k < 3; k++)
            add_fixed(&p, primaries[i][k]);
    }
    add(&p, "para\0\0\0\0", 8);
    add_number(&p, numbers == 1 ? 0 : 3, 2);
    add_number(&p, 0, 2);
    for (int i = 0; i < numbers; i++)
        add_fixed(&p, curve[i]);
    return p;
}

static const double srgb_curve[5] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
/* Of Apple's profile Display P3, and of the profiles of sRGB. */
static const double p3[3][3] = {
    {0.515121, 0.241196, -0.001053}, {0.291977, 0.692245, 0.041885}, {0.157104, 0.066574, 0.784073}};
static const double srgb[3][3] = {
    {0.436066, 0.222488, 0.013916}, {0.385147, 0.716873, 0.097076}, {0.143066, 0.060608, 0.714096}};

static void add_profile(buffer *to, const buffer *profile)
{
    buffer data = {.size = 0};
    unsigned char packed[4096];
    uLongf size = sizeof packed;
    assert_int_equal(compress(packed, &size, profile->bytes, profile->size), Z_OK);
    add(&data, "a name\0\0", 8);
    add(&data, packed, size);
    add_chunk(to, "iCCP", data.bytes, data.size);
}

static buffer make_chunks(unsigned parts)
{
    buffer chunks = {.size = 0};
    if (parts & CHROMA) /* BT.2020 */
        add_numbers(&chunks, "cHRM", (const uint32_t[]){31270, 32900, 70800, 29200, 17000, 79700, 13100, 4600}, 8);
    if (parts & GAMMA)
        add_numbers(&chunks, "gAMA", (const uint32_t[]){50000}, 1);
    if (parts & SRGB)
        add_chunk(&chunks, "sRGB", "\0", 1);
    if (parts & (ICC_P3 | ICC_SRGB)) {
        const buffer profile = make_profile(parts & ICC_P3 ? p3 : srgb, srgb_curve, 5, "RGB ");
        add_profile(&chunks, &profile);
    }
    if (parts & CICP_P3)
        add_chunk(&chunks, "cICP", "\x0c\x0d\0\1", 4);
    if (parts & CICP_709)
        add_chunk(&chunks, "cICP", "\1\1\0\1", 4);
    return chunks;
}

/* ---- tests ---- */

/* Portable Network Graphics, 3rd edition, 4.3: cICP before iCCP before sRGB before gAMA and cHRM. */
static void chunks_have_their_precedence(void **state)
{
    (void)state;
    static const struct {
        unsigned parts;
        double (*curve)(double, double);
        double exponent;
        const double (*m)[3];
        double tolerance;
    } kinds[] = {
        {0, srgb_of, 0, same, 1e-7},
        {GAMMA, power_of, 2, same, 1e-7},
        {CHROMA, srgb_of, 0, of_2020, 2e-4},
        {GAMMA | CHROMA, power_of, 2, of_2020, 2e-4},
        {SRGB | GAMMA | CHROMA, srgb_of, 0, same, 1e-7},
        {ICC_P3, srgb_of, 0, of_p3, 3e-4},
        {ICC_P3 | GAMMA | CHROMA, srgb_of, 0, of_p3, 3e-4},
        {ICC_SRGB, srgb_of, 0, same, 1e-7},
        {CICP_P3, srgb_of, 0, of_p3, 1e-6},
        {CICP_P3 | ICC_SRGB | SRGB | GAMMA | CHROMA, srgb_of, 0, of_p3, 1e-6},
        {CICP_709 | ICC_P3, bt709_of, 0, same, 1e-7},
    };
    for (size_t k = 0; k < COUNT(kinds); k++) {
        const buffer chunks = make_chunks(kinds[k].parts), png = make_png(samples, &chunks);
        image *img = read_as(&png, IMAGE_LIGHT), *coded = read_as(&png, IMAGE_CODED),
              *plain = read_as(&png, IMAGE_SRGB);
        has_colors(img, kinds[k].curve, kinds[k].exponent, kinds[k].m, kinds[k].tolerance);
        assert_string_equal(img->note, "");
        has_colors(coded, power_of, 1, same, 1e-7); /* data have no colour space */
        for (int i = 0; i < 9 * HEIGHT; i++)
            assert_true(coded->pixel[i] == (float)(samples[i] / 65535.0));
        has_colors(plain, srgb_of, 0, same, 1e-7);
        image_destroy(img);
        image_destroy(coded);
        image_destroy(plain);
    }
}

/* 11.3.2.5: what writers of sRGB add for others. */
static void the_numbers_of_srgb_mean_srgb(void **state)
{
    (void)state;
    static const uint32_t chroma[] = {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
    buffer chunks = {.size = 0};
    add_numbers(&chunks, "gAMA", (const uint32_t[]){45455}, 1);
    buffer png = make_png(samples, &chunks);
    image *img = read_as(&png, IMAGE_LIGHT);
    has_colors(img, power_of, 1e5 / 45455, same, 1e-7);
    image_destroy(img);
    add_numbers(&chunks, "cHRM", chroma, 8);
    png = make_png(samples, &chunks);
    img = read_as(&png, IMAGE_LIGHT);
    has_colors(img, srgb_of, 0, same, 1e-7);
    image_destroy(img);
}

static void colors_outside_srgb_are_limited_and_noted(void **state)
{
    (void)state;
    unsigned short green[3 * WIDTH * HEIGHT] = {0, 65535, 0};
    const buffer chunks = make_chunks(CICP_P3), png = make_png(green, &chunks);
    image *img = read_as(&png, IMAGE_LIGHT);
    assert_true(img->pixel[0] == 0.0F && img->pixel[1] == 1.0F && img->pixel[2] == 0.0F);
    assert_string_equal(img->note, "1 of 6 pixels have colours that sRGB cannot show, limited to its range");
    image_destroy(img);
}

static void high_dynamic_range_is_refused_as_color(void **state)
{
    (void)state;
    static const char *const codes[] = {"\x09\x10\0\1", "\x09\x12\0\1"};
    for (size_t k = 0; k < COUNT(codes); k++) {
        buffer chunks = {.size = 0};
        diagnostic why = {.what = ""};
        image *img;
        add_chunk(&chunks, "cICP", codes[k], 4);
        const buffer png = make_png(samples, &chunks);
        assert_int_equal(image_decode(png.bytes, png.size, IMAGE_LIGHT, &img, NULL, &why), STATUS_BAD_INPUT);
        assert_non_null(strstr(why.what, k ? "HLG" : "PQ"));
        img = read_as(&png, IMAGE_CODED);
        image_destroy(img);
    }
}

/* What cannot be applied is noted, and the next chunk, or sRGB, decides. */
static void unreadable_spaces_are_noted(void **state)
{
    (void)state;
    static const double gamma[1] = {1.8};
    buffer profiles[4] = {make_profile(srgb, srgb_curve, 5, "RGB "), make_profile(srgb, srgb_curve, 5, "CMYK"),
                          make_profile(srgb, srgb_curve, 5, "RGB "), make_profile(srgb, gamma, 1, "GRAY")};
    static const char *const notes[] = {"its colour profile is damaged, and is ignored", "neither of RGB nor of grey",
                                        "its colour profile consists of tables", ""};
    profiles[0].bytes[36] = 'x';
    memcpy(profiles[2].bytes + 132, "A2B0", 4);
    for (size_t k = 0; k < COUNT(profiles); k++) {
        buffer chunks = {.size = 0};
        add_profile(&chunks, &profiles[k]);
        const buffer png = make_png(samples, &chunks);
        image *img = read_as(&png, IMAGE_LIGHT);
        assert_non_null(strstr(img->note, notes[k]));
        has_colors(img, k < 3 ? srgb_of : power_of, 1.8, same, 1e-4);
        image_destroy(img);
    }
    buffer chunks = {.size = 0};
    add_chunk(&chunks, "cICP", "\1\1\1\1", 4);
    add_numbers(&chunks, "gAMA", (const uint32_t[]){0}, 1);
    const buffer png = make_png(samples, &chunks);
    image *img = read_as(&png, IMAGE_LIGHT);
    assert_non_null(strstr(img->note, "cICP"));
    assert_non_null(strstr(img->note, "gAMA"));
    has_colors(img, srgb_of, 0, same, 1e-7);
    image_destroy(img);
}

/* Cut and changed profiles are read or refused within their bytes, which instruments check. */
static void damaged_profiles_are_harmless(void **state)
{
    (void)state;
    const buffer whole = make_profile(p3, srgb_curve, 5, "RGB ");
    uint32_t random = 77;
    for (int k = 0; k < 20000; k++) {
        const size_t size = k < (int)whole.size ? (size_t)k : whole.size;
        unsigned char *bytes = malloc(size ? size : 1);
        codec_color color = {.curved = false};
        codec_tables tables = {{NULL}};
        assert_non_null(bytes);
        memcpy(bytes, whole.bytes, size);
        for (int i = 0; i < 4 && size == whole.size; i++)
            bytes[128 + next_random(&random) % (size - 128)] = (unsigned char)next_random(&random);
        if (!codec_color_of_icc(bytes, size, &color)) {
            const unsigned maximum[3] = {9, 9, 9};
            assert_int_equal(codec_tables_make(&color, maximum, &tables, NULL), STATUS_OK);
            for (int i = 0; i < 30; i++)
                assert_true(tables.of[i / 10][i % 10] >= 0.0F && tables.of[i / 10][i % 10] <= 1.0F);
            codec_tables_free(&tables);
        }
        free(bytes);
    }
}

/* ---- orientation ---- */

/* The stored rows "abc", "def", seen upright (EXIF 2.32, 4.6.4: the places of row 0 and of column 0). */
static const char *const upright[] = {"abc/def",  "cba/fed",  "fed/cba",  "def/abc",
                                      "ad/be/cf", "da/eb/fc", "fc/eb/da", "cf/be/ad"};

static void is_upright(const image *img, int orientation, const double colors[6], double tolerance)
{
    const char *right = upright[orientation - 1];
    const bool turned = orientation > 4;
    assert_true(img->width == (turned ? 2 : 3) && img->height == (turned ? 3 : 2));
    for (int i = 0; i < 6; i++) {
        const char letter = right[i / img->width * (img->width + 1) + i % img->width];
        for (int c = 0; c < 3; c++)
            assert_close((double)img->pixel[3 * i + c], colors[letter - 'a'], tolerance);
    }
}

static buffer make_exif(int orientation, bool big)
{
    buffer exif = {.size = 0};
    if (big) {
        add(&exif, "MM\0*\0\0\0\10\0\1\1\22\0\3\0\0\0\1\0", 19);
        add_number(&exif, (uint32_t)orientation, 1);
    } else {
        add(&exif, "II*\0\10\0\0\0\1\0\22\1\3\0\1\0\0\0", 18);
        add_number(&exif, (uint32_t)orientation, 1);
        add_number(&exif, 0, 1);
    }
    add(&exif, "\0\0\0\0\0\0", 6);
    return exif;
}

static void png_is_turned_upright(void **state)
{
    (void)state;
    unsigned short grey[3 * WIDTH * HEIGHT];
    double colors[6];
    for (int i = 0; i < 18; i++)
        grey[i] = (unsigned short)(i / 3 * 10000);
    for (int i = 0; i < 6; i++)
        colors[i] = srgb_decode(i * 10000 / 65535.0);
    for (int orientation = 1; orientation <= 8; orientation++)
        for (int big = 0; big < 2; big++) {
            const buffer exif = make_exif(orientation, big);
            buffer chunks = {.size = 0};
            add_chunk(&chunks, "eXIf", exif.bytes, exif.size);
            const buffer png = make_png(grey, &chunks);
            image *img = read_as(&png, IMAGE_LIGHT);
            is_upright(img, orientation, colors, 1e-7);
            image_destroy(img);
        }
}

/* ---- JPEG ---- */

/* Each pixel of the upright image is a block of 8 x 8 equal pixels. markers: after the header. */
static buffer make_jpeg(const buffer *exif, const buffer *profile, int parts)
{
    struct jpeg_compress_struct cinfo;
    struct jpeg_error_mgr errors;
    unsigned char *bytes = NULL;
    unsigned long size = 0;
    cinfo.err = jpeg_std_error(&errors);
    jpeg_create_compress(&cinfo);
    jpeg_mem_dest(&cinfo, &bytes, &size);
    cinfo.image_width = 8 * WIDTH, cinfo.image_height = 8 * HEIGHT;
    cinfo.input_components = 3, cinfo.in_color_space = JCS_RGB;
    jpeg_set_defaults(&cinfo);
    jpeg_set_quality(&cinfo, 100, TRUE);
    jpeg_start_compress(&cinfo, TRUE);
    if (exif) {
        buffer marker = {.size = 0};
        add(&marker, "Exif\0", 6);
        add(&marker, exif->bytes, exif->size);
        jpeg_write_marker(&cinfo, JPEG_APP0 + 1, marker.bytes, (unsigned)marker.size);
    }
    for (int i = parts; profile && i-- > 0;) { /* in any order */
        const size_t from = profile->size * (size_t)i / (size_t)parts,
                     to = profile->size * (size_t)(i + 1) / (size_t)parts;
        buffer marker = {.size = 0};
        add(&marker, "ICC_PROFILE", 12);
        add_number(&marker, (uint32_t)i + 1, 1);
        add_number(&marker, (uint32_t)parts, 1);
        add(&marker, profile->bytes + from, to - from);
        jpeg_write_marker(&cinfo, JPEG_APP0 + 2, marker.bytes, (unsigned)marker.size);
    }
    while (cinfo.next_scanline < cinfo.image_height) {
        unsigned char row[3 * 8 * WIDTH];
        for (int i = 0; i < 3 * 8 * WIDTH; i++)
            row[i] = (unsigned char)(40 * (i / 24 + WIDTH * (int)(cinfo.next_scanline / 8)) + 20);
        JSAMPROW rows = row;
        jpeg_write_scanlines(&cinfo, &rows, 1);
    }
    jpeg_finish_compress(&cinfo);
    jpeg_destroy_compress(&cinfo);
    buffer file = {.size = 0};
    add(&file, bytes, size);
    free(bytes);
    return file;
}

static void jpeg_is_turned_upright(void **state)
{
    (void)state;
    double colors[6];
    for (int i = 0; i < 6; i++)
        colors[i] = srgb_decode((40 * i + 20) / 255.0);
    for (int orientation = 1; orientation <= 8; orientation++) {
        const buffer exif = make_exif(orientation, orientation % 2), file = make_jpeg(&exif, NULL, 0);
        image *img = read_as(&file, IMAGE_LIGHT), *small;
        assert_int_equal(image_create(img->width / 8, img->height / 8, &small, NULL), STATUS_OK);
        for (int y = 0; y < small->height; y++)
            for (int x = 0; x < small->width; x++)
                memcpy(small->pixel + 3 * (y * small->width + x),
                       img->pixel + 3 * ((8 * y + 3) * img->width + 8 * x + 3), 3 * sizeof *img->pixel);
        is_upright(small, orientation, colors, 0.01);
        image_destroy(img);
        image_destroy(small);
    }
}

static void jpeg_profiles_are_applied(void **state)
{
    (void)state;
    static const double gamma[1] = {1.0};
    const buffer profile = make_profile(srgb, gamma, 1, "RGB ");
    for (int parts = 1; parts <= 3; parts++) {
        const buffer file = make_jpeg(NULL, &profile, parts);
        image *img = read_as(&file, IMAGE_LIGHT);
        for (int i = 0; i < WIDTH; i++)
            assert_close((double)img->pixel[3 * (3 * 8 * WIDTH + 8 * i + 3)], (40 * i + 20) / 255.0, 0.006);
        image_destroy(img);
    }
    buffer lacking = make_jpeg(NULL, &profile, 3), changed = lacking;
    for (size_t i = 0; i + 14 < changed.size; i++)
        if (memcmp(changed.bytes + i, "ICC_PROFILE\0\2", 13) == 0)
            changed.bytes[i + 12] = 9;
    image *img = read_as(&changed, IMAGE_LIGHT);
    assert_non_null(strstr(img->note, "its colour profile is damaged"));
    image_destroy(img);
    img = read_as(&lacking, IMAGE_CODED);
    assert_close((double)img->pixel[3 * (3 * 8 * WIDTH + 3)], 20 / 255.0, 0.006);
    image_destroy(img);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chunks_have_their_precedence),
        cmocka_unit_test(the_numbers_of_srgb_mean_srgb),
        cmocka_unit_test(colors_outside_srgb_are_limited_and_noted),
        cmocka_unit_test(high_dynamic_range_is_refused_as_color),
        cmocka_unit_test(unreadable_spaces_are_noted),
        cmocka_unit_test(damaged_profiles_are_harmless),
        cmocka_unit_test(png_is_turned_upright),
        cmocka_unit_test(jpeg_is_turned_upright),
        cmocka_unit_test(jpeg_profiles_are_applied),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
