/* What a lesson measures, and the commands that give the same numbers. */
#include "lesson/lesson.h"

#include "base/text.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static status read_metric(const lesson *l, const scene *s, isa level, lesson_result *out, diagnostic *why)
{
    realism_report report;
    TRY(realism_measure(s, level, &report, why));
    for (int i = 0; i < report.count; i++) {
        const realism_value *v = &report.value[i];
        if (strcmp(v->metric, l->metric) != 0)
            continue;
        const double factor = strcmp(v->unit, "rad") == 0 && strcmp(l->unit, "deg") == 0 ? 180.0 / M_PI : 1.0;
        out->measured = v->measured * factor;
        out->theory = v->theory * factor;
        out->tolerance = v->tolerance * factor;
        return STATUS_OK;
    }
    return diagnose(why, STATUS_BAD_INPUT, "'cuvette realism SCENE' lists the metrics", "the scene has no metric '%s'",
                    l->metric);
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

status lesson_measure(const lesson *l, const scene *s, isa level, lesson_result *out, diagnostic *why)
{
    *out = (lesson_result){.measured = NAN, .theory = NAN};
    TRY(realism_trace_curve(s, level, l->curve, &out->points, why));
    for (int i = 0; i < out->points.count; i++) {
        const double error = fabs(out->points.at[i].measured - out->points.at[i].theory);
        out->error = error <= out->error ? out->error : error; /* a NaN stays */
    }
    if (l->metric)
        TRY(read_metric(l, s, level, out, why));
    else
        read_point(l, out);
    out->passes =
        out->error <= l->tolerance && (isnan(out->theory) || fabs(out->measured - out->theory) <= out->tolerance);
    return STATUS_OK;
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

char *lesson_command(const lesson *l, bool curve)
{
    char *text = curve ? text_format("cuvette realism %s --curve %s", l->scene_path, realism_curve_name(l->curve))
                       : text_format("cuvette realism %s", l->scene_path);
    for (size_t i = 0; text && i < l->setting_count; i++) {
        char *longer = text_format("%s --set %s", text, l->setting[i]);
        free(text);
        text = longer;
    }
    return text;
}
