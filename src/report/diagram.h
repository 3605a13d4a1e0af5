/* Rays in a plane of a scene, drawn to scale over the section of its solids: a panel of an SVG file with media,
 * outlines, axes, rays and marks. Rays out of the plane are projected onto it at right angles; what leaves the window
 * is clipped.
 *
 * Ownership: the probe, its scene and the stream are borrowed; diagram_begin takes memory, diagram_end releases it. */
#pragma once

#include "render/inspect/section.h"
#include "scene/model/solids.h"
#include <stdio.h>

/* A box in the plane's coordinates that grows; empty while u0 > u1. */
typedef struct diagram_box {
    double u0, u1, v0, v1;
} diagram_box;
#define DIAGRAM_BOX_EMPTY                        \
    {                                            \
        HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL \
    }
void diagram_include(diagram_box *box, const section_plane *plane, vec3 p);
/* The corners of the solid's bounding box; nothing for a plane, which has none. */
void diagram_include_solid(diagram_box *box, const section_plane *plane, const solid *one);
bool diagram_box_is_empty(const diagram_box *box);

/* The plane through a point with these axes. Its origin is its point nearest to the world's, so that along an axis of
 * the world its coordinate is the world's. */
section_plane diagram_plane(vec3 point, vec3 e_u, vec3 e_v);

typedef struct diagram_frame {
    double left, top, width, height;
} diagram_frame; /* CSS pixels */

typedef struct diagram {
    FILE *out;
    const probe *p;
    const scene *s;
    section_plane plane; /* its extent is the window's */
    section cut;
    bool *kept; /* by point of it: is needed at this scale */
    diagram_frame frame;
    double scale; /* pixels a scene unit */
} diagram;

/* Fits the window around the box, both at one scale, and draws the media, their outlines, and the axes with a caption
 * above. */
status diagram_begin(diagram *d, FILE *out, const probe *p, const scene *s, const section_plane *plane,
                     const diagram_box *box, const diagram_frame *frame, const char *caption, diagnostic *why);
void diagram_end(diagram *d);

/* A straight piece; weight 0..1 makes it thinner and paler. dashes: as SVG's stroke-dasharray, or NULL. */
void diagram_ray(const diagram *d, vec3 from, vec3 to, const char *color, double weight, const char *dashes);
/* The head of an arrow at the end of such a piece; nothing outside the window. */
void diagram_arrow(const diagram *d, vec3 from, vec3 to, const char *color, double weight);
/* A circle; fill or stroke may be "none". Nothing outside the window. */
void diagram_dot(const diagram *d, vec3 at, double radius_px, const char *fill, const char *stroke);
void diagram_cross(const diagram *d, vec3 at, double radius_px, const char *stroke);
bool diagram_shows(const diagram *d, vec3 at);

/* Of the dashes of what was not traced on. */
#define DIAGRAM_CUT "0.5,3"
bool diagram_is_cut(const ray_node *node);
/* What the node weighs, on the mean of its channels. */
double diagram_weight(const ray_node *node);

/* Samples of the media, in rows from left to right, the first at base line y; returns the last one's. out NULL: only
 * measures. */
double diagram_media_key(FILE *out, const probe *p, const scene *s, double left, double right, double y);
enum { DIAGRAM_ROW = 20 };

/* Room to leave around a frame for its caption, numbers and names of axes. */
enum { DIAGRAM_ABOVE = 24, DIAGRAM_BELOW = 42, DIAGRAM_BEFORE = 54, DIAGRAM_BEHIND = 14 };
