/* A fit: parameters of a study's scene are chosen so that measured quantities meet targets, or so that one quantity is
 * least or greatest. read.c and read_targets.c read the section `fit` of a study file, measure.c measures the
 * quantities, rows.c keeps every evaluation as a row of results/<study>/fit.csv, search.c lets NLopt choose the points,
 * damped.c does so by derivatives, and spread.c adds intervals and tolerances at the best one.
 *
 * Everything is a function of the study file, the scene and the build: the same rows in the same order, for any number
 * of threads. A fit that is run again requests the same points; those with a row are not measured again, so that a
 * killed fit goes on where it stopped. Ownership: fit_destroy releases a fit, fit_run_end a run. Errors of the section
 * are located in the study file. Only the program links this folder and NLopt; the library does not. */
#pragma once

#include "job/job.h"
#include "job/quantities.h"
#include "scene/data/document.h"
#include "study/rows/rows.h"
#include "study/study.h"

enum { FIT_PARAMETERS_MAX = 16, FIT_TARGETS_MAX = 128, FIT_STAGES_MAX = 8, FIT_EVALUATIONS_MAX = 1000000 };

/* --- what is fitted --- */

/* The parameter's value x sets `path` to offset + factor x, or to its reciprocal. */
typedef struct fit_drive {
    char *path;
    double offset, factor;
} fit_drive;

typedef struct fit_parameter {
    char *name; /* the column; without `sets` also the path */
    double from, to, start;
    fit_drive *drives;
    size_t drive_count;
    bool reciprocal; /* a curvature sets a radius: 1 / v, and 0, which is flat, where that is beyond the path's range */
} fit_parameter;

typedef enum fit_source {
    FIT_FRAME,    /* a quantity of a frame (job/quantities.h) that is equal in all frames of a scene */
    FIT_RADIANCE, /* of the film: one pixel, or the mean of all */
    FIT_REALISM,  /* a metric of realism/realism.h, as traced */
    FIT_BEAMS     /* of the rays of beams */
} fit_source;

/* Quantities of the last segments of the beams' refracted paths, which `fan` follows too, at a screen: the plane
 * through `at` with the normal. Only rays that reach the screen, or leave the scene, count; rays have the weight of
 * their power at the start, since a spot diagram shows geometry, not losses. */
typedef enum fit_beam_quantity {
    FIT_FOCUS,        /* signed distance from the screen, along its normal, of the least rms radius */
    FIT_FOCUS_RMS,    /* that radius */
    FIT_FOCAL_LENGTH, /* -dh / du: height at the start over slope at the end, by least squares; for parallel rays */
    FIT_POWER,        /* its reciprocal, which flat glass has, too: -du / dh, by least squares */
    FIT_SPOT_RMS,     /* rms distance on the screen from the rays' mean */
    FIT_SPOT_RADIUS,  /* the largest such distance */
    FIT_SPOT_U,       /* the rays' mean on the screen: horizontally (x on a horizontal screen), */
    FIT_SPOT_V,       /* and at right angles to that */
    FIT_RECEIVED,     /* fraction of the beams' power that reaches the screen */
    FIT_BEAM_QUANTITY_COUNT
} fit_beam_quantity;
extern const char *const fit_beam_words[FIT_BEAM_QUANTITY_COUNT]; /* "focus", ... */

typedef struct fit_measure {
    fit_source source;
    char *name;            /* "edges.left", "hits.rod", "focus", "radiance" */
    long line, column;     /* of its name in the study file */
    const quantity *frame; /* FIT_FRAME */
    int solid;             /* for a quantity by solid; -1 */
    int pixel[2];          /* FIT_RADIANCE; -1: the whole film */
    int channel;           /* 0 .. 2; -1: the mean */
    fit_beam_quantity beam_quantity;
    uint64_t *beams;  /* a bit for each beam of the scene */
    double lambda_nm; /* only rays of this wavelength; 0: all */
    vec3 at, normal;  /* of the screen; the normal is a unit vector */
    size_t setting;   /* index in fit.settings */
} fit_measure;

typedef struct fit_target {
    char *name; /* the column */
    fit_measure of, minus;
    bool has_minus; /* the measured value is the difference */
    double value, weight;
    double sigma; /* standard deviation of the value, weight = 1 / sigma^2; 0: a weight was given */
} fit_target;

typedef enum fit_goal { FIT_TARGETS, FIT_MINIMISE, FIT_MAXIMISE } fit_goal;

typedef enum fit_method {
    FIT_NELDER_MEAD,
    FIT_SBPLX,
    FIT_BOBYQA,
    FIT_COBYLA,
    FIT_DAMPED, /* least squares by derivatives, not of NLopt: damped.c */
    FIT_DIRECT, /* global, without random numbers */
    FIT_CRS,    /* global, with the seed */
    FIT_METHOD_COUNT
} fit_method;
extern const char *const fit_method_words[FIT_METHOD_COUNT];

typedef struct fit {
    study *s;
    fit_goal goal;
    fit_parameter parameters[FIT_PARAMETERS_MAX];
    size_t parameter_count;
    fit_target targets[FIT_TARGETS_MAX]; /* one for FIT_MINIMISE and FIT_MAXIMISE */
    size_t target_count;
    study_point settings[2 * FIT_TARGETS_MAX + 2]; /* different `set` of the targets; the first is empty */
    size_t setting_count;
    fit_method stages[FIT_STAGES_MAX]; /* each starts at the best point so far */
    size_t stage_count;
    long evaluations; /* most of each stage */
    double precision; /* a stage ends when a step is below this fraction of every parameter's range */
    double step;      /* half the distance of central differences, as a fraction of the range */
    double worsening; /* of the merit, which defines tolerances; 0: the default (fit_worsening) */
    bool linear;      /* intervals are linear; else of the profile (spread.c) */
    uint64_t seed;
    uint64_t identity; /* of what is measured: the scene, its files, parameters and quantities; not of the search */
} fit;

/* Reads a study with a section `fit`, and tries its parameters and quantities on the scene. */
status fit_read(const char *path, fit **out, diagnostic *why);
/* Reads it from memory; name is used in diagnostics, and the scene's path is relative to its folder. */
status fit_read_text(const char *name, const char *text, size_t size, fit **out, diagnostic *why);
void fit_destroy(fit *f);

/* --- measuring: measure.c --- */

/* The study's scene with the parameters at x and a setting; its files are not loaded. */
status fit_scene(const fit *f, const double *x, size_t setting, scene **out, diagnostic *why);
/* One value for each target. STATUS_BAD_INPUT if the scene at x is invalid; NaN for what cannot be measured there. */
status fit_measure_at(const fit *f, job *frames, const double *x, double *values, diagnostic *why);
/* The merit, which the search makes least: the sum of weight (measured - value)^2, or the quantity, or its negative. */
double fit_merit(const fit *f, const double *values);

/* --- running: rows.c, search.c, spread.c --- */

typedef struct fit_evaluation {
    double x[FIT_PARAMETERS_MAX], values[FIT_TARGETS_MAX];
    double merit; /* NaN: not measurable there */
} fit_evaluation;

typedef struct fit_options {
    const char *results; /* NULL: no rows are written or read */
    /* Called after each evaluation. May be NULL. */
    void (*progressed)(void *context, size_t evaluations, double best);
    void *context;
} fit_options;

typedef struct fit_run fit_run;
status fit_run_begin(const fit *f, const fit_options *options, fit_run **out, diagnostic *why);
void fit_run_end(fit_run *r);
/* The evaluation at x: of this run, of an earlier one's row, or a new one, whose row is on disk when this returns.
 * STATUS_INTERRUPTED without a row. *out lives as long as the run. reason: why it is not measurable; may be NULL. */
status fit_evaluate(fit_run *r, const char *stage, const double *x, const fit_evaluation **out, diagnostic *reason,
                    diagnostic *why);
size_t fit_run_evaluations(const fit_run *r); /* different points that this run has requested */
size_t fit_run_new(const fit_run *r);         /* those that it measured */
size_t fit_run_set_aside(const fit_run *r);   /* rows of other builds, scenes or quantities, or edited, not used */
const fit *fit_run_of(const fit_run *r);

typedef double fit_matrix[FIT_PARAMETERS_MAX][FIT_PARAMETERS_MAX];

/* Of each target by each parameter; at a bound the difference is one-sided. */
typedef struct fit_derivatives {
    double by[FIT_TARGETS_MAX][FIT_PARAMETERS_MAX];
    bool at_bound[FIT_PARAMETERS_MAX];
} fit_derivatives;

typedef struct fit_result {
    fit_evaluation best;
    const char *ended;                /* why the last stage ended */
    fit_derivatives derivative;       /* at the best point */
    long freedom;                     /* targets minus parameters */
    bool has_interval;                /* the parameters are determined, and their errors known */
    double error[FIT_PARAMETERS_MAX]; /* standard error */
    double half[FIT_PARAMETERS_MAX];  /* half the 95 % interval, linear in the parameters */
    fit_matrix correlation;
    bool has_profile[FIT_PARAMETERS_MAX];    /* false: not wanted, errors not known, or too many evaluations */
    double profile[FIT_PARAMETERS_MAX][2];   /* ends of the 95 % interval of the profile */
    bool open[FIT_PARAMETERS_MAX][2];        /* that end is only the parameter's bound */
    size_t profile_lacking;                  /* parameters without a profile for want of evaluations */
    fit_evaluation better;                   /* the best point that a profile found */
    bool has_better;                         /* it is clearly better than best: the search missed it */
    double worsening;                        /* of the merit, for the tolerances; 0: none */
    double tolerance[FIT_PARAMETERS_MAX][2]; /* changes, down and up, at which it is reached; NaN: not within bounds */
} fit_result;

/* Lets the stages find the best point. The start must be measurable: otherwise STATUS_BAD_INPUT with the reason. */
status fit_search(fit_run *r, fit_result *out, diagnostic *why);
#define FIT_NONE_HELD SIZE_MAX
/* Damped least squares, for targets only: improves *best. The parameter `held` stays. It ends when no step is expected
 * to improve the merit by more than `enough`. */
status fit_damped(fit_run *r, const char *stage, size_t held, double enough, fit_evaluation *best, const char **ended,
                  diagnostic *why);
/* The derivatives at x: evaluations at a step on both sides of each parameter; 0 by the one that is held. */
status fit_jacobian(fit_run *r, const char *stage, size_t held, const double *x, fit_derivatives *out, diagnostic *why);
/* The inverse of a symmetric positive definite matrix, whose diagonal is about 1, by Gauss and Jordan; false, with a
 * meaningless, if it is singular to working precision. */
bool fit_invert(size_t n, fit_matrix a);
/* Completes the result of fit_search. */
status fit_spread(fit_run *r, fit_result *out, diagnostic *why);

/* --- the dictionary of fit.csv: rows.c --- */

row_columns fit_each_column;

/* The part of reading the section `fit` that read_targets.c does for read.c: values, names, quantities and targets.
 * Private to this folder. */

typedef struct fit_reading {
    fit *f;
    const document *d;
    vec3 at, normal; /* of the section's screen; NaN, zero: not given */
    diagnostic *why;
} fit_reading;

/* node_error at a node. */
#define WRONG(r, node, remedy, ...) node_error((r)->d, node, (r)->why, remedy, __VA_ARGS__)

/* A missing node leaves *out unchanged. */
status fit_read_real(const fit_reading *r, const node *map, const char *key, double least, double most, double *out);
/* A list of 2 or 3 numbers. */
status fit_read_reals(const fit_reading *r, const node *n, const char *what, size_t count, double *out);
/* form: the remedy if n is no map. */
status fit_check_map(const fit_reading *r, const node *n, const char *what, const char *form, const char *const *keys,
                     size_t count);
/* The name of a column must be free. */
status fit_check_column(const fit_reading *r, const node *at);
/* A path must not be set by the study or by a parameter. */
status fit_check_unset(const fit_reading *r, const node *at, const char *path);

status fit_read_screen(const fit_reading *r, const node *screen, vec3 *at, vec3 *normal);
status fit_read_target(const fit_reading *r, const node *name, const node *map);
/* minimise: spot_rms, or {quantity: spot_rms, beam: axis} */
status fit_read_extreme(const fit_reading *r, const node *n);
