/* Studies as JSON for the laboratory's API. Values of rows and summaries are strings exactly as in the files, so no
 * digit is lost. Ownership: returns new references. Errors: STATUS_BAD_INPUT for rows that are damaged or belong to
 * another definition. */
#pragma once

#include "study/study.h"
#include <jansson.h>

enum { STUDY_JSON_ROWS_MAX = 1000, STUDY_JSON_CELLS_MAX = 5000 };

/* Adds title, cells and axes: [{"name", "paths", "units", "count"}]; false when out of memory. */
bool study_json_about(const study *s, json_t *into);

/* The output of `cuvette study summary`, allocated memory; NULL without rows. */
status study_summary_text(const study *s, const char *results, char **text, size_t *size, diagnostic *why);
/* {"columns", "rows", "count"}: the output of `cuvette study summary`, limited to STUDY_JSON_CELLS_MAX cells; null
 * without rows. */
status study_json_summary(const study *s, const char *results, json_t **out, diagnostic *why);
/* The raw rows in the same form, from row `from` on, at most STUDY_JSON_ROWS_MAX. */
status study_json_rows(const study *s, const char *results, size_t from, json_t **out, diagnostic *why);
