/* The parameter table as text, one line a parameter; as JSON, which the page and `cuvette params --json` read; and as
 * roff for the manual page. The lines are collected in param_lines.c. */
#pragma once

#include "scene/model/params.h"
#include <jansson.h>
#include <stdio.h>

/* The parameters that a table shows: all there are, or those of a scene with their values, or the few that a word fits.
 * param_lines_release releases what param_lines_collect filled, also after an error. */
enum { PARAM_PATH_MAX = 400 };

typedef struct param_line {
    char *path, *value; /* the value is the default where there is no scene */
    const param *row;
} param_line;

typedef struct param_lines {
    param_line *line;
    size_t count;
} param_lines;

/* filter as below; s and filter may be NULL. */
status param_lines_collect(const scene *s, const char *filter, param_lines *out, diagnostic *why);
void param_lines_release(param_lines *all);

/* "render.depth"; "LIGHT.intensity" where the scene gives the name. */
char *param_lines_path(const param *row, char *text, size_t size);

/* The table; with a scene, each of its parameters and the value. filter, unless NULL: only the parameters of that path,
 * group or name, or else those that have the word in their path or meaning; STATUS_BAD_INPUT when there are none.
 * columns: of the terminal, to which meanings are wrapped; 0 leaves them alone. */
status param_rows_print(FILE *stream, const scene *s, const char *filter, int columns, diagnostic *why);

/* The same as JSON; the caller's. */
status param_rows_json(const scene *s, const char *filter, json_t **out, diagnostic *why);

/* The generated part of cuvette-scene(5). */
void param_rows_manual(FILE *stream);
