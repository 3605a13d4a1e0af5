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
#include "render/plan/sampling.h"
#include "render/tracer/integrator.h"
#include <math.h>

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

/* Internals of the emission of photons, used only by emission.c and emission_aim.c. */

enum { CONES_MAX = 64 }; /* if more solids deflect light, one ball holds them all */

typedef struct ball {
    vec3 centre, half; /* half: half extents of the solid's axis-aligned box */
    double radius;     /* infinite: no bounds */
    int solid;         /* -1: several */
} ball;

typedef struct cone {
    vec3 axis;
    double cap;      /* 1 - the cosine of its half angle; 2: all directions; for a sun, 0: one direction */
    double flux;     /* relative to the flux of other cones and beams; 0: the lamp does not shine there */
    double fraction; /* of the lamp's photons */
} cone;

typedef struct lamp_emission {
    int64_t first, count; /* the lamp's photons: first .. first + count - 1 */
    cone *cones;
    uint64_t inside;
} lamp_emission;

typedef struct beam_emission {
    int64_t first, count;
    double flux;
    ray_axes axes;
    vec3 color; /* in an rgb film */
} beam_emission;

struct emission {
    const plan *p;
    int64_t photons; /* wanted */
    bool sizes, is_pilot;
    int ball_count;
    ball balls[CONES_MAX];
    double extent;
    lamp_emission *lamps;
    beam_emission *beams;
    int64_t count;
    double *wanted; /* relative numbers of photons by target */
};

/* Two numbers in (0, 1) for photon i of a source; purpose: source << 8 | choice. A pilot has other numbers. */
static inline unit_pair emission_pair(const emission *e, int64_t i, uint64_t purpose)
{
    enum { PILOT = 0x80 };
    const uint64_t source = e->is_pilot ? purpose | PILOT : purpose;
    const sobol_point s = sobol_at((uint32_t)i, (source << 32 | DRAW_PHOTON) ^ e->p->draws.seed_hash);
    return (unit_pair){random_unit(s.x), random_unit(s.y)};
}

/* The radius of a lamp that is a sphere, else 0. */
static inline double sphere_radius(const emission *e, int lamp)
{
    return e->sizes && !light_is_flat(&e->p->lights[lamp]) ? e->p->lights[lamp].radius : 0.0;
}

static inline bool is_flat(const emission *e, int lamp)
{
    return e->sizes && light_is_flat(&e->p->lights[lamp]);
}

static inline bool is_sun(const emission *e, int lamp)
{
    return e->p->lights[lamp].kind == LIGHT_SUN;
}

/* The rectangle, perpendicular to a direction, through which a sun's rays in that direction pass: around the solid's
 * box, aligned with the box's edge that is longest in projection. */
typedef struct sunlit_area {
    vec3 centre, u, v; /* u and v: unit vectors across the direction */
    double across, up; /* half its size along u and v */
} sunlit_area;

sunlit_area sunlit_area_of(const emission *e, int k, vec3 direction);

/* The distance from the start of a sun's rays to the middle of the scene. */
static inline double sun_path(const emission *e)
{
    return 0x1p10 * fmax(e->p->geometry->extent, vec3_length(e->p->view.eye));
}
