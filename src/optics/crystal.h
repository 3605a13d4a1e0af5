/* Double refraction: plane interfaces where at least one medium is a uniaxial crystal. A ray that meets one splits into
 * up to four: an ordinary and an extraordinary one in each crystal, one in each isotropic medium. Born and Wolf,
 * Principles of Optics, 7th ed., 15.2 and 15.3; boundary conditions: Yeh, Optical Waves in Layered Media, chapter 9.
 * Crystals are transparent and not optically active. Pure; cannot fail; all values, nothing is owned.
 *
 * In a crystal a ray is of one of two modes, each fully polarised. Its direction d is the direction of the energy flow.
 * The wave vector, in units of 2 pi / lambda, is n_o d for an ordinary ray, and for an extraordinary ray the point of
 * an ellipsoid at which the normal is d.
 *
 * Signs and frames are those of optics/mueller.h: rays run from the eye, light against them; by reciprocity, light has
 * the amplitude of a wave along the ray. Modes are followed as rays that do not interfere: their powers add. This is
 * exact if the modes separate, and is the mean over a fringe if they overlap. */
#pragma once

#include "optics/mueller.h"
#include <stdbool.h>

/* n_o: index of an isotropic medium or of the ordinary wave. Uniaxial media only: n_e is the index for a field along
 * axis, the optic axis (a unit vector). */
typedef struct optical_medium {
    bool uniaxial;
    double n_o, n_e;
    vec3 axis;
} optical_medium;

/* The kind of a ray; MODE_ANY in an isotropic medium. */
typedef enum crystal_mode { MODE_ANY, MODE_ORDINARY, MODE_EXTRAORDINARY } crystal_mode;

/* A ray of direction d in `from` that meets the interface with `to`; the normal n faces the ray. */
typedef struct crystal_incidence {
    optical_medium from, to;
    vec3 d, n;
    crystal_mode mode; /* in `from` */
    bool mirror;       /* the interface is a perfect mirror's surface; `to` is not used */
} crystal_incidence;

typedef struct crystal_ray {
    vec3 d;
    bool reflected;
    crystal_mode mode;
    /* The analyser's row. In an isotropic medium in d's canonical frame; .i is the weight of unpolarised light. In a
     * crystal only .i is set: unpolarised light has half of its power in each mode. */
    stokes row;
} crystal_ray;

enum { CRYSTAL_RAYS_MAX = 4 };

/* Splits an incident ray with an analyser row (in a crystal only row.i counts) into reflected rays, then transmitted
 * ones, the ordinary after the extraordinary. Waves that do not travel away (total reflection) are left out. Returns
 * their number. The weights .i of an unpolarised row add up to row.i. */
int crystal_split(const crystal_incidence *in, stokes row, crystal_ray out[CRYSTAL_RAYS_MAX]);

/* The wave vector of a ray of direction d; its length is the refractive index of the wave. */
vec3 crystal_wave_vector(const optical_medium *m, crystal_mode mode, vec3 d);
