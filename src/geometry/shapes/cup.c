/* The shape cup: a cylinder of radius, m and height, minus a cylinder of inner_radius and the same m that starts at the
 * height of the floor and is open at the top. Its position is the centre of its base. The ellipses are similar, so that
 * the wall is radius - inner_radius thick along x, and 1 / m of that along z. */
#include "geometry/shapes/parts.h"

static status check(const solid_shape *shape, diagnostic *why)
{
    status code = cylinder_check(shape, why);
    THEN(code, check_length(shape->inner_radius, "inner_radius", why));
    THEN(code, check_length(shape->floor, "floor", why));
    if (code != STATUS_OK)
        return code;
    if (shape->inner_radius >= shape->radius)
        return diagnose(why, STATUS_BAD_INPUT, "make inner_radius smaller than radius, or the cup has no wall",
                        "inner_radius %g is not smaller than radius %g", shape->inner_radius, shape->radius);
    if (shape->floor >= shape->height)
        return diagnose(why, STATUS_BAD_INPUT, "make floor smaller than height, or the cup has no hollow",
                        "floor %g is not smaller than height %g", shape->floor, shape->height);
    return STATUS_OK;
}

/* The cup is a closed set, so its hollow is open: the hollow's own surface belongs to the cup. */
static bool contains(const solid_shape *shape, vec3 p)
{
    const double m = shape->m, r = shape->inner_radius;
    return cylinder_contains(shape, p) && !(p.x * p.x + m * m * p.z * p.z < r * r && p.y > shape->floor);
}

static void primitives(const solid_shape *shape, primitive *out)
{
    out[0] = cylinder_placed(shape, shape->radius, 0.0, shape->height);
    out[1] = cylinder_placed(shape, shape->inner_radius, shape->floor, HUGE_VAL);
}

static bool flat(const solid_shape *shape, size_t i, vec3 *normal, vec3 *point)
{
    return level_faces((const double[]){0.0, shape->height, shape->floor}, 3, i, normal, point);
}

/* Is the hidden shape outside the hollow: below the floor, or to one side of the hollow? */
static bool avoids_hollow(const placed_shape *cover, const placed_shape *hidden)
{
    const solid_shape *cup = &cover->shape;
    const vec3 up = placed_axis(&cover->turn, 1);
    if (is_within(placed_farthest(hidden, up), vec3_dot(up, cup->position) + cup->floor, cup->height))
        return true;
    const vec3 local = mat3_apply_transposed(cover->turn, vec3_sub(hidden->shape.position, cup->position));
    const double r = hypot(local.x, local.z);
    if (r == 0.0)
        return false;
    const vec3 out = mat3_apply(cover->turn, vec3_make(local.x / r, 0.0, local.z / r));
    const double hollow = cup->inner_radius * hypot(local.x / r, local.z / (r * cup->m));
    return is_within(placed_farthest(hidden, vec3_scale(out, -1.0)), -vec3_dot(out, cup->position) - hollow,
                     cup->radius);
}

static bool covers(const placed_shape *cover, const placed_shape *hidden)
{
    return cylinder_covers(cover, hidden) && avoids_hollow(cover, hidden);
}

/* The thickness of the wall or of the floor. */
static double thickness(const solid_shape *shape)
{
    return fmin((shape->radius - shape->inner_radius) * fmin(1.0, 1.0 / shape->m), shape->floor);
}

static void fit(solid_shape *shape, double size)
{
    cylinder_fit(shape, size);
    shape->inner_radius = 0.9 * shape->radius;
    shape->floor = 0.1 * size;
}

static int rings(const solid_shape *shape, shape_ring *out)
{
    const double r = shape->inner_radius;
    const int outside = cylinder_rings(shape, out);
    out[outside] = (shape_ring){.part = 1, .y = shape->floor, .x = r, .z = r / shape->m};
    out[outside + 1] = (shape_ring){.part = 1, .y = shape->height, .x = r, .z = r / shape->m};
    return outside + 2;
}

/* Its outside, whose top is a ring; and the wall and floor of its hollow. */
static status tessellation(const solid_shape *shape, int part, mesh **out, diagnostic *why)
{
    const double r = shape->radius, inner = shape->inner_radius, low = shape->floor, h = shape->height;
    const profile_point outside[4] = {{0.0, 0.0}, {r, 0.0}, {r, h}, {inner, h}};
    const profile_point hollow[3] = {{0.0, low}, {inner, low}, {inner, h}};
    return part == 0 ? tessellate_lathe(outside, 4, out, why) : tessellate_lathe(hollow, 3, out, why);
}

const shape_rule shape_cup = {
    .word = "cup",
    .meaning =
        "a cylinder minus a cylinder of inner_radius that starts at the height of its floor and is open at the top; "
        "its position is the centre of its base",
    .parameters = WORDS("radius", "height", "m", "inner_radius", "floor"),
    .hollow = true,
    .curved = true,
    .check = check,
    .contains = contains,
    .primitive_count = 2,
    .primitives = primitives,
    .faces = {WORDS("outer side", "bottom", "rim"), WORDS("inner side", "floor", "rim")},
    .flat = flat,
    .extent = cylinder_extent,
    .farthest = cylinder_farthest,
    .farthest_from = cylinder_farthest_from,
    .covers = covers,
    .thickness = thickness,
    .fit = fit,
    .rings = rings,
    .tessellation = tessellation,
    .tessellation_scale = cylinder_tessellation_scale,
};
