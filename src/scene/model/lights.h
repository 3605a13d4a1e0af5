/* The lights and the beams of a scene. The rays of a beam are drawn; with `lights` it is also a lamp, whose light
 * photons carry. Plain values; each owns its name. */
#pragma once

#include "base/vec3.h"
#include "optics/optical_data.h"
#include "optics/spectrum.h"
#include "scene/model/material.h"
#include "scene/model/render_settings.h"
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

enum { SCENE_LIGHTS_MAX = 1024 };

typedef enum light_kind {
    LIGHT_POINT,
    LIGHT_CONE,
    LIGHT_SOFT_CONE,
    LIGHT_DISC,
    LIGHT_RECTANGLE,
    LIGHT_SUN /* infinitely far away, in the direction from target to position */
} light_kind;

typedef struct light {
    char *name;
    int64_t kind;          /* light_kind */
    vec3 position, target; /* target: the point that a spotlight or a flat light is aimed at */
    double half_angle_deg; /* of a spotlight, from its axis */
    vec3 color;
    double intensity;
    int64_t spectrum;                       /* lamp_spectrum */
    char spectrum_data[SCENE_NAME_MAX + 1]; /* of LAMP_DATA; "" for none */
    const optical_data *emission_data;      /* as a material's index_data */
    double temperature_k;                   /* of a black body */
    double line_nm;                         /* of a lamp of one line */
    double radius;                          /* of an emitting sphere or disc; 0 = a point light */
    double width, height, roll_deg;         /* of a rectangle */
    double angular_diameter_deg;            /* of a sun; 0: all its light is parallel */
    double polarised, polarisation_deg; /* degree of linear polarisation, and the field's angle from the horizontal */
    double reach; /* the distance at which the intensity applies, with inverse square falloff; 0 = no falloff */
} light;

/* A disc or a rectangle. */
static inline bool light_is_flat(const light *l)
{
    return l->kind == LIGHT_DISC || l->kind == LIGHT_RECTANGLE;
}

/* The radius of a ball around the light: 0 for a point and for a sun. */
static inline double light_extent(const light *l)
{
    return l->kind == LIGHT_SUN                ? 0.0
           : l->kind != LIGHT_RECTANGLE        ? l->radius
           : l->width > 0.0 && l->height > 0.0 ? 0.5 * sqrt(l->width * l->width + l->height * l->height)
                                               : 0.0;
}

/* Whether the light has an angular size, so that its shadows can be soft. */
static inline bool light_has_size(const light *l)
{
    return l->kind == LIGHT_SUN ? l->angular_diameter_deg > 0.0 : light_extent(l) > 0.0;
}

/* --- beams --- */

enum { BEAM_RAYS_MAX = 1000000, BEAM_FIELDS_MAX = 1000, BEAM_DEPTH_MAX = 10000 };

/* Rays from one point in a cone (pencil) or a plane (fan), or parallel rays in a plane (sheet) or over a disc
 * (bundle). */
typedef enum beam_kind { BEAM_PENCIL, BEAM_FAN, BEAM_SHEET, BEAM_BUNDLE } beam_kind;

/* Where the rays of a pencil and a bundle are in the cone or disc; all divide it into equal parts (ray_axes.h). */
typedef enum beam_pattern { PATTERN_SPIRAL, PATTERN_RINGS, PATTERN_SQUARE, PATTERN_SOBOL } beam_pattern;

/* Distribution of the photons' power: even over the angle or width, or exp(-2 r^2 / w^2), with 2 w as the angle or
 * width. */
typedef enum beam_profile { BEAM_UNIFORM, BEAM_GAUSSIAN } beam_profile;

typedef struct beam_place {
    vec3 position, target;
    vec3 direction;     /* used instead of the target unless it is zero */
    vec3 normal;        /* of the plane of a fan or sheet; zero: as in `cuvette fan` */
    double width;       /* of a sheet, diameter of a bundle */
    double field_width; /* between the outermost field points of rays from a point */
} beam_place;

typedef struct beam {
    char *name;
    int64_t kind;                             /* beam_kind */
    char follows[SCENE_NAME_MAX + 1];         /* name of a solid with which it moves, turns and is scaled; "": none */
    beam_place own;                           /* in that solid's frame, as the parameters have it */
    vec3 position, target, direction, normal; /* in the world, as in beam_place */
    double width, field_width;
    int64_t rays;
    int64_t pattern;                   /* beam_pattern */
    int64_t field_columns, field_rows; /* field points: each has all rays */
    double field_deg;                  /* between the outermost field points of parallel rays */
    double angle_deg;                  /* full angle of a pencil or fan */
    int64_t white; /* 1: `wavelengths` wavelengths from BEAM_LOW_NM to BEAM_HIGH_NM instead of lambda_nm */
    double lambda_nm;
    int64_t wavelengths;
    double power;     /* sum over all rays and field points, at their starts */
    int64_t branches; /* 1: reflected and refracted rays; 0: the refracted path, as in `cuvette fan` */
    int64_t depth;
    double min_fraction;
    vec3 color; /* of the drawn lines; black: the colour of the wavelength */
    int64_t visible;
    int64_t lights, profile; /* 1: the beam lights the scene; beam_profile of its light */
} beam;

/* Wavelengths of white light: evenly spaced, of equal power. */
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

static inline int beam_fields(const beam *b)
{
    return (int)(b->field_columns * b->field_rows);
}

/* The direction of the beam's axis, of any length. */
static inline vec3 beam_axis(const beam *b)
{
    return vec3_dot(b->direction, b->direction) > 0.0 ? b->direction : vec3_sub(b->target, b->position);
}

/* Whether photons carry the beam's light; wavelengths that the eye does not see are no light. */
static inline bool beam_lights_scene(const beam *b, const render_settings *r)
{
    const bool seen = b->white || (b->lambda_nm >= OBSERVER_LOW_NM && b->lambda_nm <= OBSERVER_HIGH_NM);
    return b->lights && b->visible && b->power > 0.0 && seen && scene_has_caustics(r);
}

static inline bool beam_is_flat(const beam *b)
{
    return b->kind == BEAM_FAN || b->kind == BEAM_SHEET;
}

static inline bool beam_is_parallel(const beam *b)
{
    return b->kind == BEAM_SHEET || b->kind == BEAM_BUNDLE;
}
