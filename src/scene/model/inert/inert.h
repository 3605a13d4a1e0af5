/* Detects parameters without effect in a scene, with the reason and a setting under which they have one. A condition is
 * computed from the scene and from what the renderer uses, so that no value of the parameter changes the film while it
 * holds; if that is uncertain there is no note: a false note is worse than none. Pure; ownership: values. */
#pragma once

#include "base/counters.h"
#include "scene/model/inert/note.h"
#include "scene/model/open.h"
#include <stdbool.h>

typedef struct inert_answer {
    const char *rule; /* a word for the condition, constant text */
    scene_note note; /* its place is the path; if a value gives the parameter an effect, the remedy has it as PATH=VALUE
                        */
} inert_answer;

/* Access to what a frame of the scene shows, for conditions that the scene file cannot decide: a renderer. Both
 * functions are optional. */
typedef struct inert_witness {
    const ray_counters *frame; /* of a frame of this scene */
    bool (*same)(void *context,
                 const char *assignment); /* whether the film is unchanged by this PATH=VALUE; false if uncertain */
    void *context;
} inert_witness;

/* Whether the parameter has no effect. witness may be NULL. False also for an invalid path. */
bool inert_ask(const scene *s, const char *path, const inert_witness *witness, inert_answer *out);
