/* For all parts of a laboratory: the struct that holds them, the events for pages, and helpers for scenes. Private to
 * the laboratory. web/lab.c starts and stops the parts; each knows only those before it: the folder and the document
 * (web/document), the render worker (web/live), the tasks (web/session), the handlers of requests (web/api). */
#pragma once

#include "base/vec3.h"
#include "web/document/folder.h"
#include "web/document/scene_document.h"
#include "web/http/http.h"
#include "web/live/render_worker.h"
#include "web/session/settings.h"
#include "web/session/tasks.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>

typedef struct studies studies; /* web/session/studies.h */
typedef struct videos videos;   /* web/session/videos.h */

struct lab {
    lab_settings settings;
    folder *files;
    struct scene_document *scene_document;
    struct render_worker *render_worker;
    struct reference_image *reference_image;
    struct studies *studies;
    struct videos *videos;
    struct sent_scenes *sent;      /* web/api/api.h */
    struct pixel_maps *pixel_maps; /* web/live/images.h */
    struct thumbnails *thumbnails; /* web/live/images.h */
    atomic_uint motion_stops;      /* number of requests to stop /api/motion */
    struct rescue *rescue;         /* web/session/rescue.h */
    semaphore *heavy;              /* limits the handlers that need much memory and time */
    http_server *server;
    http_route *routes;
    struct api_bound *bound; /* contexts of the routes */
    /* Held while the state is read and sent, so that the last event holds the newest state; acquired before all other
     * locks. */
    pthread_mutex_t state_lock;
    pthread_mutex_t publish_lock;
    char *temporary;          /* the laboratory's own folder for temporary files; NULL: the system's */
    int temporary_lock;       /* its locked descriptor: the next laboratory removes folders that are not locked */
    json_t *(*state)(lab *l); /* the state of all parts for pages; NULL when out of memory */
    bool open;                /* events may be published */
    bool leaves_unsaved;      /* the unsaved scene stays on disk at the stop */
};

/* Confines the calling thread, and all threads and programs that it starts, to the files that the laboratory needs
 * (base/os_confine.h), and makes its folder for temporary files. If the system cannot confine, nothing changes.
 * STATUS_FAILURE when out of memory. */
status lab_confine(lab *l, diagnostic *why);
/* Removes the folder for temporary files, and the folder for unsaved scenes if it is empty. */
void lab_remove_temporary(lab *l);
/* The folder for temporary files, and a file in it without a name; NULL with errno. */
const char *lab_temporary_folder(const lab *l);
FILE *lab_temporary_file(const lab *l);

/* Sends an event to all pages; owns value. Thread-safe. */
void lab_publish(lab *l, const char *event, json_t *value);

/* Sends the state to all pages. */
void lab_publish_state(lab *l);
/* Whether events may be published. */
bool lab_is_open(lab *l);

/* Whether the name is that of a scene file. Scenes are not saved into other files, such as images that hold one. */
bool lab_is_scene_name(const char *name);

/* Sets the default number of threads in an opened scene that sets none. */
void lab_set_default_threads(const lab *l, scene *s);
/* Resets render.threads if it equals that default: the default belongs to this machine, so files do not store it. */
void lab_clear_default_threads(const lab *l, scene *s);

/* The camera ray through the point (x, y) of the full image, in pixels. direction is a unit vector. */
void lab_camera_ray(const scene *s, double x, double y, vec3 *origin, vec3 *direction);
