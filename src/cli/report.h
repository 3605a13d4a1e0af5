/* The JSON account of a render: what `cuvette render --json` prints. The manual page names the keys. */
#ifndef CUVETTE_CLI_REPORT_H
#define CUVETTE_CLI_REPORT_H

#include "cli/frames.h"
#include "scene/params.h"
#include <jansson.h>

enum { REPORT_SCHEMA = 1 }; /* goes up when a key changes its meaning or goes away */

/* The account of measured frames, with at least one result; NULL when memory is out. repeated: asked for by
 * --repeat. */
json_t *report_create(const scene *s, isa level, const frames *f, bool repeated);

/* Each parameter of the scene under its path, as number, list or word; NULL when memory is out. */
json_t *report_params(const scene *s);

/* The value of one parameter from its text. */
json_t *report_value(const param *row, const char *text);

#endif
