/* A scene's texts, parameters, hints and names for scripts. */
#include "wasm/api/results.h"

#include "base/json_build.h"
#include "report/json.h"
#include "wasm/exports.h"
#include <stdlib.h>

/* Reads a text of a length that the first call finds out. */
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
    } kinds[] = {{"lights", CUVETTE_LIGHT},
                 {"materials", CUVETTE_MATERIAL},
                 {"solids", CUVETTE_SOLID},
                 {"meshes", CUVETTE_MESH},
                 {"textures", CUVETTE_TEXTURE}};
    json_t *all = json_object();
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        json_t *list = json_array();
        for (size_t i = 0; i < cuvette_scene_count(scene, kinds[k].kind); i++)
            json_add(&list, json_of_text(cuvette_scene_name(scene, kinds[k].kind, i)));
        json_add_as(&all, kinds[k].key, list);
    }
    return results_text(all);
}
