/* The shape lens: within the radius diameter / 2 of the axis, between two conics of revolution about it, or aspheres
 * (lens_profile.h), or sides that are not round (lens_toric.c): side 1 through the position, its vertex, and side 2
 * through the vertex `thickness` above. A side with a smaller diameter of its own is continued by a level ring, so that
 * the rim may be wider than a sphere. A bevel at 45 degrees may cut the edge between a round side, or its ring, and the
 * rim. A radius of curvature is positive if its centre lies above the vertex, as for light that travels upwards (Hecht,
 * Optics, 5.2): a biconvex lens has radius_1 > 0 > radius_2. 0 is a flat side. Coefficients count upwards for both
 * sides. */
#include "geometry/shapes/parts.h"

#include "base/elementary.h"
#include "geometry/shapes/lens_profile.h"
#include <stdio.h>

PRIMITIVE_RULE(asphere);
PRIMITIVE_RULE(asphere_5);
PRIMITIVE_RULE(asphere_7);
PRIMITIVE_RULE(asphere_9);
PRIMITIVE_RULE(lens);
PRIMITIVE_RULE(meniscus);
PRIMITIVE_RULE(biconcave);

enum { ARC_STEPS = 48 }; /* of a side's profile in a tessellation */

/* A conic with 1 + k > 0 is an ellipsoid of half width |radius| / sqrt(1 + k); with coefficients, its slope at the rim
 * is finite. */
static status check_side(const solid_shape *s, int k, diagnostic *why)
{
    const lens_profile e = lens_profile_of(s, k);
    const double radius = k == 0 ? s->radius_1 : s->radius_2;
    if (!isfinite(radius) || !isfinite(e.conic))
        return diagnose(why, STATUS_BAD_INPUT, "use finite numbers; a radius of 0 is a flat side",
                        "radius_%d or conic_%d is not finite", k + 1, k + 1);
    if (e.twisted)
        return lens_twisted_check(s, k, why);
    const double fraction = e.aspheric ? sqrt(1.0 - ASPHERE_ROOT2_LEAST) : 1.0;
    const double half = e.conic > -1.0 ? fraction * fabs(radius) / sqrt(1.0 + e.conic) : HUGE_VAL;
    const double diameter = 2.0 * lens_clear_of(s, k);
    if (radius == 0.0 || diameter <= 2.0 * half)
        return STATUS_OK;
    char remedy[160];
    snprintf(remedy, sizeof remedy, "use a diameter_%d of at most %g, or a radius_%d of at least %g in magnitude",
             k + 1, 2.0 * half, k + 1, fabs(radius) * (diameter / (2.0 * half)));
    return diagnose(why, STATUS_BAD_INPUT, remedy,
                    "diameter %g is larger than side %d, which %sends at a diameter of %g", diameter, k + 1,
                    e.aspheric ? "with coefficients " : "", 2.0 * half);
}

static status check_diameters(const solid_shape *s, diagnostic *why)
{
    const double larger = fmax(s->diameter_1, s->diameter_2);
    const int k = s->diameter_1 < s->diameter_2;
    if (!(s->diameter_1 >= 0.0 && s->diameter_2 >= 0.0))
        return diagnose(why, STATUS_BAD_INPUT, "use numbers from 0, which stands for the diameter",
                        "diameter_1 is %g and diameter_2 is %g", s->diameter_1, s->diameter_2);
    if (larger <= s->diameter)
        return STATUS_OK;
    char remedy[160];
    snprintf(remedy, sizeof remedy, "use a diameter of at least %.9g, or a smaller diameter_%d", larger, k + 1);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "diameter_%d %g is larger than the diameter %g", k + 1, larger,
                    s->diameter);
}

static status check_coefficients(const solid_shape *s, int k, diagnostic *why)
{
    const double *even = k == 0 ? s->even_1 : s->even_2, *odd = k == 0 ? s->odd_1 : s->odd_2;
    for (int i = 0; i < ASPHERE_TERMS + ASPHERE_ODD; i++)
        if (!isfinite(i < ASPHERE_TERMS ? even[i] : odd[i - ASPHERE_TERMS]))
            return diagnose(why, STATUS_BAD_INPUT, "use finite numbers", "a%d_%d is not finite",
                            i < ASPHERE_TERMS ? 4 + 2 * i : asphere_odd_power(i - ASPHERE_TERMS), k + 1);
    return STATUS_OK;
}

/* The largest amount by which a side is beyond the cone of its bevel within it, or short of it beyond. */
static double beyond_bevel(const solid_shape *s, int k)
{
    enum { STEPS = 256 };
    const lens_profile e = lens_profile_of(s, k);
    const double end = lens_end(s, k), inwards = k == 0 ? 1.0 : -1.0;
    double most = -HUGE_VAL;
    for (int i = 0; i <= STEPS; i++) {
        const double rho = lens_rim(s) * i / STEPS, cone = (rho - end) + inwards * (lens_edge(s, k) - e.vertex),
                     off = inwards * (lens_height_at(&e, rho) - e.vertex) - cone;
        most = fmax(most, rho < end ? -off : off);
    }
    return most;
}

static status check_chamfer(const solid_shape *s, int k, diagnostic *why)
{
    const double length = lens_chamfer(s, k), own = k == 0 ? s->diameter_1 : s->diameter_2;
    const double slack = PLACED_SLACK * (s->thickness + s->diameter), clear = own > 0.0 ? 0.5 * own : 0.0;
    char remedy[160];
    if (!(length >= 0.0 && isfinite(length)))
        return diagnose(why, STATUS_BAD_INPUT, "use a length from 0, which stands for none", "chamfer_%d is %g", k + 1,
                        length);
    if (length == 0.0)
        return STATUS_OK;
    if (own == 0.0 && !(length < lens_rim(s))) {
        snprintf(remedy, sizeof remedy, "use a chamfer_%d below %.9g", k + 1, lens_rim(s));
        return diagnose(why, STATUS_BAD_INPUT, remedy, "chamfer_%d %g reaches the axis", k + 1, length);
    }
    if (length > lens_rim(s) - clear + slack) {
        snprintf(remedy, sizeof remedy, "use a chamfer_%d of at most %.9g, or a smaller diameter_%d", k + 1,
                 lens_rim(s) - clear, k + 1);
        return diagnose(why, STATUS_BAD_INPUT, remedy, "chamfer_%d %g reaches into the diameter %g of side %d", k + 1,
                        length, own, k + 1);
    }
    if (beyond_bevel(s, k) <= slack)
        return STATUS_OK;
    snprintf(remedy, sizeof remedy, "use another chamfer_%d, or a diameter_%d that ends before it", k + 1, k + 1);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "side %d is steeper than 45 degrees at its chamfer", k + 1);
}

/* The least distance along the axis between the surfaces of both sides beyond the beginning of a bevel, and the radius
 * where it is. */
static double least_edge(const solid_shape *s, double *at)
{
    enum { STEPS = 256 };
    const double from = fmin(lens_end(s, 0), lens_end(s, 1));
    double least = HUGE_VAL;
    for (int i = 0; i <= STEPS; i++) {
        const double rho = from + (lens_rim(s) - from) * i / STEPS;
        double height[2];
        for (int k = 0; k < 2; k++) {
            const lens_profile e = lens_profile_of(s, k);
            const double end = lens_end(s, k), inwards = k == 0 ? 1.0 : -1.0;
            height[k] = rho > end ? lens_edge(s, k) + inwards * (rho - end) : lens_height_at(&e, rho);
        }
        if (height[1] - height[0] < least)
            least = height[1] - height[0], *at = rho;
    }
    return least;
}

static status check_chamfers(const solid_shape *s, diagnostic *why)
{
    if (s->chamfer_1 == 0.0 && s->chamfer_2 == 0.0)
        return STATUS_OK;
    for (int k = 0; k < 2; k++)
        if (lens_profile_of(s, k).twisted)
            return diagnose(why, STATUS_BAD_INPUT,
                            "set chamfer_1 and chamfer_2 to 0, or the form of that side to round",
                            "side %d is not round: its edge is not level, and has no bevel", k + 1);
    for (int k = 0; k < 2; k++)
        TRY(check_chamfer(s, k, why));
    double at;
    const double left = least_edge(s, &at);
    if (left >= -PLACED_SLACK * (s->thickness + s->diameter)) /* 0: the bevels meet in a sharp edge */
        return STATUS_OK;
    char remedy[160];
    snprintf(remedy, sizeof remedy, "use chamfers that are %.6g shorter in sum, or a larger thickness", -left);
    return diagnose(why, STATUS_BAD_INPUT, remedy,
                    "chamfer_1 %g and chamfer_2 %g are longer than the edge: they leave nothing at %.6g from the axis",
                    s->chamfer_1, s->chamfer_2, at);
}

static status check_form(const solid_shape *s, int k, lens_form *form, diagnostic *why)
{
    double within;
    *form = lens_form_of(s, k, &within);
    if (*form < LENS_TURNS)
        return STATUS_OK;
    if (lens_profile_of(s, k).twisted && *form == LENS_TURNS)
        return diagnose(
            why, STATUS_BAD_INPUT,
            "use coefficients that leave its curve convex or concave as radius_1_x is, or a radius_1_x of 0",
            "side %d, a curve with coefficients that is turned about a line, may be crossed too often", k + 1);
    char remedy[160], diameter[48] = "smaller diameter"; /* if the side is not allowed even near the axis */
    if (within > 0.0)
        snprintf(diameter, sizeof diameter, "diameter of at most %.6g", 2.0 * within);
    snprintf(remedy, sizeof remedy, "use a %s, or smaller coefficients of side %d", diameter, k + 1);
    const char *what = *form == LENS_STEEP ? "is too steep" : "turns too often between convex and concave";
    return diagnose(why, STATUS_BAD_INPUT, remedy, "side %d %s, within %.6g from the axis", k + 1, what,
                    lens_clear_of(s, k));
}

static status check_forms(const solid_shape *s, diagnostic *why)
{
    lens_form form[2] = {LENS_CONVEX, LENS_CONVEX};
    TRY(check_form(s, 0, &form[0], why));
    TRY(check_form(s, 1, &form[1], why));
    if (lens_chords_of(s, form) <= CHORDS_MAX)
        return STATUS_OK;
    const int turns = form[0] < form[1] ? 2 : 1;
    char remedy[160];
    snprintf(remedy, sizeof remedy, "use smaller coefficients of side %d, or a smaller diameter", turns);
    return diagnose(why, STATUS_BAD_INPUT, remedy,
                    "the sides turn so often between convex and concave that a line could cross the lens %d times",
                    2 * lens_chords_of(s, form));
}

static status check(const solid_shape *s, diagnostic *why)
{
    TRY(check_length(s->diameter, "diameter", why));
    TRY(check_length(s->thickness, "thickness", why));
    TRY(check_diameters(s, why));
    TRY(check_coefficients(s, 0, why));
    TRY(check_coefficients(s, 1, why));
    TRY(check_side(s, 0, why));
    TRY(check_side(s, 1, why));
    TRY(check_forms(s, why));
    TRY(check_chamfers(s, why));
    double at;
    const double gap = lens_least_gap(s, &at);
    if (gap >= -PLACED_SLACK * (s->thickness + s->diameter)) /* 0: the sides meet in a sharp edge */
        return STATUS_OK;
    char remedy[160];
    snprintf(remedy, sizeof remedy, "use a thickness of at least %.9g, or a smaller diameter", s->thickness - gap);
    return diagnose(why, STATUS_BAD_INPUT, remedy,
                    "thickness %g is too small: the sides cross within the rim, at %g from the axis", s->thickness, at);
}

static bool contains(const solid_shape *s, vec3 p)
{
    const lens_profile one = lens_profile_of(s, 0), two = lens_profile_of(s, 1);
    for (int k = 0; k < 2; k++)
        if (lens_chamfer(s, k) > 0.0 &&
            sqrt(p.x * p.x + p.z * p.z) > lens_end(s, k) + (k == 0 ? 1.0 : -1.0) * (p.y - lens_edge(s, k)))
            return false;
    return sqrt(p.x * p.x + p.z * p.z) <= lens_rim(s) && p.y >= lens_height_over(&one, p.x, p.z) &&
           p.y <= lens_height_over(&two, p.x, p.z);
}

static double lowest(const solid_shape *s)
{
    return lens_lowest_of(s, 0);
}

static double highest(const solid_shape *s)
{
    return lens_highest_of(s, 1);
}

static size_t details(const solid_shape *s, void *out)
{
    const lens_profile side[2] = {lens_profile_of(s, 0), lens_profile_of(s, 1)};
    lens_details *const d = out;
    solid_shape whole = *s; /* without bevels: sides are intersected up to the rim */
    whole.chamfer_1 = whole.chamfer_2 = 0.0;
    for (int k = 0; k < 2 && d; k++) {
        for (int i = 0; i < ASPHERE_TERMS; i++)
            d->even[k][i] = side[k].e.even[i];
        d->low[k] = lens_lowest_of(&whole, k) - side[k].vertex;
        d->high[k] = lens_highest_of(&whole, k) - side[k].vertex;
        d->clear[k] = side[k].clear;
        d->bevel[k] = lens_chamfer(s, k) > 0.0 ? lens_end(s, k) : HUGE_VAL;
        d->apex[k] = lens_edge(s, k) - (k == 0 ? 1.0 : -1.0) * lens_end(s, k);
        d->general[k] = side[k].twisted || side[k].e.odd_terms > 0;
        for (int i = 0; i < ASPHERE_ODD; i++)
            d->odd[k][i] = side[k].e.odd[i];
        d->form[k] = side[k].e.form, d->curvature_x[k] = side[k].e.curvature_x;
        d->conic_x[k] = k == 0 ? s->conic_1_x : s->conic_2_x;
    }
    bool more = false;
    for (int k = 0; k < 2; k++)
        more |= side[k].aspheric || lens_has_ring(&side[k]) || lens_chamfer(s, k) > 0.0;
    return more ? sizeof(lens_details) : 0;
}

/* The most chords of a lens with details, at least those of any other: an odd number. */
static int most_chords(const solid_shape *s)
{
    double within;
    const lens_form form[2] = {lens_form_of(s, 0, &within), lens_form_of(s, 1, &within)};
    const int most = details(s, NULL) > 0 ? lens_chords_of(s, form) : 0;
    return most <= 3 ? 3 : most < CHORDS_MAX ? most | 1 : CHORDS_MAX;
}

static int more_rows(const solid_shape *s)
{
    return most_chords(s) - 3;
}

static void primitives(const solid_shape *s, primitive *out)
{
    const lens_profile one = lens_profile_of(s, 0), two = lens_profile_of(s, 1);
    const primitive_rule *const by_concave_sides[] = {&lens_rule, &meniscus_rule, &biconcave_rule};
    const primitive_rule *const by_chords[] = {&asphere_rule, &asphere_5_rule, &asphere_7_rule, &asphere_9_rule};
    const bool aspheric = details(s, NULL) > 0;
    const double reach = aspheric ? lens_rim(s) + fmax(fabs(lowest(s)), fabs(highest(s)))
                                  : s->thickness + lens_rim(s) + fmax(fabs(lens_edge(s, 0)), fabs(lens_edge(s, 1)));
    out[0] = primitive_placed(
        s, aspheric ? by_chords[(most_chords(s) - 3) / 2] : by_concave_sides[one.concave + two.concave], reach);
    out[0].radius = lens_rim(s);
    out[0].top = s->thickness;
    out[0].lens = (lens_sides){.curvature = {one.e.curvature, two.e.curvature}, .conic = {one.conic, two.conic}};
}

static bool flat(const solid_shape *s, size_t i, vec3 *normal, vec3 *point)
{
    double heights[4];
    size_t count = 0;
    for (int k = 0; k < 2; k++) {
        const lens_profile e = lens_profile_of(s, k);
        if (lens_is_flat(&e))
            heights[count++] = e.vertex;
        if (lens_has_ring(&e))
            heights[count++] = lens_edge(s, k);
    }
    return level_faces(heights, count, i, normal, point);
}

static shape_extent extent(const solid_shape *s)
{
    const double r = lens_rim(s), low = lowest(s), high = highest(s);
    return (shape_extent){{vec3_make(-r, low, -r), vec3_make(r, high, r)}, hypot(r, 0.5 * (high - low))};
}

/* The maximum of d . p over a side. On a convex side it is at the point whose normal is d, with the slope c rho /
 * sqrt(1 - (1 + k) c^2 rho^2) of d, if that is within the rim; otherwise at the rim's edge. */
static double farthest_of_side(const solid_shape *s, int k, vec3 d)
{
    const lens_profile e = lens_profile_of(s, k);
    if (e.twisted)
        return lens_twisted_reach(s, k, d);
    const double out = hypot(d.x, d.z), outwards = k == 0 ? -d.y : d.y, slope = out / outwards;
    const double at_rim =
        fmax(lens_rim(s) * out + lens_rim_edge(s, k) * d.y, lens_end(s, k) * out + lens_edge(s, k) * d.y);
    double rho = lens_seen_of(s, k);
    if (e.aspheric)
        return fmax(at_rim, lens_reach_of(s, k, out, d.y));
    if (!e.concave && e.e.curvature != 0.0 && outwards > 0.0 && 1.0 + (1.0 + e.conic) * slope * slope > 0.0)
        rho = fmin(rho, slope / (fabs(e.e.curvature) * sqrt(1.0 + (1.0 + e.conic) * slope * slope)));
    return fmax(at_rim, rho * out + lens_height_at(&e, rho) * d.y);
}

static double farthest(const solid_shape *s, vec3 d)
{
    return fmax(farthest_of_side(s, 0, d), farthest_of_side(s, 1, d));
}

static double thickness(const solid_shape *s)
{
    double at;
    const double gap = lens_least_gap(s, &at);
    if (s->chamfer_1 == 0.0 && s->chamfer_2 == 0.0)
        return fmax(0.0, gap);
    return fmax(0.0, fmin(gap, least_edge(s, &at)));
}

/* A biconvex lens. */
static void fit(solid_shape *s, double size)
{
    s->diameter = size;
    s->thickness = 0.3 * size;
    s->radius_1 = size;
    s->radius_2 = -size;
    s->conic_1 = s->conic_2 = 0.0;
    s->diameter_1 = s->diameter_2 = s->chamfer_1 = s->chamfer_2 = 0.0;
    for (int i = 0; i < ASPHERE_TERMS; i++)
        s->even_1[i] = s->even_2[i] = 0.0;
    for (int i = 0; i < ASPHERE_ODD; i++)
        s->odd_1[i] = s->odd_2[i] = 0.0;
    s->form_1 = s->form_2 = SIDE_ROUND;
}

/* The outline of the rim contains convex sides; any other side is a separate piece. */
static int rings(const solid_shape *s, shape_ring *out)
{
    enum { CIRCLES = 7 }; /* of a side */
    int count = 0, pieces = 0;
    for (int k = 0; k < 2; k++) {
        const lens_profile e = lens_profile_of(s, k);
        double within;
        const bool convex = lens_form_of(s, k, &within) == LENS_CONVEX && !lens_has_ring(&e);
        const int piece = convex ? 0 : ++pieces;
        if (e.twisted) {
            count += lens_twisted_rings(s, k, piece, out + count);
            continue;
        }
        for (int i = 0; i < CIRCLES; i++) {
            const double rho = lens_seen_of(s, k) * i / (CIRCLES - 1);
            out[count++] = (shape_ring){.part = piece, .y = lens_height_at(&e, rho), .x = rho, .z = rho};
        }
        const double end = lens_end(s, k), edge = lens_edge(s, k);
        if (lens_has_ring(&e))
            out[count++] = (shape_ring){.part = piece, .y = edge, .x = end, .z = end};
        if (!convex)
            out[count++] = (shape_ring){.y = edge, .x = end, .z = end};
        if (lens_chamfer(s, k) > 0.0)
            out[count++] = (shape_ring){.y = lens_rim_edge(s, k), .x = lens_rim(s), .z = lens_rim(s)};
    }
    return count;
}

/* The profile of side k from the axis to the rim: the side, its ring, and its bevel; level at the height k if one
 * of the sides is not round (twisted). */
static size_t profile_of(const solid_shape *s, int k, bool twisted, profile_point *out)
{
    const lens_profile e = lens_profile_of(s, k);
    const int steps = lens_is_flat(&e) && !twisted ? 1 : ARC_STEPS;
    size_t count = 0;
    for (int i = 0; i <= steps; i++) {
        double sine, cosine;
        elementary_sincos_deg(90.0 * i / steps, &sine, &cosine);
        const double rho = lens_seen_of(s, k) * sine;
        out[count++] = (profile_point){rho, twisted ? k : lens_height_at(&e, rho)};
    }
    if (lens_has_ring(&e) && lens_end(s, k) > lens_seen_of(s, k))
        out[count++] = (profile_point){lens_end(s, k), twisted ? k : lens_edge(s, k)};
    if (lens_chamfer(s, k) > 0.0)
        out[count++] = (profile_point){lens_rim(s), lens_rim_edge(s, k)};
    return count;
}

/* From the axis along side 1 to the rim, and back along side 2; a sharp edge is one point. A side that is not round
 * moves a level disc's triangles. */
static status tessellation(const solid_shape *s, int part, mesh **out, diagnostic *why)
{
    (void)part;
    const bool twisted = lens_profile_of(s, 0).twisted || lens_profile_of(s, 1).twisted;
    profile_point profile[2 * ARC_STEPS + 6], back[ARC_STEPS + 3];
    const bool is_sharp =
        !twisted && !(lens_rim_edge(s, 1) - lens_rim_edge(s, 0) > PLACED_SLACK * (s->thickness + s->diameter));
    size_t count = profile_of(s, 0, twisted, profile), left = profile_of(s, 1, twisted, back) - is_sharp;
    while (left > 0)
        profile[count++] = back[--left];
    TRY(tessellate_lathe(profile, count, out, why));
    const status code = twisted ? lens_twist_mesh(s, *out, why) : STATUS_OK;
    if (code != STATUS_OK)
        mesh_release(*out), *out = NULL;
    return code;
}

const shape_rule shape_lens = {
    .word = "lens",
    .meaning =
        "x^2 + z^2 <= (diameter / 2)^2, between side 1, through its position, and side 2, which crosses the axis "
        "at y = thickness: spheres, or conics, of signed radii of curvature radius_1 and radius_2, positive if "
        "the centre lies above the side, 0 for a flat one; with a1_1 to a20_2 aspheres, with form_1 or form_2 biconic "
        "or toric; a side with a smaller diameter_1 or diameter_2 of its own ends in a level ring; chamfer_1 and "
        "chamfer_2 cut the edges of the rim at 45 degrees; the sides do not cross within the rim",
    .parameters =
        WORDS("radius_1", "radius_2", "thickness", "diameter", "diameter_1", "diameter_2", "chamfer_1", "chamfer_2",
              "conic_1", "conic_2", "a4_1", "a6_1", "a8_1", "a10_1", "a12_1", "a14_1", "a16_1", "a18_1", "a20_1",
              "a4_2", "a6_2", "a8_2", "a10_2", "a12_2", "a14_2", "a16_2", "a18_2", "a20_2", "a1_1", "a2_1", "a3_1",
              "a5_1", "a7_1", "a9_1", "a11_1", "a13_1", "a15_1", "a1_2", "a2_2", "a3_2", "a5_2", "a7_2", "a9_2",
              "a11_2", "a13_2", "a15_2", "form_1", "form_2", "radius_1_x", "radius_2_x", "conic_1_x", "conic_2_x",
              "material_1", "material_2", "material_rim", "points", "scale"),
    .curved = true,
    .check = check,
    .contains = contains,
    .primitive_count = 1,
    .further_rows = 2,
    .more_rows = more_rows,
    .primitives = primitives,
    .details = details,
    .faces = {WORDS("rim", "side 1", "side 2", "ring of side 1", "ring of side 2", "bevel of side 1",
                    "bevel of side 2")},
    .ends = {1, 2},
    .flat = flat,
    .extent = extent,
    .farthest = farthest,
    .thickness = thickness,
    .fit = fit,
    .rings = rings,
    .tessellation = tessellation,
};
