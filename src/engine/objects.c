/* Lights, materials and solids come, go, move and turn. */
#include "engine/engine_private.h"

#include "scene/model/edit/edit.h"
#include "scene/model/scene.h"

cuvette_status cuvette_scene_add_light(cuvette_scene *s, const char *name, cuvette_diagnostic *why)
{
    ENGINE_ENTER(host);
    ENGINE_CHANGE(s, why);
    ENGINE_NEED(name, why);
    diagnostic inner = {.line = 0};
    return engine_report(scene_add_light(s->model, name, NULL, &inner), &inner, why);
}

cuvette_status cuvette_scene_add_material(cuvette_scene *s, const char *name, cuvette_diagnostic *why)
{
    ENGINE_ENTER(host);
    ENGINE_CHANGE(s, why);
    ENGINE_NEED(name, why);
    diagnostic inner = {.line = 0};
    return engine_report(scene_add_material(s->model, name, NULL, &inner), &inner, why);
}

cuvette_status cuvette_scene_add_solid(cuvette_scene *s, const char *name, const char *shape, const char *of,
                                       cuvette_diagnostic *why)
{
    ENGINE_ENTER(host);
    ENGINE_CHANGE(s, why);
    ENGINE_NEED(name, why);
    ENGINE_NEED(shape, why);
    diagnostic inner = {.line = 0};
    shape_kind kind = {0};
    status code = scene_shape_named(shape, &kind, &inner);
    if (code == STATUS_OK)
        code = scene_add_solid(s->model, name, kind, NULL, &inner);
    if (code == STATUS_OK && of) {
        code = scene_give_material(s->model, name, of, &inner);
        if (code != STATUS_OK)
            scene_remove(s->model, name, NULL);
    }
    return engine_report(code, &inner, why);
}

cuvette_status cuvette_scene_remove(cuvette_scene *s, const char *name, cuvette_diagnostic *why)
{
    ENGINE_ENTER(host);
    ENGINE_CHANGE(s, why);
    ENGINE_NEED(name, why);
    diagnostic inner = {.line = 0};
    const size_t meshes = s->model->mesh_count;
    const status code = scene_remove(s->model, name, &inner);
    s->slimes_changed += s->model->mesh_count != meshes; /* those behind it have other places now */
    return engine_report(code, &inner, why);
}

cuvette_status cuvette_scene_rename(cuvette_scene *s, const char *name, const char *new_name, cuvette_diagnostic *why)
{
    ENGINE_ENTER(host);
    ENGINE_CHANGE(s, why);
    ENGINE_NEED(name, why);
    ENGINE_NEED(new_name, why);
    diagnostic inner = {.line = 0};
    return engine_report(scene_rename(s->model, name, new_name, &inner), &inner, why);
}

cuvette_status cuvette_scene_give_material(cuvette_scene *s, const char *to, const char *of, cuvette_diagnostic *why)
{
    ENGINE_ENTER(host);
    ENGINE_CHANGE(s, why);
    ENGINE_NEED_NAMED(to, "solid", why);
    diagnostic inner = {.line = 0};
    return engine_report(scene_give_material(s->model, to, of, &inner), &inner, why);
}

cuvette_status cuvette_scene_move(cuvette_scene *s, const char *name, const double *by, cuvette_diagnostic *why)
{
    ENGINE_ENTER(host);
    ENGINE_CHANGE(s, why);
    ENGINE_NEED(name, why);
    ENGINE_NEED(by, why);
    diagnostic inner = {.line = 0};
    return engine_report(scene_move(s->model, name, vec3_make(by[0], by[1], by[2]), &inner), &inner, why);
}

cuvette_status cuvette_scene_turn(cuvette_scene *s, const char *name, const double *degrees, cuvette_diagnostic *why)
{
    ENGINE_ENTER(host);
    ENGINE_CHANGE(s, why);
    ENGINE_NEED(name, why);
    ENGINE_NEED(degrees, why);
    diagnostic inner = {.line = 0};
    return engine_report(scene_turn(s->model, name, vec3_make(degrees[0], degrees[1], degrees[2]), &inner), &inner,
                         why);
}

cuvette_status cuvette_scene_scale(cuvette_scene *s, const char *name, double factor, cuvette_diagnostic *why)
{
    ENGINE_ENTER(host);
    ENGINE_CHANGE(s, why);
    ENGINE_NEED(name, why);
    diagnostic inner = {.line = 0};
    return engine_report(scene_scale(s->model, name, factor, &inner), &inner, why);
}

cuvette_status cuvette_scene_look_at(cuvette_scene *s, const double *target, cuvette_diagnostic *why)
{
    ENGINE_ENTER(host);
    ENGINE_CHANGE(s, why);
    ENGINE_NEED(target, why);
    diagnostic inner = {.line = 0};
    return engine_report(scene_look_at(s->model, vec3_make(target[0], target[1], target[2]), &inner), &inner, why);
}

size_t cuvette_scene_count(const cuvette_scene *s, cuvette_object kind)
{
    if (!s)
        return 0;
    switch (kind) {
    case CUVETTE_LIGHT: return s->model->light_count;
    case CUVETTE_MATERIAL: return s->model->material_count;
    case CUVETTE_SOLID: return s->model->solid_count;
    case CUVETTE_MESH: return s->model->mesh_count;
    case CUVETTE_TEXTURE: return s->model->texture_count;
    }
    return 0;
}

const char *cuvette_scene_name(const cuvette_scene *s, cuvette_object kind, size_t index)
{
    if (index >= cuvette_scene_count(s, kind))
        return NULL;
    switch (kind) {
    case CUVETTE_LIGHT: return s->model->lights[index].name;
    case CUVETTE_MATERIAL: return s->model->materials[index].name;
    case CUVETTE_SOLID: return s->model->solids[index].name;
    case CUVETTE_MESH: return s->model->meshes[index].name;
    case CUVETTE_TEXTURE: return s->model->textures[index].name;
    }
    return NULL;
}
