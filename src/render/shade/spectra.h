/* The spectra of a scene, for films that are traced wavelength by wavelength. Light is told apart in SPECTRA_COUNT
 * wavelengths, 0.1 nm from one to the next; what a scene does at each of them (its colours lifted by optics/upsample.h,
 * its indices of refraction, its absorption, and how the eye sees it) is worked out once a frame, in tables. Ownership:
 * spectra_create gives, spectra_destroy releases; the scene is borrowed during the call only. Lookups are pure. */
#pragma once

#include "optics/upsample.h"
#include "render/core/sample_key.h"
#include "scene/model/medium.h"
#include "scene/model/material.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include "scene/model/view_settings.h"

/* A number of wavelengths that puts each of the observer's 5 nm into 50 of them. */
enum { SPECTRA_COUNT = 10 * (OBSERVER_HIGH_NM - OBSERVER_LOW_NM), SKY_BASIS_COUNT = 7, SKY_BASIS_WHITE = 0 };

/* Offsets that the wavelengths of a pixel can have, and from how many wavelengths on their sum is made good. */
enum { SPECTRA_OFFSETS = 256, SPECTRA_WHITE_FROM = 8 };

/* What all share at one wavelength. */
typedef struct spectral_row {
    double eye[3]; /* observer_weights */
    double sky, horizon, ambient;
    double basis[SKY_BASIS_COUNT]; /* white, cyan, magenta, yellow, red, green, blue: of a sky picture's texels */
} spectral_row;

/* A body at one wavelength; absorption: and tint, in 1 / scene unit. */
typedef struct region_spectrum {
    double color, checker_color, index, absorption;
} region_spectrum;

typedef struct spectra {
    spectral_row *rows;       /* by wavelength */
    region_spectrum *regions; /* by wavelength, then rank */
    double *lights;           /* by wavelength, then light: radiance of its colour times its intensity */
    double (*white)[3];       /* by offset: what makes the wavelengths of a pixel, seen under D65, white */
    size_t priority_indices, light_count;
} spectra;

/* laws, materials: by rank, materials[0] is NULL; ranks counts that one too. NULL when memory is out. */
spectra *spectra_create(const scene *s, const material *const *materials, const index_law *laws,
                        size_t priority_indices);
void spectra_destroy(spectra *p);

/* The wavelength of that number, in the middle of its 0.1 nm. */
double spectra_lambda(int64_t number);

/* A ticket with its wavelength. Those of one point of a pixel lie evenly over 380..780 nm, from an offset that is
 * hashed from seed, pixel and point (Cranley and Patterson, "Randomization of Number Theoretic Methods for Multiple
 * Integration", SIAM J. Numer. Anal. 13(6), 1976): the observer's curves are smooth and end at 0, where such sums err
 * least. What is left of the error for white is taken out by weights for X, Y and Z (*white), so that a white furnace
 * is white whatever the offset; below SPECTRA_WHITE_FROM wavelengths, where that would be no small change, they are 1.
 */
int64_t spectra_choose(const spectra *p, const render_settings *render, int64_t sample_key, const double **white);

static inline const spectral_row *spectra_row(const spectra *p, int64_t sample_key)
{
    return &p->rows[sample_key_wavelength(sample_key)];
}

static inline const region_spectrum *spectra_region(const spectra *p, int64_t sample_key, int64_t priority_index)
{
    return &p->regions[(size_t)sample_key_wavelength(sample_key) * p->priority_indices + (size_t)priority_index];
}

static inline double spectra_light(const spectra *p, int64_t sample_key, int lamp)
{
    return p->lights[(size_t)sample_key_wavelength(sample_key) * p->light_count + (size_t)lamp];
}

/* Radiance of the sky; its mean over all directions, of which sky_mean has the colour. */
double spectra_sky(const spectral_row *row, const background *sky, vec3 direction);
double spectra_sky_mean(const spectral_row *row, const background *sky, vec3 mean);
