/* Surfaces that reflect by wave optics: metals, and films on any surface (optics/multilayer.h). A spectral film
 * evaluates them exactly, ray by ray. For an rgb film each surface has a table by angle of the colour that it reflects
 * of daylight: its spectrum under D65, seen by the standard observer (optics/spectrum.h), in linear sRGB, where white
 * is 1 at every angle; the media on both sides have their indices at render.lambda_nm. Colours outside the gamut are
 * clamped to 0 .. 1, so that no light is created; a film that does not absorb transmits the rest, channel by channel.
 * This is exact for one reflection of daylight; of several the product of colours is not the colour of the product.
 *
 * The table is uniform in the cosine on the side of the lower index, in which the reflectance has no singularity: from
 * the other side the cosine of refraction leads to the same entry, by reversal, and under total reflection all is
 * reflected. Between entries it is cubic: error below 2e-5 for films up to 2 um thick, 1e-4 up to 10 um, 2e-3 up to 20
 * um; 1e-2 within a degree of grazing, where fringes are narrower than the steps of the integral. A film of lower
 * index than both sides (a gap of air between glass and water) totally reflects abruptly: there each ray is
 * integrated. A table is filled when a ray first needs it, by the worker that traces it; its values depend on the
 * scene alone.
 * Ownership: layered_plan_create allocates, layered_plan_destroy releases. */
#pragma once

#include "optics/multilayer.h"
#include "scene/model/medium.h"
#include "scene/model/material.h"
#include <pthread.h>
#include <stdatomic.h>

/* Steps of a table; those of a film up to that thickness, and of a metal, are fewer. */
enum { LAYERED_STEPS = 256, LAYERED_STEPS_THIN = 128, LAYERED_THIN_NM = 1000 };

/* A surface: a film (of thickness 0: none) on matter that is opaque or transparent. */
typedef struct layered_surface {
    thin_film film;
    bool opaque;
    index_law law;     /* of the index behind an opaque surface */
    const material *m; /* the source of its k */
} layered_surface;

/* Reflected colour by cosine, k / steps; not clamped, so that the entries have no kinks. */
typedef struct layered_curve {
    atomic_bool ready; /* the entries are filled */
    bool by_ray;       /* there are no entries */
    int steps;
    vec3 color[LAYERED_STEPS + 1];
} layered_curve;

typedef struct layered_plan {
    size_t priority_indices;
    const layered_surface **surface; /* by priority index; NULL for an ordinary surface */
    layered_surface *surfaces;
    double *index; /* of the distinct media */
    int *medium;   /* by priority index: number of its medium, in index */
    int medium_count;
    layered_curve **curves; /* by priority index: one for each medium that meets its surface; NULL in a spectral film */
    bool *owns_curves;
    pthread_mutex_t filling;
    bool one_wavelength; /* set by the probe: every surface is evaluated at render.lambda_nm, for all channels */
} layered_plan;

/* By priority index, [0] the surrounding medium: materials (NULL there), their laws, indices at render.lambda_nm, and
 * numbers that are equal for equal materials, at most the priority index. *out is NULL if no surface is layered. False
 * when out of memory. */
bool layered_plan_create(const render_settings *r, const material *const *materials, const index_law *laws,
                         const double *ior, const int *alike, size_t priority_indices, layered_plan **out);
void layered_plan_destroy(layered_plan *p);

/* Amplitudes at a wavelength, from n_from into n_to (not used behind an opaque surface). */
sp_amplitudes layered_amplitudes(const layered_surface *s, double cos_i, double n_from, double n_to, double lambda_nm);

/* The colour that a surface reflects between two media; cosine: on the side of the lower index, or before an opaque
 * surface. */
vec3 layered_color(const layered_surface *s, double cosine, double n_low, double n_high);
/* The table of the surface of a priority index and the medium of that number. */
const layered_curve *layered_curve_of(layered_plan *p, int priority_index, int medium_number);
/* The same from a table. */
void layered_curve_make(const layered_surface *s, double n_low, double n_high, layered_curve *out);
vec3 layered_curve_at(const layered_curve *c, double cosine);
