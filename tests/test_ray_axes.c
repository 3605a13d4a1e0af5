/* Tests of where the rays of fans and beams start: an orthonormal frame, whose sign is the documented one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "random_stream.h"
#include "render/plan/ray_axes.h"
#include <string.h>

static void assert_vec(vec3 a, double x, double y, double z)
{
    assert_true(fabs(a.x - x) < 1e-14 && fabs(a.y - y) < 1e-14 && fabs(a.z - z) < 1e-14);
}

static ray_axes axes_of(vec3 axis, const vec3 *normal)
{
    ray_axes a;
    diagnostic why = {.what = ""};
    assert_int_equal(ray_axes_set(&a, vec3_make(1, 2, 3), axis, normal, &why), STATUS_OK);
    return a;
}

/* Seen from above, with x to the right and z ahead, the first ray of a horizontal fan is on the right of its axis. */
static void a_horizontal_plane_has_its_left_on_the_left(void **state)
{
    (void)state;
    const vec3 up = {0, 1, 0}, down = {0, -7, 0};
    const double r = sqrt(0.5);
    assert_vec(axes_of(vec3_make(2, 0, 0), &up).across, 0, 0, 1);
    assert_vec(axes_of(vec3_make(0, 0, 3), &up).across, -1, 0, 0);
    assert_vec(axes_of(vec3_make(-1, 0, 0), &down).across, 0, 0, -1);
    assert_vec(axes_of(vec3_make(0, 0, -1), &down).across, 1, 0, 0);
    assert_vec(axes_of(vec3_make(1, 0, 1), NULL).across, -r, 0, r);
    assert_vec(axes_of(vec3_make(1, 0, -3), &down).across, 3 / sqrt(10), 0, 1 / sqrt(10));
}

static void any_other_plane_has_its_upper_side_up(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int i = 0; i < 1000; i++) {
        const vec3 axis = random_point(&seed, 4.0), normal = random_direction(&seed);
        const ray_axes a = axes_of(axis, i % 2 ? &normal : NULL);
        assert_true(a.across.y > 0.0);
        assert_true(fabs(vec3_dot(a.across, a.axis)) < 1e-14 && fabs(vec3_dot(a.across, a.normal)) < 1e-14);
        assert_true(fabs(vec3_dot(a.normal, a.axis)) < 1e-12 && fabs(vec3_length(a.across) - 1.0) < 1e-14);
        if (i % 2 == 0)
            assert_true(fabs(a.normal.y) < 1e-14); /* a vertical plane */
    }
    assert_vec(axes_of(vec3_make(0, 5, 0), NULL).normal, 0, 0, 1); /* an upright axis has many vertical planes */
}

static void no_plane_is_refused(void **state)
{
    (void)state;
    ray_axes a;
    diagnostic why = {.what = ""};
    const vec3 along = {0, 0, -4}, none = {0, 0, 0};
    assert_int_equal(ray_axes_set(&a, none, none, NULL, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "same point"));
    assert_int_equal(ray_axes_set(&a, none, vec3_make(0, 0, 1), &along, &why), STATUS_BAD_INPUT);
    assert_int_equal(ray_axes_set(&a, none, vec3_make(0, 0, 1), &none, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "parallel"));
}

/* The ends are half the size from the axis; a disc and a cone are filled evenly, so that the mean square distance is
 * half the square of the radius. */
static void rays_fill_the_width_and_the_disc(void **state)
{
    (void)state;
    const ray_axes a = axes_of(vec3_make(0, 0, 1), NULL);
    vec3 origin, direction;
    assert_true(ray_axes_in_plane(&a, false, 0.8, 0, 5, &origin, &direction) == -0.4);
    assert_vec(origin, 1.4, 2, 3);
    assert_true(ray_axes_in_plane(&a, true, 60.0, 4, 5, &origin, &direction) == 30.0);
    assert_vec(direction, -0.5, 0, sqrt(0.75));
    enum { RAYS = 20000 };
    double square = 0.0, cosine = 0.0;
    for (int i = 0; i < RAYS; i++) {
        ray_axes_round(&a, false, 2.0, i, RAYS, &origin, &direction);
        const double x = origin.x - 1, y = origin.y - 2;
        square += (x * x + y * y) / RAYS;
        assert_true(x * x + y * y <= 1.0);
        ray_axes_round(&a, true, 120.0, i, RAYS, &origin, &direction);
        cosine += direction.z / RAYS;
        assert_true(direction.z >= 0.5 - 1e-12);
        assert_true(fabs(vec3_dot(direction, direction) - 1.0) < 1e-12);
    }
    assert_true(fabs(square - 0.5) < 1e-9 && fabs(cosine - 0.75) < 1e-9); /* a cone of 60 degrees: (1 + cos) / 2 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_horizontal_plane_has_its_left_on_the_left),
        cmocka_unit_test(any_other_plane_has_its_upper_side_up),
        cmocka_unit_test(no_plane_is_refused),
        cmocka_unit_test(rays_fill_the_width_and_the_disc),
    };
    return cmocka_run_group_tests_name("ray_axes", tests, NULL, NULL);
}
