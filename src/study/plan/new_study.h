/* A new study file, for `cuvette study new` and the laboratory: composed from a scene and axes, and read as `cuvette
 * study run` reads it. Ownership: new_axis_release frees an axis; the caller frees the text and the study of
 * new_study_compose; everything else is borrowed. */
#pragma once

#include "base/status.h"
#include "scene/model/open.h"
#include "study/study.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* PATH=1,2,3, or PATH=FROM..TO:STEPS. */
typedef struct new_axis {
    char *path;
    char **values; /* the values of a list; or from, to and steps of a range */
    size_t count;
    bool range;
} new_axis;

/* Splits the value of --axis. Commas in brackets belong to one value: lamp.position=[0,1,2],[3,4,5]. */
status new_axis_parse(const char *text, new_axis *out, diagnostic *why);
void new_axis_release(new_axis *axis);

typedef struct new_study {
    const char *name, *scene_path; /* the path relative to the study file */
    const scene *base;
    const char *const *sets; /* PATH=VALUE */
    size_t set_count;
    const new_axis *axes;
    size_t axis_count;
    int64_t repetitions, warmups;
} new_study;

/* Writes the study file, with a comment on each parameter. */
void new_study_write(const new_study *s, FILE *out);

/* The request for a new study. */
typedef struct new_study_order {
    const char *scene;                     /* the path of the scene file */
    const char *target;                    /* the path of the study file; NULL: none is written */
    const char *name;                      /* NULL: taken from target, or from the scene and the first axis */
    const char *const *axes, *const *sets; /* PATH=VALUES; PATH=VALUE for all cells */
    size_t axis_count, set_count;
    int64_t repetitions, warmups;
    const study_guard *guard; /* limits the files that the study may read; NULL: no limit */
} new_study_order;

/* s: the scene of the file; the settings are applied to it. An error is located at the option of `study new` that
 * causes it, such as "--axis render.depth=x". */
status new_study_compose(const new_study_order *order, scene *s, char **text, study **read, diagnostic *why);
