/* How an image of 8 bits shows radiance: exposure and tone curve, before the sRGB encoding. Files of numbers (PFM,
 * OpenEXR, PNG with 16 bits) keep the linear values, and so do films and comparisons. Pure; cannot fail. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum tone_curve { TONE_NONE, TONE_REINHARD, TONE_ACES } tone_curve;

/* All zero: values are shown as they are. */
typedef struct image_tone {
    double exposure; /* stops: values are multiplied by 2^exposure before the curve */
    int64_t curve;   /* tone_curve */
    double white;    /* Reinhard's: the least luminance, after the exposure, that is shown as white */
} image_tone;

/* Whether the tone changes no value. */
bool image_tone_is_plain(const image_tone *t);

/* Applies the tone to linear RGB values in place. Values that are not positive, and NaN, stay so. */
void image_tone_apply(const image_tone *t, float *rgb, size_t pixels);
