/* Camera moves: orbit about the target, turn in place, step along the camera's axes. Pure. */
#pragma once

#include "scene/model/open.h"

typedef struct camera_move {
    double orbit_deg[2]; /* the camera moves to the image's left and turns to the right; and up. Without roll: yaw and
                            pitch */
    double turn_deg[2];  /* to the image's right and up */
    double step[3];      /* right, up, forward, scene units; the target moves as well */
} camera_move;

/* A scene_document_change; of is a camera_move. Directions stay 0.5 degrees away from vertical, so that the camera
 * never turns upside down. */
status camera_move_apply(void *of, scene *s, diagnostic *why);
