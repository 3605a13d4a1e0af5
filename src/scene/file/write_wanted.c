#include "scene/file/write_wanted.h"
#include "scene/model/medium.h"
#include "scene/model/params_value.h"
#include "scene/model/scene.h"

#include <stdlib.h>
#include <string.h>

static bool is_material_row(const param *row, size_t offset)
{
    return row->group == PARAM_MATERIAL && row->offset == offset;
}

static bool is_background_row(const param *row, size_t offset)
{
    return row->group == PARAM_BACKGROUND && row->offset == offset;
}

/* A mesh has either a file or a generator. */
static bool is_other_source(const mesh_entry *m, const param *row)
{
    if (row->offset == offsetof(mesh_entry, script_path))
        return false;
    return m->source == MESH_FILE ? row->offset == offsetof(mesh_entry, source)
                                  : row->offset == offsetof(mesh_entry, path);
}

/* The index of a material with another medium has no effect, and writing it would replace that medium. */
static bool is_without_effect(const scene *s, const param_place *at)
{
    if (at->object_group == PARAM_MESH)
        return is_other_source(&s->meshes[at->index], at->row);
    if (is_background_row(at->row, offsetof(background, ior)))
        return s->background.medium != MEDIUM_IOR;
    if (!is_material_row(at->row, offsetof(material, ior)))
        return false;
    const material *m =
        at->object_group == PARAM_SOLID ? &s->solids[at->index].surface : &s->materials[at->index].value;
    return m->medium != MEDIUM_IOR;
}

/* The value that a reader would assume without the line: the material's for a solid with one, else the default. */
static char *implied_text(const scene *s, const param_place *at)
{
    const int index =
        at->object_group == PARAM_SOLID && at->row->group == PARAM_MATERIAL ? s->solids[at->index].material_index : -1;
    if (index < 0)
        return param_default_text(at->row);
    const param_place there = {.row = at->row, .object_group = PARAM_MATERIAL, .index = (size_t)index, .element = -1};
    const material *m = &s->materials[index].value;
    return is_without_effect(s, &there) ? param_default_text(at->row)
                                        : param_value_text(at->row, -1, (const char *)m + at->row->offset);
}

/* The presence of an angle selects aiming by angles. */
static bool is_needed(const param *row)
{
    return row->group == PARAM_CAMERA && row->offset == offsetof(camera, yaw_deg);
}

status write_is_wanted(const scene *s, const param_place *at, const char *value, bool all, bool *wanted,
                       diagnostic *why)
{
    *wanted = false;
    if (is_without_effect(s, at))
        return STATUS_OK;
    char *implied = implied_text(s, at);
    if (!implied)
        return out_of_memory(why);
    /* An empty path is not written, and unused paths are not visited. */
    *wanted = (all && value[0]) || is_needed(at->row) || strcmp(implied, value) != 0;
    free(implied);
    return STATUS_OK;
}
