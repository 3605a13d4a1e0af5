/* Materials, lights and solids of a scene file. */
#include "base/text.h"
#include "scene/check.h"
#include "scene/params_path.h"
#include "scene/params_value.h"
#include "scene/read_entries.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One more element at the end of an array, all zero; NULL when memory is out. */
static void *append(void **array, size_t count, size_t size)
{
    char *grown = realloc(*array, (count + 1) * size);
    if (!grown) {
        return NULL;
    }
    *array = grown;
    return memset(grown + count * size, 0, size);
}

/* The name of a new object, checked; fresh memory. */
static status read_name(const scene_reader *r, const node *key, char **name)
{
    status code = check_name(key->text, r->why);
    if (code == STATUS_OK) {
        code = check_name_is_free(r->scene, key->text, r->why);
    }
    if (code != STATUS_OK) {
        return read_located(r, key, code);
    }
    *name = strdup(key->text);
    return *name ? STATUS_OK : read_out_of_memory(r);
}

static status read_material(const scene_reader *r, const node *key, const node *map)
{
    char *name = NULL;
    status code = read_name(r, key, &name);
    if (code != STATUS_OK) {
        return code;
    }
    void *array = r->scene->materials;
    named_material *m = append(&array, r->scene->material_count, sizeof *m);
    r->scene->materials = array;
    if (!m) {
        free(name);
        return read_out_of_memory(r);
    }
    r->scene->material_count++;
    m->name = name;
    code = param_set_defaults(PARAM_MATERIAL, &m->value, r->why);
    if (code == STATUS_OK) {
        code = read_check_keys(r, PARAM_MATERIAL, map);
    }
    if (code == STATUS_OK) {
        code = read_one_medium(r, map);
    }
    return code == STATUS_OK ? read_entries(r, name, PARAM_MATERIAL, map) : code;
}

static status read_light(const scene_reader *r, const node *key, const node *map)
{
    char *name = NULL;
    status code = read_name(r, key, &name);
    if (code != STATUS_OK) {
        return code;
    }
    void *array = r->scene->lights;
    light *l = append(&array, r->scene->light_count, sizeof *l);
    r->scene->lights = array;
    if (!l) {
        free(name);
        return read_out_of_memory(r);
    }
    r->scene->light_count++;
    l->name = name;
    code = param_set_defaults(PARAM_LIGHT, l, r->why);
    if (code == STATUS_OK) {
        code = read_check_keys(r, PARAM_LIGHT, map);
    }
    if (code == STATUS_OK) {
        code = read_entries(r, name, PARAM_LIGHT, map);
    }
    return code == STATUS_OK ? read_located(r, key, check_light(r->scene, l, r->why)) : code;
}

static status read_shape(const scene_reader *r, const node *key, const node *map, shape_kind *out)
{
    const node *shape = node_get(map, "shape");
    if (!shape) {
        return node_error(r->file, key, r->why, "add shape: plane, cylinder, cup, box, sphere or mesh", "%s has no shape",
                          key->text);
    }
    status code = read_expect_word(r, shape, "shape");
    if (code != STATUS_OK) {
        return code;
    }
    const char *words[SHAPE_COUNT];
    for (int k = 0; k < SHAPE_COUNT; k++) {
        words[k] = shape_name((shape_kind)k);
        if (strcmp(words[k], shape->text) == 0) {
            *out = (shape_kind)k;
            return STATUS_OK;
        }
    }
    const char *nearest = text_nearest(shape->text, words, SHAPE_COUNT);
    char remedy[100];
    snprintf(remedy, sizeof remedy,
             nearest ? "did you mean '%s'?" : "the shapes are plane, cylinder, cup, box, sphere and mesh", nearest);
    return node_error(r->file, shape, r->why, remedy, "no shape '%.60s'", shape->text);
}

/* Gives the solid the material that its entry names, if any. */
static status read_material_name(const scene_reader *r, const node *map, solid *owner)
{
    const node *word = node_get(map, "material");
    if (!word) {
        return STATUS_OK;
    }
    status code = read_expect_word(r, word, "material");
    if (code != STATUS_OK) {
        return code;
    }
    const char *names[SCENE_MATERIALS_MAX];
    for (size_t i = 0; i < r->scene->material_count; i++) {
        names[i] = r->scene->materials[i].name;
        if (strcmp(names[i], word->text) == 0) {
            owner->material_index = (int)i;
            owner->surface = r->scene->materials[i].value;
            return STATUS_OK;
        }
    }
    const char *nearest = text_nearest(word->text, names, r->scene->material_count);
    char remedy[SCENE_NAME_MAX + 80] = "add it to materials";
    if (nearest) {
        snprintf(remedy, sizeof remedy, "did you mean '%s'?", nearest);
    }
    return node_error(r->file, word, r->why, remedy, "no material '%.80s'", word->text);
}

static status read_solid(const scene_reader *r, const node *key, const node *map)
{
    char *name = NULL;
    status code = read_name(r, key, &name);
    if (code != STATUS_OK) {
        return code;
    }
    void *array = r->scene->solids;
    solid *owner = append(&array, r->scene->solid_count, sizeof *owner);
    r->scene->solids = array;
    if (!owner) {
        free(name);
        return read_out_of_memory(r);
    }
    r->scene->solid_count++;
    owner->name = name;
    owner->material_index = -1;
    code = param_set_defaults(PARAM_SOLID, owner, r->why);
    if (code == STATUS_OK) {
        code = param_set_defaults(PARAM_MATERIAL, &owner->surface, r->why);
    }
    if (code == STATUS_OK) {
        code = read_check_keys(r, PARAM_SOLID, map);
    }
    if (code == STATUS_OK) {
        code = read_one_medium(r, map);
    }
    if (code == STATUS_OK) {
        code = read_shape(r, key, map, &owner->shape.kind);
    }
    if (code == STATUS_OK) {
        code = read_material_name(r, map, owner);
    }
    if (code == STATUS_OK) {
        code = read_entries(r, name, PARAM_SOLID, map);
    }
    return code == STATUS_OK ? read_located(r, key, check_solid(r->scene, owner, r->why)) : code;
}

status read_objects(const scene_reader *r, const char *name, const node *map, read_object_call *read_object)
{
    status code = read_expect_map(r, map, name);
    for (size_t i = 0; i < map->count && code == STATUS_OK; i++) {
        code = read_expect_map(r, map->items[i], map->keys[i]->text);
        if (code == STATUS_OK) {
            code = read_object(r, map->keys[i], map->items[i]);
        }
        if (code == STATUS_OK) {
            code = read_located(r, map->keys[i], check_limits(r->scene, r->why));
        }
    }
    return code;
}

status read_materials(const scene_reader *r, const char *name, const node *map)
{
    return read_objects(r, name, map, read_material);
}

status read_lights(const scene_reader *r, const char *name, const node *map)
{
    return read_objects(r, name, map, read_light);
}

status read_solids(const scene_reader *r, const char *name, const node *map)
{
    return read_objects(r, name, map, read_solid);
}
