/* The spectra of a scene, for spectral films. There are SPECTRA_COUNT wavelengths, 0.1 nm apart; the scene's properties
 * at each of them (colours upsampled by optics/upsample.h, refractive indices, absorption, and the observer's response)
 * are computed once per frame, in tables.
 *
 * Lamps that emit lines: a line is at one of the film's wavelengths, which evenly spaced samples would hit once in
 * thousands. If there are such lamps, half of a pixel's wavelengths are drawn from the lines in proportion to their
 * brightness, or all if nothing in the scene emits other light. The observer's weights are divided by the density, so
 * that the mean stays the same (importance sampling with one sample from a mixture, Veach, Robust Monte Carlo Methods
 * for Light Transport Simulation, 1997, section 9.2.4). The density is exact, not only on average: each line has a
 * whole number of LINE_SLOTS, which divides the number of offsets.
 *
 * Ownership: spectra_create allocates, spectra_destroy releases; the scene is borrowed during the call only. Lookups
 * are pure. */
#pragma once

#include "optics/upsample.h"
#include "render/plan/sampling.h"
#include "scene/model/material.h"
#include "scene/model/medium.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include "scene/model/scene.h"
#include "scene/model/view_settings.h"

/* --- lines --- */

/* The number of slots, and the maximum number of different lines, which check.c ensures. */
enum { LINE_SLOTS = 128 };

typedef struct line_table {
    int count;                /* number of different lines; 0: no lamp emits lines */
    bool lines_only;          /* nothing emits other light */
    int16_t slot[LINE_SLOTS]; /* wavelength numbers, in order */
} line_table;

/* A line of a lamp. bright: its contribution to a film, X + Y + Z, in proportion to which lines are chosen. */
typedef struct lamp_line {
    int wavelength;  /* number of the wavelength */
    double radiance; /* at this wavelength; its mean over all SPECTRA_COUNT wavelengths is the line's power */
    double bright;
} lamp_line;
int spectral_lines_of(const light *l, lamp_line lines[LAMP_LINES_MAX]);

line_table line_table_of(const scene *s);

/* The wavelength number for u in [0, 1), in a scene with lines; *of_line: whether it is drawn from the lines. */
int64_t line_table_choose(const line_table *t, double u, bool *of_line);

/* The density of line_table_choose at a wavelength relative to a uniform density; 1 without lines. */
double line_table_density(const line_table *t, int64_t wavelength);

/* --- tables --- */

/* SPECTRA_COUNT gives each 5 nm step of the observer 50 wavelengths. */
enum { SPECTRA_COUNT = 10 * (OBSERVER_HIGH_NM - OBSERVER_LOW_NM), SKY_BASIS_COUNT = 7, SKY_BASIS_WHITE = 0 };

/* Number of possible offsets of a pixel's wavelengths, and the least number of wavelengths whose sum is corrected to
 * white. */
enum { SPECTRA_OFFSETS = 256, SPECTRA_WHITE_FROM = 8 };

/* Values at one wavelength that do not depend on a region. */
typedef struct spectral_row {
    double eye[3]; /* observer_weights (or those of bands) over the density of the choice (line_table_density) */
    double sky, horizon, ambient;
    double basis[SKY_BASIS_COUNT]; /* of a sky image's texels: white, cyan, magenta, yellow, red, green, blue */
} spectral_row;

/* A region at one wavelength; absorption, which includes the tint, and scattering in 1 / scene unit. */
typedef struct region_spectrum {
    double color, checker_color, index, absorption, scattering;
} region_spectrum;

typedef struct spectra {
    spectral_row *rows;       /* by wavelength */
    region_spectrum *regions; /* by wavelength, then priority index */
    double *lights;           /* by wavelength, then light: radiance of its colour times its intensity */
    double (*white)[3];       /* by offset: weights that make a pixel's wavelengths white under D65 */
    int64_t per_offset;       /* number of wavelengths that share one offset */
    double (
        *tints)[SKY_BASIS_COUNT]; /* by wavelength: reflectances of the basis colours; NULL: no vertex has a colour */
    line_table lines;
    size_t priority_indices, light_count;
} spectra;

/* laws, materials: by priority index, materials[0] is NULL; priority_indices is their length, including that entry.
 * NULL when out of memory. */
spectra *spectra_create(const scene *s, const material *const *materials, const index_law *const *laws,
                        size_t priority_indices);
void spectra_destroy(spectra *p);

/* The wavelength with a number, at the middle of its 0.1 nm interval, and the number of a wavelength from
 * OBSERVER_LOW_NM to OBSERVER_HIGH_NM. */
double spectra_lambda(int64_t number);
int spectra_number(double lambda_nm);

/* Number of wavelengths that share one offset, and are evenly spaced: the wavelengths of a sample point; with random
 * paths, of all paths of a pixel, or under sobol, of one replicate. */
int64_t wavelengths_per_offset(const render_settings *render);

/* Returns the sample key with its wavelength. The wavelengths of one sample point of a pixel are evenly spaced over
 * 380..780 nm, from an offset that is hashed from seed, pixel and point (Cranley and Patterson, "Randomization of
 * Number Theoretic Methods for Multiple Integration", SIAM J. Numer. Anal. 13(6), 1976): the observer's curves are
 * smooth and end at 0, where such sums have the smallest error. The remaining error for white is removed by weights for
 * X, Y and Z (*white), so that a white furnace is white whatever the offset. The weights are 1 for spectral lines, and
 * below SPECTRA_WHITE_FROM wavelengths, where the correction would be large. */
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

/* The reflectance of a colour between the colours of a mesh's vertices, 0 to 1. */
double spectra_tint(const spectra *p, int64_t sample_key, vec3 color);

/* Radiance of the sky in a direction, and its mean over all directions; `mean` is the colour from sky_mean. */
double spectra_sky(const spectral_row *row, const background *sky, vec3 direction);
double spectra_sky_mean(const spectral_row *row, const background *sky, vec3 mean);
