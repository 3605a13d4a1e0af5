/* The file formats behind image.h: three that are written and read, and BMP, which is only read. Writers write an image
 * to a stream and leave stream errors to the caller that closes it; readers decode a whole file in memory. Diagnostics
 * lack the file name. Ownership: an image that was read is the caller's; nothing is allocated unless the status is
 * STATUS_OK. */
#pragma once

#include "image/image.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Maximum number of pixels of an image file, 2^28. */
#define CODEC_PIXELS_MAX 268435456LL

/* Maximum number of pixels per byte of the file, for images larger than CODEC_PIXELS_FREE. Deflate can reach 8256 (1032
 * to 1, RFC 1951, eight pixels per byte), which expands a file of kilobytes to gigabytes; photographs and renderings
 * stay far below 64. */
#define CODEC_PIXELS_FREE 16777216LL
#define CODEC_PIXELS_A_BYTE 64LL

/* STATUS_BAD_INPUT unless a file with that many bytes may have this size. */
status codec_check_size(long long width, long long height, size_t file_bytes, diagnostic *why);

/* Creates an image of the size in the file, and the decoding table of its values 0..maximum. Both are the caller's,
 * even after a failure. */
status codec_begin(long long width, long long height, size_t file_bytes, unsigned maximum, image **img, float **linear,
                   diagnostic *why);

/* The sRGB-encoded value, correctly rounded to 0..maximum; 0 for NaN. */
unsigned codec_quantize(float linear, unsigned maximum);

/* The same for 0..255, faster: least[b] is the least linear value that is encoded as the byte b or a greater one. */
typedef struct codec_bytes {
    float least[256];
} codec_bytes;
void codec_bytes_prepare(codec_bytes *table);
unsigned char codec_byte(const codec_bytes *table, float linear);
/* Decoding table of the encoded values 0..maximum to linear values; free it. NULL without memory. */
float *codec_decode_table(unsigned maximum);

/* fast: less compression effort, a larger file. */
status codec_png_write(const image *img, FILE *stream, int bits, bool fast, diagnostic *why);
status codec_jpeg_write(const image *img, FILE *stream, diagnostic *why);
status codec_pfm_write(const image *img, FILE *stream, diagnostic *why);

status codec_png_read(const unsigned char *bytes, size_t size, image **out, int *bits, diagnostic *why);
status codec_jpeg_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why);
status codec_pfm_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why);
status codec_bmp_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why);
