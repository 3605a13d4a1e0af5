/* Tests of the noise that random paths report: over many seeds, the root mean square of the reported standard errors of
 * an image is that of its true errors; and both samplers and both filters have the same mean. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "render_fixture.h"
#include "scene/model/scene.h"
#include "whole.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
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
        cmocka_unit_test(the_reported_noise_is_the_true_error),
        cmocka_unit_test(samplers_have_the_same_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
