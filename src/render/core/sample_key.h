/* The sample key: one number that identifies the pixel of a ray, for films with more than one sample per pixel
 * (spectral films, random paths) also the sample, and for spectral films also the wavelength. An rgb film with
 * Whitted's rays uses only the pixel.
 *     bits 0..27 the pixel, fewer than SCENE_PIXELS_MAX
 *          28..49 the sample: at most 1048576 paths, 64 x 65536 wavelengths
 *          50..61 the wavelength's number (render/shade/spectra.h)
 *          62     see SAMPLE_KEY_SPECULAR_BOUNCE
 *          63     see SAMPLE_KEY_PHOTONS */
#pragma once

#include <stdint.h>

/* The ray may hit a light source and collect its emission: it starts at the camera or at a specular surface. */
#define SAMPLE_KEY_SPECULAR_BOUNCE ((int64_t)1 << 62)
/* The path has left a matte surface, whose photons bring the light that mirrors and clear solids throw on it. */
#define SAMPLE_KEY_PHOTONS INT64_MIN

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
