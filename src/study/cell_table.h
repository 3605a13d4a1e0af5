/* Tables of what a cell's scene measures to, beside its picture: its realism metrics (realism/realism.h), one line a
 * metric, or a point of a curve; and its slimes' motion (softbody/trials.h), one line a value. Each line begins with
 * study, cell and the cell's values of the grid, so that the tables of all cells can be strung together. Tab separated,
 * NA for what there is none of; results/README.md lists the columns. A file appears whole or not at all. */
#pragma once

#include "base/isa.h"
#include "study/study.h"
#include <stdio.h>

typedef enum cell_table { CELL_METRICS, CELL_CURVES, CELL_MOTION } cell_table;

/* Can the tables that the study keeps be measured in every cell? Errors are located in the study file. */
status cell_tables_check(const study *s, diagnostic *why);

/* setting: the cell's scene. STATUS_BAD_INPUT when it is none that the metrics know. */
status cell_table_write(cell_table which, const study *s, size_t cell, const scene *setting, isa level,
                        const char *path, diagnostic *why);

/* A tab and a number, with as many digits as read back the same. */
void cell_table_number(FILE *out, double value);
