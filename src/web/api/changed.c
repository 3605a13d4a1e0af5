/* The parameters in which two scenes differ, as JSON. */
#include "web/api/api.h"

#include "base/text.h"
#include "report/json.h"
#include "report/report.h"
#include "scene/model/scene.h"
#include <stdlib.h>
#include <string.h>

static status add_value(void *context, const char *path, const param *row, const char *text)
{
    return json_object_set_new(context, path, report_value(row, text)) ? STATUS_FAILURE : STATUS_OK;
}

/* Only parameters in use: an aimed camera has no angles of its own. */
static json_t *values_of(const scene *s)
{
    json_t *values = json_object();
    return json_if(values, values && scene_each_param(s, add_value, values) == STATUS_OK);
}

static int add_change(json_t *list, const char *path, json_t *a, json_t *b)
{
    return json_array_append_new(
        list, json_pack("{s:s, s:O?, s:O?}", "path", path, "a", a ? a : json_null(), "b", b ? b : json_null()));
}

/* Whether path belongs to a solid and has the value of the solid's material. */
static bool is_inherited(const scene *s, const json_t *values, const char *path)
{
    const char *dot = strchr(path, '.');
    const size_t length = dot ? (size_t)(dot - path) : 0;
    for (size_t i = 0; dot && i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        if (strlen(one->name) != length || strncmp(one->name, path, length) != 0 || one->material_index < 0)
            continue;
        char *material_path = text_format("%s%s", s->materials[one->material_index].name, dot);
        const json_t *inherited = material_path ? json_object_get(values, material_path) : NULL;
        free(material_path);
        return inherited && json_equal(inherited, json_object_get(values, path));
    }
    return false;
}

static json_t *list_changes(const scene *scene_a, const scene *scene_b, json_t *a, json_t *b)
{
    json_t *list = json_array(), *value;
    const char *path;
    int bad = !list;
    json_object_foreach(b, path, value)
    {
        json_t *before = json_object_get(a, path);
        if (before && (json_equal(before, value) || (is_inherited(scene_a, a, path) && is_inherited(scene_b, b, path))))
            continue;
        bad |= add_change(list, path, before, value);
    }
    json_object_foreach(a, path, value) if (!json_object_get(b, path)) bad |= add_change(list, path, value, NULL);
    return json_if(list, !bad);
}

json_t *changed_params(const scene *a, const scene *b)
{
    json_t *of_a = values_of(a), *of_b = values_of(b);
    json_t *list = of_a && of_b ? list_changes(a, b, of_a, of_b) : NULL;
    json_decref(of_a);
    json_decref(of_b);
    return list;
}
