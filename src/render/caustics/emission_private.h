/* Internals of the emission of photons, used only by emission.c and emission_aim.c. */
#pragma once

#include "render/caustics/emission.h"

#include "render/plan/ray_axes.h"

#include <math.h>

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
