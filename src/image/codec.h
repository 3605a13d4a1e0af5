/* The codecs behind image.h: PNG, JPEG and PFM, which are read and written, and BMP, which is read only. Writers write
 * an image to a stream; whoever closes the stream checks it for errors. Readers decode a whole file in memory.
 * Diagnostics do not name the file. Ownership: an image that is read belongs to the caller; unless the status is
 * STATUS_OK, nothing stays allocated. */
#pragma once

#include "image/image.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* The most pixels of an image from disk, 2^28. */
#define CODEC_PIXELS_MAX 268435456LL

/* The most pixels per byte of the file, for an image of more than CODEC_PIXELS_FREE pixels. Deflate can reach 8256
 * (1032 to 1, RFC 1951, eight pixels in a byte), which expands a file of kilobytes to gigabytes; photographs and
 * renderings stay far below 64. */
#define CODEC_PIXELS_FREE 16777216LL
#define CODEC_PIXELS_A_BYTE 64LL

/* STATUS_BAD_INPUT unless a file of file_bytes bytes may have this width and height. */
status codec_check_size(long long width, long long height, size_t file_bytes, diagnostic *why);

/* Creates an image of the width and height that a file of file_bytes bytes claims, and the decoding table of its values
 * 0..maximum. Both belong to the caller, also when this fails: then either may be NULL. */
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
/* The linear light of the encoded values 0..maximum; the caller frees it. NULL when out of memory. */
float *codec_decode_table(unsigned maximum);

/* fast: compresses with less effort, to a larger file. */
status codec_png_write(const image *img, FILE *stream, int bits, bool fast, diagnostic *why);
status codec_jpeg_write(const image *img, FILE *stream, diagnostic *why);
status codec_pfm_write(const image *img, FILE *stream, diagnostic *why);

status codec_png_read(const unsigned char *bytes, size_t size, image **out, int *bits, diagnostic *why);
status codec_jpeg_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why);
status codec_pfm_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why);
status codec_bmp_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why);
