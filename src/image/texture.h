/* Textures: pictures that are looked up by surface coordinates. u runs to the right and v upwards; the picture covers
 * the unit square, (0, 0) is its lower left corner and the lowest row's lower edge, and the centre of texel x of a row
 * of w is u = (x + 1/2) / w. All filtering is done in linear light, in doubles with + - * / and floor alone: the same
 * bits everywhere. Alpha is what image_read makes of it: blended over black, then dropped. A texture is not changed
 * once it is made, and is shared: texture_retain and texture_release count its owners (from any thread); sampling needs
 * no lock. It keeps nothing of the picture that it was made from. */
#pragma once

#include "base/status.h"
#include "base/vec3.h"
#include "image/image.h"
#include <stdint.h>

/* What the numbers in a PNG, JPEG or BMP file stand for. image_read takes all of them for sRGB: with TEXTURE_SRGB they
 * stay the linear light that it made of them; with TEXTURE_LINEAR the file's own numbers (0 to 1) are restored, exactly
 * to the file's 8 or 16 bits where no alpha was blended. Pictures that were never coded (PFM, rendered) are taken as
 * they are in both. */
typedef enum texture_space { TEXTURE_SRGB, TEXTURE_LINEAR } texture_space;

/* What lies beyond the unit square: the picture again, its mirror image (and so on in turn, period 2), or its edge. */
typedef enum texture_wrap { TEXTURE_REPEAT, TEXTURE_MIRROR, TEXTURE_CLAMP } texture_wrap;

/* The texel that the point lies in; between the four nearest centres; or that in the two nearest levels of a pyramid
 * of ever smaller pictures, too, and between these by log2 of the footprint (Williams, "Pyramidal parametrics",
 * SIGGRAPH 1983). */
typedef enum texture_filter { TEXTURE_NEAREST, TEXTURE_BILINEAR, TEXTURE_TRILINEAR } texture_filter;

enum { TEXTURE_LEVELS_MAX = 17 }; /* 65536 = 2^16 texels a side, and 1 */

typedef struct texture texture;

/* The caller is the one owner. STATUS_BAD_INPUT when a pixel is not finite or a size not image_create's, STATUS_FAILURE
 * when memory is out. */
status texture_create(const image *img, texture_space space, texture_wrap wrap_u, texture_wrap wrap_v,
                      texture_filter filter, texture **out, diagnostic *why);

/* The same from a file that lies below root (base/below.h; NULL: anywhere): image_read's diagnostics and limits. */
status texture_read_below(const char *path, const char *root, texture_space space, texture_wrap wrap_u,
                          texture_wrap wrap_v, texture_filter filter, texture **out, diagnostic *why);

void texture_retain(const texture *t);
void texture_release(const texture *t); /* NULL is allowed */

/* The texture at (u, v). footprint is how far a pixel reaches in u or in v, whichever is more; it matters to
 * TEXTURE_TRILINEAR alone, whose level is log2(footprint * larger side in texels), from 0 (bilinear in the picture
 * itself: a pixel covers at most a texel) to the last (one texel, the picture's mean). The result is finite, within the
 * range of the texels but for rounding, and continuous in all three except where TEXTURE_NEAREST goes from texel to
 * texel. Never fails: a coordinate that is not a number, or is infinite where the picture repeats or mirrors, counts as
 * 0, and so does a footprint that is negative or not a number. */
vec3 texture_sample(const texture *t, double u, double v, double footprint);

/* Goes into a fingerprint (base/hash.h): size and texels of the picture itself. */
uint64_t texture_hash(const texture *t, uint64_t hash);
