/* Where the camera stands and looks, as vectors. Pure. */
#pragma once

#include "base/vec3.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"

/* See camera_toward: u is in (-half_width, half_width), v likewise. */
typedef struct camera_frame {
    vec3 eye, forward, right, up;
    double half_width, half_height;
} camera_frame;

camera_frame camera_frame_of(const scene *s);

/* The same without the camera's roll: right is level. */
camera_frame camera_frame_level(const scene *s);

/* How pixels from the picture's upper left corner are u and v: this much of them one pixel is. */
typedef struct camera_pixel {
    double across, down;
} camera_pixel;

static inline camera_pixel camera_pixel_of(const camera_frame *f, const render_settings *r)
{
    return (camera_pixel){2.0 * f->half_width / (double)r->width, 2.0 * f->half_height / (double)r->height};
}

static inline double camera_u(const camera_frame *f, camera_pixel p, double x)
{
    return x * p.across - f->half_width;
}

static inline double camera_v(const camera_frame *f, camera_pixel p, double y)
{
    return f->half_height - y * p.down;
}

/* The camera ray's unit direction: the one place where it is computed. */
static inline vec3 camera_toward(const camera_frame *f, double u, double v)
{
    return vec3_normalize(vec3_add(f->forward, vec3_add(vec3_scale(f->right, u), vec3_scale(f->up, v))));
}

/* The same through a point of the picture, in pixels from its upper left corner; of r the width and height
 * count. */
static inline vec3 camera_direction(const camera_frame *f, const render_settings *r, double x, double y)
{
    const camera_pixel p = camera_pixel_of(f, r);
    return camera_toward(f, camera_u(f, p, x), camera_v(f, p, y));
}
