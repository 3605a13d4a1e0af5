/* What a study's cells are. For study/read.c, which builds the grid, and those who walk it. */
#pragma once

#include "study/study.h"

/* Sets what a point sets, in its order. */
status grid_set_point(scene *to, const study_point *point, diagnostic *why);

/* Has one of the point's parameters been overwritten by a later one, which its row would then not tell? An error,
 * located at the point. */
status grid_check_kept(const study *s, const study_point *point, const scene *setting, diagnostic *why);

/* Calls look with the scene of every cell, until one has an error. */
typedef status grid_visit(void *context, const study *s, size_t cell, scene *setting, diagnostic *why);
status grid_each_cell(const study *s, grid_visit *look, void *context, diagnostic *why);

/* scene_check for every cell; a wrong one is located in the study file at the point of its last axis. */
status grid_check_cells(const study *s, diagnostic *why);

/* Finds the film of each point (study_point.film); s has the objects that the points' paths name. */
void axis_find_films(study_axis *axis, const scene *s);

/* The fingerprint of what a row means (study/meaning.h). Loads the scene's files, whose
 * contents count too. */
status grid_definition(const study *s, uint64_t *hash, diagnostic *why);

/* Goes into a fingerprint: a text; all of a scene that makes its picture, with or without the parameters that are how a
 * frame is computed (param.performance_only); the paths and values of a point. The scene's files must have been
 * loaded. */
void grid_hash_text(uint64_t *hash, const char *text);
status grid_hash_scene(uint64_t *hash, const scene *of, bool without_performance);
/* The part of it that the parameters do not say: the sky's picture, textures, meshes and what their files say of their
 * faces. A scene without files leaves the fingerprint as it was. */
void grid_hash_files(uint64_t *hash, const scene *of);
void grid_hash_point(uint64_t *hash, const study_point *point);

/* The paths of the grid, in its order, one at a time: NULL behind the last. */
const char *study_grid_path(const study *s, size_t index);

/* All of them, and the cell's values as the study file gives them, each behind a tab. */
void grid_put_paths(const study *s, FILE *out);
void grid_put_values(const study *s, size_t cell, FILE *out);
