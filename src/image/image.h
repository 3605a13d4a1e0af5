/* Images in memory and on disk: PNG (libpng), JPEG (libjpeg-turbo) and PFM (Debevec); BMP can only be read. Files hold
 * no time stamps, so that equal images give equal bytes; they are written completely or not at all. Ownership:
 * image_create and image_read give an image to the caller, image_destroy releases it. */
#pragma once

#include "base/status.h"
#include <stdbool.h>

/* RGB, linear light, rows from the top, pixel[(y * width + x) * 3 + channel]; 1.0 is white. coded_bits is 8 or 16 if
 * image_read decoded the pixels from sRGB values of that many bits, else 0. */
typedef struct image {
    int width, height;
    float *pixel;
    int coded_bits, owners;
} image;

enum { IMAGE_SIDE_MAX = 65536 };

/* Creates a black image, 1 <= width, height <= IMAGE_SIDE_MAX. */
status image_create(int width, int height, image **out, diagnostic *why);
void image_destroy(image *img);

/* Adds an owner to an image, which must not be changed afterwards. Each owner calls image_destroy, from any thread; the
 * last call frees the image. */
image *image_share(const image *img);

/* The sRGB transfer function, IEC 61966-2-1, and its inverse. The encoder clamps values to 0..1. */
double srgb_encode(double linear);
double srgb_decode(double encoded);

/* The format of a file by its extension: .png .jpg .jpeg .pfm (in any letter case). "-" (standard output) and paths
 * below /dev/ have no extension and are PNG. */
typedef enum image_format {
    IMAGE_UNKNOWN,
    IMAGE_PNG,
    IMAGE_JPEG,
    IMAGE_PFM,
    IMAGE_BMP
} image_format; /* IMAGE_BMP can only be read; image_format_of never returns it */
image_format image_format_of(const char *path);

/* Writes an image. PNG of 8 or 16 bits and JPEG (quality 92, 4:4:4) are sRGB-encoded and correctly rounded, NaN as 0;
 * PNG has an sRGB chunk. PFM is linear, little-endian float. bits is used for PNG only. */
status image_write(const image *img, const char *path, int bits, diagnostic *why);

/* Writes an image to new memory, which belongs to the caller. bits: 8 or 16. fast: compresses a PNG with less effort,
 * for interactive use. */
status image_encode(const image *img, image_format format, int bits, bool fast, unsigned char **bytes, size_t *size,
                    diagnostic *why);

/* Reads PNG (any depth and kind; alpha is dropped after blending over black), JPEG (grey or RGB), PFM (colour or
 * grey, either byte order, finite) or BMP (24 bits, uncompressed), recognised by its first bytes, not by its name; PNG,
 * JPEG and BMP are decoded from sRGB to linear. A file that is truncated, damaged or larger than 2^28 pixels is
 * STATUS_BAD_INPUT. file_bits, if not NULL, is set to 8 or 16 for PNG, 8 for JPEG and BMP, and 32 for PFM. */
status image_read(const char *path, image **out, int *file_bits, diagnostic *why);
/* The same for a file that must be below root (base/below.h). */
status image_read_below(const char *path, const char *root, image **out, int *file_bits, diagnostic *why);
