/* The medium of a material or of the surroundings: the law of its refractive index, and its absorption. A medium is an
 * index into medium_words: `ior` for a constant index, then the laws that need coefficients, `data`, then the
 * catalogue, then the metals (both optics/media.h). Pure; indices are relative to vacuum, wavelengths are in vacuum. */
#pragma once

#include "optics/dispersion.h"
#include "optics/media.h"
#include "scene/model/material.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include "scene/model/view_settings.h"

enum { MEDIUM_IOR, MEDIUM_SELLMEIER, MEDIUM_CAUCHY, MEDIUM_TABLE, MEDIUM_DATA, MEDIUM_CATALOGUE };
enum { MEDIUM_METAL = MEDIUM_CATALOGUE + MEDIA_COUNT };
extern const char *const medium_words[];
/* For the surroundings: `ior`, then the catalogue. */
enum { SURROUNDING_CATALOGUE = 1 };
extern const char *const surrounding_words[];
/* The number of the first medium of the catalogue that drops of rain can have: air, number 0, is excluded. */
enum { DROPS_FIRST = 1 };

/* A dispersion law, ready for evaluation. */
typedef struct index_law {
    dispersion law;
    bool relative_to_air;
    const optical_data *data; /* replaces the law, whose range is theirs; borrowed; NULL: none */
} index_law;

/* STATUS_BAD_INPUT if the coefficients are invalid; label is the name of the material in the message. For a metal, *out
 * is the law of n, the real part of its index. */
status material_index_law(const material *m, const char *label, index_law *out, diagnostic *why);
index_law surrounding_index_law(const background *b);
/* Coefficients to begin with when a law is edited: near the constant index, with the dispersion of water and crown
 * glass; for sellmeier the coefficients of N-BK7. Empty for a medium without coefficients. */
number_list medium_first_coefficients(int word, double ior);

double index_law_at(const index_law *law, double lambda_nm);
/* Whether two laws have equal indices: at the single wavelength of an RGB film, or at all wavelengths of a spectral
 * one. */
bool index_laws_match(const render_settings *r, const index_law *a, const index_law *b);
/* Whether the material's index equals that of the scene's surroundings. */
bool material_matches_surroundings(const scene *s, const material *m);

/* Above this index a transparent material is a perfect mirror: the limit of Fresnel's equations; with constant weights
 * it reflects both the reflected and the transmitted fraction. */
#define MIRROR_IOR 1e4
bool material_is_mirror(const material *m);
/* Whether neither light nor rays cross the material's surface. */
bool material_is_opaque(const material *m);

/* The metal of the material's medium, or NULL. */
const struct metal *material_metal(const material *m);
/* Whether the surface has a film or a coating. */
bool material_has_film(const material *m);
struct film_stack; /* optics/coating.h */
/* Fills *out with the layers of a material that material_has_film. */
void material_film_stack(const material *m, struct film_stack *out);
/* Whether two materials have equal layers. */
bool material_films_match(const material *a, const material *b);
/* The mean transmittance of the layers over the channels of an rgb film at normal incidence, from air into the
 * material; 1 if only a single film is there, whose loss shadow rays do not have. */
double material_layers_pass(const material *m);
/* STATUS_BAD_INPUT if a layer of the coating needs data that the material does not name. */
status material_coating_check(const material *m, const char *label, diagnostic *why);
/* Whether the surface reflects and transmits by optics/multilayer.h: it is a metal, or has a film. A film on a
 * transparent surface needs Fresnel weights. */
bool material_is_layered(const material *m, const render_settings *r);
/* alpha of the microfacets that reflect or refract random paths (optics/microfacet.h); 0: smooth. A transparent surface
 * needs Fresnel weights. */
double material_roughness(const material *m, const render_settings *r);
/* Whether the material refracts light doubly: only in ray trees of integrator whitted, with Fresnel weights. */
bool material_is_crystal(const material *m, const render_settings *r);
/* STATUS_BAD_INPUT if the constant index of a material that is not a metal is below 0.1. */
status material_ior_check(const material *m, const char *label, diagnostic *why);
/* STATUS_BAD_INPUT if a crystal has no axis, or a coating, a film or a sheet. */
status material_crystal_check(const material *m, const char *label, diagnostic *why);
/* k of an opaque material's complex index. */
double material_extinction_index(const material *m, double lambda_nm);

/* "water", or NULL if the medium is not in the catalogue. */
const char *material_medium_name(const material *m);
const char *surrounding_medium_name(const background *b);

/* Wavelengths at which the channels of an RGB film evaluate an absorption spectrum: the dominant wavelengths of the
 * sRGB primaries. For a spectral film, absorb_per_m is interpolated linearly between them, and constant outside. */
#define CHANNEL_LAMBDA_NM   \
    {                       \
        611.4, 549.1, 464.3 \
    }

/* The material with the colour of its color_data in daylight, if it has them. */
material material_as_measured(const material *m);

/* Absorption coefficients in 1/m. */
vec3 material_absorption(const material *m);
double material_absorption_at(const material *m, double lambda_nm);
bool material_absorbs(const material *m);
/* Tint of a transparent material: the transmittance over tint_distance is color, so over a length d it is color^(d /
 * tint_distance): the Beer-Lambert law with the coefficient -ln(color) / tint_distance. A channel of 0 transmits
 * nothing, white absorbs nothing. */
bool material_tints(const material *m);
/* The coefficient of the tint in 1 / scene unit, for a channel or wavelength at which color is `value`, 0..1. */
double material_tint(const material *m, double value);
/* Whether light is attenuated inside a transparent solid with this material. */
bool material_attenuates(const material *m);
/* Scattering coefficients in 1/m: by channel, at CHANNEL_LAMBDA_NM, and at a wavelength. */
vec3 material_scattering(const material *m);
double material_scattering_at(const material *m, double lambda_nm);
/* Whether some wavelength has a coefficient above 0; material_scatters: and the solid is transparent and rendered by
 * random paths, without which media do not scatter. */
bool material_is_turbid(const material *m);
bool material_scatters(const material *m, const render_settings *r);
/* Absorption plus tint by channel, in 1 / scene unit; not defined for opaque materials. */
vec3 material_extinction(const material *m, double unit_m);
/* The reflectivity of a transparent surface as a half mirror, which reflects that fraction of the light that would be
 * transmitted; 0 with constant weights, which are used unchanged. */
double material_reflectivity(const material *m, const render_settings *r);
double surrounding_absorption_at(const background *b, double lambda_nm);
bool surroundings_absorb(const background *b);

/* Fails unless absorb_spectrum has pairs of ascending wavelength and coefficient, which is not negative. */
status material_absorption_check(const material *m, const char *label, diagnostic *why);

/* --- sheets: a transparent solid as a polarising filter or wave plate --- */

typedef enum sheet_kind {
    SHEET_NONE,
    SHEET_POLARISER,
    SHEET_CIRCULAR_LEFT,
    SHEET_CIRCULAR_RIGHT,
    SHEET_RETARDER
} sheet_kind;

bool sheet_is_polariser(const material *m);
/* Whether the sheet has an axis: a linear polariser or a wave plate. */
bool sheet_has_axis(const material *m);
bool sheet_retards(const material *m);

/* Whether the sheet changes light that crosses the solid. Without polarisation a polariser is a grey filter. False in
 * the depth buffer and in layers. */
bool sheet_acts(const material *m, const render_settings *r);
/* Whether the sheet's effect depends on the wavelength. */
bool sheet_disperses(const material *m, const render_settings *r);

/* STATUS_BAD_INPUT if the sheet's axis has no direction. */
status sheet_check(const material *m, const char *label, diagnostic *why);
