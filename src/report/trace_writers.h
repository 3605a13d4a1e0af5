/* Writers of a ray tree, as text, JSON and a drawing. Errors of the stream stay in the stream, where the caller checks
 * them. Ownership: everything is borrowed. */
#pragma once

#include "render/inspect/probe.h"
#include <stdio.h>

typedef struct traced {
    const scene *s;
    const probe *p;
    const ray_tree *tree;
    const char *scene_path;
    bool for_page; /* JSON for the laboratory's page: further keys, so that it computes no optics */
} traced;

extern const char *const trace_kind_words[]; /* by ray_kind */
extern const char *const trace_end_words[];  /* by ray_end */

/* The angle of a ray from the normal. */
double trace_angle_deg(double cosine);

/* The rays only, without the line of the radiance; and one ray with its children as a JSON object, false if memory runs
 * out. */
void trace_write_text_rays(const traced *t, FILE *out);
bool trace_write_json_ray(const traced *t, FILE *out, int at);

status trace_write_text(const traced *t, FILE *out, diagnostic *why);
/* cuvette-trace(1) documents the fixed schema in JSON OUTPUT. */
status trace_write_json(const traced *t, FILE *out, diagnostic *why);
status trace_write_drawing(const traced *t, FILE *out, diagnostic *why);
