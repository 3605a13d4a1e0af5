/* Sampling of a texture: nearest, bilinear, trilinear. */
#include "image/texture_parts.h"

#include "base/elementary_inline.h"
#include <math.h>

/* The position in the image, 0 to 1, of a coordinate; the comparisons map NaN to 0. */
static inline double fold(double c, texture_wrap wrap)
{
    double place = 0.0, away;
    switch (wrap) {
    /* 1 for the largest numbers below 0. */
    case TEXTURE_REPEAT: place = c - floor(c); break;
    case TEXTURE_MIRROR:
        away = magnitude(c);
        place = away - 2.0 * floor(0.5 * away);
        place = place > 1.0 ? 2.0 - place : place;
        break;
    case TEXTURE_CLAMP: place = c < 1.0 ? c : c >= 1.0 ? 1.0 : 0.0; break;
    }
    return place > 0.0 ? place : 0.0;
}

/* The two texels of an axis whose centres enclose a position, and the fraction between them. */
typedef struct between {
    size_t low, high;
    double part;
} between;

static inline between locate(double place, int size, texture_wrap wrap)
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

static inline double mix(double from, double to, double part)
{
    return from + part * (to - from);
}

static inline vec3 mix_texels(const texel *from, const texel *to, double part)
{
    return vec3_make(mix((double)from->r, (double)to->r, part), mix((double)from->g, (double)to->g, part),
                     mix((double)from->b, (double)to->b, part));
}

static inline vec3 mix_colors(vec3 from, vec3 to, double part)
{
    return vec3_make(mix(from.x, to.x, part), mix(from.y, to.y, part), mix(from.z, to.z, part));
}

static inline vec3 nearest(const texture *t, double u, double v)
{
    const texture_level *l = &t->level[0];
    int x = (int)(u * l->width), y = (int)(v * l->height);
    x = x < l->width ? x : l->width - 1;
    y = y < l->height ? y : l->height - 1;
    const texel *c = &l->texels[(size_t)y * (size_t)l->width + (size_t)x];
    return vec3_make((double)c->r, (double)c->g, (double)c->b);
}

static inline vec3 bilinear(const texture *t, int level, double u, double v)
{
    const texture_level *l = &t->level[level];
    between x = locate(u, l->width, t->wrap_u), y = locate(v, l->height, t->wrap_v);
    const texel *below = l->texels + y.low * (size_t)l->width, *above = l->texels + y.high * (size_t)l->width;
    return mix_colors(mix_texels(below + x.low, below + x.high, x.part),
                      mix_texels(above + x.low, above + x.high, x.part), y.part);
}

static inline vec3 trilinear(const texture *t, double u, double v, double footprint)
{
    int side = t->level[0].width > t->level[0].height ? t->level[0].width : t->level[0].height;
    int last = t->levels - 1;
    double texels = footprint * side;
    if (!(texels > 1.0))
        return bilinear(t, 0, u, v);
    if (texels >= (double)(1 << last))
        return bilinear(t, last, u, v);
    /* Williams 1983: the level at which a texel is as large as the pixel. */
    double height = elementary_log2_inline(texels);
    int level = (int)height;
    level = level < last ? level : last - 1; /* the logarithm may round up to the last level */
    return mix_colors(bilinear(t, level, u, v), bilinear(t, level + 1, u, v), height - level);
}

vec3 texture_sample(const texture *t, double u, double v, double footprint)
{
    u = fold(u, t->wrap_u);
    v = fold(v, t->wrap_v);
    switch (t->filter) {
    case TEXTURE_NEAREST: return nearest(t, u, v);
    case TEXTURE_BILINEAR: return bilinear(t, 0, u, v);
    case TEXTURE_TRILINEAR: return trilinear(t, u, v, footprint);
    }
    return vec3_make(0.0, 0.0, 0.0);
}
