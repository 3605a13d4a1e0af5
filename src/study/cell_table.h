/* Tables of the properties of a cell's scene, in addition to its image: realism metrics (realism/realism.h), one line
 * per metric or point of a curve, and the motion of its slimes (softbody/trials.h), one line per value. Each line
 * starts with study, cell and the axis values, so that the tables of all cells can be concatenated. Tab separated, NA
 * for undefined values; results/README.md lists the columns. Files are written atomically. */
#pragma once

#include "base/isa.h"
#include "study/study.h"
#include <stdio.h>

typedef enum cell_table { CELL_METRICS, CELL_CURVES, CELL_MOTION } cell_table;

/* Checks that the tables kept by the study can be measured in every cell. Errors are located in the study file. */
status cell_tables_check(const study *s, diagnostic *why);

/* setting: the cell's scene. STATUS_BAD_INPUT if the metrics do not support it. */
status cell_table_write(cell_table which, const study *s, size_t cell, const scene *setting, isa level,
                        const char *path, diagnostic *why);

/* A tab and a number, with as many digits as read back the same. */
void cell_table_number(FILE *out, double value);
