/* Textures: images that are sampled by surface coordinates. u runs to the right and v upwards; the image covers the
 * unit square, (0, 0) is its lower left corner at the lower edge of the lowest row, and the centre of texel x in a row
 * of w texels is u = (x + 1/2) / w. Filtering is done in linear light, in doubles with only + - * / and floor: the same
 * bits on every machine. image_read blends alpha over black and drops it. A texture is immutable and can be shared:
 * texture_retain and texture_release count its owners (from any thread); sampling needs no lock. It copies the pixels
 * of its image. */
#pragma once

#include "base/status.h"
#include "base/vec3.h"
#include "image/image.h"
#include <stdint.h>

/* The meaning of the values in a PNG, JPEG or BMP file. image_read decodes all of them from sRGB: with TEXTURE_SRGB the
 * decoded linear light is used; with TEXTURE_LINEAR the file's own values (0 to 1) are restored, exactly to the file's
 * 8 or 16 bits if no alpha was blended. Images that were never encoded (PFM, rendered) are used unchanged with both. */
typedef enum texture_space { TEXTURE_SRGB, TEXTURE_LINEAR } texture_space;

/* The texture outside the unit square: the image repeated, mirrored at each edge (period 2), or its edge texels. */
typedef enum texture_wrap { TEXTURE_REPEAT, TEXTURE_MIRROR, TEXTURE_CLAMP } texture_wrap;

/* Nearest: the texel that contains the point. Bilinear: interpolation between the four nearest texel centres.
 * Trilinear: bilinear in the two nearest levels of a mipmap, and interpolation between these by log2 of the footprint
 * (Williams, "Pyramidal parametrics", SIGGRAPH 1983). */
typedef enum texture_filter { TEXTURE_NEAREST, TEXTURE_BILINEAR, TEXTURE_TRILINEAR } texture_filter;

enum { TEXTURE_LEVELS_MAX = 17 }; /* from 65536 = 2^16 texels a side to 1 */

typedef struct texture texture;

/* Creates a texture, whose only owner is the caller. STATUS_BAD_INPUT if a pixel is not finite or the size is not
 * allowed by image_create, STATUS_FAILURE when out of memory. */
status texture_create(const image *img, texture_space space, texture_wrap wrap_u, texture_wrap wrap_v,
                      texture_filter filter, texture **out, diagnostic *why);

/* The same from a file that must be below root (base/below.h; NULL: anywhere), with image_read's diagnostics and
 * limits. */
status texture_read_below(const char *path, const char *root, texture_space space, texture_wrap wrap_u,
                          texture_wrap wrap_v, texture_filter filter, texture **out, diagnostic *why);

void texture_retain(const texture *t);
void texture_release(const texture *t); /* NULL is allowed */

/* The texture at (u, v). footprint is the extent of a pixel in u or v, whichever is larger. Only TEXTURE_TRILINEAR uses
 * it: the level is log2(footprint * larger side in texels), from 0 (bilinear in the image itself: a pixel covers at
 * most a texel) to the last (one texel, the mean of the image). The result is finite, within the range of the texels up
 * to rounding, and, except with TEXTURE_NEAREST, continuous in all three arguments. Never fails: a coordinate that is
 * NaN, or infinite with TEXTURE_REPEAT or TEXTURE_MIRROR, counts as 0, as does a footprint that is negative or NaN. */
vec3 texture_sample(const texture *t, double u, double v, double footprint);

/* Adds the size and the texels of level 0 to a hash (base/hash.h). */
uint64_t texture_hash(const texture *t, uint64_t hash);
