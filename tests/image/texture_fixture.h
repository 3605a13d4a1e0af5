/* What a texture holds, one from a file or an image, and comparisons. */
#pragma once

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "image/texture.h"

#include <math.h>

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

static inline void level_size(const texture *t, int level, int *width, int *height)
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
    assert_int_equal(texture_create(img, wrap, wrap, filter, &t, NULL), STATUS_OK);
    return t;
}

/* The image is no longer needed. */
static inline texture *owned(image *img, texture_wrap wrap, texture_filter filter)
{
    texture *t = textured(img, wrap, filter);
    image_destroy(img);
    return t;
}

static inline void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g is not %.17g within %g", a, b, tolerance);
}

static inline void assert_same(vec3 a, vec3 b, double tolerance)
{
    assert_near(a.x, b.x, tolerance);
    assert_near(a.y, b.y, tolerance);
    assert_near(a.z, b.z, tolerance);
}

static inline image *blank(int width, int height)
{
    image *img;
    assert_int_equal(image_create(width, height, &img, NULL), STATUS_OK);
    return img;
}

/* Sets the texel x from the left and y from below. */
static inline void set(image *img, int x, int y, double r, double g, double b)
{
    float *pixel = img->pixel + ((size_t)(img->height - 1 - y) * (size_t)img->width + (size_t)x) * 3;
    pixel[0] = (float)r;
    pixel[1] = (float)g;
    pixel[2] = (float)b;
}
