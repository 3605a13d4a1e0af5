/* Textures: images sampled by surface coordinates. u points right and v up; the image covers the unit square, (0, 0) is
 * its lower left corner, and the centre of texel x in a row of w is u = (x + 1/2) / w. Filtering is linear, in doubles
 * with + - * / and floor only: bit-identical everywhere. A texture is immutable and shared: texture_retain and
 * texture_release count references (thread safe); sampling needs no lock. It keeps nothing of its source image. */
#pragma once

#include "base/isa.h"
#include "base/pack.h"
#include "base/status.h"
#include "base/vec3.h"
#include "image/image.h"
#include <stdbool.h>
#include <stdint.h>

/* The meaning of the values in a file (image_values of image.h). TEXTURE_SRGB: colours, IMAGE_LIGHT. TEXTURE_LINEAR:
 * data, IMAGE_CODED. TEXTURE_GLTF: colours of a glTF file, IMAGE_SRGB: it ignores what images say of their space. */
typedef enum texture_space { TEXTURE_SRGB, TEXTURE_LINEAR, TEXTURE_GLTF } texture_space;

/* Coordinates outside the unit square: repeat, mirror (period 2), or clamp to the edge. */
typedef enum texture_wrap { TEXTURE_REPEAT, TEXTURE_MIRROR, TEXTURE_CLAMP } texture_wrap;

/* The nearest texel; bilinear interpolation of the four nearest; or trilinear interpolation between the two nearest
 * levels of a mipmap, by log2 of the footprint (Williams, "Pyramidal parametrics", SIGGRAPH 1983). */
typedef enum texture_filter { TEXTURE_NEAREST, TEXTURE_BILINEAR, TEXTURE_TRILINEAR } texture_filter;

enum { TEXTURE_LEVELS_MAX = 17 }; /* sides of 2^16 = 65536 to 2^0 = 1 texels */

typedef struct texture texture;

/* The caller has the only reference. The values are used as they are; small negative ones are 0, with a note.
 * STATUS_BAD_INPUT for an image that image_check_light or image_create refuses, STATUS_FAILURE if memory runs out. */
status texture_create(const image *img, texture_wrap wrap_u, texture_wrap wrap_v, texture_filter filter, texture **out,
                      diagnostic *why);

/* The same from a file below root (below_open of base/file.h; NULL: anywhere): with image_read's diagnostics and
 * limits. */
status texture_read_below(const char *path, const char *root, texture_space space, texture_wrap wrap_u,
                          texture_wrap wrap_v, texture_filter filter, texture **out, diagnostic *why);

/* The same from the bytes of an image file; the diagnostic has no place. */
status texture_decode(const void *bytes, size_t size, texture_space space, texture_wrap wrap_u, texture_wrap wrap_v,
                      texture_filter filter, texture **out, diagnostic *why);

/* What reading the file ignored or changed, "" for nothing; valid as long as t. A packed texture has none. */
const char *texture_note(const texture *t);

void texture_retain(const texture *t);
void texture_release(const texture *t); /* NULL is allowed */

/* The size of the image itself, in texels. */
void texture_size(const texture *t, int *width, int *height);

/* The texture at (u, v). footprint is the size of a pixel in u or v, whichever is larger; it applies to
 * TEXTURE_TRILINEAR only, whose level is log2(footprint * larger side in texels), from 0 (bilinear in the image itself:
 * a pixel covers at most a texel) to the last (one texel, the mean of the image). The result is finite, within the
 * range of the texels up to rounding, and continuous in all three arguments except for TEXTURE_NEAREST at texel
 * boundaries. Never fails: a NaN coordinate, or an infinite one with repeat or mirror, counts as 0, and so does a
 * negative or NaN footprint. */
vec3 texture_sample(const texture *t, double u, double v, double footprint);

/* Multiplies colours by the texture at each of count points: texture_sample, once for each instruction set, with
 * bit-identical results. */
typedef void texture_tinter(const texture *t, int count, const double *u, const double *v, const double *footprint,
                            double *r, double *g, double *b);
ISA_DECLARE(texture_tinter, texture_tint)

/* Alpha. A texture by itself ignores it: its colours are those of the file. If some texel's alpha is below 1, it has a
 * covered texture besides, which texture_covered returns; otherwise that is NULL. It is borrowed, and lives as long as
 * t. Its texels and levels are filtered after multiplication by alpha, and the colour is then divided by the filtered
 * alpha (Porter and Duff, "Compositing digital images", SIGGRAPH 1984): what a transparent texel stores as colour,
 * often black or white, does not show at the edges of the texels around it. */
const texture *texture_covered(const texture *t);
/* The alpha of a covered texture at (u, v), 0 to 1: by the nearest texel or between the nearest four, always of the
 * image itself, so that it does not depend on who looks from how far. */
double texture_alpha(const texture *covered, double u, double v);

/* Adds size and texels of the image itself to a hash (base/hash.h), with alpha if some is below 1. */
uint64_t texture_hash(const texture *t, uint64_t hash);
/* Adds wrap and filter, unless they are those of OBJ files: repeat and trilinear. */
uint64_t texture_sampler_hash(const texture *t, uint64_t hash);

/* A texture as bytes (base/pack.h): the image itself travels, and the receiver computes the smaller levels again.
 * Unpacking checks the sizes, and that texels are finite; the caller owns the result. STATUS_BAD_INPUT for damaged
 * bytes, STATUS_FAILURE without memory. */
status texture_pack(const texture *t, pack_writer *to, diagnostic *why);
status texture_unpack(pack_reader *from, const texture **out, diagnostic *why);

/* Memory layout of a texture, shared by texture.c and texture_sample_kernel.c. Private to them. Ownership: all texels
 * of all levels are one block, owned by the texture. */

typedef double texture_alpha_reader(const texture *covered, double u, double v);
ISA_DECLARE(texture_alpha_reader, texture_alpha)

/* One load per texel, and no texel straddles two cache lines. */
typedef struct texel {
    float r, g, b, alpha;
} texel;

/* Rows from the bottom, like v: texels[y * width + x]. */
typedef struct texture_level {
    int width, height;
    texel *texels;
} texture_level;

struct texture {
    texture_wrap wrap_u, wrap_v;
    texture_filter filter;
    int levels;
    texture_level level[TEXTURE_LEVELS_MAX];
    texel *block;
    size_t block_bytes;
    struct texture *covered; /* see texture_covered; NULL: none */
    char note[IMAGE_NOTE_MAX];
    bool multiplied; /* a covered texture: colours are multiplied by alpha */
    size_t owners;   /* modified atomically */
};
