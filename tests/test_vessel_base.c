/* Test of the view through the vessel's base, along one ray that can be computed by hand. POV-Ray 3.7 shows the ground
 * there, dark; Cuvette shows the sky. In the plane x = 0 the vessel is a stack of flat layers: a ray that comes down
 * through the vertical walls at elevation -e keeps sin e' = sin e / n in every layer, so on the horizontal base it has
 * n cos e' = sqrt(n^2 - sin^2 e) > 1: total reflection, whatever e, for every n > sqrt 2 (and through the liquid, n =
 * 1.33, including the floor of glass below it, since n cos e' is the same in all layers, sqrt(1.33^2 - sin^2 e) = 1.266
 * for the ray below). It returns upwards at +e', leaves through the far wall at +e, and ends in the sky. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/isa.h"
#include "render/frame/renderer.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <math.h>

static const double GLASS = 1.5, LIQUID = 1.33;

/* Hecht, Optics, 4.6.2, written with sines only: R = (sin^2(i-t)/sin^2(i+t) + tan^2(i-t)/tan^2(i+t)) / 2. */
static double reflectance(double i, double t)
{
    double s = sin(i - t) / sin(i + t), p = tan(i - t) / tan(i + t);
    return 0.5 * (s * s + p * p);
}

typedef struct point {
    double y, z;
} point;

/* From p at elevation e (radians) to the plane z, or to the height y. */
static point to_wall(point p, double e, double z)
{
    return (point){p.y + tan(e) * (z - p.z), z};
}
static point to_height(point p, double e, double y)
{
    return (point){y, p.z + (y - p.y) / tan(e)};
}

/* The throughput of the path camera, wall, liquid, floor, base (total), floor, liquid, wall, sky. Asserts that the ray
 * takes this path. */
static double share_by_hand(double entry_y)
{
    const double e = atan2(2.75 - entry_y, 6.0 - 1.0);
    const double in_glass = asin(sin(e) / GLASS), in_liquid = asin(sin(in_glass) * GLASS / LIQUID);
    point p = to_wall((point){entry_y, -1.0}, -in_glass, -0.9);
    p = to_height(p, -in_liquid, 0.101);
    assert_true(p.z > -0.9 && p.z < 0.9);
    /* Angles of incidence on horizontal faces are from the vertical; across the floor n sin is invariant. */
    const double from_vertical = M_PI / 2 - in_liquid, floor_angle = asin(LIQUID * sin(from_vertical) / GLASS);
    assert_true(GLASS * sin(floor_angle) > 1.0); /* total reflection at the base */
    p = to_height(p, -(M_PI / 2 - floor_angle), 0.001);
    assert_true(p.z < 1.0);
    p = to_height(p, M_PI / 2 - floor_angle, 0.101);
    assert_true(p.z < 0.9);
    p = to_wall(p, in_liquid, 0.9);
    assert_true(p.y < 2.001);
    p = to_wall(p, in_glass, 1.0);
    assert_true(p.y < 3.001);
    double wall = (1 - reflectance(e, in_glass)) * (1 - reflectance(in_glass, in_liquid));
    double floor_share = 1 - reflectance(from_vertical, floor_angle);
    return wall * floor_share * floor_share * wall;
}

/* One ray to (0, entry_y, -1) among clear solids over black ground under a white sky, black beyond the last depth. */
static double radiance(const char *depth, double entry_y)
{
    scene *s;
    diagnostic why;
    assert_int_equal(scene_read("experiments/scenes/rod.yaml", &s, &why), STATUS_OK);
    const char *const settings[] = {"render.width=1",         "render.height=1",    "render.beyond=black",
                                    "background.color=1,1,1", "ground.color=0,0,0", "ground.checker=0",
                                    "rod.visible=off",        "lamp.intensity=0",   depth};
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++)
        assert_int_equal(scene_set_assignment(s, settings[i], &why), STATUS_OK);
    s->camera.target = vec3_make(0.0, entry_y, -1.0);
    renderer *r;
    render_result *result;
    assert_int_equal(renderer_create(isa_best(), NULL, &r, &why), STATUS_OK);
    assert_int_equal(renderer_render(r, s, NULL, &result, &why), STATUS_OK);
    double value = film_value(result->img, 0, 0, 1);
    render_result_destroy(result);
    renderer_destroy(r);
    scene_destroy(s);
    return value;
}

static void the_base_of_the_vessel_reflects_the_sky(void **state)
{
    (void)state;
    for (double entry_y = 0.32; entry_y < 0.46; entry_y += 0.04) {
        double share = share_by_hand(entry_y);
        assert_true(share > 0.6);
        double with = radiance("render.depth=7", entry_y), without = radiance("render.depth=6", entry_y);
        /* The seventh branch reaches the sky; all other paths together carry at most the rest. */
        assert_true(with - without >= share - 1e-12);
        assert_true(with - without <= share + (1 - share) + 1e-12);
        assert_true(without <= 1 - share + 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_base_of_the_vessel_reflects_the_sky)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
