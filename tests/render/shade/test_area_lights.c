/* Tests of discs and rectangles as lights, and of soft shadows, against form factors. A matte white surface under a
 * lamp of radiance L has the radiance L F, with F the form factor from a point to the lamp (Siegel and Howell, Thermal
 * Radiation Heat Transfer, 4th ed., appendix C). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "render/plan/lights.h"
#include "render/shade/light_sampling.h"
#include "render_fixture.h"
#include "scene/model/scene.h"
#include "whole.h"

#define PI 3.14159265358979323846
#define assert_near(a, b, tolerance)                                    \
    do {                                                                \
        if (!(fabs((a) - (b)) <= (tolerance)))                          \
            fail_msg("%.9g instead of %.9g", (double)(a), (double)(b)); \
    } while (0)

/* From a point below one corner of a parallel rectangle a by b at height 1 (C-13 of the catalogue). */
static double corner(double a, double b)
{
    const double s = sqrt(1.0 + a * a), t = sqrt(1.0 + b * b);
    return (a / s * atan(b / s) + b / t * atan(a / t)) / (2.0 * PI);
}

/* Of the rectangle x0 .. x1 by z0 .. z1 at that height above the point (x, 0, z): a signed sum of corners. */
static double above(double x0, double x1, double z0, double z1, double height)
{
#define SIGNED(u, v) copysign(1.0, (u) * (v)) * corner(fabs(u) / height, fabs(v) / height)
    return SIGNED(x1, z1) - SIGNED(x0, z1) - SIGNED(x1, z0) + SIGNED(x0, z0);
#undef SIGNED
}

/* A small patch of a white floor at the origin, seen obliquely from below all lamps. */
#define PATCH                                                                                               \
    "render: {width: 24, height: 24, depth: 0, paths: 64, samples: 64, integrator: %s, soft_shadows: on}\n" \
    "camera: {position: [3, 0.5, 0], target: [0, 0, 0], fov_deg: 0.1}\n"                                    \
    "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"                                                  \
    "lights: {lamp: {%s}}\n"                                                                                \
    "solids: {ground: {shape: plane, diffuse: 1}%s}\n"

/* The mean over the image, first channel. */
static double mean_of(const char *method, const char *lamp, const char *solids, const char *assignments)
{
    char text[1000];
    snprintf(text, sizeof text, PATCH, method, lamp, solids);
    scene *s = scene_from(text);
    set_all(s, assignments);
    const double mean = mean_radiance(s);
    scene_destroy(s);
    return mean;
}

static const char *const integrators[] = {"path", "whitted", "raycast"};

/* A rectangle that emits straight down has its width along x, and its axis times that direction, z, is up. A quarter
 * turn exchanges the two. */
static void points_of_a_rectangle_are_where_its_edges_are(void **state)
{
    (void)state;
    light l = {
        .kind = LIGHT_RECTANGLE, .position = {1.0, 5.0, 2.0}, .target = {1.0, 0.0, 2.0}, .width = 3.0, .height = 0.5};
    lamp_shape s = lamp_shape_of(&l);
    assert_true(s.area == 1.5);
    vec3 at = lamp_shape_point(&s, l.position, 0.75, 0.25); /* half way to an edge, either way */
    assert_true(at.x == 1.75 && at.y == 5.0 && at.z == 1.875);
    l.roll_deg = 90.0;
    s = lamp_shape_of(&l);
    at = lamp_shape_point(&s, l.position, 0.75, 0.25);
    assert_near(at.x, 1.125, 1e-15);
    assert_near(at.z, 2.75, 1e-15);
}

/* A ray meets a sphere from outside; from within and from the sphere itself it meets none. */
static void a_sphere_is_met_from_outside(void **state)
{
    (void)state;
    light l = {.kind = LIGHT_POINT, .position = {0.0, 0.0, 0.0}, .radius = 2.0};
    const plan p = {.lights = &l, .light_count = 1};
    const vec3 towards = {-1.0, 0.0, 0.0};
    assert_true(area_light_distance(&p, 0, vec3_make(5.0, 0.0, 0.0), towards) == 3.0);
    assert_true(isinf(area_light_distance(&p, 0, vec3_make(5.0, 2.0, 0.0), towards))); /* a tangent */
    assert_true(isinf(area_light_distance(&p, 0, vec3_make(2.0, 0.0, 0.0), towards)));
    assert_true(isinf(area_light_distance(&p, 0, vec3_make(1.0, 0.0, 0.0), towards)));
}

/* L = pi I reach^2 / A. Off the axis too. */
static void a_rectangle_lights_by_its_form_factor(void **state)
{
    (void)state;
    const double radiance = PI * 2.0 * 9.0 / (2.0 * 1.0);
    for (int k = 0; k < 3; k++) {
        assert_near(mean_of(integrators[k],
                            "kind: rectangle, position: [0, 1.5, 0], target: [0, 0, 0], width: 2, height: 1, "
                            "intensity: 2, reach: 3",
                            "", ""),
                    radiance * above(-1.0, 1.0, -0.5, 0.5, 1.5), 0.003 * radiance);
        assert_near(mean_of(integrators[k],
                            "kind: rectangle, position: [1.2, 1.5, 0.4], target: [1.2, 0, 0.4], width: 2, height: 1, "
                            "intensity: 2, reach: 3, roll_deg: 90",
                            "", ""),
                    radiance * above(0.7, 1.7, -0.6, 1.4, 1.5), 0.003 * radiance);
    }
}

/* A parallel disc: F = r^2 / (r^2 + h^2) on its axis. One that turns its back gives nothing. */
static void a_disc_lights_by_its_form_factor(void **state)
{
    (void)state;
    const double radiance = 0.5 * 4.0 / (0.8 * 0.8), share = 0.64 / (0.64 + 2.25);
    for (int k = 0; k < 3; k++) {
        assert_near(
            mean_of(integrators[k],
                    "kind: disc, position: [0, 1.5, 0], target: [0, 0, 0], radius: 0.8, intensity: 0.5, reach: 2", "",
                    ""),
            radiance * share, 0.003 * radiance);
        assert_true(
            mean_of(integrators[k],
                    "kind: disc, position: [0, 1.5, 0], target: [0, 3, 0], radius: 0.8, intensity: 0.5, reach: 2", "",
                    "") == 0.0);
    }
}

/* A sphere of radius r at distance d, wholly above the horizon: F = (r / d)^2 cos. */
static void a_sphere_is_soft_too(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++)
        assert_near(mean_of(integrators[k], "position: [1, 2, 0], radius: 0.5, intensity: 1, reach: 2", "", ""),
                    4.0 / 5.0 * 2.0 / sqrt(5.0), 0.003);
}

/* A half plane hides the part of the lamp beyond its edge: the rest is a rectangle. The edge at height 0.75, half way
 * to the lamp, at x = e hides what is beyond 2 e. */
static void a_penumbra_is_that_of_the_visible_part(void **state)
{
    (void)state;
    const double radiance = PI * 9.0 / 2.0;
    for (double edge = -0.4; edge < 0.45; edge += 0.2) {
        char board[200];
        snprintf(board, sizeof board, ", board: {shape: box, size: [8, 0.0001, 8], position: [%.17g, 0.75, 0]}",
                 edge - 4.0);
        for (int k = 0; k < 3; k++)
            assert_near(mean_of(integrators[k],
                                "kind: rectangle, position: [0, 1.5, 0], target: [0, 0, 0], width: 2, height: 1, "
                                "intensity: 1, reach: 3",
                                board, ""),
                        radiance * above(fmax(2.0 * edge, -1.0), 1.0, -0.5, 0.5, 1.5), 0.004 * radiance);
    }
}

/* Without soft shadows a flat lamp is a point with Lambert's law: I (reach / d)^2 cos cos_l. */
static void far_away_it_is_a_point_by_lamberts_law(void **state)
{
    (void)state;
    const double d2 = 30.0 * 30.0 + 40.0 * 40.0, cosine = 40.0 / 50.0,
                 cos_l = (30.0 * 1.0 + 40.0 * 2.0) / (50.0 * sqrt(5.0));
    static const char lamp[] =
        "kind: rectangle, position: [-30, 40, 0], target: [-29, 38, 0], width: 2, height: 1, intensity: 1, reach: 50";
    assert_near(mean_of("whitted", lamp, "", "render.soft_shadows=off"), 2500.0 / d2 * cosine * cos_l, 1e-4);
    for (int k = 0; k < 3; k++)
        assert_near(mean_of(integrators[k], lamp, "", ""), 2500.0 / d2 * cosine * cos_l, 2e-3);
}

/* Its radiance, from in front; from behind there is nothing, not even a shadow of it. */
static void a_path_sees_its_front(void **state)
{
    (void)state;
    static const char text[] = "render: {width: 1, height: 1, integrator: path, paths: 16}\n"
                               "camera: {position: [0, 0, 5], target: [0, 0, 0], fov_deg: 1}\n"
                               "background: {color: [0.25, 0.25, 0.25], ambient: [0, 0, 0]}\n"
                               "lights: {lamp: {kind: disc, target: [0, 0, 9], position: [0, 0, 0], radius: 0.5, "
                               "intensity: 2, reach: 3}}\n";
    scene *s = scene_from(text);
    assert_near(look(s).x, 2.0 * 9.0 / 0.25, 1e-4);
    set(s, "camera.position=0,0,-5");
    assert_near(look(s).x, 0.25, 1e-6);
    scene_destroy(s);
}

/* Photons from a disc through a slab: its apparent distance, and (1 - R) / (1 + R). The lamp is small and
 * on the axis, so that its cosine is 1. */
static void photons_leave_a_flat_lamp(void **state)
{
    (void)state;
    const double apparent = 8.0 - 1.0 + 1.0 / 1.6, r = 0.6 * 0.6 / (2.6 * 2.6),
                 expected = 64.0 / (apparent * apparent) * (1.0 - r) / (1.0 + r);
    static const char disc[] =
        "kind: disc, position: [0, 8, 0], target: [0, 0, 0], intensity: 1, reach: 8, radius: 0.4",
                      rectangle[] = "kind: rectangle, position: [0, 8, 0], target: [0, 0, 0], intensity: 1, reach: 8, "
                                    "width: 0.6, height: 0.7",
                      slab[] =
                          ", slab: {shape: box, position: [0, 2, 0], size: [1.5, 1, 1.5], transparency: 1, ior: 1.6}";
    const char *photons = "render.depth=8 render.caustics=photons render.photons=2000000 camera.position=0.5,0.3,0 "
                          "camera.fov_deg=20 render.paths=16 render.samples=16";
    for (int k = is_whole() ? 1 : 2; k < 3;
         k++) { /* random paths also have light that the floor and the slab exchange */
        assert_near(mean_of(integrators[k], disc, slab, photons), expected, 0.01 * expected);
        assert_near(mean_of(integrators[k], rectangle, slab, photons), expected, 0.01 * expected);
    }
}

static void one_film_on_all_instruction_sets(void **state)
{
    (void)state;
    static const char text[] =
        "render: {width: 40, height: 30, depth: 3, samples: 9, soft_shadows: on}\n"
        "camera: {position: [3, 2, 0], target: [0, 0.3, 0], fov_deg: 50}\n"
        "lights: {lamp: {kind: rectangle, position: [1, 3, 1], target: [0, 0, 0], reach: 3, roll_deg: 20}}\n"
        "solids: {ground: {shape: plane, diffuse: 1}, ball: {shape: sphere, position: [0, 0.5, 0], radius: 0.5, "
        "transparency: 1, ior: 1.5, specular: 0.4}}\n";
    scene *s = scene_from(text);
    for (int path = 0; path < 2; path++) {
        if (path)
            set_all(s, "render.integrator=path render.paths=8");
        render_result *best = render(s);
        for (isa level = (isa)0; level <= isa_best(); level++) {
            render_result *other = render_at(s, level, NULL);
            assert_true(film_hash(other->img) == film_hash(best->img));
            render_result_destroy(other);
        }
        set(s, "render.threads=3");
        render_result *threads = render(s);
        assert_true(film_hash(threads->img) == film_hash(best->img));
        render_result_destroy(threads);
        render_result_destroy(best);
    }
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_of_a_rectangle_are_where_its_edges_are),
        cmocka_unit_test(a_sphere_is_met_from_outside),
        cmocka_unit_test(a_rectangle_lights_by_its_form_factor),
        cmocka_unit_test(a_disc_lights_by_its_form_factor),
        cmocka_unit_test(a_sphere_is_soft_too),
        cmocka_unit_test(a_penumbra_is_that_of_the_visible_part),
        cmocka_unit_test(far_away_it_is_a_point_by_lamberts_law),
        cmocka_unit_test(a_path_sees_its_front),
        cmocka_unit_test(photons_leave_a_flat_lamp),
        cmocka_unit_test(one_film_on_all_instruction_sets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
