/* Loads the files of a scene: meshes, textures and the background image. */
#include "base/cancel.h"
#include "base/file.h"
#include "geometry/shapes/shape.h"
#include "scene/assets/assets.h"
#include "scene/model/face_materials.h"
#include "scene/model/objects.h"
#include "scene/model/params_value.h"
#include "scene/assets/mesh_make.h"
#include "scene/model/slime.h"
#include "scene/model/scene.h"

#include <stdlib.h>
#include <string.h>

void mesh_entry_unload(mesh_entry *m)
{
    mesh_release(m->data);
    face_materials_release(m->shading_materials);
    m->data = NULL;
    m->shading_materials = NULL;
    m->account = (softbody_quantities){.steps = 0};
    m->motion_s = 0.0;
}

void texture_entry_unload(texture_entry *t)
{
    texture_release(t->data);
    t->data = NULL;
}

const mesh_entry *scene_find_mesh(const scene *s, const char *name)
{
    const int at = object_find(s, PARAM_MESH, name);
    return at < 0 ? NULL : &s->meshes[at];
}

const mesh_entry *scene_mesh_of(const scene *s, const solid *owner)
{
    return shape_of(&owner->shape)->triangles ? scene_find_mesh(s, owner->mesh) : NULL;
}

solid_shape scene_loaded_shape(const scene *s, const solid *owner)
{
    solid_shape shape = owner->shape;
    const mesh_entry *m = scene_mesh_of(s, owner);
    shape.mesh = m ? m->data : NULL;
    return shape;
}

bool solid_shows(const solid *owner, const char *mesh_name)
{
    return shape_of(&owner->shape)->triangles && strcmp(owner->mesh, mesh_name) == 0;
}

const texture_entry *scene_find_texture(const scene *s, const char *name)
{
    const int at = object_find(s, PARAM_TEXTURE, name);
    return at < 0 ? NULL : &s->textures[at];
}

status asset_error(const scene *s, const char *what, long line, long column, const diagnostic *bad, status code,
                   diagnostic *why)
{
    if (line == 0) {
        diagnostic_locate(why, bad->file, bad->line, bad->column);
        return diagnose(why, code, bad->remedy, "%s: %s", what, bad->what);
    }
    diagnostic_locate(why, s->path, line, column);
    return diagnose(why, code, bad->remedy, "%s: %s%s%s", what, bad->file, bad->file[0] ? ": " : "", bad->what);
}

char *scene_file_path(const scene *s, const char *path)
{
    return file_next_to(s->path, path);
}

status sky_check(const image *sky, const char *path, diagnostic *bad)
{
    for (int y = 0; y < sky->height; y++) {
        TRY(cancel_check(bad));
        for (int x = 0; x < sky->width; x++) {
            const float *pixel = &sky->pixel[((size_t)y * (size_t)sky->width + (size_t)x) * 3];
            for (int channel = 0; channel < 3; channel++) {
                if (!(pixel[channel] >= 0.0F && pixel[channel] <= SCENE_SKY_MAX))
                    return diagnose_at(bad, path, STATUS_BAD_INPUT, "scale the image to 0..65536",
                                       "pixel %d,%d is %g in channel %d; the radiance of the sky must be in 0..65536",
                                       x, y, (double)pixel[channel], channel);
            }
        }
    }
    return STATUS_OK;
}

static status load_sky(scene *s, diagnostic *why)
{
    background *sky = &s->background;
    if (sky->kind != BACKGROUND_IMAGE || sky->img || !sky->image_path[0])
        return STATUS_OK;
    char *path = scene_file_path(s, sky->image_path);
    if (!path)
        return out_of_memory(why);
    diagnostic bad = {.what = ""};
    status code = image_read_below(path, s->limits.root, &sky->img, NULL, &bad);
    if (code == STATUS_OK && (code = sky_check(sky->img, path, &bad)) != STATUS_OK) {
        image_destroy(sky->img);
        sky->img = NULL;
    }
    free(path);
    return code == STATUS_OK
               ? code
               : asset_error(s, "background.picture", sky->image_line, sky->image_column, &bad, code, why);
}

static status load_texture(const scene *s, texture_entry *t, diagnostic *why)
{
    char *path = scene_file_path(s, t->path);
    if (!path)
        return out_of_memory(why);
    diagnostic bad = {.what = ""};
    texture *data = NULL;
    const status code = texture_read_below(path, s->limits.root, (texture_space)t->space, (texture_wrap)t->wrap_u,
                                           (texture_wrap)t->wrap_v, (texture_filter)t->filter, &data, &bad);
    free(path);
    t->data = data;
    return code == STATUS_OK ? code : asset_error(s, t->name, t->path_line, t->path_column, &bad, code, why);
}

static bool same_value(const param *row, const char *a, const char *b)
{
    char *x = param_value_text(row, -1, a + row->offset), *y = param_value_text(row, -1, b + row->offset);
    const bool same = x && y && strcmp(x, y) == 0;
    free(x);
    free(y);
    return same;
}

static bool same_mesh(const mesh_entry *a, const mesh_entry *b)
{
    bool same = true;
    for (size_t i = 0; i < param_count() && same; i++) {
        const param *row = param_at(i);
        same = row->group != PARAM_MESH || same_value(row, (const char *)a, (const char *)b);
    }
    return same;
}

void scene_borrow_meshes(scene *s, const scene *from)
{
    for (size_t i = 0; i < s->mesh_count; i++) {
        mesh_entry *m = &s->meshes[i];
        const bool own = m->source == MESH_SLIME && !s->render.keep;
        for (size_t k = 0; k < from->mesh_count && !m->data && !own; k++) {
            const mesh_entry *other = &from->meshes[k];
            if (!other->data || !same_mesh(m, other))
                continue;
            m->data = other->data;
            m->shading_materials = other->shading_materials;
            m->account = other->account;
            m->motion_s = other->motion_s;
            mesh_retain(m->data);
            face_materials_retain(m->shading_materials);
        }
    }
}

/* From its file. */
static status load_mesh(const scene *s, mesh_entry *m, diagnostic *why)
{
    char *path = scene_file_path(s, m->path);
    if (!path)
        return out_of_memory(why);
    diagnostic bad = {.what = ""};
    const status code = mesh_make_from_file(m, path, &s->limits, &bad);
    free(path);
    return code == STATUS_OK ? code : asset_error(s, m->name, m->path_line, m->path_column, &bad, code, why);
}

/* Whether all meshes together exceed the limit: before m is generated, with the triangles that it will have, or after
 * it was loaded. */
static status check_triangles(const scene *s, mesh_entry *m, size_t further, diagnostic *why)
{
    size_t all = further;
    for (size_t i = 0; i < s->mesh_count; i++)
        all += s->meshes[i].data ? s->meshes[i].data->triangle_count : 0;
    if (!s->limits.triangles || all <= s->limits.triangles)
        return STATUS_OK;
    diagnostic bad = {.what = ""};
    const status code =
        diagnose(&bad, STATUS_BAD_INPUT, "use smaller or fewer meshes",
                 "the meshes have %zu triangles together, more than the limit of %zu", all, s->limits.triangles);
    mesh_entry_unload(m);
    return asset_error(s, m->name, m->path_line, m->path_column, &bad, code, why);
}

static status generate_mesh(const scene *s, mesh_entry *m, diagnostic *why)
{
    TRY(check_triangles(s, m, mesh_make_triangles(m), why));
    return mesh_make(m, why);
}

/* Background image and textures. */
static status load_textures(scene *s, diagnostic *why)
{
    TRY(load_sky(s, why));
    for (size_t i = 0; i < s->texture_count; i++)
        if (!s->textures[i].data)
            TRY(load_texture(s, &s->textures[i], why));
    return STATUS_OK;
}

/* Progress of one slime as a part of all slimes that must move. */
typedef struct shared_watch {
    const load_watch *whole;
    double before, own, all; /* as slime_work */
} shared_watch;

static void show_all(void *context, double share_done)
{
    const shared_watch *w = context;
    w->whole->progress(w->whole->context, (w->before + share_done * w->own) / w->all);
}

static double work_of(const mesh_entry *m)
{
    return m->source == MESH_SLIME && !m->data ? slime_work(m) : 0.0;
}

static status load_meshes(scene *s, const load_watch *watch, diagnostic *why)
{
    shared_watch shared = {.whole = watch};
    for (size_t i = 0; i < s->mesh_count; i++)
        shared.all += work_of(&s->meshes[i]);
    status code = STATUS_OK;
    for (size_t i = 0; i < s->mesh_count && code == STATUS_OK; i++) {
        mesh_entry *m = &s->meshes[i];
        shared.own = work_of(m);
        if (!m->data && m->source == MESH_SLIME)
            code = slime_make(s, m, watch ? &(load_watch){show_all, &shared} : NULL, why);
        else if (!m->data && m->source == MESH_FILE)
            code = load_mesh(s, m, why);
        else if (!m->data)
            code = generate_mesh(s, m, why);
        THEN(code, check_triangles(s, m, 0, why));
        shared.before += shared.own;
    }
    return code;
}

status scene_load_until(scene *s, const load_watch *watch, diagnostic *why)
{
    TRY(load_textures(s, why));
    return load_meshes(s, watch, why);
}

status scene_load(scene *s, diagnostic *why)
{
    return scene_load_until(s, NULL, why);
}

status scene_load_files(scene *s, diagnostic *why)
{
    status code = load_textures(s, why);
    for (size_t i = 0; i < s->mesh_count && code == STATUS_OK; i++) {
        mesh_entry *m = &s->meshes[i];
        if (m->source == MESH_FILE && !m->data) {
            code = load_mesh(s, m, why);
            THEN(code, check_triangles(s, m, 0, why));
        } else if (m->source == MESH_SLIME) {
            hand_script *script;
            code = slime_read_script(s, m, &script, why);
            hand_script_destroy(script);
        }
    }
    return code;
}
