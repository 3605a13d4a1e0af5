/* Lights of a scene. Plain values; a light owns its name. */
#pragma once

#include "base/vec3.h"
#include "optics/lamp_spectrum.h"
#include <stdint.h>

enum { SCENE_LIGHTS_MAX = 1024 };

typedef enum light_kind { LIGHT_POINT, LIGHT_CONE, LIGHT_SOFT_CONE } light_kind;

typedef struct light {
    char *name;
    int64_t kind;          /* light_kind */
    vec3 position, target; /* target: the point that a spotlight is aimed at */
    double half_angle_deg; /* of a spotlight, from its axis */
    vec3 color;
    double intensity;
    int64_t spectrum;     /* lamp_spectrum */
    double temperature_k; /* of a black body */
    double line_nm;       /* of a lamp of one line */
    double radius;        /* of the emitting sphere, for the path integrator; 0 = a point light */
    double reach;         /* the distance at which the intensity applies, with inverse square falloff; 0 = no falloff */
} light;
