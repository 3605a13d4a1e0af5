/* Beams of the optical bench: rays that are shown, and with `lights` a lamp whose light photons bring. Plain values; a
 * beam owns its name. */
#pragma once

#include "base/vec3.h"
#include "optics/spectrum.h"
#include "scene/model/render_settings.h"
#include <stdbool.h>
#include <stdint.h>

enum { SCENE_BEAMS_MAX = 64, BEAM_RAYS_MAX = 10000, BEAM_DEPTH_MAX = 10000 };

/* From one point: within a cone, or in a plane. Parallel: in a plane, or over a disc. */
typedef enum beam_kind { BEAM_PENCIL, BEAM_FAN, BEAM_SHEET, BEAM_BUNDLE } beam_kind;

/* Of the power of its photons: even within the angle or width; or exp(-2 r^2 / w^2), whose 2 w is the angle or width.
 */
typedef enum beam_profile { BEAM_UNIFORM, BEAM_GAUSSIAN } beam_profile;

typedef struct beam {
    char *name;
    int64_t kind; /* beam_kind */
    vec3 position, target;
    vec3 direction; /* used instead of the target unless it is zero */
    vec3 normal;    /* of the plane of a fan or sheet; zero: as in `cuvette fan` */
    int64_t rays;
    double angle_deg, width; /* full angle of a pencil or fan; width of a sheet, diameter of a bundle, scene units */
    int64_t white;           /* 1: `wavelengths` wavelengths from BEAM_LOW_NM to BEAM_HIGH_NM instead of lambda_nm */
    double lambda_nm;
    int64_t wavelengths;
    double power;     /* of all rays together, at their starts */
    int64_t branches; /* 1: reflected and refracted rays; 0: the refracted path, as in `cuvette fan` */
    int64_t depth;
    double min_share;
    vec3 color; /* of the drawn lines; black: the colour of the wavelength */
    int64_t visible;
    int64_t lights, profile; /* 1: it lights the scene, with that beam_profile */
} beam;

/* White light: evenly spaced, of equal power. */
enum { BEAM_LOW_NM = 400, BEAM_HIGH_NM = 700 };

static inline int beam_wavelengths(const beam *b)
{
    return b->white ? (int)b->wavelengths : 1;
}

static inline double beam_lambda(const beam *b, int number)
{
    if (!b->white)
        return b->lambda_nm;
    if (b->wavelengths == 1)
        return 0.5 * (BEAM_LOW_NM + BEAM_HIGH_NM);
    return BEAM_LOW_NM + (double)(BEAM_HIGH_NM - BEAM_LOW_NM) * number / (double)(b->wavelengths - 1);
}

/* The direction of its axis, of any length. */
static inline vec3 beam_axis(const beam *b)
{
    return vec3_dot(b->direction, b->direction) > 0.0 ? b->direction : vec3_sub(b->target, b->position);
}

/* Whether photons bring its light. That of a wavelength which the eye does not see is none. */
static inline bool beam_lights_scene(const beam *b, const render_settings *r)
{
    const bool seen = b->white || (b->lambda_nm >= OBSERVER_LOW_NM && b->lambda_nm <= OBSERVER_HIGH_NM);
    return b->lights && b->visible && b->power > 0.0 && seen && scene_has_caustics(r);
}

static inline bool beam_is_parallel(const beam *b)
{
    return b->kind == BEAM_SHEET || b->kind == BEAM_BUNDLE;
}
