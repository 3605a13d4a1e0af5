/* Exposure and the published tone curves. */
#include "image/tone.h"

#include "base/elementary.h"
#include <math.h>

bool image_tone_is_plain(const image_tone *t)
{
    return t->exposure == 0.0 && t->curve == TONE_NONE;
}

/* 2^stops, exact for integers. */
static double factor_of(double stops)
{
    const double integer = floor(stops), part = stops - integer;
    return ldexp(part > 0.0 ? elementary_pow(2.0, part) : 1.0, (int)integer);
}

/* Reinhard, Stark, Shirley and Ferwerda, "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, equation
 * 4: L_d = L (1 + L / L_white^2) / (1 + L), of the luminance (ITU-R BT.709), so that hues do not change. */
static void reinhard(double white, double rgb[3])
{
    const double luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    const double scale = (1.0 + luminance / (white * white)) / (1.0 + luminance);
    for (int c = 0; c < 3 && luminance > 0.0; c++)
        rgb[c] *= scale;
}

/* The fit by K. Narkowicz, "ACES Filmic Tone Mapping Curve" (2015), of the Academy Color Encoding System's reference
 * transforms, by channel. */
static double aces(double x)
{
    return x > 0.0 ? x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14) : x;
}

void image_tone_apply(const image_tone *t, float *rgb, size_t pixels)
{
    const double factor = factor_of(t->exposure);
    for (size_t i = 0; i < pixels; i++) {
        double at[3];
        for (int c = 0; c < 3; c++)
            at[c] = factor * (double)rgb[3 * i + (size_t)c];
        if (t->curve == TONE_REINHARD)
            reinhard(t->white, at);
        for (int c = 0; c < 3; c++)
            rgb[3 * i + (size_t)c] = (float)(t->curve == TONE_ACES ? aces(at[c]) : at[c]);
    }
}
