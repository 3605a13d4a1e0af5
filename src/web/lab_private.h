/* Declarations shared by the files of the laboratory; private to them. */
#pragma once

#include "base/vec3.h"
#include "web/session/scene_document.h"
#include "web/session/folder.h"
#include "web/session/semaphore.h"
#include "web/http/http.h"
#include "web/lab.h"
#include "web/live/render_worker.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>

typedef struct reference_image reference_image; /* web/session/reference_image.h */
typedef struct studies studies;                 /* web/session/studies.h */
typedef struct videos videos;                   /* web/session/videos.h */

struct lab {
    lab_settings settings;
    folder *files;
    struct scene_document *scene_document;
    struct render_worker *render_worker;
    struct reference_image *reference_image;
    struct studies *studies;
    struct videos *videos;
    struct sent_scenes *sent;      /* web/api/scene_since.h */
    struct pixel_maps *pixel_maps; /* web/session/pixel_maps.h */
    struct thumbnails *thumbnails; /* web/session/thumbnails.h */
    atomic_uint motion_stops;      /* requests to stop /api/motion */
    struct rescue *rescue;         /* web/session/rescue.h */
    semaphore *heavy;              /* limits the handlers that need much memory and time */
    http_server *server;
    http_route *routes;
    struct api_bound *bound; /* contexts of the routes */
    /* Held while the state is read and sent, so that the last event holds the newest state; acquired before all other
     * locks. */
    pthread_mutex_t state_lock;
    pthread_mutex_t publish_lock;
    char *temporary;    /* the laboratory's own folder for temporary files; NULL: the system's */
    int temporary_lock; /* its descriptor: a folder that nobody has locked is removed by the next laboratory */
    bool open;          /* events may be published */
    bool left;          /* the unsaved scene stays on disk at the stop */
};

/* Gives up, for the calling thread and all that it starts, the access to files that the laboratory does not need
 * (base/os_confine.h), and makes its folder for temporary files. Where that is not possible, nothing changes.
 * STATUS_FAILURE when out of memory. */
status lab_confine(lab *l, diagnostic *why);
/* Removes that folder, and an empty one for unsaved scenes. */
void lab_remove_temporary(lab *l);
/* The folder for temporary files, and a file in it without a name; NULL with errno. */
const char *lab_temporary_folder(const lab *l);
FILE *lab_temporary_file(const lab *l);

/* Sends an event to all pages; takes the reference to value. Thread-safe. */
void lab_publish(lab *l, const char *event, json_t *value);

/* Sends the state to all pages. */
void lab_publish_state(lab *l);
json_t *lab_state(lab *l);

/* Whether a file would be listed among the scenes: other files that hold a scene are not saved into. */
bool lab_is_scene_name(const char *name);

/* Sets the default number of threads in an opened scene that sets none. */
void lab_set_default_threads(const lab *l, scene *s);
/* Resets render.threads where it equals that default: the default belongs to this machine, so files do not store it. */
void lab_clear_default_threads(const lab *l, scene *s);

/* The camera ray through the point (x, y) of the full image, in pixels. direction is a unit vector. */
void lab_camera_ray(const scene *s, double x, double y, vec3 *origin, vec3 *direction);
