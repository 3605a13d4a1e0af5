/* Meshes, textures, materials, lights and solids of a scene file. */
#include "scene/file/read_entries.h"
#include "scene/model/check.h"
#include "scene/model/edit/edit.h"
#include "scene/model/scene.h"

#include <string.h>

static status read_shape(const scene_reader *r, const node *key, const node *map, shape_kind *out)
{
    const node *shape = node_get(map, "shape");
    if (!shape) {
        char remedy[200] = "add shape: ";
        const size_t used = strlen(remedy);
        scene_shape_words("or", remedy + used, sizeof remedy - used);
        return node_error(r->file, key, r->why, remedy, "%s has no shape", key->text);
    }
    TRY(read_expect_word(r, shape, "shape"));
    return read_located(r, shape, scene_shape_named(shape->text, out, r->why));
}

/* Assigns the material in the solid's entry, if any. */
static status read_material_name(const scene_reader *r, const node *key, const node *map)
{
    const node *word = node_get(map, "material");
    if (!word)
        return STATUS_OK;
    TRY(read_expect_word(r, word, "material"));
    return read_located(r, word, scene_give_material(r->scene, key->text, word->text, r->why));
}

/* Adds a solid; its shape and material are not rows of the table. */
static status begin_solid(const scene_reader *r, const node *key, const node *map, size_t *index)
{
    shape_kind shape = {0};
    TRY(read_check_keys(r, PARAM_SOLID, map));
    TRY(read_one_medium(r, map));
    TRY(read_shape(r, key, map, &shape));
    TRY(read_located(r, key, scene_add_solid(r->scene, key->text, shape, index, r->why)));
    return read_material_name(r, key, map);
}

static status begin_object(const scene_reader *r, param_group group, const node *key, const node *map, size_t *index)
{
    if (group == PARAM_SOLID)
        return begin_solid(r, key, map, index);
    status code = read_located(r, key, scene_add(r->scene, group, key->text, index, r->why));
    THEN(code, read_check_keys(r, group, map));
    if (code == STATUS_OK && group == PARAM_MATERIAL)
        code = read_one_medium(r, map);
    const node *generate = node_get(map, "generate");
    if (code == STATUS_OK && group == PARAM_MESH && generate && node_get(map, "file"))
        return node_error(r->file, generate, r->why, "keep one of them", "%.80s has both a file and a generator",
                          key->text);
    return code;
}

static void note_place(const node *file, long *line, long *column)
{
    if (file) {
        *line = file->line;
        *column = file->column;
    }
}

/* Stores the locations of file names, for diagnostics when the files are read. */
static void note_places(const scene_reader *r, param_group group, size_t index, const node *map)
{
    const node *file = node_get(map, "file");
    if (group == PARAM_MESH) {
        mesh_entry *m = &r->scene->meshes[index];
        note_place(file ? file : node_get(map, "generate"), &m->path_line, &m->path_column);
        note_place(node_get(map, "script"), &m->script_line, &m->script_column);
    } else if (group == PARAM_TEXTURE) {
        texture_entry *t = &r->scene->textures[index];
        note_place(file, &t->path_line, &t->path_column);
    }
}

static status read_object(const scene_reader *r, param_group group, const node *key, const node *map)
{
    size_t index = 0;
    TRY(begin_object(r, group, key, map, &index));
    TRY(read_entries(r, key->text, group, map));
    note_places(r, group, index, map);
    return read_located(r, key, check_object(r->scene, group, index, r->why));
}

status read_objects(const scene_reader *r, const char *name, param_group group, const node *map)
{
    status code = read_expect_map(r, map, name);
    for (size_t i = 0; i < map->count && code == STATUS_OK; i++) {
        code = read_expect_map(r, map->items[i], map->keys[i]->text);
        THEN(code, read_object(r, group, map->keys[i], map->items[i]));
    }
    return code;
}
