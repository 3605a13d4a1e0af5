/* Creates, copies, finds and removes the objects of every group, by a table of where the scene stores them. */
#include "scene/model/face_materials.h"
#include "scene/model/names.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Where a scene stores the objects of a group. */
typedef struct group_storage {
    size_t at;    /* offset of the pointer to the array, or of the struct of a group without names */
    size_t count; /* offset of the array's length */
    size_t size;  /* size of an element */
    size_t value; /* offset in an element of the struct to which the rows of the table refer */
} group_storage;

static const group_storage lists[PARAM_GROUP_COUNT] = {
    [PARAM_RENDER] = {.at = offsetof(scene, render)},
    [PARAM_CAMERA] = {.at = offsetof(scene, camera)},
    [PARAM_BACKGROUND] = {.at = offsetof(scene, background)},
    [PARAM_MESH] = {offsetof(scene, meshes), offsetof(scene, mesh_count), sizeof(mesh_entry), 0},
    [PARAM_TEXTURE] = {offsetof(scene, textures), offsetof(scene, texture_count), sizeof(texture_entry), 0},
    [PARAM_DATA] = {offsetof(scene, data), offsetof(scene, data_count), sizeof(data_entry), 0},
    [PARAM_LIGHT] = {offsetof(scene, lights), offsetof(scene, light_count), sizeof(light), 0},
    [PARAM_BEAM] = {offsetof(scene, beams), offsetof(scene, beam_count), sizeof(beam), 0},
    [PARAM_MATERIAL] = {offsetof(scene, materials), offsetof(scene, material_count), sizeof(named_material),
                        offsetof(named_material, value)},
    [PARAM_SOLID] = {offsetof(scene, solids), offsetof(scene, solid_count), sizeof(solid), 0},
};

_Static_assert(offsetof(mesh_entry, name) == 0 && offsetof(texture_entry, name) == 0 &&
                   offsetof(data_entry, name) == 0 && offsetof(named_material, name) == 0 &&
                   offsetof(light, name) == 0 && offsetof(beam, name) == 0 && offsetof(solid, name) == 0,
               "the name is the first field");

static size_t *count_of(const scene *s, param_group group)
{
    return (size_t *)((char *)(uintptr_t)s + lists[group].count);
}

static char *array_of(const scene *s, param_group group)
{
    void *array;
    memcpy(&array, (const char *)s + lists[group].at, sizeof array);
    return array;
}

static void set_array(scene *s, param_group group, void *array)
{
    memcpy((char *)s + lists[group].at, &array, sizeof array);
}

static void *object_at(const scene *s, param_group group, size_t index)
{
    const group_storage *l = &lists[group];
    return group_has_names(group) ? array_of(s, group) + index * l->size : (char *)(uintptr_t)s + l->at;
}

void *object_values(const scene *s, param_group group, size_t index)
{
    return (char *)object_at(s, group, index) + lists[group].value;
}

size_t param_place_group_size(const scene *s, param_group group)
{
    return group_has_names(group) ? *count_of(s, group) : 1;
}

const char *param_place_group_name(const scene *s, param_group group, size_t index)
{
    return group_has_names(group) ? *(char **)object_at(s, group, index) : param_group_name(group);
}

static name_place place_in(param_group group, size_t index)
{
    return (name_place){(uint32_t)group, (uint32_t)index};
}

static bool has_name(const scene *s, const name_place *at, const char *name)
{
    const param_group group = (param_group)at->group;
    return at->index < param_place_group_size(s, group) &&
           strcmp(param_place_group_name(s, group, at->index), name) == 0;
}

int object_find(const scene *s, param_group group, const char *name)
{
    const size_t most = group_has_names(group) ? name_tally_most(&s->names, name) : 1;
    const name_place *newest = group_has_names(group) && most > 0 ? name_tally_newest(&s->names, name) : NULL;
    if (most == 0 || (most == 1 && newest && newest->group != (uint32_t)group && has_name(s, newest, name)))
        return -1;
    if (newest && newest->group == (uint32_t)group && has_name(s, newest, name))
        return (int)newest->index;
    for (size_t i = param_place_group_size(s, group); i-- > 0;) /* new objects are at the end */
        if (strcmp(param_place_group_name(s, group, i), name) == 0)
            return (int)i;
    return -1;
}

/* Applies act to the strings that an object owns: its name, and the paths of its files. */
static bool each_text(param_group group, void *object, bool (*act)(char **text))
{
    bool good = act(object);
    for (size_t i = 0; i < param_count(); i++) {
        const param *row = param_at(i);
        if (row->group == group && row->type == PARAM_PATH)
            good &= act((char **)((char *)object + lists[group].value + row->offset));
    }
    return good;
}

static bool copy_text(char **text)
{
    *text = strdup(*text);
    return *text != NULL;
}

static bool free_text(char **text)
{
    free(*text);
    return true;
}

static void release(param_group group, void *object)
{
    if (group == PARAM_MESH)
        mesh_entry_unload(object);
    else if (group == PARAM_TEXTURE)
        texture_entry_unload(object);
    else if (group == PARAM_DATA)
        data_entry_unload(object);
    each_text(group, object, free_text);
}

void *object_append(scene *s, param_group group, const char *name)
{
    const size_t size = lists[group].size, count = *count_of(s, group);
    char *copy = strdup(name), *grown = realloc(array_of(s, group), (count + 1) * size);
    if (grown)
        set_array(s, group, grown);
    if (!copy || !grown) {
        free(copy);
        return NULL;
    }
    char *added = memset(grown + count * size, 0, size);
    *(char **)added = copy;
    name_tally_add(&s->names, copy, place_in(group, count));
    ++*count_of(s, group);
    return added;
}

void object_remove(scene *s, param_group group, size_t index)
{
    const size_t size = lists[group].size, left = --*count_of(s, group);
    char *gap = object_at(s, group, index);
    name_tally_remove(&s->names, *(char **)gap);
    release(group, gap);
    memmove(gap, gap + size, (left - index) * size);
    for (size_t i = index; i < left; i++)
        name_tally_move(&s->names, param_place_group_name(s, group, i), place_in(group, i));
}

/* Makes a bitwise copy independent: copies owned memory, and adds a reference to loaded data. */
static bool copy_owned(param_group group, void *object)
{
    if (group == PARAM_MESH) {
        const mesh_entry *m = object;
        face_materials_retain(m->shading_materials);
        if (m->data)
            mesh_retain(m->data);
    } else if (group == PARAM_TEXTURE && ((const texture_entry *)object)->data) {
        texture_retain(((const texture_entry *)object)->data);
    } else if (group == PARAM_DATA && ((const data_entry *)object)->data) {
        optical_data_retain(((const data_entry *)object)->data);
    }
    return each_text(group, object, copy_text);
}

bool object_assign(scene *s, param_group group, size_t to, size_t from)
{
    char *object = object_at(s, group, to), *name = strdup(*(char **)object);
    release(group, object);
    memcpy(object, object_at(s, group, from), lists[group].size);
    const bool complete = copy_owned(group, object);
    free(*(char **)object);
    *(char **)object = name;
    return complete && name;
}

static bool clone_list(scene *s, const scene *original, param_group group)
{
    const size_t count = *count_of(original, group), size = lists[group].size;
    char *array = count ? malloc(count * size) : NULL;
    if (!array)
        return count == 0;
    memcpy(array, array_of(original, group), count * size);
    set_array(s, group, array);
    *count_of(s, group) = count;
    bool complete = true;
    for (size_t i = 0; i < count; i++) {
        char *object = array + i * size;
        complete &= copy_owned(group, object);
        name_tally_add(&s->names, *(char **)object ? *(char **)object : "", place_in(group, i));
    }
    return complete;
}

bool objects_clone(scene *s, const scene *original)
{
    bool complete = true;
    for (int g = PARAM_MESH; g < PARAM_GROUP_COUNT; g++)
        complete &= clone_list(s, original, (param_group)g);
    return complete;
}

void objects_release(scene *s)
{
    for (int g = PARAM_MESH; g < PARAM_GROUP_COUNT; g++) {
        for (size_t i = 0; i < *count_of(s, (param_group)g); i++)
            release((param_group)g, object_at(s, (param_group)g, i));
        free(array_of(s, (param_group)g));
    }
    name_tally_clear(&s->names);
}

void object_rename(scene *s, param_group group, size_t index, char *name)
{
    char **field = object_at(s, group, index);
    name_tally_remove(&s->names, *field);
    name_tally_add(&s->names, name, place_in(group, index));
    free(*field);
    *field = name;
}

char *object_remedy(const scene *s, param_group group, const char *wrong, char *text, size_t size)
{
    enum { ROOM = 256 };
    const char *words[ROOM];
    size_t count = 0;
    for (; count < param_place_group_size(s, group) && count < ROOM; count++)
        words[count] = param_place_group_name(s, group, count);
    const char *nearest = suggest_word(wrong, words, count);
    if (nearest)
        snprintf(text, size, "did you mean '%s'?", nearest);
    else
        snprintf(text, size, "add it to %s%s", param_group_name(group), group == PARAM_MESH ? "es" : "s");
    return text;
}
