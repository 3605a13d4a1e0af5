/* The cells of a study, for its reader and for code that iterates over them: scenes, references, values as text, and
 * the order in which cells are measured. Pure except for memory. */
#pragma once

#include "study/study.h"

/* The largest number of pixels of a frame in the quick form of a study. */
enum { QUICK_PIXELS = 80 * 60 };

/* Calls visit with the scene of every cell, until the first error. */
typedef status grid_visit(void *context, const study *s, size_t cell, scene *setting, diagnostic *why);
status grid_each_cell(const study *s, grid_visit *visit, void *context, diagnostic *why);

/* Checks that in every cell no parameter overwrites another one of the study, and that the scene is valid
 * (scene_check). An error of the scene is located in the study file at the cell's point of the last axis. */
status grid_check_cells(const study *s, diagnostic *why);

/* Finds the film of each point (study_point.film); s has the objects that the points' paths name. */
status grid_find_films(study_axis *axis, const scene *s, diagnostic *why);

/* The scene of the cell's reference; image files are not loaded. */
status reference_scene(const study *s, size_t cell, scene **out, diagnostic *why);
/* Checks that every cell's reference is a valid scene with the size of the cell's image. Errors name the place in the
 * study file. */
status reference_check(const study *s, diagnostic *why);

/* The paths of the grid, by index; NULL after the last. */
const char *study_grid_path(const study *s, size_t index);

/* Whether two texts are the same value: equal texts, numbers or vectors. Brackets and blanks of vectors are ignored:
 * "0, 3, 1" equals "[0,3,1]". */
bool grid_same_value(const char *a, const char *b);

/* Writes all paths, or all values of the cell as scene_get writes them, each preceded by a tab. */
void grid_put_paths(const study *s, FILE *out);
void grid_put_values(const study *s, size_t cell, FILE *out);
/* Writes a tab and a number, with enough digits to read back the same value; NA if it is not finite. */
void grid_put_number(FILE *out, double value);

/* Independent streams of one seed: round k of the repetitions uses stream k, and the order in which cells are divided
 * among shards uses this one. */
#define ORDER_STREAM_SHARDS UINT64_MAX

/* order[0..count-1] = a uniform random permutation of 0..count-1 (Fisher and Yates; Durstenfeld 1964) from the
 * counter-based generator Philox4x32-10 (Salmon et al., SC11): the same everywhere for the same (seed, stream). */
void order_shuffle(uint64_t seed, uint64_t stream, size_t *order, size_t count);
