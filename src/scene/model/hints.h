/* Notes on valid scenes with an unintended result, most often because of a missing line. Pure. */
#pragma once

#include "scene/model/inert/note.h"
#include "scene/model/open.h"
#include <stdbool.h>

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
