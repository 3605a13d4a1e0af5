/* What a study's cells are. For study/read.c, which builds the grid, and those who walk it. */
#ifndef CUVETTE_STUDY_GRID_H
#define CUVETTE_STUDY_GRID_H

#include "study/study.h"

void study_point_free(study_point *point);

/* scene_check for every cell; a wrong one is located in the study file at the point of its last axis. */
status grid_check_cells(const study *s, diagnostic *why);

/* Finds the film of each point (study_point.film). */
void axis_find_films(study_axis *axis);

/* The fingerprint of what a row means: name, scene, fixed parameters, grid. Loads the scene's pictures, whose
 * pixels count too. */
status grid_definition(const study *s, uint64_t *hash, diagnostic *why);

#endif
