/* Tests of render.beyond, the fallback for branches that the depth limit cuts off: black, the sky in their direction,
 * or the sky's mean. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "path_fixture.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* A camera that looks down on a mirror, which reflects the zenith. */
static const char mirror[] = "render: {width: 1, height: 1, depth: 0, beyond: mean}\n"
                             "camera: {position: [0, 4, 0], pitch_deg: -90}\n"
                             "background: {kind: gradient, color: [0.9, 0.5, 0.1], horizon: [0.1, 0.3, 0.7]}\n"
                             "solids: {ground: {shape: plane, reflectivity: 0.8}}\n";

/* The mean of max(0, sin(elevation)) over the sphere is the integral of s ds / 2 from 0 to 1. */
static void expect_mean(const scene *s, double share, double tolerance)
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
    expect_mean(s, 0.8, 1e-12);
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
    expect_mean(s, 1.0, 1e-12);
    set(s, "render.polarisation=on");
    expect_mean(s, 1.0, 1e-12);
    scene_destroy(s);
}

static void cut_random_paths_add_the_mean_of_the_sky(void **state)
{
    (void)state;
    scene *s = scene_from(mirror);
    set_all(s, "render.integrator=path render.paths=16 render.roulette=off");
    expect_mean(s, 0.8, 1e-10);
    /* a matte ground scatters paths in all directions: the mean needs no random numbers */
    set_all(s, "ground.reflectivity=0 ground.diffuse=0.5");
    expect_mean(s, 0.5, 1e-10);
    scene_destroy(s);
}

/* The colour of the spectral film's mean is the rgb film's, up to the error of 256 wavelengths. */
static void spectral_films_add_the_mean_of_the_sky(void **state)
{
    (void)state;
    scene *s = scene_from(mirror);
    set_all(s, "render.spectrum=spectral render.wavelengths=256");
    expect_mean(s, 0.8, 2e-3);
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
        cmocka_unit_test(a_cut_branch_adds_the_mean_of_the_sky),
        cmocka_unit_test(reflected_and_transmitted_branches_add_the_mean_of_the_sky),
        cmocka_unit_test(cut_random_paths_add_the_mean_of_the_sky),
        cmocka_unit_test(spectral_films_add_the_mean_of_the_sky),
        cmocka_unit_test(the_fallback_changes_no_counter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
