/* Camera and background of a scene. Plain values; a background owns its image. */
#pragma once

#include "base/vec3.h"
#include "image/image.h"
#include "optics/cie_sky.h"
#include <stdint.h>

typedef enum background_kind {
    BACKGROUND_UNIFORM,
    BACKGROUND_GRADIENT,
    BACKGROUND_IMAGE,
    BACKGROUND_RAIN,
    BACKGROUND_CIE
} background_kind;
typedef enum projection_rule { PROJECTION_PERSPECTIVE, PROJECTION_ORTHOGRAPHIC } projection_rule;
typedef enum analyser_kind {
    ANALYSER_NONE,
    ANALYSER_LINEAR,
    ANALYSER_CIRCULAR_LEFT,
    ANALYSER_CIRCULAR_RIGHT
} analyser_kind;
/* Maximum radiance of a background image times its brightness: below the film's limit, and above the largest half
 * float, 65504. */
#define SCENE_SKY_MAX 65536.0F

/* y is up; yaw 0 looks along +z, positive yaw turns towards +x, positive pitch looks up; x is to the right at yaw 0. */
typedef struct camera {
    vec3 position;
    vec3 target;               /* used if aimed */
    double yaw_deg, pitch_deg; /* used if not aimed */
    int64_t aimed;             /* 1: at target; 0: along yaw and pitch; whichever was set last */
    double roll_deg;           /* about the viewing direction, right side down: the image turns counter-clockwise */
    int64_t projection;        /* projection_rule */
    double fov_deg;            /* vertical; perspective */
    double view_height;        /* of the image, scene units; orthographic */
    double aperture;           /* diameter of a thin lens, scene units; 0: a pinhole */
    double focus;              /* distance of the plane in focus along the viewing direction, scene units */
    int64_t analyser;          /* analyser_kind: an ideal filter before the eye, with render.polarisation */
    double analyser_angle_deg; /* of a linear analyser's axis: from the image's right, towards up */
    double exposure;           /* stops, for images with 8 bits */
    int64_t tone;              /* tone_curve, for images with 8 bits */
    double white;              /* see image_tone */
} camera;

typedef struct background {
    int64_t kind;     /* background_kind */
    vec3 color;       /* linear RGB in x, y, z; uniform, or the zenith of a gradient or a CIE sky */
    vec3 horizon;     /* colour at and below the horizon of a gradient, also behind rain; below the horizon of a CIE
                         sky */
    char *image_path; /* equirectangular sky; "" for none; relative to the scene file */
    long image_line, image_column; /* where the scene file names the image; 0 if it does not */
    image *img;                    /* owned; NULL until loaded by scene_load */
    float brightest;               /* largest value of img, set by sky_take */
    double brightness;             /* factor of img's radiance */
    vec3 ambient;                  /* I_a of Phong's equation, linear RGB */
    double ior;                    /* index of the surroundings of all solids, if medium is MEDIUM_IOR */
    int64_t medium;                /* see scene/model/medium.h */
    double rain;                   /* radiance of the rain if its drops scattered evenly in all directions */
    int64_t drops;                 /* the drops' medium, from DROPS_FIRST in scene/model/medium.h */
    double sun_elevation_deg, sun_azimuth_deg; /* without a light of kind sun; azimuth as the camera's yaw */
    int64_t sky_type;                          /* of a CIE sky: see optics/cie_sky.h */
    cie_sky cie;                               /* set only in the background of a plan */
    vec3 absorb_per_m; /* absorption of the surroundings by channel, along rays that end at a surface or a light */
} background;
