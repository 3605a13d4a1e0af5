/* Thumbnails of scenes: small images, rendered when they are first requested and kept in memory. Thread-safe.
 * Ownership: thumbnails_create creates, thumbnails_destroy releases, when no thread calls it any more. */
#pragma once

#include "base/isa.h"
#include "scene/model/open.h"

typedef struct thumbnails thumbnails;

thumbnails *thumbnails_create(isa level); /* NULL when out of memory */
void thumbnails_destroy(thumbnails *t);   /* NULL is allowed */
/* Ends a render; later requests return STATUS_INTERRUPTED. */
void thumbnails_end(thumbnails *t);

/* The JPEG kept for a key, in fresh memory; *bytes is NULL if there is none. */
status thumbnails_find(thumbnails *t, const char *key, unsigned char **bytes, size_t *size, diagnostic *why);
/* Renders the scene, whose image settings are changed and whose files are loaded, and keeps it. STATUS_FAILURE if it
 * takes longer than some seconds. */
status thumbnails_render(thumbnails *t, const char *key, scene *s, unsigned char **bytes, size_t *size,
                         diagnostic *why);
