/* The shape box: |x| <= size.x / 2, |y| <= size.y / 2, |z| <= size.z / 2. Its position is its centre. */
#include "geometry/shapes/parts.h"

PRIMITIVE_RULE(box);

static status check(const solid_shape *shape, diagnostic *why)
{
    TRY(check_length(shape->size.x, "size.x", why));
    TRY(check_length(shape->size.y, "size.y", why));
    return check_length(shape->size.z, "size.z", why);
}

static bool contains(const solid_shape *shape, vec3 p)
{
    const vec3 size = shape->size;
    return fabs(p.x) <= size.x / 2 && fabs(p.y) <= size.y / 2 && fabs(p.z) <= size.z / 2;
}

static void primitives(const solid_shape *shape, primitive *out)
{
    out[0] = primitive_placed(shape, &box_rule, largest_of(shape->size.x, shape->size.y, shape->size.z));
    out[0].half = vec3_scale(shape->size, 0.5);
}

static bool flat(const solid_shape *shape, size_t i, vec3 *normal, vec3 *point)
{
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const vec3 n = vec3_make(i / 2 == 0 ? side : 0.0, i / 2 == 1 ? side : 0.0, i / 2 == 2 ? side : 0.0);
    *normal = n;
    *point = vec3_make(0.5 * n.x * shape->size.x, 0.5 * n.y * shape->size.y, 0.5 * n.z * shape->size.z);
    return i < 6;
}

static shape_extent extent(const solid_shape *shape)
{
    return extent_of_size(shape->size);
}

static double farthest(const solid_shape *shape, vec3 d)
{
    const vec3 size = shape->size;
    return 0.5 * (fabs(d.x) * size.x + fabs(d.y) * size.y + fabs(d.z) * size.z);
}

static bool covers(const placed_shape *cover, const placed_shape *hidden)
{
    const vec3 half = vec3_scale(cover->shape.size, 0.5);
    return placed_is_between(cover, hidden, 0, -half.x, half.x) &&
           placed_is_between(cover, hidden, 1, -half.y, half.y) && placed_is_between(cover, hidden, 2, -half.z, half.z);
}

static double thickness(const solid_shape *shape)
{
    return least_of_three(shape->size);
}

static void fit(solid_shape *shape, double size)
{
    shape->size = vec3_make(size, size, size);
}

static int rings(const solid_shape *shape, shape_ring *out)
{
    const vec3 half = vec3_scale(shape->size, 0.5);
    for (int i = 0; i < 2; i++) {
        out[i] = (shape_ring){.y = i == 0 ? -half.y : half.y,
                              .x = sqrt(2.0) * half.x,
                              .z = sqrt(2.0) * half.z,
                              .corners = 4,
                              .from_deg = 45.0};
    }
    return 2;
}

static status tessellation(const solid_shape *shape, int part, mesh **out, diagnostic *why)
{
    (void)part;
    return generate_box(shape->size, out, why);
}

const shape_rule shape_box = {
    .word = "box",
    .meaning = "|x|, |y| and |z| at most half of its size; its position is its centre",
    .parameters = WORDS("size", "material_1", "material_2", "material_rim", "points", "scale"),
    .check = check,
    .contains = contains,
    .primitive_count = 1,
    .primitives = primitives,
    .faces = {WORDS("-x side", "+x side", "bottom", "top", "-z side", "+z side")},
    .ends = {2, 3},
    .flat = flat,
    .extent = extent,
    .farthest = farthest,
    .covers = covers,
    .thickness = thickness,
    .fit = fit,
    .rings = rings,
    .tessellation = tessellation,
};
