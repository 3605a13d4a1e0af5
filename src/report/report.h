/* The JSON account of a render: what `cuvette render --json` prints. The manual page names the keys. */
#ifndef CUVETTE_REPORT_REPORT_H
#define CUVETTE_REPORT_REPORT_H

#include "image/compare.h"
#include "measure/usage.h"
#include "render/core/renderer.h"
#include "scene/model/params.h"
#include <jansson.h>
#include <stdbool.h>

/* Frames of one scene, rendered one after another and measured. */
typedef struct frames {
    render_result *result;    /* of the last whole frame; a partial one if none was finished */
    bool whole;               /* all that were asked for are finished */
    size_t count;             /* finished frames */
    double *wall_s, *cpu_s;   /* of each finished frame, in order */
    usage spent;              /* over all the frames */
    hardware_counts hardware; /* over all the frames, pool threads included; -1 where absent */
} frames;

enum { REPORT_SCHEMA = 1 }; /* goes up when a key changes its meaning or goes away */

/* The account of measured frames, with at least one result; NULL when memory is out. repeated: asked for by
 * --repeat. */
json_t *report_create(const scene *s, isa level, const frames *f, bool repeated);

/* Each parameter of the scene under its path, as number, list or word; NULL when memory is out. */
json_t *report_params(const scene *s);

/* Adds how far two pictures lie apart; false when memory is out. */
bool report_comparison(json_t *o, const image_comparison *c);

/* The value of one parameter from its text. */
json_t *report_value(const param *row, const char *text);

#endif
