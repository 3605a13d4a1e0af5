/* The parameters that a table shows: all there are, or those of a scene with their values, or the few that a word fits.
 * Ownership: param_lines_release releases what param_lines_collect filled, also after an error. */
#ifndef CUVETTE_REPORT_PARAM_LINES_H
#define CUVETTE_REPORT_PARAM_LINES_H

#include "scene/model/params.h"

enum { PARAM_PATH_MAX = 400 };

typedef struct param_line {
    char *path, *value; /* the value is the default where there is no scene */
    const param *row;
} param_line;

typedef struct param_lines {
    param_line *line;
    size_t count, capacity;
} param_lines;

/* filter as in report/param_rows.h; s and filter may be NULL. */
status param_lines_collect(const scene *s, const char *filter, param_lines *out, diagnostic *why);
void param_lines_release(param_lines *all);

/* "render.depth"; "LIGHT.intensity" where the scene gives the name. */
char *param_lines_path(const param *row, char *text, size_t size);

#endif
