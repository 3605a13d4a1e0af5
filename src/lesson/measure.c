/* What a lesson measures, and the commands that give the same numbers. */
#include "lesson/lesson.h"

#include "base/number.h"
#include "base/text.h"
#include "lesson/metric.h"
#include "scene/model/params.h"
#include "softbody/trials.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 25 }; /* of a control with a range */

bool lesson_is_timed(const lesson *l)
{
    return l->metric && strcmp(l->metric, LESSON_SPEEDUP) == 0;
}

/* The point of the curve that is nearest to `at`. */
static void read_point(const lesson *l, lesson_result *out)
{
    double nearest = INFINITY;
    out->tolerance = l->tolerance;
    for (int i = 0; i < out->points.count; i++) {
        const realism_point *p = &out->points.at[i];
        if (fabs(p->x - l->at) >= nearest)
            continue;
        nearest = fabs(p->x - l->at);
        out->measured = p->measured;
        out->theory = p->theory;
    }
}

/* The i-th value of the control on the x axis; false after the last. */
static bool value_at(const lesson_control *c, int i, char text[NUMBER_TEXT_MAX], double *x)
{
    if (i >= (c->choice_count ? c->choice_count : STEPS))
        return false;
    *x = c->from + (c->to - c->from) * i / (STEPS - 1);
    if (c->choice_count)
        number_parse_real(c->choices[i], x);
    number_format(*x, text);
    return true;
}

static status sweep_control(lesson_meter *m, const scene *s, realism_points *out, diagnostic *why)
{
    const lesson_control *c = &m->l->control[m->l->over];
    char text[NUMBER_TEXT_MAX];
    double x;
    scene *copy = scene_clone(s);
    status code = copy ? STATUS_OK : out_of_memory(why);
    out->count = 0;
    for (int i = 0; code == STATUS_OK && value_at(c, i, text, &x); i++) {
        lesson_value v = {NAN, NAN, NAN};
        code = scene_set(copy, c->parameter, text, why);
        THEN(code, lesson_metric(m, copy, &v, why));
        out->at[out->count++] = (realism_point){x, v.measured, v.theory};
    }
    scene_destroy(copy);
    return code;
}

/* A time is not measured again: it would be another one than the point of the curve. */
static const realism_point *point_of_now(const lesson *l, const scene *s, const realism_points *points)
{
    char *text = NULL;
    double now = NAN;
    if (l->over >= 0 && scene_get(s, l->control[l->over].parameter, &text, NULL) == STATUS_OK)
        number_parse_real(text, &now);
    free(text);
    for (int i = 0; i < points->count; i++)
        if (points->at[i].x == now)
            return &points->at[i];
    return NULL;
}

static status read_value(lesson_meter *m, const scene *s, lesson_result *out, diagnostic *why)
{
    const realism_point *known = lesson_is_timed(m->l) ? point_of_now(m->l, s, &out->points) : NULL;
    lesson_value v = {NAN, NAN, NAN};
    if (known)
        v = (lesson_value){known->measured, known->theory, INFINITY};
    else
        TRY(lesson_metric(m, s, &v, why));
    out->measured = v.measured;
    out->theory = v.theory;
    out->tolerance = v.tolerance;
    return STATUS_OK;
}

status lesson_measure(const lesson *l, const scene *s, isa level, lesson_result *out, diagnostic *why)
{
    lesson_meter m = {.l = l, .level = level};
    *out = (lesson_result){.measured = NAN, .theory = NAN};
    status code = l->over < 0 ? realism_trace_curve(s, level, l->curve, &out->points, why)
                              : sweep_control(&m, s, &out->points, why);
    for (int i = 0; i < out->points.count; i++) {
        const double error = fabs(out->points.at[i].measured - out->points.at[i].theory);
        out->error = error <= out->error ? out->error : error; /* a NaN stays */
    }
    if (l->metric)
        THEN(code, read_value(&m, s, out, why));
    else
        read_point(l, out);
    lesson_meter_release(&m);
    out->passes =
        out->error <= l->tolerance && (isnan(out->theory) || fabs(out->measured - out->theory) <= out->tolerance);
    return code;
}

status lesson_check(const lesson *l, isa level, lesson_result *out, diagnostic *why)
{
    status code = lesson_measure(l, l->start, level, out, why);
    if (code == STATUS_OK && !out->passes)
        code = diagnose(why, STATUS_BAD_INPUT, "correct the scene, or raise the tolerance",
                        "the largest error of the curve is %.2g, and %.10g was read instead of %.10g", out->error,
                        out->measured, out->theory);
    if (code != STATUS_OK)
        diagnostic_locate(why, l->path, l->line, l->column);
    return code;
}

/* Without a curve, the command that measures the metric. */
static char *command_of(const lesson *l, bool curve)
{
    if (curve)
        return text_format("cuvette realism %s --curve %s", l->scene_path, realism_curve_name(l->curve));
    if (lesson_is_timed(l))
        return text_format("cuvette render %s --json -o frame.png", l->scene_path);
    return text_format("cuvette %s %s", softbody_has_trial(l->metric) ? "motion" : "realism", l->scene_path);
}

char *lesson_command(const lesson *l, bool curve)
{
    char *text = command_of(l, curve);
    for (size_t i = 0; text && i < l->setting_count; i++) {
        char *longer = text_format("%s --set %s", text, l->setting[i]);
        free(text);
        text = longer;
    }
    return text;
}

char *lesson_x_label(const lesson *l)
{
    return strdup(l->over < 0 ? realism_curve_x(l->curve) : l->control[l->over].label);
}

char *lesson_y_label(const lesson *l)
{
    if (l->over < 0)
        return strdup(realism_curve_y(l->curve));
    return text_format(l->unit[0] ? "%s, %s" : "%s", l->reading, l->unit);
}
