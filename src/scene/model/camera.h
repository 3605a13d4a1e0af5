/* Where the camera stands and looks, as vectors. Pure. */
#ifndef CUVETTE_SCENE_MODEL_CAMERA_H
#define CUVETTE_SCENE_MODEL_CAMERA_H

#include "base/vec3.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"

/* Directions of camera rays: forward + u right + v up, for u in (-half_width, half_width), v likewise. */
typedef struct camera_frame {
    vec3 eye, forward, right, up;
    double half_width, half_height;
} camera_frame;

camera_frame camera_frame_of(const scene *s);

/* The same without the camera's roll: right is level. */
camera_frame camera_frame_level(const scene *s);

/* The unit direction of the ray through a point of the picture, in pixels from its upper left corner; picture: whose
 * width and height count. */
vec3 camera_direction(const camera_frame *f, const render_settings *picture, double x, double y);

#endif
