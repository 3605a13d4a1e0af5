/* A fan of rays as CSV and as a drawing. Each writes all of it to a stream, whose errors are left in the stream.
 * Ownership: everything is borrowed. */
#pragma once

#include "render/inspect/fan.h"
#include <stdio.h>

typedef struct fanned {
    const scene *s;
    probe *p;
    const fan_rule *rule;
    const fan *f;
    bool whole_trees; /* drawn in place of the refracted ways alone */
    bool as_csv;
} fanned;

/* A coordinate without what rounding leaves of a zero, for a line of text. */
static inline double fan_shown(double value)
{
    return floor(value * 1e9 + 0.5) / 1e9 + 0.0;
}

status fan_write_csv(const fanned *t, FILE *out, diagnostic *why);
status fan_write_drawing(const fanned *t, FILE *out, diagnostic *why);
