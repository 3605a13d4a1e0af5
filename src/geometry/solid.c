/* Checks and queries that all shapes share, and rotation matrices. */
#include "geometry/shapes/shape.h"

#include "base/elementary.h"
#include "geometry/scene_geometry.h"
#include <string.h>

#define SHAPE_RULE(KIND, file) [SHAPE_##KIND] = &shape_##file,
static const shape_rule *const rules[SHAPE_COUNT] = {SHAPES(SHAPE_RULE)};

const shape_rule *shape_of_kind(shape_kind kind)
{
    return (size_t)kind < SHAPE_COUNT ? rules[kind] : NULL;
}

bool shape_named(const char *word, shape_kind *out)
{
    for (int k = 0; k < SHAPE_COUNT; k++) {
        if (strcmp(rules[k]->word, word) == 0) {
            *out = (shape_kind)k;
            return true;
        }
    }
    return false;
}

bool shape_has(const shape_rule *rule, const char *parameter)
{
    for (const char *const *name = rule->parameters; name && *name; name++)
        if (strcmp(*name, parameter) == 0)
            return true;
    return false;
}

const char *shape_face_name(const shape_rule *rule, int64_t face)
{
    const char *const *names = rule->triangles ? NULL : rule->faces[face >= HOLLOW_FACES && rule->primitive_count > 1];
    for (int64_t i = rule->primitive_count > 1 ? face % HOLLOW_FACES : face; names && i > 0 && names[1]; i--)
        names++;
    return names ? *names : "surface";
}

const shape_rule *shape_of(const solid_shape *shape)
{
    return rules[shape->kind];
}

status solid_shape_check(const solid_shape *shape, diagnostic *why)
{
    if (!vec3_is_finite(shape->position) || !vec3_is_finite(shape->rotation_deg))
        return diagnose(why, STATUS_BAD_INPUT, "use finite numbers", "position or rotation is not finite");
    const shape_rule *rule = shape_of_kind(shape->kind);
    if (!rule)
        return diagnose(why, STATUS_BAD_INPUT, "", "unknown shape");
    return rule->check ? rule->check(shape, why) : STATUS_OK;
}

bool solid_shape_contains(const solid_shape *shape, vec3 point)
{
    const shape_rule *rule = shape_of(shape);
    const vec3 from_center = vec3_sub(point, shape->position), turned = shape->rotation_deg;
    if (!rule->contains)
        return false;
    if (turned.x == 0.0 && turned.y == 0.0 && turned.z == 0.0) /* most solids, and drawings ask thousands of times */
        return rule->contains(shape, from_center);
    return rule->contains(shape, mat3_apply_transposed(rotation_from_deg(turned), from_center));
}

/* R = R_z R_y R_x: rotation about x comes first. R_x takes y towards z, R_y z towards x, R_z x towards y. */
mat3 rotation_from_deg(vec3 rotation_deg)
{
    double sx, cx, sy, cy, sz, cz;
    elementary_sincos_deg(rotation_deg.x, &sx, &cx);
    elementary_sincos_deg(rotation_deg.y, &sy, &cy);
    elementary_sincos_deg(rotation_deg.z, &sz, &cz);
    mat3 r;
    r.row[0] = vec3_make(cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx);
    r.row[1] = vec3_make(sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx);
    r.row[2] = vec3_make(-sy, cy * sx, cy * cx);
    return r;
}
