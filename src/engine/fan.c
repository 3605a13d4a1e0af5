/* Fans of rays, traced by the query's probe; and sections. */
#include "render/inspect/fan.h"
#include "engine/engine_private.h"
#include "report/trace_writers.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct cuvette_fan {
    cuvette_query *query;
    fan_rule rule;
    fan traced;
    cuvette_node *nodes;
    cuvette_fan_ray *rays;
    cuvette_crossing *crossings;
};

void cuvette_fan_destroy(cuvette_fan *f)
{
    if (!f)
        return;
    free(f->nodes);
    free(f->rays);
    free(f->crossings);
    fan_release(&f->traced);
    cuvette_query_destroy(f->query);
    free(f);
}

static status read_rule(const cuvette_fan_rule *given, fan_rule *out, diagnostic *why)
{
    const double *n = given->normal;
    if (given->size < sizeof *given) /* there is no earlier version yet */
        return diagnose(why, STATUS_BAD_INPUT, "set it to sizeof(cuvette_fan_rule)",
                        "the size of the fan's rule is %zu, which is too small", given->size);
    if (!engine_is_finite(given->from) || !engine_is_finite(given->to) || !engine_is_finite(n))
        return diagnose(why, STATUS_BAD_INPUT, "give finite numbers", "the fan's axis or normal is not finite");
    if (given->rays < 1 || given->rays > FAN_RAYS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use 1 to 100000 rays", "a fan of %d rays is out of range", given->rays);
    if (!(given->width >= 0 && given->width <= 1e6) || !(given->spread_deg >= 0 && given->spread_deg <= 179))
        return diagnose(why, STATUS_BAD_INPUT, "use a width of 0 to 1e6 and a spread of 0 to 179 degrees",
                        "the fan's width or spread is out of range");
    *out = (fan_rule){.from = engine_vector(given->from),
                      .to = engine_vector(given->to),
                      .has_normal = n[0] != 0 || n[1] != 0 || n[2] != 0,
                      .normal = engine_vector(n),
                      .rays = given->rays,
                      .spreads = given->spread_deg > 0,
                      .width = given->width,
                      .spread_deg = given->spread_deg};
    return STATUS_OK;
}

static fan_output content_of(const cuvette_fan *f)
{
    return (fan_output){f->query->model, f->query->inspector, &f->rule, &f->traced, false, false};
}

static status copy_out(cuvette_fan *f, diagnostic *why)
{
    const fan *from = &f->traced;
    const fan_output content = content_of(f);
    f->nodes = tree_nodes_make(f->query, from->node, from->node_count);
    f->rays = calloc((size_t)from->count + 1, sizeof *f->rays);
    f->crossings = calloc((size_t)from->crossing_count + 1, sizeof *f->crossings);
    if (!f->nodes || !f->rays || !f->crossings)
        return out_of_memory(why);
    for (int i = 0; i < from->count; i++) {
        const fan_ray *ray = &from->ray[i];
        f->rays[i] = (cuvette_fan_ray){.offset = ray->offset,
                                       .first = ray->first,
                                       .count = ray->count,
                                       .leaves = ray->leaves,
                                       .crosses_axis = ray->crosses_axis,
                                       .end_name = fan_end_text(&content, ray),
                                       .reach = ray->reach,
                                       .deviation_deg = ray->deviation_deg,
                                       .weight = ray->weight,
                                       .axis_at = ray->axis_at};
        engine_put_vector(f->rays[i].exit_point, ray->exit_point);
        engine_put_vector(f->rays[i].exit_direction, ray->exit_direction);
        engine_put_vector(f->rays[i].axis_point, ray->axis_point);
    }
    for (int i = 0; i < from->crossing_count; i++) {
        f->crossings[i].ray = from->crossing[i].ray;
        engine_put_vector(f->crossings[i].at, from->crossing[i].at);
    }
    return STATUS_OK;
}

cuvette_status cuvette_query_fan(const cuvette_query *query, const cuvette_fan_rule *rule, cuvette_fan **out,
                                 cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    ENGINE_NEED(query, rule);
    fan_rule read;
    cuvette_query *q = NULL;
    status code = read_rule(rule, &read, &inner);
    THEN(code, query_begin_trace(query, &q, &inner));
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    cuvette_fan *f = calloc(1, sizeof *f);
    if (f)
        f->query = query_retain(q), f->rule = read;
    code = f ? fan_trace(q->inspector, &read, &f->traced, &inner) : out_of_memory(&inner);
    THEN(code, copy_out(f, &inner));
    query_end_trace(q);
    if (code == STATUS_OK)
        *out = f;
    else
        cuvette_fan_destroy(f);
    return engine_report(code, &inner, why);
}

static void set_count(size_t *count, size_t value)
{
    if (count)
        *count = value;
}

const cuvette_fan_ray *cuvette_fan_rays(const cuvette_fan *f, size_t *count)
{
    set_count(count, f ? (size_t)f->traced.count : 0);
    return f ? f->rays : NULL;
}

const cuvette_node *cuvette_fan_nodes(const cuvette_fan *f, size_t *count)
{
    set_count(count, f ? f->traced.node_count : 0);
    return f ? f->nodes : NULL;
}

const cuvette_crossing *cuvette_fan_crossings(const cuvette_fan *f, size_t *count)
{
    set_count(count, f ? (size_t)f->traced.crossing_count : 0);
    return f ? f->crossings : NULL;
}

cuvette_status cuvette_fan_focus(const cuvette_fan *f, cuvette_focus *out, cuvette_diagnostic *why)
{
    ENGINE_ENTER();
    ENGINE_NEED_NAMED(f, "fan");
    ENGINE_NEED(out);
    cuvette_focus found = {.exists = f->traced.has_focus, .is_virtual = f->traced.is_virtual};
    if (found.exists) {
        engine_put_vector(found.point, f->traced.focus);
        found.rms = f->traced.focus_rms;
    }
    return engine_copy_struct(&found, sizeof found, out, why);
}

static status write_drawing(const void *content, FILE *out, diagnostic *why)
{
    return fan_write_drawing(content, out, why);
}

static status write_csv(const void *content, FILE *out, diagnostic *why)
{
    return fan_write_csv(content, out, why);
}

static const ray_writer writers[] = {{".svg", write_drawing}, {".csv", write_csv}};

cuvette_status cuvette_fan_write(const cuvette_fan *f, const char *path, cuvette_diagnostic *why)
{
    ENGINE_ENTER();
    ENGINE_NEED_NAMED(f, "fan");
    ENGINE_NEED(path);
    cuvette_query *q = NULL;
    status code = query_begin_trace(f->query, &q, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    const fan_output content = content_of(f);
    code = query_write_file(writers, sizeof writers / sizeof *writers, "use .svg or .csv", &content, path, &inner);
    query_end_trace(q);
    return engine_report(code, &inner, why);
}

/* --- sections --- */

static status write_section_drawing(const void *content, FILE *out, diagnostic *why)
{
    return section_write_drawing(content, out, why);
}

static status write_section_json(const void *content, FILE *out, diagnostic *why)
{
    return section_write_json(content, out, why);
}

static status read_section_rule(const cuvette_section_rule *given, section_rule *out, diagnostic *why)
{
    const double *e = given->extent;
    if (given->size < sizeof *given) /* there is no earlier version yet */
        return diagnose(why, STATUS_BAD_INPUT, "set it to sizeof(cuvette_section_rule)",
                        "the size of the section's rule is %zu, which is too small", given->size);
    if (given->view < 0 || given->view >= SECTION_VIEW_COUNT)
        return diagnose(why, STATUS_BAD_INPUT, "use a value of cuvette_section_view", "there is no view number %d",
                        (int)given->view);
    if (given->at && !engine_is_finite(given->at))
        return diagnose(why, STATUS_BAD_INPUT, "give finite numbers", "the section's point is not finite");
    *out = (section_rule){.view = (section_view)given->view,
                          .through = given->through,
                          .has_at = given->at,
                          .has_extent = e[0] != 0 || e[1] != 0 || e[2] != 0 || e[3] != 0,
                          .extent = {e[0], e[1], e[2], e[3]},
                          .cells = given->cells ? given->cells : SECTION_CELLS_USUAL};
    if (given->at)
        out->at = engine_vector(given->at);
    return STATUS_OK;
}

cuvette_status cuvette_query_write_section(const cuvette_query *query, const cuvette_section_rule *rule,
                                           const char *path, cuvette_diagnostic *why)
{
    ENGINE_CALL(query, rule, path);
    static const ray_writer forms[] = {{".svg", write_section_drawing}, {".json", write_section_json}};
    section_rule read;
    cuvette_query *q = NULL;
    status code = read_section_rule(rule, &read, &inner);
    THEN(code, query_begin_trace(query, &q, &inner));
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    section_output t = {.s = q->model, .p = q->inspector, .level = q->level, .scene_path = "", .cells = read.cells};
    code = section_rule_resolve(&read, q->model, &t.plane, &inner);
    THEN(code, query_write_file(forms, sizeof forms / sizeof *forms, "use .svg or .json", &t, path, &inner));
    query_end_trace(q);
    return engine_report(code, &inner, why);
}
