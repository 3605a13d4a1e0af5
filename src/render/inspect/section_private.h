/* The section's inside, shared by section.c (the grid), section_march.c (one cell after another) and section_chain.c
 * (lines out of pieces, areas out of lines). */
#pragma once

#include "render/inspect/section.h"

/* Labels of the grid's points, with a frame of SECTION_EDGE around them; the crossings on its edges; and pieces between
 * them. */
typedef struct piece {
    int end[2]; /* crossings, or junctions (from `edges` on) */
    int a, b;
    size_t first, count; /* points between the ends, in the section's point list */
    bool used;
} piece;

typedef struct cutter {
    const probe *p;
    const section_plane *plane;
    section *out;
    int nu, nv; /* points, frame included */
    double du, dv;
    int *label;
    int edges;               /* how many; horizontal ones first */
    section_point *crossing; /* by edge, then by junction */
    int junctions, junction_capacity;
    int (*at)[2]; /* by edge: the pieces that end there, -1 for none */
    piece *pieces;
    size_t piece_count, piece_capacity;
    bool failed; /* out of memory */
} cutter;

void section_add_point(cutter *c, section_point at);

/* Where medium `own`, which is at a and not at b, ends. */
section_point section_bisect(const cutter *c, section_point a, section_point b, int own);

/* Adds the pieces of boundary in the cell with its low corner at grid point i, j. */
void section_march(cutter *c, int i, int j);

/* Makes lines of all pieces. */
void section_chain_all(cutter *c);

static inline int medium_at(const cutter *c, section_point at)
{
    return probe_medium_at(c->p, section_place(c->plane, at.u, at.v));
}

static inline section_point between(section_point a, section_point b, double share)
{
    return (section_point){a.u + (b.u - a.u) * share, a.v + (b.v - a.v) * share};
}

static inline section_point grid_point(const cutter *c, int i, int j)
{
    return (section_point){c->plane->u0 + (i - 1) * c->du, c->plane->v0 + (j - 1) * c->dv};
}

static inline int label(const cutter *c, int i, int j)
{
    return c->label[j * c->nu + i];
}

static inline int edge_across(const cutter *c, int i, int j)
{
    return j * (c->nu - 1) + i;
}

static inline int edge_up(const cutter *c, int i, int j)
{
    return c->nv * (c->nu - 1) + j * c->nu + i;
}
