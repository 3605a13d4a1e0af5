/* Optics compared with theory, and random numbers, for scripts. */
#include "wasm/api/results.h"

#include "base/json_build.h"
#include "base/random.h"
#include "report/json.h"
#include "wasm/exports.h"
#include <stdlib.h>

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

void wasm_random(uint32_t key_low, uint32_t key_high, uint32_t a, uint32_t b, uint32_t c, uint32_t d, uint32_t *words)
{
    const random_words r = random_at((uint64_t)key_high << 32 | key_low, a, b, c, d);
    for (int i = 0; i < 4; i++)
        words[i] = r.word[i];
}
