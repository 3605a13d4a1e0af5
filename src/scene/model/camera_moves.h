/* How a person moves the camera: around what it looks at, on the spot, along its own axes. Pure. */
#pragma once

#include "scene/model/open.h"

typedef struct camera_move {
    double orbit_deg[2]; /* the camera goes to the image's left and looks further to the right; it goes up. Without
                            roll: yaw and pitch */
    double turn_deg[2];  /* to the image's right, and up */
    double step[3];      /* right, up, forward, scene units; what is looked at moves with it */
} camera_move;

/* A scene_document_change; of is a camera_move. The camera never stands on its head: directions stay 0.5 degrees from
 * straight up and down. */
status camera_move_apply(void *of, scene *s, diagnostic *why);
