/* The views of a document: where the camera was, to go back and forward, apart from the undo history of the scene. A
 * view is the whole camera and its pivot. Plain values; not thread-safe; cannot fail. */
#pragma once

#include "scene/model/camera_moves.h"
#include "scene/model/view_settings.h"
#include <stddef.h>

enum { VIEWS_MAX = 100 };

typedef struct camera_view {
    struct camera camera;
    camera_pivot pivot;
} camera_view;

typedef struct view_stack {
    camera_view item[VIEWS_MAX];
    size_t count;
} view_stack;

typedef struct view_history {
    view_stack back, forward;
    char gesture[80]; /* of the last move; "" for none */
} view_history;

bool camera_equal(const struct camera *a, const struct camera *b);

/* Records the view before a move. Consecutive moves with the same gesture are one entry; NULL: an entry of its own. */
void view_history_push(view_history *h, const camera_view *before, const char *gesture);
/* Replaces the current view by the one before (or after) it; false if there is none. */
bool view_history_go(view_history *h, bool forward, camera_view *now);
void view_history_clear(view_history *h);
