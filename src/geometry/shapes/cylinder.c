/* The shapes cylinder and cup. */
#include "geometry/shapes/meniscus.h"
#include "geometry/shapes/parts.h"

/* --- cylinder ---
 *
 * x^2 + m^2 z^2 <= radius^2, 0 <= y <= height, or below a meniscus (meniscus.h). Its position is the centre of its
 * base. */

PRIMITIVE_RULE(cylinder);
PRIMITIVE_RULE(capillary);

static status cylinder_check(const solid_shape *shape, diagnostic *why)
{
    TRY(check_length(shape->radius, "radius", why));
    TRY(check_length(shape->height, "height", why));
    TRY(check_length(shape->m, "m", why));
    return meniscus_check(shape, why);
}

static bool cylinder_contains(const solid_shape *shape, vec3 p)
{
    const double m = shape->m, r = shape->radius;
    if (has_meniscus(shape))
        return capillary_contains(meniscus_of(shape), r, p.x * p.x + p.z * p.z, p.y);
    return p.x * p.x + m * m * p.z * p.z <= r * r && p.y >= 0.0 && p.y <= shape->height;
}

static primitive cylinder_placed(const solid_shape *shape, double radius, double bottom, double top)
{
    primitive p = primitive_placed(shape, &cylinder_rule, shape->height + radius);
    p.radius = radius;
    p.m2 = shape->m * shape->m;
    p.bottom = bottom;
    p.top = top;
    if (p.m2 < 1.0) /* the long axis is radius / m */
        p.extent += radius / shape->m;
    return p;
}

static void cylinder_primitives(const solid_shape *shape, primitive *out)
{
    out[0] = cylinder_placed(shape, shape->radius, 0.0, shape->height);
    if (!has_meniscus(shape))
        return;
    out[0].rule = &capillary_rule;
    out[0].extent += fmax(0.0, meniscus_high(shape) - shape->height);
}

static size_t cylinder_details(const solid_shape *shape, void *out)
{
    if (!has_meniscus(shape))
        return 0;
    if (out)
        *(capillary_profile *)out = *meniscus_of(shape);
    return sizeof(capillary_profile);
}

static int cylinder_more_rows(const solid_shape *shape)
{
    return has_meniscus(shape) ? 1 : 0;
}

static bool cylinder_flat(const solid_shape *shape, size_t i, vec3 *normal, vec3 *point)
{
    const bool is_level = !has_meniscus(shape) || meniscus_of(shape)->radius < shape->radius;
    return level_faces((const double[]){0.0, meniscus_wall(shape)}, is_level ? 2 : 1, i, normal, point);
}

static shape_extent cylinder_extent(const solid_shape *shape)
{
    const double r = shape->radius, deep = r / shape->m, high = meniscus_high(shape);
    return (shape_extent){{vec3_make(-r, 0.0, -deep), vec3_make(r, high, deep)},
                          hypot(r / fmin(shape->m, 1.0), 0.5 * high)};
}

static double cylinder_farthest(const solid_shape *shape, vec3 d)
{
    const double straight = fmax(0.0, meniscus_wall(shape) * d.y) + shape->radius * hypot(d.x, d.z / shape->m);
    return has_meniscus(shape) ? fmax(straight, meniscus_farthest(shape, d)) : straight;
}

/* Exact around a point if the cylinder is round, and about an axis if it is round and upright along the axis; otherwise
 * an overestimate. */
static double cylinder_farthest_from(const placed_shape *placed, const round_frame *f)
{
    const solid_shape *s = &placed->shape;
    const double wide = s->radius * fmax(1.0, 1.0 / s->m), high = meniscus_high(s);
    if (f->from_point) {
        const vec3 p = mat3_apply_transposed(placed->turn, vec3_sub(f->origin, s->position));
        return hypot(hypot(p.x, p.z) + wide, fmax(fabs(p.y), fabs(p.y - high)));
    }
    const vec3 top = vec3_add(s->position, vec3_scale(placed_axis(&placed->turn, 1), high));
    return fmax(round_distance(f, s->position), round_distance(f, top)) + wide * fmax(1.0, f->m);
}

static bool cylinder_covers(const placed_shape *cover, const placed_shape *hidden)
{
    const solid_shape *c = &cover->shape;
    const round_frame frame = {c->position, cover->turn, c->m, false};
    return placed_is_between(cover, hidden, 1, 0.0, meniscus_low(c)) &&
           is_within(placed_farthest_from(hidden, &frame), c->radius, c->radius);
}

static double cylinder_thickness(const solid_shape *shape)
{
    return fmin(meniscus_low(shape), 2.0 * fmin(shape->radius, shape->radius / shape->m));
}

static void cylinder_fit(solid_shape *shape, double size)
{
    shape->radius = 0.5 * size;
    shape->height = size;
    shape->capillary_length = shape->contact_radius = 0.0;
}

static int outline_rings(const solid_shape *shape, shape_ring *out)
{
    const double r = shape->radius;
    out[0] = (shape_ring){.x = r, .z = r / shape->m};
    out[1] = (shape_ring){.y = meniscus_wall(shape), .x = r, .z = r / shape->m};
    return 2;
}

/* A meniscus is a separate convex piece. */
static int cylinder_rings(const solid_shape *shape, shape_ring *out)
{
    enum { CIRCLES = 9 };
    const int outline = outline_rings(shape, out);
    if (!has_meniscus(shape))
        return outline;
    profile_point surface[CIRCLES];
    meniscus_points(shape, CIRCLES, surface);
    for (int i = 0; i < CIRCLES; i++) {
        const double r = surface[i].radius;
        out[outline + i] = (shape_ring){.part = 1, .y = surface[i].height, .x = r, .z = r};
    }
    return outline + CIRCLES;
}

static status cylinder_tessellation(const solid_shape *shape, int part, mesh **out, diagnostic *why)
{
    (void)part;
    const double r = shape->radius, h = shape->height;
    if (!has_meniscus(shape))
        return tessellate_lathe((const profile_point[]){{0.0, 0.0}, {r, 0.0}, {r, h}, {0.0, h}}, 4, out, why);
    profile_point profile[3 + MENISCUS_POINTS] = {{0.0, 0.0}, {r, 0.0}, {r, meniscus_wall(shape)}};
    const bool ring = meniscus_of(shape)->radius < r;
    meniscus_points(shape, MENISCUS_POINTS, profile + 2 + ring);
    return tessellate_lathe(profile, (size_t)(2 + ring + MENISCUS_POINTS), out, why);
}

static vec3 cylinder_tessellation_scale(const solid_shape *shape)
{
    return vec3_make(1.0, 1.0, 1.0 / shape->m);
}

const shape_rule shape_cylinder = {
    .word = "cylinder",
    .meaning = "x^2 + m^2 z^2 <= radius^2, 0 <= y <= height; its position is the centre of its base; with a "
               "capillary_length, a liquid whose top is a meniscus and whose volume is the same",
    .parameters = WORDS("radius", "height", "m", "capillary_length", "contact_angle_deg", "contact_radius",
                        "material_1", "material_2", "material_rim", "points", "scale"),
    .curved = true,
    .check = cylinder_check,
    .contains = cylinder_contains,
    .primitive_count = 1,
    .more_rows = cylinder_more_rows,
    .primitives = cylinder_primitives,
    .details = cylinder_details,
    .faces = {WORDS("side", "bottom", "top", "ring")},
    .ends = {1, 2},
    .flat = cylinder_flat,
    .extent = cylinder_extent,
    .farthest = cylinder_farthest,
    .farthest_from = cylinder_farthest_from,
    .covers = cylinder_covers,
    .thickness = cylinder_thickness,
    .fit = cylinder_fit,
    .rings = cylinder_rings,
    .tessellation = cylinder_tessellation,
    .tessellation_scale = cylinder_tessellation_scale,
};

/* --- cup ---
 *
 * A cylinder of radius, m and height, minus a cylinder of inner_radius and the same m that starts at the height of the
 * floor and is open at the top; a floor of 0 is a tube or ring, open at both ends. Its position is the centre of its
 * base. The ellipses are similar, so that the wall is radius - inner_radius thick along x, and 1 / m of that along z.
 */

static bool is_tube(const solid_shape *shape)
{
    return shape->floor == 0.0;
}

/* The height at which the hollow starts. */
static double hollow_bottom(const solid_shape *shape)
{
    return is_tube(shape) ? -shape->height : shape->floor;
}

static status cup_check(const solid_shape *shape, diagnostic *why)
{
    status code = cylinder_check(shape, why);
    THEN(code, check_length(shape->inner_radius, "inner_radius", why));
    if (!is_tube(shape))
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
static bool cup_contains(const solid_shape *shape, vec3 p)
{
    const double m = shape->m, r = shape->inner_radius;
    return cylinder_contains(shape, p) && !(p.x * p.x + m * m * p.z * p.z < r * r && p.y > hollow_bottom(shape));
}

static void cup_primitives(const solid_shape *shape, primitive *out)
{
    out[0] = cylinder_placed(shape, shape->radius, 0.0, shape->height);
    out[1] = cylinder_placed(shape, shape->inner_radius, hollow_bottom(shape), HUGE_VAL);
}

static bool cup_flat(const solid_shape *shape, size_t i, vec3 *normal, vec3 *point)
{
    return level_faces((const double[]){0.0, shape->height, shape->floor}, is_tube(shape) ? 2 : 3, i, normal, point);
}

/* Whether the hidden shape is outside the hollow: below the floor, or to one side of the hollow. */
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

static bool cup_covers(const placed_shape *cover, const placed_shape *hidden)
{
    return cylinder_covers(cover, hidden) && avoids_hollow(cover, hidden);
}

/* The thickness of the wall or of the floor; a ring may be thinner than its wall. */
static double cup_thickness(const solid_shape *shape)
{
    return fmin((shape->radius - shape->inner_radius) * fmin(1.0, 1.0 / shape->m),
                is_tube(shape) ? shape->height : shape->floor);
}

static void cup_fit(solid_shape *shape, double size)
{
    cylinder_fit(shape, size);
    shape->inner_radius = 0.9 * shape->radius;
    shape->floor = 0.1 * size;
}

static int cup_rings(const solid_shape *shape, shape_ring *out)
{
    const double r = shape->inner_radius;
    const int outside = outline_rings(shape, out);
    out[outside] = (shape_ring){.part = 1, .y = shape->floor, .x = r, .z = r / shape->m};
    out[outside + 1] = (shape_ring){.part = 1, .y = shape->height, .x = r, .z = r / shape->m};
    return outside + 2;
}

/* The outside, whose top is a ring, or the wall and floor of the hollow; of a tube both ends are rings. */
static status cup_tessellation(const solid_shape *shape, int part, mesh **out, diagnostic *why)
{
    const double r = shape->radius, inner = shape->inner_radius, low = shape->floor, h = shape->height;
    const profile_point outside[4] = {{0.0, 0.0}, {r, 0.0}, {r, h}, {inner, h}};
    const profile_point hollow[3] = {{0.0, low}, {inner, low}, {inner, h}};
    if (is_tube(shape)) {
        const profile_point ends[4] = {{inner, 0.0}, {r, 0.0}, {r, h}, {inner, h}};
        return part == 0 ? tessellate_lathe(ends, 4, out, why) : tessellate_lathe(hollow + 1, 2, out, why);
    }
    return part == 0 ? tessellate_lathe(outside, 4, out, why) : tessellate_lathe(hollow, 3, out, why);
}

const shape_rule shape_cup = {
    .word = "cup",
    .meaning =
        "a cylinder minus a cylinder of inner_radius that starts at the height of its floor and is open at the top, "
        "with a floor of 0 also at the bottom; its position is the centre of its base",
    .parameters = WORDS("radius", "height", "m", "inner_radius", "floor", "points", "scale"),
    .hollow = true,
    .curved = true,
    .check = cup_check,
    .contains = cup_contains,
    .primitive_count = 2,
    .primitives = cup_primitives,
    .faces = {WORDS("outer side", "bottom", "rim"), WORDS("inner side", "floor", "rim")},
    .flat = cup_flat,
    .extent = cylinder_extent,
    .farthest = cylinder_farthest,
    .farthest_from = cylinder_farthest_from,
    .covers = cup_covers,
    .thickness = cup_thickness,
    .fit = cup_fit,
    .rings = cup_rings,
    .tessellation = cup_tessellation,
    .tessellation_scale = cylinder_tessellation_scale,
};
