/* Tests of the noise that random paths report, and of adaptive numbers of paths. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "render/frame/record.h"
#include "render/frame/renderer.h"
#include "render/plan/sampling.h"
#include "render_fixture.h"
#include "scene/model/scene.h"
#include "whole.h"
#include <stdlib.h>

/* Adaptive numbers of paths: the requested standard error, an unbiased mean, the same film for all threads and
 * instruction sets, the limits. */

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

/* A penumbra, a mirrored lamp, and light that paths find by chance in the mirror. */
static const char uneven[] =
    "render: {width: 24, height: 18, depth: 3, integrator: path, paths: 4096, error: 0.01}\n"
    "camera: {position: [0, 2, -5], target: [0, 0.7, 0], fov_deg: 40}\n"
    "background: {color: [0.1, 0.15, 0.2]}\n"
    "lights: {lamp: {position: [3, 5, -2], intensity: 1, reach: 5, radius: 2}}\n"
    "solids:\n"
    "  floor: {shape: plane, color: [0.9, 0.6, 0.3], diffuse: 0.7}\n"
    "  ball: {shape: sphere, position: [-0.8, 0.8, 0], radius: 0.7, diffuse: 0.5, reflectivity: 0.3}\n";

static void the_noise_is_what_was_requested(void **state)
{
    (void)state;
    static const char *const samplers[] = {"render.sampler=philox", "render.sampler=sobol"};
    for (size_t k = 0; k < COUNT(samplers); k++) {
        scene *s = scene_from(uneven);
        set_all(s, "ball.reflectivity=0");
        set(s, samplers[k]);
        double before = HUGE_VAL;
        for (double error = 0.008; error > 0.0015; error *= 0.5) {
            s->render.error = error;
            render_result *r = render(s);
            const double noise = render_noise_rms(r);
            print_message("%s: error %g, noise %.4g, %llu paths\n", samplers[k], error, noise,
                          (unsigned long long)r->counters.camera);
            assert_true(noise < 1.1 * error && noise > 0.3 * error && noise < before);
            assert_true(!CUVETTE_COUNTERS || r->counters.camera < (uint64_t)(24 * 18 * 2048));
            before = noise;
            render_result_destroy(r);
        }
        scene_destroy(s);
    }
}

/* The pilot's rays are among the frame's and its workers'; the error of a pixel is the root of the mean variance of its
 * channels. */
static void the_account_includes_the_pilot(void **state)
{
    (void)state;
    scene *s = scene_from(uneven);
    set_all(s, "render.error=0.004 render.threads=3 render.tile=4");
    render_result *r = render(s);
    uint64_t cameras = 0, shadow = 0, tiles = 0;
    for (int i = 0; i < r->worker_count; i++)
        cameras += r->workers[i].camera, shadow += r->workers[i].shadow, tiles += (uint64_t)r->workers[i].tiles;
    assert_int_equal(cameras, r->counters.camera);
    assert_int_equal(shadow, r->counters.shadow);
    assert_int_equal(tiles, 2 * (24 / 4) * (18 / 4 + 1));
    const size_t pixels = 24 * 18;
    double values[24 * 18];
    record_noise_values(r, values);
    for (size_t i = 0; i < pixels; i++) {
        const double *v = &r->variance[3 * i];
        assert_true(fabs(values[i] * values[i] * 3.0 - (v[0] + v[1] + v[2])) <= 1e-15);
    }
    render_result_destroy(r);
    scene_destroy(s);
}

/* Rare bright paths: a floor under a small bright emitter that paths find by chance. A pixel that stopped when its own
 * samples agree would stop while it has found none, and be too dark. The mean over seeds and pixels is that with a
 * fixed number, within four standard errors. */
static void the_mean_is_unbiased(void **state)
{
    (void)state;
    enum { SEEDS = 1000 };
    scene *s = scene_from("render: {width: 6, height: 6, depth: 1, integrator: path, beyond: black}\n"
                          "camera: {position: [0, 1, -0.01], target: [0, 0, 0], fov_deg: 30}\n"
                          "background: {color: [0, 0, 0]}\n"
                          "solids:\n  floor: {shape: plane, diffuse: 0.8}\n"
                          "  lamp: {shape: sphere, radius: 0.3, position: [1, 1.5, 0], emission: 10}\n");
    static const char *const settings[] = {"render.paths=1024 render.error=0", "render.paths=1024 render.error=0.1"};
    double mean[2] = {0.0, 0.0}, variance[2] = {0.0, 0.0};
    for (int k = 0; k < 2; k++) {
        double sum = 0.0, squares = 0.0;
        set_all(s, settings[k]);
        for (int seed = 0; seed < SEEDS; seed++) {
            double brightness = 0.0;
            s->render.seed = seed + k * SEEDS;
            render_result *r = render(s);
            for (int i = 0; i < 6 * 6; i++)
                brightness += (double)r->img->sum[3 * i] / FILM_ONE / 36.0;
            render_result_destroy(r);
            sum += brightness, squares += brightness * brightness;
        }
        mean[k] = sum / SEEDS, variance[k] = (squares / SEEDS - mean[k] * mean[k]) / SEEDS;
    }
    print_message("fixed %.6f +- %.2g, adaptive %.6f +- %.2g\n", mean[0], sqrt(variance[0]), mean[1],
                  sqrt(variance[1]));
    assert_true(sqrt(variance[1]) < 0.01 * mean[1]);
    assert_true(fabs(mean[0] - mean[1]) < 4.0 * sqrt(variance[0] + variance[1]));
    scene_destroy(s);
}

static void films_are_the_same_for_threads_and_instruction_sets(void **state)
{
    (void)state;
    scene *s = scene_from(uneven);
    set(s, "render.error=0.02");
    render_result *r = render(s);
    const uint64_t expected = film_hash(r->img);
    const ray_counters counters = r->counters;
    render_result_destroy(r);
    for (int threads = 1; threads <= 7; threads += 3)
        for (int level = ISA_BASE; level <= (int)isa_best(); level++) {
            s->render.threads = threads;
            s->render.tile = 5 * threads;
            r = render_at(s, (isa)level, NULL);
            assert_true(film_hash(r->img) == expected);
            assert_memory_equal(&r->counters, &counters, sizeof counters);
            render_result_destroy(r);
        }
    scene_destroy(s);
}

/* Without noise each pixel has the pilot's number; where the target is out of reach, render.paths; every count is a
 * multiple of the replicates. */
static void counts_are_within_their_limits(void **state)
{
    (void)state;
    static const int64_t limits[] = {17, 32, 36, 99, 100, 1024, 1000000};
    scene *s = scene_from(uneven);
    render_result *pilot = NULL;
    scene first = *s;
    first.render = path_counts_pilot(&s->render);
    pilot = render(&first);
    for (size_t k = 0; k < COUNT(limits); k++)
        for (int sampler = SAMPLER_PHILOX; sampler <= SAMPLER_SOBOL; sampler++)
            for (double error = 1e-6; error < 1e4; error *= 1e3) {
                uint32_t *counts = NULL, least = UINT32_MAX, most = 0;
                s->render.paths = limits[k], s->render.sampler = sampler, s->render.error = error;
                assert_int_equal(path_counts_create(&s->render, pilot, &counts, NULL), STATUS_OK);
                const uint32_t replicates = (uint32_t)path_sampling_of(&s->render).replicates;
                for (int i = 0; i < 24 * 18; i++) {
                    least = counts[i] < least ? counts[i] : least, most = counts[i] > most ? counts[i] : most;
                    assert_true(counts[i] % replicates == 0 && counts[i] <= limits[k]);
                }
                assert_true(least >= PILOT_PATHS && (error > 1e-5 || most == limits[k]));
                assert_true(error < 100.0 || most < 2 * PILOT_PATHS);
                free(counts);
            }
    render_result_destroy(pilot);
    scene_destroy(s);
}

/* The film is that of a fixed number where no pixel needs more than the least, or each needs the largest. */
static void the_limits_are_films_of_fixed_numbers(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {{"render.error=1000 render.paths=256", "render.error=0 render.paths=16"},
                                           {"render.error=1e-9 render.paths=64", "render.error=0 render.paths=64"},
                                           {"render.error=0.01 render.paths=16", "render.error=0 render.paths=16"}};
    for (size_t k = 0; k < COUNT(pairs); k++) {
        uint64_t hash[2];
        for (int i = 0; i < 2; i++) {
            scene *s = scene_from(uneven);
            set_all(s, "lamp.radius=0 background.kind=gradient");
            set_all(s, pairs[k][i]);
            render_result *r = render(s);
            hash[i] = film_hash(r->img);
            render_result_destroy(r);
            scene_destroy(s);
        }
        assert_true(hash[0] == hash[1]);
    }
}

static void unsupported_films_are_refused(void **state)
{
    (void)state;
    static const char *const settings[] = {"render.filter=centre", "render.spectrum=spectral"};
    for (size_t k = 0; k < COUNT(settings); k++) {
        diagnostic why = {0};
        scene *s = scene_from(uneven);
        set(s, settings[k]);
        assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
        assert_non_null(strstr(why.what, "render.error does not support"));
        set(s, "render.integrator=whitted");
        assert_int_equal(scene_check(s, &why), STATUS_OK);
        scene_destroy(s);
    }
}

/* The noise that random paths report: over many seeds, the root mean square of the reported standard errors of
 * an image is that of its true errors; and both samplers and both filters have the same mean. */

enum { SEEDS = 60, WIDTH = 12, HEIGHT = 9, VALUES = 3 * WIDTH * HEIGHT };

#define FRAME "render: {width: 12, height: 9, depth: 5, integrator: path, paths: 64}\n"
#define VIEW "camera: {position: [0, 2, -5], target: [0, 0.7, 0], fov_deg: 40}\n"
#define SKY "background: {kind: gradient, color: [1, 0.4, 0.2], horizon: [0.3, 0.5, 0.8]}\n"
#define LAMP "lights: {lamp: {position: [3, 5, -2], intensity: 1, reach: 5, radius: 1}}\n"
#define FLOOR "solids:\n  floor: {shape: plane, color: [0.9, 0.6, 0.3], diffuse: 0.7, checker: 0.4}\n"

/* A penumbra; glass; many small lamps; a mirror; and a furnace of emitting walls. */
static const char *const scenes[] = {
    FRAME VIEW SKY LAMP FLOOR "  stone: {shape: sphere, position: [0.8, 0.7, 0], radius: 0.7, diffuse: 0.8}\n",
    FRAME VIEW SKY "lights: {lamp: {position: [3, 5, -2], intensity: 1, reach: 5, radius: 0}}\n" FLOOR
                   "  ball: {shape: sphere, position: [-0.8, 0.8, 0], radius: 0.7, transparency: 1, ior: 1.5}\n",
    FRAME VIEW SKY "lights:\n  red: {position: [3, 3, -2], intensity: 1, reach: 3, radius: 0.5, color: [1, 0.2, 0.1]}\n"
                   "  blue: {position: [-3, 2, -1], intensity: 2, reach: 2, radius: 0.2, color: [0.1, 0.2, 1]}\n"
                   "  point: {position: [0, 6, 3], intensity: 0.3}\n" FLOOR
                   "  stone: {shape: box, position: [0.8, 0.7, 0], size: [1, 1.4, 1], diffuse: 0.8, specular: 0.2}\n",
    FRAME VIEW SKY "lights: {lamp: {position: [3, 5, -2], intensity: 1, reach: 5, radius: 3}}\n" FLOOR
                   "  mirror: {shape: sphere, position: [0, 0.9, 0], radius: 0.9, reflectivity: 0.5, diffuse: 0.4}\n",
    "render: {width: 12, height: 9, depth: 7, beyond: black, integrator: path, paths: 64, roulette: on}\n"
    "camera: {position: [0.1, 0.2, -0.3], target: [0.7, 0, 1], fov_deg: 100}\n"
    "background: {color: [0, 0, 0]}\n"
    "solids:\n"
    "  room: {shape: sphere, radius: 9, diffuse: 0.6}\n"
    "  hollow: {shape: sphere, radius: 3, transparency: 1, ior: 1, priority: 1}\n"
    "  lamp: {shape: sphere, radius: 0.5, position: [0.5, 1.5, 1.5], emission: 3, priority: 2}\n"};

typedef struct trial {
    double mean[VALUES], variance[VALUES]; /* over the seeds */
    double own, reported;                  /* mean over the image */
} trial;

static void try_seeds(scene *s, trial *out)
{
    double sum[VALUES] = {0}, squares[VALUES] = {0}, reported = 0.0, own = 0.0;
    for (int seed = 0; seed < SEEDS; seed++) {
        s->render.seed = seed;
        render_result *r = render(s);
        assert_non_null(r->variance);
        for (int i = 0; i < VALUES; i++) {
            const double v = (double)r->img->sum[i] / FILM_ONE;
            sum[i] += v, squares[i] += v * v;
        }
        const double noise = render_noise_rms(r);
        reported += noise * noise / SEEDS;
        render_result_destroy(r);
    }
    for (int i = 0; i < VALUES; i++) {
        out->mean[i] = sum[i] / SEEDS;
        out->variance[i] = (squares[i] - sum[i] * sum[i] / SEEDS) / (SEEDS - 1);
        own += out->variance[i] / VALUES;
    }
    out->own = sqrt(own), out->reported = sqrt(reported);
}

static void the_reported_noise_is_the_true_error(void **state)
{
    (void)state;
    static const char *const settings[] = {"render.sampler=philox render.filter=box",
                                           "render.sampler=philox render.filter=centre render.samples=4",
                                           "render.sampler=sobol render.filter=box",
                                           "render.sampler=sobol render.filter=centre render.samples=4",
                                           "render.sampler=sobol render.filter=box render.paths=36",
                                           "render.sampler=sobol render.filter=box render.spectrum=spectral"};
    for (size_t k = 0; k < COUNT(scenes); k++)
        for (size_t i = is_whole() ? 0 : k % 2; i < COUNT(settings); i += is_whole() ? 1 : 2) {
            trial t;
            scene *s = scene_from(scenes[k]);
            set_all(s, settings[i]);
            try_seeds(s, &t);
            print_message("scene %zu, %s: RMS error %.4g, reported %.4g, ratio %.3f\n", k, settings[i], t.own,
                          t.reported, t.reported / t.own);
            assert_true(fabs(t.reported / t.own - 1.0) < 0.1);
            scene_destroy(s);
        }
}

/* Differences of two means over the seeds, in units of their standard errors: 4 standard deviations of their mean
 * square, which is 1, allowing for values of one pixel that move together. */
static void samplers_have_the_same_mean(void **state)
{
    (void)state;
    for (size_t k = 0; k < COUNT(scenes); k++) {
        trial one, other;
        scene *s = scene_from(scenes[k]);
        set_all(s, "render.sampler=philox");
        try_seeds(s, &one);
        set_all(s, "render.sampler=sobol");
        try_seeds(s, &other);
        double squares = 0.0;
        int count = 0;
        for (int i = 0; i < VALUES; i++) {
            const double variance = (one.variance[i] + other.variance[i]) / SEEDS, off = one.mean[i] - other.mean[i];
            if (variance < 1e-12)
                continue;
            squares += off * off / variance;
            count++;
        }
        print_message("scene %zu: mean square of %d differences is %.2f; error of sobol %.2f of philox\n", k, count,
                      squares / count, other.own / one.own);
        assert_true(count > VALUES / 2 && squares / count < 1.0 + 4.0 * sqrt(2.0 * 3.0 / count));
        assert_true(other.own < 0.85 * one.own);
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_noise_is_what_was_requested),
        cmocka_unit_test(the_account_includes_the_pilot),
        cmocka_unit_test(the_mean_is_unbiased),
        cmocka_unit_test(films_are_the_same_for_threads_and_instruction_sets),
        cmocka_unit_test(counts_are_within_their_limits),
        cmocka_unit_test(the_limits_are_films_of_fixed_numbers),
        cmocka_unit_test(unsupported_films_are_refused),
        cmocka_unit_test(the_reported_noise_is_the_true_error),
        cmocka_unit_test(samplers_have_the_same_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
