/* The objects of a scene: adds, removes, translates, rotates and scales lights, materials and solids; adds meshes,
 * textures and optical data, also from arrays. */
#include "engine/engine_private.h"
#include "optics/optical_data.h"
#include "scene/model/edit/edit.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

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
    static const param_group groups[] = {
        [CUVETTE_LIGHT] = PARAM_LIGHT, [CUVETTE_MATERIAL] = PARAM_MATERIAL, [CUVETTE_SOLID] = PARAM_SOLID,
        [CUVETTE_MESH] = PARAM_MESH,   [CUVETTE_TEXTURE] = PARAM_TEXTURE,   [CUVETTE_DATA] = PARAM_DATA};
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

cuvette_status cuvette_scene_add_mesh(cuvette_scene *s, const char *name, cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, name);
    return engine_report(scene_add(s->model, PARAM_MESH, name, NULL, &inner), &inner, why);
}

cuvette_status cuvette_scene_add_texture(cuvette_scene *s, const char *name, cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, name);
    return engine_report(scene_add(s->model, PARAM_TEXTURE, name, NULL, &inner), &inner, why);
}

/* Element i of the array that is not NULL. */
static double element(const double *doubles, const float *floats, size_t i)
{
    return doubles ? doubles[i] : (double)floats[i];
}

static void copy_vectors(const double *doubles, const float *floats, size_t count, vec3 *out)
{
    for (size_t i = 0; i < count; i++)
        out[i] = vec3_make(element(doubles, floats, 3 * i), element(doubles, floats, 3 * i + 1),
                           element(doubles, floats, 3 * i + 2));
}

static status make_mesh(const cuvette_triangles *t, mesh **out, diagnostic *why)
{
    const bool normals = t->normals || t->normals_float, uvs = t->uvs || t->uvs_float;
    mesh *m = NULL;
    TRY(mesh_create(t->vertex_count, t->triangle_count, normals, uvs, t->slots != NULL, &m, why));
    status code = STATUS_OK;
    copy_vectors(t->vertices, t->vertices_float, t->vertex_count, m->vertices);
    if (normals)
        copy_vectors(t->normals, t->normals_float, t->vertex_count, m->normals);
    for (size_t i = 0; uvs && i < t->vertex_count; i++)
        m->uvs[i] = (mesh_uv){element(t->uvs, t->uvs_float, 2 * i), element(t->uvs, t->uvs_float, 2 * i + 1)};
    for (size_t i = 0; i < t->triangle_count; i++)
        for (size_t k = 0; k < 3; k++)
            m->triangles[i].corner[k] = t->corners[3 * i + k];
    m->slot_count = 1;
    for (size_t i = 0; t->slots && i < t->triangle_count; i++) {
        m->slots[i] = t->slots[i];
        m->slot_count = m->slot_count > t->slots[i] ? m->slot_count : t->slots[i] + 1;
    }
    for (int i = 0; t->slot_names && i < t->slot_count && i < MESH_SLOTS_MAX && code == STATUS_OK; i++) {
        m->slot_count = m->slot_count > i ? m->slot_count : i + 1;
        if (t->slot_names[i] && !(m->slot_names[i] = strdup(t->slot_names[i])))
            code = out_of_memory(why);
    }
    THEN(code, mesh_finish(m, why));
    if (code != STATUS_OK) {
        mesh_release(m);
        return code;
    }
    *out = m;
    return STATUS_OK;
}

static status check_arrays(const cuvette_triangles *t, diagnostic *why)
{
    if (t->size < sizeof *t) /* there is no earlier version yet */
        return diagnose(why, STATUS_BAD_INPUT, "set it to sizeof(cuvette_triangles)",
                        "the triangles' size is %zu, which is too small", t->size);
    if ((!t->vertices == !t->vertices_float && t->vertex_count > 0) || (!t->corners && t->triangle_count > 0))
        return diagnose(why, STATUS_BAD_INPUT, "set vertices, as doubles or floats, and corners",
                        "the triangles lack vertices or corners, or have vertices twice");
    if ((t->normals && t->normals_float) || (t->uvs && t->uvs_float))
        return diagnose(why, STATUS_BAD_INPUT, "set either doubles or floats",
                        "normals or texture coordinates are given twice");
    return STATUS_OK;
}

cuvette_status cuvette_scene_add_triangles(cuvette_scene *s, const char *name, const cuvette_triangles *triangles,
                                           cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, name, triangles);
    mesh *made = NULL;
    size_t index = 0;
    status code = check_arrays(triangles, &inner);
    THEN(code, make_mesh(triangles, &made, &inner));
    THEN(code, scene_add(s->model, PARAM_MESH, name, &index, &inner));
    if (code != STATUS_OK) {
        mesh_release(made);
        return engine_report(code, &inner, why);
    }
    mesh_entry_unload(&s->model->meshes[index]);
    s->model->meshes[index].source = MESH_ARRAYS;
    s->model->meshes[index].data = made;
    return CUVETTE_OK;
}

cuvette_status cuvette_scene_add_pixels(cuvette_scene *s, const char *name, int width, int height, const float *rgb,
                                        cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, name, rgb);
    image *img = NULL;
    texture *made = NULL;
    size_t index = 0;
    status code = width >= 1 && height >= 1 && width <= IMAGE_SIDE_MAX && height <= IMAGE_SIDE_MAX &&
                          width <= SCENE_PIXELS_MAX / height
                      ? image_create(width, height, &img, &inner)
                      : diagnose(&inner, STATUS_BAD_INPUT, "use sides from 1 to 65536, and at most 268435456 pixels",
                                 "a texture cannot be %d x %d", width, height);
    if (code == STATUS_OK) {
        memcpy(img->pixel, rgb, 3 * (size_t)width * (size_t)height * sizeof *rgb);
        code = texture_create(img, TEXTURE_REPEAT, TEXTURE_REPEAT, TEXTURE_TRILINEAR, &made, &inner);
    }
    image_destroy(img);
    THEN(code, scene_add(s->model, PARAM_TEXTURE, name, &index, &inner));
    if (code != STATUS_OK) {
        texture_release(made);
        return engine_report(code, &inner, why);
    }
    texture_entry_unload(&s->model->textures[index]);
    s->model->textures[index].data = made;
    return CUVETTE_OK;
}

cuvette_status cuvette_scene_add_data(cuvette_scene *s, const char *name, cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, name);
    return engine_report(scene_add(s->model, PARAM_DATA, name, NULL, &inner), &inner, why);
}

/* Pairs of a wavelength and a value, as optical_curve has them; NULL without memory. */
static double *pairs_of(const double *lambda_nm, const double *values, size_t count)
{
    double *point = count <= SIZE_MAX / (2 * sizeof *point) ? malloc((2 * count + 1) * sizeof *point) : NULL;
    for (size_t i = 0; point && i < count; i++) {
        point[2 * i] = lambda_nm[i];
        point[2 * i + 1] = values[i];
    }
    return point;
}

/* The diagnostic with the name of the data before it. */
static status of_data(const char *name, status code, diagnostic *why)
{
    const diagnostic bad = *why;
    return code == STATUS_BAD_INPUT ? diagnose(why, code, bad.remedy, "%.80s: %s", name, bad.what) : code;
}

cuvette_status cuvette_scene_add_values(cuvette_scene *s, const char *name, const double *lambda_nm,
                                        const double *values, const double *extinction, size_t count,
                                        cuvette_diagnostic *why)
{
    ENGINE_CHANGE(s, name, lambda_nm, values);
    const optical_data *made = NULL;
    size_t index = 0;
    double *first = pairs_of(lambda_nm, values, count),
           *second = extinction ? pairs_of(lambda_nm, extinction, count) : NULL;
    status code = first && !extinction == !second ? STATUS_OK : out_of_memory(&inner);
    THEN(code, of_data(name,
                       optical_data_create(NULL, (optical_curve){first, count},
                                           (optical_curve){second, second ? count : 0}, &made, &inner),
                       &inner));
    free(first);
    free(second);
    THEN(code, scene_add(s->model, PARAM_DATA, name, &index, &inner));
    if (code != STATUS_OK) {
        optical_data_release(made);
        return engine_report(code, &inner, why);
    }
    s->model->data[index].data = made;
    return CUVETTE_OK;
}
