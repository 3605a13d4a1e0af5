/* Emission of photons: the first ray of each photon, and its power. Photons start only towards solids that can deflect
 * them, mirrors and clear solids: their directions are uniform over the cones, seen from the lamp, around the bounding
 * balls of these solids, with a density that is the sum over the cones. For an unbounded solid, the cone is the full
 * sphere of directions; a spotlight's cone replaces a wider one. A lamp and the ball of a solid that it can light are a
 * target. A lamp's flux into a small solid angle dw is pi I reach^2 dw, for a point as for a sphere, which emits each
 * direction from a disc perpendicular to it; I is its intensity (path.c). A ray passes through a random point of the
 * lamp's disc or, if the lamp is larger than the ball, of the ball's disc. A sun's directions are uniform over its
 * disc, or equal; its rays pass through rectangles around the solids, perpendicular to the rays, and begin far in front
 * of all solids. For an unbounded ball, the rectangle covers twice the extent of the scene.
 *
 * A beam that lights the scene is one more lamp: its photons start like its rays, towards any solid, and also light the
 * first matte surface, since beams have no shadow rays.
 *
 * Photons are points of a scrambled Sobol sequence for each lamp, a function of the seed and the photon's number.
 * Ownership: emission_create allocates, emission_destroy releases; the plan is borrowed. */
#pragma once

#include "base/status.h"
#include "render/photons/photon_map.h"
#include "render/plan/plan.h"
#include "render/tracer/integrator.h"

typedef struct emission emission;

/* Divides `photons` photons among the targets. With C the flux towards a target, and n its photons, of which the
 * fraction h arrives, the squared error of the arriving light C h is C^2 h / n: n in proportion to sqrt(C) minimises
 * the sum of the squared errors, each divided by its light (the Lagrange function of sum C / n). sizes: whether lights
 * keep their size; otherwise they are points. */
status emission_create(const plan *p, int64_t photons, bool sizes, emission **out, diagnostic *why);
void emission_destroy(emission *e);

/* Targets: the pairs of a lamp and a solid that deflects its light, then the beams. emission_target_solid: the solid's
 * number in the scene, or -1 for a beam or several solids. */
int emission_target_count(const emission *e);
int emission_target_solid(const emission *e, int target);
/* The light that arrives from a target, relative to other targets, if `arrived` of its photons arrive. */
double emission_light(const emission *e, int target, int64_t arrived);
/* A pilot finds the targets from which light arrives. It has few photons, equally many per target, and different from
 * the later ones. emission_begin_pilot: false if a pilot is not worthwhile. emission_end_pilot: delivers[target]:
 * whether any of its photons arrived; targets that deliver none get a small fraction of the photons. */
bool emission_begin_pilot(emission *e);
void emission_end_pilot(emission *e, const bool *delivers);

/* The number of photons to emit: 0 if there is no beam, and no lamp shines or nothing can deflect its light. */
int64_t emission_count(const emission *e);
/* The radius of the largest bounding ball, or of the scene for an unbounded solid; at least the extent of the beams. */
double emission_extent(const emission *e);

typedef struct emitted_ray {
    vec3 origin, direction;
    vec3 power; /* over pi, by channel; in a spectral film, at the photon's wavelength, equal in all channels */
    double lamp_radius;
    double q, u; /* with polarisation: the Stokes vector relative to its first element, in the ray's canonical frame */
    uint64_t inside;
    int target;
    int wavelength; /* number of the photon's wavelength; -1 in an rgb film */
    bool of_line;   /* the photon is of a spectral line, and contributes only to its wavelength */
    bool of_beam;
    bool falls; /* false: the light has no falloff with distance, and its power applies at distance 1 */
} emitted_ray;

/* The ray of photon i; false if it has none, for example outside a spotlight's cone. */
bool emission_ray(const emission *e, int64_t i, emitted_ray *out);

/* A random number in (0, 1) for a decision of photon i at a depth. */
double emission_chance(const emission *e, int64_t i, int depth, int which);
/* Two random numbers each: for the end and the branch of a deep photon; for the facet of a rough surface. */
unit_pair emission_roulette(const emission *e, int64_t i, int depth);
unit_pair emission_facet(const emission *e, int64_t i, int depth);
/* Two random numbers, and a third in *chance, for light of further facets. */
unit_pair emission_further(const emission *e, int64_t i, int depth, double *chance);

/* --- photon_integrator.c: the integrator that traces photons, as a separate frame (render/tracer/integrator.h) --- */

/* The state of the photons' frame. */
typedef struct photon_frame {
    const emission *from;
    atomic_int_fast64_t *arrived; /* photons at matte surfaces, by target */
    bool is_pilot;                /* a pilot only counts photons */
    atomic_bool out_of_memory;
} photon_frame;

extern const integrator integrator_of_photons;

/* Enqueues photons first .. end - 1 in the tracer's first queue, which must have room; found: the list to which
 * arriving photons are added from now on. */
void photon_integrator_emit(tracer *t, int64_t first, int64_t end, photon_list *found);
