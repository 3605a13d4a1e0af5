/* A panel of an SVG file: rays drawn to scale over the section of a scene's solids, with media, outlines, axes and
 * marks. Rays outside the plane are projected onto it orthogonally; everything is clipped to the window.
 *
 * Ownership: the probe, its scene and the stream are borrowed; diagram_begin allocates, diagram_end frees. */
#pragma once

#include "render/inspect/ray_line.h"
#include "scene/model/solids.h"
#include <stdio.h>

/* A bounding box in the plane's coordinates; empty while u0 > u1. */
typedef struct diagram_box {
    double u0, u1, v0, v1;
} diagram_box;
#define DIAGRAM_BOX_EMPTY                        \
    {                                            \
        HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL \
    }
void diagram_include(diagram_box *box, const section_plane *plane, vec3 p);
/* Includes the corners of the solid's bounding box; does nothing for a plane or a mesh. */
void diagram_include_solid(diagram_box *box, const section_plane *plane, const solid *one);
bool diagram_box_is_empty(const diagram_box *box);

/* The plane through a point with these axes. Its origin is the point of the plane nearest to the world origin, so that
 * its coordinate along a world axis equals the world coordinate. */
section_plane diagram_plane(vec3 point, vec3 e_u, vec3 e_v);

typedef struct diagram_frame {
    double left, top, width, height;
} diagram_frame; /* CSS pixels */

typedef struct diagram {
    FILE *out;
    const probe *p;
    const scene *s;
    section_plane plane; /* its extent is the window */
    section cut;
    diagram_frame frame;
    double scale; /* pixels per scene unit */
} diagram;

/* Fits the window around the box, with equal scales of both axes, and draws the media, their outlines, and the axes
 * with a caption above. */
status diagram_begin(diagram *d, FILE *out, const probe *p, const scene *s, const section_plane *plane,
                     const diagram_box *box, const diagram_frame *frame, const char *caption, diagnostic *why);
void diagram_end(diagram *d);

/* The line of a ray; a short stub if the ray was cut. */
ray_line diagram_line_of(const diagram *d, const ray_node *node);
/* A smaller weight (0..1) makes a line thinner and paler. dashes: an SVG stroke-dasharray, or NULL. */
void diagram_ray(const diagram *d, const ray_line *line, const char *color, double weight, const char *dashes);
/* An arrow head at the end of a ray's line, or at the edge of the window if the ray leaves it. */
void diagram_arrow(const diagram *d, const ray_line *line, const char *color, double weight);
/* A circle, unless its centre is outside the window. fill or stroke may be "none". */
void diagram_dot(const diagram *d, vec3 at, double radius_px, const char *fill, const char *stroke);
void diagram_cross(const diagram *d, vec3 at, double radius_px, const char *stroke);
bool diagram_shows(const diagram *d, vec3 at);

/* The dashes of a segment that was not traced further. */
#define DIAGRAM_CUT "0.5,3"
bool diagram_is_cut(const ray_node *node);
/* The throughput of the node, mean of its channels. */
double diagram_weight(const ray_node *node);

/* The legend of the media, in rows from left to right, the first at baseline y; returns the last baseline. out NULL:
 * only measures. */
double diagram_media_key(FILE *out, const probe *p, const scene *s, double left, double right, double y);
enum { DIAGRAM_ROW = 20 };

/* The refractive index of a solid at render.lambda_nm; 1 if it is unknown. */
double diagram_index(const scene *s, int solid);

/* Margins around a frame for its caption, tick labels and axis names, in CSS pixels. */
enum { DIAGRAM_ABOVE = 24, DIAGRAM_BELOW = 42, DIAGRAM_BEFORE = 54, DIAGRAM_BEHIND = 14 };

/* The SVG 1.1 writer. Coordinates are rounded to 0.01 px, so that equal drawings have equal bytes; there are no scripts
 * and no embedded fonts. Colours are those of plots/style.gp (Okabe and Ito). Errors of the stream stay in the stream,
 * where the caller checks them. Ownership: nothing is kept. */

#define SVG_BLUE "#0072b2"
#define SVG_VERMILLION "#d55e00"
#define SVG_PURPLE "#cc79a7"
#define SVG_ORANGE "#e69f00"
#define SVG_INK "#222222"
#define SVG_GREY "#777777"

/* The start of the document with a white background and a title, which may be NULL. Sizes are CSS pixels. */
void svg_begin(FILE *out, double width, double height, const char *title);
void svg_end(FILE *out);

/* stroke: the attributes of the line, such as "stroke=\"#777777\"". */
void svg_line(FILE *out, double x1, double y1, double x2, double y2, const char *stroke);

/* anchor: "start", "middle" or "end". y is the baseline. */
void svg_label(FILE *out, double x, double y, const char *anchor, const char *color, const char *text);

/* An entry of a legend, line and text; returns the x of the next entry, x + width. dashes may be NULL. */
double svg_key(FILE *out, double x, double y, const char *color, const char *dashes, const char *words, double width);

/* Writes text with XML entities; control characters become '?'. */
void svg_escape(FILE *out, const char *text);
