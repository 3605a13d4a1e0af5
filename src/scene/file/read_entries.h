/* Common code of a scene file's sections: entries that are rows of the parameter table. For read.c and read_objects.c.
 * Ownership: a scene_reader borrows. */
#pragma once

#include "scene/file/document.h"
#include "scene/model/params.h"

typedef struct scene_reader {
    const document *file;
    struct scene *scene;
    diagnostic *why;
} scene_reader;

/* Returns code; on failure, adds the node's location to a diagnostic from a function that does not know the file. */
status read_located(const scene_reader *r, const node *at, status code);

/* Requires a map, or nothing (an empty map). */
status read_expect_map(const scene_reader *r, const node *n, const char *name);
/* Requires a scalar that is not empty. */
status read_expect_word(const scene_reader *r, const node *n, const char *name);

/* Refuses a map that has both an index and a medium. */
status read_one_medium(const scene_reader *r, const node *map);

/* Refuses keys that are not rows of the group. */
status read_check_keys(const scene_reader *r, param_group group, const node *map);
/* Sets the entries of a map that are rows of the group; name is the path's first word. Other entries are left to the
 * caller. */
status read_entries(const scene_reader *r, const char *name, param_group group, const node *map);

/* Reads a section of named objects: each is added to the scene and checked. Materials come before solids, which refer
 * to them. */
status read_objects(const scene_reader *r, const char *name, param_group group, const node *map);
