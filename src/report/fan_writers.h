/* Writers of a fan of rays, as CSV, drawing and JSON, for `cuvette fan` and the laboratory. Errors of the stream stay
 * in the stream, where the caller checks them. Ownership: everything is borrowed; JSON is a new reference. */
#pragma once

#include "render/inspect/fan.h"
#include <jansson.h>
#include <math.h>
#include <stdio.h>

typedef struct fan_output {
    const scene *s;
    probe *p;
    const fan_rule *rule;
    const fan *f;
    bool complete_trees; /* draw complete ray trees, not only the refracted paths */
    bool as_csv;
} fan_output;

/* The end of a path: "sky", "cut", or the name of the opaque solid that it hit. */
const char *fan_end_text(const fan_output *t, const fan_ray *ray);

/* A coordinate rounded to 1e-9, so that rounding errors around zero print as 0. */
static inline double fan_shown(double value)
{
    return floor(value * 1e9 + 0.5) / 1e9 + 0.0;
}

status fan_write_csv(const fan_output *t, FILE *out, diagnostic *why);
status fan_write_drawing(const fan_output *t, FILE *out, diagnostic *why);
/* In the format of GET /api/fan (src/web/README.md); NULL when out of memory. */
json_t *fan_json(const fan_output *t);
