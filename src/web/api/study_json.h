/* What the laboratory's API says of studies, as JSON. Values of rows and summaries are texts, as they stand in the
 * files: a program that reads them as numbers loses nothing on the way. Ownership: new references. Errors:
 * STATUS_BAD_INPUT for rows that are damaged or of another definition. */
#pragma once

#include "study/study.h"
#include <jansson.h>

enum { STUDY_JSON_ROWS_MAX = 1000, STUDY_JSON_CELLS_MAX = 5000 };

/* title, cells, axes: [{"name", "paths", "units", "count"}]; false when memory is out. */
bool study_json_about(const study *s, json_t *into);

/* {"columns", "rows", "count"}: what `cuvette study summary` prints, of the first STUDY_JSON_CELLS_MAX cells; null
 * without rows. */
status study_json_summary(const study *s, const char *results, json_t **out, diagnostic *why);
/* The same of the raw rows from the from-th on, STUDY_JSON_ROWS_MAX at most. */
status study_json_rows(const study *s, const char *results, size_t from, json_t **out, diagnostic *why);
/* {"columns": paths of the grid, "cells": [..]}: wall times of the cells in two folders of results, see web/README.md.
 */
status study_json_compare(const study *s, const char *results, const char *other, json_t **out, diagnostic *why);
