/* Lights, materials and solids: adding, removing, translating, rotating, scaling. */
#include "engine/engine_private.h"

#include "scene/model/edit/edit.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

cuvette_status cuvette_scene_add_light(cuvette_scene *s, const char *name, cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, name);
    return engine_report(scene_add(s->model, PARAM_LIGHT, name, NULL, &inner), &inner, why);
}

cuvette_status cuvette_scene_add_material(cuvette_scene *s, const char *name, cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, name);
    return engine_report(scene_add(s->model, PARAM_MATERIAL, name, NULL, &inner), &inner, why);
}

cuvette_status cuvette_scene_add_solid(cuvette_scene *s, const char *name, const char *shape, const char *of,
                                       cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, name, shape);
    shape_kind kind = {0};
    status code = scene_shape_named(shape, &kind, &inner);
    THEN(code, scene_add_solid(s->model, name, kind, NULL, &inner));
    if (code == STATUS_OK && of) {
        code = scene_assign_material(s->model, name, of, &inner);
        if (code != STATUS_OK)
            scene_remove(s->model, name, NULL);
    }
    return engine_report(code, &inner, why);
}

cuvette_status cuvette_scene_remove(cuvette_scene *s, const char *name, cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, name);
    const size_t meshes = s->model->mesh_count;
    const status code = scene_remove(s->model, name, &inner);
    s->slimes_changed += s->model->mesh_count != meshes; /* the indices of later meshes have changed */
    return engine_report(code, &inner, why);
}

cuvette_status cuvette_scene_rename(cuvette_scene *s, const char *name, const char *new_name, cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, name, new_name);
    return engine_report(scene_rename(s->model, name, new_name, &inner), &inner, why);
}

cuvette_status cuvette_scene_give_material(cuvette_scene *s, const char *to, const char *of, cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s);
    ENGINE_NEED_NAMED(to, "solid");
    return engine_report(scene_assign_material(s->model, to, of, &inner), &inner, why);
}

cuvette_status cuvette_scene_move(cuvette_scene *s, const char *name, const double *by, cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, name, by);
    return engine_report(scene_move(s->model, name, engine_vector(by), &inner), &inner, why);
}

cuvette_status cuvette_scene_turn(cuvette_scene *s, const char *name, const double *degrees, cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, name, degrees);
    return engine_report(scene_turn(s->model, name, engine_vector(degrees), &inner), &inner, why);
}

cuvette_status cuvette_scene_scale(cuvette_scene *s, const char *name, double factor, cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, name);
    return engine_report(scene_scale(s->model, name, factor, &inner), &inner, why);
}

cuvette_status cuvette_scene_look_at(cuvette_scene *s, const double *target, cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, target);
    return engine_report(scene_look_at(s->model, engine_vector(target), &inner), &inner, why);
}

static param_group group_of(cuvette_object kind)
{
    static const param_group groups[] = {[CUVETTE_LIGHT] = PARAM_LIGHT,
                                         [CUVETTE_MATERIAL] = PARAM_MATERIAL,
                                         [CUVETTE_SOLID] = PARAM_SOLID,
                                         [CUVETTE_MESH] = PARAM_MESH,
                                         [CUVETTE_TEXTURE] = PARAM_TEXTURE};
    return (size_t)kind < sizeof groups / sizeof *groups ? groups[kind] : PARAM_GROUP_COUNT;
}

size_t cuvette_scene_count(const cuvette_scene *s, cuvette_object kind)
{
    return s && group_of(kind) != PARAM_GROUP_COUNT ? param_place_group_size(s->model, group_of(kind)) : 0;
}

const char *cuvette_scene_name(const cuvette_scene *s, cuvette_object kind, size_t index)
{
    return index < cuvette_scene_count(s, kind) ? param_place_group_name(s->model, group_of(kind), index) : NULL;
}
