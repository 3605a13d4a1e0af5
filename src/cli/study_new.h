/* The text of a new study file for `cuvette study new`. Ownership: new_axis_release frees an axis; everything else is
 * borrowed. */
#pragma once

#include "base/status.h"
#include "scene/model/open.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* PATH=1,2,3, or PATH=FROM..TO:STEPS. */
typedef struct new_axis {
    char *path;
    char **values; /* of a list; or from, to and steps */
    size_t count;
    bool range;
} new_axis;

/* Splits the value of --axis. Commas in brackets belong to one value: lamp.position=[0,1,2],[3,4,5]. */
status new_axis_parse(const char *text, new_axis *out, diagnostic *why);
void new_axis_release(new_axis *axis);
/* The number of its values. */
size_t new_axis_points(const new_axis *axis);

typedef struct new_study {
    const char *name, *scene_path; /* the path relative to the study file */
    const scene *of;
    const char *const *sets; /* PATH=VALUE */
    size_t set_count;
    const new_axis *axes;
    size_t axis_count;
    int64_t repetitions;
} new_study;

/* Writes the study file, with a comment on each parameter. */
void new_study_write(const new_study *s, FILE *out);
