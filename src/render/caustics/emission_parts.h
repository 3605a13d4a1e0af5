/* The parts of an emission of photons, for emission.c and emission_aim.c alone. */
#pragma once

#include "render/caustics/emission.h"

#include "render/core/draw.h"
#include "render/inspect/ray_axes.h"

#include <math.h>

enum { CONES_MAX = 64 }; /* of a scene with more solids that deflect light, one ball holds them all */

typedef struct ball {
    vec3 centre;
    double radius; /* infinite: no bounds */
} ball;

typedef struct cone {
    vec3 axis;
    double cap;   /* 1 - the cosine of its half angle; 2: all directions; of a sun, 0: one direction */
    double share; /* of the lamp's photons */
} cone;

typedef struct lamp_emission {
    int64_t first, count; /* its photons */
    cone *cones;
    uint64_t inside;
} lamp_emission;

typedef struct beam_emission {
    int64_t first, count;
    ray_axes axes;
    vec3 color; /* in an rgb film */
} beam_emission;

struct emission {
    const plan *p;
    bool sizes;
    int ball_count;
    ball balls[CONES_MAX];
    double extent;
    lamp_emission *lamps;
    beam_emission *beams;
    int64_t count;
};

static inline unit_pair emission_pair(const emission *e, int64_t i, uint64_t purpose)
{
    const sobol_point s = sobol_at((uint32_t)i, (purpose << 32 | DRAW_PHOTON) ^ e->p->draws.seed_hash);
    return (unit_pair){random_unit(s.x), random_unit(s.y)};
}

/* emission_beam.c: prepares the beams and sets their shares of the photons, as emission_aim.c does of lamps; then the
 * ray of photon i, which must be a beam's. */
status emission_prepare_beams(emission *e, double *power, diagnostic *why);
bool emission_beam_ray(const emission *e, int64_t i, emitted_ray *out);

/* Of a lamp that is a sphere, else 0. */
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

/* The ball whose disc, across them, a sun's rays pass. */
static inline ball sunlit_ball(const emission *e, int k)
{
    const camera_frame *view = &e->p->view;
    if (!isinf(e->balls[k].radius))
        return e->balls[k];
    return (ball){vec3_make(0.0, 0.0, 0.0), 2.0 * fmax(e->p->geometry->extent, vec3_length(view->eye))};
}

/* From where a sun's rays begin to the middle of the scene. */
static inline double sun_path(const emission *e)
{
    return 0x1p10 * fmax(e->p->geometry->extent, vec3_length(e->p->view.eye));
}
