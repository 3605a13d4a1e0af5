/* Pictures in memory and on disk: PNG (libpng), JPEG (libjpeg-turbo), PFM (Debevec); in alone: BMP. No time stamps, the
 * same bytes for the same picture; files appear whole or not at all. Ownership: image_create and
 * image_read give a picture to the caller, image_destroy releases it. */
#pragma once

#include "base/status.h"
#include <stdbool.h>

/* RGB, linear light, rows from the top, pixel[(y * width + x) * 3 + channel]; 1.0 is white. coded_bits is 8 or 16 when
 * image_read decoded the pixels from sRGB numbers of so many bits, else 0. */
typedef struct image {
    int width, height;
    float *pixel;
    int coded_bits, owners;
} image;

enum { IMAGE_SIDE_MAX = 65536 };

/* Black picture, 1 <= width, height <= IMAGE_SIDE_MAX. */
status image_create(int width, int height, image **out, diagnostic *why);
void image_destroy(image *img);

/* One more owner of a picture that nobody changes from now on: image_destroy then releases it when the last one has
 * called it, from any thread. */
image *image_share(const image *img);

/* The sRGB transfer function, IEC 61966-2-1, both ways. Values under 0 and over 1 are clamped by the encoder. */
double srgb_encode(double linear);
double srgb_decode(double encoded);

/* Which format the ending of a file's name stands for: .png .jpg .jpeg .pfm (letter case ignored). "-" (standard
 * output) and what lies under /dev/ have no ending and are PNG. */
typedef enum image_format {
    IMAGE_UNKNOWN,
    IMAGE_PNG,
    IMAGE_JPEG,
    IMAGE_PFM,
    IMAGE_BMP
} image_format; /* IMAGE_BMP: for reading alone, no ending's */
image_format image_format_of(const char *path);

/* PNG at 8 or 16 bits and JPEG (quality 92, 4:4:4) are sRGB-encoded, with a PNG sRGB chunk, correctly rounded, NaN as
 * 0; PFM is linear, little-endian float. bits matters to PNG only. */
status image_write(const image *img, const char *path, int bits, diagnostic *why);

/* The same into fresh memory, the caller's. bits: 8 or 16. fast: a PNG is compressed with less effort, for one who
 * waits. */
status image_encode(const image *img, image_format format, int bits, bool fast, unsigned char **bytes, size_t *size,
                    diagnostic *why);

/* Reads PNG (any depth and kind; alpha is dropped after blending over black), JPEG (grey or RGB), PFM (colour or
 * grey, either byte order, finite) or BMP (24 bits, uncompressed), told by its first bytes, not by its name; PNG, JPEG
 * and BMP are decoded from sRGB to linear. Truncated, damaged or larger than 2^28 pixels is STATUS_BAD_INPUT.
 * file_bits, when not NULL, receives 8 or 16 for PNG, 8 for JPEG and BMP, and 32 for PFM. */
status image_read(const char *path, image **out, int *file_bits, diagnostic *why);
/* The same of a file that lies below root (base/below.h). */
status image_read_below(const char *path, const char *root, image **out, int *file_bits, diagnostic *why);
