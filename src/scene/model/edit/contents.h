/* Objects that belong together. What is inside a solid goes with it: the liquid and the rod of a vessel. These are
 * the solids and lights whose centre is in the solid's bounding box and that are smaller than it, so that the liquid
 * does not take the vessel along. Errors: STATUS_BAD_INPUT as in scene/model/edit/edit.h; a partial change may
 * remain, so edit a copy. */
#pragma once

#include "base/vec3.h"
#include "scene/model/open.h"
#include <stdbool.h>

typedef struct contents {
    const char **name; /* borrowed from the scene */
    size_t count;
} contents;

/* Fills out, which contents_clear frees; empty for a light or an unbounded solid. */
status contents_find(const scene *s, const char *container, contents *out, diagnostic *why);
void contents_clear(contents *c);

/* A ball around the object, and whether it is known: not for an unbounded solid. */
bool contents_ball(const scene *s, const char *name, vec3 *centre, double *radius);

/* Objects that are changed together, as one rigid body about the position of the first. Names other than of the first
 * may repeat; each is changed once. */
typedef struct object_list {
    const char *first, **others;
    size_t count; /* of the others */
} object_list;

/* scene_move, scene_turn and scene_scale for them. */
status scene_move_together(scene *s, const object_list *of, vec3 by, diagnostic *why);
status scene_turn_together(scene *s, const object_list *of, vec3 degrees, diagnostic *why);
status scene_scale_together(scene *s, const object_list *of, double factor, diagnostic *why);
