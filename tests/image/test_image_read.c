/* Tests of reading PNG, JPEG and PFM files of other programs, and damaged ones. */
#include "image_files.h"

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

/* Channel 3 is alpha. */
static double expected_channel(const png_kind *kind, int x, int y, int channel)
{
    double full = (1u << kind->depth) - 1, alpha = 1.0;
    int channels = channels_of(kind->color);
    unsigned first = sample_at(kind, x, y, 0);
    if (kind->color == PNG_COLOR_TYPE_PALETTE) {
        png_color entry = palette_entry(first);
        double value = (channel == 0 ? entry.red : channel == 1 ? entry.green : entry.blue) / 255.0;
        return channel < 3 ? srgb_decode(value) : kind->transparent ? (first * 53 & 255) / 255.0 : 1.0;
    }
    if (channels % 2 == 0) {
        alpha = sample_at(kind, x, y, channels - 1) / full;
    } else if (kind->transparent) {
        bool same = true;
        for (int c = 0; c < channels; c++)
            same = same && sample_at(kind, x, y, c) == sample_at(kind, 2, 3, c);
        alpha = same ? 0.0 : 1.0;
    }
    return channel == 3 ? alpha : srgb_decode(sample_at(kind, x, y, channels >= 3 ? channel : 0) / full);
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
    assert_true((img->alpha != NULL) == (channels_of(kind->color) % 2 == 0 || kind->transparent));
    for (int i = 0; i < KIND_WIDTH * KIND_HEIGHT; i++) {
        const int x = i % KIND_WIDTH, y = i / KIND_WIDTH;
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)img->pixel[3 * i + c] - expected_channel(kind, x, y, c)) < 1e-7);
        assert_true(!img->alpha || fabs((double)img->alpha[i] - expected_channel(kind, x, y, 3)) < 1e-7);
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

static void write_jpeg_as(const char *path, J_COLOR_SPACE space, int channels, bool progressive, int subsampling,
                          J_COLOR_SPACE stored, bool adobe)
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
    if (stored != JCS_UNKNOWN) {
        jpeg_set_colorspace(&cinfo, stored);
        cinfo.write_Adobe_marker = adobe;
    }
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

static void write_jpeg_kind(const char *path, J_COLOR_SPACE space, int channels, bool progressive, int subsampling)
{
    write_jpeg_as(path, space, channels, progressive, subsampling, JCS_UNKNOWN, false);
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

/* Without a profile R = (1 - C) (1 - K); Adobe's marker means that 1 - C is stored. All four channels are equal
 * here. */
static void cmyk_jpeg_is_converted(void **state)
{
    (void)state;
    static const struct {
        J_COLOR_SPACE stored;
        bool adobe;
    } kinds[] = {{JCS_CMYK, true}, {JCS_CMYK, false}, {JCS_YCCK, true}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        char *path = in_folder("cmyk.jpg");
        image *img;
        write_jpeg_as(path, JCS_CMYK, 4, k == 1, 1, kinds[k].stored, kinds[k].adobe);
        assert_int_equal(image_read(path, &img, NULL, NULL), STATUS_OK);
        assert_string_equal(img->note, "");
        for (int i = 0; i < 40 * 30 * 3; i++) {
            const double coded = (60 + i / 3 % 40 * 3 + i / 3 / 40) / 255.0, ink = kinds[k].adobe ? 1 - coded : coded;
            assert_true(fabs(srgb_encode((double)img->pixel[i]) - (1 - ink) * (1 - ink)) < 8 / 255.0);
        }
        image_destroy(img);
        free(path);
    }
}

/* The frame header (SOF) declares what the library does not read: the message names it, and does not say damaged. */
static void unsupported_jpeg_is_refused_by_name(void **state)
{
    (void)state;
    static const struct {
        unsigned char process, precision;
        const char *word;
    } kinds[] = {{0xc1, 12, "has 12 bits per channel"}, {0xc3, 8, "lossless or hierarchical"}, {0xc5, 8, "(SOF 5)"}};
    char *path = in_folder("kind.jpg");
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        write_jpeg_kind(path, JCS_RGB, 3, false, 1);
        blob b = get(path);
        size_t at = 0;
        diagnostic why = {0};
        image *img;
        while (at + 9 < b.size && memcmp(b.bytes + at, "\xff\xc0", 2) != 0)
            at++;
        assert_true(at + 9 < b.size);
        b.bytes[at + 1] = (char)kinds[k].process, b.bytes[at + 4] = (char)kinds[k].precision;
        put(path, b.bytes, b.size);
        free(b.bytes);
        assert_int_equal(image_read(path, &img, NULL, &why), STATUS_BAD_INPUT);
        if (!strstr(why.what, kinds[k].word) || strstr(why.what, "damaged"))
            fail_msg("%s", why.what);
    }
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

#define file_test(f) cmocka_unit_test_setup_teardown(f, make_folder, remove_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        file_test(pfm_is_read_in_either_byte_order),
        file_test(invalid_pfm_is_refused),
        file_test(png_of_every_kind_is_read),
        file_test(huge_png_is_refused),
        file_test(decompression_bombs_are_refused),
        file_test(jpeg_with_a_false_size_is_refused),
        file_test(jpeg_of_other_kinds_is_read),
        file_test(cmyk_jpeg_is_converted),
        file_test(unsupported_jpeg_is_refused_by_name),
        file_test(truncated_files_are_refused),
        file_test(corrupted_files_are_refused_or_read_whole),
        file_test(files_with_many_corruptions_are_refused_or_read_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
