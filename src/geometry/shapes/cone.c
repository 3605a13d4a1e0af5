/* The shape cone: x^2 + z^2 <= w^2, 0 <= y <= height, where w decreases or increases linearly from radius at the base
 * to top_radius, which may be 0. Its position is the centre of its base. */
#include "geometry/shapes/parts.h"

PRIMITIVE_RULE(cone);

static status check(const solid_shape *shape, diagnostic *why)
{
    status code = check_length(shape->radius, "radius", why);
    THEN(code, check_length(shape->height, "height", why));
    if (code == STATUS_OK && !(shape->top_radius >= 0.0 && isfinite(shape->top_radius)))
        code = diagnose(why, STATUS_BAD_INPUT, "use a length of at least 0; 0 makes a point", "top_radius is %g",
                        shape->top_radius);
    return code;
}

static double widest(const solid_shape *shape)
{
    return fmax(shape->radius, shape->top_radius);
}

static bool contains(const solid_shape *shape, vec3 p)
{
    const double w = shape->radius + (shape->top_radius - shape->radius) / shape->height * p.y;
    return p.x * p.x + p.z * p.z <= w * w && p.y >= 0.0 && p.y <= shape->height;
}

static void primitives(const solid_shape *shape, primitive *out)
{
    out[0] = primitive_placed(shape, &cone_rule, shape->height + widest(shape));
    out[0].radius = shape->radius;
    out[0].second_radius = shape->top_radius;
    out[0].top = shape->height;
}

static bool flat(const solid_shape *shape, size_t i, vec3 *normal, vec3 *point)
{
    return level_faces((const double[]){0.0, shape->height}, shape->top_radius > 0.0 ? 2 : 1, i, normal, point);
}

static shape_extent extent(const solid_shape *shape)
{
    const double r = widest(shape);
    return (shape_extent){{vec3_make(-r, 0.0, -r), vec3_make(r, shape->height, r)}, hypot(r, 0.5 * shape->height)};
}

static double farthest(const solid_shape *shape, vec3 d)
{
    const double out = hypot(d.x, d.z);
    return fmax(shape->radius * out, shape->height * d.y + shape->top_radius * out);
}

/* The lesser of its diameter at half height and its height. */
static double thickness(const solid_shape *shape)
{
    return fmin(shape->height, shape->radius + shape->top_radius);
}

static void fit(solid_shape *shape, double size)
{
    shape->radius = 0.5 * size;
    shape->top_radius = 0.0;
    shape->height = size;
}

static int rings(const solid_shape *shape, shape_ring *out)
{
    out[0] = (shape_ring){.y = 0.0, .x = shape->radius, .z = shape->radius};
    out[1] = (shape_ring){.y = shape->height, .x = shape->top_radius, .z = shape->top_radius};
    return 2;
}

static status tessellation(const solid_shape *shape, int part, mesh **out, diagnostic *why)
{
    (void)part;
    const profile_point profile[] = {
        {0.0, 0.0}, {shape->radius, 0.0}, {shape->top_radius, shape->height}, {0.0, shape->height}};
    return tessellate_lathe(profile, shape->top_radius > 0.0 ? 4 : 3, out, why);
}

const shape_rule shape_cone = {
    .word = "cone",
    .meaning = "x^2 + z^2 <= w^2, 0 <= y <= height, where w changes linearly from radius at the base to top_radius, 0 "
               "for a point; its position is the centre of its base",
    .parameters =
        WORDS("radius", "top_radius", "height", "material_1", "material_2", "material_rim", "points", "scale"),
    .curved = true,
    .check = check,
    .contains = contains,
    .primitive_count = 1,
    .primitives = primitives,
    .faces = {WORDS("side", "bottom", "top")},
    .ends = {1, 2},
    .flat = flat,
    .extent = extent,
    .farthest = farthest,
    .thickness = thickness,
    .fit = fit,
    .rings = rings,
    .tessellation = tessellation,
};
