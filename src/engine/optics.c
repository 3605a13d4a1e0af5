/* Optics against theory: the metrics and curves of a scene; reports on its lenses. */
#include "engine/engine_private.h"
#include "lens/lens.h"
#include "realism/realism.h"
#include "report/param_rows.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The scene, checked and loaded, with the default instruction set. */
static status prepare(const cuvette_scene *s, isa *level, diagnostic *why)
{
    status code = engine_check(s, why);
    THEN(code, engine_load((cuvette_scene *)(uintptr_t)s, NULL, why)); /* handles are never const objects */
    THEN(code, isa_choose(level, why));
    return code;
}

cuvette_status cuvette_scene_each_metric(const cuvette_scene *s,
                                         bool (*visit)(void *context, const cuvette_metric *one), void *context,
                                         cuvette_diagnostic *why)
{
    ENGINE_CALL(s);
    ENGINE_NEED_NAMED(visit, "visit");
    isa level = ISA_BASE;
    realism_report *report = malloc(sizeof *report);
    status code = report ? prepare(s, &level, &inner) : out_of_memory(&inner);
    THEN(code, realism_measure(s->model, level, report, &inner));
    bool wants_more = true;
    for (int i = 0; code == STATUS_OK && wants_more && i < report->count; i++) {
        const realism_value *v = &report->value[i];
        const cuvette_metric one = {.name = v->metric,
                                    .meaning = v->what,
                                    .unit = v->unit,
                                    .verdict = realism_verdict(v),
                                    .measured = v->measured,
                                    .theory = v->theory,
                                    .error = realism_error(v),
                                    .tolerance = v->tolerance};
        float_environment_leave(&host);
        wants_more = visit(context, &one);
        float_environment_enter(&host);
    }
    free(report);
    return engine_report(code, &inner, why);
}

cuvette_status cuvette_scene_each_curve(const cuvette_scene *s, bool (*visit)(void *context, const cuvette_curve *one),
                                        void *context, cuvette_diagnostic *why)
{
    ENGINE_CALL(s);
    ENGINE_NEED_NAMED(visit, "visit");
    bool wants_more = true;
    for (int i = 0; wants_more && i < REALISM_CURVE_COUNT; i++) {
        const realism_curve which = (realism_curve)i;
        if (realism_check_curve(s->model, which, NULL) != STATUS_OK)
            continue;
        const cuvette_curve one = {realism_curve_name(which), realism_curve_x(which), realism_curve_y(which)};
        float_environment_leave(&host);
        wants_more = visit(context, &one);
        float_environment_enter(&host);
    }
    return CUVETTE_OK;
}

static status curve_named(const char *name, realism_curve *out, diagnostic *why)
{
    for (int i = 0; i < REALISM_CURVE_COUNT; i++)
        if (strcmp(realism_curve_name((realism_curve)i), name) == 0) {
            *out = (realism_curve)i;
            return STATUS_OK;
        }
    char remedy[256] = "use one of:";
    for (int i = 0; i < REALISM_CURVE_COUNT; i++) {
        const size_t used = strlen(remedy);
        snprintf(remedy + used, sizeof remedy - used, "%s %s", i ? "," : "", realism_curve_name((realism_curve)i));
    }
    return diagnose(why, STATUS_BAD_INPUT, remedy, "there is no curve '%.64s'", name);
}

cuvette_status cuvette_scene_curve(const cuvette_scene *s, const char *name, double (*points)[3], size_t room,
                                   size_t *count, cuvette_diagnostic *why)
{
    ENGINE_CALL(s, name, count);
    if (room > 0)
        ENGINE_NEED(points);
    isa level = ISA_BASE;
    realism_curve which = REALISM_CURVE_FRESNEL;
    realism_points *made = malloc(sizeof *made);
    status code = made ? curve_named(name, &which, &inner) : out_of_memory(&inner);
    THEN(code, prepare(s, &level, &inner));
    THEN(code, realism_measure_curve(s->model, level, which, made, &inner));
    if (code == STATUS_OK) {
        *count = (size_t)made->count;
        for (size_t i = 0; i < *count && i < room; i++)
            points[i][0] = made->at[i].x, points[i][1] = made->at[i].measured, points[i][2] = made->at[i].theory;
        if (*count > room)
            code = diagnose(&inner, STATUS_BAD_INPUT, "make room for that many points",
                            "the curve has %zu points, but there is room for %zu", *count, room);
    }
    free(made);
    return engine_report(code, &inner, why);
}

/* --- reports on lenses --- */

/* Reports on a copy, in which the stop has no solid. */
static status make_report(const cuvette_scene *s, const char *system, lens_report *out, diagnostic *why)
{
    isa level = ISA_BASE;
    scene *copy = scene_clone(s->model);
    status code = copy ? isa_choose(&level, why) : out_of_memory(why);
    THEN(code, lens_report_of_scene(copy, system, &(lens_light){.fields = 0}, level, &lens_options_usual, out, why));
    scene_destroy(copy);
    return code;
}

cuvette_status cuvette_scene_each_lens_number(const cuvette_scene *s, const char *system,
                                              bool (*visit)(void *context, const cuvette_lens_number *one),
                                              void *context, cuvette_diagnostic *why)
{
    ENGINE_CALL(s);
    ENGINE_NEED_NAMED(visit, "visit");
    lens_report report = {0};
    status code = engine_check(s, &inner);
    THEN(code, engine_load((cuvette_scene *)(uintptr_t)s, NULL, &inner)); /* handles are never const objects */
    THEN(code, make_report(s, system, &report, &inner));
    bool wants_more = true;
    for (size_t i = 0; code == STATUS_OK && wants_more && i < report.count; i++) {
        const lens_row *r = &report.row[i];
        const cuvette_lens_number one = {.section = r->section,
                                         .quantity = r->quantity,
                                         .unit = r->unit,
                                         .surface = r->surface,
                                         .field = r->field,
                                         .lambda_nm = r->lambda_nm,
                                         .x = r->x,
                                         .value = r->value};
        float_environment_leave(&host);
        wants_more = visit(context, &one);
        float_environment_enter(&host);
    }
    lens_report_release(&report);
    return engine_report(code, &inner, why);
}
