/* Meshes and textures of a scene file. */
#include "scene/model/check.h"
#include "scene/model/edit/edit.h"
#include "scene/file/read_entries.h"
#include "scene/model/scene.h"

static status no_name(const scene_reader *r, const node *key, status code)
{
    return code == STATUS_OK ? code : read_located(r, key, code);
}

/* Where a file that is named stands, for diagnostics when it is read. */
static void note_place(const node *map, const char *key, long *line, long *column)
{
    const node *file = node_get(map, key);
    if (file) {
        *line = file->line;
        *column = file->column;
    }
}

static status read_mesh(const scene_reader *r, const node *key, const node *map)
{
    size_t index;
    status code = no_name(r, key, scene_add_mesh(r->scene, key->text, &index, r->why));
    if (code == STATUS_OK) {
        code = read_check_keys(r, PARAM_MESH, map);
    }
    const node *file = node_get(map, "file"), *generate = node_get(map, "generate");
    if (code == STATUS_OK && file && generate) {
        return node_error(r->file, generate, r->why, "keep one of them", "%.80s has a file, and is generated too",
                          key->text);
    }
    if (code == STATUS_OK) {
        code = read_entries(r, key->text, PARAM_MESH, map);
    }
    if (code == STATUS_OK) {
        mesh_entry *m = &r->scene->meshes[index];
        note_place(map, file ? "file" : "generate", &m->path_line, &m->path_column);
        note_place(map, "script", &m->script_line, &m->script_column);
        code = no_name(r, key, check_mesh(&r->scene->meshes[index], r->why));
    }
    return code;
}

static status read_texture(const scene_reader *r, const node *key, const node *map)
{
    size_t index;
    status code = no_name(r, key, scene_add_texture(r->scene, key->text, &index, r->why));
    if (code == STATUS_OK) {
        code = read_check_keys(r, PARAM_TEXTURE, map);
    }
    if (code == STATUS_OK) {
        code = read_entries(r, key->text, PARAM_TEXTURE, map);
    }
    if (code == STATUS_OK) {
        note_place(map, "file", &r->scene->textures[index].path_line, &r->scene->textures[index].path_column);
        code = no_name(r, key, check_texture(&r->scene->textures[index], r->why));
    }
    return code;
}

status read_meshes(const scene_reader *r, const char *name, const node *map)
{
    return read_objects(r, name, map, read_mesh);
}

status read_textures(const scene_reader *r, const char *name, const node *map)
{
    return read_objects(r, name, map, read_texture);
}
