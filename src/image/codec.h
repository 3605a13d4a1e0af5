/* The file formats behind image.h: three that are written and read, and BMP, which is read. Writers put a picture on a
 * stream and leave the stream's own errors to whoever closes it; readers decode a whole file that lies in memory.
 * Diagnostics are filled without the file's name. Ownership: a read picture is the caller's; nothing is allocated when
 * a status other than STATUS_OK comes back. */
#pragma once

#include "image/image.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* As many pixels as a picture from disk may have, 2^28. */
#define CODEC_PIXELS_MAX 268435456LL

/* So many pixels for each byte of its file may a picture have that is larger than CODEC_PIXELS_FREE. Deflate can reach
 * 8256 (1032 to 1, RFC 1951, eight pixels in a byte), which makes gigabytes of a file of kilobytes; photographs and
 * renderings stay far below 64. */
#define CODEC_PIXELS_FREE 16777216LL
#define CODEC_PIXELS_A_BYTE 64LL

/* STATUS_BAD_INPUT unless a file of so many bytes may have this size. */
status codec_check_size(long long width, long long height, size_t file_bytes, diagnostic *why);

/* A picture of the size that a file of so many bytes claims, and the decoding table of its values 0..maximum. Both are
 * the caller's, also of what there is when this fails. */
status codec_begin(long long width, long long height, size_t file_bytes, unsigned maximum, image **img, float **linear,
                   diagnostic *why);

/* sRGB-encoded and correctly rounded to 0..maximum; NaN is 0. */
unsigned codec_quantize(float linear, unsigned maximum);

/* The same for 0..255, faster: least[b] is the least linear value that becomes the byte b or a greater one. */
typedef struct codec_bytes {
    float least[256];
} codec_bytes;
void codec_bytes_prepare(codec_bytes *table);
unsigned char codec_byte(const codec_bytes *table, float linear);
/* Linear light of the encoded values 0..maximum; free it. NULL without memory. */
float *codec_decode_table(unsigned maximum);

/* fast: with less effort, a larger file. */
status codec_png_write(const image *img, FILE *stream, int bits, bool fast, diagnostic *why);
status codec_jpeg_write(const image *img, FILE *stream, diagnostic *why);
status codec_pfm_write(const image *img, FILE *stream, diagnostic *why);

status codec_png_read(const unsigned char *bytes, size_t size, image **out, int *bits, diagnostic *why);
status codec_jpeg_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why);
status codec_pfm_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why);
status codec_bmp_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why);
