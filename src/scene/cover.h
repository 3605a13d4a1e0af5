/* Which solid hides another one for good: by the shapes' own measures, so that what sticks out by a hair is not hidden. Pure. */
#ifndef CUVETTE_SCENE_COVER_H
#define CUVETTE_SCENE_COVER_H

#include "scene/scene.h"

/* The visible solid of s that contains all of `hidden`, one of its own solids, and wins there; NULL if there is none, or none that is known:
 * what only several cover together, what lies in a mesh, a few cylinders that lie askew in curved solids. Meshes are known once they are loaded. */
const solid *scene_cover(const scene *s, const solid *hidden);

#endif
