/* A cell's realism metrics (realism/realism.h) as a table beside its picture: one line a metric, or a point of a curve,
 * with the cell's values of the grid in front, so that the tables of all cells can be strung together. Tab separated,
 * NA for what there is none of. results/README.md lists the columns. The file appears whole or not at all. */
#ifndef CUVETTE_STUDY_METRIC_TABLE_H
#define CUVETTE_STUDY_METRIC_TABLE_H

#include "base/isa.h"
#include "study/study.h"

/* Can the metrics and curves that the study keeps be measured in every cell? Errors are located in the study file. */
status metric_table_check(const study *s, diagnostic *why);

/* setting: the cell's scene. STATUS_BAD_INPUT when it is none that the metrics know. */
status metric_table_write(const study *s, size_t cell, const scene *setting, isa level, const char *path,
                          diagnostic *why);
status curve_table_write(const study *s, size_t cell, const scene *setting, isa level, const char *path,
                         diagnostic *why);

#endif
