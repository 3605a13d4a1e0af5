/* Radiance and mean of the background's kinds. */
#include "render/shade/sky.h"

#include "base/elementary.h"

static vec3 sky_image_texel(const image *img, int x, int y)
{
    const float *p = &img->pixel[((size_t)y * (size_t)img->width + (size_t)x) * 3];
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
static vec3 sky_image_radiance(const image *img, vec3 d)
{
    double longitude = elementary_atan2_deg(d.x, d.z),
           latitude = elementary_atan2_deg(d.y, sqrt(d.x * d.x + d.z * d.z));
    double u = (0.5 + longitude / 360.0) * img->width - 0.5, v = (0.5 - latitude / 180.0) * img->height - 0.5;
    double left = floor(u), top = floor(v);
    int x0 = wrap((int)left, img->width), x1 = wrap((int)left + 1, img->width);
    int y0 = clamp((int)top, img->height), y1 = clamp((int)top + 1, img->height);
    vec3 upper = mix(sky_image_texel(img, x0, y0), sky_image_texel(img, x1, y0), u - left);
    vec3 lower = mix(sky_image_texel(img, x0, y1), sky_image_texel(img, x1, y1), u - left);
    return mix(upper, lower, v - top);
}

vec3 sky_radiance(const background *sky, vec3 direction)
{
    switch ((background_kind)sky->kind) {
    case BACKGROUND_UNIFORM: return sky->color;
    case BACKGROUND_RAIN:
    case BACKGROUND_GRADIENT: return mix(sky->horizon, sky->color, direction.y > 0.0 ? direction.y : 0.0);
    case BACKGROUND_IMAGE: return sky->img ? sky_image_radiance(sky->img, direction) : sky->color;
    case BACKGROUND_CIE:
        return direction.y > 0.0 ? vec3_scale(sky->color, cie_sky_relative(&sky->cie, direction)) : sky->horizon;
    }
    return sky->color;
}

/* The weight of a row of texels in the mean: the integral of its interpolation, a hat function from the row above to
 * the row below, times the sine of the polar angle. With rows h apart that is sin(angle) 2 (1 - cos h) / h; a row next
 * to a pole is constant up to the pole: 1 - 2 cos h sin(h / 2) / h. The weights add up to 2. */
static double row_weight(int y, int height)
{
    const double h_deg = 180.0 / height, h = 3.141592653589793 / height;
    double sin_h, cos_h, sin_half, cos_half, sine, cosine;
    if (height == 1)
        return 2.0;
    elementary_sincos_deg(h_deg, &sin_h, &cos_h);
    elementary_sincos_deg(0.5 * h_deg, &sin_half, &cos_half);
    if (y == 0 || y == height - 1)
        return 1.0 - 2.0 * cos_h * sin_half / h;
    elementary_sincos_deg((y + 0.5) * h_deg, &sine, &cosine);
    return sine * 4.0 * sin_half * sin_half / h;
}

static vec3 sky_image_mean(const image *img)
{
    vec3 mean = {0.0, 0.0, 0.0};
    for (int y = 0; y < img->height; y++) {
        vec3 row = {0.0, 0.0, 0.0};
        for (int x = 0; x < img->width; x++)
            row = vec3_add(row, sky_image_texel(img, x, y));
        mean = vec3_add(mean, vec3_scale(row, 0.5 * row_weight(y, img->height) / img->width));
    }
    return mean;
}

vec3 sky_mean(const background *sky)
{
    switch ((background_kind)sky->kind) {
    case BACKGROUND_UNIFORM: return sky->color;
    case BACKGROUND_RAIN:
    case BACKGROUND_GRADIENT: return mix(sky->horizon, sky->color, 0.25);
    case BACKGROUND_IMAGE: return sky->img ? sky_image_mean(sky->img) : sky->color;
    case BACKGROUND_CIE: return mix(sky->horizon, vec3_scale(sky->color, sky->cie.mean), 0.5);
    }
    return sky->color;
}
