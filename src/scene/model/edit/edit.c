/* Removes and renames objects. Adding is in edit_add.c, materials and shapes of solids in edit_solid.c, placement in
 * edit_place.c. */
#include "scene/model/edit/edit.h"
#include "scene/model/check.h"
#include "scene/model/objects.h"
#include "scene/model/params_path.h"
#include "scene/model/params_value.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static status remove_material(scene *s, size_t index, diagnostic *why)
{
    const char *user = NULL;
    size_t users = 0;
    for (size_t i = 0; i < s->solid_count; i++) {
        if (s->solids[i].material_index == (int)index) {
            user = user ? user : s->solids[i].name;
            users++;
        }
    }
    if (user) {
        char others[48] = "";
        if (users > 1)
            snprintf(others, sizeof others, " and %zu more", users - 1);
        return diagnose(why, STATUS_BAD_INPUT, "assign another material to them first, or remove them",
                        "%.80s is the material of %.80s%s", s->materials[index].name, user, others);
    }
    object_remove(s, PARAM_MATERIAL, index);
    for (size_t i = 0; i < s->solid_count; i++)
        s->solids[i].material_index -= s->solids[i].material_index > (int)index;
    return STATUS_OK;
}

static status in_use(const char *what, const char *name, const char *user, diagnostic *why)
{
    char remedy[200];
    snprintf(remedy, sizeof remedy, "first give %.80s another %s, or remove %.80s", user, what, user);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%.80s is the %s of %.80s", name, what, user);
}

static status remove_mesh(scene *s, size_t index, diagnostic *why)
{
    const mesh_entry *m = &s->meshes[index];
    for (size_t i = 0; i < s->solid_count; i++)
        if (solid_shows(&s->solids[i], m->name))
            return in_use("mesh", m->name, s->solids[i].name, why);
    object_remove(s, PARAM_MESH, index);
    return STATUS_OK;
}

static status remove_texture(scene *s, size_t index, diagnostic *why)
{
    const texture_entry *t = &s->textures[index];
    for (size_t i = 0; i < s->material_count; i++)
        if (strcmp(s->materials[i].value.texture, t->name) == 0)
            return in_use("texture", t->name, s->materials[i].name, why);
    for (size_t i = 0; i < s->solid_count; i++)
        if (strcmp(s->solids[i].surface.texture, t->name) == 0)
            return in_use("texture", t->name, s->solids[i].name, why);
    object_remove(s, PARAM_TEXTURE, index);
    return STATUS_OK;
}

status scene_remove(scene *s, const char *name, diagnostic *why)
{
    param_place at;
    TRY(param_place_find_object(s, name, &at, why));
    switch (at.object_group) {
    case PARAM_MESH: return remove_mesh(s, at.index, why);
    case PARAM_TEXTURE: return remove_texture(s, at.index, why);
    case PARAM_MATERIAL: return remove_material(s, at.index, why);
    case PARAM_LIGHT:
    case PARAM_BEAM:
    case PARAM_SOLID: object_remove(s, at.object_group, at.index); return STATUS_OK;
    case PARAM_RENDER: return param_set_defaults(PARAM_RENDER, &s->render, why);
    case PARAM_CAMERA: s->camera.aimed = 1; return param_set_defaults(PARAM_CAMERA, &s->camera, why);
    case PARAM_BACKGROUND:
        image_destroy(s->background.img);
        s->background.img = NULL;
        s->background.image_line = s->background.image_column = 0;
        return param_set_defaults(PARAM_BACKGROUND, &s->background, why);
    case PARAM_GROUP_COUNT: break;
    }
    return STATUS_FAILURE;
}

/* Solids and materials refer to meshes and textures by name. */
static void follow_name(scene *s, const param_place *at, const char *from, const char *to)
{
    for (size_t i = 0; i < s->solid_count; i++) {
        solid *owner = &s->solids[i];
        if (at->object_group == PARAM_MESH && strcmp(owner->mesh, from) == 0)
            strcpy(owner->mesh, to);
        if (at->object_group == PARAM_TEXTURE && strcmp(owner->surface.texture, from) == 0)
            strcpy(owner->surface.texture, to);
    }
    for (size_t i = 0; at->object_group == PARAM_TEXTURE && i < s->material_count; i++)
        if (strcmp(s->materials[i].value.texture, from) == 0)
            strcpy(s->materials[i].value.texture, to);
}

status scene_rename(scene *s, const char *name, const char *new_name, diagnostic *why)
{
    param_place at;
    TRY(param_place_find_object(s, name, &at, why));
    char *copy = NULL;
    if (!group_has_names(at.object_group))
        return diagnose(why, STATUS_BAD_INPUT, "name a mesh, a texture, a light, a beam, a material or a solid",
                        "the %s has no name", name);
    if (strcmp(name, new_name) == 0)
        return STATUS_OK;
    TRY(check_name(new_name, why));
    TRY(check_name_is_free(s, new_name, why));
    if (!(copy = strdup(new_name)))
        return out_of_memory(why);
    follow_name(s, &at, name, copy);
    object_rename(s, at.object_group, at.index, copy);
    return STATUS_OK;
}

status scene_set_title(scene *s, const char *title, diagnostic *why)
{
    char *copy = strdup(title);
    if (!copy)
        return out_of_memory(why);
    free(s->title);
    s->title = copy;
    return STATUS_OK;
}
