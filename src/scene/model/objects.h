/* The objects of a scene by their group, whatever they are: meshes, textures, lights, materials and solids stand in
 * arrays whose elements begin with their names; render, camera and background are one each, without a name of their
 * own. For the scene's own files, which make, copy, find and remove them. Ownership: the scene's. */
#pragma once

#include "scene/model/params.h"

static inline bool group_has_names(param_group group)
{
    return group > PARAM_BACKGROUND;
}

/* The object itself, and the struct in it that its group's rows are about. */
void *object_at(const scene *s, param_group group, size_t index);
void *object_values(const scene *s, param_group group, size_t index);

/* Index of the object of that name, or -1. */
int object_find(const scene *s, param_group group, const char *name);

/* One more of a group with names, at its end: all zero but for a copy of the name; NULL when memory is out. */
void *object_append(scene *s, param_group group, const char *name);
void object_remove(scene *s, param_group group, size_t index);

/* All of one but its name, to another one of its group. Copies share what was loaded; false when memory is out, and
 * what there is is released with the scene. */
bool object_assign(scene *s, param_group group, size_t to, size_t from);

/* All that have names. As object_assign. */
bool objects_clone(scene *s, const scene *original);
void objects_release(scene *s);

/* "did you mean 'oak'?", or where to add one; returns text. */
char *object_remedy(const scene *s, param_group group, const char *wrong, char *text, size_t size);
