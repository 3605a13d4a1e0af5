/* The cells of a study, for its reader and for code that iterates over them: scenes, references, values as text, and
 * the order in which cells are measured. Pure except for memory. */
#pragma once

#include "scene/data/document.h"
#include "study/study.h"

/* Reads a study that is a fit (study/fit/fit.h): it has a section `fit`, and no grid, repetitions or kept files. *d:
 * its document, which the caller destroys. study_read refuses such a study. */
status study_read_fit(const char *path, study **out, document **d, diagnostic *why);
status study_read_fit_text(const char *name, const char *text, size_t size, study **out, document **d, diagnostic *why);

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

/* Applies the settings of a point, in order. */
status study_point_apply(const study_point *point, scene *to, diagnostic *why);

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

/* --- reading a grid (read_grid.c, comma_slip.c) ---
 *
 * The part of a study file that refers to parameters: the fixed settings and the grid. For study/plan/read.c. */

/* Validates every path and value on s->base, applies the fixed ones to it, and fills s->fixed and s->axes. set and grid
 * may be NULL. */
status read_grid(study *s, const document *d, const node *set, const node *grid, diagnostic *why);

/* Reads each entry of a map {path: value} into an empty point, and applies it to target. The caller releases the point,
 * also after an error. */
status read_point(study_point *point, scene *target, const document *d, const node *map, diagnostic *why);
void study_point_release(study_point *point);

/* Validates the reference's paths and values on a copy of s->base, and fills s->reference. reference may be NULL. */
status read_reference(study *s, const document *d, const node *reference, diagnostic *why);

/* Whether the text has no control characters: a row must be one line. */
bool read_grid_plain(const char *text);

/* Commas in place of decimal points in the list of an axis (study/plan/comma_slip.c): [1.3, 1,4] has three values, not
 * two. Such a list is valid, so there is a note, not an error; the study owns it. */
enum { COMMA_SLIP_TEXT_MAX = 64 };

/* Whether items i and i + 1, two integers, are probably one number, which is then written to joined ("1.4"). One of
 * these is the case:
 * - No blank follows the comma, and the second integer has several digits and begins with 0: [1,05, 2].
 * - No blank follows the comma, the parameter is real (`real`), and the list has only these integers, the first of one
 *   digit and the second of several: [1,33].
 * - Another item has a decimal point, and no blank follows this comma although one follows another comma.
 * - Another item has a decimal point, and the values increase or decrease steadily if the two are one number, but not
 *   if they are two. */
bool comma_slip_at(const node *list, size_t i, bool real, char joined[COMMA_SLIP_TEXT_MAX]);

/* Adds a note for each decimal comma in the list of values of path. */
status comma_slip_note(study *s, const char *path, const node *list, bool real, diagnostic *why);
