/* Sampling of a texture: nearest, bilinear, trilinear. One source for all instruction sets, with bit-identical
 * results. */
#include "base/isa.h"
#include "base/lanes.h"
#include "image/texture.h"
#include <math.h>

/* ---- a texel and a colour as vectors of four, in the vector extensions that gcc and clang share ---- */

/* Without AVX compilers warn about passing wide vectors to functions; all functions here are inlined. */
#pragma GCC diagnostic ignored "-Wpsabi"

typedef float texel4 __attribute__((vector_size(16)));
typedef double color4 __attribute__((vector_size(32)));

ALWAYS_INLINE color4 color_of_texel(const texel *t)
{
    return __builtin_convertvector(*(const texel4 *)(const void *)t, color4);
}

ALWAYS_INLINE color4 color_mix(color4 from, color4 to, double part)
{
    const color4 weight = {part, part, part, part};
    return from + weight * (to - from);
}

/* ---- positions ---- */

/* Maps coordinates to positions in the image, 0 to 1; the comparisons map NaN to 0. */
static void repeat(int count, const double *restrict c, double *restrict place)
{
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        const double p = c[i] - floor(c[i]); /* 1 for the largest numbers below 0 */
        place[i] = blend(mask_less(0.0, p), p, 0.0);
    }
}

static void mirror(int count, const double *restrict c, double *restrict place)
{
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        const double away = magnitude(c[i]), once = away - 2.0 * floor(0.5 * away);
        const double p = blend(mask_less(1.0, once), 2.0 - once, once);
        place[i] = blend(mask_less(0.0, p), p, 0.0);
    }
}

static void clamp(int count, const double *restrict c, double *restrict place)
{
    /* VECTORISE */
    for (int i = 0; i < count; i++)
        place[i] = blend(mask_less(0.0, c[i]), blend(mask_less(c[i], 1.0), c[i], 1.0), 0.0);
}

static void fold(texture_wrap wrap, int count, const double *c, double *place)
{
    switch (wrap) {
    case TEXTURE_REPEAT: repeat(count, c, place); break;
    case TEXTURE_MIRROR: mirror(count, c, place); break;
    case TEXTURE_CLAMP: clamp(count, c, place); break;
    }
}

/* The two texels of an axis whose centres enclose a position, and the fraction between them. */
typedef struct between {
    size_t low, high;
    double part;
} between;

ALWAYS_INLINE between locate(double place, int size, texture_wrap wrap)
{
    double x = place * size - 0.5;
    int low = (int)x;
    low -= x < (double)low; /* floor without a function call */
    int high = low + 1;
    between b;
    b.part = x - (double)low;
    /* repeat wraps around; clamp and mirror repeat the edge texel */
    b.low = (size_t)(low >= 0 ? low : wrap == TEXTURE_REPEAT ? size - 1 : 0);
    b.high = (size_t)(high < size ? high : wrap == TEXTURE_REPEAT ? 0 : size - 1);
    return b;
}

/* ---- filters ---- */

ALWAYS_INLINE color4 nearest(const texture *t, double u, double v)
{
    const texture_level *l = &t->level[0];
    int x = (int)(u * l->width), y = (int)(v * l->height);
    x = x < l->width ? x : l->width - 1;
    y = y < l->height ? y : l->height - 1;
    return color_of_texel(&l->texels[(size_t)y * (size_t)l->width + (size_t)x]);
}

ALWAYS_INLINE color4 bilinear(const texture *t, int level, double u, double v)
{
    const texture_level *l = &t->level[level];
    between x = locate(u, l->width, t->wrap_u), y = locate(v, l->height, t->wrap_v);
    const texel *below = l->texels + y.low * (size_t)l->width, *above = l->texels + y.high * (size_t)l->width;
    return color_mix(color_mix(color_of_texel(below + x.low), color_of_texel(below + x.high), x.part),
                     color_mix(color_of_texel(above + x.low), color_of_texel(above + x.high), x.part), y.part);
}

/* The mipmap level of each sample, as a real number: the level at which a texel is as large as the pixel (Williams
 * 1983). Negative for a pixel that covers at most a texel; beyond the last level for a pixel that covers the image. */
static void find_heights(const texture *t, int count, const double *restrict footprint, double *restrict height)
{
    const double side = t->level[0].width > t->level[0].height ? t->level[0].width : t->level[0].height;
    const double beyond = t->levels, largest = (double)(1 << (t->levels - 1));
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        const double texels = footprint[i] * side;
        const int64_t above = mask_less(1.0, texels), below = mask_less(texels, largest);
        const double inner = elementary_log2_inline(blend(above & below, texels, 1.0));
        height[i] = blend(above, blend(below, inner, beyond), -1.0);
    }
}

ALWAYS_INLINE color4 trilinear(const texture *t, double u, double v, double height)
{
    const int last = t->levels - 1;
    if (height < 0.0)
        return bilinear(t, 0, u, v);
    if (height > (double)last)
        return bilinear(t, last, u, v);
    int level = (int)height;
    level = level < last ? level : last - 1; /* the logarithm may round up to the last level */
    return color_mix(bilinear(t, level, u, v), bilinear(t, level + 1, u, v), height - level);
}

enum { STRIP = 64 };

ALWAYS_INLINE void tint_strip(const texture *t, texture_filter filter, int count, const double *u, const double *v,
                              const double *height, double *r, double *g, double *b)
{
    for (int i = 0; i < count; i++) {
        const color4 c = filter == TEXTURE_NEAREST    ? nearest(t, u[i], v[i])
                         : filter == TEXTURE_BILINEAR ? bilinear(t, 0, u[i], v[i])
                                                      : trilinear(t, u[i], v[i], height[i]);
        r[i] *= c[0], g[i] *= c[1], b[i] *= c[2];
    }
}

/* tint_strip for a covered texture: one that is seen has alpha above 0 at its full size, and so in every level. */
static void tint_covered(const texture *t, int count, const double *u, const double *v, const double *height, double *r,
                         double *g, double *b)
{
    for (int i = 0; i < count; i++) {
        const color4 c = t->filter == TEXTURE_NEAREST    ? nearest(t, u[i], v[i])
                         : t->filter == TEXTURE_BILINEAR ? bilinear(t, 0, u[i], v[i])
                                                         : trilinear(t, u[i], v[i], height[i]);
        const double part = c[3] > 0.0 ? 1.0 / c[3] : 0.0;
        r[i] *= part * c[0], g[i] *= part * c[1], b[i] *= part * c[2];
    }
}

double KERNEL(texture_alpha)(const texture *t, double u, double v)
{
    double x, y;
    fold(t->wrap_u, 1, &u, &x);
    fold(t->wrap_v, 1, &v, &y);
    return (t->filter == TEXTURE_NEAREST ? nearest(t, x, y) : bilinear(t, 0, x, y))[3];
}

void KERNEL(texture_tint)(const texture *t, int count, const double *u, const double *v, const double *footprint,
                          double *r, double *g, double *b)
{
    double x[STRIP], y[STRIP], height[STRIP];
    for (int first = 0; first < count; first += STRIP) {
        const int n = count - first < STRIP ? count - first : STRIP;
        fold(t->wrap_u, n, u + first, x);
        fold(t->wrap_v, n, v + first, y);
        if (t->multiplied) {
            find_heights(t, n, footprint + first, height);
            tint_covered(t, n, x, y, height, r + first, g + first, b + first);
            continue;
        }
        switch (t->filter) {
        case TEXTURE_NEAREST: tint_strip(t, TEXTURE_NEAREST, n, x, y, height, r + first, g + first, b + first); break;
        case TEXTURE_BILINEAR: tint_strip(t, TEXTURE_BILINEAR, n, x, y, height, r + first, g + first, b + first); break;
        case TEXTURE_TRILINEAR:
            find_heights(t, n, footprint + first, height);
            tint_strip(t, TEXTURE_TRILINEAR, n, x, y, height, r + first, g + first, b + first);
            break;
        }
    }
}
