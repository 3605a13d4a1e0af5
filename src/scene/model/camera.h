/* The camera as vectors: its position, directions, field of view and lens; and its rays. Pure.
 *
 * A perspective camera's rays pass through one point, the eye; an orthographic one's are parallel and start in the
 * plane through the eye across the viewing direction: what is behind that plane is not seen. With a thin lens in that
 * plane (Hecht, Optics, 5.2; Potmesil and Chakravarty, "A lens and aperture camera model for synthetic image
 * generation", SIGGRAPH 1981) the rays of one image point start all over the lens and meet again in the plane in focus,
 * where the chief ray, through the lens's centre, meets it. The lens of an orthographic camera is telecentric: each
 * image point has its own centre. A point at depth z is blurred to a disc whose diameter, measured in the plane in
 * focus at depth f, is A |z - f| / z in perspective, and A |z - f| / f with parallel chief rays, for an aperture A. */
#pragma once

#include "base/vec3.h"
#include "image/image.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include <stdbool.h>

/* Image plane coordinates: u is in (-half_width, half_width), v in (-half_height, half_height). In perspective they are
 * slopes (lengths at depth 1); for an orthographic camera they are lengths at any depth. */
typedef struct camera_frame {
    vec3 eye, forward, right, up;
    double half_width, half_height;
    int64_t parallel;   /* 1: orthographic */
    double lens_radius; /* scene units; 0: a pinhole */
    double focus;       /* depth of the plane in focus */
} camera_frame;

camera_frame camera_frame_of(const scene *s);

/* The frame without the camera's roll: right is horizontal. */
camera_frame camera_frame_level(const scene *s);

/* The tone mapping of the scene's images; none for the layers of integrator aov, which show no light. */
image_tone camera_tone(const scene *s);

/* Whether rays are distributed over the lens: it has a size, and a pixel has several rays. The depth buffer, layers of
 * first hits and single rays use chief rays only. */
bool camera_lens_is_sampled(const scene *s);

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

/* The unit direction of a camera ray with the slopes u and v; the only place where it is computed. */
static inline vec3 camera_toward(const camera_frame *f, double u, double v)
{
    return vec3_normalize(vec3_add(f->forward, vec3_add(vec3_scale(f->right, u), vec3_scale(f->up, v))));
}

typedef struct camera_ray {
    vec3 origin, direction; /* a unit vector */
} camera_ray;

/* The ray of the image point (u, v) through the point (x, y) of the lens, scene units from its centre. Like the chief
 * ray, it meets the plane in focus at (focus u, focus v), or at (u, v) if chief rays are parallel. */
static inline camera_ray camera_ray_through(const camera_frame *f, double u, double v, double x, double y)
{
    const double slope = f->parallel ? 0.0 : 1.0, shift = 1.0 - slope;
    const vec3 across = vec3_scale(f->right, shift * u + x), upward = vec3_scale(f->up, shift * v + y);
    return (camera_ray){vec3_add(f->eye, vec3_add(across, upward)),
                        camera_toward(f, slope * u - x / f->focus, slope * v - y / f->focus)};
}

/* The chief ray through a point of the image, in pixels from its upper left corner; only width and height of r are
 * used. */
static inline camera_ray camera_chief_ray(const camera_frame *f, const render_settings *r, double x, double y)
{
    const camera_pixel p = camera_pixel_of(f, r);
    return camera_ray_through(f, camera_u(f, p, x), camera_v(f, p, y), 0.0, 0.0);
}

/* The length in the scene of one unit of u and v at a depth in front of the camera. */
static inline double camera_spread(const camera_frame *f, double depth)
{
    return f->parallel ? 1.0 : depth;
}

/* Camera moves: orbit about the pivot, turn in place, zoom, step along the camera's axes, look from a side, frame an
 * object. Pure. The pivot of an aimed camera is its target; only turns, steps and frames move it. */

/* The point that a camera orbits about. For a camera that is aimed by angles, the caller keeps it from move to move. */
typedef struct camera_pivot {
    vec3 at;
    bool known;
} camera_pivot;

typedef struct camera_move {
    const char *frame;   /* a solid, a light or "all", which the image then shows, with the pivot at its centre */
    const char *look;    /* the side to look from: front, back, left, right or top; NULL: none. Front looks along +z */
    double orbit_deg[2]; /* orbit to the image's left, and up; without roll: yaw and pitch */
    double turn_deg[2];  /* to the image's right and up */
    double zoom;         /* factor of the distance from the pivot, or of camera.view_height; 0: none */
    double step[3];      /* right, up, forward, scene units; the pivot moves as well */
    camera_pivot pivot;  /* in: the pivot after the last move; out: after this one */
} camera_move;

/* Changes only the camera. Directions stay 0.5 degrees away from vertical, except from the top, so that the camera
 * never turns upside down. No move crosses a ground (a visible opaque plane that faces up): orbits and zooms stop
 * there, steps slide along it. */
status camera_move_apply(camera_move *m, scene *s, diagnostic *why);

/* The current pivot. known: the pivot after the last move. */
vec3 camera_pivot_of(const scene *s, camera_pivot known);
