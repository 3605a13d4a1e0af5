/* The objects of a scene by group: meshes, textures, lights, beams, materials and solids are in arrays whose elements
 * start with their names; render, camera and background are single structs without a name. For the files of src/scene,
 * and lint/needs.c. Ownership: the scene owns its objects. */
#pragma once

#include "scene/model/params.h"

static inline bool group_has_names(param_group group)
{
    return group > PARAM_BACKGROUND;
}

/* The struct in an object to which the rows of its group refer. */
void *object_values(const scene *s, param_group group, size_t index);

/* Index of the object with that name, or -1. */
int object_find(const scene *s, param_group group, const char *name);

/* Appends an object to a group with names: all zero except for a copy of the name; NULL if memory runs out. */
void *object_append(scene *s, param_group group, const char *name);
void object_remove(scene *s, param_group group, size_t index);

/* Replaces the name of an object; the scene owns the new name from then on. */
void object_rename(scene *s, param_group group, size_t index, char *name);

/* Copies everything except the name to another object of the group, and retains loaded data. False if memory runs out:
 * the partial copy is released with the scene. */
bool object_assign(scene *s, param_group group, size_t to, size_t from);

/* Copies all objects with names, as object_assign. */
bool objects_clone(scene *s, const scene *original);
void objects_release(scene *s);

/* Writes the remedy for a name that does not exist: "did you mean 'oak'?", or where to add it; returns text. */
char *object_remedy(const scene *s, param_group group, const char *wrong, char *text, size_t size);
