/* Shared code of all metrics; private to this folder. A metric is a function that adds its values to the report; it
 * adds the same names for every scene, with theory NaN and the reason if a value is undefined. Ownership: trial_start
 * becomes the owner of the scene, also if it fails; trial_end frees everything. */
#pragma once

#include "realism/realism.h"
#include "realism/setup.h"
#include "render/inspect/probe.h"
#include <math.h>

#define DEGREE (M_PI / 180.0)

typedef struct metrics {
    const scene *traced, *supposed; /* the scene to measure; the scene for theory */
    setup at, theory_at;            /* of these scenes */
    isa level;
    realism_report *report;
} metrics;

status realism_edges(const metrics *m, diagnostic *why); /* edges.c: edges of the rod in the image, magnification */
status realism_water_line(const metrics *m, diagnostic *why); /* apparent.c: kink of the leaning rod */
status realism_lens(const metrics *m, diagnostic *why);       /* lens.c: deviation, power, dispersion */
status realism_interfaces(const metrics *m, diagnostic *why); /* flat.c: critical angles, Fresnel */
status realism_balance(const metrics *m, diagnostic *why);    /* energy.c: white furnace */
status realism_slab(const metrics *m, diagnostic *why);       /* flat.c: convergence with depth */
status realism_gap(const metrics *m, diagnostic *why);        /* flat.c: empty gaps, and solids far away */
status realism_radiance(const metrics *m, diagnostic *why);   /* energy.c: radiance across a flat surface */
status realism_absorption(const metrics *m, diagnostic *why); /* energy.c: Beer and Lambert */
status realism_reversal(const metrics *m, diagnostic *why);   /* lens.c: reversed paths */

/* Metrics of scenes other than the vessel, and whether a scene has the solids for them. Only the scenes, the level and
 * the report of m are used. */
bool prism_is_there(const scene *s);
status realism_prism(const metrics *m, diagnostic *why); /* dispersion.c: minimum deviation */
bool drop_is_there(const scene *s);
status realism_drop(const metrics *m, diagnostic *why); /* dispersion.c: the first rainbow */
bool stack_is_there(const scene *s);
status realism_stack(const metrics *m, diagnostic *why); /* plates.c: a stack of two plates */

void metrics_add(const metrics *m, realism_value value);

/* The pair with the largest difference in units of its tolerance. */
typedef struct worst_pair {
    double measured, theory, tolerance;
    bool any;
} worst_pair;
#define WORST_NONE ((worst_pair){NAN, NAN, NAN, false})
void worst_pair_add(worst_pair *w, double measured, double theory, double tolerance);

/* Measurements and curves for realism.c. */
status lens_deviation(probe *p, ray_tree *tree, const setup *at, double offset, double *radians, diagnostic *why);
typedef struct interface_reflectances {
    double R_s, R_p, R;
} interface_reflectances;
status interface_measure(probe *p, ray_tree *tree, double start_y, double angle, interface_reflectances *out,
                         diagnostic *why);
status slab_measure(const metrics *m, int depth, bool polarised, double *transmitted, diagnostic *why);
double slab_theory(const metrics *m, int depth, bool polarised);
void curve_add(realism_points *out, double x, double measured, double theory);
status prism_curve(const metrics *m, realism_points *out, diagnostic *why);
status drop_curve(const metrics *m, realism_points *out, diagnostic *why);
status stack_curve(const metrics *m, realism_points *out, diagnostic *why);
bool filters_are_there(const scene *s);
status filters_curve(const metrics *m, realism_points *out, diagnostic *why);
bool coin_is_there(const scene *s);
status coin_curve(const metrics *m, realism_points *out, diagnostic *why);
bool arrow_is_there(const scene *s);
status arrow_curve(const metrics *m, realism_points *out, diagnostic *why);
bool soap_is_there(const scene *s);
status soap_curve(const metrics *m, realism_points *out, diagnostic *why);
scene *attenuation_scene(const scene *s, const setup *at);
status edges_displacement(const metrics *m, double measured[2], double theory[2], diagnostic *why);

/* A scene and a tracer for it. */
typedef struct trial {
    scene *s;
    probe *p;
    ray_tree tree;
} trial;
status trial_start(trial *t, scene *owned, isa level, diagnostic *why);
void trial_end(trial *t);

/* Transmittances after a length of the liquid, in a trial of attenuation_scene; and the maximum length. */
status attenuation_point(trial *t, const setup *at, double length, double transmittance[3], diagnostic *why);
double attenuation_reach(const trial *t, const setup *at);

/* Index of a solid's medium relative to the surroundings; NaN if its coefficients are invalid. */
double relative_index(const scene *s, int at, double lambda_nm);

/* The minimum between low and high of a function with a single minimum there: golden section search (Kiefer,
 * "Sequential minimax search for a maximum", Proc. AMS 4, 1953). As the function is stationary there, its value is good
 * to rounding. */
double least_value(double (*f)(void *context, double x), void *context, double low, double high);

/* bisect: the position, to 1e-12, between `from`, where the answer is `before`, and `to`, where it is not. find_edges:
 * first and last position between `from` and `to` where something is visible; changes are searched in `steps` steps. */
typedef bool seen_at(void *context, double x);
double bisect(seen_at *seen, void *context, double from, double to, bool before);
bool find_edges(seen_at *seen, void *context, double from, double to, int steps, double edge[2]);

/* Whether the path from origin, refracted if possible, ends on solid `which` without a reflection; upright: and only
 * through vertical surfaces. A failure of the tracer is stored in *code. */
bool trial_meets(trial *t, vec3 origin, vec3 direction, int which, bool upright, status *code, diagnostic *why);

/* The edges of solid `which` in a line of the image: the first and last px whose camera path meets it as in
 * trial_meets. NaN if it has no edges. */
status trial_edges(trial *t, int which, bool upright, double py, const double range[2], int steps, double edge[2],
                   diagnostic *why);

/* Bound of the position, across the ray, at which the path through an edge from trial_edges meets the solid. The path
 * is moved by EDGE_INSIDE_PX towards the other edge. NaN if it does not meet the solid. */
#define EDGE_INSIDE_PX 1e-6
status trial_edge_bound(trial *t, int which, double py, const double edge[2], int side, double curvature,
                        double *across, diagnostic *why);

/* The error of `bisect` at a position, px or scene units: half its last interval, and the rounding of the ends. */
double bisect_width(double at);

/* Adds an angle at the F, d and C lines and at render.lambda_nm. difference: measured, theory and tolerance of F minus
 * C. none is the reason if there is no theory. */
typedef status at_line_call(const metrics *m, double lambda_nm, double *measured, double *theory, double *tolerance,
                            diagnostic *why);
status metrics_at_lines(const metrics *m, const char *const names[4], const char *const what[4], const char *none,
                        at_line_call *at_line, double difference[3], diagnostic *why);

/* A copy at a wavelength, with a depth and a least weight that do not cut off the path of such an angle; NULL if memory
 * runs out. */
scene *arrange_at(const scene *s, double lambda_nm);

/* --- bounds of rounding errors (bound.c) ---
 *
 * Bounds of rounding errors, from which the metrics derive their tolerances; first order in the unit roundoff. The
 * errors of n operations on a value are within gamma_n = n u / (1 - n u) of it, u = 2^-53: Higham, Accuracy and
 * Stability of Numerical Algorithms, 2nd ed., lemma 3.1. Such errors are carried along a path as it is traced, a
 * running error analysis (Higham, 3.3), with the derivatives of Snell's and Fresnel's laws as condition numbers.
 *
 * Each bound is for a difference of two computations, of the tracer and of the closed form, or of a path and its
 * reversal: both make errors of that size. Angles in radians, lengths in scene units. Pure; cannot fail. */

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
