/* Tests of prisms over regular polygons: light through an equilateral one, sizes, and invalid parameters. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "optics/interface.h"
#include "random_stream.h"
#include "ray_fixture.h"

static scene_geometry *arrange(const solid_shape *shape)
{
    const region_source source = {.shape = shape, .medium = 1, .shadow_transmittance = 1.0};
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(&source, 1, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    return a;
}

static double degrees(double radians)
{
    return radians * 180.0 / acos(-1.0);
}

/* The deviation of a ray with that angle of incidence in an equilateral prism of index n; -1 under total internal
 * reflection. Its corner in front is the refracting edge. */
static double deviation(const scene_geometry *a, double n, double incidence)
{
    const double turn = acos(-1.0) / 180.0 * (incidence - 30.0); /* the first side faces 60 degrees from -z to +x */
    const vec3 d = vec3_make(-cos(turn), 0.0, -sin(turn));
    const vec3 aim = vec3_scale(vec3_make(sin(acos(-1.0) / 3.0), 0.0, -cos(acos(-1.0) / 3.0)), 0.5);
    const one_ray r = {vec3_sub(vec3_add(aim, vec3_make(0.0, 1.0, 0.0)), vec3_scale(d, 3.0)), d, FACE_NONE, 0};
    const one_hit in = nearest_interface(a, r);
    assert_int_equal(in.face, 2);
    assert_true(fabs(degrees(acos(in.cos_i)) - incidence) < 1e-9);
    const fresnel f = fresnel_dielectric(in.cos_i, 1.0, n);
    const vec3 within = direction_refract(d, in.normal, in.cos_i, f.eta, f.cos_t);
    const one_hit out = nearest_interface(a, (one_ray){in.point, within, in.face, in.inside_after});
    if (out.face != 4)
        return -1.0;
    const fresnel g = fresnel_dielectric(out.cos_i, n, 1.0);
    if (g.total)
        return -1.0;
    return degrees(acos(vec3_dot(d, direction_refract(within, out.normal, out.cos_i, g.eta, g.cos_t))));
}

/* Born and Wolf, Principles of Optics, 4.7.2: sin((A + D) / 2) = n sin(A / 2) at the minimum, where the ray passes
 * symmetrically and its angle of incidence is (A + D) / 2. */
static void minimum_deviation_of_a_prism_equals_the_formula(void **state)
{
    (void)state;
    const solid_shape s = {.kind = SHAPE_PRISM, .radius = 1.0, .sides = 3, .height = 2.0};
    scene_geometry *a = arrange(&s);
    static const double indices[3] = {1.33, 1.5168, 1.72};
    for (int k = 0; k < 3; k++) {
        const double half = asin(indices[k] * 0.5), least = degrees(2.0 * half) - 60.0;
        assert_true(fabs(deviation(a, indices[k], degrees(half)) - least) < 1e-9);
        for (double off = 0.5; off < 5.0; off += 0.5)
            for (int side = -1; side <= 1; side += 2)
                assert_true(deviation(a, indices[k], degrees(half) + side * off) > least);
    }
    scene_geometry_destroy(a);
}

/* The polygon's area is n/2 r^2 sin(2 pi / n). */
static void the_volume_of_a_prism_equals_that_of_its_polygon(void **state)
{
    (void)state;
    enum { POINTS = 100000 };
    uint64_t seed = 1;
    static const int sides[4] = {3, 4, 7, 60};
    for (int k = 0; k < 4; k++) {
        const solid_shape s = {.kind = SHAPE_PRISM, .radius = 0.9, .sides = sides[k], .height = 0.8};
        scene_geometry *a = arrange(&s);
        int inside = 0;
        for (int i = 0; i < POINTS; i++)
            inside += scene_geometry_inside(a, random_point(&seed, 1.0)) == 1;
        const double area = 0.5 * sides[k] * 0.81 * sin(2.0 * acos(-1.0) / sides[k]), share = 0.8 * area / 8.0;
        assert_true(fabs((double)inside / POINTS - share) < 4.0 * sqrt(share * (1.0 - share) / POINTS));
        scene_geometry_destroy(a);
    }
}

/* For a hexagon: corner to corner along z, side to side along x. */
static void the_central_chords_of_a_hexagonal_prism_equal_its_diameters(void **state)
{
    (void)state;
    const solid_shape s = {.kind = SHAPE_PRISM, .radius = 1.0, .sides = 6, .height = 1.0};
    scene_geometry *a = arrange(&s);
    const vec3 along[3] = {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
    const double lengths[3] = {sqrt(3.0), 2.0, 1.0};
    for (int k = 0; k < 3; k++) {
        const vec3 from = vec3_sub(vec3_make(0.0, 0.5, 0.0), vec3_scale(along[k], 3.0));
        const one_hit in = nearest_interface(a, (one_ray){from, along[k], FACE_NONE, 0});
        const one_hit out = nearest_interface(a, (one_ray){in.point, along[k], in.face, in.inside_after});
        assert_true(fabs(out.t - lengths[k]) < 1e-14);
        assert_true(k < 2 || (in.face == 1 && out.face == 0));
    }
    scene_geometry_destroy(a);
}

/* With four sides, rotated by 45 degrees, it is a box. */
static void a_prism_with_four_sides_equals_a_box(void **state)
{
    (void)state;
    uint64_t seed = 2;
    const double edge = sqrt(2.0);
    const solid_shape prism = {
        .kind = SHAPE_PRISM, .radius = 1.0, .sides = 4, .height = 1.0, .rotation_deg = {0.0, 45.0, 0.0}};
    const solid_shape box = {.kind = SHAPE_BOX, .position = {0.0, 0.5, 0.0}, .size = {edge, 1.0, edge}};
    scene_geometry *a = arrange(&prism), *b = arrange(&box);
    int hits = 0;
    for (int trial = 0; trial < 20000; trial++) {
        const vec3 from = vec3_scale(random_direction(&seed), 4.0);
        const one_ray r = {from, vec3_normalize(vec3_sub(random_point(&seed, 1.0), from)), FACE_NONE, 0};
        const one_hit h = nearest_interface(a, r), k = nearest_interface(b, r);
        assert_int_equal(h.hit_primitive, k.hit_primitive);
        hits += h.hit_primitive >= 0;
        assert_true(h.hit_primitive < 0 || fabs(h.t - k.t) <= (h.error + k.error) / h.cos_i);
    }
    assert_true(hits > 5000);
    scene_geometry_destroy(a), scene_geometry_destroy(b);
}

static void too_few_and_too_many_sides_are_refused(void **state)
{
    (void)state;
    solid_shape s = {.kind = SHAPE_PRISM, .radius = 1.0, .sides = 2, .height = 1.0};
    diagnostic why = {0};
    assert_int_equal(solid_shape_check(&s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.remedy, "3 to 60"));
    s.sides = 61;
    assert_int_equal(solid_shape_check(&s, &why), STATUS_BAD_INPUT);
    s.sides = 60;
    assert_int_equal(solid_shape_check(&s, &why), STATUS_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(minimum_deviation_of_a_prism_equals_the_formula),
        cmocka_unit_test(the_volume_of_a_prism_equals_that_of_its_polygon),
        cmocka_unit_test(the_central_chords_of_a_hexagonal_prism_equal_its_diameters),
        cmocka_unit_test(a_prism_with_four_sides_equals_a_box),
        cmocka_unit_test(too_few_and_too_many_sides_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
