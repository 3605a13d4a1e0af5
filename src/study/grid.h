/* The cells of a study. For study/read.c, which builds the grid, and for code that iterates over it. */
#pragma once

#include "study/study.h"

/* Applies the settings of a point, in order. */
status grid_set_point(scene *to, const study_point *point, diagnostic *why);

/* Fails, located at the point, if one of the point's parameters has been overwritten by a later one: the row would then
 * have a wrong value. */
status grid_check_kept(const study *s, const study_point *point, const scene *setting, diagnostic *why);

/* Calls look with the scene of every cell, until the first error. */
typedef status grid_visit(void *context, const study *s, size_t cell, scene *setting, diagnostic *why);
status grid_each_cell(const study *s, grid_visit *look, void *context, diagnostic *why);

/* Calls scene_check for every cell; an error is located in the study file at the point of its last axis. */
status grid_check_cells(const study *s, diagnostic *why);

/* Finds the film of each point (study_point.film); s has the objects that the points' paths name. */
void axis_find_films(study_axis *axis, const scene *s);

/* Parts of a hash: a text; everything in a scene that determines its image, with or without the parameters that affect
 * only performance (param.performance_only); the paths and values of a point. The scene's files must be loaded. */
void grid_hash_text(uint64_t *hash, const char *text);
status grid_hash_scene(uint64_t *hash, const scene *of, bool without_performance);
/* The contents of files: background image, textures, meshes and the materials in mesh files. A scene without files does
 * not change the hash. STATUS_FAILURE if the machine failed: the hash is then that of other files. */
status grid_hash_files(uint64_t *hash, const scene *of, diagnostic *why);
void grid_hash_point(uint64_t *hash, const study_point *point);

/* The paths of the grid, by index; NULL after the last. */
const char *study_grid_path(const study *s, size_t index);

/* Whether two texts are one value: equal texts, numbers or vectors, whose brackets and blanks may be left out: "0,
 * 3, 1" and "[0,3,1]". */
bool grid_same_value(const char *a, const char *b);

/* Writes all paths, or all values of the cell as written in the study file, each preceded by a tab. */
void grid_put_paths(const study *s, FILE *out);
void grid_put_values(const study *s, size_t cell, FILE *out);
