/* Tests of pencils and fans. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "random_stream.h"
#include "render/inspect/fan.h"
#include "render/plan/sampling.h"
#include "render_fixture.h"

/* Pencils and fans against geometrical optics. */

static fan follow(const scene *s, const fan_rule *rule)
{
    probe *p = NULL;
    fan f = {0};
    diagnostic why = {0};
    worked(probe_create(s, isa_best(), &p, &why), &why);
    worked(fan_trace(p, rule, &f, &why), &why);
    probe_destroy(p);
    return f;
}

static const char ball_text[] =
    "render: {depth: 6}\nsolids: {ball: {shape: sphere, transparency: 1, ior: 1.5, radius: 1}}\n";

/* A ball lens: f = n R / (2 (n - 1)) from its centre (Hecht 6.2, thick lens with R_1 = -R_2 = R and d = 2 R); 1.5 for
 * glass. */
static void a_thin_pencil_converges_at_the_focus_of_a_ball_lens(void **state)
{
    (void)state;
    scene *s = scene_from(ball_text);
    const fan_rule rule = {.from = {-5, 0, 0}, .to = {5, 0, 0}, .rays = 11, .width = 1e-3};
    fan f = follow(s, &rule);
    assert_int_equal(f.count, 11);
    assert_true(f.has_focus && !f.is_virtual && f.focus_rms < 1e-9);
    assert_true(fabs(f.focus.x - 1.5) < 1e-5 && fabs(f.focus.y) < 1e-9 && fabs(f.focus.z) < 1e-9);
    assert_int_equal(f.crossing_count, 10);
    for (int i = 0; i < f.crossing_count; i++)
        assert_true(fabs(f.crossing[i].at.x - 1.5) < 1e-5);
    for (int i = 0; i < f.count; i++) {
        const fan_ray *ray = &f.ray[i];
        assert_true(fabs(ray->offset - 1e-3 * (i / 10.0 - 0.5)) < 1e-18);
        assert_true(ray->leaves && ray->count == 3 && fabs(ray->weight - 0.96 * 0.96) < 1e-6);
        if (i != 5)
            assert_true(ray->crosses_axis && fabs(ray->axis_at - 6.5) < 1e-5);
    }
    fan_release(&f);
    scene_destroy(s);
}

/* A sphere deflects a ray with angle of incidence i by 2 (i - t), and sin i = h / R (Hecht 4.4, twice). */
static void a_wide_pencil_obeys_snells_law(void **state)
{
    (void)state;
    scene *s = scene_from(ball_text);
    const fan_rule rule = {.from = {-5, 0, 0}, .to = {5, 0, 0}, .rays = 19, .width = 1.4};
    fan f = follow(s, &rule);
    for (int k = 0; k < f.count; k++) {
        const fan_ray *ray = &f.ray[k];
        const double i = asin(fabs(ray->offset)), t = asin(fabs(ray->offset) / 1.5);
        assert_true(fabs(ray->deviation_deg - 2.0 * (i - t) * 180.0 / 3.14159265358979323846) < 1e-9);
        /* Spherical aberration: the exit ray, at distance R sin i from the centre, crosses the axis at R sin i / sin(2
         * (i - t)). */
        if (k != 9)
            assert_true(fabs(ray->axis_at - 5.0 - sin(i) / sin(2.0 * (i - t))) < 1e-9);
    }
    /* The caustic is symmetric, and nowhere behind the paraxial focus. */
    assert_int_equal(f.crossing_count, 18);
    for (int k = 0; k < 18; k++) {
        assert_true(fabs(f.crossing[k].at.x - f.crossing[17 - k].at.x) < 1e-12);
        assert_true(f.crossing[k].at.x < 1.5);
    }
    assert_true(f.focus_rms > 1e-3);
    fan_release(&f);
    scene_destroy(s);
}

/* Light from the focus in front of a ball leaves it parallel: there is then no focus and no crossing. */
static void light_from_the_focus_leaves_parallel(void **state)
{
    (void)state;
    scene *s = scene_from(ball_text);
    const fan_rule rule = {.from = {-1.5, 0, 0}, .to = {0, 0, 0}, .rays = 5, .spreads = true, .spread_deg = 0.02};
    fan f = follow(s, &rule);
    for (int i = 0; i < f.count; i++)
        assert_true(fabs(f.ray[i].offset - 0.02 * (i / 4.0 - 0.5)) < 1e-15 && f.ray[i].exit_direction.x > 1.0 - 1e-12);
    fan_release(&f);
    scene_destroy(s);
}

/* A plane slab makes a point appear nearer by d (1 - 1/n) for a slab of thickness d (Hecht 4.4, paraxial). Its image is
 * virtual. */
static void a_slab_shifts_the_virtual_image_of_a_point(void **state)
{
    (void)state;
    scene *s =
        scene_from("render: {depth: 6}\nsolids: {slab: {shape: box, transparency: 1, ior: 1.5, size: [3, 50, 50]}}\n");
    const fan_rule rule = {.from = {-5, 1, 0}, .to = {5, 1, 0}, .rays = 7, .spreads = true, .spread_deg = 0.1};
    fan f = follow(s, &rule);
    assert_true(f.has_focus && f.is_virtual && fabs(f.focus.x - (-5.0 + 1.0)) < 1e-5);
    assert_int_equal(f.crossing_count, 0);
    assert_true(f.ray[6].exit_point.x == 1.5 && !f.ray[6].crosses_axis && f.ray[6].deviation_deg < 1e-9);
    fan_release(&f);
    scene_destroy(s);
}

/* Outer rays that miss the ball do not count for its focus. A ray that crosses the axis at a = sin i / sin d, deflected
 * by d = 2 (i - t), is at distance |x - a| sin d from x; the sum of the squares is least at sum a sin^2 d / sum sin^2
 * d. */
static void only_deflected_rays_count_for_the_focus(void **state)
{
    (void)state;
    scene *s = scene_from(ball_text);
    const fan_rule rule = {.from = {-5, 0, 0}, .to = {5, 0, 0}, .rays = 9, .width = 3.6};
    fan f = follow(s, &rule);
    double weights = 0.0, moment = 0.0, squares = 0.0;
    for (int k = 1; k <= 2; k++) { /* on each side; the middle ray has weight 0 */
        const double i = asin(0.45 * k), d = 2.0 * (i - asin(0.3 * k)), weight = 2.0 * sin(d) * sin(d),
                     at = sin(i) / sin(d);
        weights += weight, moment += weight * at, squares += weight * at * at;
    }
    const double x = moment / weights, rms = sqrt((squares - x * moment) / 5.0);
    assert_true(f.has_focus && fabs(f.focus.x - x) < 1e-12 && fabs(f.focus_rms - rms) < 1e-12);
    fan_release(&f);
    scene_destroy(s);
}

/* i = asin 0.9: the two rays cross at 0.9 / sin(2 (i - t)) = 1.104 on the axis, 0.204 behind the ball. A stone next to
 * the axis blocks the second ray from 0.177 to 0.061 before that point, and the first one 0.020 behind it. */
static void rays_cross_only_where_both_are_unblocked(void **state)
{
    (void)state;
    scene *s = scene_from("render: {depth: 6}\n"
                          "solids:\n"
                          "  ball: {shape: sphere, transparency: 1, ior: 1.5, radius: 1}\n"
                          "  stone: {shape: sphere, position: [1.25, 0, 0.25], radius: 0.27}\n");
    const fan_rule rule = {.from = {-5, 0, 0}, .to = {5, 0, 0}, .rays = 2, .width = 1.8};
    fan f = follow(s, &rule);
    const double i = asin(0.9), at = 0.9 / sin(2.0 * (i - asin(0.6)));
    assert_true(f.ray[0].leaves && fabs(f.ray[0].reach - 0.204 - 0.020) < 1e-3 &&
                fabs(f.ray[1].reach - 0.204 + 0.177) < 1e-3);
    assert_true(f.ray[0].crosses_axis && fabs(f.ray[0].axis_at - 5.0 - at) < 1e-12 && !f.ray[1].crosses_axis);
    assert_int_equal(f.crossing_count, 0);
    fan_release(&f);
    set(s, "stone.visible=off");
    f = follow(s, &rule);
    assert_true(f.ray[0].crosses_axis && f.ray[1].crosses_axis);
    assert_true(f.crossing_count == 1 && fabs(f.crossing[0].at.x - at) < 1e-12);
    fan_release(&f);
    scene_destroy(s);
}

static void the_plane_of_a_fan_is_horizontal_vertical_or_given(void **state)
{
    (void)state;
    scene *s = scene_from(ball_text);
    fan_rule rule = {.from = {-5, 0.5, 0}, .to = {5, 0.5, 0}, .rays = 3, .width = 1};
    fan f = follow(s, &rule);
    assert_true(fabs(f.normal.y) == 1.0 && f.across.z == 1.0);
    fan_release(&f);
    rule.to.y = 0.6;
    f = follow(s, &rule);
    assert_true(fabs(f.normal.z) > 1.0 - 1e-12 && f.across.y > 0.99);
    fan_release(&f);
    rule.to = vec3_make(-5, -3, 0); /* straight down */
    f = follow(s, &rule);
    assert_true(fabs(f.normal.z) == 1.0);
    fan_release(&f);
    rule.to = vec3_make(5, 0.5, 0), rule.has_normal = true, rule.normal = vec3_make(7, 0, 2);
    f = follow(s, &rule);
    assert_true(fabs(f.normal.z) == 1.0 && f.across.y == 1.0 && f.ray[2].offset == 0.5);
    fan_release(&f);
    scene_destroy(s);
}

static void invalid_fan_rules_are_refused(void **state)
{
    (void)state;
    scene *s = scene_from(ball_text);
    probe *p = NULL;
    worked(probe_create(s, isa_best(), &p, NULL), NULL);
    const fan_rule good = {.from = {-5, 0, 0}, .to = {5, 0, 0}, .rays = 3, .width = 1};
    fan_rule bad[6];
    for (int i = 0; i < 6; i++)
        bad[i] = good;
    bad[0].to = bad[0].from;
    bad[1].has_normal = true, bad[1].normal = vec3_make(-2, 0, 0);
    bad[2].rays = 0;
    bad[3].width = NAN;
    bad[4].spreads = true, bad[4].spread_deg = 180.0;
    bad[5].rays = FAN_RAYS_MAX + 1;
    fan f = {0};
    for (int i = 0; i < 6; i++) {
        diagnostic why = {0};
        assert_int_equal(fan_trace(p, &bad[i], &f, &why), STATUS_BAD_INPUT);
        assert_true(why.what[0] && why.remedy[0]);
        fan_release(&f);
    }
    probe_destroy(p);
    scene_destroy(s);
}

/* Plates and prisms leave parallel rays parallel (Hecht 4.4 and 5.5): there is no focus, whatever the angle. */
static void plates_and_prisms_have_no_focus(void **state)
{
    (void)state;
    static const int rays[] = {2, 3, 11, 41};
    char text[300];
    int followed = 0;
    for (int prism = 0; prism < 2; prism++)
        for (int i = 0; i < (prism ? 5 : 10); i++)
            for (size_t k = 0; k < sizeof rays / sizeof *rays; k++) {
                snprintf(text, sizeof text,
                         prism
                             ? "solids: {a: {shape: prism, sides: 3, transparency: 1, ior: 1.5, radius: 2, height: 4, "
                               "position: [0, -2, 0], rotation: [0, %.17g, 0]}}"
                             : "solids: {a: {shape: box, transparency: 1, ior: 1.5, size: [4, 1, 4], rotation: [3, 7, "
                               "%.17g]}}",
                         prism ? 50.0 + 7.3 * i : 8.1 * i);
                scene *s = scene_from(text);
                const fan_rule rule = {.from = {-5, 3.3, 0.1}, .to = {0, 0, 0}, .rays = rays[k], .width = 0.3};
                const fan_rule level = {.from = {-5, 0.1, 0.2}, .to = {0, 0.1, 0.1}, .rays = rays[k], .width = 0.3};
                fan f = follow(s, prism ? &level : &rule);
                followed += f.ray[0].leaves && f.ray[0].count > 1;
                assert_true(!f.has_focus && f.crossing_count == 0);
                fan_release(&f);
                scene_destroy(s);
            }
    assert_true(followed >= 50);
}

/* A ball of index n has its paraxial focus n R / (2 (n - 1)) behind its centre (Hecht 6.2), also 1e8 times as far away
 * as the pencil is wide; of the ball of lower index than its surroundings it is virtual. */
static void far_foci_are_found(void **state)
{
    (void)state;
    static const double less_1[] = {5e-3, 5e-5, 5e-7, -5e-5, -5e-7};
    char text[200];
    for (size_t i = 0; i < sizeof less_1 / sizeof *less_1; i++)
        for (int turned = 0; turned < 2; turned++) {
            snprintf(text, sizeof text, "solids: {ball: {shape: sphere, transparency: 1, ior: %.17g, radius: 1}}",
                     1.0 + less_1[i]);
            scene *s = scene_from(text);
            const vec3 axis = turned ? vec3_make(0.48, -0.6, 0.64) : vec3_make(1, 0, 0);
            const fan_rule rule = {.from = vec3_scale(axis, -5), .to = {0, 0, 0}, .rays = 21, .width = 0.01};
            fan f = follow(s, &rule);
            const double n = 1.0 + less_1[i], at = n / (2.0 * (n - 1.0));
            assert_true(f.has_focus && f.is_virtual == (at < 0.0));
            assert_true(fabs(vec3_dot(f.focus, axis) / at - 1.0) < 1e-4);
            assert_true(vec3_length(vec3_sub(f.focus, vec3_scale(axis, vec3_dot(f.focus, axis)))) < 1e-9 * fabs(at));
            fan_release(&f);
            scene_destroy(s);
        }
}

/* Where the rays of fans and beams start: an orthonormal frame, whose sign is the documented one. */

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
    const ray_pattern spiral = ray_pattern_of(PATTERN_SPIRAL, RAYS);
    double square = 0.0, cosine = 0.0;
    for (int i = 0; i < RAYS; i++) {
        ray_axes_round(&a, &spiral, false, 2.0, i, &origin, &direction);
        const double x = origin.x - 1, y = origin.y - 2;
        square += (x * x + y * y) / RAYS;
        assert_true(x * x + y * y <= 1.0);
        ray_axes_round(&a, &spiral, true, 120.0, i, &origin, &direction);
        cosine += direction.z / RAYS;
        assert_true(direction.z >= 0.5 - 1e-12);
        assert_true(fabs(vec3_dot(direction, direction) - 1.0) < 1e-12);
    }
    assert_true(fabs(square - 0.5) < 1e-9 && fabs(cosine - 0.75) < 1e-9); /* a cone of 60 degrees: (1 + cos) / 2 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_thin_pencil_converges_at_the_focus_of_a_ball_lens),
        cmocka_unit_test(a_wide_pencil_obeys_snells_law),
        cmocka_unit_test(light_from_the_focus_leaves_parallel),
        cmocka_unit_test(plates_and_prisms_have_no_focus),
        cmocka_unit_test(far_foci_are_found),
        cmocka_unit_test(a_slab_shifts_the_virtual_image_of_a_point),
        cmocka_unit_test(only_deflected_rays_count_for_the_focus),
        cmocka_unit_test(rays_cross_only_where_both_are_unblocked),
        cmocka_unit_test(the_plane_of_a_fan_is_horizontal_vertical_or_given),
        cmocka_unit_test(invalid_fan_rules_are_refused),
        cmocka_unit_test(a_horizontal_plane_has_its_left_on_the_left),
        cmocka_unit_test(any_other_plane_has_its_upper_side_up),
        cmocka_unit_test(no_plane_is_refused),
        cmocka_unit_test(rays_fill_the_width_and_the_disc),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
