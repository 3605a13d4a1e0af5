/* The file formats behind image.h: four that are written and read, and others that are only read; and what these have
 * in common. Writers write an image to a stream and leave stream errors to the caller that closes it; readers decode a
 * file in memory. Diagnostics lack the file name. Ownership: an image that was read is the caller's; nothing is
 * allocated unless the status is STATUS_OK. */
#pragma once

#include "image/image.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* ---- codec.c ---- */

/* Maximum number of pixels of an image file, 2^28. */
#define CODEC_PIXELS_MAX 268435456LL

/* Maximum number of pixels per byte of the file, for images larger than CODEC_PIXELS_FREE. Deflate can reach 8256 (1032
 * to 1, RFC 1951, eight pixels per byte), which expands a file of kilobytes to gigabytes; photographs and renderings
 * stay far below 64. */
#define CODEC_PIXELS_FREE 16777216LL
#define CODEC_PIXELS_PER_BYTE 64LL

/* STATUS_BAD_INPUT unless a file of file_bytes may hold an image of this size. */
status codec_check_size(long long width, long long height, size_t file_bytes, diagnostic *why);

/* The number in 1 to 4 bytes, the most significant first, or last. */
static inline uint32_t codec_big_endian(const unsigned char *at, int bytes)
{
    uint32_t value = 0;
    for (int i = 0; i < bytes; i++)
        value = value << 8 | at[i];
    return value;
}

static inline uint32_t codec_little_endian(const unsigned char *at, int bytes)
{
    uint32_t value = 0;
    for (int i = 0; i < bytes; i++)
        value |= (uint32_t)at[i] << 8 * i;
    return value;
}

/* ---- color.c ---- */

/* The colour space of a file: {0} is sRGB. A transfer function for each channel, from values 0..1 to light 0..1: (a x +
 * b)^g + e from x = d on, c x + f below (ICC.1:2022, 10.18); or interpolated in a table of count big-endian numbers of
 * 16 bits, which is borrowed. Then the matrix to linear sRGB. */
typedef struct codec_curve {
    double g, a, b, c, d, e, f;
    const unsigned char *table;
    size_t count; /* 0: no table */
} codec_curve;

typedef struct codec_color {
    bool curved; /* false: the transfer function of sRGB */
    codec_curve curve[3];
    bool mixes; /* false: the primaries of sRGB */
    double to_srgb[3][3];
} codec_color;

void codec_color_set_curve(codec_color *color, const codec_curve *all);
/* Sets the primaries: CIE xy of white, red, green, blue. White stays white, by Bradford's adaptation to D65. False,
 * with color unchanged, if they span no colours. */
bool codec_color_set_primaries(codec_color *color, const double xy[8]);
/* The same without adaptation: a spectrum keeps its colour, and another white is not grey. luminance: of red, green and
 * blue, of sum 1. */
bool codec_color_set_unadapted(codec_color *color, const double xy[8], double luminance[3]);
/* The channels are CIE XYZ, without adaptation. */
void codec_color_set_XYZ(codec_color *color);

/* Reads an ICC profile of RGB with primaries, or of grey values. Returns NULL; or, with color unchanged, why the
 * profile cannot be applied ("is damaged"). Tables of the result borrow from the bytes. */
#define CODEC_PROFILE_NOTE "its colour profile %s, and is ignored: colours are read as sRGB"
const char *codec_color_of_icc(const unsigned char *bytes, size_t size, codec_color *color);

/* For each channel a table of the linear values of 0..maximum; color NULL: value / maximum. Channels may have one and
 * the same table. The caller frees them, even after a failure. */
typedef struct codec_tables {
    float *of[3];
} codec_tables;
status codec_tables_make(const codec_color *color, const unsigned maximum[3], codec_tables *out, diagnostic *why);
void codec_tables_free(codec_tables *tables); /* {NULL} is allowed */

/* Applies the matrix, limits what it changed to 0..most, and notes how many pixels that affects. */
void codec_color_apply(const codec_color *color, double most, image *img);

/* ---- codec.c ---- */

/* Creates an image of the size in the file, and the decoding tables of its values 0..maximum. Both are the caller's,
 * even after a failure. */
status codec_begin(long long width, long long height, size_t file_bytes, unsigned maximum, const codec_color *color,
                   image **img, codec_tables *tables, diagnostic *why);

/* The orientation in EXIF data, from its TIFF header on: 1 to 8 (EXIF 2.32, 4.6.4: 1: rows from the top; 6: rows from
 * the right, as of a camera on its side). 1 if there is none, or if the data are damaged. */
int codec_exif_orientation(const unsigned char *bytes, size_t size);
/* Turns an image that is stored in this orientation upright. Replaces *img. */
status codec_orient(image **img, int orientation, diagnostic *why);

/* Runs a function in a new thread that can only compute: it opens nothing, sends nothing and starts nothing
 * (base/os_process.h), whatever a damaged file makes it do. It has access to the memory of the process, so this is a
 * second line of defence, weaker than the separate process of the importer; it costs 0.1 ms. If the thread cannot be
 * created or confined, the function runs unconfined. Cancelling the caller cancels it (base/cancel.h), and it has the
 * caller's memory budget. Signals are left to other threads. */
void codec_run_confined(void (*work)(void *context), void *context);

/* ---- srgb.c ---- */

/* The sRGB-encoded value, correctly rounded to 0..maximum; 0 for NaN. */
unsigned codec_quantize(float linear, unsigned maximum);

/* codec_quantize for 0..255, faster: least[b] is the least linear value that is encoded as the byte b or a greater one
 * (least[256] is infinity). The floats from 2^-13 (less than least[1]) to 1 are divided into cells of equal sign,
 * exponent and first 7 bits of the mantissa; first[cell] is the byte of a cell's least value, and no cell has more than
 * two bytes. */
enum { CODEC_CELL_SHIFT = 16, CODEC_CELLS_FROM = 0x3900, CODEC_CELLS = 13 * 128 };
typedef struct codec_bytes {
    float least[257];
    unsigned char first[CODEC_CELLS + 1];
} codec_bytes;
void codec_bytes_prepare(codec_bytes *table);

static inline unsigned char codec_byte(const codec_bytes *table, float linear)
{
    float value = linear > 0.0f ? linear : 0.0f; /* NaN too */
    uint32_t word;
    value = value < 1.0f ? value : 1.0f;
    memcpy(&word, &value, sizeof word);
    const int32_t cell = (int32_t)(word >> CODEC_CELL_SHIFT) - CODEC_CELLS_FROM;
    const unsigned byte = table->first[cell > 0 ? cell : 0];
    return (unsigned char)(byte + (value >= table->least[byte + 1]));
}

/* Encodes count values as bytes. */
void codec_bytes_encode(const codec_bytes *table, const float *linear, size_t count, unsigned char *bytes);

/* The same as codec_quantize for 0..65535, faster. free releases the table; NULL without memory. */
typedef struct codec_words codec_words;
codec_words *codec_words_create(void);
/* Encodes count values as two bytes each, the high one first. */
void codec_words_encode(const codec_words *table, const float *linear, size_t count, unsigned char *bytes);

/* Decoding table of the encoded values 0..maximum to linear values; free it. NULL without memory. */
float *codec_decode_table(unsigned maximum);

/* ---- one file each ---- */

/* fast: PNG with less compression effort, a larger file; JPEG of quality 80, 4:2:0, a smaller one. */
status codec_png_write(const image_rows *rows, FILE *stream, int bits, bool fast, diagnostic *why);
status codec_jpeg_write(const image_rows *rows, FILE *stream, bool fast, diagnostic *why);
status codec_pfm_write(const image_rows *rows, FILE *stream, diagnostic *why);
/* fast: larger. The file is made in memory, since its table of places precedes what it points to. */
status codec_exr_write(const image_rows *rows, FILE *stream, bool fast, diagnostic *why);

/* bits: see image_read. */
status codec_png_read(const unsigned char *bytes, size_t size, image_values values, image **out, int *bits,
                      diagnostic *why);
status codec_jpeg_read(const unsigned char *bytes, size_t size, image_values values, image **out, diagnostic *why);
status codec_bmp_read(const unsigned char *bytes, size_t size, image_values values, image **out, int *bits,
                      diagnostic *why);
status codec_pfm_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why);
status codec_hdr_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why);
status codec_exr_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why);

/* image_text_read for a file of one format. */
status codec_png_text(const void *bytes, size_t size, const char *keyword, size_t limit, char **text, diagnostic *why);
status codec_exr_text(const void *bytes, size_t size, const char *keyword, size_t limit, char **text, diagnostic *why);

/* --- png_chunks.c --- */

/* The orientation of a PNG file, by its chunk eXIf; and for IMAGE_LIGHT its colour space, by the chunks cICP, iCCP,
 * sRGB, gAMA with cHRM, in this order (PNG specification, 3rd edition, 4.3). *profile is memory that the colour space
 * borrows from, for the caller to free, or NULL. What cannot be applied is added to note, "" for nothing. */
typedef struct png_space {
    codec_color color;
    int orientation;
    unsigned char *profile;
    char note[IMAGE_NOTE_MAX];
} png_space;
status png_read_space(const unsigned char *bytes, size_t size, image_values values, png_space *out, diagnostic *why);

/* --- png_bands.c --- */

/* The pixels of a PNG file, compressed by several threads. The rows are divided into bands, whose size depends only on
 * the image; each band is compressed independently and ends at a byte boundary (by deflate's empty stored block, RFC
 * 1951, 3.2.4), so that the bands one after another are one zlib stream: the file is the same for any number of
 * threads. Ownership: png_bands_create allocates, png_bands_destroy releases; for one caller at a time. */
typedef struct png_bands png_bands;

/* bits: 8 or 16. fast: less effort, a larger file. rows must exist until the bands are destroyed. */
status png_bands_create(const image_rows *rows, int bits, bool fast, png_bands **out, diagnostic *why);
void png_bands_destroy(png_bands *b); /* NULL is allowed */

/* Compresses the next bands, and returns how many; 0 after the last one. */
size_t png_bands_compress(png_bands *b);

/* Band `index` of those that png_bands_compress has just compressed, as a part of the zlib stream; false if zlib failed
 * or the work was cancelled. */
bool png_bands_get(const png_bands *b, size_t index, const unsigned char **bytes, size_t *size);

/* --- exr_colours.c --- */

/* Chroma of an image of width x height pixels, at every second column and line: (R - Y) / Y and (B - Y) / Y. Ownership:
 * create allocates, release frees. */
typedef struct exr_chroma {
    float *red, *blue; /* NULL: the image has no chroma */
    int columns, lines;
} exr_chroma;
status exr_chroma_create(exr_chroma *c, int width, int height, diagnostic *why);
void exr_chroma_release(exr_chroma *c);

/* Turns the values of a file into our colours: chroma, if there is any, into RGB (luminance is in all three channels),
 * linear RGB of these primaries into linear sRGB, and divides by alpha, which is clamped to 0..1 (alpha of 1 everywhere
 * is removed; colours with alpha 0 stay). chroma is changed. x, y: the image's first pixel in the image of which chroma
 * is. primaries: CIE xy of white, red, green, blue; NULL: those of sRGB. STATUS_BAD_INPUT for a value that is not
 * finite, and for primaries on one line. */
status exr_colours_convert(image *img, const double primaries[8], exr_chroma *chroma, int64_t x, int64_t y,
                           diagnostic *why);
