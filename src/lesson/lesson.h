/* Lessons: guided experiments for the laboratory's gallery, as data files that a teacher writes and translates. A
 * lesson names a scene, a few of its parameters as controls, a prediction to make, and a curve with a value to read.
 * The curve is one of `cuvette realism --curve` (realism/realism.h), or a metric at values of one of the controls.
 * cuvette-lesson(5) describes the format. lesson_read validates every word and parameter; lesson_check also measures.
 *
 * Ownership: the caller releases lessons with lesson_destroy, lists with lesson_list_release. Errors: STATUS_BAD_INPUT
 * with file, line, column and remedy. */
#pragma once

#include "realism/realism.h"
#include "scene/model/open.h"

enum { LESSON_CONTROLS_MAX = 5, LESSON_CHOICES_MAX = 6 };
#define LESSON_SPEEDUP "speedup" /* the metric that measures times */

typedef struct lesson_control {
    char *parameter, *label;
    double from, to;                   /* equal if the lesson gives no range */
    char *choices[LESSON_CHOICES_MAX]; /* instead of a range: words or numbers */
    int choice_count;
} lesson_control;

typedef struct lesson {
    char *path; /* of the lesson file, as given */
    char *name, *title, *language, *question, *answer;
    char *scene_path; /* without links; relative if it is below the working folder, else absolute */
    char **setting;   /* parameters of the scene that the lesson sets, "PATH=VALUE" */
    size_t setting_count;
    lesson_control control[LESSON_CONTROLS_MAX];
    int control_count;
    char *ask;                         /* the prediction's question */
    char *choices[LESSON_CHOICES_MAX]; /* of the prediction; none: it is a number, compared with the reading */
    int choice_count, right;           /* right: index of the correct choice */
    char predicts;                     /* 'x' or 'y': the axis of the curve with the predicted number; 0: none */
    int over;                          /* index of the control on the curve's x axis; -1: `curve` is used */
    realism_curve curve;               /* if over is -1 */
    double tolerance;                  /* largest |measured - theory| that the curve may have; INFINITY for times */
    char *metric;                      /* the metric to read; NULL: the curve is read at x = `at` */
    double at;
    char *reading, *unit; /* label of the value to read, and its unit; "deg" converts a metric in radians */
    double answer_within; /* a predicted number counts as right within this distance */
    long line, column;    /* of the key 'measure' */
    scene *start;         /* the scene with the lesson's parameters set, its files not loaded; its path is scene_path */
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
    bool passes; /* the curve and the value */
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
