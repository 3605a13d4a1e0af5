/* Light that facets of a rough surface send to other facets, which optics/microfacet.h loses. With
 * render.energy_compensation it leaves in every direction, as from a matte surface,
 *   f(i, o) = w A(i) A(o) / (pi a),
 * where A(i) is the fraction of light from i that one facet loses, a its mean on the side of o (twice the integral of A
 * times cosine), and w the fraction of this light that leaves there. No light is lost then, and f is reciprocal; [KC].
 *   [KC] Kulla and Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH 2017; after Kelemen and
 *        Szirmay-Kalos, "A microfacet based coupled specular-matte BRDF model", Eurographics 2001.
 * The fraction w. A metal or a mirror of mean reflectance F has w = F^2 E / (1 - F (1 - E)), where E = 1 - a is the
 * mean albedo of facets that reflect everything: each further facet reflects F. A clear solid has one fraction for
 * reflection and one for refraction, whose sum is 1. Light from side 1 to 2 is reciprocal if n_1^2 t_1 a_1 = n_2^2 t_2
 * a_2 (basic radiance); the mean transmittances of smooth surfaces have n_1^2 T_1 = n_2^2 T_2, so that t_1 = T_1 min(1,
 * a_2 / a_1) is the largest fraction that obeys both; [KC] have a_2 / (a_1 + a_2) for the minimum. From air into glass
 * of index 1.5 at alpha 0.5, a random walk (Heitz and others, "Multiple-scattering microfacet BSDFs with the Smith
 * model", SIGGRAPH 2016) refracts 0.96 to 0.98 of this light, the minimum has 0.91, and [KC] have 0.71.
 *
 * A is tabulated by sqrt(cosine) for the ratios of indices 2^(k / 64) up to 4, and interpolated between them; thin
 * films are ignored. The worker whose ray first needs a table fills it; its values depend only on the material and the
 * ratio. Ownership: rough_energy_add allocates, rough_energy_destroy releases. */
#pragma once

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

enum { ENERGY_STEPS = 64, ENERGY_PER_OCTAVE = 64, ENERGY_RATIOS = 129 };

/* Fractions of energy for one ratio of indices, with the symbols above. lost: A; [0] on the side of the lower index, or
 * before an opaque surface, [1] on the other side; node k is at the cosine (k / ENERGY_STEPS)^2. mean: a by side.
 * passed: T of a smooth surface, from the side of the lower index. */
typedef struct energy_table {
    atomic_bool ready;
    double lost[2][ENERGY_STEPS + 1], mean[2], passed;
} energy_table;

/* The rough surfaces that share tables. reflectivity: see material_reflectivity. */
typedef struct rough_finish {
    double alpha, reflectivity;
    bool opaque;
    energy_table *tables; /* ENERGY_RATIOS tables; one for an opaque surface */
} rough_finish;

typedef struct rough_energy {
    int count;
    size_t room;
    rough_finish *finishes;
    pthread_mutex_t filling;
} rough_energy;

/* Adds a finish unless it is present, and creates *all if it is NULL. Returns false when out of memory. */
bool rough_energy_add(rough_energy **all, double alpha, double reflectivity, bool opaque);
void rough_energy_destroy(rough_energy *all);
const rough_finish *rough_energy_find(const rough_energy *all, double alpha, double reflectivity, bool opaque);

/* The lost light at a point of the surface, for light from a medium of index n_from at a cosine; n_to is unused if
 * opaque. */
typedef struct facet_energy {
    const energy_table *below, *above; /* tables of the nearest ratios */
    double mix;                        /* weight of `above` */
    int from, to;                      /* sides, as in energy_table */
    double lost;                       /* A(i), in [0, 1] */
    double fraction[2];                /* of reflection and, for a clear surface, refraction; their sum is 1 */
    double mean;                       /* E of an opaque surface */
} facet_energy;

facet_energy facet_energy_at(rough_energy *all, const rough_finish *finish, double n_from, double n_to, double cosine);

/* A(o) / a of a direction on the side of reflection or refraction. With it,
 *   f |cos o| = lost * fraction[refracted] * A(o) / a * |cos o| / pi.
 * For an opaque surface also multiply by w, which is facet_energy_kept of the mean reflectance. */
double facet_energy_towards(const facet_energy *e, bool refracted, double cosine);
double facet_energy_kept(const facet_energy *e, double reflectance);
