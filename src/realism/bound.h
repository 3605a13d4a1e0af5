/* Bounds of rounding errors, from which the metrics derive their tolerances; first order in the unit roundoff. The
 * errors of n operations on a value are within gamma_n = n u / (1 - n u) of it, u = 2^-53: Higham, Accuracy and
 * Stability of Numerical Algorithms, 2nd ed., lemma 3.1. Such errors are carried along a path as it is traced, a
 * running error analysis (Higham, 3.3), with the derivatives of Snell's and Fresnel's laws as condition numbers.
 *
 * Each bound is for a difference of two computations, of the tracer and of the closed form, or of a path and its
 * reversal: both make errors of that size. Angles in radians, lengths in scene units. Pure; cannot fail. */
#pragma once

#include "render/inspect/probe.h"

/* Half a unit of the film (render/plan/film.h): the rounding error of one contribution to a pixel. */
#define BOUND_FILM 0x1p-45

/* Operations that a datum passes through, at most: the intersection with a surface and its normal; the refraction or
 * reflection of a direction, with tidying; Fresnel's equations; a closed form or a function of the C library. */
enum { BOUND_HIT = 32, BOUND_TURN = 24, BOUND_REFLECTANCES = 12, BOUND_FORM = 8 };

/* gamma_n, and 2 gamma_n for a difference. */
double bound_gamma(int operations);
double bound_difference(int operations);

/* The errors of reflectances for an angle of incidence that is off by up to aside. Near the critical angle, where their
 * slope is infinite, an error e of cos^2 t is an error min(e / cos t, sqrt(e)) of cos t. */
typedef struct reflectance_bound {
    double R_s, R_p, R;
} reflectance_bound;
reflectance_bound bound_reflectances(double angle, double aside, double n_from, double n_to);

/* The errors of a path at the end of its last ray: distance across the ray, direction, and relative error of the
 * throughput. At each surface the errors so far are multiplied by the derivatives of the law there, and the surface's
 * errors are added; the error of a point is relative to the lengths of the vectors from which it is computed.
 * curvature: the largest of any surface. NaN if the tree is empty. */
typedef struct path_bound {
    double across, heading, weight;
} path_bound;
path_bound bound_path(const ray_tree *tree, double curvature);

/* The error of the direction at the end of a path in a plane through the common centre of round surfaces. Bouguer's
 * invariant, n times the ray's offset from the centre, preserves an error, so that errors add up instead of being
 * multiplied: an error of the offset changes each angle at a surface, asin(offset / radius). The direction of the first
 * ray is exact. NaN if the tree is empty. */
double bound_around(const ray_tree *tree, vec3 center);
