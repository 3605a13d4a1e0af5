/* What the motion of a cell's slimes measures to (softbody/trials.h) as a table beside its picture: one line a value,
 * as `cuvette motion` has it. results/README.md lists the columns. The file appears whole or not at all. */
#ifndef CUVETTE_STUDY_MOTION_TABLE_H
#define CUVETTE_STUDY_MOTION_TABLE_H

#include "base/isa.h"
#include "study/study.h"

/* If the study keeps motion: has every cell a slime? Errors are located in the study file. */
status motion_table_check(const study *s, diagnostic *why);

/* setting: the cell's scene. */
status motion_table_write(const study *s, size_t cell, const scene *setting, isa level, const char *path,
                          diagnostic *why);

#endif
