/* Internals of image/texture.h, included only by its files: the memory layout of a texture. Ownership: the texels of
 * all levels are one block, which belongs to the texture. */
#pragma once

#include "image/texture.h"

/* Padded to 16 bytes: one load reads a texel, and no texel straddles two cache lines. */
typedef struct texel {
    float r, g, b, unused;
} texel;

/* Rows from the bottom, in the direction of v: texels[y * width + x]. */
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
    size_t owners; /* changed atomically */
};

/* Computes level 1 and the levels above it from level 0. Their sizes and memory must be set. Cannot fail. */
void texture_build_pyramid(texture *t);
