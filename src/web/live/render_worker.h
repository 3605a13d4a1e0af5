/* The painter renders what is on the desk, in a thread of its own, in passes from coarse to fine; a change ends the
 * pass that is on its way. It also moves the slime while that is live (web/live/live.h). One picture, the newest, is
 * there for all. Ownership: render_worker_create gives, render_worker_end joins, render_worker_destroy releases.
 * Pictures are shared and never change: shared_image_retain and shared_image_release count their owners. */
#pragma once

#include "base/isa.h"
#include "image/image.h"
#include "web/session/scene_document.h"
#include "web/live/live.h"
#include <stdint.h>

typedef struct render_worker render_worker;

typedef struct shared_image {
    uint64_t generation;
    uint64_t serial;   /* one more for each picture, whatever it shows */
    int pass, passes;  /* from 1 */
    bool final;        /* the film that the scene makes */
    int width, height; /* of this pass */
    int full_width, full_height;
    const json_t *numbers; /* report_page's */
    uint64_t film_hash;    /* of the final one */
    const image *linear;
    const scene *of; /* final: the scene that it shows; else NULL */
} shared_image;

/* published: called after each pass with the desk and painter unlocked; the picture is borrowed. told: whenever
 * render_worker_json would say something else. */
typedef struct render_worker_listener {
    void (*published)(void *context, const shared_image *p);
    void (*told)(void *context);
    void *context;
} render_worker_listener;

status render_worker_create(scene_document *d, isa level, const render_worker_listener *listener, render_worker **out,
                            diagnostic *why);
/* Ends the thread and all waiting for it; what is asked from then on is answered with STATUS_INTERRUPTED. */
void render_worker_end(render_worker *p);
/* After render_worker_end, when nobody asks any more. NULL is allowed. */
void render_worker_destroy(render_worker *p);

/* Something changed on the desk or in the live slime: look. From any thread, returns at once. */
void render_worker_wake(render_worker *p);

/* Renders nothing while text is not NULL (why, for people; copied). Returns when nothing is being rendered any more. */
void render_worker_suspend(render_worker *p, const char *text);

/* The newest picture, kept for the caller; NULL before the first. */
const shared_image *render_worker_take(render_worker *p);
/* The final one of the generation that is on the desk now, or of a newer one. Waits for at most limit_s. NULL and *why
 * where it cannot be rendered (STATUS_BAD_INPUT), where the time is out or the painter waits (STATUS_INTERRUPTED). */
status render_worker_take_final(render_worker *p, double limit_s, const shared_image **out, diagnostic *why);
void shared_image_retain(const shared_image *p);
void shared_image_release(const shared_image *p); /* NULL is allowed */

/* The picture as a PNG of 8 bits, made once for all who ask; the bytes are the picture's. */
status shared_image_png(const shared_image *p, const unsigned char **bytes, size_t *size, diagnostic *why);

/* The picture as it is described in web/README.md; NULL when memory is out. */
json_t *shared_image_json(const shared_image *p);

/* Adds trouble, waiting, picture, camera; false when memory is out. */
bool render_worker_json(render_worker *p, json_t *state);

/* The live slime of the painter, for web/api/api_slime.c. */
live *render_worker_live(render_worker *p);

/* Calls look with the scene as it is shown now, slime included, while nothing moves or renders it; for traces. loaded
 * as far as that went. */
status render_worker_with_scene(render_worker *p, status (*look)(void *context, scene *s, diagnostic *why),
                                void *context, diagnostic *why);
