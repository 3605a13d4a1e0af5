/* The linter: notes on a scene that is legal and still looks wrong, from what it says (scene/model/hints.h), from where
 * its solids and its camera are, and from a small probe image. Where solids are is found along lines through them: a
 * note is only given where the solids themselves show it, so that it is never a false alarm; what lies between all
 * lines is not seen.
 *
 * Nothing of a later frame changes: neither its film nor its counters. Ownership: the scene is borrowed, a note
 * lasts for the call. */
#pragma once

#include "base/isa.h"
#include "scene/model/inert/note.h"
#include "scene/model/open.h"

/* Of a scene that is not loaded (scene_load) and has meshes only what it says is looked at. level: from isa_choose. */
status lint_scene(const scene *s, isa level, const note_taker *taker, diagnostic *why);

/* The same for a scene of which some parameters vary: `varies` is asked about each note, and one whose place varies
 * is left out. NULL: none does. */
typedef struct lint_filter {
    bool (*varies)(void *context, const char *place);
    void *context;
} lint_filter;
status lint_scene_but(const scene *s, isa level, const lint_filter *filter, const note_taker *taker, diagnostic *why);
