/* The camera in scalars: direction of an image point, and projection of a scene point. Pinhole geometry, independent of
 * render/core/plan.c. Image coordinates start at the top left corner, px; lengths in scene units. Pure. */
#pragma once

#include "scene/model/open.h"

typedef struct view {
    double x, y, z;       /* of the camera */
    double yaw, pitch;    /* radians: 0 along +z, towards +x; up */
    double roll;          /* radians: the camera's right side down */
    double width, height; /* px */
    double focal_px;      /* focal length in px: size of a slope of 1 at the centre of the image */
} view;

view view_of(const scene *s);

/* Unit direction through a point of the image. */
typedef struct sight {
    double x, y, z;
} sight;
sight view_through(const view *v, double px, double py);

/* Projection of a scene point; false behind the camera. */
bool view_place(const view *v, double x, double y, double z, double *px, double *py);
