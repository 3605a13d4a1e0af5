/* The camera as vectors: its position, directions and field of view. Pure. */
#pragma once

#include "base/vec3.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"

/* Image plane coordinates, see camera_toward: u is in (-half_width, half_width), v likewise. */
typedef struct camera_frame {
    vec3 eye, forward, right, up;
    double half_width, half_height;
} camera_frame;

camera_frame camera_frame_of(const scene *s);

/* The same without the camera's roll: right is horizontal. */
camera_frame camera_frame_level(const scene *s);

/* Conversion of pixels from the image's upper left corner to u and v: the size of one pixel. */
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

/* The unit direction of a camera ray; the only place where it is computed. */
static inline vec3 camera_toward(const camera_frame *f, double u, double v)
{
    return vec3_normalize(vec3_add(f->forward, vec3_add(vec3_scale(f->right, u), vec3_scale(f->up, v))));
}

/* The same through a point of the image, in pixels from its upper left corner; only width and height of r are used. */
static inline vec3 camera_direction(const camera_frame *f, const render_settings *r, double x, double y)
{
    const camera_pixel p = camera_pixel_of(f, r);
    return camera_toward(f, camera_u(f, p, x), camera_v(f, p, y));
}
