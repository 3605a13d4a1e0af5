/* Lights of a scene. Plain values; a light owns its name. */
#pragma once

#include "base/vec3.h"
#include "optics/spectrum.h"
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
    int64_t spectrum;                   /* lamp_spectrum */
    double temperature_k;               /* of a black body */
    double line_nm;                     /* of a lamp of one line */
    double radius;                      /* of an emitting sphere or disc; 0 = a point light */
    double width, height, roll_deg;     /* of a rectangle */
    double angular_diameter_deg;        /* of a sun; 0: all its light is parallel */
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

/* Is it seen under an angle, so that its shadows can be soft? */
static inline bool light_has_size(const light *l)
{
    return l->kind == LIGHT_SUN ? l->angular_diameter_deg > 0.0 : light_extent(l) > 0.0;
}
