/* The part of reading the section `fit` that read_targets.c does for read.c: values, names, quantities and targets.
 * Private to this folder. */
#pragma once

#include "scene/file/document.h"
#include "study/fit/fit.h"

typedef struct fit_reading {
    fit *f;
    const document *d;
    vec3 at, normal; /* of the section's screen; NaN, zero: not given */
    diagnostic *why;
} fit_reading;

/* node_error at a node. */
#define WRONG(r, node, remedy, ...) node_error((r)->d, node, (r)->why, remedy, __VA_ARGS__)

/* A missing node leaves *out unchanged. */
status fit_read_real(const fit_reading *r, const node *map, const char *key, double least, double most, double *out);
/* A list of 2 or 3 numbers. */
status fit_read_reals(const fit_reading *r, const node *n, const char *what, size_t count, double *out);
/* form: the remedy if n is no map. */
status fit_check_map(const fit_reading *r, const node *n, const char *what, const char *form, const char *const *keys,
                     size_t count);
/* The name of a column must be free. */
status fit_check_column(const fit_reading *r, const node *at);
/* A path must not be set by the study or by a parameter. */
status fit_check_unset(const fit_reading *r, const node *at, const char *path);

status fit_read_screen(const fit_reading *r, const node *screen, vec3 *at, vec3 *normal);
status fit_read_target(const fit_reading *r, const node *name, const node *map);
/* minimise: spot_rms, or {quantity: spot_rms, beam: axis} */
status fit_read_extreme(const fit_reading *r, const node *n);
