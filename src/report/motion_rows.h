/* Properties of a slime's motion next to theory as CSV and JSON, for `cuvette motion` and the laboratory. Errors of the
 * stream stay in the stream. Ownership: everything is borrowed; JSON is a new reference, NULL when out of
 * memory. */
#pragma once

#include "scene/model/solids.h"
#include "softbody/trials.h"
#include <jansson.h>
#include <stdio.h>

/* The name of the slime's integrator. */
const char *motion_integrator(const mesh_entry *m);

/* cuvette-motion(1) documents them. The CSV has one header for all slimes. */
void motion_write_csv_header(FILE *out);
void motion_write_csv(const mesh_entry *m, const softbody_trial_report *r, FILE *out);
json_t *motion_slime_json(const mesh_entry *m, const softbody_trial_report *r);
/* Takes the reference to slimes, a list of those. */
json_t *motion_json(json_t *slimes, const char *scene_path);
