/* Notes on a study before it runs, one line each on standard error: those of the linter, of hints and of parameters
 * without effect (lint/lint.h), in all cells or in some, and those of
 * the study file. Ownership: everything is borrowed. */
#pragma once

#include "study/study.h"

/* Notes on the study file, located in it. */
void study_notes_print_file(const study *s);

/* Notes on the scenes of the cells, each once with the number of its cells. Overlaps, gaps, the camera and the depth
 * limit need traced rays: cells are examined for at most a second, and slimes are not simulated. */
status study_notes_print_cells(const study *s, diagnostic *why);
