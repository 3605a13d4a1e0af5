/* Attachment of a simulation to a scene: saving and restoring its data, and comparing the slimes of another scene. */
#include "scene/motion/motion_private.h"

#include "base/text.h"
#include "scene/model/params.h"
#include "scene/model/params_value.h"
#include "scene/model/scene.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is_of_the_body(const param *row)
{
    return row->group == PARAM_MESH && row->offset != offsetof(mesh_entry, time_s);
}

/* All its parameters except time_s as one text, and the path of its script. NULL if memory runs out. */
static char *motion_parameters(const scene *s, const mesh_entry *entry)
{
    char *text = NULL, *script = scene_file_path(s, entry->script_path);
    text_writer writer;
    bool good = script && text_writer_open(&writer, NULL) == STATUS_OK;
    const bool begun = good;
    for (size_t i = 0; i < param_count() && good; i++) {
        const param *row = param_at(i);
        char *value = is_of_the_body(row) ? param_value_text(row, -1, (const char *)entry + row->offset) : NULL;
        good = !is_of_the_body(row) || (value && fprintf(writer.stream, "%s\n", value) >= 0);
        free(value);
    }
    good = good && (!entry->script_path[0] || fprintf(writer.stream, "%s\n", script) >= 0);
    free(script);
    if (begun)
        text_writer_end(&writer, good ? STATUS_OK : STATUS_FAILURE, &text, NULL, NULL);
    return text;
}

static void take_given(given_slime *given, mesh_entry *entry)
{
    *given = (given_slime){
        .time_s = entry->time_s, .data = entry->data, .account = entry->account, .motion_s = entry->motion_s};
    entry->data = NULL;
}

static void give_back(mesh_entry *entry, given_slime *given)
{
    mesh_entry_unload(entry);
    entry->time_s = given->time_s;
    entry->data = given->data;
    entry->account = given->account;
    entry->motion_s = given->motion_s;
    *given = (given_slime){.data = NULL};
}

status motion_remember(scene_motion *m, moving_slime *one, diagnostic *why)
{
    mesh_entry *entry = motion_entry(m, one);
    one->name = strdup(entry->name);
    one->parameters = motion_parameters(m->s, entry);
    if (!one->name || !one->parameters)
        return out_of_memory(why);
    take_given(&one->given, entry);
    return STATUS_OK;
}

void motion_forget(moving_slime *one)
{
    slime_destroy(&one->x);
    mesh_release(one->given.data);
    mesh_release(one->surface);
    free(one->name);
    free(one->parameters);
}

void scene_motion_leave(scene_motion *m)
{
    for (size_t i = 0; m->s && i < m->count; i++) {
        moving_slime *one = &m->slimes[i];
        mesh_entry *entry = motion_entry(m, one);
        one->surface = entry->data;
        entry->data = NULL;
        give_back(entry, &one->given);
    }
    m->s = NULL;
}

void scene_motion_end(scene_motion *m)
{
    if (m) {
        scene_motion_leave(m);
        scene_motion_destroy(m);
    }
}

/* Index of the mesh with the same name and parameters. */
static status find_same(const scene *s, const moving_slime *one, size_t *mesh_index, bool *found, diagnostic *why)
{
    *found = false;
    for (size_t i = 0; i < s->mesh_count; i++) {
        const mesh_entry *entry = &s->meshes[i];
        if (entry->source != MESH_SLIME || strcmp(entry->name, one->name) != 0)
            continue;
        char *parameters = motion_parameters(s, entry);
        if (!parameters)
            return out_of_memory(why);
        *mesh_index = i;
        *found = strcmp(parameters, one->parameters) == 0;
        free(parameters);
        break;
    }
    return STATUS_OK;
}

static void put_into(scene_motion *m, moving_slime *one)
{
    mesh_entry *entry = motion_entry(m, one);
    take_given(&one->given, entry);
    mesh_entry_unload(entry);
    entry->data = one->surface;
    one->surface = NULL;
    motion_take_account(m, one, one->time_s);
}

status scene_motion_join(scene_motion *m, scene *s, bool *joined, diagnostic *why)
{
    *joined = motion_count_slimes(s) == m->count;
    size_t places[SCENE_MESHES_MAX];
    status code = STATUS_OK;
    for (size_t i = 0; i < m->count && *joined && code == STATUS_OK; i++)
        code = find_same(s, &m->slimes[i], &places[i], joined, why);
    if (code != STATUS_OK || !*joined) {
        *joined = false;
        return code;
    }
    scene_motion_leave(m);
    m->s = s;
    for (size_t i = 0; i < m->count && code == STATUS_OK; i++) {
        moving_slime *one = &m->slimes[i];
        const bool had_surface = one->surface != NULL;
        one->entry = places[i];
        put_into(m, one);
        code = had_surface ? STATUS_OK : motion_give_surface(m, one, why);
    }
    return code;
}
