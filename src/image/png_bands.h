/* The pixels of a PNG file, compressed by several threads. The rows are divided into bands, whose size depends only on
 * the image; each band is compressed independently and ends at a byte boundary (by deflate's empty stored block, RFC
 * 1951, 3.2.4), so that the bands one after another are one zlib stream: the file is the same for any number of
 * threads. Ownership: png_bands_create allocates, png_bands_destroy releases; for one caller at a time. */
#pragma once

#include "image/codec.h"

typedef struct png_bands png_bands;

/* bits: 8 or 16. fast: less effort, a larger file. rows must exist until the bands are destroyed. */
status png_bands_create(const image_rows *rows, int bits, bool fast, png_bands **out, diagnostic *why);
void png_bands_destroy(png_bands *b); /* NULL is allowed */

/* Compresses the next bands, and returns how many; 0 after the last one. */
size_t png_bands_compress(png_bands *b);

/* Band `index` of those that png_bands_compress has just compressed, as a part of the zlib stream; false if zlib failed
 * or the work was cancelled. */
bool png_bands_get(const png_bands *b, size_t index, const unsigned char **bytes, size_t *size);
