#include "scene/model/params.h"
#include "base/elementary.h"
#include "base/text.h"
#include "scene/model/medium.h"
#include "scene/model/objects.h"
#include "scene/model/params_path.h"
#include "scene/model/params_value.h"
#include "scene/model/scene.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* The struct with the field of a place. */
static void *place_base(const scene *s, const param_place *at)
{
    const bool of_surface = at->object_group == PARAM_SOLID && at->row->group == PARAM_MATERIAL;
    return of_surface ? (void *)&s->solids[at->index].surface : object_values(s, at->object_group, at->index);
}

static bool is_camera_row(const param *row, size_t offset)
{
    return row->group == PARAM_CAMERA && row->offset == offset;
}

static bool is_target(const param *row)
{
    return is_camera_row(row, offsetof(camera, target));
}

static bool is_angle(const param *row)
{
    return is_camera_row(row, offsetof(camera, yaw_deg)) || is_camera_row(row, offsetof(camera, pitch_deg));
}

/* The camera with both of its directions valid: the unused one is derived from the other. */
static camera camera_with_both(camera c)
{
    if (c.aimed) {
        vec3 d = vec3_sub(c.target, c.position);
        c.yaw_deg = elementary_atan2_deg(d.x, d.z);
        c.pitch_deg = elementary_atan2_deg(d.y, sqrt(d.x * d.x + d.z * d.z));
    } else {
        double sin_yaw, cos_yaw, sin_pitch, cos_pitch;
        elementary_sincos_deg(c.yaw_deg, &sin_yaw, &cos_yaw);
        elementary_sincos_deg(c.pitch_deg, &sin_pitch, &cos_pitch);
        c.target = vec3_add(c.position, vec3_make(cos_pitch * sin_yaw, sin_pitch, cos_pitch * cos_yaw));
    }
    return c;
}

/* A constant index replaces a medium that was set before. */
static void forget_medium(scene *s, const param_place *at)
{
    if (at->row->group == PARAM_BACKGROUND && at->row->offset == offsetof(background, ior))
        s->background.medium = MEDIUM_IOR;
    if (at->row->group != PARAM_MATERIAL || at->row->offset != offsetof(material, ior))
        return;
    if (at->object_group == PARAM_SOLID) {
        s->solids[at->index].surface.medium = MEDIUM_IOR;
        return;
    }
    s->materials[at->index].value.medium = MEDIUM_IOR;
    for (size_t i = 0; i < s->solid_count; i++)
        if (s->solids[i].material_index == (int)at->index)
            s->solids[i].surface.medium = MEDIUM_IOR;
}

/* Releases the mesh or image that was loaded for the old value. Setting a file's path also selects the kind `file`. */
static void forget_loaded(scene *s, const param_place *at, param_value value)
{
    const bool names_file = at->row->type == PARAM_PATH, some = names_file && value.path[0];
    if (at->object_group == PARAM_MESH) {
        mesh_entry *m = &s->meshes[at->index];
        mesh_entry_unload(m);
        if (at->row->offset == offsetof(mesh_entry, script_path)) {
            m->script_line = m->script_column = 0;
            return;
        }
        m->source = some ? MESH_FILE : m->source;
        m->path_line = names_file ? 0 : m->path_line;
    } else if (at->object_group == PARAM_TEXTURE) {
        texture_entry *t = &s->textures[at->index];
        texture_entry_unload(t);
        t->path_line = names_file ? 0 : t->path_line;
    } else if (names_file) {
        image_destroy(s->background.img);
        s->background.img = NULL;
        s->background.image_line = s->background.image_column = 0;
        s->background.kind = some ? BACKGROUND_IMAGE : s->background.kind;
    }
}

static void store(scene *s, const param_place *at, param_value value)
{
    forget_medium(s, at);
    const param *row = at->row;
    if (is_target(row) || is_angle(row)) {
        int64_t aimed = is_target(row);
        if (aimed != s->camera.aimed) {
            s->camera = camera_with_both(s->camera);
            s->camera.aimed = aimed;
        }
    }
    forget_loaded(s, at, value);
    param_value_store(row, at->element, (char *)place_base(s, at) + row->offset, value);
    for (size_t i = 0; at->object_group == PARAM_MATERIAL && i < s->solid_count; i++)
        if (s->solids[i].material_index == (int)at->index)
            param_value_store(row, at->element, (char *)&s->solids[i].surface + row->offset, value);
}

status scene_set(scene *s, const char *path, const char *value, diagnostic *why)
{
    param_place at;
    TRY(param_place_find(s, path, &at, why));
    param_value parsed;
    TRY(param_value_parse(at.row, at.element, path, value, &parsed, why));
    store(s, &at, parsed);
    return STATUS_OK;
}

status scene_set_assignment(scene *s, const char *assignment, diagnostic *why)
{
    const char *equals = strchr(assignment, '=');
    if (!equals)
        return diagnose(why, STATUS_BAD_INPUT, "write path=value, such as render.depth=8", "'%.80s' has no '='",
                        assignment);
    char *path = strndup(assignment, (size_t)(equals - assignment));
    if (!path)
        return out_of_memory(why);
    status code = scene_set(s, path, equals + 1, why);
    free(path);
    return code;
}

/* The value of a place in s, whose camera has both directions. */
static char *place_text(const scene *s, const param_place *at)
{
    camera both = camera_with_both(s->camera);
    const char *base = at->object_group == PARAM_CAMERA ? (const char *)&both : place_base(s, at);
    return param_value_text(at->row, at->element, base + at->row->offset);
}

status scene_get(const scene *s, const char *path, char **value, diagnostic *why)
{
    *value = NULL;
    param_place at;
    TRY(param_place_find(s, path, &at, why));
    *value = place_text(s, &at);
    return *value ? STATUS_OK : out_of_memory(why);
}

static status visit_one(const scene *s, const param_place *at, param_visit *visit, void *context)
{
    char *path = text_format("%s.%s", param_place_group_name(s, at->object_group, at->index), at->row->name);
    char *value = place_text(s, at);
    status code = path && value ? visit(context, path, at->row, value) : STATUS_FAILURE;
    free(path);
    free(value);
    return code;
}

/* Parameters that setting would put into use are skipped while they are not in use: the unused direction of the camera,
 * the background image, a mesh's file; and the parameters of slimes for other meshes. */
static bool is_in_use(const scene *s, const param_place *at)
{
    const param *row = at->row;
    if (row->group == PARAM_MESH && row->makers != 0)
        return (row->makers & 1u << s->meshes[at->index].source) != 0;
    if (row->type == PARAM_PATH && row->group == PARAM_MESH)
        return s->meshes[at->index].source == MESH_FILE;
    if (row->type == PARAM_PATH && row->group == PARAM_BACKGROUND && s->background.kind != BACKGROUND_IMAGE)
        return !s->background.image_path[0];
    return s->camera.aimed ? !is_angle(row) : !is_target(row);
}

/* The rows of one object in one group of the table. */
static status visit_rows(const scene *s, param_place at, param_group rows, param_visit *visit, void *context)
{
    status code = STATUS_OK;
    for (size_t i = 0; i < param_count() && code == STATUS_OK; i++) {
        at.row = param_at(i);
        if (at.row->group == rows && is_in_use(s, &at) &&
            (at.object_group != PARAM_SOLID || solid_has(&s->solids[at.index], at.row)))
            code = visit_one(s, &at, visit, context);
    }
    return code;
}

status scene_each_param(const scene *s, param_visit *visit, void *context)
{
    status code = STATUS_OK;
    for (int g = 0; g < PARAM_GROUP_COUNT; g++) {
        param_place at = {.row = NULL, .object_group = (param_group)g, .index = 0, .element = -1};
        for (; at.index < param_place_group_size(s, at.object_group) && code == STATUS_OK; at.index++) {
            code = visit_rows(s, at, at.object_group, visit, context);
            if (code == STATUS_OK && at.object_group == PARAM_SOLID)
                code = visit_rows(s, at, PARAM_MATERIAL, visit, context);
        }
    }
    return code;
}
