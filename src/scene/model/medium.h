/* The medium of a material or of the surroundings: which law gives its refractive index and its absorption. The choice
 * is an index into medium_words: `ior` for a plain index, the words of the laws that a scene may give coefficients for,
 * then the names of the catalogue (optics/media.h). Pure; indices are relative to vacuum, wavelengths are vacuum's. */
#pragma once

#include "optics/dispersion.h"
#include "optics/media.h"
#include "scene/model/material.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include "scene/model/view_settings.h"

enum { MEDIUM_IOR, MEDIUM_SELLMEIER, MEDIUM_CAUCHY, MEDIUM_TABLE, MEDIUM_CATALOGUE };
extern const char *const medium_words[];
/* Of the surroundings: `ior`, then the catalogue. */
enum { SURROUNDING_CATALOGUE = 1 };
extern const char *const surrounding_words[];

/* A law of refraction, ready to be evaluated. */
typedef struct index_law {
    dispersion law;
    bool relative_to_air;
} index_law;

/* STATUS_BAD_INPUT when the coefficients do not make a law; label names the material in the message. */
status material_index_law(const material *m, const char *label, index_law *out, diagnostic *why);
index_law surrounding_index_law(const background *b);

double index_law_at(const index_law *law, double lambda_nm);
/* No light is bent where two laws meet: at the one wavelength of an rgb film, or at all of them. */
bool index_laws_match(const render_settings *r, const index_law *a, const index_law *b);
/* The material's index is that of the scene's surroundings. */
bool material_matches_surroundings(const scene *s, const material *m);

/* Above this index a clear material is a mirror that nothing passes: all light is reflected under Fresnel's weights (of
 * which that is the limit), with constant shares what would have been reflected and what would have passed. */
#define MIRROR_IOR 1e4
bool material_is_mirror(const material *m);
/* Neither light nor a ray passes its surface. */
bool material_is_opaque(const material *m);

/* "water", or NULL when the medium is not one of the catalogue. */
const char *material_medium_name(const material *m);
const char *surrounding_medium_name(const background *b);

/* Wavelengths at which the channels of the rgb film look up a spectrum of absorption: the dominant wavelengths of the
 * primaries of sRGB. Between them, absorb_per_m is linear in wavelength for the spectral film, and constant beyond. */
#define CHANNEL_LAMBDA_NM   \
    {                       \
        611.4, 549.1, 464.3 \
    }

/* Absorption coefficients in 1/m. */
vec3 material_absorption(const material *m);
double material_absorption_at(const material *m, double lambda_nm);
bool material_absorbs(const material *m);
/* What a clear material's colour takes: light has its colour after tint_distance, so the share left over a way d is
 * color^(d / tint_distance), Beer and Lambert's law with -ln(color) / tint_distance. A channel that is 0 leaves
 * nothing. White takes nothing. */
bool material_tints(const material *m);
/* That coefficient in 1 / scene unit, of a channel or wavelength at which the colour is share, 0..1. */
double material_tint(const material *m, double share);
/* Does light inside a clear solid of it become less? */
bool material_attenuates(const material *m);
/* By channel in 1 / scene unit, absorption and tint; of an opaque material nothing is asked. */
vec3 material_extinction(const material *m, double unit_m);
/* Share of the light that would pass which a clear surface's coating sends back: 0 where shares are constants, which
 * say all. */
double material_coating(const material *m, const render_settings *r);
double surrounding_absorption_at(const background *b, double lambda_nm);
bool surroundings_absorb(const background *b);

/* Pairs of numbers, wavelengths ascending, coefficients not negative. */
status material_absorption_check(const material *m, const char *label, diagnostic *why);
