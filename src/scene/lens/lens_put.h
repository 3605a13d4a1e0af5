/* Sets parameters of a scene by name, one after the other, until the first error. Private to this folder. */
#pragma once

#include "scene/model/params.h"

typedef struct lens_target {
    scene *s;
    status code; /* of the first step that failed */
    diagnostic *why;
} lens_target;

/* Adds a solid, whose shape is a word of files. */
void lens_add_solid(lens_target *t, const char *shape, const char *name);
/* Sets NAME.ROW (scene_set_property). */
void lens_put(lens_target *t, const char *name, const char *row, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void lens_put_number(lens_target *t, const char *name, const char *row, double value);
/* Whether an object of the group has the name. */
bool lens_has(const scene *s, param_group group, const char *name);
