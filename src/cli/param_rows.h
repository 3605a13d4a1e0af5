/* The parameter table as text for people: one line a parameter, or the reference of the manual page as roff. */
#ifndef CUVETTE_CLI_PARAM_ROWS_H
#define CUVETTE_CLI_PARAM_ROWS_H

#include "scene/params.h"
#include <jansson.h>
#include <stdio.h>

/* "render.depth"; "LIGHT.intensity" where the scene gives the name. */
char *param_rows_path(const param *row, char *text, size_t size);

/* The table; with a scene, each of its parameters and the value. */
status param_rows_print(FILE *stream, const scene *s, diagnostic *why);

/* The same as JSON; NULL when memory is out. */
json_t *param_rows_json(const scene *s);

/* The parameter part of cuvette.1. */
void param_rows_manual(FILE *stream);

#endif
