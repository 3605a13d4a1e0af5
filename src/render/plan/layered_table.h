/* Surfaces that reflect by wave optics: metals, and thin films and coatings (optics/coating.h) on any surface
 * (optics/multilayer.h). For a spectral film they are evaluated exactly, ray by ray. For an rgb film each surface has
 * a table by angle of the colour of reflected daylight: its reflectance under D65, as the standard observer sees it
 * (optics/spectrum.h), in linear sRGB, where white is 1 at every angle; the media on both sides have their indices at
 * render.lambda_nm. Colours outside the gamut are clamped to 0 .. 1, so that no light is created; layers without
 * absorption transmit the rest, channel by channel, and for others there is a table of transmitted daylight, limited
 * to the rest. This is exact for one reflection of daylight; after several, the product of colours is not the colour
 * of the product.
 *
 * The table is uniform in the cosine on the side of the lower index, because the reflectance has no singularity there.
 * A ray from the other side uses the cosine of its refracted ray, since reversed paths have equal reflectance; under
 * total reflection the colour is 1. Layers that absorb reflect unlike from their two sides and under total reflection,
 * too: they have tables for each (layered_side). Interpolation is cubic: its error is below 2e-5 for thin films up to
 * 2 um, 1e-4 up to 10 um, and 2e-3 up to 20 um; 1e-2 within a degree of grazing, where fringes are narrower than the
 * steps of the integral. A table of several layers has as many steps as it needs for 1e-4, at most LAYERED_STEPS_MOST.
 * Total reflection begins abruptly at a thin film of lower index than both sides (a gap of air between glass and
 * water), so that single films of this kind are integrated for each ray. The worker whose ray first needs a table
 * fills it; its values depend only on the scene. Ownership: layered_plan_create allocates, layered_plan_destroy
 * releases. */
#pragma once

#include "optics/coating.h"
#include "scene/model/material.h"
#include "scene/model/medium.h"
#include <pthread.h>
#include <stdatomic.h>

/* Steps of a table: LAYERED_STEPS_THIN for metals and for thin films up to LAYERED_THIN_NM, LAYERED_STEPS for other
 * films; for several layers from LAYERED_STEPS_THIN to LAYERED_STEPS_MOST. */
enum { LAYERED_STEPS = 256, LAYERED_STEPS_THIN = 128, LAYERED_STEPS_MOST = 1024, LAYERED_THIN_NM = 1000 };

/* Layers on an opaque or transparent solid. */
typedef struct layered_surface {
    const film_stack *stack; /* NULL: none */
    bool opaque;
    index_law law;     /* dispersion law behind an opaque surface */
    const material *m; /* source of the extinction index k */
} layered_surface;

/* What a table is for, and its abscissa from 0 to 1. Only LAYERED_LOW is needed if the layers do not absorb. */
typedef enum layered_side {
    LAYERED_LOW,     /* reflection on the side of the lower index, or before an opaque surface: the cosine there */
    LAYERED_DENSE,   /* reflection on the other side, below the critical angle: the cosine of the refracted ray */
    LAYERED_BEYOND,  /* the same, under total reflection: t, where the cosine is (1 - t^2) / (1 + t^2) of that of the
                        critical angle, so that the reflectance has a singularity at neither end */
    LAYERED_THROUGH, /* transmission, the same from both sides: the cosine on the side of the lower index */
    LAYERED_SIDES
} layered_side;

/* Colours at the abscissas k / steps; not clamped, so that interpolation meets no kinks. */
typedef struct layered_curve {
    int steps;
    vec3 *color; /* steps + 1; NULL: integrate for each ray */
} layered_curve;

/* The tables of a surface between two media. */
typedef struct layered_curves {
    atomic_bool ready; /* they are filled */
    layered_curve side[LAYERED_SIDES];
} layered_curves;

typedef struct layered_plan {
    size_t priority_indices;
    const layered_surface **surface; /* by surface key (plan.h); NULL for an ordinary surface */
    layered_surface *surfaces;
    film_stack **stacks; /* of the surfaces; by priority index, NULL where another's is used */
    double *index;       /* refractive indices of the distinct media */
    int *medium;         /* by surface key: number of its medium, in index */
    int medium_count;
    layered_curves **curves; /* by priority index: a table per medium that meets the surface; NULL in a spectral film */
    bool *owns_curves;
    pthread_mutex_t filling;
    bool one_wavelength; /* set by the probe: every surface is evaluated at render.lambda_nm, for all channels */
} layered_plan;

/* By surface key (plan.h), [0] for the surrounding medium: materials ([0] is NULL), their dispersion laws, their
 * refractive indices at render.lambda_nm, and their shading classes (plan.h). Sets *out to NULL if no surface is
 * layered. Returns false when out of memory. */
bool layered_plan_create(const render_settings *r, const material *const *materials, const index_law *const *laws,
                         const double *ior, const int *shading_class, size_t priority_indices, layered_plan **out);
void layered_plan_destroy(layered_plan *p);

/* Amplitudes at a wavelength, from n_from into n_to (not used behind an opaque surface). inward: the ray meets the
 * layers from outside of the solid. */
sp_amplitudes layered_amplitudes(const layered_surface *s, bool inward, double cos_i, double n_from, double n_to,
                                 double lambda_nm);

/* The colours that a surface reflects and transmits, from tables or, without them (NULL), integrated. */
typedef struct layered_colors {
    vec3 reflected, transmitted;
} layered_colors;
layered_colors layered_colors_at(const layered_surface *s, const layered_curves *c, bool inward, double cos_i,
                                 double n_from, double n_to);
/* The tables of the surface of a key and a medium, by its number (layered_plan.medium); filled if
 * necessary. */
const layered_curves *layered_curves_of(layered_plan *p, int priority_index, int medium_number);
/* Fills the tables for a surface with indices n_out outside and n_in inside of the solid; *out must be zero.
 * layered_curves_release frees them. */
void layered_curves_make(const layered_surface *s, double n_out, double n_in, layered_curves *out);
void layered_curves_release(layered_curves *c);
