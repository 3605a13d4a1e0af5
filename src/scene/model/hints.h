/* What a scene that is right in every part still shows nothing of, most often because a line was forgotten. Pure. */
#pragma once

#include "scene/model/inert/note.h"
#include "scene/model/open.h"

/* Gives a note for each: no visible solid; no light where something would be lit; a visible solid that is black,
 * that is transparent and bends no light, that is opaque and has a refractive index, or that lies wholly inside
 * another one that wins there; what is set and has no effect; then those of scene_range_hints. A scene may be meant
 * so: these are notes, not errors. */
void scene_hints(const scene *s, const note_taker *taker);

/* The same for each medium, the surroundings' too, whose index is extrapolated beyond the wavelengths where it was
 * measured. */
void scene_range_hints(const scene *s, const note_taker *taker);
