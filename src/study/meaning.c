#include "study/meaning.h"
#include "base/hash.h"
#include "base/array.h"
#include "base/text.h"
#include "scene/model/params.h"
#include "scene/model/params_value.h"
#include "scene/model/scene.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Takes ownership of both texts. */
static status add(meaning *m, char *name, char *value)
{
    if (!name || !value || !room_for_one(&m->items, m->count, sizeof *m->items)) {
        free(name);
        free(value);
        return STATUS_FAILURE;
    }
    m->items[m->count++] = (meaning_item){name, value};
    return STATUS_OK;
}

typedef struct visit_state {
    meaning *into;
    const scene *of;
    bool without_performance, by_chance;
} visit_state;

static status add_param(void *context, const char *path, const param *row, const char *value)
{
    visit_state *state = context;
    if (row->group == PARAM_BEAM && !scene_film_depends_on(state->of, path))
        return STATUS_OK;
    if ((state->without_performance && row->performance_only) || (row->by_chance && !state->by_chance))
        return STATUS_OK;
    char *usual = param_first_default_text(row);
    status code = STATUS_FAILURE;
    if (usual)
        code = strcmp(usual, value) == 0 ? STATUS_OK : add(state->into, strdup(path), strdup(value));
    free(usual);
    return code;
}

/* Every object is listed, including those with all parameters at their defaults. */
static status add_objects(meaning *m, const scene *of, param_group group)
{
    for (size_t i = 0; i < param_place_group_size(of, group); i++)
        if (group != PARAM_BEAM || of->beams[i].lights) /* no film depends on the others */
            TRY(add(m, text_format("%s %zu", param_group_name(group), i),
                    strdup(param_place_group_name(of, group, i))));
    return STATUS_OK;
}

static status add_solid(meaning *m, const scene *of, const solid *owner)
{
    TRY(add(m, text_format("shape of %s", owner->name), strdup(shape_name(owner->shape.kind))));
    if (owner->material_index >= 0)
        TRY(add(m, text_format("material of %s", owner->name), strdup(of->materials[owner->material_index].name)));
    return STATUS_OK;
}

status meaning_of_scene(meaning *m, const scene *of, bool without_performance)
{
    static const param_group groups[] = {PARAM_MESH, PARAM_TEXTURE,  PARAM_LIGHT,
                                         PARAM_BEAM, PARAM_MATERIAL, PARAM_SOLID};
    visit_state state = {m, of, without_performance, integrator_traits_of(&of->render)->by_chance};
    TRY(scene_each_param(of, add_param, &state));
    TRY(add(m, strdup("the camera's direction"), strdup(of->camera.aimed ? "its target" : "its angles")));
    for (size_t i = 0; i < sizeof groups / sizeof *groups; i++)
        TRY(add_objects(m, of, groups[i]));
    for (size_t i = 0; i < of->solid_count; i++)
        TRY(add_solid(m, of, &of->solids[i]));
    return STATUS_OK;
}

void meaning_free(meaning *m)
{
    for (size_t i = 0; i < m->count; i++) {
        free(m->items[i].name);
        free(m->items[i].value);
    }
    free(m->items);
    *m = (meaning){0};
}

uint64_t meaning_hash(const meaning *m)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < m->count; i++) {
        const meaning_item *item = &m->items[i];
        const uint64_t name = hash_bytes(HASH_START, item->name, strlen(item->name) + 1);
        sum += hash_finish(hash_bytes(name, item->value, strlen(item->value) + 1));
    }
    return sum;
}
