/* What a page's copy of the scene lacks, for GET /api/scene?since=GENERATION. Ownership: create creates, destroy
 * releases. Threads: sent_scenes_reply is thread-safe. Errors: NULL when out of memory. */
#pragma once

#include <jansson.h>

typedef struct sent_scenes sent_scenes;

sent_scenes *sent_scenes_create(void);
void sent_scenes_destroy(sent_scenes *s); /* NULL is allowed */

/* The reply as allocated text: the scene (as scene_json makes it, which is taken over), or only what differs from the
 * generation `since`, if that was sent lately; -1 for none. */
char *sent_scenes_reply(sent_scenes *s, json_t *scene, long long since);
