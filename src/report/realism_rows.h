/* Metrics and curves of optics compared with closed forms as CSV and JSON, for `cuvette realism` and the laboratory.
 * Errors of the stream stay in the stream. Ownership: everything is borrowed; JSON is a new reference, NULL when out of
 * memory. */
#pragma once

#include "realism/realism.h"
#include <jansson.h>
#include <stdio.h>

/* "pass", "FAIL", or "none" for a metric that the scene does not have. */
const char *realism_verdict(const realism_value *v);

/* cuvette-realism(1) documents them. */
void realism_write_csv(const realism_report *r, FILE *out);
json_t *realism_json(const realism_report *r, const char *scene_path);
void realism_write_curve(realism_curve which, const realism_points *points, FILE *out);
/* {"name", "x", "y", "points": [[x, measured, theory], ..]} */
json_t *realism_curve_json(realism_curve which, const realism_points *points);
