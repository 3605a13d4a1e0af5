/* What a ray knows of where it belongs, in one number: the pixel, and for films of more than one sample a pixel
 * (spectral ones, those of random paths) the sample too, and of spectral ones the wavelength. An rgb film of Whitted's
 * rays has the pixel alone.
 *     bits 0..27 the pixel, fewer than SCENE_PIXELS_MAX
 *          28..49 the sample: at most 1048576 paths, 64 x 65536 wavelengths
 *          50..61 the wavelength's number (render/shade/spectra.h)
 *          62     see SAMPLE_KEY_SPECULAR_BOUNCE */
#pragma once

#include <stdint.h>

/* The ray may meet a light that shines: it comes from the eye or from a mirror-like surface. */
#define SAMPLE_KEY_SPECULAR_BOUNCE ((int64_t)1 << 62)

static inline int64_t sample_key_make(int64_t pixel, int64_t sample)
{
    return pixel | sample << 28;
}

static inline int64_t sample_key_with_wavelength(int64_t sample_key, int64_t number)
{
    return sample_key | number << 50;
}

static inline int64_t sample_key_pixel(int64_t sample_key)
{
    return sample_key & 0xfffffff;
}

static inline int64_t sample_key_sample(int64_t sample_key)
{
    return sample_key >> 28 & 0x3fffff;
}

static inline int64_t sample_key_wavelength(int64_t sample_key)
{
    return sample_key >> 50 & 0xfff;
}
