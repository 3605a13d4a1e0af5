/* Tests of the end of paths: render.depth=unlimited, and render.beyond where the depth limit cuts a branch off. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "path_fixture.h"
#include "render/frame/tracers.h"
#include "render/inspect/beams.h"
#include "whole.h"

/* render.depth=unlimited: random paths go on until Russian roulette ends them, so that light which meets
 * hundreds of surfaces or is scattered hundreds of times arrives; beams without branches meet thousands of surfaces. */

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

/* Over all pixels and channels: within four standard errors, the pixels being independent, and this error a small part
 * of the value. */
static void expect_mean(const scene *s, double expected, double precision)
{
    render_result *r = render(s);
    const int count = 3 * r->img->width * r->img->height;
    double sum = 0.0, variance = 0.0;
    for (int i = 0; i < count; i++) {
        sum += (double)r->img->sum[i] / FILM_ONE;
        variance += r->variance[i];
    }
    /* the channels of one path are equal */
    const double mean = sum / count, error = sqrt(3.0 * variance) / count;
    printf("# %.6f +- %.6f, expected %.6f\n", mean, error, expected);
    assert_true(error < precision * expected);
    if (!(fabs(mean - expected) < 4.0 * error + 1e-9))
        fail_msg("%.6f +- %.6f instead of %.6f", mean, error, expected);
    render_result_destroy(r);
}

/* A thick slab that scatters evenly and absorbs nothing transmits 4/3 K(mu) / (t + 2 q) of the light along mu, with the
 * escape function K(mu) = sqrt(3) / 4 H(mu) and q = 0.710446 (van de Hulst, Multiple Light Scattering, 1980, 5.3.1; the
 * error falls as exp(-t)), H(1) = 2.907810 (Chandrasekhar, Radiative Transfer, 1960, table XI). By Helmholtz's
 * reciprocity that is the radiance straight below a slab under a white sky. */
static void milk_transmits_what_diffusion_says(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 8, height: 8, integrator: path, paths: 1024, depth: unlimited, beyond: "
                          "black}\nbackground: {kind: cie, sky_type: 5, color: [1, 1, 1], horizon: [0, 0, 0]}\n"
                          "camera: {position: [0, -60, 0.001], target: [0, -1, 0], projection: orthographic, "
                          "view_height: 0.001}\nsolids:\n  milk: {shape: box, size: [4000, 1, 4000], position: [0, "
                          "-0.5, 0], transparency: 1, ior: 1, scatter_per_m: 30}\n");
    for (int roulette = 0; roulette < 2; roulette++) {
        s->render.roulette = roulette;
        expect_mean(s, 4.0 / 3.0 * sqrt(3.0) / 4.0 * 2.907810 / (30.0 + 2.0 * 0.710446), 0.03);
    }
    /* light that passes a slab of 100 is scattered 5000 times: the weights of such paths must not vary too much */
    set(s, "milk.scatter_per_m=100");
    expect_mean(s, 4.0 / 3.0 * sqrt(3.0) / 4.0 * 2.907810 / (100.0 + 2.0 * 0.710446), 0.07);
    scene_destroy(s);
}

/* A closed room whose walls glow with 1 and reflect 0.99 is as bright as the whole series, 1 / (1 - 0.99). */
static void a_glowing_room_has_the_whole_series(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 8, height: 6, depth: unlimited, integrator: path, paths: 64, beyond: "
                          "black}\ncamera: {position: [0.5, 0.4, -0.3], target: [0, 0, 5], fov_deg: 90}\n"
                          "solids:\n  stone: {shape: sphere, radius: 4, diffuse: 0.99, emission: 1}\n"
                          "  hollow: {shape: sphere, radius: 2, transparency: 1, ior: 1, priority: 1}\n");
    expect_mean(s, 100.0, 0.05);
    set(s, "render.roulette=on");
    expect_mean(s, 100.0, 0.05);
    set(s, "stone.diffuse=0.9");
    expect_mean(s, 10.0, 0.03);
    scene_destroy(s);
}

/* Walls that reflect everything: a path ends, and no light appears or is lost. */
static void paths_that_lose_nothing_end(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 4, height: 3, depth: unlimited, integrator: path, paths: 16}\n"
                          "camera: {position: [0.5, 0.4, -0.3], target: [0, 0, 5], fov_deg: 90}\n"
                          "solids:\n  stone: {shape: sphere, radius: 4, reflectivity: 1}\n"
                          "  hollow: {shape: sphere, radius: 2, transparency: 1, ior: 1, priority: 1}\n");
    render_result *r = render(s);
    for (int i = 0; i < 4 * 3 * 3; i++)
        assert_true(r->img->sum[i] == 0);
    if (CUVETTE_COUNTERS) {
        assert_true(r->counters.cut_depth == 0);
        assert_true(r->counters.by_depth[COUNTERS_DEPTH_MAX] > 0);
    }
    render_result_destroy(r);
    scene_destroy(s);
}

/* Everything that absorbs nothing is white under a white sky, however long light stays inside. */
static void a_furnace_stays_white(void **state)
{
    (void)state;
    static const char *const variants[] = {"ball.scatter_per_m=30", "ball.scatter_per_m=30 ball.ior=1.5",
                                           "ball.scatter_per_m=0 ball.ior=2.4", "render.roulette=on ball.ior=1.5",
                                           "render.radiance=basic"};
    scene *s = scene_from("render: {width: 12, height: 9, depth: unlimited, integrator: path, paths: 64}\n"
                          "camera: {position: [0, 0, 4], target: [0, 0, 0], fov_deg: 30}\n"
                          "background: {color: [1, 1, 1]}\n"
                          "solids:\n  ball: {shape: sphere, transparency: 1, ior: 1}\n");
    for (size_t i = 0; i < (is_whole() ? COUNT(variants) : 3); i++) {
        set_all(s, variants[i]);
        render_result *r = render(s);
        double sum = 0.0;
        for (int k = 0; k < 12 * 9 * 3; k++)
            sum += (double)r->img->sum[k] / FILM_ONE;
        if (!(fabs(sum / (12 * 9 * 3) - 1.0) < 1e-3))
            fail_msg("%s: %.6f", variants[i], sum / (12 * 9 * 3));
        render_result_destroy(r);
    }
    scene_destroy(s);
}

/* Without a limit only those pixels have other values of which a path was cut. */
static void paths_that_are_not_cut_stay_the_same(void **state)
{
    (void)state;
    scene *s = rod_scene("render.width=24 render.height=18 render.integrator=path render.paths=8 render.depth=64 "
                         "render.beyond=black rod.diffuse=0.3");
    render_result *limited = render(s);
    set(s, "render.depth=unlimited");
    render_result *unlimited = render(s);
    uint64_t changed = 0;
    for (int i = 0; i < 24 * 18; i++) {
        changed += limited->img->sum[3 * i] != unlimited->img->sum[3 * i];
        assert_true(limited->img->sum[3 * i] <= unlimited->img->sum[3 * i]);
    }
    if (CUVETTE_COUNTERS)
        assert_true(changed > 0 && changed <= limited->counters.cut_depth);
    render_result_destroy(limited);
    render_result_destroy(unlimited);
    scene_destroy(s);
}

static void films_are_the_same_for_any_threads(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 20, height: 15, integrator: path, paths: 32, depth: unlimited, sampler: "
                          "sobol}\nbackground: {color: [0.3, 0.5, 0.7]}\n"
                          "camera: {position: [0, 0, 4], target: [0, 0, 0], fov_deg: 30}\n"
                          "lights: {lamp: {position: [3, 3, 3], reach: 3}}\n"
                          "solids: {ball: {shape: sphere, transparency: 1, ior: 1.4, scatter_per_m: 60}}\n");
    uint64_t hash[4];
    uint64_t rays[4];
    for (int i = 0; i < 4; i++) {
        s->render.threads = 1 + i % 3;
        s->render.tile = i < 3 ? 32 : 3;
        render_result *r = render(s);
        hash[i] = film_hash(r->img);
        rays[i] = ray_counters_total(&r->counters);
        assert_true(hash[i] == hash[0] && rays[i] == rays[0]);
        render_result_destroy(r);
    }
    set(s, "render.sampler=philox");
    for (int i = 0; i < 2; i++) {
        s->render.threads = 1 + i;
        render_result *r = render(s);
        hash[i] = film_hash(r->img);
        assert_true(hash[i] == hash[0]);
        render_result_destroy(r);
    }
    scene_destroy(s);
}

/* Rays that wait take no more memory than a bounded number of queues. */
static void memory_is_bounded(void **state)
{
    (void)state;
    assert_true(tracer_bytes(DEPTH_UNLIMITED, false, false) == tracer_bytes(DEPTH_TREE_MAX + 1, false, false));
    assert_true(tracer_bytes(DEPTH_UNLIMITED, false, false) < 2 * tracer_bytes(DEPTH_TREE_MAX, false, false));
}

/* --- beams --- */

typedef struct longest {
    size_t nodes;
    ray_end last;
} longest;

static status keep_longest(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    longest *l = context;
    (void)ray, (void)p, (void)why;
    if (tree->count > l->nodes) {
        l->nodes = tree->count;
        l->last = tree->node[tree->count - 1].end;
    }
    return STATUS_OK;
}

/* In a plate of thickness 1 and length 1000, light of a slope of 0.8 is totally reflected, at 51 degrees, once every
 * 1.25 units of length; it leaves by the far end, at 39 degrees. */
static void a_beam_in_a_long_plate_is_reflected_hundreds_of_times(void **state)
{
    (void)state;
    diagnostic why = {0};
    scene *s = scene_from("solids:\n  plate: {shape: box, size: [1000, 1, 4], position: [500, 0, 0], transparency: 1, "
                          "ior: 1.5}\nbeams:\n  laser: {position: [0.2, 0, 0], target: [1.2, 0.8, 0], branches: off, "
                          "depth: 4000, min_fraction: 0}\n");
    longest l = {.nodes = 0};
    worked(beams_each_ray(s, isa_best(), 0, keep_longest, &l, &why), &why);
    printf("# %zu segments\n", l.nodes);
    assert_true(l.nodes > 798 && l.nodes < 805 && l.last == RAY_END_SKY);
    set(s, "laser.depth=100");
    l.nodes = 0;
    worked(beams_each_ray(s, isa_best(), 0, keep_longest, &l, &why), &why);
    assert_true(l.nodes == 102 && l.last == RAY_END_CUT_DEPTH);
    set(s, "laser.branches=on");
    assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
    set(s, "laser.depth=64");
    assert_int_equal(scene_check(s, &why), STATUS_OK);
    scene_destroy(s);
}

/* --- input --- */

static void only_random_paths_are_unlimited(void **state)
{
    (void)state;
    diagnostic why = {0};
    scene *s = scene_from("render: {integrator: path, depth: unlimited}\n");
    char *text = NULL;
    worked(scene_get(s, "render.depth", &text, &why), &why);
    assert_string_equal(text, "unlimited");
    free(text);
    assert_int_equal(scene_check(s, &why), STATUS_OK);
    set(s, "render.integrator=whitted");
    assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
    assert_int_equal(scene_set_assignment(s, "render.depth=65", &why), STATUS_BAD_INPUT);
    assert_int_equal(scene_set_assignment(s, "render.depth=1073741824", &why), STATUS_BAD_INPUT);
    scene_destroy(s);
}

/* render.beyond, the fallback for branches that the depth limit cuts off: black, the sky in their direction,
 * or the sky's mean. */

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* A camera that looks down on a mirror, which reflects the zenith. */
static const char mirror[] = "render: {width: 1, height: 1, depth: 0, beyond: mean}\n"
                             "camera: {position: [0, 4, 0], pitch_deg: -90}\n"
                             "background: {kind: gradient, color: [0.9, 0.5, 0.1], horizon: [0.1, 0.3, 0.7]}\n"
                             "solids: {ground: {shape: plane, reflectivity: 0.8}}\n";

/* The mean of max(0, sin(elevation)) over the sphere is the integral of s ds / 2 from 0 to 1. */
static void expect_mean_of_sky(const scene *s, double share, double tolerance)
{
    const vec3 seen = look(s);
    assert_near(seen.x, share * (0.25 * 0.9 + 0.75 * 0.1), tolerance);
    assert_near(seen.y, share * (0.25 * 0.5 + 0.75 * 0.3), tolerance);
    assert_near(seen.z, share * (0.25 * 0.1 + 0.75 * 0.7), tolerance);
}

static void a_cut_branch_adds_the_mean_of_the_sky(void **state)
{
    (void)state;
    scene *s = scene_from(mirror);
    expect_mean_of_sky(s, 0.8, 1e-12);
    set(s, "render.beyond=sky");
    assert_near(look(s).x, 0.8 * 0.9, 1e-12);
    set_all(s, "render.beyond=mean render.depth=1"); /* now the branch is followed, into the zenith */
    assert_near(look(s).x, 0.8 * 0.9, 1e-12);
    set_all(s, "render.depth=0 background.kind=uniform");
    assert_near(look(s).z, 0.8 * 0.1, 1e-12);
    scene_destroy(s);
}

/* Both branches of a clear surface are cut: R + T = 1 of the mean, polarised or not. */
static void reflected_and_transmitted_branches_add_the_mean_of_the_sky(void **state)
{
    (void)state;
    scene *s = scene_from(mirror);
    set_all(s, "ground.transparency=1 ground.ior=1.5");
    expect_mean_of_sky(s, 1.0, 1e-12);
    set(s, "render.polarisation=on");
    expect_mean_of_sky(s, 1.0, 1e-12);
    scene_destroy(s);
}

static void cut_random_paths_add_the_mean_of_the_sky(void **state)
{
    (void)state;
    scene *s = scene_from(mirror);
    set_all(s, "render.integrator=path render.paths=16 render.roulette=off");
    expect_mean_of_sky(s, 0.8, 1e-10);
    /* a matte ground scatters paths in all directions: the mean needs no random numbers */
    set_all(s, "ground.reflectivity=0 ground.diffuse=0.5");
    expect_mean_of_sky(s, 0.5, 1e-10);
    scene_destroy(s);
}

/* The colour of the spectral film's mean is the rgb film's, up to the error of 256 wavelengths. */
static void spectral_films_add_the_mean_of_the_sky(void **state)
{
    (void)state;
    scene *s = scene_from(mirror);
    set_all(s, "render.spectrum=spectral render.wavelengths=256");
    expect_mean_of_sky(s, 0.8, 2e-3);
    scene_destroy(s);
}

static void the_fallback_changes_no_counter(void **state)
{
    (void)state;
    need_counters();
    static const char *const integrators[] = {"whitted", "path"};
    for (int i = 0; i < 2; i++) {
        char setting[64];
        snprintf(setting, sizeof setting, "render.integrator=%s", integrators[i]);
        scene *s = rod_scene("render.width=40 render.height=30 render.depth=3 render.paths=8 background.kind=gradient");
        set(s, setting);
        render_result *sky = render(s);
        set(s, "render.beyond=mean");
        render_result *mean = render(s);
        assert_true(sky->counters.cut_depth > 0);
        assert_int_equal(sky->counters.cut_depth, mean->counters.cut_depth);
        for (int c = 0; c < 3; c++)
            assert_int_equal(sky->counters.cut_depth_throughput[c], mean->counters.cut_depth_throughput[c]);
        assert_true(film_hash(sky->img) != film_hash(mean->img));
        render_result_destroy(sky);
        render_result_destroy(mean);
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(milk_transmits_what_diffusion_says),
        cmocka_unit_test(a_glowing_room_has_the_whole_series),
        cmocka_unit_test(paths_that_lose_nothing_end),
        cmocka_unit_test(a_furnace_stays_white),
        cmocka_unit_test(paths_that_are_not_cut_stay_the_same),
        cmocka_unit_test(films_are_the_same_for_any_threads),
        cmocka_unit_test(memory_is_bounded),
        cmocka_unit_test(a_beam_in_a_long_plate_is_reflected_hundreds_of_times),
        cmocka_unit_test(only_random_paths_are_unlimited),
        cmocka_unit_test(a_cut_branch_adds_the_mean_of_the_sky),
        cmocka_unit_test(reflected_and_transmitted_branches_add_the_mean_of_the_sky),
        cmocka_unit_test(cut_random_paths_add_the_mean_of_the_sky),
        cmocka_unit_test(spectral_films_add_the_mean_of_the_sky),
        cmocka_unit_test(the_fallback_changes_no_counter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
