/* Hashes the contents of a scene's files for the identities of cells: equal names with other contents are another
 * scene. The hash is the same on every machine. */
#include "study/grid.h"

#include "base/file.h"
#include "base/hash.h"
#include "scene/model/face_materials.h"
#include "scene/model/scene.h"
#include <stdlib.h>
#include <string.h>

static void hash_array(uint64_t *hash, const void *array, size_t count, size_t size)
{
    if (array)
        *hash = hash_numbers(*hash, array, count, size);
}

static void hash_texture(uint64_t *hash, const texture *t)
{
    if (t)
        *hash = texture_hash(t, *hash);
}

/* Properties of faces that newer versions read are hashed only if they are not at their defaults, so that old hashes
 * stay valid. */
static void hash_visit(uint64_t *hash, const face_material *l)
{
    const double numbers[] = {l->given, l->color.x, l->color.y, l->color.z, l->diffuse, l->specular, l->shininess};
    hash_array(hash, numbers, sizeof numbers / sizeof *numbers, sizeof *numbers);
    const double later[] = {l->emission, 1.0 - l->opacity};
    for (size_t i = 0; i < sizeof later / sizeof *later; i++) {
        const double numbered[] = {(double)i, later[i]};
        hash_array(hash, later[i] != 0.0 ? numbered : NULL, 2, sizeof *numbered);
    }
    hash_texture(hash, l->img);
}

static void hash_mesh(uint64_t *hash, const mesh *m)
{
    hash_array(hash, m->vertices, m->vertex_count * 3, sizeof(double));
    hash_array(hash, m->triangles, m->triangle_count * 3, sizeof(uint32_t));
    hash_array(hash, m->normals, m->vertex_count * 3, sizeof(double));
    hash_array(hash, m->uvs, m->vertex_count * 2, sizeof(double));
    hash_array(hash, m->slots, m->triangle_count, sizeof *m->slots);
    for (int i = 0; i < m->slot_count; i++)
        if (m->slot_names[i])
            hash_array(hash, m->slot_names[i], strlen(m->slot_names[i]) + 1, 1);
}

/* The text of a slime's script. An unreadable script is skipped: loading it reports the error. */
static status hash_script(uint64_t *hash, const scene *of, const mesh_entry *m, diagnostic *why)
{
    enum { SCRIPT_BYTES_MAX = 1 << 20 };
    char *path = scene_file_path(of, m->script_path), *text = NULL;
    size_t size = 0;
    const status code =
        path ? file_read_below(path, of->limits.root, SCRIPT_BYTES_MAX, &text, &size, why) : out_of_memory(why);
    if (code == STATUS_OK)
        hash_array(hash, text, size, 1);
    free(text);
    free(path);
    return code == STATUS_BAD_INPUT ? STATUS_OK : code;
}

status grid_hash_files(uint64_t *hash, const scene *of, diagnostic *why)
{
    status code = STATUS_OK;
    const image *sky = of->background.img;
    if (sky)
        hash_array(hash, sky->pixel, (size_t)sky->width * (size_t)sky->height * 3, sizeof *sky->pixel);
    for (size_t i = 0; i < of->texture_count; i++)
        hash_texture(hash, of->textures[i].data);
    for (size_t i = 0; i < of->mesh_count; i++) {
        const mesh_entry *m = &of->meshes[i];
        if (m->source == MESH_FILE && m->data)
            hash_mesh(hash, m->data);
        if (m->source == MESH_SLIME && m->script_path[0])
            THEN(code, hash_script(hash, of, m, why));
        for (int slot = 0; slot < face_materials_count(m->shading_materials); slot++)
            hash_visit(hash, face_materials_at(m->shading_materials, slot));
    }
    return code;
}
