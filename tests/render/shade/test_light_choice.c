/* Tests of the choice of one light by random paths: the same mean as with all lights, no noise where the choice is by
 * exact proportion, one shadow ray per point, and the same film in a scene of one light. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "render_fixture.h"
#include "scene/model/scene.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
enum { SEEDS = 80, WIDTH = 8, HEIGHT = 6, VALUES = 3 * WIDTH * HEIGHT };

#define FRAME                                                                                \
    "render: {width: 8, height: 6, depth: 1, integrator: path, paths: 32, filter: centre}\n" \
    "camera: {position: [0, 2, -5], target: [0, 0.7, 0], fov_deg: 40}\nbackground: {color: [0, 0, 0]}\n"
#define SOLIDS                                                                                              \
    "solids:\n  floor: {shape: plane, color: [0.9, 0.6, 0.3], diffuse: 0.7, specular: 0.3, shininess: 9}\n" \
    "  stone: {shape: sphere, position: [0.8, 0.7, 0], radius: 0.7, diffuse: 0.8}\n"                        \
    "  pane: {shape: box, position: [-1, 1, 0], size: [0.5, 1, 0.5], transparency: 0.9, ior: 1.3, specular: 0.4}\n"

/* Points with and without falloff, spheres above, on and below the horizon of the floor, cones of either kind. */
static const char *const lights[] = {
    "lights:\n  a: {position: [3, 3, -2], intensity: 1}\n  b: {position: [-3, 2, -1], intensity: 0.6, reach: 2}\n"
    "  c: {position: [0, 1, -3], intensity: 0.1, color: [0.1, 1, 0.2]}\n",
    "lights:\n  a: {position: [3, 0.2, -2], intensity: 1, reach: 3, radius: 0.6}\n"
    "  b: {position: [-3, -0.1, 1], intensity: 2, reach: 2, radius: 0.5}\n"
    "  c: {position: [0, 4, -2], intensity: 1, reach: 2, radius: 1, color: [0, 0.5, 1]}\n",
    "lights:\n  a: {kind: cone, position: [0, 3, -2], target: [0.5, 0, 0], half_angle_deg: 20, intensity: 1}\n"
    "  b: {kind: soft_cone, position: [-2, 3, 0], target: [0, 0, 0], half_angle_deg: 50, intensity: 1}\n"
    "  c: {kind: cone, position: [2, 3, 0], target: [0, 0, 0], half_angle_deg: 40, intensity: 1, reach: 3, radius: "
    "0.3}\n"
    "  dark: {position: [0, 3, 0], intensity: 0}\n"};

static scene *scene_of(const char *lamps)
{
    char text[3000];
    snprintf(text, sizeof text, "%s%s%s", FRAME, lamps, SOLIDS);
    return scene_from(text);
}

static void add_seeds(scene *s, int first, double *mean, double *variance)
{
    double sum[VALUES] = {0}, squares[VALUES] = {0};
    for (int seed = 0; seed < SEEDS; seed++) {
        s->render.seed = first + seed;
        render_result *r = render(s);
        for (int i = 0; i < VALUES; i++) {
            const double v = (double)r->img->sum[i] / FILM_ONE;
            sum[i] += v, squares[i] += v * v;
        }
        render_result_destroy(r);
    }
    for (int i = 0; i < VALUES; i++) {
        mean[i] = sum[i] / SEEDS;
        variance[i] += (squares[i] - sum[i] * sum[i] / SEEDS) / (SEEDS - 1) / SEEDS;
    }
}

/* The mean square of the differences in units of their standard errors is 1; and the mean difference is 0. */
static void one_light_has_the_mean_of_all(void **state)
{
    (void)state;
    static const char *const films[] = {"render.sampler=philox", "render.sampler=sobol", "render.shadows=off",
                                        "render.spectrum=spectral render.sampler=philox"};
    for (size_t k = 0; k < COUNT(lights); k++)
        for (size_t f = 0; f < COUNT(films); f++) {
            double all[VALUES], one[VALUES], variance[VALUES] = {0}, squares = 0.0, off = 0.0, of_off = 0.0;
            int count = 0;
            scene *s = scene_of(lights[k]);
            set_all(s, films[f]);
            set(s, "render.light_sampling=all");
            add_seeds(s, 0, all, variance);
            set(s, "render.light_sampling=one");
            add_seeds(s, SEEDS, one, variance);
            for (int i = 0; i < VALUES; i++) {
                if (variance[i] < 1e-14) {
                    assert_true(fabs(all[i] - one[i]) < 1e-5);
                    continue;
                }
                count++;
                squares += (all[i] - one[i]) * (all[i] - one[i]) / variance[i];
                off += one[i] - all[i], of_off += variance[i];
            }
            print_message("lights %zu, %s: %d values, mean square %.2f, off by %.2f standard errors\n", k, films[f],
                          count, squares / count, off / sqrt(3.0 * of_off));
            assert_true(count > VALUES / 3 && squares / count < 1.8 && fabs(off) < 4.0 * sqrt(3.0 * of_off));
            scene_destroy(s);
        }
}

enum { LAMPS = 64 };

/* Lamps above a convex matte floor, the first half in one colour; returns the light of either half that its point below
 * the camera's axis reflects: k_d C / pi times the irradiance, here k_d I (N.L) reach^2 / d^2 by lamp. cones: the
 * lamps are spotlights, of which every second one shines upwards. */
static scene *many_lamps(const char *first, const char *second, int paths, bool cones, double expected[2])
{
    char text[16000];
    int at = snprintf(text, sizeof text,
                      "render: {width: 1, height: 1, depth: 0, integrator: path, paths: %d, beyond: black}\n"
                      "camera: {position: [0, 60, -80], target: [0, 0, 0], fov_deg: 0.00001}\n"
                      "background: {color: [0, 0, 0]}\nsolids: {floor: {shape: plane, diffuse: 0.7}}\nlights:\n",
                      paths);
    expected[0] = expected[1] = 0.0;
    for (int k = 0; k < LAMPS; k++) {
        const double x = k % 8 - 3.2, y = 1.0 + 0.1 * k, z = k / 8.0 - 2.0, strength = 0.01 + 0.001 * k;
        const bool upwards = cones && k % 2 == 1;
        const vec3 target = upwards ? vec3_make(x, 99.0, z) : vec3_make(0.0, 0.0, 0.0);
        at += snprintf(text + at, sizeof text - (size_t)at,
                       "  l%d: {kind: %s, position: [%.17g, %.17g, %.17g], target: [%.17g, %.17g, %.17g], "
                       "half_angle_deg: 30, intensity: %.17g, reach: 3, color: %s}\n",
                       k, cones ? "cone" : "point", x, y, z, target.x, target.y, target.z, strength,
                       k < LAMPS / 2 ? first : second);
        expected[k >= LAMPS / 2] += upwards ? 0.0 : 0.7 * strength * 9.0 * y / pow(x * x + y * y + z * z, 1.5);
    }
    return scene_from(text);
}

/* Each of white lamps is chosen in proportion to its light, and none that does not reach the point, so that every path
 * brings the sum. */
static void lamps_without_shadows_make_no_noise(void **state)
{
    (void)state;
    for (int cones = 0; cones < 2; cones++) {
        double expected[2];
        scene *s = many_lamps("[1, 1, 1]", "[1, 1, 1]", 16, cones, expected);
        render_result *r = render(s);
        const double seen = (double)r->img->sum[0] / FILM_ONE / (expected[0] + expected[1]);
        if (!(fabs(seen - 1.0) < 1e-6 && render_noise_rms(r) < 1e-6))
            fail_msg("%.9g +- %.2g of what is expected", seen, render_noise_rms(r));
        assert_true(!CUVETTE_COUNTERS || r->counters.shadow == 16);
        render_result_destroy(r);
        scene_destroy(s);
    }
}

/* Red and green lamps: the share of paths that choose a red one is its share of the light. The standard error of 4096
 * independent choices is 0.008 at most. */
static void each_lamp_is_chosen_in_proportion_to_its_light(void **state)
{
    (void)state;
    double expected[2];
    scene *s = many_lamps("[1, 0, 0]", "[0, 1, 0]", 4096, false, expected);
    render_result *r = render(s);
    for (int half = 0; half < 2; half++)
        assert_true(fabs((double)r->img->sum[half] / FILM_ONE - expected[half]) < 0.03 * (expected[0] + expected[1]));
    assert_true(expected[0] > 0.2 * expected[1] && expected[1] > 0.2 * expected[0]);
    render_result_destroy(r);
    scene_destroy(s);
}

static void the_film_of_one_light_is_the_same(void **state)
{
    (void)state;
    static const char *const lamps[] = {"lights: {a: {position: [3, 3, -2], intensity: 1, reach: 3, radius: 0.5}}\n",
                                        "lights: {a: {position: [3, 3, -2], intensity: 1}}\n"};
    for (size_t k = 0; k < COUNT(lamps); k++) {
        scene *s = scene_of(lamps[k]);
        uint64_t hash[2];
        for (int rule = LIGHT_SAMPLING_ALL; rule <= LIGHT_SAMPLING_ONE; rule++) {
            s->render.light_sampling = rule;
            render_result *r = render(s);
            hash[rule] = film_hash(r->img);
            render_result_destroy(r);
        }
        assert_true(hash[0] == hash[1]);
        scene_destroy(s);
    }
}

static void films_are_bit_identical_on_all_instruction_sets(void **state)
{
    (void)state;
    for (size_t k = 0; k < COUNT(lights); k++) {
        scene *s = scene_of(lights[k]);
        uint64_t expected = 0;
        for (int level = ISA_BASE; level <= (int)isa_best(); level++) {
            render_result *r = render_at(s, (isa)level, NULL);
            if (level == ISA_BASE)
                expected = film_hash(r->img);
            assert_true(film_hash(r->img) == expected);
            render_result_destroy(r);
        }
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_light_has_the_mean_of_all),
        cmocka_unit_test(lamps_without_shadows_make_no_noise),
        cmocka_unit_test(each_lamp_is_chosen_in_proportion_to_its_light),
        cmocka_unit_test(the_film_of_one_light_is_the_same),
        cmocka_unit_test(films_are_bit_identical_on_all_instruction_sets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
