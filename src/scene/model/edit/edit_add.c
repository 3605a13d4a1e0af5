/* New objects at the end of their sections. */
#include "scene/model/check.h"
#include "scene/model/edit/edit.h"
#include "scene/model/params_value.h"
#include "scene/model/scene.h"

#include <stdlib.h>
#include <string.h>

/* Every object begins with its name. */
_Static_assert(offsetof(mesh_entry, name) == 0 && offsetof(texture_entry, name) == 0 &&
                   offsetof(named_material, name) == 0 && offsetof(light, name) == 0 && offsetof(solid, name) == 0,
               "the name first");

/* One more element at the end of an array, which is not counted yet: all zero but for its name, which is checked. */
static status append(const scene *s, const char *name, void **array, size_t count, size_t size, diagnostic *why)
{
    status code = check_name(name, why);
    if (code == STATUS_OK) {
        code = check_name_is_free(s, name, why);
    }
    if (code != STATUS_OK) {
        return code;
    }
    char *copy = strdup(name), *grown = realloc(*array, (count + 1) * size);
    *array = grown ? grown : *array;
    if (!copy || !grown) {
        free(copy);
        return out_of_memory(why);
    }
    memset(grown + count * size, 0, size);
    memcpy(grown + count * size, &copy, sizeof copy);
    return STATUS_OK;
}

/* Counts the new element unless its making failed with code, or it is one too many. */
static status settle(const scene *s, status code, size_t *count, size_t *index, diagnostic *why)
{
    ++*count;
    if (code == STATUS_OK) {
        code = check_limits(s, why);
    }
    if (code != STATUS_OK) {
        --*count;
    } else if (index) {
        *index = *count - 1;
    }
    return code;
}

status scene_add_material(scene *s, const char *name, size_t *index, diagnostic *why)
{
    void *array = s->materials;
    status code = append(s, name, &array, s->material_count, sizeof *s->materials, why);
    s->materials = array;
    if (code != STATUS_OK) {
        return code;
    }
    named_material *new = &s->materials[s->material_count];
    code = settle(s, param_set_defaults(PARAM_MATERIAL, &new->value, why), &s->material_count, index, why);
    if (code != STATUS_OK) {
        free(new->name);
    }
    return code;
}

status scene_add_light(scene *s, const char *name, size_t *index, diagnostic *why)
{
    void *array = s->lights;
    status code = append(s, name, &array, s->light_count, sizeof *s->lights, why);
    s->lights = array;
    if (code != STATUS_OK) {
        return code;
    }
    light *new = &s->lights[s->light_count];
    code = settle(s, param_set_defaults(PARAM_LIGHT, new, why), &s->light_count, index, why);
    if (code != STATUS_OK) {
        free(new->name);
    }
    return code;
}

status scene_add_mesh(scene *s, const char *name, size_t *index, diagnostic *why)
{
    void *array = s->meshes;
    status code = append(s, name, &array, s->mesh_count, sizeof *s->meshes, why);
    s->meshes = array;
    if (code != STATUS_OK) {
        return code;
    }
    mesh_entry *new = &s->meshes[s->mesh_count];
    code = settle(s, param_set_defaults(PARAM_MESH, new, why), &s->mesh_count, index, why);
    if (code != STATUS_OK) {
        free(new->name);
        free(new->path);
        free(new->script_path);
    }
    return code;
}

status scene_add_texture(scene *s, const char *name, size_t *index, diagnostic *why)
{
    void *array = s->textures;
    status code = append(s, name, &array, s->texture_count, sizeof *s->textures, why);
    s->textures = array;
    if (code != STATUS_OK) {
        return code;
    }
    texture_entry *new = &s->textures[s->texture_count];
    code = settle(s, param_set_defaults(PARAM_TEXTURE, new, why), &s->texture_count, index, why);
    if (code != STATUS_OK) {
        free(new->name);
        free(new->path);
    }
    return code;
}

status scene_add_solid(scene *s, const char *name, shape_kind shape, size_t *index, diagnostic *why)
{
    void *array = s->solids;
    status code = append(s, name, &array, s->solid_count, sizeof *s->solids, why);
    s->solids = array;
    if (code != STATUS_OK) {
        return code;
    }
    solid *new = &s->solids[s->solid_count];
    new->shape.kind = shape;
    new->material_index = -1;
    code = param_set_defaults(PARAM_SOLID, new, why);
    if (code == STATUS_OK) {
        code = param_set_defaults(PARAM_MATERIAL, &new->surface, why);
    }
    code = settle(s, code, &s->solid_count, index, why);
    if (code != STATUS_OK) {
        free(new->name);
    }
    return code;
}
