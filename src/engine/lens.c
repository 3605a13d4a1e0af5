/* The report of the lens of a scene. */
#include "lens/lens.h"
#include "engine/engine_private.h"
#include "scene/model/scene.h"

#include <stdlib.h>

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
