/* The camera in scalars: which way a point of the picture looks, and where a point of the scene lies in the picture.
 * Pinhole geometry, written apart from render/core/plan.c. Pictures count from their top left corner, px; lengths in
 * scene units. Pure. */
#pragma once

#include "scene/model/open.h"

typedef struct view {
    double x, y, z;       /* of the eye */
    double yaw, pitch;    /* radians: 0 along +z, towards +x; up */
    double roll;          /* radians: the camera's right side down */
    double width, height; /* px */
    double focal_px;      /* px that a slope of 1 makes in the picture's middle */
} view;

view view_of(const scene *s);

/* Direction of length 1 through a point of the picture. */
typedef struct sight {
    double x, y, z;
} sight;
sight view_through(const view *v, double px, double py);

/* Where a point of the scene lies in the picture; false behind the camera. */
bool view_place(const view *v, double x, double y, double z, double *px, double *py);
