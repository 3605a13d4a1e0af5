/* A plane cut through a scene: where one medium ends and the next begins, by the rule of priorities, as lines to draw.
 * The medium (the solid that wins, probe_medium_at) is sampled on a grid, marching squares find the cells that a
 * boundary crosses (Lorensen and Cline 1987, in two dimensions), and bisection puts the lines' points onto it, more of
 * them where it bends.
 *
 * Boundaries are drawn between solids, also where two of them are of one medium and bend no light: a section shows what
 * is where. A layer thinner than a cell is found only where a grid point lies in it; the boundary is then that of its
 * neighbours.
 *
 * Ownership: a section is the caller's; zero it before its first use, release it with section_release. */
#pragma once

#include "render/inspect/probe.h"

/* The points origin + u e_u + v e_v for u in u0..u1, v in v0..v1; e_u and e_v are unit vectors at right angles. */
typedef struct section_plane {
    vec3 origin, e_u, e_v;
    double u0, u1, v0, v1; /* scene units */
} section_plane;

enum { SECTION_EDGE = -2 /* beyond the plane's extent */, SECTION_CELLS_MAX = 4096 };

/* A boundary: points first .. first + count - 1. a and b are the media on its two sides, a < b: indices in
 * scene.solids, RAY_OUTSIDE or SECTION_EDGE (the line is then a piece of the window's frame, which closes areas and is
 * not to be drawn). */
typedef struct section_line {
    size_t first, count;
    int a, b;
    int end[2]; /* numbers of the junctions that it leads from and to; -1: it is closed, its last point its first */
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

/* The area of one medium: its lines, in order and direction, as closed rings. */
typedef struct section_step {
    size_t line;
    bool backwards, starts_ring;
} section_step;

/* Writes *count steps, up to line_count. */
status section_area(const section *s, int medium, section_step *out, size_t *count, diagnostic *why);

/* A point of space in the plane's coordinates, projected at right angles; and back. */
section_point section_project(const section_plane *plane, vec3 p);
vec3 section_place(const section_plane *plane, double u, double v);
