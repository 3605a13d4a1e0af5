/* The linter: notes on parts of a valid scene that have no effect, or not the effect that the author expects.
 *
 * A note has a place, one sentence and a remedy. Three things make notes:
 * - param_is_inert: one parameter has no effect, and what it needs. It takes microseconds, and therefore runs for each
 *   --set, each change in the page and each axis of a study. A witness, if there is one, decides what only an
 *   image shows.
 * - scene_hints, scene_range_hints and the like: what a scene seems to lack.
 * - lint_scene: the hints, and what lines through the solids and small images show.
 *
 * If the answer is uncertain there is no note: a false note is worse than none. Pure: film and counters of later frames
 * are not affected. Ownership: the scene is borrowed; a note is valid during the call that passes it. */
#pragma once

#include "base/isa.h"
#include "scene/model/material.h"
#include "scene/model/open.h"
#include <stdbool.h>
#include <stddef.h>

/* --- notes --- */

enum { NOTE_PLACE_MAX = 2 * SCENE_NAME_MAX, NOTE_TEXT_MAX = 256, NOTE_LINE_MAX = 768 };

typedef struct scene_note {
    char place[NOTE_PLACE_MAX]; /* a parameter's path as in --set ("water.ior"), or an object's name */
    char text[NOTE_TEXT_MAX];   /* the observation, no full stop */
    char remedy[NOTE_TEXT_MAX]; /* the remedy, no full stop; "" for none */
} scene_note;

/* A callback for notes; each note is borrowed for the call. */
typedef void note_call(void *context, const scene_note *note);
typedef struct note_sink {
    note_call *take;
    void *context;
} note_sink;

/* Passes a note to the callback. Its place is object.parameter; either may be NULL. */
void note_report(const note_sink *taker, const char *object, const char *parameter, const char *remedy,
                 const char *text, ...) __attribute__((format(printf, 5, 6)));

/* Writes "place: text; remedy" (missing parts are omitted) to line, at most NOTE_LINE_MAX; returns line. */
char *note_line(const scene_note *note, char *line, size_t size);

struct ray_counters; /* base/counters.h */

/* --- parameters without effect --- */

struct param;        /* scene/model/params.h */
struct ray_counters; /* base/counters.h */

typedef struct inert_answer {
    const char *rule; /* a word for the condition, constant text */
    scene_note note;  /* at the parameter's path; a remedy that sets a parameter has the form "set PATH=VALUE" */
} inert_answer;

/* A renderer that decides what the scene file cannot. Each member may be NULL. */
typedef struct inert_witness {
    const struct ray_counters *frame; /* counters of a frame of this scene */
    /* Whether this assignment (PATH=VALUE) leaves the film unchanged; false if uncertain. */
    bool (*same)(void *context, const char *assignment);
    void *context;
} inert_witness;

/* Whether the parameter has no effect: none of its values changes the film while the condition of the note holds.
 * witness may be NULL. False for an invalid path, too. */
bool param_is_inert(const scene *s, const char *path, const inert_witness *witness, inert_answer *out);

/* The conditions on other parameters under which a parameter has an effect: "kind=rectangle, height>0", on the same
 * object or with a full path; "" for none. Rules that depend on the scene, and conditions of all parameters of a group,
 * are left out. Returns text. */
char *inert_needs_text(const struct param *row, char *text, size_t size);

/* --- hints --- */

/* Reports a note for each of: no visible solid; no light although a surface needs one; a visible solid that is black,
 * or transparent without refraction, or opaque with a refractive index, or entirely inside another one that has
 * precedence; settings without effect; then scene_range_hints. Such a scene may be intended: these are notes, not
 * errors. */
void scene_hints(const scene *s, const note_sink *taker);

/* Notes each medium (surroundings and metals, too) whose index the film needs at wavelengths outside the range in which
 * it was measured. */
void scene_range_hints(const scene *s, const note_sink *taker);
/* Like scene_range_hints, at render.lambda_nm only: for `cuvette trace` and `cuvette fan`. layered: metals and films
 * are evaluated at this wavelength, too, instead of in daylight (probe_use_one_wavelength). */
void scene_lambda_range_hints(const scene *s, bool layered, const note_sink *taker);
/* Like scene_range_hints, at the wavelengths of the visible beams, whether or not they light the scene: for drawings of
 * beams. */
void scene_beam_range_hints(const scene *s, const note_sink *taker);

/* --- the linter --- */

/* Reports the hints; overlaps and gaps, which are found along lines through the solids (features between the lines are
 * missed) and confirmed at points around them; a camera inside a solid; and light that the depth limit cuts, by small
 * images. A scene whose files are not loaded gets only the hints. level: from isa_choose. */
status lint_scene(const scene *s, isa level, const note_sink *taker, diagnostic *why);
