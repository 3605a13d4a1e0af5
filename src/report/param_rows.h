/* The parameter table as text, one line per parameter; as JSON, for the page and `cuvette params --json`; and as roff
 * for the manual page. param_lines.c collects the lines. */
#pragma once

#include "scene/model/params.h"
#include <jansson.h>
#include <stdio.h>

/* The lines of a table: all parameters, or those of a scene with their values, or those that match a filter. Ownership:
 * param_lines_release frees the lines that param_lines_collect allocated, also after an error. */
enum { PARAM_PATH_MAX = 400 };

typedef struct param_line {
    char *path, *value; /* without a scene the value is the default */
    const param *row;
} param_line;

typedef struct param_lines {
    param_line *line;
    size_t count;
} param_lines;

/* filter: as for param_rows_print; s and filter may be NULL. */
status param_lines_collect(const scene *s, const char *filter, param_lines *out, diagnostic *why);
void param_lines_release(param_lines *all);

/* The path of a row, such as "render.depth"; "LIGHT.intensity" for objects, whose names the scene defines. Returns
 * text. */
char *param_lines_path(const param *row, char *text, size_t size);

/* Prints the table; with a scene, all its parameters with their values. filter: NULL, or a path, group or name of
 * parameters, or a word in their path or meaning; STATUS_BAD_INPUT if it matches none. columns: width of the terminal
 * to which meanings are wrapped; 0: no wrapping. */
status param_rows_print(FILE *stream, const scene *s, const char *filter, int columns, diagnostic *why);

/* The table as JSON; the caller owns *out. opened: NULL, or, for the page, an earlier state of the scene, whose values
 * become `initial` (null: no such parameter). Rows of `ior` then have `first_coefficients`, {LAW: initial numbers}. */
status param_rows_json(const scene *s, const scene *opened, const char *filter, json_t **out, diagnostic *why);

/* Prints the generated part of cuvette-scene(5). */
void param_rows_manual(FILE *stream);
