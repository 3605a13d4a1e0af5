/* The scene document's versions and views, shared by its two files: scene_document.c and scene_document_changes.c.
 * Private to them. */
#pragma once

#include "scene/model/camera.h"
#include "scene/model/view_settings.h"
#include "web/document/scene_document.h"

#include <pthread.h>
#include <stddef.h>

/* The history of views, separate from the undo history of the scene. A view is a camera and its pivot. */
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

/* A scene as it was opened, shared by all versions derived from it. Guarded by the document's lock. */
typedef struct origin {
    scene *s;
    uint64_t number; /* the version's */
    bool unfiled;    /* perhaps no file has the opened version: it was rescued, or its file was saved with changes */
    int references;
} origin;

/* One version of the document. Undo versions hold no loaded data: a hundred undo steps must not hold a hundred
 * meshes. */
typedef struct version {
    scene *s;
    char *file;      /* NULL: no file */
    char *what;      /* the change made to it, for undo; in the redo stack: the change that led to it */
    uint64_t number; /* of the version; undo restores it */
    origin *from;
    struct camera saved_camera; /* the scene's own, which files have; the camera of s is the view */
} version;

typedef struct version_stack {
    version item[DOCUMENT_UNDO_MAX];
    size_t count;
} version_stack;

struct scene_document {
    pthread_mutex_t lock;
    const folder *files;
    void (*changed)(void *context);
    void *context;
    version now;
    uint64_t generation, last_number, saved_number;
    char gesture[80]; /* of the last change; "" for none */
    version_stack undo, redo;
    camera_pivot pivot; /* of the view */
    view_history views;
};

bool camera_equal(const struct camera *a, const struct camera *b);

/* Replaces the current view by the one before (or after) it; false if there is none. */
bool view_history_go(view_history *h, bool forward, camera_view *now);

/* Sets the view, and records the previous view unless it is equal. Consecutive moves with the same gesture are one
 * entry; a move without a gesture (NULL) is always a new entry. The caller holds the lock. */
void scene_document_put_view(scene_document *d, const camera_view *next, const char *gesture);
camera_view scene_document_view_now(const scene_document *d);

/* Replaces the scene by next, which the document owns from now on, and pushes the old one on the undo stack, or
 * drops it if the same gesture made it. from: the new origin of an opened scene, owned from now on; NULL: the
 * origin stays. saved_camera: the scene's own camera from now on. The caller holds the lock. */
status scene_document_push(scene_document *d, scene *next, const char *file, origin *from,
                           const struct camera *saved_camera, const char *what, const char *gesture, diagnostic *why);

/* Ends every change: returns the generation to the caller, unlocks and calls changed. */
status scene_document_finish(scene_document *d, status code, uint64_t *generation);
