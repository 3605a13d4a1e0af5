/* Cells by content. The identity of a cell is a hash of everything that determines its film and its measurement: the
 * meaning of its scene, and the contents of all files that it names. So a new parameter changes no identity, and a cell
 * keeps its rows when axes of its study grow, shrink or are reordered.
 *
 * The meaning of a scene is what determines its frame, as pairs of name and value. Values at their first defaults
 * (param.first_default) are omitted, so that a version of the program with more parameters, shapes or words, or with
 * other defaults, gives the same meaning for the same values; so are parameters of random paths in a scene of another
 * integrator (param.by_chance); objects and shapes are identified by name. For this, a published name or word must
 * never change. Ownership: identities_find gives an array for free; meaning_free releases what was filled. */
#pragma once

#include "study/study.h"

/* The identity of each cell, in their order. The files of s->base must be loaded; those that an axis names are loaded
 * here. */
status identities_find(const study *s, uint64_t **out, diagnostic *why);

/* The number of the cell with that identity, or study_cell_count(s). */
size_t identity_cell(const study *s, uint64_t identity);

/* The identity of a row of compare.csv: that of the cell and its reference. */
uint64_t identity_compared(const study *s, uint64_t identity);

/* The hash of a reference's scene, equal for scenes that differ only in performance parameters. Image files must be
 * loaded. */
status reference_scene_hash(const scene *setting, uint64_t *hash);

/* The contents of files: background image, textures, meshes and the materials in mesh files. A scene without files does
 * not change the hash. STATUS_FAILURE if the machine failed: the hash is then that of other files. */
status identity_hash_files(uint64_t *hash, const scene *of, diagnostic *why);

typedef struct meaning_item {
    char *name, *value;
} meaning_item;
typedef struct meaning {
    meaning_item *items;
    size_t count;
} meaning;

/* The meaning of a scene, with or without the parameters that affect only performance (param.performance_only).
 * STATUS_FAILURE if memory runs out. */
status meaning_of_scene(meaning *m, const scene *of, bool without_performance);
void meaning_free(meaning *m);

/* A hash that does not depend on the order of the items. */
uint64_t meaning_hash(const meaning *m);
