/* The section: a plane cut through a scene, which shows the boundaries between media, by the rule of priorities, as
 * lines to draw. The medium (the solid with the highest priority, probe_medium_at) is sampled on a grid, marching
 * squares find the cells that a boundary crosses (Lorensen and Cline 1987, in two dimensions), and bisection moves the
 * lines' points onto it, with more points where it bends.
 *
 * Boundaries are drawn between solids, even between two of the same medium, which do not bend light: a section shows
 * the extent of each solid. A layer thinner than a cell is found only where a grid point is in it; elsewhere the
 * section shows one boundary between the neighbours of the layer.
 *
 * Ownership: the caller owns a section; zero it before its first use, release it with section_release. */
#pragma once

#include "render/inspect/probe.h"

/* The points origin + u e_u + v e_v for u in u0..u1, v in v0..v1; e_u and e_v are unit vectors at right angles. */
typedef struct section_plane {
    vec3 origin, e_u, e_v;
    double u0, u1, v0, v1; /* scene units */
} section_plane;

enum { SECTION_EDGE = -2 /* outside the plane's extent */, SECTION_CELLS_MAX = 4096 };

/* A boundary: points first .. first + count - 1. a and b are the media on its two sides, a < b: indices in
 * scene.solids, RAY_OUTSIDE or SECTION_EDGE (the line is then part of the window's frame, which closes areas and is not
 * drawn). */
typedef struct section_line {
    size_t first, count;
    int a, b;
    int end[2]; /* the line's first and last junction; -1: the line is closed, its last point equals its first */
} section_line;

typedef struct section_point {
    double u, v;
} section_point;

typedef struct section {
    section_point *point;
    section_line *line;
    size_t point_count, line_count, point_capacity, line_capacity;
} section;

/* cells: along the longer side, 2 .. SECTION_CELLS_MAX. */
status section_cut(const probe *p, const section_plane *plane, int cells, section *out, diagnostic *why);
void section_release(section *s);

/* One step around the area of a medium: a line and its direction. The steps form closed rings. */
typedef struct section_step {
    size_t line;
    bool backwards, starts_ring;
} section_step;

/* Writes the steps around the area of a medium, an index as in section_line, to out, which has room for s->line_count
 * steps, and their number to *count. */
status section_area(const section *s, int medium, section_step *out, size_t *count, diagnostic *why);

/* Drops the points that the lines do not need within the tolerance, in scene units (Douglas and Peucker 1973). */
status section_simplify(section *s, double tolerance, diagnostic *why);

/* section_project: the orthogonal projection of a point onto the plane's coordinates; section_place: the inverse. */
section_point section_project(const section_plane *plane, vec3 p);
vec3 section_place(const section_plane *plane, double u, double v);
