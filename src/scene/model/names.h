/* The names of a scene's objects, and other words of its file: which names are valid, which are in use, and what a
 * wrong word was probably meant to be. Pure, except for the memory of a tally. */
#pragma once

#include "base/status.h"
#include "scene/model/params.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Letters, digits, _ and -, not starting with a digit or -, at most SCENE_NAME_MAX bytes, and not a reserved word of
 * paths or scene files. */
status check_name(const char *name, diagnostic *why);

/* An upper bound of the number of objects with a name, by a table of the names' hashes, which is nearly always exact;
 * and the place of the newest object with that name. The cost of finding a name then does not depend on the number of
 * objects.
 *
 * Ownership: zero-initialised; name_tally_clear frees. If memory runs out, it is `lost`, and the bound is SIZE_MAX. */
typedef struct name_place {
    uint32_t group, index; /* in the scene's lists of objects */
} name_place;
typedef struct name_tally {
    uint64_t *hash;     /* open addressing; an entry with hash 0 is free */
    uint32_t *count;    /* number of names with that hash */
    name_place *newest; /* the newest object with that hash */
    size_t size, used;
    bool lost;
} name_tally;

void name_tally_add(name_tally *t, const char *name, name_place at);
void name_tally_remove(name_tally *t, const char *name);
/* The upper bound of the number of objects with that name. */
size_t name_tally_most(const name_tally *t, const char *name);
/* The place of the newest object with that name, or with another name of equal hash; NULL if there is none, or if it is
 * not known. An object that has moved needs name_tally_move. */
const name_place *name_tally_newest(const name_tally *t, const char *name);
void name_tally_move(name_tally *t, const char *name, name_place to);
void name_tally_clear(name_tally *t);

/* The word of words[0..count-1] that was probably meant: a synonym (n and index for ior, opacity for transparency), the
 * only word that begins with wrong (fov for fov_deg), or the nearest in spelling. NULL if there is none; numbers and
 * words of one or two characters, to which every short word is near, match only synonyms. */
const char *suggest_word(const char *wrong, const char *const *words, size_t count);

/* Writes the remedy for a wrong key; words[] are the valid keys. Returns text. */
char *suggest_key(const char *wrong, const char *const *words, size_t count, char *text, size_t size);

/* Writes the prefix and the words: "a, b, c", or "a, b, ..." if the buffer is too small. */
void suggest_list(const char *prefix, const char *const *words, size_t count, char *text, size_t size);

/* The objects of a scene by group: meshes, textures, lights, beams, materials and solids are in arrays whose elements
 * start with their names; render, camera and background are single structs without a name. For the files of src/scene,
 * and lint/needs.c. Ownership: the scene owns its objects. */

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
