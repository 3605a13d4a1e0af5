/* What the chunks of a PNG file say of its colours and its orientation. Portable Network Graphics, 3rd edition (W3C
 * 2025), 4.3 and 11.3.2; ITU-T H.273 for cICP. */
#include "image/codec.h"

#include <stdlib.h>
#include <zlib.h>

enum { PROFILE_MOST = 8000000, PROFILE_START = 128 };

typedef struct png_chunk {
    const unsigned char *data; /* NULL: none */
    size_t size;
} png_chunk;

/* The first chunk of a type; of one that must come before the pixels, there. */
static png_chunk find_chunk(const unsigned char *bytes, size_t size, const char *type, bool before_pixels)
{
    for (size_t at = 8; size > at && size - at >= 12;) {
        const size_t length = codec_big_endian(bytes + at, 4);
        if (length > size - at - 12 || (before_pixels && memcmp(bytes + at + 4, "IDAT", 4) == 0))
            break;
        if (memcmp(bytes + at + 4, type, 4) == 0)
            return (png_chunk){bytes + at + 8, length};
        at += 12 + length;
    }
    return (png_chunk){NULL, 0};
}

/* ---- code points ---- */

static const codec_curve *transfer_of(int code)
{
    static const codec_curve bt709 = {.g = 1.0 / 0.45,
                                      .a = 1.0 / 1.099,
                                      .b = 0.099 / 1.099,
                                      .c = 1.0 / 4.5,
                                      .d = 0.081},
                             gamma_22 = {.g = 2.2, .a = 1.0}, gamma_28 = {.g = 2.8, .a = 1.0},
                             linear = {.g = 1.0, .a = 1.0};
    switch (code) {
    case 1:
    case 6:
    case 14:
    case 15: return &bt709;
    case 4: return &gamma_22;
    case 5: return &gamma_28;
    case 8: return &linear;
    default: return NULL;
    }
}

/* CIE xy of white, red, green, blue (H.273, table 2). */
static const double *primaries_of(int code)
{
    static const struct {
        int code;
        double xy[8];
    } list[] = {
        {1, {0.3127, 0.3290, 0.64, 0.33, 0.30, 0.60, 0.15, 0.06}},
        {4, {0.310, 0.316, 0.67, 0.33, 0.21, 0.71, 0.14, 0.08}},
        {5, {0.3127, 0.3290, 0.64, 0.33, 0.29, 0.60, 0.15, 0.06}},
        {6, {0.3127, 0.3290, 0.630, 0.340, 0.310, 0.595, 0.155, 0.070}},
        {7, {0.3127, 0.3290, 0.630, 0.340, 0.310, 0.595, 0.155, 0.070}},
        {9, {0.3127, 0.3290, 0.708, 0.292, 0.170, 0.797, 0.131, 0.046}},
        {11, {0.314, 0.351, 0.680, 0.320, 0.265, 0.690, 0.150, 0.060}},
        {12, {0.3127, 0.3290, 0.680, 0.320, 0.265, 0.690, 0.150, 0.060}},
        {22, {0.3127, 0.3290, 0.630, 0.340, 0.295, 0.605, 0.155, 0.077}},
    };
    for (size_t i = 0; i < sizeof list / sizeof *list; i++)
        if (list[i].code == code)
            return list[i].xy;
    return NULL;
}

enum { CODE_SRGB = 13, CODE_PQ = 16, CODE_HLG = 18, CODE_RGB = 0 };

/* *used: whether the chunk decides. PQ and HLG are meant for displays of another range: as sRGB they would be wrong. */
static status read_codes(png_chunk chunk, png_space *out, bool *used, diagnostic *why)
{
    *used = false;
    if (!chunk.data)
        return STATUS_OK;
    const int transfer = chunk.size == 4 ? chunk.data[1] : 0;
    if (transfer == CODE_PQ || transfer == CODE_HLG)
        return diagnose(why, STATUS_BAD_INPUT, "convert it to Radiance HDR, or to a PNG of sRGB",
                        "the PNG file has values of high dynamic range (%s), which are not supported",
                        transfer == CODE_PQ ? "PQ" : "HLG");
    const codec_curve *curve = transfer_of(transfer);
    const double *primaries = chunk.size == 4 ? primaries_of(chunk.data[0]) : NULL;
    if (!primaries || (!curve && transfer != CODE_SRGB) || chunk.data[2] != CODE_RGB || chunk.data[3] != 1) {
        image_note(out->note, "its chunk cICP has unsupported values, and is ignored");
        return STATUS_OK;
    }
    if (curve)
        codec_color_set_curve(&out->color, curve);
    *used = codec_color_set_primaries(&out->color, primaries);
    return STATUS_OK;
}

/* ---- profiles ---- */

/* Expands the profile, whose first number is its size. NULL: it is damaged. */
static unsigned char *expand(z_stream *z, size_t *size)
{
    unsigned char start[PROFILE_START], *profile = NULL;
    z->next_out = start, z->avail_out = sizeof start;
    const int code = inflate(z, Z_SYNC_FLUSH);
    if ((code != Z_OK && code != Z_STREAM_END) || z->avail_out > 0)
        return NULL;
    *size = codec_big_endian(start, 4);
    if (*size < sizeof start || *size > PROFILE_MOST || !(profile = calloc(*size, 1)))
        return NULL;
    memcpy(profile, start, sizeof start);
    z->next_out = profile + sizeof start, z->avail_out = (uInt)(*size - sizeof start);
    inflate(z, Z_FINISH);
    if (z->avail_out == 0)
        return profile;
    free(profile);
    return NULL;
}

/* A name of at most 79 letters, 0, the method 0, and the profile, compressed by zlib. */
static void read_profile(png_chunk chunk, png_space *out)
{
    const unsigned char *end = memchr(chunk.data, 0, chunk.size);
    const size_t name = end ? (size_t)(end - chunk.data) : chunk.size;
    const char *reason = "is damaged";
    size_t size = 0;
    z_stream z = {.next_in = NULL};
    if (chunk.size >= name + 2 && end[1] == 0 && inflateInit(&z) == Z_OK) {
        z.next_in = (z_const Bytef *)(uintptr_t)(end + 2);
        z.avail_in = (uInt)(chunk.size - name - 2);
        out->profile = expand(&z, &size);
        inflateEnd(&z);
    }
    if (out->profile)
        reason = codec_color_of_icc(out->profile, size, &out->color);
    if (reason)
        image_note(out->note, CODEC_PROFILE_NOTE, reason);
}

/* ---- numbers ---- */

enum { GAMMA_SRGB = 45455, GAMMA_LEAST = 16, GAMMA_MOST = 625000000 };
static const unsigned srgb_numbers[8] = {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};

/* gAMA and cHRM, in units of 1/100000. Both with the numbers that 11.3.2.5 gives for sRGB mean sRGB: many programs
 * write them without its chunk. */
static void read_numbers(png_chunk gamma, png_chunk primaries, png_space *out)
{
    const uint32_t g = gamma.size == 4 ? codec_big_endian(gamma.data, 4) : 0;
    double xy[8];
    bool srgb = g == GAMMA_SRGB && primaries.size == 32;
    for (int i = 0; i < 8 && primaries.size == 32; i++) {
        const uint32_t number = codec_big_endian(primaries.data + 4 * i, 4);
        xy[i] = number / 1e5;
        srgb &= number == srgb_numbers[i];
    }
    if (srgb)
        return;
    if (gamma.data && (g < GAMMA_LEAST || g > GAMMA_MOST))
        image_note(out->note, "its chunk gAMA is damaged, and ignored");
    else if (gamma.data)
        codec_color_set_curve(&out->color, &(codec_curve){.g = 1e5 / g, .a = 1.0});
    if (primaries.data && (primaries.size != 32 || !codec_color_set_primaries(&out->color, xy)))
        image_note(out->note, "its chunk cHRM is damaged, and ignored");
}

status png_read_space(const unsigned char *bytes, size_t size, image_values values, png_space *out, diagnostic *why)
{
    const png_chunk exif = find_chunk(bytes, size, "eXIf", false), codes = find_chunk(bytes, size, "cICP", true),
                    profile = find_chunk(bytes, size, "iCCP", true), srgb = find_chunk(bytes, size, "sRGB", true);
    bool used;
    *out = (png_space){.orientation = exif.data ? codec_exif_orientation(exif.data, exif.size) : 1};
    if (values != IMAGE_LIGHT)
        return STATUS_OK;
    TRY(read_codes(codes, out, &used, why));
    if (!used && profile.data)
        read_profile(profile, out);
    else if (!used && !srgb.data)
        read_numbers(find_chunk(bytes, size, "gAMA", true), find_chunk(bytes, size, "cHRM", true), out);
    return STATUS_OK;
}
