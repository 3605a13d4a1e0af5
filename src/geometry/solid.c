#include "geometry/solid.h"
#include "base/elementary.h"

#include <math.h>

static bool is_length(double value)
{
    return isfinite(value) && value > 0.0;
}

static status check_length(double value, const char *name, diagnostic *why)
{
    if (is_length(value)) {
        return STATUS_OK;
    }
    return diagnose(why, STATUS_BAD_INPUT, "give a length above 0", "%s is %g", name, value);
}

static bool is_finite_vector(vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static status check_cup(const solid_shape *shape, diagnostic *why)
{
    status code = check_length(shape->inner_radius, "inner_radius", why);
    if (code == STATUS_OK) {
        code = check_length(shape->floor, "floor", why);
    }
    if (code != STATUS_OK) {
        return code;
    }
    if (shape->inner_radius >= shape->radius) {
        return diagnose(why, STATUS_BAD_INPUT, "make inner_radius smaller than radius, or the cup has no wall",
                        "inner_radius %g is not smaller than radius %g", shape->inner_radius, shape->radius);
    }
    if (shape->floor >= shape->height) {
        return diagnose(why, STATUS_BAD_INPUT, "make floor smaller than height, or the cup holds nothing",
                        "floor %g is not smaller than height %g", shape->floor, shape->height);
    }
    return STATUS_OK;
}

static status check_round(const solid_shape *shape, diagnostic *why)
{
    status code = check_length(shape->radius, "radius", why);
    if (code == STATUS_OK && shape->kind != SHAPE_SPHERE) {
        code = check_length(shape->height, "height", why);
        if (code == STATUS_OK) {
            code = check_length(shape->m, "m", why);
        }
    }
    return code == STATUS_OK && shape->kind == SHAPE_CUP ? check_cup(shape, why) : code;
}

static status check_box(const solid_shape *shape, diagnostic *why)
{
    status code = check_length(shape->size.x, "size.x", why);
    if (code == STATUS_OK) {
        code = check_length(shape->size.y, "size.y", why);
    }
    return code == STATUS_OK ? check_length(shape->size.z, "size.z", why) : code;
}

static bool is_whole(double value)
{
    return value >= 1.0 && value <= SHAPE_COPIES_MAX && value == floor(value);
}

static status check_copies(const solid_shape *shape, diagnostic *why)
{
    const vec3 n = shape->copies, s = shape->scale;
    if (!is_whole(n.x) || !is_whole(n.y) || !is_whole(n.z) || n.x * n.y * n.z > SHAPE_COPIES_MAX) {
        return diagnose(why, STATUS_BAD_INPUT, "give three whole numbers from 1, at most 4194304 copies in all",
                        "copies is %g, %g, %g", n.x, n.y, n.z);
    }
    if (!(s.x > 0.0 && s.y > 0.0 && s.z > 0.0) || !is_finite_vector(s) || !is_finite_vector(shape->spacing)) {
        return diagnose(why, STATUS_BAD_INPUT, "give numbers above 0", "scale is %g, %g, %g", s.x, s.y, s.z);
    }
    return STATUS_OK;
}

status solid_shape_check(const solid_shape *shape, diagnostic *why)
{
    if (!is_finite_vector(shape->position) || !is_finite_vector(shape->rotation_deg)) {
        return diagnose(why, STATUS_BAD_INPUT, "give finite numbers", "position or rotation is not finite");
    }
    switch (shape->kind) {
    case SHAPE_PLANE: return STATUS_OK;
    case SHAPE_CYLINDER:
    case SHAPE_CUP:
    case SHAPE_SPHERE: return check_round(shape, why);
    case SHAPE_BOX: return check_box(shape, why);
    case SHAPE_MESH: return check_copies(shape, why);
    case SHAPE_COUNT: break;
    }
    return diagnose(why, STATUS_BAD_INPUT, "", "no such shape");
}

static bool in_cylinder(vec3 p, double radius, double m, double bottom, double top)
{
    return p.x * p.x + m * m * p.z * p.z <= radius * radius && p.y >= bottom && p.y <= top;
}

/* The cup is closed, so its hollow is open: the hollow's own surface belongs to the cup. */
static bool in_hollow(const solid_shape *cup, vec3 p)
{
    return p.x * p.x + cup->m * cup->m * p.z * p.z < cup->inner_radius * cup->inner_radius && p.y > cup->floor;
}

bool solid_shape_contains(const solid_shape *shape, vec3 point)
{
    mat3 rotation = rotation_from_deg(shape->rotation_deg);
    vec3 p = mat3_apply_transposed(rotation, vec3_sub(point, shape->position));
    switch (shape->kind) {
    case SHAPE_PLANE: return p.y <= 0.0;
    case SHAPE_CYLINDER: return in_cylinder(p, shape->radius, shape->m, 0.0, shape->height);
    case SHAPE_CUP: return in_cylinder(p, shape->radius, shape->m, 0.0, shape->height) && !in_hollow(shape, p);
    case SHAPE_BOX:
        return fabs(p.x) <= shape->size.x / 2 && fabs(p.y) <= shape->size.y / 2 && fabs(p.z) <= shape->size.z / 2;
    case SHAPE_SPHERE: return vec3_dot(p, p) <= shape->radius * shape->radius;
    case SHAPE_MESH: /* asked of an arrangement, which has its triangles in order */
    case SHAPE_COUNT: break;
    }
    return false;
}

/* R = R_z R_y R_x: the point is turned about x first. R_x takes y towards z, R_y z towards x, R_z x towards y. */
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
