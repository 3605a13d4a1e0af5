/* Parameters by name: every value passes through the parameter table as text, so that a value set as a number equals
 * the value set by its digits. */
#include "scene/model/params.h"
#include "base/number.h"
#include "engine/engine_private.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is_slime(const scene *s, const char *path)
{
    param_place at;
    return param_place_find(s, path, &at, NULL) == STATUS_OK && at.object_group == PARAM_MESH &&
           s->meshes[at.index].source == MESH_SLIME;
}

cuvette_status cuvette_scene_set(cuvette_scene *s, const char *path, const char *value, cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, path, value);
    const bool was_slime = is_slime(s->model, path);
    const status code = scene_set(s->model, path, value, &inner);
    if (code == STATUS_OK &&
        (was_slime || is_slime(s->model, path))) /* also if the mesh became a slime or ceased to be one */
        s->slimes_changed++;
    return engine_report(code, &inner, why);
}

cuvette_status cuvette_scene_set_double(cuvette_scene *s, const char *path, double value, cuvette_diagnostic *why)
{
    ENGINE_ENTER();
    char text[NUMBER_TEXT_MAX];
    return cuvette_scene_set(s, path, number_format(value, text), why);
}

static bool is_switch(const param *row)
{
    return row->type == PARAM_CHOICE && strcmp(row->choices[0], "off") == 0 && strcmp(row->choices[1], "on") == 0 &&
           !row->choices[2];
}

cuvette_status cuvette_scene_set_int(cuvette_scene *s, const char *path, int64_t value, cuvette_diagnostic *why)
{
    ENGINE_CALL(s, path);
    param_place at;
    char text[NUMBER_TEXT_MAX];
    snprintf(text, sizeof text, "%lld", (long long)value);
    const param *row = param_place_find(s->model, path, &at, NULL) == STATUS_OK ? at.row : NULL;
    const bool is_small = value == 0 || value == 1;
    const char *word = !row                            ? NULL
                       : is_switch(row)                ? (is_small ? row->choices[value] : NULL)
                       : value == row->automatic_value ? row->automatic
                                                       : NULL;
    return cuvette_scene_set(s, path, word ? word : text, why);
}

cuvette_status cuvette_scene_set_vector(cuvette_scene *s, const char *path, const double *values, size_t count,
                                        cuvette_diagnostic *why)
{
    ENGINE_ENTER();
    enum { EACH = NUMBER_TEXT_MAX + 1, MOST = NUMBER_LIST_MAX + 1 };
    char text[MOST * EACH + 3] = "[", number[NUMBER_TEXT_MAX];
    size_t length = 1;
    if (count > 0)
        ENGINE_NEED(values);
    if (count > MOST) /* the table reports a list that is too long */
        count = MOST;
    for (size_t i = 0; i < count; i++)
        length += (size_t)snprintf(text + length, sizeof text - length, "%s%s", i ? "," : "",
                                   number_format(values[i], number));
    snprintf(text + length, sizeof text - length, "]");
    return cuvette_scene_set(s, path, text, why);
}

static cuvette_status get(const cuvette_scene *s, const char *path, char **value, cuvette_diagnostic *why)
{
    ENGINE_NEED(s, path);
    diagnostic inner = {.line = 0};
    return engine_report(scene_get(s->model, path, value, &inner), &inner, why);
}

cuvette_status cuvette_scene_get(const cuvette_scene *s, const char *path, char *text, size_t size, size_t *length,
                                 cuvette_diagnostic *why)
{
    ENGINE_ENTER();
    char *value;
    if (size > 0)
        ENGINE_NEED(text);
    ENGINE_TRY(get(s, path, &value, why));
    return engine_copy_text(value, text, size, length, why);
}

static cuvette_status is_no_number(const char *path, const char *value, const char *kind, cuvette_diagnostic *why)
{
    diagnostic inner = {.line = 0};
    return engine_report(diagnose(&inner, STATUS_BAD_INPUT, "use cuvette_scene_get, which returns text",
                                  "%.128s is '%.128s', not %s", path, value, kind),
                         &inner, why);
}

cuvette_status cuvette_scene_get_double(const cuvette_scene *s, const char *path, double *value,
                                        cuvette_diagnostic *why)
{
    ENGINE_ENTER();
    char *text;
    double number = 0.0;
    ENGINE_NEED(value);
    ENGINE_TRY(get(s, path, &text, why));
    cuvette_status code = CUVETTE_OK;
    if (number_parse_real(text, &number))
        *value = number;
    else
        code = is_no_number(path, text, "a number", why);
    free(text);
    return code;
}

cuvette_status cuvette_scene_get_int(const cuvette_scene *s, const char *path, int64_t *value, cuvette_diagnostic *why)
{
    ENGINE_ENTER();
    char *text;
    int64_t number = 0;
    ENGINE_NEED(value);
    ENGINE_TRY(get(s, path, &text, why));
    cuvette_status code = CUVETTE_OK;
    param_place at = {.row = NULL};
    if (param_place_find(s->model, path, &at, NULL) == STATUS_OK && is_switch(at.row))
        *value = strcmp(text, "on") == 0;
    else if (at.row && at.row->automatic && strcmp(text, at.row->automatic) == 0)
        *value = at.row->automatic_value;
    else if (number_parse_int(text, &number))
        *value = number;
    else
        code = is_no_number(path, text, "an integer", why);
    free(text);
    return code;
}

/* Parses "[1, 2, 3]", "1,2,3", or a single number; returns their count, or -1. Modifies text. */
static int parse_numbers(char *text, double numbers[NUMBER_LIST_MAX])
{
    int count = 0;
    char *rest = text;
    for (char *word; (word = strtok_r(rest, "[], ", &rest));) {
        if (count == NUMBER_LIST_MAX || !number_parse_real(word, &numbers[count]))
            return -1;
        count++;
    }
    return count;
}

cuvette_status cuvette_scene_get_vector(const cuvette_scene *s, const char *path, double *values, size_t room,
                                        size_t *count, cuvette_diagnostic *why)
{
    ENGINE_ENTER();
    char *text;
    double numbers[NUMBER_LIST_MAX];
    ENGINE_NEED(count);
    if (room > 0)
        ENGINE_NEED(values);
    ENGINE_TRY(get(s, path, &text, why));
    const int found = parse_numbers(text, numbers);
    free(text);
    if (found < 0) {
        diagnose(&inner, STATUS_BAD_INPUT, "use cuvette_scene_get, which returns text",
                 "%.128s is not a list of numbers", path);
        return engine_report(STATUS_BAD_INPUT, &inner, why);
    }
    *count = (size_t)found;
    if ((size_t)found > room) {
        diagnose(&inner, STATUS_BAD_INPUT, "make room for the reported count", "%.128s has %d numbers", path, found);
        return engine_report(STATUS_BAD_INPUT, &inner, why);
    }
    memcpy(values, numbers, (size_t)found * sizeof *numbers);
    return CUVETTE_OK;
}

typedef struct visitor {
    bool (*visit)(void *context, const cuvette_parameter *one);
    void *context;
    float_environment *host; /* the caller's, for the callback */
} visitor;

static status visit_one(void *context, const char *path, const param *row, const char *value)
{
    const visitor *v = context;
    char range[1024];
    const cuvette_parameter one = {.path = path,
                                   .value = value,
                                   .unit = row->unit,
                                   .range = param_range_text(row, range, sizeof range),
                                   .initial = row->fallback,
                                   .meaning = row->meaning};
    float_environment_leave(v->host);
    const bool wants_more = v->visit(v->context, &one);
    float_environment_enter(v->host);
    return wants_more ? STATUS_OK : STATUS_INTERRUPTED;
}

cuvette_status cuvette_scene_each_parameter(const cuvette_scene *s,
                                            bool (*visit)(void *context, const cuvette_parameter *one), void *context,
                                            cuvette_diagnostic *why)
{
    ENGINE_CALL(s);
    ENGINE_NEED_NAMED(visit, "visit");
    visitor v = {visit, context, &host};
    const status code = scene_each_param(s->model, visit_one, &v);
    if (code == STATUS_OK || code == STATUS_INTERRUPTED)
        return CUVETTE_OK;
    return engine_report(diagnose(&inner, code, MEMORY_REMEDY, "out of memory"), &inner, why);
}
