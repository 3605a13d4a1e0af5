/* Between a picture that looks right and one that is right: each metric measures a quantity of optics through the
 * tracer, by taking rays apart (render/inspect/probe.h), beside the same quantity from a textbook's closed form, which
 * theory.h computes with scalars and without the tracer's code. Angles in radians unless a unit says otherwise; lengths
 * in scene units.
 *
 * The scene has solids named vessel (a cup), rod (a box) and, unless it is empty, liquid (a cylinder that reaches into
 * the vessel's wall), upright and around one axis, as experiments/scenes/rod.yaml. Their indices, and the settings that
 * say what an interface does with light, are taken as they are; where a metric needs another arrangement of the same
 * media, such as a slab, it builds that from a copy.
 *
 * Three other scene_geometries are known by the names of their solids, and have metrics of their own: a prism (prism,
 * cut by the half-spaces left and right), a drop (a sphere whose name begins with drop), and two parallel plates
 * (plate1, plate2).
 *
 * Tolerances come from arithmetic: a unit in the last place of a double is 2.2e-16 of the value, of the film 5.7e-14;
 * the longest ways here take some ten interfaces, each of which may make such an error several times larger. None is a
 * wish. Ownership: values. Errors: STATUS_BAD_INPUT says which solid is not as it must be. */
#pragma once

#include "base/isa.h"
#include "base/status.h"
#include "scene/model/open.h"
#include <stdbool.h>

typedef struct realism_value {
    const char *metric; /* "lens.power" */
    const char *what;   /* one line; where theory is NaN, why the scene has none of it */
    const char *unit;   /* "" for ratios */
    double measured, theory, tolerance;
} realism_value;

enum { REALISM_MAX = 64 };
typedef struct realism_report {
    realism_value value[REALISM_MAX];
    int count;
} realism_report;

/* Is it a scene that the metrics know; one with curves? STATUS_BAD_INPUT says what it lacks. Quick. */
status realism_check(const scene *s, bool curves, diagnostic *why);

/* All metrics, in a fixed order: the same names for every scene. */
status realism_measure(const scene *s, isa level, realism_report *out, diagnostic *why);

/* Measures in one scene and asks theory about another one. With two scenes that differ a little it shows which metrics
 * see that. */
status realism_measure_against(const scene *traced, const scene *supposed, isa level, realism_report *out,
                               diagnostic *why);

/* |measured - theory|; NaN where theory is. */
double realism_error(const realism_value *v);
bool realism_is_defined(const realism_value *v);
/* Within the tolerance? False also for what is not defined, and for a measurement that found nothing. */
bool realism_passes(const realism_value *v);

/* Curves for figures: points (x, measured, theory). */
typedef enum realism_curve {
    REALISM_CURVE_FRESNEL_S, /* R_s of the vessel's outer surface against the angle of incidence, deg */
    REALISM_CURVE_FRESNEL_P,
    REALISM_CURVE_FRESNEL,    /* R of unpolarised light, as the tracer shares it out */
    REALISM_CURVE_DEVIATION,  /* deg, of the filled vessel as a lens against the ray's offset from its axis, scene units
                               */
    REALISM_CURVE_DEPTH,      /* what a slab of the vessel's medium lets through, against the depth of recursion */
    REALISM_CURVE_ABSORPTION, /* transmittance of the liquid (red) against length, m */
    REALISM_CURVE_EDGES,      /* displacement of the rod's left edge, px, against the liquid's index 1.00 .. 1.60 */
    REALISM_CURVE_COUNT
} realism_curve;

typedef struct realism_point {
    double x, measured, theory;
} realism_point;
enum { REALISM_POINTS_MAX = 1024 };
typedef struct realism_points {
    realism_point at[REALISM_POINTS_MAX];
    int count;
} realism_points;

/* "fresnel-s", "depth", ... */
const char *realism_curve_name(realism_curve which);
/* What x and the value are, with units: "angle of incidence, deg". */
const char *realism_curve_x(realism_curve which);
const char *realism_curve_y(realism_curve which);
status realism_trace_curve(const scene *s, isa level, realism_curve which, realism_points *out, diagnostic *why);
