/* Tests of emission: k_e times the surface's colour, with every integrator, and as a light source of random paths. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "path_fixture.h"
#include "scene/model/scene.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static const char patch[] = "render: {width: 1, height: 1, depth: 2, paths: 8}\n"
                            "camera: {position: [0.25, 4, 0.25], pitch_deg: -90, fov_deg: 1}\n"
                            "background: {color: [0, 0, 0], ambient: [0.5, 1, 2]}\n"
                            "solids: {ground: {shape: plane, color: [0.9, 0.6, 0.3], emission: 2.5}}\n";

static void expect_color(const scene *s, double r, double g, double b, double tolerance)
{
    const vec3 seen = look(s);
    assert_near(seen.x, r, tolerance);
    assert_near(seen.y, g, tolerance);
    assert_near(seen.z, b, tolerance);
}

static void every_integrator_renders_emission(void **state)
{
    (void)state;
    static const char *const settings[] = {
        "render.integrator=whitted", "render.integrator=raycast", "render.integrator=zbuffer", "render.integrator=path",
        "render.lighting=lambert",   "render.lighting=phong",     "render.polarisation=on",    "render.shadows=off"};
    for (size_t k = 0; k < sizeof settings / sizeof *settings; k++) {
        scene *s = scene_from(patch);
        set(s, settings[k]);
        expect_color(s, 2.5 * 0.9, 2.5 * 0.6, 2.5 * 0.3, 1e-10);
        set_all(s, "ground.checker=1 ground.checker_color=0.25,0.5,1 ground.position=1,0,0");
        expect_color(s, 2.5 * 0.25, 2.5 * 0.5, 2.5, 1e-10);
        scene_destroy(s);
    }
}

/* Emission adds to the ambient term and the lamp's; random paths have no ambient term. */
static void emission_adds_to_the_other_terms(void **state)
{
    (void)state;
    scene *s = scene_from(patch);
    set(s, "ground.ambient=0.1");
    expect_color(s, (2.5 + 0.05) * 0.9, (2.5 + 0.1) * 0.6, (2.5 + 0.2) * 0.3, 1e-12);
    set(s, "render.integrator=path");
    expect_color(s, 2.5 * 0.9, 2.5 * 0.6, 2.5 * 0.3, 1e-10);
    scene_destroy(s);
}

/* A clear solid with the surroundings' index, which otherwise has no surface: k_e C on entry, and t k_e C on exit. */
static void clear_solids_emit_at_any_index(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 3, beyond: black, paths: 64}\n"
                          "camera: {position: [0, 0, -4], target: [0, 0, 0], fov_deg: 0.1}\n"
                          "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
                          "solids: {slab: {shape: box, emission: 2, transparency: 0.5}}\n");
    expect_color(s, 3.0, 3.0, 3.0, 1e-12);
    set(s, "render.integrator=path");
    expect_color(s, 3.0, 3.0, 3.0, 1e-9);
    set(s, "render.integrator=zbuffer");
    expect_color(s, 3.0, 3.0, 3.0, 1e-12);
    set(s, "slab.emission=0");
    expect_color(s, 0.0, 0.0, 0.0, 0.0);
    scene_destroy(s);
}

/* A mirror reflects emission, glass transmits it: R + T = 1 between two equal emitting walls. */
static void mirrors_reflect_and_glass_transmits_emission(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 6, beyond: black, paths: 64, filter: centre}\n"
                          "camera: {position: [0, 3, -4], target: [0, 0, 0]}\n"
                          "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
                          "solids:\n  ground: {shape: plane, reflectivity: 0.5}\n"
                          "  wall: {shape: plane, position: [0, 0, 4], rotation: [-90, 0, 0], emission: 3}\n");
    expect_color(s, 1.5, 1.5, 1.5, 1e-12);
    set(s, "render.integrator=path");
    expect_color(s, 1.5, 1.5, 1.5, 1e-10);
    set_all(s, "render.integrator=whitted ground.reflectivity=0 ground.transparency=1 ground.ior=1.5 wall.priority=1");
    expect_color(s, 3.0, 3.0, 3.0, 1e-12); /* the wall continues below the water line */
    set(s, "ground.ior=1e6"); /* a transparent solid with such an index is a mirror, and emits in its colour too */
    set_all(s, "ground.emission=0.5 ground.color=1,0.5,0.25");
    expect_color(s, 3.5, 3.25, 3.125, 1e-12);
    set_all(s, "ground.ior=1.5 ground.emission=0 ground.color=1,1,1");
    set(s, "ground.emission=0.5"); /* a clear surface emits as well */
    expect_color(s, 3.5, 3.5, 3.5, 1e-12);
    set(s, "wall.visible=off");
    expect_color(s, 0.5, 0.5, 0.5, 1e-12);
    scene_destroy(s);
}

/* The furnace: walls of albedo a that emit e produce e (1 + a + a^2 + ..) = e / (1 - a) everywhere inside (Goral et
 * al., SIGGRAPH 1984). */
static const char box[] =
    "render: {width: 4, height: 3, depth: 7, beyond: black, integrator: path, paths: 32, roulette: off}\n"
    "camera: {position: [0.1, 0.2, -0.3], target: [0.7, 0, 1], fov_deg: 100}\n"
    "background: {color: [0, 0, 0], ambient: [1, 1, 1]}\n"
    "materials: {wall: {color: [1, 0.5, 0.25], diffuse: 0.6, ambient: 0.3, emission: 0.75}}\n"
    "solids:\n"
    "  low: {shape: box, material: wall, position: [0, -2, 0], size: [6, 2, 6]}\n  high: {shape: box, "
    "material: wall, position: [0, 2, 0], size: [6, 2, 6]}\n"
    "  left: {shape: box, material: wall, position: [-2, 0, 0], size: [2, 6, 6]}\n  right: {shape: box, "
    "material: wall, position: [2, 0, 0], size: [2, 6, 6]}\n"
    "  near: {shape: box, material: wall, position: [0, 0, -2], size: [6, 6, 2]}\n  far: {shape: box, "
    "material: wall, position: [0, 0, 2], size: [6, 6, 2]}\n";

static double geometric_sum(double first, double ratio, int terms)
{
    return first * (1.0 - pow(ratio, terms)) / (1.0 - ratio);
}

static void a_furnace_of_emitting_walls_has_its_geometric_sum(void **state)
{
    (void)state;
    static const double color[3] = {1.0, 0.5, 0.25};
    scene *s = scene_from(box);
    for (int depth = 0; depth <= 7; depth++) {
        s->render.depth = depth;
        render_result *r = render(s);
        for (int at = 0; at < 4 * 3; at++)
            for (int c = 0; c < 3; c++)
                assert_near((double)r->img->sum[at * 3 + c] / FILM_ONE,
                            geometric_sum(0.75 * color[c], 0.6 * color[c], depth + 1), 1e-8);
        render_result_destroy(r);
    }
    set_all(s, "render.depth=64 render.roulette=on render.paths=256 render.width=1 render.height=1");
    for (int c = 0; c < 3; c++)
        expect_estimate(look_by_chance(s, c), 0.75 * color[c] / (1.0 - 0.6 * color[c]));
    scene_destroy(s);
}

/* Spectral, with white walls: the same sum at each wavelength. */
static void a_spectral_furnace_has_its_geometric_sum(void **state)
{
    (void)state;
    scene *s = scene_from(box);
    set_all(s, "wall.color=1,1,1 render.spectrum=spectral render.paths=64 render.width=1 render.height=1");
    const double each = geometric_sum(0.75, 0.6, 8);
    expect_color(s, each, each, each, 1e-4);
    scene_destroy(s);
}

/* Under a disc of radius r at the height h, on its axis, irradiance is pi L r^2 / (r^2 + h^2) (Lambert's cosine law
 * over the disc; Modest, Radiative Heat Transfer, appendix D): a matte floor of albedo a reflects a L r^2 / (r^2 +
 * h^2). */
static void a_disc_lights_the_floor_by_the_closed_form(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 1, beyond: black, integrator: path, paths: 4096}\n"
                          "camera: {position: [0, 0.5, -3], target: [0, 0, 0], fov_deg: 1}\n"
                          "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
                          "solids:\n  floor: {shape: plane, diffuse: 0.8}\n"
                          "  disc: {shape: cylinder, position: [0, 1.5, 0], radius: 2, height: 0.1, emission: 5}\n");
    const estimate e = look_by_chance(s, 0);
    assert_true(e.standard_error > 0.0 && e.standard_error < 0.1);
    expect_estimate(e, 0.8 * 5.0 * 4.0 / (4.0 + 2.25));
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clear_solids_emit_at_any_index),
        cmocka_unit_test(every_integrator_renders_emission),
        cmocka_unit_test(emission_adds_to_the_other_terms),
        cmocka_unit_test(mirrors_reflect_and_glass_transmits_emission),
        cmocka_unit_test(a_furnace_of_emitting_walls_has_its_geometric_sum),
        cmocka_unit_test(a_spectral_furnace_has_its_geometric_sum),
        cmocka_unit_test(a_disc_lights_the_floor_by_the_closed_form),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
