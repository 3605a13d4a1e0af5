/* Lights of a scene. Values; a light owns its name. */
#pragma once

#include "base/vec3.h"
#include <stdint.h>

enum { SCENE_LIGHTS_MAX = 64 };

typedef enum light_kind { LIGHT_POINT, LIGHT_CONE, LIGHT_SOFT_CONE } light_kind;

typedef struct light {
    char *name;
    int64_t kind;          /* light_kind */
    vec3 position, target; /* target: the point that a cone is aimed at */
    double half_angle_deg; /* of a cone, from its axis */
    vec3 color;
    double intensity;
    double radius; /* of the sphere that shines, for the path tracer; 0 = a point */
    double reach;  /* distance at which intensity holds, falling off with the square; 0 = the same everywhere */
} light;
