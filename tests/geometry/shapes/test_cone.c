/* Tests of a cone's special cases: its apex, the other nappe of the double cone, and a cylinder as its limit. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "random_stream.h"
#include "ray_fixture.h"
#include "solid_reference.h"

static solid_shape cone_of(double radius, double top_radius, double height)
{
    return (solid_shape){.kind = SHAPE_CONE, .radius = radius, .top_radius = top_radius, .height = height};
}

static one_ray random_ray(uint64_t *seed, double reach)
{
    const vec3 from = vec3_scale(random_direction(seed), 4.0 * reach), to = random_point(seed, reach);
    return (one_ray){from, vec3_normalize(vec3_sub(to, from)), FACE_NONE, 0};
}

static void a_cone_with_equal_radii_is_a_cylinder(void **state)
{
    (void)state;
    uint64_t seed = 1;
    int hits = 0;
    for (int trial = 0; trial < 20000; trial++) {
        solid_shape cone = cone_of(0.8, 0.8, 1.3);
        cone.rotation_deg = trial % 2 ? vec3_make(17.0, -33.0, 71.0) : vec3_make(0.0, 0.0, 0.0);
        solid_shape cylinder = cone;
        cylinder.kind = SHAPE_CYLINDER, cylinder.m = 1.0;
        scene_geometry *a = scene_geometry_of(&cone, 1), *b = scene_geometry_of(&cylinder, 1);
        one_ray r = random_ray(&seed, 1.3);
        if (trial % 16 == 0) /* along the axis */
            r = (one_ray){vec3_make(0.3, -2.0, 0.2), vec3_make(0.0, 1.0, 0.0), FACE_NONE, 0};
        const one_hit h = nearest_interface(a, r), k = nearest_interface(b, r);
        assert_int_equal(h.hit_primitive, k.hit_primitive);
        if (h.hit_primitive >= 0) {
            hits++;
            assert_int_equal(h.face, k.face);
            assert_true(fabs(h.t - k.t) <= (h.error + k.error) / h.cos_i);
            assert_true(vec3_length(vec3_sub(h.normal, k.normal)) <= 4e-14);
        }
        scene_geometry_destroy(a), scene_geometry_destroy(b);
    }
    assert_true(hits > 5000);
}

/* pi h (R^2 + R r + r^2) / 3 */
static void the_volume_is_that_of_a_frustum(void **state)
{
    (void)state;
    enum { POINTS = 200000 };
    uint64_t seed = 2;
    const double tops[3] = {0.0, 0.4, 1.1};
    for (int k = 0; k < 3; k++) {
        solid_shape s = cone_of(0.9, tops[k], 1.6);
        s.rotation_deg = vec3_make(20.0, 40.0, 60.0);
        scene_geometry *a = scene_geometry_of(&s, 1);
        int inside = 0;
        for (int i = 0; i < POINTS; i++)
            inside += scene_geometry_inside(a, random_point(&seed, 2.0)) == 1;
        const double r = s.top_radius, volume = acos(-1.0) * 1.6 * (0.81 + 0.9 * r + r * r) / 3.0,
                     share = volume / 64.0;
        assert_true(fabs((double)inside / POINTS - share) < 4.0 * sqrt(share * (1.0 - share) / POINTS));
        scene_geometry_destroy(a);
    }
}

/* Through the middle of the axis, a horizontal chord has the mean of both diameters as its length; along the axis, the
 * height. */
static void chords_through_the_middle_have_their_closed_form(void **state)
{
    (void)state;
    const solid_shape s = cone_of(1.0, 0.5, 2.0);
    scene_geometry *a = scene_geometry_of(&s, 1);
    const one_hit in = nearest_interface(a, (one_ray){{-3.0, 1.0, 0.0}, {1.0, 0.0, 0.0}, FACE_NONE, 0});
    const one_hit out = nearest_interface(a, (one_ray){in.point, {1.0, 0.0, 0.0}, in.face, in.inside_after});
    assert_true(fabs(out.t - 1.5) < 1e-15 && in.face == 0 && out.face == 0);
    const double slope = -0.25, slant = sqrt(1.0 + slope * slope);
    assert_true(fabs(in.normal.x + 1.0 / slant) < 1e-15 && fabs(in.normal.y + slope / slant) < 1e-15);
    const one_hit up = nearest_interface(a, (one_ray){{0.2, -1.0, 0.0}, {0.0, 1.0, 0.0}, FACE_NONE, 0});
    const one_hit top = nearest_interface(a, (one_ray){up.point, {0.0, 1.0, 0.0}, up.face, up.inside_after});
    assert_true(up.face == 1 && top.face == 2 && top.t == 2.0);
    scene_geometry_destroy(a);
}

/* Onto the side of a frustum a million times as wide as high, from a distance of 1. */
static void a_thin_frustum_is_hit_where_it_is(void **state)
{
    (void)state;
    const double height = 0x1p-20;
    const solid_shape s = cone_of(1.0, 0.5, height);
    scene_geometry *a = scene_geometry_of(&s, 1);
    for (int k = 1; k < 8; k++) {
        const double y = 0.125 * k * height, x = 1.0 - 0.0625 * k;
        const one_hit h = nearest_interface(a, (one_ray){{x + 0.6, y + 0.8, 0.0}, {-0.6, -0.8, 0.0}, FACE_NONE, 0});
        const one_hit g = nearest_interface(a, (one_ray){{0.0, y + 0.8, x - 0.6}, {0.0, -0.8, 0.6}, FACE_NONE, 0});
        assert_true(h.face == 0 && fabs(h.t - 1.0) < 1e-15);
        assert_true(g.face == 0 && fabs(g.t - 1.0) < 1e-15);
    }
    scene_geometry_destroy(a);
}

/* Rays at the apex and near it: a hit has a normal and no number is NaN; above the apex there is no hit. */
static void the_apex_is_hit_and_the_other_nappe_is_not(void **state)
{
    (void)state;
    uint64_t seed = 3;
    const solid_shape s = cone_of(0.7, 0.0, 1.1);
    scene_geometry *a = scene_geometry_of(&s, 1);
    const vec3 tip = vec3_make(0.0, 1.1, 0.0);
    const one_hit down = nearest_interface(a, (one_ray){{0.0, 3.0, 0.0}, {0.0, -1.0, 0.0}, FACE_NONE, 0});
    assert_true(down.hit_primitive == 0 && fabs(down.t - 1.9) < 1e-14 && down.normal.y == 1.0 && down.cos_i == 1.0);
    for (int trial = 0; trial < 40000; trial++) {
        const vec3 d = random_direction(&seed);
        const vec3 aim = vec3_add(tip, vec3_scale(random_direction(&seed), exp(random_real(&seed, -40.0, 0.0))));
        const one_ray r = {vec3_sub(aim, vec3_scale(d, 3.0)), d, FACE_NONE,
                           scene_geometry_inside(a, vec3_sub(aim, vec3_scale(d, 3.0)))};
        const one_hit h = nearest_interface(a, r);
        if (h.hit_primitive < 0)
            continue;
        assert_true(isfinite(h.t) && fabs(vec3_length(h.normal) - 1.0) < 1e-15 && h.cos_i > 0.0 && h.cos_i <= 1.0);
        assert_true(quad_abs(reference_distance(&s, quad3_from(h.point))) <= h.error);
        assert_true(h.point.y <= 1.1 + h.error);
        const one_hit next = nearest_interface(a, (one_ray){h.point, d, h.face, h.inside_after});
        assert_true(next.hit_primitive < 0 || (isfinite(next.t) && next.t >= 0.0));
    }
    for (int trial = 0; trial < 20000; trial++) { /* within the other nappe, downwards to above the apex */
        const double high = random_real(&seed, 1e-9, 2.0);
        const vec3 at = vec3_add(tip, vec3_make(0.3 * high * cos(trial), high, 0.3 * high * sin(trial)));
        const vec3 side = random_direction(&seed);
        const one_ray r = {at, vec3_normalize(vec3_make(side.x, fabs(side.y), side.z)), FACE_NONE, 0};
        assert_int_equal(nearest_interface(a, r).hit_primitive, -1);
        assert_int_equal(scene_geometry_inside(a, at), 0);
    }
    scene_geometry_destroy(a);
}

/* A liquid that widens upwards overlaps the wall of a glass, which has the higher priority, only where it is wide
 * enough; below that there is air between them. */
static void a_conical_liquid_overlaps_the_wall_only_where_it_is_wide_enough(void **state)
{
    (void)state;
    const solid_shape shapes[2] = {
        {.kind = SHAPE_CUP, .m = 1.0, .radius = 1.0, .inner_radius = 0.9, .height = 3.0, .floor = 0.1},
        {.kind = SHAPE_CONE, .position = {0.0, 0.05, 0.0}, .radius = 0.85, .top_radius = 0.95, .height = 2.0}};
    scene_geometry *a = scene_geometry_of(shapes, 2);
    static const int high[4] = {0, 1, 0, -1}, low[6] = {0, -1, 1, -1, 0, -1};
    for (int k = 0; k < 2; k++) {
        one_ray r = {{-3.0, k ? 0.5 : 1.8, 0.0}, {1.0, 0.0, 0.0}, FACE_NONE, 0};
        const int *expected = k ? low : high;
        int n = 0;
        for (one_hit h = nearest_interface(a, r); h.hit_primitive >= 0; h = nearest_interface(a, r)) {
            assert_true(n < (k ? 6 : 4));
            assert_int_equal(a->regions[h.after].solid, expected[n++]);
            r = (one_ray){h.point, r.d, h.face, h.inside_after};
        }
        assert_int_equal(n, k ? 6 : 4);
    }
    scene_geometry_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cone_with_equal_radii_is_a_cylinder),
        cmocka_unit_test(the_volume_is_that_of_a_frustum),
        cmocka_unit_test(chords_through_the_middle_have_their_closed_form),
        cmocka_unit_test(a_thin_frustum_is_hit_where_it_is),
        cmocka_unit_test(the_apex_is_hit_and_the_other_nappe_is_not),
        cmocka_unit_test(a_conical_liquid_overlaps_the_wall_only_where_it_is_wide_enough),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
