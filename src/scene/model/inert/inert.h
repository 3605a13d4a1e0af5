/* Can a parameter act in a scene as it stands? If not, a note says why, and what to set so that it does. A condition is
 * computed from what the scene says and what the renderer does with it, so that no value of the parameter changes the
 * film while it holds; where that cannot be known, nothing is said: a note that is false is worse than none. Pure;
 * ownership: values. */
#pragma once

#include "base/counters.h"
#include "scene/model/inert/note.h"
#include "scene/model/open.h"
#include <stdbool.h>

typedef struct inert_answer {
    const char *rule; /* a word for the condition, constant text */
    scene_note note; /* its place is the path; where a value makes the parameter act, the remedy has it as PATH=VALUE */
} inert_answer;

/* Who can tell what a frame of the scene shows, for conditions that its file does not hold: a renderer. Both are
 * optional. */
typedef struct inert_witness {
    const ray_counters *frame; /* of a frame of this scene */
    bool (*same)(void *context,
                 const char *assignment); /* does the film stay as it is with this PATH=VALUE? False when unsure */
    void *context;
} inert_witness;

/* Is the parameter without effect? witness may be NULL. False also for a path that leads nowhere. */
bool inert_ask(const scene *s, const char *path, const inert_witness *witness, inert_answer *out);
