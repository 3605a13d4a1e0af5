/* Emission of photons: which ray from a lamp each photon begins with, and which power it carries. Photons start only
 * towards what can deflect them, mirrors and clear solids: their directions are uniform over the cones, seen from the
 * lamp, around the bounding balls of these solids, with a density that is the sum over the cones. Where one has no
 * bounds, the cone is the whole sphere of directions; a lamp's own cone takes the place of one that is wider. A lamp
 * and the ball of a solid that it can light are a target. A lamp's flux into a small solid angle dw is pi I reach^2 dw,
 * for a point as for a sphere, whose every direction leaves from a disc across it; I is its intensity (path.c). A ray
 * of a direction passes a random point of the lamp's disc, or, of a lamp that is larger than the ball, as the sun is,
 * of the ball's disc. A sun's directions are uniform over its disc, or one; its rays pass rectangles around the solids
 * across them, and begin far before all solids. Where a ball has no bounds, they are followed within twice the extent
 * of the scene.
 *
 * A beam that lights the scene is one more lamp: its photons start as its rays do, whatever they meet, and bring its
 * light to the first matte surface too, which no shadow ray does.
 *
 * Photons are points of a scrambled Sobol sequence for each lamp, a function of the seed and the photon's number.
 * Ownership: emission_create allocates, emission_destroy releases; the plan is borrowed. */
#pragma once

#include "base/status.h"
#include "render/plan/plan.h"

typedef struct emission emission;

/* Of `photons` photons in all. With C the flux towards a target, n its photons of which the fraction h arrives, the
 * squared error of the light that arrives, C h, is C^2 h / n: n in proportion to sqrt(C) makes the sum of the squared
 * errors, each over its light, the least (the Lagrange function of sum C / n). sizes: lights with a size have it,
 * otherwise they are points. */
status emission_create(const plan *p, int64_t photons, bool sizes, emission **out, diagnostic *why);
void emission_destroy(emission *e);

/* Targets: the pairs of a lamp and a solid that deflects its light, then the beams. The solid's number in the scene, or
 * -1: a beam, or several solids. */
int emission_target_count(const emission *e);
int emission_target_solid(const emission *e, int target);
/* The light that arrives from a target, relative to others, when that number of its photons does. */
double emission_light(const emission *e, int target, int64_t arrived);
/* A pilot tells from which targets light arrives. While it goes on there are few photons, as many for each target, and
 * other ones than later. emission_end_pilot: delivers[target] is whether any did; the others get a small fraction. */
bool emission_begin_pilot(emission *e);
void emission_end_pilot(emission *e, const bool *delivers);

/* The number of photons that are really emitted: 0 if no lamp shines or nothing can deflect them, and no beam does. */
int64_t emission_count(const emission *e);
/* The radius of the largest bounding ball; of scenes without bounds, that of the scene; at least that of beams. */
double emission_extent(const emission *e);

typedef struct emitted_ray {
    vec3 origin, direction;
    vec3 power; /* over pi, by channel; in a spectral film that at the photon's wavelength, in each channel */
    double lamp_radius;
    double q, u; /* with polarisation: its Stokes vector relative to its first element, in its canonical frame */
    uint64_t inside;
    int target;
    int wavelength; /* its number, or -1 */
    bool of_line;   /* one of a spectral line, of which all photons count for that wavelength alone */
    bool of_beam;
    bool falls; /* false: its light does not fall off with distance, and its power applies at distance 1 */
} emitted_ray;

/* The ray of photon i; false if it has none (outside a spotlight's cone). */
bool emission_ray(const emission *e, int64_t i, emitted_ray *out);

/* A random number in (0, 1) for a decision of photon i at a depth. */
double emission_chance(const emission *e, int64_t i, int depth, int which);
/* Two, for the end of a deep photon and its branch; two, for the facet of a rough surface. */
unit_pair emission_roulette(const emission *e, int64_t i, int depth);
unit_pair emission_facet(const emission *e, int64_t i, int depth);
/* Two, and another one, for light of further facets. */
unit_pair emission_further(const emission *e, int64_t i, int depth, double *chance);
