/* What a texture holds, and one from a file or an image. */
#pragma once

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "image/texture_parts.h"

static inline status texture_read(const char *path, texture_space space, texture_wrap wrap_u, texture_wrap wrap_v,
                                  texture_filter filter, texture **out, diagnostic *why)
{
    return texture_read_below(path, NULL, space, wrap_u, wrap_v, filter, out, why);
}

/* The pyramid: number of levels (1 unless TEXTURE_TRILINEAR), size of one (level k has floor(w / 2^k) x floor(h / 2^k)
 * texels, at least 1 x 1), and one texel, x from the left, y from below. Each level's mean is the image's. */
static inline int texture_levels(const texture *t)
{
    return t->levels;
}

static inline void texture_size(const texture *t, int level, int *width, int *height)
{
    *width = t->level[level].width;
    *height = t->level[level].height;
}

static inline vec3 texture_texel(const texture *t, int level, int x, int y)
{
    const texture_level *from = &t->level[level];
    const texel *c = &from->texels[(size_t)y * (size_t)from->width + (size_t)x];
    return vec3_make((double)c->r, (double)c->g, (double)c->b);
}

/* Memory that it takes. */
static inline size_t texture_bytes(const texture *t)
{
    return sizeof *t + t->block_bytes;
}

static inline texture *textured(const image *img, texture_wrap wrap, texture_filter filter)
{
    texture *t;
    assert_int_equal(texture_create(img, TEXTURE_SRGB, wrap, wrap, filter, &t, NULL), STATUS_OK);
    return t;
}

/* The image is no longer needed. */
static inline texture *owned(image *img, texture_wrap wrap, texture_filter filter)
{
    texture *t = textured(img, wrap, filter);
    image_destroy(img);
    return t;
}
