/* The parameter table as text, as JSON, and as roff for the manual page. */
#pragma once

#include "scene/model/params.h"
#include <jansson.h>
#include <stdio.h>

/* The lines of a table: all parameters, or those of a scene with their values, optionally filtered.
 * param_lines_collect allocates, param_lines_release frees, also after an error. */
enum { PARAM_PATH_MAX = 400 };

typedef struct param_line {
    char *path, *value; /* without a scene, value is the default */
    const param *row;
} param_line;

typedef struct param_lines {
    param_line *line;
    size_t count;
} param_lines;

/* filter as below; s and filter may be NULL. */
status param_lines_collect(const scene *s, const char *filter, param_lines *out, diagnostic *why);
void param_lines_release(param_lines *all);

/* "render.depth"; "LIGHT.intensity" for a group whose objects have names. */
char *param_lines_path(const param *row, char *text, size_t size);

/* Prints the table; with a scene, each of its parameters and values. filter, unless NULL: only the parameters of that
 * path, group or name, or if there are none, those with the word in their path or meaning; STATUS_BAD_INPUT if there
 * are none either. columns: width of the terminal to which lines are wrapped; 0: no wrapping. */
status param_rows_print(FILE *stream, const scene *s, const char *filter, int columns, diagnostic *why);

/* The same as JSON, a new reference. */
status param_rows_json(const scene *s, const char *filter, json_t **out, diagnostic *why);

/* The parameter section of cuvette.1. */
void param_rows_manual(FILE *stream);
