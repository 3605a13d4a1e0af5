/* Tests of lenses as solids: chords of random lenses against quadruple precision, volumes, bounds, and bad numbers. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "geometry/primitives/primitive.h"
#include "geometry/shapes/shape.h"
#include "random_stream.h"
#include "ray_fixture.h"
#include "room_fixture.h"
#include "solid_reference.h"
#include "whole.h"

static solid_shape lens_of(double radius_1, double radius_2, double thickness, double diameter)
{
    return (solid_shape){
        .kind = SHAPE_LENS, .radius_1 = radius_1, .radius_2 = radius_2, .thickness = thickness, .diameter = diameter};
}

/* All crossings of a ray, each from the last one's point. */
static int walk(const scene_geometry *a, one_ray r, one_hit *hits, int most)
{
    int n = 0;
    for (one_hit h = nearest_interface(a, r); h.hit_primitive >= 0; h = nearest_interface(a, r)) {
        assert_true(n < most);
        hits[n++] = h;
        r = (one_ray){h.point, r.d, h.face, h.inside_after};
    }
    return n;
}

/* Along the axis and across it, the lengths are those of the prescription. */
static void a_line_through_a_biconcave_lens_has_six_crossings(void **state)
{
    (void)state;
    const solid_shape s = lens_of(-1.0, 1.0, 0.0625, 1.2); /* sag at the rim: 1 - sqrt(1 - 0.36) = 0.2 */
    scene_geometry *a = scene_geometry_of(&s, 1);
    one_hit hits[8];
    const one_ray along = {{0.0, -2.0, 0.0}, {0.0, 1.0, 0.0}, FACE_NONE, 0};
    assert_int_equal(walk(a, along, hits, 8), 2);
    assert_true(hits[0].t == 2.0 && hits[1].t == 0.0625);
    assert_true(hits[0].normal.y == -1.0 && hits[1].normal.y == -1.0);
    const double slope = 0.3; /* out of the rim below, through both hollows, out of it above */
    const one_ray across = {
        {-2.0, 0.03125 - 2.0 * slope, 0.0}, vec3_normalize(vec3_make(1.0, slope, 0.0)), FACE_NONE, 0};
    assert_int_equal(walk(a, across, hits, 8), 6);
    for (int k = 0; k < 6; k++) {
        static const int faces[6] = {0, 1, 1, 2, 2, 0};
        assert_int_equal(hits[k].face, faces[k]);
        assert_int_equal(hits[k].after, 1 - k % 2);
    }
    scene_geometry_destroy(a);
}

static solid_shape placed_lens(uint64_t *seed)
{
    solid_shape s = {.kind = SHAPE_LENS};
    random_lens(&s, seed);
    const double size = exp(random_real(seed, -3.0, 3.0));
    s.radius_1 *= size, s.radius_2 *= size, s.thickness *= size, s.diameter *= size;
    s.position = random_point(seed, random_below(seed, 4) ? 1.0 : 1000.0);
    if (random_below(seed, 2))
        s.rotation_deg = random_point(seed, 180.0);
    return s;
}

/* Every crossing of a random line, from hit to hit (including starts on the surface), against quadruple precision, and
 * its point's distance from the surface in units of its bound. */
static void crossings_of_random_lines_agree_with_quadruple_precision(void **state)
{
    (void)state;
    const int rays = is_whole() ? 60000 : 12000;
    uint64_t seed = 1;
    double worst = 0.0, worst_along = 0.0;
    long crossings = 0, with_four = 0, with_six = 0, unlike = 0;
    for (int ray = 0; ray < rays; ray++) {
        solid_shape s = placed_lens(&seed);
        const bool thin = ray % 4 == 0 && s.radius_1 < 0.0 && s.radius_2 > 0.0;
        if (thin)
            s.thickness = 0.01 * s.diameter;
        assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
        scene_geometry *a = scene_geometry_of(&s, 1);
        const double size = s.diameter, off = exp(random_real(&seed, 1.0, random_below(&seed, 8) ? 1.5 : 9.0));
        const vec3 from = vec3_add(s.position, vec3_scale(random_direction(&seed), size * off));
        const vec3 to = vec3_add(s.position, vec3_scale(random_direction(&seed), size * random_real(&seed, 0.0, 0.7)));
        vec3 d = vec3_sub(to, from);
        if (thin) /* near its middle, at a low angle: through both hollows */
            d = mat3_apply(rotation_from_deg(s.rotation_deg),
                           vec3_make(0.02 * d.x, random_real(&seed, 0.1, 0.5) * size, size));
        const one_ray r = {thin ? vec3_sub(s.position, vec3_scale(d, 3.0)) : from, vec3_normalize(d), FACE_NONE, 0};
        const reference_line line = {quad3_from(r.o), quad3_from(r.d)};
        quad t[REFERENCE_CROSSINGS_MAX], passed = 0;
        one_hit hits[8];
        const int events = reference_events(&s, &line, 0, t), n = walk(a, r, hits, 8);
        bool grazes = false; /* its crossings may differ in double precision */
        for (int k = 0; k + 1 < events; k++)
            grazes |= t[k + 1] - t[k] < (quad)1e-5 * size;
        unlike += n != events;
        assert_true(n == events || grazes);
        for (int k = 0; k < n; k++) {
            const quad away = quad_abs(reference_distance(&s, quad3_from(hits[k].point)));
            worst = fmax(worst, (double)(away / hits[k].error));
            passed += hits[k].t;
            if (n == events && hits[k].cos_i > 0.01) {
                const double bound = (k + 1) * hits[k].error / hits[k].cos_i + hits[0].error / hits[0].cos_i;
                worst_along = fmax(worst_along, (double)(quad_abs(passed - t[k]) / bound));
            }
        }
        crossings += n;
        with_four += n == 4;
        with_six += n == 6;
        scene_geometry_destroy(a);
    }
    print_message(
        "%d rays, %ld crossings, %ld rays with four, %ld with six, %ld grazing ones that differ; errors are at "
        "most %.3f of the bound for points, %.3f for distances\n",
        rays, crossings, with_four, with_six, unlike, worst, worst_along);
    assert_true(worst <= 1.0 && worst_along <= 1.0);
    assert_true(with_six > rays / 6000 && with_four > rays / 500 && crossings > rays / 2);
}

/* Rays that start inside, or reflect within a lens, stay on its surface and alternate between inside and outside. */
static void reflected_rays_stay_within_a_lens(void **state)
{
    (void)state;
    uint64_t seed = 2;
    long bounces = 0;
    for (int trial = 0; trial < 400; trial++) {
        solid_shape s = {.kind = SHAPE_LENS};
        random_lens(&s, &seed);
        s.rotation_deg = random_point(&seed, 180.0);
        scene_geometry *a = scene_geometry_of(&s, 1);
        const mat3 turn = rotation_from_deg(s.rotation_deg);
        one_ray r = {mat3_apply(turn, vec3_make(0.0, 0.5 * s.thickness, 0.0)), random_direction(&seed), FACE_NONE, 1};
        for (int k = 0; k < 200; k++) {
            const one_hit h = nearest_interface(a, r);
            assert_int_equal(h.hit_primitive, 0);
            assert_true(quad_abs(reference_distance(&s, quad3_from(h.point))) <= h.error);
            const vec3 d = vec3_sub(r.d, vec3_scale(h.normal, 2.0 * vec3_dot(r.d, h.normal)));
            r = (one_ray){h.point, vec3_normalize(d), h.face, 1};
            bounces++;
        }
        scene_geometry_destroy(a);
    }
    assert_int_equal(bounces, 80000);
}

/* A cap of a sphere has the volume pi s^2 (3 R - s) / 3 with the sag s; a convex side adds it to the rim's cylinder, a
 * concave one removes it. */
static void volumes_equal_those_of_spherical_caps(void **state)
{
    (void)state;
    const int points = trials_of(200000);
    static const double radii[][2] = {{1.0, -1.5}, {-1.0, 1.5}, {1.0, 1.5}, {0.0, -0.9}, {0.5, -0.5}};
    uint64_t seed = 3;
    for (size_t i = 0; i < sizeof radii / sizeof *radii; i++) {
        const double h = 0.45, pi = acos(-1.0);
        solid_shape s = lens_of(radii[i][0], radii[i][1], 1.1, 2.0 * h);
        double volume = pi * h * h * 1.1;
        for (int k = 0; k < 2; k++) {
            const double r = fabs(radii[i][k]), sag = r - sqrt(r * r - h * h),
                         cap = pi * sag * sag * (3.0 * r - sag) / 3.0;
            const bool convex = (radii[i][k] > 0.0) == (k == 0);
            /* measured between the vertices: a convex side lacks its corner, a concave one has it */
            if (r > 0.0)
                volume += (convex ? -1.0 : 1.0) * (pi * h * h * sag - cap);
        }
        s.position = vec3_make(0.1, -0.2, 0.3);
        s.rotation_deg = vec3_make(20.0, 40.0, 60.0);
        scene_geometry *a = scene_geometry_of(&s, 1);
        const bounds3 box = shape_world_box(&s);
        const vec3 size = vec3_sub(box.high, box.low);
        int inside = 0;
        for (int k = 0; k < points; k++) {
            const vec3 p = {box.low.x + size.x * random_real(&seed, 0.0, 1.0),
                            box.low.y + size.y * random_real(&seed, 0.0, 1.0),
                            box.low.z + size.z * random_real(&seed, 0.0, 1.0)};
            const bool in = scene_geometry_inside(a, p) == 1;
            assert_int_equal(in, solid_shape_contains(&s, p));
            if (quad_abs(reference_distance(&s, quad3_from(p))) > (quad)1e-12)
                assert_int_equal(in, reference_contains(&s, quad3_from(p)));
            inside += in;
        }
        const double share = volume / (size.x * size.y * size.z);
        if (!(fabs((double)inside / points - share) < 4.0 * sqrt(share * (1.0 - share) / points)))
            fail_msg("lens %zu: %.6g of the box instead of %.6g", i, (double)inside / points, share);
        scene_geometry_destroy(a);
    }
}

/* The box in the world is the smallest one: the farthest points of random lenses, of a dense set of their points. */
static void bounds_are_tight(void **state)
{
    (void)state;
    uint64_t seed = 4;
    for (int trial = 0; trial < 200; trial++) {
        solid_shape s = {.kind = SHAPE_LENS};
        random_lens(&s, &seed);
        const vec3 d = random_direction(&seed);
        const double across = hypot(d.x, d.z);
        double most = -HUGE_VAL;
        for (int i = 0; i <= 4000; i++) {
            const double rho = 0.5 * s.diameter * i / 4000;
            for (int k = 0; k < 2; k++) {
                const double r = k ? s.radius_2 : s.radius_1, stretch = 1.0 + (k ? s.conic_2 : s.conic_1);
                const double c = r == 0.0 ? 0.0 : 1.0 / r,
                             y = k * s.thickness + c * rho * rho / (1.0 + sqrt(1.0 - stretch * c * c * rho * rho));
                most = fmax(most, across * rho + d.y * y);
            }
        }
        const double farthest = shape_of(&s)->farthest(&s, d);
        assert_true(farthest >= most - 1e-12 && farthest <= most + 1e-5 * s.diameter);
    }
}

/* A cemented doublet: two lenses with one common side, up to rounding. Its crossings with a ray are one, without a
 * film of the surrounding medium. */
static void cemented_lenses_have_no_film_between_them(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int trial = 0; trial < 4000; trial++) {
        solid_shape pair[2] = {lens_of(1.2, -0.9, 0.4, 1.0),
                               lens_of(-0.9, random_below(&seed, 2) ? 3.0 : -3.0, 0.2, 1.0)};
        const vec3 rotation = random_below(&seed, 4) ? random_point(&seed, 180.0) : vec3_make(0.0, 0.0, 0.0);
        const mat3 turn = rotation_from_deg(rotation);
        pair[0].rotation_deg = pair[1].rotation_deg = rotation;
        pair[0].position = random_point(&seed, 2.0);
        pair[1].position = vec3_add(pair[0].position, mat3_apply(turn, vec3_make(0.0, pair[0].thickness, 0.0)));
        scene_geometry *a = scene_geometry_of(pair, 2); /* priority indices 2 and 1 */
        const vec3 from = vec3_make(random_real(&seed, -0.3, 0.3), -2.0, random_real(&seed, -0.3, 0.3)),
                   to = vec3_make(random_real(&seed, -0.3, 0.3), 0.4, random_real(&seed, -0.3, 0.3));
        const vec3 d = mat3_apply(turn, vec3_normalize(vec3_sub(to, from)));
        one_hit hits[8];
        const bool back = random_below(&seed, 2);
        const vec3 o = vec3_add(pair[0].position, mat3_apply(turn, from)),
                   start = back ? vec3_add(o, vec3_scale(d, 6.0)) : o;
        assert_int_equal(walk(a, (one_ray){start, back ? vec3_scale(d, -1.0) : d, FACE_NONE, 0}, hits, 8), 3);
        static const int media[4] = {0, 2, 1, 0};
        for (int k = 0; k < 3; k++) {
            assert_int_equal(hits[k].before, media[back ? 3 - k : k]);
            assert_int_equal(hits[k].after, media[back ? 2 - k : k + 1]);
        }
        scene_geometry_destroy(a);
    }
}

static void expect_refused(solid_shape s, const char *what, const char *remedy)
{
    diagnostic why = {.what = ""};
    assert_int_equal(solid_shape_check(&s, &why), STATUS_BAD_INPUT);
    if (!strstr(why.what, what) || !strstr(why.remedy, remedy))
        fail_msg("'%s; %s' does not contain '%s' and '%s'", why.what, why.remedy, what, remedy);
}

static void impossible_lenses_are_refused(void **state)
{
    (void)state;
    expect_refused(lens_of(1.0, -1.0, 0.5, 2.1), "diameter 2.1 is larger than side 1", "at most 2, or a radius_1");
    expect_refused(lens_of(2.0, -1.0, 0.5, 2.1), "larger than side 2", "at most 2, or a radius_2 of at least 1.05");
    expect_refused(lens_of(1.0, -1.0, 0.39, 1.2), "cross within the rim, at 0.6", "a thickness of at least 0.4,");
    expect_refused(lens_of(2.0, 1.0, 0.0, 1.0), "thickness is 0", "above 0");
    expect_refused(lens_of(1.0, -1.0, 0.5, -1.0), "diameter is -1", "above 0");
    expect_refused(lens_of(HUGE_VAL, -1.0, 0.5, 1.0), "not finite", "0 is a flat side");
    solid_shape oblate = lens_of(1.0, 0.0, 1.0, 1.5);
    oblate.conic_1 = 3.0; /* half width 1 / sqrt(1 + 3) */
    expect_refused(oblate, "diameter 1.5 is larger than side 1, which ends at a diameter of 1", "at most 1,");
    solid_shape sharp = lens_of(1.0, -1.0, 2.0 * (1.0 - sqrt(1.0 - 0.36)), 1.2);
    assert_int_equal(solid_shape_check(&sharp, NULL), STATUS_OK);
    sharp.thickness -= 1e-9;
    assert_int_equal(solid_shape_check(&sharp, NULL), STATUS_BAD_INPUT);
}

/* Two sides of unlike curvature and conic that cross between the axis and the rim, and are apart at both. */
static void sides_that_cross_between_axis_and_rim_are_refused(void **state)
{
    (void)state;
    solid_shape s = lens_of(1.0, 1.2, 0.01, 1.8);
    s.conic_1 = -0.5; /* steeper near the axis, flatter at the rim */
    s.conic_2 = 0.7;
    const double rim2 = 0.81, sag_1 = rim2 / (1.0 + sqrt(1.0 - 0.5 * rim2)),
                 sag_2 = rim2 / 1.2 / (1.0 + sqrt(1.0 - 1.7 * rim2 / 1.44));
    assert_true(s.thickness + sag_2 - sag_1 > 0.0); /* apart at the rim */
    expect_refused(s, "cross within the rim", "a thickness of at least");
    double most = 0.0; /* of the distance by which the first side is ahead */
    for (int i = 0; i <= 10000; i++) {
        const double rho2 = rim2 * i / 10000.0;
        most = fmax(most, rho2 / (1.0 + sqrt(1.0 - 0.5 * rho2)) - rho2 / 1.2 / (1.0 + sqrt(1.0 - 1.7 * rho2 / 1.44)));
    }
    s.thickness = most * (1.0 - 1e-5);
    assert_int_equal(solid_shape_check(&s, NULL), STATUS_BAD_INPUT);
    s.thickness = most * (1.0 + 1e-5);
    assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
}

/* The face is that which a ray hits there. */
static void a_flat_side_is_the_plane_through_its_vertex(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        const solid_shape s = k ? lens_of(2.0, 0.0, 0.5, 1.0) : lens_of(0.0, -2.0, 0.5, 1.0);
        const double out = k ? 1.0 : -1.0;
        scene_geometry *a = scene_geometry_of(&s, 1);
        const one_hit h = nearest_interface(a, (one_ray){{0.1, 3.0 * out, 0.2}, {0.0, -out, 0.0}, FACE_NONE, 0});
        flat_face flat[FLATS_MAX];
        assert_int_equal(primitive_flats(&a->primitives[0], flat), 1);
        assert_int_equal(a->primitives[0].first_face + flat[0].face, h.face);
        assert_true(flat[0].axis == 1 && flat[0].at == h.point.y && flat[0].outwards == h.normal.y);
        assert_true(h.point.y == 0.5 * k && h.normal.y == out);
        scene_geometry_destroy(a);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_through_a_biconcave_lens_has_six_crossings),
        cmocka_unit_test(crossings_of_random_lines_agree_with_quadruple_precision),
        cmocka_unit_test(reflected_rays_stay_within_a_lens),
        cmocka_unit_test(volumes_equal_those_of_spherical_caps),
        cmocka_unit_test(bounds_are_tight),
        cmocka_unit_test(cemented_lenses_have_no_film_between_them),
        cmocka_unit_test(impossible_lenses_are_refused),
        cmocka_unit_test(sides_that_cross_between_axis_and_rim_are_refused),
        cmocka_unit_test(a_flat_side_is_the_plane_through_its_vertex),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
