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
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
