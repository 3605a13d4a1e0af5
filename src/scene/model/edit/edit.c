/* Adds, removes and renames objects; assigns materials and shapes to solids. edit_place.c moves and rotates. */
#include "scene/model/edit/edit.h"
#include "base/text.h"
#include "geometry/shapes/shape.h"
#include "scene/model/names.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

status scene_set_title(scene *s, const char *title, diagnostic *why)
{
    char *copy = strdup(title);
    if (!copy)
        return out_of_memory(why);
    free(s->title);
    s->title = copy;
    return STATUS_OK;
}

/* --- adding --- */

/* Sets a new solid to the defaults. Scenes can have many solids: the texts of the table are read for the first. */
static status set_solid_defaults(scene *s, solid *new, diagnostic *why)
{
    if (!s->new_solid) {
        if (!(s->new_solid = calloc(1, sizeof *s->new_solid)))
            return out_of_memory(why);
        TRY(param_set_defaults(PARAM_SOLID, s->new_solid, why));
        TRY(param_set_defaults(PARAM_MATERIAL, &s->new_solid->surface, why));
        s->new_solid->material_index = -1;
        solid_stand(s->new_solid);
    }
    char *name = new->name;
    *new = *s->new_solid;
    new->name = name;
    return STATUS_OK;
}

/* shape: only for solids. */
static status add(scene *s, param_group group, shape_kind shape, const char *name, size_t *index, diagnostic *why)
{
    const size_t at = param_place_group_size(s, group);
    TRY(check_name(name, why));
    TRY(check_name_is_free(s, name, why));
    if (!object_append(s, group, name))
        return out_of_memory(why);
    status code = group == PARAM_SOLID ? set_solid_defaults(s, &s->solids[at], why)
                                       : param_set_defaults(group, object_values(s, group, at), why);
    if (group == PARAM_SOLID)
        s->solids[at].shape.kind = shape;
    if (group == PARAM_BEAM)
        beam_stand(&s->beams[at]);
    /* Counting all solids for each new one is slow: few bounded solids cannot exceed the limits. */
    const shape_rule *rule = shape_of_kind(shape);
    if (group != PARAM_SOLID || rule->unbounded || rule->triangles || s->solid_count > SCENE_PRIMITIVES_MAX / 3)
        THEN(code, check_limits(s, why));
    if (code != STATUS_OK)
        object_remove(s, group, at);
    else if (index)
        *index = at;
    return code;
}

status scene_add(scene *s, param_group group, const char *name, size_t *index, diagnostic *why)
{
    return add(s, group, (shape_kind){0}, name, index, why);
}

status scene_add_solid(scene *s, const char *name, shape_kind shape, size_t *index, diagnostic *why)
{
    return add(s, PARAM_SOLID, shape, name, index, why);
}

/* --- material and shape of a solid, which are not rows of the table --- */

status scene_assign_material(scene *s, const char *solid_name, const char *material_name, diagnostic *why)
{
    param_place at;
    TRY(param_place_find_object(s, solid_name, &at, why));
    if (at.object_group != PARAM_SOLID)
        return diagnose(why, STATUS_BAD_INPUT, "name a solid", "%.80s is a %s, which has no material", solid_name,
                        param_group_name(at.object_group));
    solid *owner = &s->solids[at.index];
    if (!material_name || !material_name[0]) {
        owner->material_index = -1;
        return param_set_defaults(PARAM_MATERIAL, &owner->surface, why);
    }
    const int material_index = object_find(s, PARAM_MATERIAL, material_name);
    if (material_index >= 0) {
        owner->material_index = material_index;
        owner->surface = s->materials[material_index].value;
        return STATUS_OK;
    }
    char remedy[SCENE_NAME_MAX + 80];
    return diagnose(why, STATUS_BAD_INPUT, object_remedy(s, PARAM_MATERIAL, material_name, remedy, sizeof remedy),
                    "no material '%.80s'", material_name);
}

enum { SHAPES_MAX = 64 };

static size_t shape_words(const char *words[SHAPES_MAX])
{
    size_t count = 0;
    for (const shape_rule *rule; count < SHAPES_MAX && (rule = shape_of_kind((shape_kind)count)); count++)
        words[count] = rule->word;
    return count;
}

char *scene_shape_words(const char *conjunction, char *text, size_t size)
{
    const char *words[SHAPES_MAX];
    const size_t last = shape_words(words) - 1;
    suggest_list("", words, last, text, size);
    const size_t used = strlen(text);
    snprintf(text + used, size - used, " %s %s", conjunction, words[last]);
    return text;
}

status scene_shape_named(const char *word, shape_kind *out, diagnostic *why)
{
    if (shape_named(word, out))
        return STATUS_OK;
    const char *words[SHAPES_MAX], *nearest = text_nearest(word, words, shape_words(words));
    char remedy[200], all[160];
    snprintf(remedy, sizeof remedy, nearest ? "did you mean '%s'?" : "the shapes are %s",
             nearest ? nearest : scene_shape_words("and", all, sizeof all));
    return diagnose(why, STATUS_BAD_INPUT, remedy, "'%.60s' is not a shape", word);
}

static status put_shape(scene *s, solid *owner, const char *word, diagnostic *why)
{
    const shape_kind before = owner->shape.kind;
    status code = scene_shape_named(word, &owner->shape.kind, why);
    THEN(code, check_limits(s, why));
    if (code != STATUS_OK)
        owner->shape.kind = before;
    return code;
}

/* The solid at the start of a path, or NULL. */
static solid *owner_of(const scene *s, const char *path)
{
    const size_t length = strcspn(path, ".");
    for (size_t i = 0; i < s->solid_count; i++)
        if (strlen(s->solids[i].name) == length && strncmp(s->solids[i].name, path, length) == 0)
            return &s->solids[i];
    return NULL;
}

status scene_set_property(scene *s, const char *path, const char *value, diagnostic *why)
{
    solid *owner = owner_of(s, path);
    const char *rest = path + strcspn(path, ".");
    if (owner && strcmp(rest, ".material") == 0)
        return scene_assign_material(s, owner->name, value, why);
    if (owner && strcmp(rest, ".shape") == 0)
        return put_shape(s, owner, value, why);
    return scene_set(s, path, value, why);
}

/* --- removing and renaming --- */

static bool is_end_material(const solid *owner, const char *name)
{
    return strcmp(owner->ends[0], name) == 0 || strcmp(owner->ends[1], name) == 0 || strcmp(owner->ends[2], name) == 0;
}

static status remove_material(scene *s, size_t index, diagnostic *why)
{
    const char *user = NULL;
    size_t users = 0;
    for (size_t i = 0; i < s->solid_count; i++) {
        if (s->solids[i].material_index == (int)index || is_end_material(&s->solids[i], s->materials[index].name)) {
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
    char remedy[240];
    snprintf(remedy, sizeof remedy, "first give %.80s another %s, or remove %.80s", user, what, user);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%.80s is the %s of %.80s", name, what, user);
}

static status remove_mesh(scene *s, size_t index, diagnostic *why)
{
    const mesh_entry *m = &s->meshes[index];
    for (size_t i = 0; i < s->solid_count; i++)
        if (solid_uses_mesh(&s->solids[i], m->name))
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

/* The names of data to which a material refers. */
enum { MATERIAL_DATA_NAMES = 5 };
static char *data_name(material *m, int i)
{
    char *const names[MATERIAL_DATA_NAMES] = {m->medium_data, m->color_data, m->absorb_data, m->scatter_data,
                                              m->coating_data};
    return names[i];
}

static bool refers(material *m, const char *name)
{
    bool any = false;
    for (int i = 0; i < MATERIAL_DATA_NAMES; i++)
        any |= strcmp(data_name(m, i), name) == 0;
    return any;
}

static status remove_data(scene *s, size_t index, diagnostic *why)
{
    const data_entry *d = &s->data[index];
    for (size_t i = 0; i < s->material_count; i++)
        if (refers(&s->materials[i].value, d->name))
            return in_use("data file", d->name, s->materials[i].name, why);
    for (size_t i = 0; i < s->solid_count; i++)
        if (refers(&s->solids[i].surface, d->name))
            return in_use("data file", d->name, s->solids[i].name, why);
    for (size_t i = 0; i < s->light_count; i++)
        if (strcmp(s->lights[i].spectrum_data, d->name) == 0)
            return in_use("data file", d->name, s->lights[i].name, why);
    object_remove(s, PARAM_DATA, index);
    return STATUS_OK;
}

status scene_remove(scene *s, const char *name, diagnostic *why)
{
    param_place at;
    TRY(param_place_find_object(s, name, &at, why));
    switch (at.object_group) {
    case PARAM_MESH: return remove_mesh(s, at.index, why);
    case PARAM_TEXTURE: return remove_texture(s, at.index, why);
    case PARAM_DATA: return remove_data(s, at.index, why);
    case PARAM_MATERIAL: return remove_material(s, at.index, why);
    case PARAM_SOLID:
        for (size_t i = 0; s->has_followers && i < s->solid_count; i++)
            if (strcmp(s->solids[i].follows, name) == 0)
                return diagnose(why, STATUS_BAD_INPUT, "first set its follows to another solid, or remove it",
                                "%.80s follows %.80s", s->solids[i].name, name);
        for (size_t i = 0; s->has_followers && i < s->beam_count; i++)
            if (strcmp(s->beams[i].follows, name) == 0)
                return diagnose(why, STATUS_BAD_INPUT, "first set its follows to another solid, or remove it",
                                "%.80s follows %.80s", s->beams[i].name, name);
        object_remove(s, at.object_group, at.index);
        return STATUS_OK;
    case PARAM_LIGHT:
    case PARAM_BEAM: object_remove(s, at.object_group, at.index); return STATUS_OK;
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

static void rename_data(material *m, const char *from, const char *to)
{
    for (int i = 0; i < MATERIAL_DATA_NAMES; i++)
        if (strcmp(data_name(m, i), from) == 0)
            strcpy(data_name(m, i), to);
}

/* Renames the references of solids and materials to a mesh, a texture, data or the material of an end. */
static void follow_name(scene *s, const param_place *at, const char *from, const char *to)
{
    for (size_t i = 0; i < s->solid_count; i++) {
        solid *owner = &s->solids[i];
        if (at->object_group == PARAM_MESH && strcmp(owner->mesh, from) == 0)
            strcpy(owner->mesh, to);
        if (at->object_group == PARAM_MESH && strcmp(owner->points, from) == 0)
            strcpy(owner->points, to);
        if (at->object_group == PARAM_SOLID && strcmp(owner->follows, from) == 0)
            strcpy(owner->follows, to);
        if (at->object_group == PARAM_TEXTURE && strcmp(owner->surface.texture, from) == 0)
            strcpy(owner->surface.texture, to);
        if (at->object_group == PARAM_DATA)
            rename_data(&owner->surface, from, to);
        for (int k = 0; at->object_group == PARAM_MATERIAL && k < 3; k++)
            if (strcmp(owner->ends[k], from) == 0)
                strcpy(owner->ends[k], to);
    }
    for (size_t i = 0; at->object_group == PARAM_SOLID && i < s->beam_count; i++)
        if (strcmp(s->beams[i].follows, from) == 0)
            strcpy(s->beams[i].follows, to);
    for (size_t i = 0; at->object_group == PARAM_DATA && i < s->material_count; i++)
        rename_data(&s->materials[i].value, from, to);
    for (size_t i = 0; at->object_group == PARAM_DATA && i < s->light_count; i++)
        if (strcmp(s->lights[i].spectrum_data, from) == 0)
            strcpy(s->lights[i].spectrum_data, to);
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
