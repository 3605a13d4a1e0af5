/* Memory layout of a texture, shared by the files of image/texture.h. Private to them. Ownership: all texels of all
 * levels are one block, owned by the texture. */
#pragma once

#include "image/texture.h"

/* Padded to 16 bytes: one load per texel, and no texel straddles two cache lines. */
typedef struct texel {
    float r, g, b, unused;
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
    size_t owners; /* modified atomically */
};

/* A texture with memory for its texels, which are not set; NULL if memory runs out. Sides are at least 1. */
texture *texture_allocate(int width, int height, texture_wrap wrap_u, texture_wrap wrap_v, texture_filter filter);

/* Computes level 1 and above from level 0; sizes and memory are set. Cannot fail. */
void texture_build_pyramid(texture *t);
