/* The render worker: renders the scene document in a thread, in passes from coarse to fine; a change
 * interrupts the current pass. It also simulates the live slime (web/live/live.h). The newest image is shared with
 * all threads (web/live/images.h). Ownership: render_worker_create creates, render_worker_end joins,
 * render_worker_destroy releases. */
#pragma once

#include "base/isa.h"
#include "web/document/scene_document.h"
#include "web/live/images.h"
#include "web/live/live.h"

#include <stdint.h>

typedef struct render_worker render_worker;

/* published: called after each pass without the document's and the worker's locks; the image is borrowed.
 * state_changed: called when the result of render_worker_json changes. */
typedef struct render_worker_listener {
    void (*published)(void *context, const shared_image *img);
    void (*state_changed)(void *context);
    void *context;
} render_worker_listener;

status render_worker_create(scene_document *d, isa level, const render_worker_listener *listener, render_worker **out,
                            diagnostic *why);
/* Ends the thread. Waiting and later requests return STATUS_INTERRUPTED. */
void render_worker_end(render_worker *worker);
/* Call it after render_worker_end, when no thread calls the worker any more. NULL is allowed. */
void render_worker_destroy(render_worker *worker);

/* Reports a change of the scene document or the live slime. Thread-safe; returns at once. */
void render_worker_wake(render_worker *worker);

/* Suspends rendering while text is not NULL (the reason, for people; copied). Returns when nothing is being rendered
 * any more. */
void render_worker_suspend(render_worker *worker, const char *text);

/* A new reference to the newest image; NULL before the first. */
const shared_image *render_worker_newest(render_worker *worker);
/* The final image of the document's current generation or a newer one. Waits at most limit_s. NULL and *why if the
 * scene cannot be rendered (STATUS_BAD_INPUT, or STATUS_FAILURE for a lack of memory or open files), after the time
 * limit, or while the worker is suspended (STATUS_INTERRUPTED). */
status render_worker_wait_for_final(render_worker *worker, double limit_s, const shared_image **out, diagnostic *why);
/* Adds trouble, waiting, image and camera; false when out of memory. */
bool render_worker_json(render_worker *worker, json_t *state);

/* The live slime of the render worker, for web/api/api_slime.c. */
live *render_worker_live(render_worker *worker);

/* Calls act, for queries with rays, with the loaded scene that is displayed, including the live slime; nothing moves or
 * replaces the scene meanwhile. */
status render_worker_with_scene(render_worker *worker, status (*act)(void *context, scene *s, diagnostic *why),
                                void *context, diagnostic *why);
