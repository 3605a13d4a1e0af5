/* Internals of the section, shared by section.c (the grid), section_march.c (marching squares) and section_chain.c
 * (lines from pieces, areas from lines). */
#pragma once

#include "render/inspect/section.h"

/* A piece of boundary within one cell, between two crossings of the grid's edges. */
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
    int nu, nv; /* grid points, including the frame of SECTION_EDGE around them */
    double du, dv;
    int *label;
    int edges;               /* number of edges; horizontal ones first */
    section_point *crossing; /* by edge, then by junction */
    int junctions, junction_capacity;
    int (*at)[2]; /* by edge: the pieces that end on it, -1 for none */
    piece *pieces;
    size_t piece_count, piece_capacity;
    bool failed; /* out of memory */
} cutter;

void section_add_point(cutter *c, section_point at);

/* The end of medium `own` between a, which is in it, and b, which is not. */
section_point section_bisect(const cutter *c, section_point a, section_point b, int own);

/* Adds the pieces of boundary in the cell whose low corner is grid point i, j. */
void section_march(cutter *c, int i, int j);

/* Joins all pieces into lines. */
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
