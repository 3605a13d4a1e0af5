#include "render/sky.h"

#include "base/elementary.h"

static vec3 picture_texel(const image *picture, int x, int y)
{
    const float *p = &picture->pixel[((size_t)y * (size_t)picture->width + (size_t)x) * 3];
    return vec3_make((double)p[0], (double)p[1], (double)p[2]);
}

static vec3 mix(vec3 a, vec3 b, double share)
{
    return vec3_add(vec3_scale(a, 1.0 - share), vec3_scale(b, share));
}

static int wrap(int x, int width)
{
    x %= width;
    return x < 0 ? x + width : x;
}

static int clamp(int y, int height)
{
    return y < 0 ? 0 : y >= height ? height - 1 : y;
}

/* Bilinear; longitude wraps around, latitude is clamped. */
static vec3 picture_radiance(const image *picture, vec3 d)
{
    double longitude = elementary_atan2_deg(d.x, d.z), latitude = elementary_atan2_deg(d.y, sqrt(d.x * d.x + d.z * d.z));
    double u = (0.5 + longitude / 360.0) * picture->width - 0.5, v = (0.5 - latitude / 180.0) * picture->height - 0.5;
    double left = floor(u), top = floor(v);
    int x0 = wrap((int)left, picture->width), x1 = wrap((int)left + 1, picture->width);
    int y0 = clamp((int)top, picture->height), y1 = clamp((int)top + 1, picture->height);
    vec3 upper = mix(picture_texel(picture, x0, y0), picture_texel(picture, x1, y0), u - left);
    vec3 lower = mix(picture_texel(picture, x0, y1), picture_texel(picture, x1, y1), u - left);
    return mix(upper, lower, v - top);
}

vec3 sky_radiance(const background *sky, vec3 direction)
{
    switch ((background_kind)sky->kind) {
    case BACKGROUND_UNIFORM: return sky->color;
    case BACKGROUND_GRADIENT: return mix(sky->horizon, sky->color, direction.y > 0.0 ? direction.y : 0.0);
    case BACKGROUND_PICTURE: return sky->picture ? picture_radiance(sky->picture, direction) : sky->color;
    }
    return sky->color;
}
