/* The parameter table as text for people: one line a parameter, or the reference of the manual page as roff. */
#ifndef CUVETTE_REPORT_PARAM_ROWS_H
#define CUVETTE_REPORT_PARAM_ROWS_H

#include "scene/model/params.h"
#include <jansson.h>
#include <stdio.h>

/* The table; with a scene, each of its parameters and the value. filter, unless NULL: only the parameters of that path,
 * group or name, or else those that have the word in their path or meaning; STATUS_BAD_INPUT when there are none.
 * columns: of the terminal, to which meanings are wrapped; 0 leaves them alone. */
status param_rows_print(FILE *stream, const scene *s, const char *filter, int columns, diagnostic *why);

/* The same as JSON; the caller's. */
status param_rows_json(const scene *s, const char *filter, json_t **out, diagnostic *why);

/* The parameter part of cuvette.1. */
void param_rows_manual(FILE *stream);

#endif
