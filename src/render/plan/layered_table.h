/* Surfaces that reflect by wave optics: metals, and thin films on any surface (optics/multilayer.h). For a spectral
 * film they are evaluated exactly, ray by ray. For an rgb film each surface has a table by angle of the colour of
 * reflected daylight: its reflectance under D65, as the standard observer sees it (optics/spectrum.h), in linear sRGB,
 * where white is 1 at every angle; the media on both sides have their indices at render.lambda_nm. Colours outside the
 * gamut are clamped to 0 .. 1, so that no light is created; a thin film without absorption transmits the rest, channel
 * by channel. This is exact for one reflection of daylight; after several, the product of colours is not the colour of
 * the product.
 *
 * The table is uniform in the cosine on the side of the lower index, because the reflectance has no singularity there.
 * A ray from the other side uses the cosine of its refracted ray, since reversed paths have equal reflectance; under
 * total reflection the colour is 1. Interpolation is cubic: its error is below 2e-5 for thin films up to 2 um, 1e-4 up
 * to 10 um, and 2e-3 up to 20 um; 1e-2 within a degree of grazing, where fringes are narrower than the steps of the
 * integral. Total reflection begins abruptly at a thin film of lower index than both sides (a gap of air between glass
 * and water), so that such films are integrated for each ray. The worker whose ray first needs a table fills it; its
 * values depend only on the scene. Ownership: layered_plan_create allocates, layered_plan_destroy releases. */
#pragma once

#include "optics/multilayer.h"
#include "scene/model/material.h"
#include "scene/model/medium.h"
#include <pthread.h>
#include <stdatomic.h>

/* Steps of a table: LAYERED_STEPS_THIN for metals and for thin films up to LAYERED_THIN_NM, LAYERED_STEPS for
 * others. */
enum { LAYERED_STEPS = 256, LAYERED_STEPS_THIN = 128, LAYERED_THIN_NM = 1000 };

/* A thin film (thickness 0: none) on an opaque or transparent solid. */
typedef struct layered_surface {
    thin_film film;
    bool opaque;
    index_law law;     /* dispersion law behind an opaque surface */
    const material *m; /* source of the extinction index k */
} layered_surface;

/* Reflected colour at the cosines k / steps; not clamped, so that interpolation meets no kinks. */
typedef struct layered_curve {
    atomic_bool ready; /* the entries are filled */
    bool by_ray;       /* no entries: integrate for each ray */
    int steps;
    vec3 color[LAYERED_STEPS + 1];
} layered_curve;

typedef struct layered_plan {
    size_t priority_indices;
    const layered_surface **surface; /* by priority index; NULL for an ordinary surface */
    layered_surface *surfaces;
    double *index; /* refractive indices of the distinct media */
    int *medium;   /* by priority index: number of its medium, in index */
    int medium_count;
    layered_curve **curves; /* by priority index: a table per medium that meets the surface; NULL in a spectral film */
    bool *owns_curves;
    pthread_mutex_t filling;
    bool one_wavelength; /* set by the probe: every surface is evaluated at render.lambda_nm, for all channels */
} layered_plan;

/* By priority index, [0] for the surrounding medium: materials ([0] is NULL), their dispersion laws, their refractive
 * indices at render.lambda_nm, and their shading classes (plan.h). Sets *out to NULL if no surface is layered. Returns
 * false when out of memory. */
bool layered_plan_create(const render_settings *r, const material *const *materials, const index_law *const *laws,
                         const double *ior, const int *shading_class, size_t priority_indices, layered_plan **out);
void layered_plan_destroy(layered_plan *p);

/* Amplitudes at a wavelength, from n_from into n_to (not used behind an opaque surface). */
sp_amplitudes layered_amplitudes(const layered_surface *s, double cos_i, double n_from, double n_to, double lambda_nm);

/* The colour that a surface reflects between two media; cosine: on the side of the lower index, or before an opaque
 * surface. */
vec3 layered_color(const layered_surface *s, double cosine, double n_low, double n_high);
/* The table for the surface of a priority index and a medium, by its number (layered_plan.medium); filled if
 * necessary. */
const layered_curve *layered_curve_of(layered_plan *p, int priority_index, int medium_number);
/* Fills a table with the colours of layered_color before they are clamped. layered_curve_at interpolates, then
 * clamps. */
void layered_curve_make(const layered_surface *s, double n_low, double n_high, layered_curve *out);
vec3 layered_curve_at(const layered_curve *c, double cosine);
