/* What the files of image/texture.h share: how a texture lies in memory. Nobody else includes it.
 * Ownership: all texels of all levels are one block, which belongs to the texture. */
#pragma once

#include "image/texture.h"

/* Padded to 16 bytes: one load brings a texel, and none straddles two cache lines. */
typedef struct texel {
    float r, g, b, unused;
} texel;

/* Rows from below, as v runs: texels[y * width + x]. */
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

/* Fills level 1 and those above it from level 0; sizes and memory are there. Cannot fail. */
void texture_build_pyramid(texture *t);
