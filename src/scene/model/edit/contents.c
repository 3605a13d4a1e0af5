/* The contents of a solid, and edits of several objects as one rigid body (edit.h). */
#include "geometry/shapes/shape.h"
#include "scene/model/edit/edit.h"
#include "scene/model/place/placement.h"
#include "scene/model/scene.h"

#include <stdlib.h>
#include <string.h>

/* A bounding box in the solid's own frame. */
typedef struct container_box {
    solid_shape shape;
    bounds3 box;
    double radius;
} container_box;

static bool box_of(const scene *s, const solid *one, container_box *out)
{
    vec3 centre;
    if (!placement_bounding_sphere(s, one, &centre, &out->radius))
        return false;
    out->shape = scene_loaded_shape(s, one);
    if (shape_of(&out->shape)->triangles && (!out->shape.mesh || !out->shape.mesh->triangle_count))
        return false;
    out->box = shape_extent_of(&out->shape).box;
    return true;
}

static bool is_inside(const container_box *b, vec3 point)
{
    const mat3 turn = rotation_from_deg(b->shape.rotation_deg);
    const vec3 p = mat3_apply_transposed(turn, vec3_sub(point, b->shape.position));
    return p.x > b->box.low.x && p.x < b->box.high.x && p.y > b->box.low.y && p.y < b->box.high.y &&
           p.z > b->box.low.z && p.z < b->box.high.z;
}

status contents_find(const scene *s, const char *container, contents *out, diagnostic *why)
{
    param_place at;
    container_box box;
    *out = (contents){.count = 0};
    TRY(edit_find(s, container, &at, why));
    if (at.object_group != PARAM_SOLID || !box_of(s, &s->solids[at.index], &box))
        return STATUS_OK;
    out->name = calloc(s->solid_count + s->light_count, sizeof *out->name);
    if (!out->name)
        return out_of_memory(why);
    for (size_t i = 0; i < s->solid_count; i++) {
        vec3 centre;
        double radius;
        if (i != at.index && placement_bounding_sphere(s, &s->solids[i], &centre, &radius) && radius < box.radius &&
            is_inside(&box, centre))
            out->name[out->count++] = s->solids[i].name;
    }
    for (size_t i = 0; i < s->light_count; i++)
        if (light_extent(&s->lights[i]) < box.radius && is_inside(&box, s->lights[i].position))
            out->name[out->count++] = s->lights[i].name;
    return STATUS_OK;
}

void contents_clear(contents *c)
{
    free(c->name);
    *c = (contents){.count = 0};
}

bool contents_ball(const scene *s, const char *name, vec3 *centre, double *radius)
{
    const int index = scene_find_solid(s, name);
    return index >= 0 && placement_bounding_sphere(s, &s->solids[index], centre, radius);
}

typedef struct group_edit {
    vec3 by;
    double factor;
    status (*act)(const struct group_edit *e, scene *s, const char *name, vec3 from_first, diagnostic *why);
} group_edit;

static status position_of(const scene *s, const char *name, vec3 *out, diagnostic *why)
{
    param_place at;
    TRY(edit_find(s, name, &at, why));
    if (at.object_group != PARAM_SOLID && at.object_group != PARAM_LIGHT)
        return diagnose(why, STATUS_BAD_INPUT, "name solids and lights", "%.80s cannot be edited together with others",
                        name);
    *out = at.object_group == PARAM_SOLID ? s->solids[at.index].shape.position : s->lights[at.index].position;
    return STATUS_OK;
}

static bool is_repeated(const object_list *of, size_t i)
{
    bool found = strcmp(of->first, of->others[i]) == 0;
    for (size_t k = 0; k < i && !found; k++)
        found = strcmp(of->others[k], of->others[i]) == 0;
    return found;
}

static status apply_to_each(const group_edit *e, scene *s, const object_list *of, diagnostic *why)
{
    vec3 centre, position;
    TRY(position_of(s, of->first, &centre, why));
    TRY(e->act(e, s, of->first, vec3_make(0, 0, 0), why));
    for (size_t i = 0; i < of->count; i++) {
        if (is_repeated(of, i))
            continue;
        TRY(position_of(s, of->others[i], &position, why));
        TRY(e->act(e, s, of->others[i], vec3_sub(position, centre), why));
    }
    return STATUS_OK;
}

/* Edits all objects or, if one fails, none. */
static status apply(const group_edit *e, scene *s, const object_list *of, diagnostic *why)
{
    scene *before = scene_clone(s);
    if (!before)
        return out_of_memory(why);
    const status code = apply_to_each(e, s, of, why);
    if (code != STATUS_OK)
        edit_restore(s, before);
    scene_destroy(before);
    return code;
}

/* Whether the object moves, turns and is scaled with a solid of the scene. */
static bool has_leader(const scene *s, const char *name)
{
    const int at = scene_find_solid(s, name), rays = object_find(s, PARAM_BEAM, name);
    return (at >= 0 && solid_follows(&s->solids[at])) || (rays >= 0 && s->beams[rays].follows[0]);
}

static bool is_led(const scene *s, const char *name, vec3 from_first)
{
    return has_leader(s, name) && (from_first.x != 0.0 || from_first.y != 0.0 || from_first.z != 0.0);
}

static status move_one(const group_edit *e, scene *s, const char *name, vec3 from_first, diagnostic *why)
{
    return is_led(s, name, from_first) ? STATUS_OK : scene_move(s, name, e->by, why);
}

/* Rotates an object about the first one; a point light has no direction, and only moves. */
static status turn_one(const group_edit *e, scene *s, const char *name, vec3 from_first, diagnostic *why)
{
    param_place at;
    const vec3 to = mat3_apply(rotation_from_deg(e->by), from_first);
    if (has_leader(s, name))
        return STATUS_OK;
    TRY(scene_move(s, name, vec3_sub(to, from_first), why));
    TRY(param_place_find_object(s, name, &at, why));
    const bool is_point = at.object_group == PARAM_LIGHT && s->lights[at.index].kind == LIGHT_POINT;
    return is_point ? STATUS_OK : scene_turn(s, name, e->by, why);
}

static status scale_one(const group_edit *e, scene *s, const char *name, vec3 from_first, diagnostic *why)
{
    if (is_led(s, name, from_first))
        return STATUS_OK;
    TRY(scene_move(s, name, vec3_scale(from_first, e->factor - 1.0), why));
    return scene_scale(s, name, e->factor, why);
}

status scene_move_objects(scene *s, const object_list *of, vec3 by, diagnostic *why)
{
    return apply(&(group_edit){.by = by, .act = move_one}, s, of, why);
}

status scene_turn_objects(scene *s, const object_list *of, vec3 degrees, diagnostic *why)
{
    return apply(&(group_edit){.by = degrees, .act = turn_one}, s, of, why);
}

status scene_scale_objects(scene *s, const object_list *of, double factor, diagnostic *why)
{
    return apply(&(group_edit){.factor = factor, .act = scale_one}, s, of, why);
}
