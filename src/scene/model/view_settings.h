/* What a scene is looked at with, and what it is surrounded by: camera, background. Plain values; a background owns
 * its picture. */
#pragma once

#include "base/vec3.h"
#include "image/image.h"
#include <stdint.h>

typedef enum background_kind { BACKGROUND_UNIFORM, BACKGROUND_GRADIENT, BACKGROUND_IMAGE } background_kind;
/* Of a sky picture's values: under the film's limit, and all that a half float holds. */
#define SCENE_SKY_MAX 65536.0F

/* y is up; yaw 0 looks along +z, positive yaw turns towards +x, positive pitch looks up; x is to the right at yaw 0. */
typedef struct camera {
    vec3 position;
    vec3 target;               /* used when aimed */
    double yaw_deg, pitch_deg; /* used when not aimed */
    int64_t aimed;             /* 1: looks at target; 0: along yaw and pitch. Set by whichever was written last */
    double roll_deg;           /* about the direction of view, right side down: the image turns counter-clockwise */
    double fov_deg;            /* vertical */
} camera;

typedef struct background {
    int64_t kind;                  /* background_kind */
    vec3 color;                    /* linear RGB in x, y, z; uniform, and the zenith of a gradient */
    vec3 horizon;                  /* gradient: colour at and below the horizon */
    char *image_path;              /* equirectangular sky; "" for none; relative to the scene file */
    long image_line, image_column; /* where the scene file names it; 0 when it was set otherwise */
    image *img;                    /* owned; NULL until loaded by scene_load */
    vec3 ambient;                  /* I_a of Phong's sum, linear RGB */
    double ior;                    /* of what surrounds all solids, where medium is MEDIUM_IOR */
    int64_t medium;                /* see scene/model/medium.h */
    vec3 absorb_per_m; /* of what surrounds all solids, by channel, along ways that end at a surface or a light */
} background;
