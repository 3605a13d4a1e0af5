/* The linter: notes on valid but suspicious scenes, from the scene itself (scene/model/hints.h), the placement of its
 * solids and camera, and a small probe image. Placement is examined along lines through the solids: a note is given
 * only if the solids themselves confirm it, so there are no false alarms; features between all lines are missed.
 *
 * Later frames are not affected: neither film nor counters. Ownership: the scene is borrowed, a note is valid during
 * the call. */
#pragma once

#include "base/isa.h"
#include "scene/model/inert/note.h"
#include "scene/model/open.h"

/* Without scene_load, a scene with meshes is examined only by its parameters. level: from isa_choose. */
status lint_scene(const scene *s, isa level, const note_taker *taker, diagnostic *why);
