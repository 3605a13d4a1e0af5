/* Tests of the emission of photons: their power into every cone is the lamp's intensity times the solid angle, however
 * many solids deflect light. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "render/caustics/emission.h"
#include "render_fixture.h"
#include "scene/model/scene.h"

#define PI 3.14159265358979323846
enum { PHOTONS = 1 << 17, BALLS_MAX = 80 };

/* The solid angle of a ball, from 1 - cos = sin^2 / (1 + cos). */
static double solid_angle(double radius, double distance)
{
    const double sine = radius / distance;
    return 2.0 * PI * sine * sine / (1.0 + sqrt(1.0 - sine * sine));
}

static emission *emission_of(const char *text, bool sizes, scene **s, plan **p)
{
    emission *e = NULL;
    *s = scene_from(text);
    assert_int_equal(plan_build(*s, p, NULL), STATUS_OK);
    assert_int_equal(emission_create(*p, PHOTONS, sizes, &e, NULL), STATUS_OK);
    return e;
}

static void emission_end(emission *e, plan *p, scene *s)
{
    emission_destroy(e);
    plan_destroy(p);
    scene_destroy(s);
}

/* Towards one solid, whose bounding ball is around its box: photons of one power fill the cone around that ball, and
 * none is beyond it. */
static void photons_fill_the_cone_around_a_solid(void **state)
{
    (void)state;
    scene *s;
    plan *p;
    emission *e = emission_of("render: {caustics: photons}\nlights: {lamp: {position: [0, 0, 0], intensity: 2, reach: "
                              "3}}\nsolids: {b: {shape: box, size: [2, 2, 2], position: [0, 0, 4], transparency: 1, "
                              "ior: 1.5}}\n",
                              false, &s, &p);
    const double around = solid_angle(sqrt(3.0), 4.0), cap = around / (2.0 * PI);
    double widest = 0.0;
    for (int64_t i = 0; i < PHOTONS; i++) {
        emitted_ray ray;
        assert_true(emission_ray(e, i, &ray));
        assert_true(fabs(ray.power.x / (2.0 * 9.0 * around / PHOTONS) - 1.0) < 1e-8);
        widest = fmax(widest, 1.0 - ray.direction.z);
    }
    assert_true(widest > 0.999 * cap && widest < (1.0 + 1e-8) * cap);
    emission_end(e, p, s);
}

/* Without light, and where nothing deflects it, there are no photons. */
static void dark_lamps_and_matte_solids_have_no_photons(void **state)
{
    (void)state;
    static const char *const cases[] = {"intensity: 0}}\nsolids: {b: {shape: sphere, transparency: 1, ior: 1.5}}\n",
                                        "intensity: 1}}\nsolids: {b: {shape: sphere}}\n"};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[256];
        scene *s;
        plan *p;
        snprintf(text, sizeof text, "render: {caustics: photons}\nlights: {lamp: {position: [0, 4, 0], %s", cases[k]);
        emission *e = emission_of(text, false, &s, &p);
        assert_int_equal(emission_count(e), 0);
        emission_end(e, p, s);
    }
}

/* The cones of two balls, one behind the other, overlap, and a lamp of radius 1 is larger than either: rays within an
 * angle of the axis that pass within b of the first one's centre leave the lamp, and carry I reach^2 over pi times
 * their etendue, 2 pi (1 - cos) pi b^2, over the area of its disc, pi. Those that pass both are counted once. */
static void rays_that_pass_two_balls_are_counted_once(void **state)
{
    (void)state;
    scene *s;
    plan *p;
    emission *e = emission_of("render: {caustics: photons}\nlights: {lamp: {position: [0, 0, 0], radius: 1, intensity: "
                              "2, reach: 3}}\nsolids:\n"
                              "  near: {shape: sphere, radius: 0.2, position: [0, 0, 10], transparency: 1, ior: 1.5}\n"
                              "  far: {shape: sphere, radius: 0.2, position: [0, 0, 20], transparency: 1, ior: 1.5}\n",
                              true, &s, &p);
    const double b = 0.2 * sqrt(3.0), angle = 0.06;
    double power = 0.0;
    for (int64_t i = 0; i < PHOTONS; i++) {
        emitted_ray ray;
        if (!emission_ray(e, i, &ray) || !(ray.direction.z > cos(angle)))
            continue;
        const double t = (10.0 - ray.origin.z) / ray.direction.z;
        const vec3 off = vec3_cross(vec3_sub(vec3_make(0.0, 0.0, 10.0), ray.origin), ray.direction);
        assert_true(t > 0.0);
        if (vec3_length(off) <= b)
            power += ray.power.x;
    }
    const double expected = 2.0 * 9.0 * 2.0 * PI * (1.0 - cos(angle)) * b * b;
    if (!(fabs(power / expected - 1.0) < 0.02))
        fail_msg("%.6g instead of %.6g", power, expected);
    emission_end(e, p, s);
}

/* Photons of a lamp of lines know that they are; those of a continuous spectrum have any wavelength. */
static void photons_of_lines_are_marked(void **state)
{
    (void)state;
    static const char *const kinds[] = {"black_body", "mercury"};
    for (int lines = 0; lines < 2; lines++) {
        char text[512];
        scene *s;
        plan *p;
        snprintf(text, sizeof text,
                 "render: {caustics: photons, spectrum: spectral}\nlights: {lamp: {position: [0, 4, 0], intensity: 1, "
                 "reach: 1, spectrum: %s}}\nsolids: {b: {shape: sphere, transparency: 1, ior: 1.5}}\n",
                 kinds[lines]);
        emission *e = emission_of(text, false, &s, &p);
        for (int64_t i = 0; i < 100; i++) {
            emitted_ray ray;
            assert_true(emission_ray(e, i, &ray) && ray.wavelength >= 0);
            assert_int_equal(ray.of_line, lines);
        }
        emission_end(e, p, s);
    }
}

/* Glass balls about the lamp at the origin, apart from each other: the power of the photons whose rays meet each is the
 * ball's solid angle, and every ball is met. 64 have a cone each; more share one, which must hold them all, also where
 * one of them is so large that it holds others' bounds. */
static void every_ball_gets_its_solid_angle(void **state)
{
    (void)state;
    const struct {
        int balls;
        double first; /* radius of the first one */
        double tolerance;
    } cases[] = {{1, 0.3, 1e-3}, {12, 0.3, 0.01}, {64, 0.3, 0.02}, {80, 0.3, 0.4}, {80, 4.5, 0.4}};
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        const int count = cases[n].balls;
        vec3 at[BALLS_MAX];
        double radius[BALLS_MAX], power[BALLS_MAX] = {0.0};
        static char text[16384];
        int used = snprintf(text, sizeof text,
                            "render: {caustics: photons}\nlights: {lamp: {position: [0, 0, 0], "
                            "intensity: 2, reach: 3}}\nsolids:\n");
        for (int k = 0; k < count; k++) { /* in a slab ahead of the lamp, the first one behind them */
            at[k] = k == 0    ? vec3_make(0.0, 0.0, 12.0)
                    : k == 79 ? vec3_make(0.1, 0.0, 12.0) /* within the first one */
                              : vec3_make(k % 9 - 4.0, k / 9 - 4.0, 6.0);
            radius[k] = k == 0 ? cases[n].first : 0.3;
            used += snprintf(text + used, sizeof text - (size_t)used,
                             "  b%d: {shape: sphere, transparency: 1, ior: 1.5, radius: %g, position: [%g, %g, %g]}\n",
                             k, radius[k], at[k].x, at[k].y, at[k].z);
        }
        scene *s = scene_from(text);
        plan *p = NULL;
        emission *e = NULL;
        assert_int_equal(plan_build(s, &p, NULL), STATUS_OK);
        assert_int_equal(emission_create(p, PHOTONS, false, &e, NULL), STATUS_OK);
        assert_int_equal(emission_count(e), PHOTONS);
        for (int64_t i = 0; i < PHOTONS; i++) {
            emitted_ray ray;
            assert_true(emission_ray(e, i, &ray) && ray.power.x > 0.0 && ray.falls);
            for (int k = 0; k < count; k++) {
                const double along = vec3_dot(vec3_sub(at[k], ray.origin), ray.direction);
                const vec3 off = vec3_sub(vec3_add(ray.origin, vec3_scale(ray.direction, along)), at[k]);
                if (along > 0.0 && vec3_length(off) <= radius[k])
                    power[k] += ray.power.x;
            }
        }
        for (int k = 0; k < count; k++) {
            const double expected = 2.0 * 9.0 * solid_angle(radius[k], vec3_length(at[k]));
            if (!(fabs(power[k] / expected - 1.0) <= (radius[k] > 1.0 ? 0.03 : cases[n].tolerance)))
                fail_msg("%d balls: %.6g instead of %.6g for number %d", count, power[k], expected, k);
        }
        emission_destroy(e);
        plan_destroy(p);
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_ball_gets_its_solid_angle),
        cmocka_unit_test(photons_fill_the_cone_around_a_solid),
        cmocka_unit_test(dark_lamps_and_matte_solids_have_no_photons),
        cmocka_unit_test(rays_that_pass_two_balls_are_counted_once),
        cmocka_unit_test(photons_of_lines_are_marked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
