/* What the sections of a scene file have in common: entries that are rows of the parameter table. For read.c and
 * read_objects.c. Ownership: a scene_reader borrows. */
#pragma once

#include "scene/file/document.h"
#include "scene/model/params.h"

typedef struct scene_reader {
    const document *file;
    struct scene *scene;
    diagnostic *why;
} scene_reader;

/* Returns code; on a failure, puts the node's place into a diagnostic that a function without knowledge of the
 * file filled. */
status read_located(const scene_reader *r, const node *at, status code);

/* A map, or nothing at all (which counts as a map without entries). */
status read_expect_map(const scene_reader *r, const node *n, const char *name);
/* A scalar that is not empty. */
status read_expect_word(const scene_reader *r, const node *n, const char *name);

/* A map that gives an index must not name a medium too. */
status read_one_medium(const scene_reader *r, const node *map);

/* Refuses keys that are no rows of the group. */
status read_check_keys(const scene_reader *r, param_group group, const node *map);
/* Sets the entries of a map that are rows of the group; name is the path's first word. Others are left to the
 * caller. */
status read_entries(const scene_reader *r, const char *name, param_group group, const node *map);

/* A section of named objects: each is added to the scene, and checked. Materials come before solids, which refer to
 * them. */
status read_objects(const scene_reader *r, const char *name, param_group group, const node *map);
