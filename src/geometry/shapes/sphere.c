/* The shape sphere: x^2 + y^2 + z^2 <= radius^2. Its position is its centre. */
#include "geometry/shapes/parts.h"

#include "base/elementary.h"

PRIMITIVE_RULE(sphere);

static status check(const solid_shape *shape, diagnostic *why)
{
    return check_length(shape->radius, "radius", why);
}

static bool contains(const solid_shape *shape, vec3 p)
{
    return vec3_dot(p, p) <= shape->radius * shape->radius;
}

static void primitives(const solid_shape *shape, primitive *out)
{
    out[0] = primitive_placed(shape, &sphere_rule, shape->radius);
    out[0].radius = shape->radius;
}

static shape_extent extent(const solid_shape *shape)
{
    const double r = shape->radius;
    return (shape_extent){{vec3_make(-r, -r, -r), vec3_make(r, r, r)}, r};
}

static double farthest(const solid_shape *shape, vec3 d)
{
    (void)d;
    return shape->radius;
}

static double farthest_from(const placed_shape *placed, const round_frame *f)
{
    return round_distance(f, placed->shape.position) + placed->shape.radius * (f->from_point ? 1.0 : fmax(1.0, f->m));
}

static bool covers(const placed_shape *cover, const placed_shape *hidden)
{
    const solid_shape *c = &cover->shape;
    const round_frame frame = {c->position, cover->turn, 1.0, true};
    return is_within(placed_farthest_from(hidden, &frame), c->radius, c->radius);
}

static double thickness(const solid_shape *shape)
{
    return 2.0 * shape->radius;
}

static void fit(solid_shape *shape, double size)
{
    shape->radius = 0.5 * size;
}

static int rings(const solid_shape *shape, shape_ring *out)
{
    enum { CIRCLES = 13 }; /* every 15 degrees of latitude */
    for (int i = 0; i < CIRCLES; i++) {
        double sine, cosine;
        elementary_sincos_deg(15.0 * i - 90.0, &sine, &cosine);
        out[i] = (shape_ring){.y = shape->radius * sine, .x = shape->radius * cosine, .z = shape->radius * cosine};
    }
    return CIRCLES;
}

/* The unit sphere, 20 4^5 triangles. Its outline is inside the circle by at most 2e-4 of the radius. */
static status tessellation(const solid_shape *shape, int part, mesh **out, diagnostic *why)
{
    (void)shape, (void)part;
    return generate_icosphere(5, out, why);
}

static vec3 tessellation_scale(const solid_shape *shape)
{
    return vec3_make(shape->radius, shape->radius, shape->radius);
}

solid_shape shape_point(vec3 at)
{
    return (solid_shape){.kind = SHAPE_SPHERE, .position = at};
}

const shape_rule shape_sphere = {
    .word = "sphere",
    .meaning = "x^2 + y^2 + z^2 <= radius^2; its position is its centre",
    .parameters = WORDS("radius", "points", "scale"),
    .isotropic = true,
    .curved = true,
    .check = check,
    .contains = contains,
    .primitive_count = 1,
    .primitives = primitives,
    .extent = extent,
    .farthest = farthest,
    .farthest_from = farthest_from,
    .covers = covers,
    .thickness = thickness,
    .fit = fit,
    .rings = rings,
    .tessellation = tessellation,
    .tessellation_scale = tessellation_scale,
    .one_tessellation = true,
};
