/* A scene's texts, parameters, hints and names, its optics compared with theory, the report on its lens, and its slimes
 * in motion, for scripts; and random numbers. */
#include "base/array.h"
#include "base/json_build.h"
#include "base/random.h"
#include "report/json.h"
#include "report/param_rows.h"
#include "wasm/api/results.h"
#include "wasm/exports.h"

#include <math.h>
#include <stdlib.h>

/* Returns a text of the library; the first call, without room, finds its length. */
static char *sized_text(const cuvette_scene *s, const char *path)
{
    size_t length = 0;
    char *text = NULL;
    for (size_t size = 0; !text || size <= length; size = length + 1) {
        free(text);
        text = size ? malloc(size) : NULL;
        if (size && !text) {
            diagnostic why = {.line = 0};
            results_report(out_of_memory(&why), &why);
            return NULL;
        }
        length = 0;
        const cuvette_status code = path
                                        ? results_note(cuvette_scene_get(s, path, text, size, &length, &results_last))
                                        : results_note(cuvette_scene_write_text(s, text, size, &length, &results_last));
        if (code != CUVETTE_OK && (length == 0 || length < size)) {
            free(text);
            return NULL;
        }
    }
    return text;
}

char *wasm_scene_text(const cuvette_scene *scene)
{
    return sized_text(scene, NULL);
}

char *wasm_scene_get(const cuvette_scene *scene, const char *path)
{
    return sized_text(scene, path);
}

static bool add_parameter(void *list, const cuvette_parameter *one)
{
    json_add(list,
             json_pack("{s:o,s:o,s:o,s:o,s:o,s:o}", "path", json_of_text(one->path), "value", json_of_text(one->value),
                       "unit", json_of_text(one->unit), "range", json_of_text(one->range), "initial",
                       json_of_text(one->initial), "meaning", json_of_text(one->meaning)));
    return true;
}

/* Releases an incomplete list. */
static char *list_text(cuvette_status code, json_t *list)
{
    if (code == CUVETTE_OK)
        return results_text(list);
    json_decref(list);
    return NULL;
}

char *wasm_scene_parameters(const cuvette_scene *scene)
{
    json_t *list = json_array();
    return list_text(results_note(cuvette_scene_each_parameter(scene, add_parameter, &list, &results_last)), list);
}

static void add_hint(void *list, const char *text)
{
    json_add(list, json_of_text(text));
}

char *wasm_scene_hints(const cuvette_scene *scene)
{
    json_t *list = json_array();
    return list_text(results_note(cuvette_scene_hints(scene, add_hint, &list, &results_last)), list);
}

char *wasm_scene_names(const cuvette_scene *scene)
{
    static const struct {
        const char *key;
        cuvette_object kind;
    } kinds[] = {{"lights", CUVETTE_LIGHT}, {"materials", CUVETTE_MATERIAL}, {"solids", CUVETTE_SOLID},
                 {"meshes", CUVETTE_MESH},  {"textures", CUVETTE_TEXTURE},   {"data", CUVETTE_DATA}};
    json_t *all = json_object();
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        json_t *list = json_array();
        for (size_t i = 0; i < cuvette_scene_count(scene, kinds[k].kind); i++)
            json_add(&list, json_of_text(cuvette_scene_name(scene, kinds[k].kind, i)));
        json_add_as(&all, kinds[k].key, list);
    }
    return results_text(all);
}

/* --- optics compared with theory, and random numbers --- */

enum { POINTS_MAX = 1024 };

static bool add_metric(void *list, const cuvette_metric *m)
{
    json_add(list,
             json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "name", json_of_text(m->name), "meaning",
                       json_of_text(m->meaning), "unit", json_of_text(m->unit), "verdict", json_of_text(m->verdict),
                       "measured", json_of_real(m->measured), "theory", json_of_real(m->theory), "error",
                       json_of_real(m->error), "tolerance", json_of_real(m->tolerance)));
    return true;
}

static bool add_curve(void *list, const cuvette_curve *c)
{
    json_add(list, json_pack("{s:o,s:o,s:o}", "name", json_of_text(c->name), "x", json_of_text(c->x), "y",
                             json_of_text(c->y)));
    return true;
}

char *wasm_scene_realism(const cuvette_scene *scene)
{
    json_t *metrics = json_array(), *curves = json_array(), *both = json_object();
    cuvette_status code = results_note(cuvette_scene_each_metric(scene, add_metric, &metrics, &results_last));
    if (code == CUVETTE_OK)
        code = results_note(cuvette_scene_each_curve(scene, add_curve, &curves, &results_last));
    json_add_as(&both, "metrics", metrics);
    json_add_as(&both, "curves", curves);
    if (code == CUVETTE_OK)
        return results_text(both);
    json_decref(both);
    return NULL;
}

char *wasm_scene_curve(const cuvette_scene *scene, const char *name)
{
    double(*points)[3] = malloc(POINTS_MAX * sizeof *points);
    size_t count = 0;
    diagnostic why = {.line = 0};
    const cuvette_status code =
        points ? results_note(cuvette_scene_curve(scene, name, points, POINTS_MAX, &count, &results_last))
               : results_report(out_of_memory(&why), &why);
    json_t *list = json_array();
    for (size_t i = 0; code == CUVETTE_OK && i < count; i++)
        json_add(&list, results_vector(points[i]));
    free(points);
    if (code == CUVETTE_OK)
        return results_text(list);
    json_decref(list);
    return NULL;
}

static bool add_number(void *context, const cuvette_lens_number *one)
{
    lens_report *r = context;
    if (r->failed || !GROW(r->row, r->room, r->count + 1))
        return !(r->failed = true);
    r->row[r->count++] = (lens_row){one->section, one->surface,  one->field, one->lambda_nm,
                                    one->x,       one->quantity, one->unit,  one->value};
    return true;
}

char *wasm_scene_lens(const cuvette_scene *scene, const char *system)
{
    lens_report report = {0};
    diagnostic why = {.line = 0};
    cuvette_status code = results_note(
        cuvette_scene_each_lens_number(scene, *system ? system : NULL, add_number, &report, &results_last));
    if (code == CUVETTE_OK && report.failed)
        code = results_report(out_of_memory(&why), &why);
    char *text = code == CUVETTE_OK ? results_text(lens_json(&report, system)) : NULL;
    lens_report_release(&report);
    return text;
}

void wasm_random(uint32_t key_low, uint32_t key_high, uint32_t a, uint32_t b, uint32_t c, uint32_t d, uint32_t *words)
{
    const random_words r = random_at((uint64_t)key_high << 32 | key_low, a, b, c, d);
    for (int i = 0; i < 4; i++)
        words[i] = r.word[i];
}

/* --- slimes in motion: states and hands --- */

char *wasm_motion_names(const cuvette_motion *motion)
{
    json_t *list = json_array();
    for (size_t i = 0; i < cuvette_motion_count(motion); i++)
        json_add(&list, json_of_text(cuvette_motion_name(motion, i)));
    return results_text(list);
}

char *wasm_motion_state(const cuvette_motion *motion, const char *name)
{
    cuvette_slime s = {.size = sizeof s};
    if (results_note(cuvette_motion_state(motion, name, &s, &results_last)) != CUVETTE_OK)
        return NULL;
    json_t *json =
        json_pack("{s:o,s:I,s:I,s:I,s:I,s:o,s:o,s:o,s:o}", "time_s", json_of_real(s.time_s), "steps",
                  (json_int_t)s.steps, "substeps", (json_int_t)s.substeps, "masses", (json_int_t)s.masses, "held",
                  (json_int_t)s.held, "kinetic", json_of_real(s.kinetic), "elastic", json_of_real(s.elastic),
                  "compression", json_of_real(s.compression), "gravity", json_of_real(s.gravity));
    json_add_all(&json, json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "center", results_vector(s.center), "momentum",
                                  results_vector(s.momentum), "volume", json_of_real(s.volume), "volume_at_rest",
                                  json_of_real(s.volume_at_rest), "low", json_of_real(s.low), "high",
                                  json_of_real(s.high), "speed_max", json_of_real(s.speed_max)));
    return results_text(json);
}

static cuvette_ray hand_ray(const double *n)
{
    return (cuvette_ray){.origin = {n[0], n[1], n[2]}, .direction = {n[3], n[4], n[5]}, .reach = n[6]};
}

char *wasm_motion_pick(const cuvette_motion *motion, const char *name, const double *ray)
{
    const cuvette_ray along = hand_ray(ray);
    double where[3] = {0, 0, 0}, distance;
    if (results_note(cuvette_motion_pick(motion, name, &along, where, &distance, &results_last)) != CUVETTE_OK)
        return NULL;
    return results_text(isfinite(distance)
                            ? json_pack("{s:o,s:o}", "distance", json_of_real(distance), "where", results_vector(where))
                            : json_null());
}

char *wasm_motion_grab(cuvette_motion *motion, const char *name, const double *ray, double reach)
{
    const cuvette_ray along = hand_ray(ray);
    double where[3] = {0, 0, 0};
    int hand = CUVETTE_NO_HAND;
    if (results_note(cuvette_motion_grab(motion, name, &along, reach, &hand, where, &results_last)) != CUVETTE_OK)
        return NULL;
    return results_text(hand == CUVETTE_NO_HAND ? json_null()
                                                : json_pack("{s:i,s:o}", "hand", hand, "where", results_vector(where)));
}
