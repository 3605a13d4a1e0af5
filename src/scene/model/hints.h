/* Notes on valid scenes with an unintended result, most often because of a missing line. Pure. */
#pragma once

#include "scene/model/inert/note.h"
#include "scene/model/open.h"

/* Reports a note for each of: no visible solid; no light although a surface needs one; a visible solid that is black,
 * or transparent without refraction, or opaque with a refractive index, or entirely inside another one that has
 * precedence; settings without effect; then scene_range_hints. Such a scene may be intended: these are notes, not
 * errors. */
void scene_hints(const scene *s, const note_taker *taker);

/* The same for each medium, including the surroundings, whose index is extrapolated outside the range in which it was
 * measured. */
void scene_range_hints(const scene *s, const note_taker *taker);
