/* The linter: notes on a valid scene, parts of which have no effect or not the one that its author expects.
 *
 * A note has a place, one sentence and a remedy. Three things make notes:
 * - inert_ask: one parameter has no effect, and what it needs. From the scene, in microseconds: for each --set,
 *   each change in the page, each axis of a study. What only an image shows, a witness decides, if there is one.
 * - scene_hints and its relatives: what a scene seems to lack.
 * - lint_scene: the hints, and what lines through the solids and a small image show.
 *
 * If the answer is uncertain there is no note: a false note is worse than none. Pure: later frames are not affected,
 * neither film nor counters. Ownership: the scene is borrowed; a note is a value, valid during the call that passes it.
 */
#pragma once

#include "base/isa.h"
#include "scene/model/material.h"
#include "scene/model/open.h"
#include <stdbool.h>
#include <stddef.h>

/* --- notes --- */

enum { NOTE_PLACE_MAX = 2 * SCENE_NAME_MAX, NOTE_TEXT_MAX = 256, NOTE_LINE_MAX = 768 };

typedef struct scene_note {
    char place[NOTE_PLACE_MAX]; /* a parameter's path as --set takes it ("water.ior"), or an object's name */
    char text[NOTE_TEXT_MAX];   /* the observation, no full stop */
    char remedy[NOTE_TEXT_MAX]; /* the remedy, no full stop; "" for none */
} scene_note;

/* A callback for notes; each note is borrowed for the call. */
typedef void note_call(void *context, const scene_note *note);
typedef struct note_taker {
    note_call *take;
    void *context;
} note_taker;

/* Passes a note to the callback. Its place is object.parameter, or whichever of them is not NULL. */
void note_report(const note_taker *taker, const char *object, const char *parameter, const char *remedy,
                 const char *text, ...) __attribute__((format(printf, 5, 6)));

/* Writes "place: text; remedy" (missing parts are omitted) to line, at most NOTE_LINE_MAX; returns line. */
char *note_line(const scene_note *note, char *line, size_t size);

struct ray_counters; /* base/counters.h */

/* --- parameters without effect --- */

struct param;        /* scene/model/params.h */
struct ray_counters; /* base/counters.h */

typedef struct inert_answer {
    const char *rule; /* a word for the condition, constant text */
    scene_note note; /* its place is the path; if a value gives the parameter an effect, the remedy has it as PATH=VALUE
                       */
} inert_answer;

/* Access to what a frame of the scene shows, for conditions that the scene file cannot decide: a renderer. Both
 * functions are optional. */
typedef struct inert_witness {
    const struct ray_counters *frame; /* of a frame of this scene */
    bool (*same)(void *context,
                 const char *assignment); /* whether the film is unchanged by this PATH=VALUE; false if uncertain */
    void *context;
} inert_witness;

/* Whether the parameter has no effect: no value of it changes the film while the condition holds. witness may be NULL.
 * False also for an invalid path. */
bool inert_ask(const scene *s, const char *path, const inert_witness *witness, inert_answer *out);

/* The conditions on other parameters under which a parameter has an effect: "kind=rectangle, height>0", of the same
 * object or with a full path; "" for none. What else it needs depends on the scene. Returns text. */
char *inert_needs_text(const struct param *row, char *text, size_t size);

/* --- hints --- */

/* Reports a note for each of: no visible solid; no light although a surface needs one; a visible solid that is black,
 * or transparent without refraction, or opaque with a refractive index, or entirely inside another one that has
 * precedence; settings without effect; then scene_range_hints. Such a scene may be intended: these are notes, not
 * errors. */
void scene_hints(const scene *s, const note_taker *taker);

/* For each medium, including the surroundings and metals, whose index is evaluated outside the range in which it was
 * measured: at the wavelengths of the film. */
void scene_range_hints(const scene *s, const note_taker *taker);
/* At render.lambda_nm alone, as `cuvette trace` and `cuvette fan` do; layered: metals and films too, instead of in
 * daylight (probe_one_wavelength). */
void scene_lambda_range_hints(const scene *s, bool layered, const note_taker *taker);
/* At the wavelengths of the visible beams, whether or not they light the scene: for what shows them. */
void scene_beam_range_hints(const scene *s, const note_taker *taker);

/* --- the linter --- */

/* The hints; overlaps, gaps and the camera, examined along lines through the solids: a note is given only if the solids
 * themselves confirm it, and features between all lines are missed; and what the depth limit cuts, by small images.
 * Without scene_load, a scene with meshes is examined only by its parameters. level: from isa_choose. */
status lint_scene(const scene *s, isa level, const note_taker *taker, diagnostic *why);
