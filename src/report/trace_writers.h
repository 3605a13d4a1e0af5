/* Writers of a ray tree, as text, JSON, CSV and a drawing; of the ray trees of a scene's beams; of the light that
 * beams cast on a screen; and of a section of the solids. cuvette-trace(1) documents the formats. Errors of the
 * stream stay in the stream, where the caller checks them. Ownership: everything is borrowed. */
#pragma once

#include "render/inspect/beams.h"
#include "render/inspect/fan.h"
#include "render/inspect/probe.h"
#include "render/inspect/section.h"
#include <jansson.h>
#include <math.h>
#include <stdio.h>

typedef struct traced {
    const scene *s;
    const probe *p;
    const ray_tree *tree;
    const char *scene_path;
    bool for_page; /* JSON for the laboratory's page, with more keys, so that the page computes no optics */
} traced;

/* What a ray is, and how it ends, in every output: "reflect", "cut_depth". */
const char *trace_kind_word(const ray_node *node);
const char *trace_end_word(const ray_node *node);
/* The angle between a ray and the normal, from its cosine. */
double trace_angle_deg(double cosine);

status trace_write_text(const traced *t, FILE *out, diagnostic *why);
/* cuvette-trace(1) documents the fixed schema in JSON OUTPUT. */
status trace_write_json(const traced *t, FILE *out, diagnostic *why);
/* A row for each ray; cuvette-trace(1) documents the columns in CSV OUTPUT. */
status trace_write_csv(const traced *t, FILE *out, diagnostic *why);
status trace_write_drawing(const traced *t, FILE *out, diagnostic *why);

typedef struct beam_output {
    const scene *s;
    isa level;
    const char *scene_path;
    size_t segments_max; /* STATUS_BAD_INPUT if the trees have more rays; 0: no limit */
    bool for_page;       /* as in traced */
} beam_output;

status beams_write_text(const beam_output *b, FILE *out, diagnostic *why);
status beams_write_json(const beam_output *b, FILE *out, diagnostic *why);
/* Without a limit of rays: each is written as it is traced. */
status beams_write_csv(const beam_output *b, FILE *out, diagnostic *why);

status beam_screen_write_json(const beam_screen *screen, FILE *out, diagnostic *why);

/* Writers of a fan of rays, as CSV, drawing and JSON, for `cuvette fan` and the laboratory. Errors of the stream stay
 * in the stream, where the caller checks them. Ownership: everything is borrowed; JSON is a new reference. */

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

/* A section of a scene, for `cuvette section` and the laboratory: a plane, and the part of it that is shown. Zero it
 * first. */
typedef enum section_view { SECTION_FRONT, SECTION_TOP, SECTION_SIDE, SECTION_VIEW_COUNT } section_view;
extern const char *const section_view_words[SECTION_VIEW_COUNT];

enum { SECTION_CELLS_USUAL = 400 };

typedef struct section_rule {
    section_view view; /* x to the right and y up; x and z; z and y */
    const char
        *through; /* the plane contains the axis (y) of this solid, drawn along the page if it lies; NULL: view */
    bool has_at, has_extent;
    vec3 at;          /* a point of the plane; default: the first visible beam's start, or a solid's centre */
    double extent[4]; /* u0, u1, v0, v1 in the plane's coordinates; default: what the plane cuts, and the beams */
    int cells;        /* as for section_cut */
} section_rule;

typedef struct section_output {
    const scene *s;
    const probe *p;
    isa level;
    const char *scene_path;
    section_plane plane;
    int cells;
} section_output;

/* Finds the plane and its extent. STATUS_BAD_INPUT: there is no such solid, or the extent or the cells are out of
 * range. */
status section_rule_resolve(const section_rule *rule, const scene *s, section_plane *out, diagnostic *why);
/* cuvette-section(1) documents the JSON. The drawing also has the rays of the beams. */
status section_write_json(const section_output *t, FILE *out, diagnostic *why);
status section_write_drawing(const section_output *t, FILE *out, diagnostic *why);
