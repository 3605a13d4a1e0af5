/* Lessons: guided experiments for the laboratory's gallery, as data files that a teacher writes and translates. A
 * lesson names a scene, a few of its parameters as controls, a prediction to make, and a curve with a value to read.
 * The curve is one of `cuvette realism --curve` (realism/realism.h), or a metric at values of one of the controls. It
 * also adds beams to the scene, and names what its section shows and what the pupil measures there by hand.
 * cuvette-lesson(5) describes the format. lesson_read validates every word and parameter; lesson_check also measures.
 *
 * Ownership: the caller releases lessons with lesson_destroy, lists with lesson_list_release. Errors: STATUS_BAD_INPUT
 * with file, line, column and remedy. */
#pragma once

#include "realism/realism.h"
#include "scene/data/document.h"
#include "scene/model/open.h"

enum { LESSON_CONTROLS_MAX = 5, LESSON_CHOICES_MAX = 6, LESSON_VALUES_MAX = 12 };
#define LESSON_SPEEDUP "speedup" /* the metric that measures times */

typedef struct lesson_control {
    char *parameter, *label, *with;    /* with: a parameter that gets the same values; NULL: none */
    double from, to;                   /* equal if the lesson gives no range */
    char *choices[LESSON_CHOICES_MAX]; /* instead of a range: words or numbers */
    int choice_count;
} lesson_control;

/* A named formula, whose value texts show as {name}. */
typedef struct lesson_value_of {
    char *name, *formula;
} lesson_value_of;

/* What is drawn when the lesson opens. */
typedef struct lesson_show {
    char *view; /* "top", "front", "side": a section of the scene with the rays of its beams; "image" */
    double at;  /* of the section's plane on its normal; NaN: through the beams */
    double window[4];
    bool has_window, normals, angles, extensions;
} lesson_show;

/* What the pupil measures in the section: a reading is right if it is that close to the truth. */
typedef enum lesson_tool { LESSON_NO_TOOL, LESSON_PROTRACTOR, LESSON_RULER, LESSON_SCREEN } lesson_tool;
typedef struct lesson_hand {
    lesson_tool tool;
    char *ask, *unit, *truth; /* truth: a formula */
    bool reads_power;         /* a screen: percent of the power of the beams; else its distance from `from` */
    double within;
    double place[3], to[3], from[3]; /* where the tool is at first; the ruler's end; see above */
    double arms[2];                  /* of a protractor, degrees from the right */
} lesson_hand;

typedef struct lesson {
    char *path; /* of the lesson file, as given */
    char *name, *title, *language, *question, *answer;
    char *scene_path; /* without links; relative if it is below the working folder, else absolute */
    char **setting;   /* parameters of the scene that the lesson sets, "PATH=VALUE" */
    size_t setting_count;
    char **added; /* names of the beams and solids that the lesson adds */
    size_t added_count;
    lesson_control control[LESSON_CONTROLS_MAX];
    int control_count;
    char *ask;                         /* the prediction's question */
    char *choices[LESSON_CHOICES_MAX]; /* of the prediction; none: it is a number, compared with the reading */
    int choice_count, right;           /* right: index of the correct choice */
    char *which;                       /* a formula for the number of the right choice, from 1; NULL: `right` */
    char predicts;                     /* 'x' or 'y': the axis of the curve with the predicted number; 0: none */
    int over;                          /* index of the control on the curve's x axis; -1: `curve` is used */
    realism_curve curve;               /* if over is -1 */
    double tolerance;                  /* largest |measured - theory| that the curve may have; INFINITY for times */
    char *metric;                      /* the metric to read; NULL: the curve is read at x = `at` */
    char *theory;                      /* the formula for a metric of a beam; NULL for others */
    double at;
    char *reading, *unit; /* label of the value to read, and its unit; "deg" converts a metric in radians */
    double answer_within; /* a predicted number counts as right within this distance */
    lesson_value_of value[LESSON_VALUES_MAX];
    int value_count;
    lesson_show show;
    lesson_hand hand;
    long line, column; /* of the key 'measure' */
    scene *start;      /* the scene with the lesson's parameters set, its files not loaded; its path is scene_path */
} lesson;

status lesson_read(const char *path, lesson **out, diagnostic *why);
/* Like lesson_read; the lesson and its scene must be below root (base/file.h). */
status lesson_read_below(const char *path, const char *root, lesson **out, diagnostic *why);
void lesson_destroy(lesson *l); /* NULL is allowed */

/* Whether the lesson measures times, which differ from one measurement to the next and have no tolerance. */
bool lesson_is_timed(const lesson *l);
/* Labels of the curve's axes, with units. The caller frees them; NULL if memory runs out. */
char *lesson_x_label(const lesson *l);
char *lesson_y_label(const lesson *l);

/* What lesson_measure finds in s, which is the lesson's scene, perhaps with other values of its controls. */
typedef struct lesson_result {
    realism_points points;
    double error; /* largest |measured - theory| of the curve */
    double measured, theory, tolerance;
    bool passes;                             /* the curve and the value */
    double values[LESSON_VALUES_MAX], truth; /* of the lesson's formulas, and of the measurement by hand */
    int right;                               /* index of the correct choice now */
} lesson_result;
status lesson_measure(const lesson *l, const scene *s, isa level, lesson_result *out, diagnostic *why);

/* Measures the lesson's scene as the lesson sets it. A curve or a value beyond its tolerance is an error,
 * located in the lesson. */
status lesson_check(const lesson *l, isa level, lesson_result *out, diagnostic *why);

/* The command that prints the curve, or else the metric's value, with --set for the parameters that the lesson sets. No
 * command prints the curve of a metric over a control: `curve` requires over = -1, and a value requires a metric. The
 * caller frees it; NULL if memory runs out. */
char *lesson_command(const lesson *l, bool curve);

/* The folder of the lessons that belong to the program: experiments/lessons next to its source or where `make install`
 * puts it. The caller frees it; NULL if there is none. */
char *lesson_folder(void);

/* The files *.lesson of a folder in order of their names, as paths. */
typedef struct lesson_list {
    char **path;
    size_t count, room;
} lesson_list;
status lesson_list_find(const char *folder, lesson_list *out, diagnostic *why);
void lesson_list_release(lesson_list *l);

/* --- parts: private to this folder --- */

/* What a formula may name: parameters of the scene, and the first `count` values of the lesson. */
typedef struct formula_names {
    const scene *s;
    const lesson *l;
    const double *values;
    int count;
    double theory;
} formula_names;
/* The value of a formula (formula.c). STATUS_BAD_INPUT, without a place, for a wrong one. */
status formula_value(const char *text, const formula_names *names, double *out, diagnostic *why);
/* The lesson's values, and a formula that uses them. theory: of the value to read, NaN before it is known. */
status lesson_values(const lesson *l, const scene *s, double theory, double values[LESSON_VALUES_MAX], diagnostic *why);
status lesson_formula(const lesson *l, const scene *s, double theory, const char *formula, double *out,
                      diagnostic *why);

typedef struct lesson_reader {
    const document *file;
    lesson *l;
    const char *root;
    diagnostic *why;
} lesson_reader;
/* The values under keys of a map (read.c). A text that is not needed may be missing, and is then NULL. */
status lesson_read_text(const lesson_reader *r, const node *map, const char *key, bool needed, char **out);
status lesson_read_number(const lesson_reader *r, const node *map, const char *key, double *out);
status lesson_expect_map(const lesson_reader *r, const node *parent, const char *key, const node **out);
/* Reports the error of a value or of the scene: bad input is located in the lesson, a failure of the machine is not. */
status lesson_relay(const lesson_reader *r, const node *at, status code, const char *remedy, const diagnostic *refused);
/* The keys 'measure'; 'values', 'show' and 'hand' (read_measure.c). */
status lesson_read_measure(const lesson_reader *r, const node *root);
status lesson_read_values(const lesson_reader *r, const node *root);
status lesson_read_show(const lesson_reader *r, const node *root);
status lesson_read_hand(const lesson_reader *r, const node *root);
/* Reads a formula and tries it. */
status lesson_read_formula(const lesson_reader *r, const node *map, const char *key, bool needed, char **out);
