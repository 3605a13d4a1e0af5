/* What the laboratory's files share: not for others. */
#pragma once

#include "base/vec3.h"
#include "web/session/scene_document.h"
#include "web/session/folder.h"
#include "web/session/semaphore.h"
#include "web/http/http.h"
#include "web/lab.h"
#include "web/live/render_worker.h"
#include <pthread.h>

typedef struct reference_image reference_image; /* web/session/reference_image.h */
typedef struct studies studies;                 /* web/session/studies.h */

struct lab {
    lab_settings settings;
    folder *files;
    struct scene_document *scene_document;
    struct render_worker *render_worker;
    struct reference_image *reference_image;
    struct studies *studies;
    semaphore *heavy; /* for handlers that take much memory and time */
    http_server *server;
    http_route *routes;
    struct api_bound *bound;   /* their contexts */
    pthread_mutex_t tell_lock; /* held while the state is looked at and sent: what comes last is the newest; goes before
                                  all others */
    pthread_mutex_t publish_lock;
    bool open; /* events may be published */
};

/* Sends an event to all pages; takes value. From any thread, at any time. */
void lab_publish(lab *l, const char *event, json_t *value);

/* Sends the state to all pages. */
void lab_tell_state(lab *l);
json_t *lab_state(lab *l);

/* Scenes that are opened and do not say how many threads they want get the settings'. */
void lab_give_threads(const lab *l, scene *s);
/* As many as those are not the scene's own wish, and belong to this machine alone: files do without. */
void lab_forget_threads(const lab *l, scene *s);

/* The ray through a place of the full picture, in pixels, of the scene's camera. direction is a unit vector. */
void lab_camera_ray(const scene *s, double x, double y, vec3 *origin, vec3 *direction);
