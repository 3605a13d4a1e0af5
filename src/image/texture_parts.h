/* Memory layout of a texture, shared by texture.c and texture_sample_kernel.c. Private to them. Ownership: all texels
 * of all levels are one block, owned by the texture. */
#pragma once

#include "image/texture.h"
#include <stdbool.h>

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
