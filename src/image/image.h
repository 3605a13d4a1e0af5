/* Images in memory and in files: PNG (libpng), JPEG (libjpeg-turbo), PFM (Debevec), OpenEXR; BMP and Radiance's HDR for
 * reading only. No time stamps, the same bytes for the same image; files are written atomically. Ownership:
 * image_create and image_read allocate an image, image_destroy releases it. */
#pragma once

#include "base/budget.h"
#include "base/pack.h"
#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* ---- tone: how an image of 8 bits shows radiance ----
 *
 * Exposure and tone curve, before the sRGB encoding. Files of numbers (PFM, OpenEXR, PNG with 16 bits) keep the linear
 * values, and so do films and comparisons. Pure; cannot fail. */

typedef enum tone_curve { TONE_NONE, TONE_REINHARD, TONE_ACES } tone_curve;

/* All zero: values are shown as they are. */
typedef struct image_tone {
    double exposure; /* stops: values are multiplied by 2^exposure before the curve */
    int64_t curve;   /* tone_curve */
    double white;    /* Reinhard's: the least luminance, after the exposure, that is shown as white */
} image_tone;

/* Whether the tone changes no value. */
bool image_tone_is_plain(const image_tone *t);

/* Applies the tone to linear RGB values in place. Values that are not positive, and NaN, stay so. */
void image_tone_apply(const image_tone *t, float *rgb, size_t pixels);

/* ---- images ---- */

enum { IMAGE_NOTE_MAX = 256 };

/* RGB, linear, rows from the top, pixel[(y * width + x) * 3 + channel]; 1.0 is white. alpha[y * width + x], 0 to 1,
 * NULL: 1 everywhere; only textures use it, and neither a packed nor a written image has it. Colours are not multiplied
 * by alpha. tone: exposure and curve for files with 8 bits. note: what reading a file ignored or changed, "" for
 * nothing; it is neither packed nor written. */
typedef struct image {
    int width, height;
    float *pixel, *alpha;
    int owners;
    image_tone tone;
    char note[IMAGE_NOTE_MAX];
} image;

enum { IMAGE_SIDE_MAX = 65536 };

/* A black image, 1 <= width, height <= IMAGE_SIDE_MAX. */
status image_create(int width, int height, image **out, diagnostic *why);
void image_destroy(image *img);

/* Adds a reference to an image that is constant from now on: the last image_destroy releases it. Thread safe. */
image *image_retain(const image *img);

/* Gives the image alpha: 1 everywhere, for the caller to change. STATUS_FAILURE without memory. */
status image_add_alpha(image *img, diagnostic *why);

/* Adds to a note. */
void image_note(char note[IMAGE_NOTE_MAX], const char *text, ...) __attribute__((format(printf, 2, 3)));

/* Light is not negative, but resampling of images with sharp bright parts leaves small negative values: those down
 * to a tenth of the largest value, which the caller replaces by 0, are added to the note. STATUS_BAD_INPUT for
 * larger ones, and for values that are not finite. *largest, if not NULL: the largest value, at least 0. */
status image_check_light(const image *img, char note[IMAGE_NOTE_MAX], float *largest, diagnostic *why);

/* Packs an image as bytes (base/pack.h), without its tone, and unpacks it; pixel values are not checked. The caller
 * owns the unpacked image. STATUS_BAD_INPUT for damaged bytes, STATUS_FAILURE without memory. */
status image_pack(const image *img, pack_writer *to, diagnostic *why);
status image_unpack(pack_reader *from, image **out, diagnostic *why);
/* Whether both sides are allowed, and the rest of the package can hold that many pixels of `pixel` bytes. */
bool image_pack_holds(const pack_reader *from, int64_t width, int64_t height, size_t pixel);

/* The sRGB transfer function, IEC 61966-2-1, and its inverse. The encoder clamps to 0..1. */
double srgb_encode(double linear);
double srgb_decode(double encoded);

/* The format of a file name extension: .png .jpg .jpeg .pfm .exr (case insensitive). "-" (standard output) and files in
 * /dev/ have no extension and are PNG. */
typedef enum image_format {
    IMAGE_UNKNOWN,
    IMAGE_PNG,
    IMAGE_JPEG,
    IMAGE_PFM,
    IMAGE_EXR,
    IMAGE_BMP,
    IMAGE_HDR
} image_format; /* IMAGE_BMP, IMAGE_HDR: for reading only; image_format_of never returns them */
image_format image_format_of(const char *path);
/* Whether files of the format hold the radiance itself, as floats. */
static inline bool image_format_is_float(image_format format)
{
    return format == IMAGE_PFM || format == IMAGE_EXR;
}
/* For texts: the endings of files that are written; those of maps, with a colour scale or as numbers. */
#define IMAGE_ENDINGS ".png, .jpg, .pfm or .exr"
#define IMAGE_MAP_ENDINGS ".png with a colour scale, .pfm or .exr with the numbers"

/* A text that a file carries with its pixels: compressed iTXt of PNG (PNG specification, 11.3.3), or a string attribute
 * of OpenEXR; UTF-8. keyword: 1 to 31 letters and spaces. Borrowed. */
typedef struct image_text {
    const char *keyword, *text;
} image_text;
enum { IMAGE_TEXTS_MAX = 6 };

/* Another value of each pixel, which only an OpenEXR file holds: value(of, y * width + x). name: LAYER.CHANNEL, at most
 * 31 letters; R, G and B are the image's own. Borrowed. */
typedef struct image_channel {
    const char *name;
    float (*value)(const void *of, size_t pixel);
    const void *of;
} image_channel;
enum { IMAGE_CHANNELS_MORE = 64, IMAGE_CHANNELS_MAX = IMAGE_CHANNELS_MORE + 32 };

/* An image that is computed row by row while it is written, with texts (of PNG and OpenEXR) and channels (of OpenEXR).
 * read writes row y, 3 x width values as in image, to rgb; several threads call it at once. read may be NULL if there
 * are channels: the file has only these. */
typedef struct image_rows {
    int width, height;
    void (*read)(const void *of, int y, float *rgb);
    const void *of;
    const image_text *texts;
    int text_count; /* at most IMAGE_TEXTS_MAX */
    const image_channel *channels;
    int channel_count; /* at most IMAGE_CHANNELS_MAX */
    image_tone tone;
} image_rows;
image_rows image_rows_of(const image *img);

/* PNG with 8 bits and JPEG are written with the image's tone, the other formats without. PNG with 8 or 16 bits and JPEG
 * (quality 92, 4:4:4) are sRGB-encoded, with a PNG sRGB chunk, correctly rounded, NaN as 0; PFM has linear,
 * little-endian floats, OpenEXR linear floats compressed by ZIP, with the chromaticities of sRGB. bits applies to PNG
 * only. PNG is compressed with a thread per processing unit, at most 16; the file does not depend on their number.
 * After a cancellation (cancel_hurries) it is compressed less. */
status image_write(const image *img, const char *path, int bits, diagnostic *why);
status image_write_rows(const image_rows *rows, const char *path, int bits, diagnostic *why);

/* The same into newly allocated memory, which the caller frees. bits: 8 or 16. fast: less compression of PNG, and JPEG
 * of quality 80, 4:2:0, for interactive use. */
status image_encode(const image *img, image_format format, int bits, bool fast, unsigned char **bytes, size_t *size,
                    diagnostic *why);
status image_encode_rows(const image_rows *rows, image_format format, int bits, bool fast, unsigned char **bytes,
                         size_t *size, diagnostic *why);

/* Adds the disk space of `count` image files with 8 bits. The size of PFM is exact; the least size of other formats
 * assumes the best possible compression, the largest of OpenEXR six channels. */
void image_room(image_format format, double width, double height, double count, disk_room *to);

/* Whether the bytes begin as a PNG file does. */
bool image_is_png(const void *bytes, size_t size);

/* Whether the bytes begin as a file that can hold a text: PNG, OpenEXR. */
bool image_holds_text(const void *bytes, size_t size);
/* Reads the text with that keyword before the pixels of such a file, into new memory; *text is NULL if there is none.
 * STATUS_BAD_INPUT if the file is damaged before the pixels, or the text is damaged or longer than limit. */
status image_text_read(const void *bytes, size_t size, const char *keyword, size_t limit, char **text, diagnostic *why);

/* The formats that are read, for messages. */
#define IMAGE_FORMATS "PNG, JPEG, BMP, PFM, Radiance HDR or OpenEXR"

/* What the pixels shall be. IMAGE_LIGHT: linear light with the primaries of sRGB, by the colour space of the file, or
 * by sRGB where a PNG, JPEG or BMP file has none. IMAGE_SRGB: by sRGB, whatever such a file says. IMAGE_CODED: the
 * values of such a file as they are, 0 to 1. Files of floats have one and the same values in all cases. */
typedef enum image_values { IMAGE_LIGHT, IMAGE_SRGB, IMAGE_CODED } image_values;

/* Reads PNG (any depth and kind; colours as they are stored, whatever their alpha), JPEG (grey, RGB, CMYK), BMP (1 to
 * 32 bits), PFM (colour or grey, either byte order, finite), Radiance HDR or OpenEXR (exr.c; finite), recognised by the
 * first bytes, not by the name, as IMAGE_LIGHT. Images that are stored lying on a side are turned upright (EXIF).
 * STATUS_BAD_INPUT for truncated or damaged files, and for more than 2^28 pixels. file_bits, if not NULL, receives the
 * bits of a channel: 8 or 16 for PNG and BMP, 8 for JPEG, and 32 for floats. */
status image_read(const char *path, image **out, int *file_bits, diagnostic *why);
/* The same for the bytes of a file, which may have come from inside another; the diagnostic has no place. */
status image_decode(const void *bytes, size_t size, image_values values, image **out, int *file_bits, diagnostic *why);
/* The same for a file below root (below_open of base/file.h). */
status image_read_below(const char *path, const char *root, image_values values, image **out, int *file_bits,
                        diagnostic *why);
