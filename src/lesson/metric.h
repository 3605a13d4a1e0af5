/* The metrics of lessons: those of `cuvette realism` and `cuvette motion`, and speedup, the time of a frame with one
 * thread over that with the scene's threads. Private to this folder. Ownership: lesson_meter_release frees what a meter
 * keeps between scenes; initially, a meter has only l and level. Errors: STATUS_BAD_INPUT for a scene without the
 * metric; those of job/job.h for frames. */
#pragma once

#include "job/job.h"
#include "lesson/lesson.h"

typedef struct lesson_meter {
    const lesson *l;
    isa level;
    job *frames;    /* NULL before the first frame */
    double alone_s; /* time of a frame with one thread; 0 before it is measured */
} lesson_meter;

/* In the lesson's unit; tolerance INFINITY for times. */
typedef struct lesson_value {
    double measured, theory, tolerance;
} lesson_value;

status lesson_metric(lesson_meter *m, const scene *s, lesson_value *out, diagnostic *why);
void lesson_meter_release(lesson_meter *m);
