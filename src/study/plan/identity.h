/* The identity of a cell is a hash of everything that determines its film and its measurement: the
 * meaning of its scene, and the contents of all files that it names. So a new parameter changes no identity, and a cell
 * keeps its rows when axes of its study grow, shrink or are reordered.
 *
 * The meaning of a scene is what determines its frame, as pairs of name and value. Values at their first defaults
 * (param.first_default) are omitted, so that a version of the program with more parameters, shapes or words, or with
 * other defaults, finds the same meaning for the same values. Parameters of random paths are omitted for other
 * integrators (param.by_chance). Objects and shapes are identified by name, so a published name or word must never
 * change. Ownership: the caller frees the array of identities_find; meaning_free releases a meaning. */
#pragma once

#include "scene/model/params.h"
#include "study/study.h"

/* The identity of each cell, in the order of cells. The files of s->base must be loaded; if an axis names files, the
 * function loads the files of each cell. */
status identities_find(const study *s, uint64_t **out, diagnostic *why);

/* The number of the cell with that identity, or study_cell_count(s). */
size_t identity_cell(const study *s, uint64_t identity);

/* The identity of a row of compare.csv: a hash of the cell's identity and its reference. */
uint64_t identity_compared(const study *s, uint64_t identity);

/* The hash of a reference's scene, equal for scenes that differ only in performance parameters. Image files must be
 * loaded. */
status reference_scene_hash(const scene *setting, uint64_t *hash);

/* Adds the contents of files to the hash: background image, textures, mesh files with their materials, and scripts of
 * slimes. A scene without files does not change it. STATUS_FAILURE after a system error: the hash is then
 * meaningless. */
status identity_hash_files(uint64_t *hash, const scene *s, diagnostic *why);

typedef struct meaning_item {
    char *name, *value;
} meaning_item;
typedef struct meaning {
    meaning_item *items;
    size_t count;
} meaning;

/* The meaning of a scene, with or without the parameters that affect only performance (param.performance_only).
 * first_defaults: of all rows, for a caller with many scenes; NULL: made here. STATUS_FAILURE if memory runs out. */
status meaning_of_scene(meaning *m, const scene *s, bool without_performance, const param_defaults *first_defaults);
void meaning_free(meaning *m);

/* A hash that does not depend on the order of the items. */
uint64_t meaning_hash(const meaning *m);
