/* Materials, lights and solids of a scene file. */
#include "scene/model/check.h"
#include "scene/model/edit/edit.h"
#include "scene/file/read_entries.h"
#include "scene/model/scene.h"

#include <string.h>

static status read_material(const scene_reader *r, const node *key, const node *map)
{
    status code = read_located(r, key, scene_add_material(r->scene, key->text, NULL, r->why));
    if (code == STATUS_OK) {
        code = read_check_keys(r, PARAM_MATERIAL, map);
    }
    if (code == STATUS_OK) {
        code = read_one_medium(r, map);
    }
    return code == STATUS_OK ? read_entries(r, key->text, PARAM_MATERIAL, map) : code;
}

static status read_light(const scene_reader *r, const node *key, const node *map)
{
    size_t index = 0;
    status code = read_located(r, key, scene_add_light(r->scene, key->text, &index, r->why));
    if (code == STATUS_OK) {
        code = read_check_keys(r, PARAM_LIGHT, map);
    }
    if (code == STATUS_OK) {
        code = read_entries(r, key->text, PARAM_LIGHT, map);
    }
    return code == STATUS_OK ? read_located(r, key, check_light(r->scene, &r->scene->lights[index], r->why)) : code;
}

static status read_shape(const scene_reader *r, const node *key, const node *map, shape_kind *out)
{
    const node *shape = node_get(map, "shape");
    if (!shape) {
        char remedy[200] = "add shape: ";
        const size_t used = strlen(remedy);
        scene_shape_words("or", remedy + used, sizeof remedy - used);
        return node_error(r->file, key, r->why, remedy, "%s has no shape", key->text);
    }
    status code = read_expect_word(r, shape, "shape");
    return code == STATUS_OK ? read_located(r, shape, scene_shape_named(shape->text, out, r->why)) : code;
}

/* Gives the solid the material that its entry names, if any. */
static status read_material_name(const scene_reader *r, const node *key, const node *map)
{
    const node *word = node_get(map, "material");
    if (!word) {
        return STATUS_OK;
    }
    status code = read_expect_word(r, word, "material");
    return code == STATUS_OK ? read_located(r, word, scene_give_material(r->scene, key->text, word->text, r->why))
                             : code;
}

static status read_solid(const scene_reader *r, const node *key, const node *map)
{
    shape_kind shape = {0};
    size_t index = 0;
    status code = read_check_keys(r, PARAM_SOLID, map);
    if (code == STATUS_OK) {
        code = read_one_medium(r, map);
    }
    if (code == STATUS_OK) {
        code = read_shape(r, key, map, &shape);
    }
    if (code == STATUS_OK) {
        code = read_located(r, key, scene_add_solid(r->scene, key->text, shape, &index, r->why));
    }
    if (code == STATUS_OK) {
        code = read_material_name(r, key, map);
    }
    if (code == STATUS_OK) {
        code = read_entries(r, key->text, PARAM_SOLID, map);
    }
    return code == STATUS_OK ? read_located(r, key, check_solid(r->scene, &r->scene->solids[index], r->why)) : code;
}

status read_objects(const scene_reader *r, const char *name, const node *map, read_object_call *read_object)
{
    status code = read_expect_map(r, map, name);
    for (size_t i = 0; i < map->count && code == STATUS_OK; i++) {
        code = read_expect_map(r, map->items[i], map->keys[i]->text);
        if (code == STATUS_OK) {
            code = read_object(r, map->keys[i], map->items[i]);
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
