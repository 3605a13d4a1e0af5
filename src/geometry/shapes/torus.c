/* The shape torus: (sqrt(x^2 + z^2) - radius)^2 + y^2 <= tube_radius^2, a ring with a hole: tube_radius < radius. Its
 * position is its centre; its axis is local y. */
#include "geometry/shapes/parts.h"

#include "base/elementary.h"

PRIMITIVE_RULE(torus);

static status check(const solid_shape *shape, diagnostic *why)
{
    status code = check_length(shape->radius, "radius", why);
    THEN(code, check_length(shape->tube_radius, "tube_radius", why));
    if (code == STATUS_OK && shape->tube_radius >= shape->radius)
        code = diagnose(why, STATUS_BAD_INPUT, "make tube_radius smaller than radius, or the ring has no hole",
                        "tube_radius %g is not smaller than radius %g", shape->tube_radius, shape->radius);
    return code;
}

static bool contains(const solid_shape *shape, vec3 p)
{
    const double apart = sqrt(p.x * p.x + p.z * p.z) - shape->radius;
    return apart * apart + p.y * p.y <= shape->tube_radius * shape->tube_radius;
}

static double outer_radius(const solid_shape *shape)
{
    return shape->radius + shape->tube_radius;
}

static void primitives(const solid_shape *shape, primitive *out)
{
    out[0] = primitive_placed(shape, &torus_rule, outer_radius(shape));
    out[0].radius = shape->radius;
    out[0].second_radius = shape->tube_radius;
}

static shape_extent extent(const solid_shape *shape)
{
    const vec3 high = vec3_make(outer_radius(shape), shape->tube_radius, outer_radius(shape));
    return (shape_extent){{vec3_scale(high, -1.0), high}, outer_radius(shape)};
}

static double farthest(const solid_shape *shape, vec3 d)
{
    return shape->radius * hypot(d.x, d.z) + shape->tube_radius;
}

static double thickness(const solid_shape *shape)
{
    return 2.0 * shape->tube_radius;
}

static void fit(solid_shape *shape, double size)
{
    shape->radius = 0.35 * size;
    shape->tube_radius = 0.15 * size;
}

/* The outer half of the tube, and the hole. */
static int rings(const solid_shape *shape, shape_ring *out)
{
    enum { CIRCLES = 7 }; /* every 30 degrees around the tube */
    for (int i = 0; i < CIRCLES; i++) {
        double sine, cosine;
        elementary_sincos_deg(30.0 * i - 90.0, &sine, &cosine);
        const double r = shape->radius + shape->tube_radius * cosine;
        out[i] = (shape_ring){.y = shape->tube_radius * sine, .x = r, .z = r};
    }
    const double hole = shape->radius - shape->tube_radius;
    out[CIRCLES] = (shape_ring){.part = 1, .x = hole, .z = hole};
    return CIRCLES + 1;
}

static status tessellation(const solid_shape *shape, int part, mesh **out, diagnostic *why)
{
    (void)part;
    return generate_torus(shape->radius, shape->tube_radius, ROUND_SEGMENTS, ROUND_SEGMENTS / 2, out, why);
}

const shape_rule shape_torus = {
    .word = "torus",
    .meaning =
        "(sqrt(x^2 + z^2) - radius)^2 + y^2 <= tube_radius^2, with tube_radius less than radius; its position is "
        "its centre",
    .parameters = WORDS("radius", "tube_radius", "points", "scale"),
    .curved = true,
    .check = check,
    .contains = contains,
    .primitive_count = 1,
    .further_rows = 1,
    .primitives = primitives,
    .extent = extent,
    .farthest = farthest,
    .thickness = thickness,
    .fit = fit,
    .rings = rings,
    .tessellation = tessellation,
};
