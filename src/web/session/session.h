/* For all parts of a laboratory: the struct that holds them, the events for pages, and helpers for scenes. Private to
 * the laboratory. web/lab.c starts and stops the parts; each knows only those before it: the folder and the document
 * (web/document), the render worker (web/live), the tasks (web/session), the handlers of requests (web/api). */
#pragma once

#include "base/isa.h"
#include "base/status.h"
#include "base/vec3.h"
#include "web/document/folder.h"
#include "web/document/scene_document.h"
#include "web/http/http.h"
#include "web/live/render_worker.h"
#include "web/session/tasks.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>

/* The settings of a laboratory: see web/lab.h. */

typedef struct lab lab;

typedef struct lab_settings {
    const char *folder; /* pages can read and write files only in it */
    /* Scene file to open, relative to the working directory and below folder; NULL: a room with a floor, a light and a
     * camera. */
    const char *scene;
    /* Folder that keeps the unsaved scene while it is unsaved (struct rescue), created when it is needed (with
     * confine at the start, and removed at the stop if it is empty); "": there is no such folder, which pages report;
     * NULL: nothing is kept or offered. */
    const char *rescue;
    const char *results; /* folder for the rows of studies: folder itself or below it; it need not exist */
    int port;            /* 0: any free port */
    isa level;
    int threads;           /* default of render.threads for opened scenes; 0: keep the scene's value */
    double requests_per_s; /* 0: the default of web/http/http.h */
    /* Origins whose pages may show this laboratory in a frame (web/http/http.h). */
    const char *const *frame_origins;
    size_t frame_origin_count;
    /* Confine the laboratory's threads, and the programs that they start, to these folders and the system's files, in
     * addition to the laboratory's own checks, where the kernel has Landlock. The caller's threads are not confined. */
    bool confine;
} lab_settings;

typedef struct studies studies; /* web/session/studies.h */

struct lab {
    lab_settings settings;
    folder *files;
    struct scene_document *scene_document;
    struct render_worker *render_worker;
    struct reference_image *reference_image;
    struct studies *studies;
    struct sent_scenes *sent;      /* web/api/api.h */
    struct pixel_maps *pixel_maps; /* web/live/images.h */
    struct thumbnails *thumbnails; /* web/live/images.h */
    atomic_uint motion_stops;      /* number of requests to stop /api/motion */
    struct rescue *rescue;         /* web/session/session.h */
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
 * (base/os_process.h), and makes its folder for temporary files. If the system cannot confine, nothing changes.
 * STATUS_FAILURE when out of memory. */
status lab_confine(lab *l, diagnostic *why);
/* Removes the folder for temporary files, and the folder for unsaved scenes if it is empty. */
void lab_remove_temporary(lab *l);
/* The folder for temporary files. */
const char *lab_temporary_folder(const lab *l);

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

/* Keeps the unsaved scene on disk, and offers scenes of laboratories that died. A thread writes the document's own
 * scene while no file has it: at the first change, then at most once a second, and not while a study runs, which it
 * would disturb. The file is removed when the scene is saved. If the disk cannot be written, the state reports it
 * and all else continues. Thread-safe. Ownership: rescue_create creates, rescue_destroy releases. Errors:
 * STATUS_BAD_INPUT for unknown scenes and those that cannot be opened. */

typedef struct rescue rescue;

/* Claims the scenes without an owner in the settings' folder. Call it when the document and the studies exist. */
status rescue_create(lab *l, rescue **out, diagnostic *why);
/* Call it after http_stop. leave: an unsaved scene stays on disk; otherwise it is removed. Scenes that were offered
 * stay. NULL is allowed. */
void rescue_destroy(rescue *r, bool leave);

/* The document has changed, or a study has ended. NULL is allowed. */
void rescue_wake(rescue *r);

/* Opens an offered scene, which is a change of the document; its file stays until the thread has written the
 * document. discard removes the file. The state is published. */
status rescue_open(rescue *r, const char *id, uint64_t *generation, diagnostic *why);
status rescue_discard(rescue *r, const char *id, diagnostic *why);

/* Adds rescued (the offers) and unkept (why changes cannot be kept); false when out of memory. */
bool rescue_json(rescue *r, json_t *state);
