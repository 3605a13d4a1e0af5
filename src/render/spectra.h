/* The spectra of a scene, for films that are traced wavelength by wavelength: every colour lifted once a frame
 * (optics/lift.h), and the wavelength that each camera ray carries. Ownership: spectra_create gives, spectra_destroy
 * releases; the sky's picture is borrowed. Lookups are pure. */
#ifndef CUVETTE_RENDER_SPECTRA_H
#define CUVETTE_RENDER_SPECTRA_H

#include "optics/lift.h"
#include "scene/scene.h"

enum { SKY_BASIS_COUNT = 7 };

typedef struct spectra {
    lifted *color, *checker_color; /* by rank */
    lifted *light;                 /* by light: its colour times its intensity */
    lifted sky, horizon, ambient;
    lifted basis[SKY_BASIS_COUNT]; /* white, cyan, magenta, yellow, red, green, blue: of a sky picture's texels */
} spectra;

/* materials: by rank, [0] is NULL; ranks counts that one too. NULL when memory is out. */
spectra *spectra_create(const scene *s, const material *const *materials, size_t ranks);
void spectra_destroy(spectra *p);

/* The wavelength of a ray: its sample's stretch of 380..780 nm, and within it a place that is hashed from seed, pixel and
 * sample. */
double spectra_lambda(const render_settings *render, int64_t ticket);

/* Radiance of the sky at a wavelength. */
double spectra_sky(const spectra *p, const background *sky, vec3 direction, double lambda_nm);

#endif
