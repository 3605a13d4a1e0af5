/* The shape lens: within the radius diameter / 2 of the axis, between two conics of revolution about it (lens.h): side
 * 1 through the position, its vertex, and side 2 through the vertex `thickness` above. A radius of curvature is
 * positive if its centre lies above the vertex, as for light that travels upwards (Hecht, Optics, 5.2): a biconvex
 * lens has radius_1 > 0 > radius_2. 0 is a flat side. */
#include "geometry/shapes/parts.h"

#include "base/elementary.h"
#include "geometry/primitives/lens.h"
#include <stdio.h>

PRIMITIVE_RULE(lens);
PRIMITIVE_RULE(meniscus);
PRIMITIVE_RULE(biconcave);

enum { ARC_STEPS = 48 }; /* of a side's profile in a tessellation */

typedef struct side {
    double curvature, conic, vertex;
    bool concave;
} side;

static side side_of(const solid_shape *s, int k)
{
    const double radius = k == 0 ? s->radius_1 : s->radius_2;
    return (side){.curvature = radius == 0.0 ? 0.0 : 1.0 / radius,
                  .conic = k == 0 ? s->conic_1 : s->conic_2,
                  .vertex = k == 0 ? 0.0 : s->thickness,
                  .concave = k == 0 ? radius < 0.0 : radius > 0.0};
}

static double height_at(const side *e, double rho)
{
    return e->vertex + lens_sag(e->curvature, e->conic, rho * rho);
}

static double rim(const solid_shape *s)
{
    return 0.5 * s->diameter;
}

/* The heights of the rim's two edges. */
static double edge(const solid_shape *s, int k)
{
    const side e = side_of(s, k);
    return height_at(&e, rim(s));
}

static double gap_at(const solid_shape *s, double rho)
{
    const side one = side_of(s, 0), two = side_of(s, 1);
    return height_at(&two, rho) - height_at(&one, rho);
}

/* The radius at which the sides are nearest to each other: on the axis, at the rim, or where their slopes c rho /
 * sqrt(1 - (1 + k) c^2 rho^2) are equal: rho^2 = (c1^2 - c2^2) / (c1^2 c2^2 (k2 - k1)). */
static double nearest_sides(const solid_shape *s)
{
    const side one = side_of(s, 0), two = side_of(s, 1);
    const double a = one.curvature * one.curvature, b = two.curvature * two.curvature;
    const double rho2 = (a - b) / (a * b * (two.conic - one.conic));
    double nearest = gap_at(s, rim(s)) < s->thickness ? rim(s) : 0.0;
    if (rho2 > 0.0 && rho2 < rim(s) * rim(s) && gap_at(s, sqrt(rho2)) < gap_at(s, nearest))
        nearest = sqrt(rho2);
    return nearest;
}

/* A conic with 1 + k > 0 is an ellipsoid of half width |radius| / sqrt(1 + k). */
static status check_side(const solid_shape *s, int k, diagnostic *why)
{
    const double radius = k == 0 ? s->radius_1 : s->radius_2, conic = k == 0 ? s->conic_1 : s->conic_2;
    if (!isfinite(radius) || !isfinite(conic))
        return diagnose(why, STATUS_BAD_INPUT, "use finite numbers; a radius of 0 is a flat side",
                        "radius_%d or conic_%d is not finite", k + 1, k + 1);
    const double half = conic > -1.0 ? fabs(radius) / sqrt(1.0 + conic) : HUGE_VAL;
    if (radius == 0.0 || s->diameter <= 2.0 * half)
        return STATUS_OK;
    char remedy[160];
    snprintf(remedy, sizeof remedy, "use a diameter of at most %g, or a radius_%d of at least %g in magnitude",
             2.0 * half, k + 1, fabs(radius) * (s->diameter / (2.0 * half)));
    return diagnose(why, STATUS_BAD_INPUT, remedy, "diameter %g is larger than side %d, which ends at a diameter of %g",
                    s->diameter, k + 1, 2.0 * half);
}

static status check(const solid_shape *s, diagnostic *why)
{
    TRY(check_length(s->diameter, "diameter", why));
    TRY(check_length(s->thickness, "thickness", why));
    TRY(check_side(s, 0, why));
    TRY(check_side(s, 1, why));
    const double at = nearest_sides(s), gap = gap_at(s, at);
    if (gap >= -PLACED_SLACK * (s->thickness + s->diameter)) /* 0: the sides meet in a sharp edge */
        return STATUS_OK;
    char remedy[160];
    snprintf(remedy, sizeof remedy, "use a thickness of at least %.9g, or a smaller diameter", s->thickness - gap);
    return diagnose(why, STATUS_BAD_INPUT, remedy,
                    "thickness %g is too small: the sides cross within the rim, at %g from the axis", s->thickness, at);
}

static bool contains(const solid_shape *s, vec3 p)
{
    const side one = side_of(s, 0), two = side_of(s, 1);
    const double rho = sqrt(p.x * p.x + p.z * p.z);
    return rho <= rim(s) && p.y >= height_at(&one, rho) && p.y <= height_at(&two, rho);
}

static void primitives(const solid_shape *s, primitive *out)
{
    const side one = side_of(s, 0), two = side_of(s, 1);
    const primitive_rule *const by_concave_sides[] = {&lens_rule, &meniscus_rule, &biconcave_rule};
    const double reach = s->thickness + rim(s) + fmax(fabs(edge(s, 0)), fabs(edge(s, 1)));
    out[0] = primitive_placed(s, by_concave_sides[one.concave + two.concave], reach);
    out[0].radius = rim(s);
    out[0].top = s->thickness;
    out[0].lens = (lens_sides){{one.curvature, two.curvature}, {one.conic, two.conic}};
}

static bool flat(const solid_shape *s, size_t i, vec3 *normal, vec3 *point)
{
    double heights[2];
    size_t count = 0;
    for (int k = 0; k < 2; k++) {
        const side e = side_of(s, k);
        if (e.curvature == 0.0)
            heights[count++] = e.vertex;
    }
    return level_faces(heights, count, i, normal, point);
}

static double lowest(const solid_shape *s)
{
    return fmin(0.0, edge(s, 0));
}

static double highest(const solid_shape *s)
{
    return fmax(s->thickness, edge(s, 1));
}

static shape_extent extent(const solid_shape *s)
{
    const double r = rim(s), low = lowest(s), high = highest(s);
    return (shape_extent){{vec3_make(-r, low, -r), vec3_make(r, high, r)}, hypot(r, 0.5 * (high - low))};
}

/* Of a convex side, the point whose normal is d, if it is within the rim: its slope c rho / sqrt(1 - (1 + k) c^2 rho^2)
 * is that of d. Otherwise the rim's edge. */
static double farthest_of_side(const solid_shape *s, int k, vec3 d)
{
    const side e = side_of(s, k);
    const double out = hypot(d.x, d.z), outwards = k == 0 ? -d.y : d.y, slope = out / outwards;
    double rho = rim(s);
    if (!e.concave && e.curvature != 0.0 && outwards > 0.0 && 1.0 + (1.0 + e.conic) * slope * slope > 0.0)
        rho = fmin(rho, slope / (fabs(e.curvature) * sqrt(1.0 + (1.0 + e.conic) * slope * slope)));
    return rho * out + height_at(&e, rho) * d.y;
}

static double farthest(const solid_shape *s, vec3 d)
{
    return fmax(farthest_of_side(s, 0, d), farthest_of_side(s, 1, d));
}

static double thickness(const solid_shape *s)
{
    return fmax(0.0, gap_at(s, nearest_sides(s)));
}

/* A biconvex lens. */
static void fit(solid_shape *s, double size)
{
    s->diameter = size;
    s->thickness = 0.3 * size;
    s->radius_1 = size;
    s->radius_2 = -size;
    s->conic_1 = s->conic_2 = 0.0;
}

/* The rim, whose outline contains convex sides; a concave side is a piece of its own. */
static int rings(const solid_shape *s, shape_ring *out)
{
    enum { CIRCLES = 7 }; /* of a side */
    int count = 0, pieces = 0;
    for (int k = 0; k < 2; k++) {
        const side e = side_of(s, k);
        const int piece = e.concave ? ++pieces : 0;
        for (int i = 0; i < CIRCLES; i++) {
            const double rho = rim(s) * i / (CIRCLES - 1);
            out[count++] = (shape_ring){.part = piece, .y = height_at(&e, rho), .x = rho, .z = rho};
        }
        if (e.concave)
            out[count++] = (shape_ring){.y = edge(s, k), .x = rim(s), .z = rim(s)};
    }
    return count;
}

/* From the axis along side 1 to the rim, and back along side 2; a sharp edge is one point. */
static status tessellation(const solid_shape *s, int part, mesh **out, diagnostic *why)
{
    (void)part;
    profile_point profile[2 * ARC_STEPS + 2];
    size_t count = 0;
    const bool is_sharp = !(edge(s, 1) - edge(s, 0) > PLACED_SLACK * (s->thickness + s->diameter));
    for (int k = 0; k < 2; k++) {
        const side e = side_of(s, k);
        const int steps = e.curvature == 0.0 ? 1 : ARC_STEPS;
        for (int i = k && is_sharp ? 1 : 0; i <= steps; i++) {
            double sine, cosine;
            elementary_sincos_deg(90.0 * (k == 0 ? i : steps - i) / steps, &sine, &cosine);
            profile[count++] = (profile_point){rim(s) * sine, height_at(&e, rim(s) * sine)};
        }
    }
    return tessellate_lathe(profile, count, out, why);
}

const shape_rule shape_lens = {
    .word = "lens",
    .meaning =
        "x^2 + z^2 <= (diameter / 2)^2, between side 1, through its position, and side 2, which crosses the axis "
        "at y = thickness: spheres, or conics, of signed radii of curvature radius_1 and radius_2, positive if "
        "the centre lies above the side, 0 for a flat one; the sides do not cross within the rim",
    .parameters = WORDS("radius_1", "radius_2", "thickness", "diameter", "conic_1", "conic_2"),
    .curved = true,
    .check = check,
    .contains = contains,
    .primitive_count = 1,
    .further_rows = 2,
    .primitives = primitives,
    .faces = {WORDS("rim", "side 1", "side 2")},
    .flat = flat,
    .extent = extent,
    .farthest = farthest,
    .thickness = thickness,
    .fit = fit,
    .rings = rings,
    .tessellation = tessellation,
};
