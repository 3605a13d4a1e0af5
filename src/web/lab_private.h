/* What the laboratory's files share: not for others. Handlers have the lab as their context. */
#ifndef CUVETTE_WEB_LAB_PRIVATE_H
#define CUVETTE_WEB_LAB_PRIVATE_H

#include "base/vec3.h"
#include "web/session/desk.h"
#include "web/session/folder.h"
#include "web/session/gate.h"
#include "web/http/http.h"
#include "web/lab.h"
#include "web/live/painter.h"
#include <pthread.h>
#include <stdint.h>

typedef struct pins pins;       /* web/session/pins.h */
typedef struct studies studies; /* web/session/studies.h */

struct lab {
    lab_settings settings;
    folder *files;
    struct desk *desk;
    struct painter *painter;
    struct pins *pins;
    struct studies *studies;
    gate *heavy; /* for handlers that take much memory and time */
    http_server *server;
    http_route *routes;
    pthread_mutex_t tell_lock; /* held while the state is looked at and sent: what comes last is the newest; goes before
                                  all others */
    pthread_mutex_t publish_lock;
    bool open; /* events may be published */
};

/* One table for each api_*.c; context is filled in by lab.c. */
typedef struct lab_routes {
    const http_route *routes;
    size_t count;
} lab_routes;
extern const lab_routes desk_routes, picture_routes, trace_routes, compare_routes, edit_routes, file_routes,
    slime_routes, study_routes, note_routes;

/* Sends an event to all pages; takes value. From any thread, at any time. */
void lab_publish(lab *l, const char *event, json_t *value);

/* Sends the state to all pages. */
void lab_tell_state(lab *l);
json_t *lab_state(lab *l);

/* Scenes that are opened and do not say how many threads they want get the settings'. */
void lab_give_threads(const lab *l, scene *s);
/* As many as those are not the scene's own wish, and belong to this machine alone: files do without. */
void lab_forget_threads(const lab *l, scene *s);

/* {"generation": N}, or the diagnostic. */
void lab_reply_generation(http_reply *r, status code, uint64_t generation, const diagnostic *why);

/* Numbers and words of a body. Each is false, with the reply set to 400, where the key is of another kind; a missing
 * one is an error only where needed. value is left alone where it is missing. */
bool lab_take_number(const json_t *body, const char *key, bool needed, double *value, http_reply *r);
bool lab_take_vector(const json_t *body, const char *key, bool needed, double value[3], http_reply *r);
bool lab_take_text(const json_t *body, const char *key, bool needed, const char **value, http_reply *r);
bool lab_take_flag(const json_t *body, const char *key, bool *value, http_reply *r);
/* The gesture; NULL for none. */
bool lab_take_gesture(const json_t *body, const char **gesture, http_reply *r);

/* The ray through a place of the full picture, in pixels, of the scene's camera. direction is a unit vector. */
void lab_camera_ray(const scene *s, double x, double y, vec3 *origin, vec3 *direction);

#endif
