/* Moves and rotates one object or the camera. Groups of objects: edit_parts.c. */
#include "base/elementary.h"
#include "base/number.h"
#include "base/text.h"
#include "geometry/shapes/shape.h"
#include "scene/model/edit/edit.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

status edit_find(const scene *s, const char *name, param_place *at, diagnostic *why)
{
    const status code = param_place_find_object(s, name, at, why);
    if (code == STATUS_BAD_INPUT && why && strncmp(why->remedy, "did you mean", 12) != 0)
        snprintf(why->remedy, sizeof why->remedy,
                 "name a solid, a light, a beam or camera, or a group: solids, lights, all, all+camera");
    return code;
}

typedef enum axis { AXIS_X, AXIS_Y, AXIS_Z } axis;

status edit_set_vector(scene *s, const char *name, const char *row, vec3 v, diagnostic *why)
{
    char x[NUMBER_TEXT_MAX], y[NUMBER_TEXT_MAX], z[NUMBER_TEXT_MAX];
    char *path = text_format("%s.%s", name, row);
    char *value = text_format("%s,%s,%s", number_format(v.x, x), number_format(v.y, y), number_format(v.z, z));
    status code = path && value ? scene_set(s, path, value, why) : out_of_memory(why);
    free(path);
    free(value);
    return code;
}

static status move_camera(scene *s, vec3 delta, diagnostic *why)
{
    const camera before = s->camera;
    status code = edit_set_vector(s, "camera", "position", vec3_add(before.position, delta), why);
    if (code == STATUS_OK && before.aimed)
        code = edit_set_vector(s, "camera", "target", vec3_add(before.target, delta), why);
    if (code != STATUS_OK)
        s->camera = before;
    return code;
}

static status has_no(const char *name, param_group group, const char *what, const char *remedy, diagnostic *why)
{
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%.80s is %s %s, which has no %s", name,
                    group <= PARAM_BACKGROUND ? "the" : "a", param_group_name(group), what);
}

/* The target of a spotlight moves as well, so that its direction stays. */
static status move_light(scene *s, size_t index, vec3 delta, diagnostic *why)
{
    light *l = &s->lights[index];
    const light before = *l;
    status code = edit_set_vector(s, l->name, "position", vec3_add(before.position, delta), why);
    if (code == STATUS_OK && before.kind != LIGHT_POINT)
        code = edit_set_vector(s, l->name, "target", vec3_add(before.target, delta), why);
    if (code != STATUS_OK)
        *l = before;
    return code;
}

/* The rotation of the solid that a beam follows. */
static mat3 beam_turn(const scene *s, const beam *b)
{
    const int at = b->follows[0] ? scene_find_solid(s, b->follows) : -1;
    return rotation_from_deg(at < 0 ? vec3_make(0.0, 0.0, 0.0) : s->solids[at].shape.rotation_deg);
}

/* The target of a beam moves as well, so that its direction stays. One that follows a solid moves in its frame. */
static status move_beam(scene *s, size_t index, vec3 by, diagnostic *why)
{
    beam *b = &s->beams[index];
    const beam before = *b;
    const vec3 delta =
        b->follows[0] ? vec3_scale(mat3_apply_transposed(beam_turn(s, b), by), 1.0 / beam_scale(s, b)) : by;
    status code = edit_set_vector(s, b->name, "position", vec3_add(before.own.position, delta), why);
    THEN(code, edit_set_vector(s, b->name, "target", vec3_add(before.own.target, delta), why));
    if (code != STATUS_OK)
        *b = before;
    return code;
}

/* A solid that follows another one moves by its offset. */
static status move_solid(scene *s, const solid *one, vec3 delta, diagnostic *why)
{
    if (!solid_follows(one))
        return edit_set_vector(s, one->name, "position", vec3_add(one->shape.position, delta), why);
    const solid *leader = &s->solids[scene_find_solid(s, one->follows)];
    const bool passes = !shape_of(&leader->shape)->triangles && !leader->points[0];
    const vec3 k = passes ? leader->shape.scale : vec3_make(1.0, 1.0, 1.0);
    const vec3 in_frame = mat3_apply_transposed(rotation_from_deg(leader->shape.rotation_deg), delta),
               within = vec3_make(in_frame.x / k.x, in_frame.y / k.y, in_frame.z / k.z);
    return edit_set_vector(s, one->name, "offset", vec3_add(one->offset, within), why);
}

status edit_move(scene *s, const char *name, vec3 delta, diagnostic *why)
{
    param_place at;
    TRY(edit_find(s, name, &at, why));
    if (at.object_group == PARAM_CAMERA)
        return move_camera(s, delta, why);
    if (at.object_group == PARAM_LIGHT)
        return move_light(s, at.index, delta, why);
    if (at.object_group == PARAM_BEAM)
        return move_beam(s, at.index, delta, why);
    if (at.object_group == PARAM_SOLID)
        return move_solid(s, &s->solids[at.index], delta, why);
    return has_no(name, at.object_group, "place", "move a solid, a light, a beam or the camera", why);
}

/* -180 < degrees <= 180 */
static double wrap_deg(double degrees)
{
    if (degrees > -180.0 && degrees <= 180.0)
        return degrees;
    double rest = degrees - 360.0 * floor(degrees / 360.0);
    return rest > 180.0 ? rest - 360.0 : rest;
}

static vec3 about(axis which, double degrees)
{
    return vec3_make(which == AXIS_X ? degrees : 0.0, which == AXIS_Y ? degrees : 0.0, which == AXIS_Z ? degrees : 0.0);
}

/* The angles after a further rotation about a world axis. z is applied last, so a rotation about z adds to z; so do
 * rotations about y and x if the angles applied later are 0. Adding keeps round numbers round. */
static vec3 rotate_angles(vec3 angles, axis which, double degrees)
{
    if (degrees == 0.0)
        return angles;
    if (which == AXIS_Z)
        return vec3_make(angles.x, angles.y, wrap_deg(angles.z + degrees));
    if (which == AXIS_Y && angles.z == 0.0)
        return vec3_make(angles.x, wrap_deg(angles.y + degrees), 0.0);
    if (which == AXIS_X && angles.y == 0.0 && angles.z == 0.0)
        return vec3_make(wrap_deg(angles.x + degrees), 0.0, 0.0);
    return rotation_to_deg(mat3_product(rotation_from_deg(about(which, degrees)), rotation_from_deg(angles)));
}

static vec3 rotate_angles_by(vec3 angles, vec3 degrees)
{
    return rotate_angles(rotate_angles(rotate_angles(angles, AXIS_X, degrees.x), AXIS_Y, degrees.y), AXIS_Z, degrees.z);
}

static status turn_camera(scene *s, vec3 degrees, diagnostic *why)
{
    const mat3 turn = rotation_from_deg(degrees);
    camera *c = &s->camera;
    if (c->aimed)
        return edit_set_vector(s, "camera", "target",
                               vec3_add(c->position, mat3_apply(turn, vec3_sub(c->target, c->position))), why);
    if (degrees.x == 0.0 && degrees.z == 0.0) { /* yaw and y rotate in the same sense, z towards x */
        c->yaw_deg = wrap_deg(c->yaw_deg + degrees.y);
        return STATUS_OK;
    }
    double sin_yaw, cos_yaw, sin_pitch, cos_pitch;
    elementary_sincos_deg(c->yaw_deg, &sin_yaw, &cos_yaw);
    elementary_sincos_deg(c->pitch_deg, &sin_pitch, &cos_pitch);
    const vec3 d = mat3_apply(turn, vec3_make(cos_pitch * sin_yaw, sin_pitch, cos_pitch * cos_yaw));
    c->yaw_deg = settled_deg(elementary_atan2_deg(d.x, d.z));
    c->pitch_deg = settled_deg(elementary_atan2_deg(d.y, sqrt(d.x * d.x + d.z * d.z)));
    return STATUS_OK;
}

/* A spotlight's target rotates about its position. */
static status turn_light(scene *s, const light *l, vec3 degrees, diagnostic *why)
{
    const vec3 direction = mat3_apply(rotation_from_deg(degrees), vec3_sub(l->target, l->position));
    return edit_set_vector(s, l->name, "target", vec3_add(l->position, direction), why);
}

/* A rotation of the world in a frame that is turned itself. */
static mat3 within(mat3 frame, mat3 turn)
{
    mat3 back = frame;
    for (int i = 0; i < 3; i++)
        back.row[i] = mat3_apply(frame, vec3_make(i == 0, i == 1, i == 2));
    return mat3_product(back, mat3_product(turn, frame));
}

/* A solid that follows another one turns in its frame. */
static status turn_solid(scene *s, const solid *one, vec3 degrees, diagnostic *why)
{
    const int at = solid_follows(one) ? scene_find_solid(s, one->follows) : -1;
    if (at < 0)
        return edit_set_vector(s, one->name, "rotation", rotate_angles_by(one->shape.rotation_deg, degrees), why);
    const mat3 frame = rotation_from_deg(s->solids[at].shape.rotation_deg),
               turn = mat3_product(within(frame, rotation_from_deg(degrees)), rotation_from_deg(one->rotation_deg));
    return edit_set_vector(s, one->name, "rotation", rotation_to_deg(turn), why);
}

/* A beam's axis and plane rotate about its position. */
static status turn_beam(scene *s, const beam *b, vec3 degrees, diagnostic *why)
{
    const mat3 turn = within(beam_turn(s, b), rotation_from_deg(degrees));
    const beam_place *own = &b->own;
    const vec3 target = vec3_add(own->position, mat3_apply(turn, vec3_sub(own->target, own->position)));
    const vec3 direction = mat3_apply(turn, own->direction), normal = mat3_apply(turn, own->normal);
    status code = edit_set_vector(s, b->name, "target", target, why);
    THEN(code, edit_set_vector(s, b->name, "direction", direction, why));
    THEN(code, edit_set_vector(s, b->name, "normal", normal, why));
    return code;
}

static bool is_angle(double degrees)
{
    return fabs(degrees) <= 1e6; /* range in which elementary_sincos_deg has its stated error; false for NaN */
}

status edit_check_angles(const char *name, vec3 degrees, diagnostic *why)
{
    if (is_angle(degrees.x) && is_angle(degrees.y) && is_angle(degrees.z))
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "give 3 angles, each -1000000..1000000 degrees",
                    "%.80s cannot be rotated by these angles", name);
}

status edit_turn(scene *s, const char *name, vec3 degrees, diagnostic *why)
{
    param_place at;
    TRY(edit_find(s, name, &at, why));
    TRY(edit_check_angles(name, degrees, why));
    if (at.object_group == PARAM_CAMERA)
        return turn_camera(s, degrees, why);
    if (at.object_group == PARAM_LIGHT && s->lights[at.index].kind != LIGHT_POINT)
        return turn_light(s, &s->lights[at.index], degrees, why);
    if (at.object_group == PARAM_BEAM)
        return turn_beam(s, &s->beams[at.index], degrees, why);
    if (at.object_group == PARAM_SOLID)
        return turn_solid(s, &s->solids[at.index], degrees, why);
    return has_no(name, at.object_group, "direction", "rotate a solid, a spotlight, a beam or the camera", why);
}

status scene_look_at(scene *s, vec3 target, diagnostic *why)
{
    return edit_set_vector(s, "camera", "target", target, why);
}
