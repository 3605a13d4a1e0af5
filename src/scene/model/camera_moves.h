/* Camera moves: orbit about the pivot, turn in place, zoom, step along the camera's axes, look from a side, frame an
 * object. Pure. The pivot of an aimed camera is its target; only turns, steps and frames move it. */
#pragma once

#include "base/vec3.h"
#include "scene/model/open.h"
#include <stdbool.h>

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
