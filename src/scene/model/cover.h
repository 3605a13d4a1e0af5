/* Which solid hides another one for good, and which are apart: by the shapes' own measures, so that what sticks out
 * by a hair is not hidden. Pure. */
#pragma once

#include "scene/model/open.h"
#include "scene/model/solids.h"

/* The visible solid of s that contains all of `hidden`, one of its own solids, and wins there; NULL if there is
 * none, or none that is known: what only several cover together, what lies in a mesh, a few cylinders that lie askew
 * in curved solids. Meshes are known once they are loaded. */
const solid *scene_cover(const scene *s, const solid *hidden);

/* Does the first win where both are? Both are solids of one scene. */
bool scene_wins(const solid *winner, const solid *loser);

/* Are two solids known to share no region? By their reach along their own axes, the world's, and the line
 * between them; two that lie askew may be apart and not be known to be. */
bool scene_apart(const scene *s, const solid *a, const solid *b);

/* Is the camera known to be outside the solid, by the same reaches? */
bool scene_apart_from_eye(const scene *s, const solid *owner);

/* Does the solid lie wholly behind the camera, so that it is seen in reflections at most? */
bool scene_is_behind_camera(const scene *s, const solid *owner);
