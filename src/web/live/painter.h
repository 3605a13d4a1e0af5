/* The painter renders what is on the desk, in a thread of its own, in passes from coarse to fine; a change ends the
 * pass that is on its way. It also moves the slime while that is live (web/live/live.h). One picture, the newest, is
 * there for all. Ownership: painter_create gives, painter_end joins, painter_destroy releases. Pictures are shared and
 * never change: picture_keep and picture_release count their owners. */
#pragma once

#include "base/isa.h"
#include "image/image.h"
#include "web/session/desk.h"
#include "web/live/live.h"
#include <stdint.h>

typedef struct painter painter;

typedef struct picture {
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
} picture;

/* published: called after each pass with the desk and painter unlocked; the picture is borrowed. told: whenever
 * painter_tell would say something else. */
typedef struct painter_listener {
    void (*published)(void *context, const picture *p);
    void (*told)(void *context);
    void *context;
} painter_listener;

status painter_create(desk *d, isa level, const painter_listener *listener, painter **out, diagnostic *why);
/* Ends the thread and all waiting for it; what is asked from then on is answered with STATUS_INTERRUPTED. */
void painter_end(painter *p);
/* After painter_end, when nobody asks any more. NULL is allowed. */
void painter_destroy(painter *p);

/* Something changed on the desk or in the live slime: look. From any thread, returns at once. */
void painter_wake(painter *p);

/* Renders nothing while text is not NULL (why, for people; copied). Returns when nothing is being rendered any more. */
void painter_wait(painter *p, const char *text);

/* The newest picture, kept for the caller; NULL before the first. */
const picture *painter_take(painter *p);
/* The final one of the generation that is on the desk now, or of a newer one. Waits for at most limit_s. NULL and *why
 * where it cannot be rendered (STATUS_BAD_INPUT), where the time is out or the painter waits (STATUS_INTERRUPTED). */
status painter_take_final(painter *p, double limit_s, const picture **out, diagnostic *why);
void picture_keep(const picture *p);
void picture_release(const picture *p); /* NULL is allowed */

/* The picture as a PNG of 8 bits, made once for all who ask; the bytes are the picture's. */
status picture_png(const picture *p, const unsigned char **bytes, size_t *size, diagnostic *why);

/* The picture as it is described in web/README.md; NULL when memory is out. */
json_t *picture_json(const picture *p);

/* Adds trouble, waiting, picture, camera; false when memory is out. */
bool painter_tell(painter *p, json_t *state);

/* The live slime of the painter, for web/api/api_slime.c. */
live *painter_live(painter *p);

/* Calls look with the scene as it is shown now, slime included, while nothing moves or renders it; for traces. loaded
 * as far as that went. */
status painter_with_scene(painter *p, status (*look)(void *context, scene *s, diagnostic *why), void *context,
                          diagnostic *why);
