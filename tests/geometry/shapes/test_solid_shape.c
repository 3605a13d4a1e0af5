/* Tests of the solids by their definitions, and of the rotation that places them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "geometry/solid.h"
#include <string.h>

static solid_shape make(shape_kind kind)
{
    solid_shape s = {.kind = kind, .radius = 1, .height = 3, .m = 1, .inner_radius = 0.9, .floor = 0.1};
    s.size = vec3_make(1, 2, 4);
    return s;
}

static bool contains(const solid_shape *s, double x, double y, double z)
{
    return solid_shape_contains(s, vec3_make(x, y, z));
}

static void a_plane_is_the_half_space_below(void **state)
{
    (void)state;
    solid_shape s = make(SHAPE_PLANE);
    s.position.y = 2;
    assert_true(contains(&s, 1e6, 2, -1e6));
    assert_true(contains(&s, 0, -1e6, 0));
    assert_false(contains(&s, 0, nextafter(2, 3), 0));
    s.rotation_deg.z = 90; /* its upward normal is rotated to -x */
    assert_true(contains(&s, 0.5, 99, 0));
    assert_false(contains(&s, -0.5, -99, 0));
}

static void spheres_and_boxes_contain_their_surfaces(void **state)
{
    (void)state;
    solid_shape s = make(SHAPE_SPHERE), b = make(SHAPE_BOX);
    assert_true(contains(&s, 1, 0, 0));
    assert_true(contains(&s, 0.6, 0, -0.8) || contains(&s, 0.6, 0, nextafter(-0.8, 0)));
    assert_false(contains(&s, 0.71, 0.71, 0));
    assert_true(contains(&b, 0.5, -1, 2));
    assert_false(contains(&b, nextafter(0.5, 1), 0, 0));
    assert_false(contains(&b, 0, 1.001, 0));
    assert_false(contains(&b, 0, 0, -2.001));
}

static void a_cylinder_is_elliptic_with_its_origin_at_the_base(void **state)
{
    (void)state;
    solid_shape s = make(SHAPE_CYLINDER);
    assert_true(contains(&s, 1, 0, 0));
    assert_true(contains(&s, 0, 3, -1));
    assert_false(contains(&s, 0, -1e-9, 0));
    assert_false(contains(&s, 0, 3.0000001, 0));
    s.m = 2; /* half as deep along z */
    assert_true(contains(&s, 1, 1, 0));
    assert_true(contains(&s, 0, 1, 0.5));
    assert_false(contains(&s, 0, 1, 0.51));
}

static void a_cup_contains_its_wall_and_floor(void **state)
{
    (void)state;
    solid_shape s = make(SHAPE_CUP);
    assert_true(contains(&s, 0.95, 2, 0));
    assert_true(contains(&s, 0, 0.05, 0));
    assert_true(contains(&s, 0, 0.1, 0));  /* the floor's surface */
    assert_true(contains(&s, 0.9, 2, 0));  /* the wall's inner surface */
    assert_true(contains(&s, 0, 3, 0.95)); /* the rim */
    assert_false(contains(&s, 0, 0.11, 0));
    assert_false(contains(&s, 0, 3, 0)); /* open at the top */
    assert_false(contains(&s, 0.95, 3.01, 0));
    assert_false(contains(&s, 1.01, 1, 0));
}

/* Similar ellipses: along z everything is scaled by 1 / m, including its wall. */
static void an_elliptic_cup_is_narrower_along_z(void **state)
{
    (void)state;
    solid_shape s = make(SHAPE_CUP);
    s.m = 2;
    assert_true(contains(&s, 0.95, 2, 0));
    assert_false(contains(&s, 0.89, 2, 0));
    assert_true(contains(&s, 0, 2, 0.5));
    assert_true(contains(&s, 0, 2, 0.45)); /* the hollow's surface: 0.9 / 2 */
    assert_false(contains(&s, 0, 2, 0.449));
    assert_false(contains(&s, 0, 2, 0.501));
    assert_true(contains(&s, 0, 0.05, 0));
}

static void assert_near(vec3 a, vec3 b)
{
    assert_true(vec3_length(vec3_sub(a, b)) < 2e-15);
}

static void rotations_take_x_to_y_to_z_to_x(void **state)
{
    (void)state;
    vec3 x = vec3_make(1, 0, 0), y = vec3_make(0, 1, 0), z = vec3_make(0, 0, 1);
    assert_near(mat3_apply(rotation_from_deg(vec3_make(90, 0, 0)), y), z);
    assert_near(mat3_apply(rotation_from_deg(vec3_make(0, 90, 0)), z), x);
    assert_near(mat3_apply(rotation_from_deg(vec3_make(0, 0, 90)), x), y);
    /* x first: y -> z -> x -> y */
    assert_near(mat3_apply(rotation_from_deg(vec3_make(90, 90, 90)), y), y);
    assert_near(mat3_apply(rotation_from_deg(vec3_make(90, 90, 0)), y), x);
    mat3 none = rotation_from_deg(vec3_make(0, -360, 720));
    assert_near(none.row[0], x);
    assert_near(none.row[1], y);
    assert_near(none.row[2], z);
}

static void a_rotation_is_the_product_of_its_axis_rotations(void **state)
{
    (void)state;
    for (int i = 0; i < 100; i++) {
        double a = i * 37.3 - 900, b = i * 11.7 - 300, c = 50 - i * 61.1;
        mat3 all = rotation_from_deg(vec3_make(a, b, c)), rx = rotation_from_deg(vec3_make(a, 0, 0)),
             ry = rotation_from_deg(vec3_make(0, b, 0)), rz = rotation_from_deg(vec3_make(0, 0, c));
        vec3 v = vec3_make(0.3, -0.5, 0.7), w = mat3_apply(rz, mat3_apply(ry, mat3_apply(rx, v)));
        assert_near(mat3_apply(all, v), w);
        assert_near(mat3_apply_transposed(all, mat3_apply(all, v)), v);
    }
}

static void a_rotated_rod_leans(void **state)
{
    (void)state;
    solid_shape s = make(SHAPE_BOX);
    s.size = vec3_make(0.25, 3, 0.25);
    s.rotation_deg.z = 30; /* its top moves to -x */
    assert_true(contains(&s, -0.7, 1.2, 0));
    assert_false(contains(&s, 0.7, 1.2, 0));
    assert_true(contains(&s, 0.7, -1.2, 0));
}

static void expect_wrong(solid_shape s, const char *word)
{
    diagnostic why = {.what = ""};
    assert_int_equal(solid_shape_check(&s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, word));
    assert_int_equal(solid_shape_check(&s, NULL), STATUS_BAD_INPUT);
}

static void invalid_solids_are_refused(void **state)
{
    (void)state;
    for (int k = 0; k < SHAPE_MESH; k++) {
        solid_shape s = make((shape_kind)k);
        assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
        s.position.z = (double)NAN;
        expect_wrong(s, "position");
    }
    solid_shape s = make(SHAPE_CUP);
    s.inner_radius = 1;
    expect_wrong(s, "inner_radius");
    s = make(SHAPE_CUP);
    s.floor = 3;
    expect_wrong(s, "floor");
    s = make(SHAPE_CUP);
    s.floor = -0.1; /* 0 is a tube */
    expect_wrong(s, "floor");
    s = make(SHAPE_SPHERE);
    s.radius = (double)NAN;
    expect_wrong(s, "radius");
    s.radius = 1, s.height = -1; /* a sphere has none */
    assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
    s = make(SHAPE_CYLINDER);
    s.m = 0;
    expect_wrong(s, "m");
    s = make(SHAPE_CUP);
    s.m = 0;
    expect_wrong(s, "m");
    s = make(SHAPE_CYLINDER);
    s.height = (double)INFINITY;
    expect_wrong(s, "height");
    s = make(SHAPE_BOX);
    s.size.y = -1;
    expect_wrong(s, "size.y");
    s.kind = SHAPE_COUNT;
    expect_wrong(s, "shape");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plane_is_the_half_space_below),
        cmocka_unit_test(spheres_and_boxes_contain_their_surfaces),
        cmocka_unit_test(a_cylinder_is_elliptic_with_its_origin_at_the_base),
        cmocka_unit_test(a_cup_contains_its_wall_and_floor),
        cmocka_unit_test(an_elliptic_cup_is_narrower_along_z),
        cmocka_unit_test(rotations_take_x_to_y_to_z_to_x),
        cmocka_unit_test(a_rotation_is_the_product_of_its_axis_rotations),
        cmocka_unit_test(a_rotated_rod_leans),
        cmocka_unit_test(invalid_solids_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
