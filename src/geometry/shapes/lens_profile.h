/* The two sides of the shape lens as profiles: heights over the distance from the axis, and their limits. Pure; cannot
 * fail. */
#pragma once

#include "geometry/primitives/asphere.h"
#include "geometry/shapes/shape.h"

typedef struct lens_profile {
    even_asphere e;
    double conic, vertex;
    double clear;  /* radius up to which it reaches, a level ring beyond it; infinite without a ring */
    bool concave;  /* by its radius; a side with coefficients: see lens_form_of */
    bool aspheric; /* more than a conic */
    bool twisted;  /* not round */
} lens_profile;

/* k: 0 for side 1, 1 for side 2 */
lens_profile lens_profile_of(const solid_shape *s, int k);

static inline bool lens_is_flat(const lens_profile *e)
{
    return e->e.curvature == 0.0 && !e->aspheric;
}

static inline bool lens_has_ring(const lens_profile *e)
{
    return e->clear < HUGE_VAL;
}

static inline double lens_height_at(const lens_profile *e, double rho)
{
    const double r = rho < e->clear ? rho : e->clear;
    return e->vertex + asphere_sag(&e->e, r * r);
}

static inline double lens_rim(const solid_shape *s)
{
    return 0.5 * s->diameter;
}

/* The length of the bevel of a side along the radius, and, as it is at 45 degrees, along the rim; 0: none. */
static inline double lens_chamfer(const solid_shape *s, int k)
{
    return k == 0 ? s->chamfer_1 : s->chamfer_2;
}

/* The radius up to which a side with its ring reaches: that of the bevel's edge, or the rim's. */
static inline double lens_end(const solid_shape *s, int k)
{
    return lens_rim(s) - lens_chamfer(s, k);
}

/* The radius up to which a side is defined: the rim's, or less with a ring; and up to which it is seen. */
double lens_clear_of(const solid_shape *s, int k);
double lens_seen_of(const solid_shape *s, int k);
/* The height at lens_end, and that of the rim's edge. */
double lens_edge(const solid_shape *s, int k);
double lens_rim_edge(const solid_shape *s, int k);
/* The distance between the sides at a radius, and the radius where they are nearest to each other. */
double lens_gap_at(const solid_shape *s, double rho);
double lens_nearest_sides(const solid_shape *s);
/* The least distance between sides of any form, and the radius where that is. */
double lens_least_gap(const solid_shape *s, double *at);

/* The least and the largest height of a side up to lens_end. */
double lens_lowest_of(const solid_shape *s, int k);
double lens_highest_of(const solid_shape *s, int k);
/* The largest rho out + height up of a round side up to lens_end. */
double lens_reach_of(const solid_shape *s, int k, double out, double up);

/* --- for sides that are not round (lens_toric.c) --- */

/* The height of a side of any form. */
double lens_height_over(const lens_profile *e, double x, double z);
/* The largest d . p of a side. */
double lens_twisted_reach(const solid_shape *s, int k, vec3 d);
status lens_twisted_check(const solid_shape *s, int k, diagnostic *why);

/* The form of a side, seen from outside. The values up to LENS_THREE_TURNS are the most intervals in which a line is on
 * the inner side: for n turns by Rolle's theorem, as the second derivative of the height along any line changes its
 * sign at most 2 n times. LENS_TURNS: more than the kernels can bound. */
typedef enum lens_form {
    LENS_CONVEX = 1,
    LENS_CONCAVE,
    LENS_ONE_TURN,
    LENS_TWO_TURNS,
    LENS_THREE_TURNS,
    LENS_TURNS,
    LENS_STEEP
} lens_form;

/* The form of a side without its ring. A flat side is convex. within: the radius up to which a side with coefficients
 * is not steep, and turns no more than the kernels can bound. */
lens_form lens_form_of(const solid_shape *s, int k, double *within);

/* The most intervals of a line in the lens, from the forms of its sides. */
int lens_chords_of(const solid_shape *s, const lens_form form[2]);
/* The same for a side's curve along z, as a round side. */
lens_form lens_round_form(const solid_shape *s, int k, double *within);

/* The rings of a side's own piece and, unless that is 0, those of its edge; returns their number, at most 9. */
int lens_twisted_rings(const solid_shape *s, int k, int piece, shape_ring *out);
/* Moves the triangles of a disc with levels at 0 and 1, whose rim has the lens's radius, to the lens. */
status lens_twist_mesh(const solid_shape *s, mesh *m, diagnostic *why);
