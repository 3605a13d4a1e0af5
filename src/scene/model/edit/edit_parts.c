/* Moves, rotates and scales groups of objects: all solids, all lights and beams, or both, with or without the camera.
 * Scales one solid or light as well. */
#include "base/elementary.h"
#include "base/number.h"
#include "geometry/shapes/shape.h"
#include "scene/model/camera.h"
#include "scene/model/edit/edit.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool add_word(const char *word, size_t length, scene_parts *parts)
{
    static const struct {
        const char *word;
        scene_parts parts;
    } words[] = {{"all", {.solids = true, .lights = true, .beams = true}},
                 {"solids", {.solids = true}},
                 {"lights", {.lights = true, .beams = true}},
                 {"camera", {.camera = true}}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (strlen(words[i].word) == length && strncmp(words[i].word, word, length) == 0) {
            parts->solids |= words[i].parts.solids;
            parts->lights |= words[i].parts.lights;
            parts->beams |= words[i].parts.beams;
            parts->camera |= words[i].parts.camera;
            return true;
        }
    }
    return false;
}

bool scene_parts_named(const scene *s, const char *name, scene_parts *out)
{
    param_place unused;
    *out = (scene_parts){.solids = false};
    if (param_place_find_object(s, name, &unused, NULL) == STATUS_OK)
        return false;
    for (const char *word = name;; word++) {
        const size_t length = strcspn(word, "+");
        if (!add_word(word, length, out))
            return false;
        word += length;
        if (!*word)
            return true;
    }
}

void edit_restore(scene *s, const scene *before)
{
    for (size_t i = 0; i < s->solid_count; i++) {
        s->solids[i].shape = before->solids[i].shape;
        s->solids[i].offset = before->solids[i].offset;
        s->solids[i].rotation_deg = before->solids[i].rotation_deg;
        s->solids[i].scale = before->solids[i].scale;
        s->solids[i].surface = before->solids[i].surface;
    }
    for (size_t i = 0; i < s->light_count; i++) {
        char *name = s->lights[i].name;
        s->lights[i] = before->lights[i];
        s->lights[i].name = name;
    }
    for (size_t i = 0; i < s->beam_count; i++) {
        char *name = s->beams[i].name;
        s->beams[i] = before->beams[i];
        s->beams[i].name = name;
    }
    for (size_t i = 0; i < s->material_count; i++)
        s->materials[i].value = before->materials[i].value;
    s->camera = before->camera;
    s->render.unit_m = before->render.unit_m;
}

/* An edit of many objects, applied completely or not at all. */
typedef struct parts_edit {
    scene *s;
    const scene *before;
    scene_parts parts;
    const char *only; /* the only solid or light that is scaled, in place; NULL: the parts */
    vec3 by;          /* vector of a move, angles of a rotation */
    double factor;    /* factor of a scaling */
    diagnostic *why;
    status (*act)(struct parts_edit *e);
} parts_edit;

static status apply(parts_edit *e)
{
    scene *before = scene_clone(e->s);
    if (!before)
        return out_of_memory(e->why);
    e->before = before;
    const status code = e->act(e);
    if (code != STATUS_OK)
        edit_restore(e->s, before);
    scene_destroy(before);
    return code;
}

static status move_parts(parts_edit *e)
{
    status code = STATUS_OK;
    for (size_t i = 0; i < e->s->solid_count && e->parts.solids && code == STATUS_OK; i++)
        if (!solid_follows(&e->s->solids[i]))
            code = edit_move(e->s, e->s->solids[i].name, e->by, e->why);
    for (size_t i = 0; i < e->s->light_count && e->parts.lights && code == STATUS_OK; i++)
        code = edit_move(e->s, e->s->lights[i].name, e->by, e->why);
    for (size_t i = 0; i < e->s->beam_count && e->parts.beams && code == STATUS_OK; i++)
        if (!e->s->beams[i].follows[0] || !e->parts.solids)
            code = edit_move(e->s, e->s->beams[i].name, e->by, e->why);
    return e->parts.camera && code == STATUS_OK ? edit_move(e->s, "camera", e->by, e->why) : code;
}

/* Rotates a vector parameter about the origin; + 0.0 turns -0 into 0. */
static status turn_point(const parts_edit *e, const char *name, const char *row, vec3 point)
{
    const vec3 to = mat3_apply(rotation_from_deg(e->by), point);
    return edit_set_vector(e->s, name, row, vec3_make(to.x + 0.0, to.y + 0.0, to.z + 0.0), e->why);
}

static status turn_solid(parts_edit *e, const solid *one)
{
    if (solid_follows(one)) /* it turns with its leader */
        return STATUS_OK;
    TRY(turn_point(e, one->name, "position", one->shape.position));
    return edit_turn(e->s, one->name, e->by, e->why);
}

static status turn_light(parts_edit *e, const light *one)
{
    const status code = turn_point(e, one->name, "position", one->position);
    return code == STATUS_OK && one->kind != LIGHT_POINT ? turn_point(e, one->name, "target", one->target) : code;
}

static status turn_beam(parts_edit *e, const beam *one)
{
    const vec3 target = one->target, direction = one->direction, normal = one->normal;
    if (one->follows[0] && e->parts.solids) /* it turns with its leader */
        return STATUS_OK;
    TRY(turn_point(e, one->name, "position", one->position));
    TRY(turn_point(e, one->name, "target", target));
    TRY(turn_point(e, one->name, "direction", direction));
    return turn_point(e, one->name, "normal", normal);
}

/* The whole camera frame rotates about the origin, including the image's up direction: its deviation from a level image
 * becomes roll. */
static status turn_camera(parts_edit *e)
{
    scene *s = e->s;
    const vec3 eye = s->camera.position, target = s->camera.target,
               up = mat3_apply(rotation_from_deg(e->by), camera_frame_of(s).up);
    status code = STATUS_OK;
    if (s->camera.aimed)
        code = turn_point(e, "camera", "target", target);
    else
        code = edit_turn(s, "camera", e->by, e->why);
    THEN(code, turn_point(e, "camera", "position", eye));
    if (code == STATUS_OK) {
        const camera_frame level = camera_frame_level(s);
        const double roll = settled_deg(elementary_atan2_deg(vec3_dot(up, level.right), vec3_dot(up, level.up)));
        s->camera.roll_deg = fabs(roll - s->camera.roll_deg) < 1e-12 ? s->camera.roll_deg : roll + 0.0;
    }
    return code;
}

static status turn_parts(parts_edit *e)
{
    status code = STATUS_OK;
    for (size_t i = 0; i < e->s->solid_count && e->parts.solids && code == STATUS_OK; i++)
        code = turn_solid(e, &e->s->solids[i]);
    for (size_t i = 0; i < e->s->light_count && e->parts.lights && code == STATUS_OK; i++)
        code = turn_light(e, &e->s->lights[i]);
    for (size_t i = 0; i < e->s->beam_count && e->parts.beams && code == STATUS_OK; i++)
        code = turn_beam(e, &e->s->beams[i]);
    return e->parts.camera && code == STATUS_OK ? turn_camera(e) : code;
}

/* The power of length in a row's unit, so that new rows are scaled as well; 0: not a length. A mesh's scale counts as a
 * length. */
static int length_power(const param *row)
{
    static const char inverse[] = "1/scene units^";
    if (row->type != PARAM_REAL && row->type != PARAM_VECTOR)
        return 0;
    if (strncmp(row->unit, inverse, sizeof inverse - 1) == 0)
        return -atoi(row->unit + sizeof inverse - 1);
    return strcmp(row->unit, "scene units") == 0;
}

static double power_of(double factor, int power)
{
    double product = 1.0;
    for (int k = 0; k < (power < 0 ? -power : power); k++)
        product *= factor;
    return power < 0 ? 1.0 / product : product;
}

/* Whether the row is the power of a beam that lights the scene: power grows with the area, so that irradiance stays. */
static bool is_power(const parts_edit *e, const char *name, const param *row)
{
    param_place at;
    return row->group == PARAM_BEAM && strcmp(row->name, "power") == 0 &&
           param_place_find_object(e->s, name, &at, NULL) == STATUS_OK && e->s->beams[at.index].lights;
}

/* Whether the row is the scale of a mesh or of points, which are lengths; that of another solid multiplies its own. */
static bool is_length_scale(const parts_edit *e, const char *name, const param *row)
{
    const int index = strcmp(row->name, "scale") == 0 ? scene_find_solid(e->s, name) : -1;
    return row->group == PARAM_SOLID && index >= 0 &&
           (shape_of(&e->s->solids[index].shape)->triangles || e->s->solids[index].points[0]);
}

static int scaling_power(const parts_edit *e, const char *name, const param *row)
{
    if (is_length_scale(e, name, row))
        return 1;
    return is_power(e, name, row) ? 2 : length_power(row);
}

/* The name of the solid that an object follows; "" for none. */
static const char *leader_of(const scene *s, const param_place *at)
{
    return at->object_group == PARAM_SOLID  ? s->solids[at->index].follows
           : at->object_group == PARAM_BEAM ? s->beams[at->index].follows
                                            : "";
}

static bool is_scaled(const parts_edit *e, const char *name, const param *row)
{
    param_place at;
    if (scaling_power(e, name, row) == 0 || param_place_find_object(e->s, name, &at, NULL) != STATUS_OK)
        return false;
    if (e->only && strcmp(row->name, "tint_distance") != 0 && strcmp(leader_of(e->s, &at), e->only) == 0)
        return true;
    if (e->only) { /* one object keeps its place and its material, and render.unit_m stays */
        return strcmp(name, e->only) == 0 && strcmp(row->name, "tint_distance") != 0 &&
               strcmp(row->name, "position") != 0 && strcmp(row->name, "offset") != 0 &&
               strcmp(row->name, "target") != 0;
    }
    return at.object_group == PARAM_SOLID || at.object_group == PARAM_MATERIAL ? e->parts.solids
           : at.object_group == PARAM_LIGHT                                    ? e->parts.lights
           : at.object_group == PARAM_BEAM                                     ? e->parts.beams
                                           : at.object_group == PARAM_CAMERA && e->parts.camera;
}

/* Scales one row. The visited rows are the clone's, because setting a material changes its solids. */
static status scale_row(void *context, const char *path, const param *row, const char *value)
{
    parts_edit *e = context;
    char name[SCENE_NAME_MAX + 1] = "";
    const size_t length = strcspn(path, ".");
    if (length <= SCENE_NAME_MAX)
        memcpy(name, path, length);
    if (!is_scaled(e, name, row))
        return STATUS_OK;
    param_value v;
    TRY(param_value_parse(row, -1, path, value, &v, e->why));
    const double factor = power_of(e->factor, scaling_power(e, name, row));
    if (row->type == PARAM_REAL)
        v.real *= factor;
    else
        v.vector = vec3_scale(v.vector, factor);
    char *text = param_value_text(row, -1, &v);
    status code = text ? scene_set(e->s, path, text, e->why) : out_of_memory(e->why);
    free(text);
    return code;
}

/* On unbounded shapes a texture size of 0 means 1 scene unit, which must be scaled, too. */
static void scale_unbounded(parts_edit *e)
{
    for (size_t i = 0; i < e->s->solid_count; i++) {
        solid *one = &e->s->solids[i];
        const bool is_wanted = e->only ? strcmp(one->name, e->only) == 0 : e->parts.solids;
        if (is_wanted && shape_of(&one->shape)->unbounded && one->surface.texture[0] &&
            one->surface.texture_size == 0.0)
            one->surface.texture_size = e->factor;
    }
}

/* A scaled scene keeps its lengths in metres, and therefore its absorption. */
static status keep_metres(parts_edit *e)
{
    char text[NUMBER_TEXT_MAX];
    return scene_set(e->s, "render.unit_m", number_format(e->before->render.unit_m / e->factor, text), e->why);
}

static status scale_parts(parts_edit *e)
{
    const status code = scene_each_param(e->before, scale_row, e);
    if (code == STATUS_FAILURE)
        return out_of_memory(e->why); /* there is no other failure */
    if (code == STATUS_OK)
        scale_unbounded(e);
    return code == STATUS_OK && e->parts.solids ? keep_metres(e) : code;
}

status scene_move(scene *s, const char *name, vec3 delta, diagnostic *why)
{
    parts_edit e = {.s = s, .by = delta, .why = why, .act = move_parts};
    return scene_parts_named(s, name, &e.parts) ? apply(&e) : edit_move(s, name, delta, why);
}

status scene_turn(scene *s, const char *name, vec3 degrees, diagnostic *why)
{
    parts_edit e = {.s = s, .by = degrees, .why = why, .act = turn_parts};
    if (!scene_parts_named(s, name, &e.parts))
        return edit_turn(s, name, degrees, why);
    TRY(edit_check_angles(name, degrees, why));
    return apply(&e);
}

status scene_scale(scene *s, const char *name, double factor, diagnostic *why)
{
    parts_edit e = {.s = s, .factor = factor, .why = why, .act = scale_parts};
    param_place at;
    if (!(factor > 0.0 && factor <= 1e9))
        return diagnose(why, STATUS_BAD_INPUT, "give a factor above 0, at most 1e9", "%.80s cannot be scaled by %g",
                        name, factor);
    if (scene_parts_named(s, name, &e.parts))
        return apply(&e);
    TRY(edit_find(s, name, &at, why));
    if (at.object_group != PARAM_SOLID && at.object_group != PARAM_LIGHT)
        return diagnose(why, STATUS_BAD_INPUT, "scale a solid, a light, or a group: all, solids or lights",
                        "%.80s cannot be scaled", name);
    e.only = name;
    return apply(&e);
}
