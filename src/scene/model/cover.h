/* Conservative tests of occlusion and separation of solids, by the exact dimensions of their shapes, so that a
 * protruding edge of any size counts as visible. Pure. */
#pragma once

#include "scene/model/open.h"
#include "scene/model/solids.h"

/* Pairs of solids are compared only in scenes with at most this number of solids. */
enum { COVER_SOLIDS_MAX = 1000 };

/* A visible solid that contains all of `hidden` and has precedence there; NULL if none is known. Not detected: cover in
 * a scene of more than COVER_SOLIDS_MAX solids, cover by several solids, solids inside meshes, some cylinders at an
 * angle inside curved solids. Meshes must be loaded. */
const solid *scene_cover(const scene *s, const solid *hidden);

/* Whether the first of two solids of a scene has precedence where they overlap. */
bool scene_has_precedence(const solid *winner, const solid *loser);

/* Whether two solids are known to be disjoint, by their extent along their own axes, the world's axes, and the line
 * between them; disjoint solids at an angle may go undetected. */
bool scene_disjoint(const scene *s, const solid *a, const solid *b);

/* Whether all origins of camera rays (an orthographic camera's image, or a lens) are known to be outside the solid. */
bool scene_apart_from_eye(const scene *s, const solid *owner);

/* Whether the solid is entirely behind the camera, so that at most its reflection is visible. */
bool scene_is_behind_camera(const scene *s, const solid *owner);
