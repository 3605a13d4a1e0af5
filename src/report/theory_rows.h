/* Writers of measured values next to theory, as CSV and JSON, for the laboratory and for `cuvette realism` (metrics and
 * curves of optics) and `cuvette motion` (the motion of slimes). Errors of the stream stay in the stream. Ownership:
 * everything is borrowed; JSON is a new reference, NULL when out of memory. */
#pragma once

#include "realism/realism.h"
#include "scene/model/solids.h"
#include "softbody/trials.h"
#include <jansson.h>
#include <stdio.h>

/* "pass", "FAIL", or "none" for a metric that the scene does not have. */
const char *realism_verdict(const realism_value *v);

/* The formats are in cuvette-realism(1). */
void realism_write_csv(const realism_report *r, FILE *out);
json_t *realism_json(const realism_report *r, const char *scene_path);
void realism_write_curve(realism_curve which, const realism_points *points, FILE *out);
/* {"name", "x", "y", "points": [[x, measured, theory], ..]} */
json_t *realism_curve_json(realism_curve which, const realism_points *points);

/* The name of the slime's integrator. */
const char *motion_integrator(const mesh_entry *m);

/* The formats are in cuvette-motion(1). The CSV has one header for all slimes. */
void motion_write_csv_header(FILE *out);
void motion_write_csv(const mesh_entry *m, const softbody_trial_report *r, FILE *out);
json_t *motion_slime_json(const mesh_entry *m, const softbody_trial_report *r);
/* slimes: a list of the objects of motion_slime_json; its reference is stolen. */
json_t *motion_json(json_t *slimes, const char *scene_path);
