/* Ray queries, ray trees and fans for scripts. A script's ray is 7 numbers: origin, direction, reach. */
#include "base/json_build.h"
#include "base/text.h"
#include "engine/engine_private.h"
#include "render/inspect/fan.h"
#include "report/json.h"
#include "report/trace_writers.h"
#include "scene/model/scene.h"
#include "wasm/api/results.h"
#include "wasm/exports.h"

#include <stdlib.h>
#include <string.h>

enum { RAY_NUMBERS = 7 };

static cuvette_ray ray_of(const double *numbers)
{
    cuvette_ray ray = {.reach = numbers[6]};
    memcpy(ray.origin, numbers, sizeof ray.origin);
    memcpy(ray.direction, numbers + 3, sizeof ray.direction);
    return ray;
}

char *wasm_query_camera_ray(const cuvette_query *query, double x, double y)
{
    cuvette_ray ray;
    if (results_note(cuvette_query_camera_ray(query, x, y, &ray, &results_last)) != CUVETTE_OK)
        return NULL;
    return results_text(
        json_pack("{s:o,s:o}", "origin", results_vector(ray.origin), "direction", results_vector(ray.direction)));
}

static json_t *solid_name(const cuvette_query *q, int32_t solid)
{
    return solid < 0 ? json_null() : json_of_text(scene_solid_name(q->model, solid));
}

static json_t *hit_json(const cuvette_query *q, const cuvette_hit *h)
{
    if (!isfinite(h->distance))
        return json_pack("{s:n,s:o}", "distance", "before", solid_name(q, h->before));
    return json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:i,s:I,s:i,s:i,s:o,s:o,s:o,s:o}", "distance",
                     json_of_real(h->distance), "point", results_vector(h->point), "normal", results_vector(h->normal),
                     "error", json_of_real(h->error), "solid", solid_name(q, h->solid), "before",
                     solid_name(q, h->before), "after", solid_name(q, h->after), "face", (int)h->face, "triangle",
                     (json_int_t)h->triangle, "copy", (int)h->copy, "slot", (int)h->slot, "u", json_of_real(h->u), "v",
                     json_of_real(h->v), "n_before", json_of_real(h->n_before), "n_after", json_of_real(h->n_after));
}

char *wasm_query_nearest(const cuvette_query *query, const double *rays, size_t count)
{
    cuvette_ray *parsed = calloc(count + 1, sizeof *parsed);
    cuvette_hit *hits = calloc(count + 1, sizeof *hits);
    diagnostic why = {.line = 0};
    cuvette_status code = parsed && hits ? CUVETTE_OK : results_report(out_of_memory(&why), &why);
    for (size_t i = 0; code == CUVETTE_OK && i < count; i++)
        parsed[i] = ray_of(rays + RAY_NUMBERS * i);
    if (code == CUVETTE_OK)
        code = results_note(cuvette_query_nearest(query, parsed, count, hits, &results_last));
    json_t *list = json_array();
    for (size_t i = 0; code == CUVETTE_OK && i < count; i++)
        json_add(&list, hit_json(query, &hits[i]));
    free(parsed), free(hits);
    if (code == CUVETTE_OK)
        return results_text(list);
    json_decref(list);
    return NULL;
}

char *wasm_query_medium(const cuvette_query *query, const double *point)
{
    int32_t solid;
    if (results_note(cuvette_query_medium(query, point, &solid, &results_last)) != CUVETTE_OK)
        return NULL;
    return results_text(json_pack("{s:o}", "solid", solid_name(query, solid)));
}

/* --- trees --- */

static status write_tree(const cuvette_query *q, const ray_tree *tree, char **text, diagnostic *why)
{
    text_writer writer;
    const traced content = {q->model, q->inspector, tree, q->model->path ? q->model->path : "", .for_page = false};
    TRY(text_writer_open(&writer, why));
    return text_writer_end(&writer, trace_write_json(&content, writer.stream, why), text, NULL, why);
}

/* ray: NULL traces the pixel. */
static char *trace(const cuvette_query *query, int x, int y, const double *ray)
{
    cuvette_query *q = NULL;
    ray_tree tree = {0};
    char *text = NULL;
    diagnostic why = {.line = 0};
    const cuvette_ray first = ray ? ray_of(ray) : (cuvette_ray){.reach = 0.0};
    status code = ray ? engine_check_ray(NULL, &first, 0, &why) : STATUS_OK;
    THEN(code, query_begin_trace(query, &q, &why));
    if (code == STATUS_OK) {
        code = ray ? probe_ray(q->inspector, engine_vector(first.origin), engine_vector(first.direction), &tree, &why)
                   : probe_pixel(q->inspector, x, y, &tree, &why);
        THEN(code, write_tree(q, &tree, &text, &why));
        query_end_trace(q);
    }
    ray_tree_release(&tree);
    results_report(code, &why);
    return text;
}

char *wasm_query_trace(const cuvette_query *query, const double *ray)
{
    return trace(query, 0, 0, ray);
}

char *wasm_query_trace_pixel(const cuvette_query *query, int x, int y)
{
    return trace(query, x, y, NULL);
}

/* --- fans --- */

static status check_rule(const double *n, diagnostic *why)
{
    if (!engine_is_finite(n) || !engine_is_finite(n + 3) || !engine_is_finite(n + 6))
        return diagnose(why, STATUS_BAD_INPUT, "give finite numbers", "the fan's axis or normal is not finite");
    if (!(n[9] >= 1 && n[9] <= FAN_RAYS_MAX))
        return diagnose(why, STATUS_BAD_INPUT, "give 1 to 100000 rays", "a fan of %g rays is out of range", n[9]);
    if (!(n[10] >= 0 && n[10] <= 1e6) || !(n[11] >= 0 && n[11] <= 179))
        return diagnose(why, STATUS_BAD_INPUT, "give a width of 0 to 1e6, or a spread of 0 to 179 degrees",
                        "the fan's width or spread is out of range");
    return STATUS_OK;
}

char *wasm_query_fan(const cuvette_query *query, const double *n)
{
    cuvette_query *q = NULL;
    diagnostic why = {.line = 0};
    json_t *json = NULL;
    fan f = {0};
    status code = check_rule(n, &why);
    const fan_rule rule = {.from = engine_vector(n),
                           .to = engine_vector(n + 3),
                           .has_normal = n[6] != 0 || n[7] != 0 || n[8] != 0,
                           .normal = engine_vector(n + 6),
                           .rays = code == STATUS_OK ? (int)n[9] : 1,
                           .width = n[10],
                           .spreads = n[11] > 0,
                           .spread_deg = n[11]};
    THEN(code, query_begin_trace(query, &q, &why));
    if (code == STATUS_OK) {
        code = fan_trace(q->inspector, &rule, &f, &why);
        if (code == STATUS_OK)
            json = fan_json(&(fan_output){q->model, q->inspector, &rule, &f, false, false});
        query_end_trace(q);
    }
    fan_release(&f);
    if (code == STATUS_OK)
        return results_text(json);
    results_report(code, &why);
    return NULL;
}
