/* Adds objects with a suitable name, size, place and colour, and copies objects (placement.h). */
#include "base/file.h"
#include "base/text.h"
#include "geometry/shapes/shape.h"
#include "scene/model/edit/edit.h"
#include "scene/model/face_materials.h"
#include "scene/model/names.h"
#include "scene/model/params.h"
#include "scene/model/place/placement.h"
#include "scene/model/scene.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

status new_name(const scene *s, const char *base, object_name name, diagnostic *why)
{
    for (int n = 1; n <= 9999; n++) {
        snprintf(name, sizeof(object_name), n == 1 ? "%.*s" : "%.*s%d", text_cut(base, SCENE_NAME_MAX - 4), base, n);
        if (check_name(name, NULL) == STATUS_OK && check_name_is_free(s, name, NULL) == STATUS_OK)
            return STATUS_OK;
    }
    return diagnose(why, STATUS_BAD_INPUT, "choose a name", "the names %.60s to %.60s9999 are in use", base, base);
}

static status name_for(const scene *s, const char *wanted, const char *base, object_name name, diagnostic *why)
{
    if (!wanted)
        return new_name(s, base, name, why);
    TRY(check_name(wanted, why));
    strcpy(name, wanted);
    return STATUS_OK;
}

static vec3 rounded(vec3 v, double size)
{
    return vec3_make(placement_round(v.x, size), placement_round(v.y, size), placement_round(v.z, size));
}

/* Sets NAME.ROW by scene_set_property; does nothing after an error. */
static void put(scene *s, status *code, diagnostic *why, const char *name, const char *row, const char *format, ...)
    __attribute__((format(printf, 6, 7)));
static void put(scene *s, status *code, diagnostic *why, const char *name, const char *row, const char *format, ...)
{
    char path[2 * SCENE_NAME_MAX], value[512];
    va_list list;
    va_start(list, format);
    vsnprintf(value, sizeof value, format, list);
    va_end(list);
    snprintf(path, sizeof path, "%s.%s", name, row);
    if (*code == STATUS_OK)
        *code = scene_set_property(s, path, value, why);
}

static void put_number(scene *s, status *code, diagnostic *why, const char *name, const char *row, double value)
{
    put(s, code, why, name, row, "%.17g", value);
}

static void put_vector(scene *s, status *code, diagnostic *why, const char *name, const char *row, vec3 v)
{
    put(s, code, why, name, row, "%.17g,%.17g,%.17g", v.x, v.y, v.z);
}

/* Sets a matte surface, with another colour than the last object's. */
static void put_appearance(scene *s, status *code, diagnostic *why, const char *name, size_t count)
{
    static const char *const colors[] = {"0.85,0.3,0.2", "0.2,0.5,0.85",  "0.3,0.7,0.3",
                                         "0.9,0.7,0.2",  "0.6,0.35,0.75", "0.2,0.7,0.7"};
    put(s, code, why, name, "color", "%s", colors[count % (sizeof colors / sizeof *colors)]);
    put(s, code, why, name, "ambient", "0.25");
    put(s, code, why, name, "diffuse", "0.7");
    put(s, code, why, name, "specular", "0.3");
}

/* If the solid overlaps others, because no place is free, sets its priority above theirs. */
static void put_above_others(scene *s, status *code, diagnostic *why, const char *name)
{
    const int index = scene_find_solid(s, name);
    vec3 centre, other;
    double radius, other_radius;
    if (*code != STATUS_OK || index < 0 || !placement_bounding_sphere(s, &s->solids[index], &centre, &radius))
        return;
    int64_t priority = s->solids[index].priority;
    for (int i = 0; i < (int)s->solid_count; i++)
        if (i != index && s->solids[i].visible && placement_bounding_sphere(s, &s->solids[i], &other, &other_radius) &&
            vec3_length(vec3_sub(other, centre)) < radius + other_radius && s->solids[i].priority >= priority)
            priority = s->solids[i].priority + (s->solids[i].priority < 1000000);
    put(s, code, why, name, "priority", "%lld", (long long)priority);
}

/* Places a floor below the view's target; if the scene has a floor, a wall behind the target. */
static void put_plane(scene *s, status *code, diagnostic *why, const char *name, const placement *where)
{
    double y;
    vec3 at = where->looked_at;
    if (placement_ground(s, at.x, at.z, &y)) {
        at = vec3_add(at, vec3_scale(where->away, where->distance));
        put(s, code, why, name, "rotation", "90,%.17g,0",
            placement_round(atan2(-where->away.x, -where->away.z) * (180.0 / M_PI), 1.0));
    } else {
        at.y -= 0.5 * where->size;
    }
    put_vector(s, code, why, name, "position",
               vec3_make(placement_round(at.x, where->size), placement_round(at.y, where->size),
                         placement_round(at.z, where->size)));
}

/* Sets the dimensions of a shape of the given size, with no more digits than necessary, and places it. */
static void put_sizes(scene *s, status *code, diagnostic *why, const char *name, const placement *where)
{
    solid fitted = s->solids[s->solid_count - 1];
    const shape_rule *rule = shape_of(&fitted.shape);
    rule->fit(&fitted.shape, where->size);
    for (const char *const *parameter = rule->parameters; *parameter; parameter++) {
        const param *row = param_find(PARAM_SOLID, *parameter);
        void *field = (char *)&fitted + row->offset;
        if (row->type == PARAM_REAL)
            *(double *)field = placement_round(*(double *)field, 0.1 * fabs(*(double *)field));
        char *text = param_value_text(row, -1, field);
        if (!text && *code == STATUS_OK)
            *code = out_of_memory(why);
        put(s, code, why, name, *parameter, "%s", text ? text : "");
        free(text);
    }
    const vec3 low = placement_free(s, where, where->size);
    put_vector(s, code, why, name, "position",
               vec3_sub(low, vec3_make(0, shape_extent_of(&fitted.shape).box.low.y, 0)));
}

/* Adds a mesh and a solid that uses it. */
static status add_mesh_solid(scene *s, const char *solid_name, object_name mesh_name, diagnostic *why)
{
    object_name base;
    shape_kind mesh_shape = {0};
    shape_named("mesh", &mesh_shape);
    snprintf(base, sizeof base, "%.*s-mesh", SCENE_NAME_MAX - 9, solid_name);
    status code = new_name(s, base, mesh_name, why);
    THEN(code, scene_add(s, PARAM_MESH, mesh_name, NULL, why));
    THEN(code, scene_add_solid(s, solid_name, mesh_shape, NULL, why));
    put(s, &code, why, solid_name, "mesh", "%s", mesh_name);
    return code;
}

static status new_mesh(scene *s, const char *name, const placement *where, diagnostic *why)
{
    object_name mesh_name;
    const vec3 low = placement_free(s, where, where->size);
    status code = add_mesh_solid(s, name, mesh_name, why);
    const double minor = placement_round(0.15 * where->size, 0.1 * where->size);
    put(s, &code, why, mesh_name, "generate", "torus");
    put_number(s, &code, why, mesh_name, "major", placement_round(0.35 * where->size, 0.1 * where->size));
    put_number(s, &code, why, mesh_name, "minor", minor);
    put_vector(s, &code, why, name, "position", vec3_add(low, vec3_make(0, minor, 0)));
    return code;
}

status new_solid(scene *s, shape_kind shape, const char *wanted, object_name name, diagnostic *why)
{
    const placement where = placement_of(s);
    const size_t count = s->solid_count;
    const shape_rule *rule = shape_of_kind(shape);
    TRY(name_for(s, wanted, rule->triangles ? "ring" : rule->word, name, why));
    status code = STATUS_OK;
    if (rule->triangles) {
        code = new_mesh(s, name, &where, why);
    } else if ((code = scene_add_solid(s, name, shape, NULL, why)) == STATUS_OK) {
        s->solids[s->solid_count - 1].visible = 0; /* so that it does not obstruct its own place */
        if (rule->unbounded)
            put_plane(s, &code, why, name, &where);
        else
            put_sizes(s, &code, why, name, &where);
        s->solids[s->solid_count - 1].visible = 1;
    }
    put_appearance(s, &code, why, name, count);
    if (rule->unbounded)
        put(s, &code, why, name, "color", "0.72,0.7,0.66");
    put_above_others(s, &code, why, name);
    return code;
}

status new_light(scene *s, const char *wanted, object_name name, diagnostic *why)
{
    const placement where = placement_of(s);
    status code = name_for(s, wanted, "lamp", name, why);
    THEN(code, scene_add(s, PARAM_LIGHT, name, NULL, why));
    /* In front of the target, left and right in turn, so that two lights are not at one point. */
    const double side = s->light_count % 2 ? 0.5 : -0.5;
    vec3 at = vec3_add(where.looked_at, vec3_scale(where.right, side * where.distance));
    at = vec3_add(at, vec3_scale(where.away, -0.4 * where.distance));
    at.y += 0.8 * where.distance;
    put_vector(s, &code, why, name, "position",
               vec3_make(placement_round(at.x, where.size), placement_round(at.y, where.size),
                         placement_round(at.z, where.size)));
    put_vector(s, &code, why, name, "target",
               vec3_make(placement_round(where.looked_at.x, where.size), placement_round(where.looked_at.y, where.size),
                         placement_round(where.looked_at.z, where.size)));
    put(s, &code, why, name, "intensity", "0.5");
    return code;
}

/* A laser from the left, across the view, through the point that the camera looks at. */
status new_beam(scene *s, const char *wanted, object_name name, diagnostic *why)
{
    const placement where = placement_of(s);
    status code = name_for(s, wanted, "laser", name, why);
    THEN(code, scene_add(s, PARAM_BEAM, name, NULL, why));
    const vec3 aim = where.looked_at;
    const vec3 at = vec3_add(
        aim, vec3_add(vec3_scale(where.right, -0.4 * where.distance), vec3_make(0.0, 0.1 * where.distance, 0.0)));
    put_vector(s, &code, why, name, "position", rounded(at, where.size));
    put_vector(s, &code, why, name, "target", rounded(aim, where.size));
    return code;
}

status new_material(scene *s, const char *wanted, object_name name, diagnostic *why)
{
    const size_t count = s->material_count;
    status code = name_for(s, wanted, "paint", name, why);
    THEN(code, scene_add(s, PARAM_MATERIAL, name, NULL, why));
    put_appearance(s, &code, why, name, count);
    return code;
}

status new_slime(scene *s, const char *wanted, object_name name, diagnostic *why)
{
    placement where = placement_of(s);
    const double size = placement_round(where.distance / 3.0, where.distance / 3.0), radius = 0.5 * size;
    const vec3 low = placement_free(s, &where, size);
    object_name mesh_name;
    TRY(name_for(s, wanted, "slime", name, why));
    TRY(add_mesh_solid(s, name, mesh_name, why));
    status code = STATUS_OK;
    /* The simulation always has the default size, a ball of radius 1 on a floor at 0, to which stiffness and time step
     * are adapted; the solid is scaled instead. */
    put(s, &code, why, mesh_name, "generate", "slime");
    put_vector(s, &code, why, name, "scale", vec3_make(radius, radius, radius));
    put_vector(s, &code, why, name, "position", low);
    put(s, &code, why, name, "transparency", "0.9");
    put(s, &code, why, name, "ior", "1.2");
    const double metres = radius * s->render.unit_m;
    put(s, &code, why, name, "absorb_per_m", "%.4g,%.4g,%.4g", fmin(2.2 / metres, 1e9), fmin(0.25 / metres, 1e9),
        fmin(1.8 / metres, 1e9));
    put(s, &code, why, name, "specular", "0.7");
    put(s, &code, why, name, "shininess", "120");
    put(s, &code, why, name, "priority", "1");
    put_above_others(s, &code, why, name);
    return code;
}

/* A name from a path: Stanford-bunny for "models/Stanford bunny.obj". */
static void base_of_path(const char *path, const char *otherwise, object_name base)
{
    const char *from = file_name_of(path), *dot = strrchr(from, '.');
    size_t length = 0;
    for (const char *c = from; *c && c != dot && length < 40; c++) {
        const bool valid = isalnum((unsigned char)*c) || *c == '_' || *c == '-';
        if (length == 0 && !isalpha((unsigned char)*c))
            continue;
        base[length++] = valid ? *c : '-';
    }
    base[length] = 0;
    if (length == 0)
        strcpy(base, otherwise);
}

static status new_of_file(scene *s, param_group group, const char *path, const char *wanted, object_name name,
                          diagnostic *why)
{
    object_name base;
    base_of_path(path, group == PARAM_TEXTURE ? "image" : "measured", base);
    status code = name_for(s, wanted, base, name, why);
    THEN(code, scene_add(s, group, name, NULL, why));
    char *row = text_format("%s.file", name);
    THEN(code, row ? scene_set(s, row, path, why) : out_of_memory(why));
    free(row);
    return code;
}

status new_texture(scene *s, const char *path, const char *wanted, object_name name, diagnostic *why)
{
    return new_of_file(s, PARAM_TEXTURE, path, wanted, name, why);
}

status new_data(scene *s, const char *path, const char *wanted, object_name name, diagnostic *why)
{
    return new_of_file(s, PARAM_DATA, path, wanted, name, why);
}

static void retain_loaded(mesh_entry *m, const mesh_entry *from)
{
    m->data = from->data;
    m->shading_materials = from->shading_materials;
    mesh_retain(m->data);
    face_materials_retain(m->shading_materials);
}

status new_model(scene *s, const scene *loaded, const char *path, const char *wanted, object_name name, diagnostic *why)
{
    const placement where = placement_of(s);
    const bounds3 b = loaded->meshes[0].data->bounds;
    const size_t count = s->solid_count;
    const vec3 low = placement_free(s, &where, where.size), edges = vec3_sub(b.high, b.low);
    const double longest = fmax(fmax(edges.x, edges.y), edges.z);
    if (!(longest > 0.0))
        return diagnose(why, STATUS_BAD_INPUT, "choose another file", "the mesh has no extent");
    object_name base, mesh_name;
    base_of_path(path, "model", base);
    status code = name_for(s, wanted, base, name, why);
    THEN(code, add_mesh_solid(s, name, mesh_name, why));
    char *row = code == STATUS_OK ? text_format("%s.file", mesh_name) : NULL;
    THEN(code, row ? scene_set(s, row, path, why) : out_of_memory(why));
    free(row);
    /* Five significant digits, so that rounding moves the model neither visibly below the ground nor above it. */
    const double scale = placement_round(where.size / longest, 0.01 * where.size / longest);
    put_vector(s, &code, why, name, "scale", vec3_make(scale, scale, scale));
    put_vector(s, &code, why, name, "position",
               vec3_make(low.x - 0.5 * scale * (b.low.x + b.high.x), low.y - scale * b.low.y,
                         low.z - 0.5 * scale * (b.low.z + b.high.z)));
    put_appearance(s, &code, why, name, count);
    if (code == STATUS_OK)
        retain_loaded(&s->meshes[s->mesh_count - 1], &loaded->meshes[0]);
    put_above_others(s, &code, why, name);
    return code;
}

/* --- copies --- */

/* Depth of overlap of two solids' bounding boxes, aligned with the camera, after moving the first; 0 if they are
 * disjoint. */
static double depth(const scene *s, const placement *where, const solid *a, vec3 step, const solid *b)
{
    const vec3 along[] = {where->right, where->away, vec3_make(0, 1, 0)};
    vec3 from, to;
    double radius, least = INFINITY;
    if (!placement_bounding_sphere(s, a, &from, &radius) || !placement_bounding_sphere(s, b, &to, &radius))
        return 0.0;
    const vec3 offset = vec3_sub(to, vec3_add(from, step));
    for (size_t i = 0; i < sizeof along / sizeof *along; i++)
        least = fmin(least, placement_half_size(s, a, along[i]) + placement_half_size(s, b, along[i]) -
                                fabs(vec3_dot(offset, along[i])));
    return fmax(0.0, least);
}

/* The total overlap that a copy would have, after this step, with the original and with solids that do not overlap the
 * original: a copy may be inside a solid that contains the original. */
static double overlap_after(const scene *s, const placement *where, const solid *of, vec3 step)
{
    double sum = depth(s, where, of, step, of);
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *other = &s->solids[i];
        if (other != of && other->visible && depth(s, where, of, vec3_make(0, 0, 0), other) <= 0.0)
            sum += depth(s, where, of, step, other);
    }
    return sum;
}

/* A step slightly longer than the solid's size in that direction, so that the copy is separate. */
static double stride(const scene *s, const solid *of, vec3 along, double radius)
{
    return 2.1 * fmax(placement_half_size(s, of, along), 0.01 * radius);
}

/* Offset from the original to a visible and preferably free place: to a side, behind or in front of it. */
static vec3 step_next_to(const scene *s, const placement *where, const solid *of, vec3 centre, double radius)
{
    static const double offsets[][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},  {2, 0}, {-2, 0},
                                        {1, 1}, {-1, 1}, {1, -1}, {-1, -1}, {0, 2}};
    const double aside = stride(s, of, where->right, radius), behind = stride(s, of, where->away, radius);
    vec3 best = where->right;
    double least = INFINITY;
    for (size_t i = 0; i < sizeof offsets / sizeof *offsets && least > 0.0; i++) {
        vec3 step =
            vec3_add(vec3_scale(where->right, aside * offsets[i][0]), vec3_scale(where->away, behind * offsets[i][1]));
        step = rounded(step, fmin(aside, behind));
        const double bad =
            overlap_after(s, where, of, step) + (placement_in_view(s, vec3_add(centre, step)) ? 0.0 : radius);
        if (bad < least) {
            least = bad;
            best = step;
        }
    }
    return best;
}

static status copy_object(scene *s, param_group group, size_t of, const char *name, diagnostic *why)
{
    size_t index;
    const status code = group == PARAM_SOLID ? scene_add_solid(s, name, s->solids[of].shape.kind, &index, why)
                                             : scene_add(s, group, name, &index, why);
    if (code != STATUS_OK || object_assign(s, group, index, of))
        return code;
    object_remove(s, group, index);
    return out_of_memory(why);
}

/* Copies a solid next to itself. The copy of a plane is behind its surface, where it has no effect until it is
 * moved. */
static status copy_solid(scene *s, size_t of, const char *name, diagnostic *why)
{
    const placement where = placement_of(s);
    const vec3 normal = mat3_apply(rotation_from_deg(s->solids[of].shape.rotation_deg), vec3_make(0, 1, 0));
    vec3 centre, step = rounded(vec3_scale(normal, -where.size), where.size);
    double radius;
    if (placement_bounding_sphere(s, &s->solids[of], &centre, &radius))
        step = step_next_to(s, &where, &s->solids[of], centre, radius);
    TRY(copy_object(s, PARAM_SOLID, of, name, why));
    solid *copy = &s->solids[s->solid_count - 1]; /* has its own place */
    copy->follows[0] = 0;
    copy->rotation_deg = copy->shape.rotation_deg, copy->scale = copy->shape.scale;
    return scene_move(s, name, step, why);
}

static status copy_next_to(scene *s, param_group group, size_t of, const char *name, diagnostic *why)
{
    TRY(copy_object(s, group, of, name, why));
    const placement where = placement_of(s);
    return scene_move(s, name, rounded(vec3_scale(where.right, where.size), where.size), why);
}

status new_copy(scene *s, const char *of, object_name name, diagnostic *why)
{
    param_place at;
    object_name base;
    TRY(param_place_find_object(s, of, &at, why));
    status code = STATUS_OK;
    size_t length = strlen(strcpy(base, of));
    while (length > 1 && base[length - 1] >= '0' && base[length - 1] <= '9')
        base[--length] = 0;
    if ((code = new_name(s, base, name, why)) != STATUS_OK)
        return code;
    switch (at.object_group) {
    case PARAM_SOLID: return copy_solid(s, at.index, name, why);
    case PARAM_LIGHT:
    case PARAM_BEAM: return copy_next_to(s, at.object_group, at.index, name, why);
    case PARAM_MATERIAL:
    case PARAM_MESH:
    case PARAM_TEXTURE:
    case PARAM_DATA: return copy_object(s, at.object_group, at.index, name, why);
    case PARAM_RENDER:
    case PARAM_CAMERA:
    case PARAM_BACKGROUND:
    case PARAM_GROUP_COUNT: break;
    }
    return diagnose(why, STATUS_BAD_INPUT, "copy a solid, a light, a beam, a material, a mesh or a texture",
                    "there is only one %.60s", of);
}
