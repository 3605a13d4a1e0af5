/* Metrics of optical correctness: each compares a quantity measured with the tracer, by inspecting rays
 * (render/inspect/probe.h), with the closed form of a textbook, which theory.h computes with scalars and without the
 * tracer's code. Angles in radians unless a unit is given; lengths in scene units.
 *
 * The scene has solids named vessel (a cup), rod (a box) and, unless it is empty, liquid (a cylinder that reaches into
 * the vessel's wall), vertical and coaxial, as in experiments/scenes/rod.yaml. Their indices, and the settings of the
 * behaviour at interfaces, are used unchanged; a metric that needs other solids of the same media, such as a slab,
 * builds them in a copy.
 *
 * Three other kinds of scenes are identified by the names of their solids, and have their own metrics: a prism (prism,
 * cut by the half-spaces left and right), a drop (a sphere whose name begins with drop), and two parallel plates
 * (plate1, plate2). Two polarisers (polariser, analyser), a coin in a cup (cup, coin, liquid), an arrow behind a glass
 * (vessel, liquid, arrow) and a thin film (film1) have a curve each.
 *
 * Tolerances are computed for each measurement from bounds of its rounding errors (bound.h): of doubles, of the film's
 * units, and of bisections, carried along the path. The largest of several errors is the one that is largest in units
 * of its tolerance. Ownership: values. Errors: STATUS_BAD_INPUT names the unsuitable solid. */
#pragma once

#include "base/isa.h"
#include "base/status.h"
#include "scene/model/open.h"
#include <stdbool.h>

typedef struct realism_value {
    const char *metric; /* "lens.power" */
    const char *what;   /* one line; if theory is NaN, why it is undefined for the scene */
    const char *unit;   /* "" for ratios */
    double measured, theory, tolerance;
} realism_value;

enum { REALISM_MAX = 64 };
typedef struct realism_report {
    realism_value value[REALISM_MAX];
    int count;
} realism_report;

/* Whether the metrics (curves: the curves of the vessel) support the scene. STATUS_BAD_INPUT describes what is missing.
 * Fast. */
status realism_check(const scene *s, bool curves, diagnostic *why);

/* All metrics, in a fixed order: the same names for every scene of a kind. */
status realism_measure(const scene *s, isa level, realism_report *out, diagnostic *why);

/* One metric. NaN in measured and theory if it is undefined; STATUS_BAD_INPUT if the scene has none of that name. */
status realism_measure_one(const scene *s, isa level, const char *metric, realism_value *out, diagnostic *why);

/* Measures in one scene and evaluates theory for another one. Two slightly different scenes show which metrics detect
 * the difference. */
status realism_measure_against(const scene *traced, const scene *supposed, isa level, realism_report *out,
                               diagnostic *why);

/* |measured - theory|; NaN if one of them is. */
double realism_error(const realism_value *v);
bool realism_is_defined(const realism_value *v);
/* Whether the error is within the tolerance. False also for undefined metrics, and for a failed measurement. */
bool realism_passes(const realism_value *v);

/* Curves for figures: points (x, measured, theory). */
typedef enum realism_curve {
    REALISM_CURVE_FRESNEL_S, /* R_s of the vessel's outer surface by the angle of incidence, deg */
    REALISM_CURVE_FRESNEL_P,
    REALISM_CURVE_FRESNEL,    /* R of unpolarised light, as used by the tracer */
    REALISM_CURVE_DEVIATION,  /* deviation by the filled vessel, deg, by the ray's offset from its axis, scene units */
    REALISM_CURVE_DEPTH,      /* transmittance of a slab of the vessel's medium by recursion depth */
    REALISM_CURVE_ABSORPTION, /* transmittance of the liquid (red) by length, m */
    REALISM_CURVE_EDGES,      /* displacement of the rod's left edge, px, by the liquid's index 1.00 .. 1.60 */
    /* The curves before this one are those that a study keeps. */
    REALISM_CURVE_STUDY_COUNT,
    REALISM_CURVE_MIRROR =
        REALISM_CURVE_STUDY_COUNT, /* R of the liquid's surface from below by the angle of incidence, deg */
    REALISM_CURVE_APPARENT_DEPTH,  /* apparent depth in the liquid, over depth, by line of sight, deg */
    /* Curves of scenes other than the vessel. */
    REALISM_CURVE_PRISM,   /* deviation by a prism by the angle of incidence, deg */
    REALISM_CURVE_RAINBOW, /* angle from the antisolar point, deg, by the ray's offset over the drop's radius */
    REALISM_CURVE_PLATES,  /* transmittance of two plates without reflections by the angle of incidence, deg */
    REALISM_CURVE_MALUS,   /* transmittance of two polarisers, and a plate between them, by the analyser's angle, deg */
    REALISM_CURVE_COIN,    /* depth of liquid at which a coin appears over a cup's rim by the liquid's index */
    REALISM_CURVE_ARROW,   /* where a line of sight through a glass meets a plane behind it, over the place without the
                            * glass, by the plane's distance from the axis, scene units */
    REALISM_CURVE_SOAP,    /* reflectance of a thin film by its thickness, nm */
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
/* Labels of x and of the value, with units: "angle of incidence, deg". */
const char *realism_curve_x(realism_curve which);
const char *realism_curve_y(realism_curve which);
/* The parameter on the x axis, such as "liquid.ior"; NULL if x is not a parameter. */
const char *realism_curve_parameter(realism_curve which);
/* Whether the scene has the solids of a curve. STATUS_BAD_INPUT describes what is missing. Fast. */
status realism_check_curve(const scene *s, realism_curve which, diagnostic *why);
status realism_measure_curve(const scene *s, isa level, realism_curve which, realism_points *out, diagnostic *why);
