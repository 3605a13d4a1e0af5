/* Tests of absorbing surroundings (Beer and Lambert: Hecht, 4.8.1, eq. 4.79): exp(-a d) over the whole path from the
 * camera, through mirrors, to the light source, as far as it is outside all solids; but not on a path to the sky. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "probe_fixture.h"
#include "scene/model/scene.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* The camera is 5 units from the origin of a matte floor, and so is the lamp; N.L = 0.8. Solids above the floor are in
 * one of the two paths. */
static const char floor_scene[] =
    "render: {width: 1, height: 1, depth: 4}\n"
    "camera: {position: [0, 3, -4], target: [0, 0, 0], fov_deg: 1}\n"
    "background: {color: [0, 0, 0], ambient: [0, 0, 0], absorb_per_m: [0.1, 0, 0.3]}\n"
    "lights: {lamp: {position: [3, 4, 0]}}\n"
    "solids:\n"
    "  floor: {shape: plane, diffuse: 1}\n"
    "  slab: {shape: box, size: [90, 0.6, 90], position: [0, 1.2, 0], transparency: 1, visible: off}\n";
static const double a_per_m[3] = {0.1, 0.0, 0.3};

static void expect(vec3 seen, double full, double length)
{
    assert_near(seen.x, full * exp(-a_per_m[0] * length), 1e-12);
    assert_near(seen.y, full * exp(-a_per_m[1] * length), 1e-12);
    assert_near(seen.z, full * exp(-a_per_m[2] * length), 1e-12);
}

static void paths_to_the_camera_and_to_the_light_are_both_attenuated(void **state)
{
    (void)state;
    static const double distances[] = {0.5, 1.0, 5.0, 20.0, 100.0};
    scene *s = scene_from(floor_scene);
    for (size_t i = 0; i < COUNT(distances); i++)
        for (size_t k = 0; k < COUNT(distances); k++) {
            const double eye = distances[i], lamp = distances[k];
            s->camera.position = vec3_make(0.0, 0.6 * eye, -0.8 * eye);
            s->lights[0].position = vec3_make(0.6 * lamp, 0.8 * lamp, 0.0);
            for (int path = 0; path <= 1; path++) {
                s->render.filter = PIXEL_FILTER_CENTRE;
                s->render.integrator = path ? INTEGRATOR_PATH : INTEGRATOR_WHITTED;
                expect(look(s), 0.8, eye + lamp);
            }
            s->render.integrator = INTEGRATOR_WHITTED;
        }
    scene_destroy(s);
}

static void the_scene_sets_the_length_of_a_unit(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    set(s, "render.unit_m=0.02");
    expect(look(s), 0.8, 0.2);
    scene_destroy(s);
}

/* Other shadow modes: without shadow rays no path to the light; opaque shadows, all of it. */
static void without_shadow_rays_the_path_to_the_light_is_not_absorbed(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    set(s, "render.shadows=off");
    expect(look(s), 0.8, 5.0);
    set(s, "render.shadows=opaque");
    expect(look(s), 0.8, 10.0);
    scene_destroy(s);
}

/* A clear slab, 0.6 thick, is not part of the surroundings: 0.6 / 0.6 = 1 unit of the view path, 0.6 / 0.8 = 0.75 of
 * the lamp's. With index 1 it does not refract, and has its own absorption. */
static void the_inside_of_solids_is_not_part_of_the_surroundings(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    set(s, "slab.visible=on");
    expect(look(s), 0.8, 10.0 - 1.0 - 0.75);
    set(s, "render.spectrum=spectral");
    set(s, "background.absorb_per_m=0.1,0.1,0.1");
    const double dimmed = look(s).y;
    set(s, "background.absorb_per_m=0,0,0");
    assert_near(dimmed, look(s).y * exp(-0.1 * 8.25), 1e-11); /* the same at every wavelength */
    set_all(s, "render.spectrum=rgb background.absorb_per_m=0.1,0,0.3 slab.absorb_per_m=0,2,0");
    assert_near(look(s).x, 0.8 * exp(-0.1 * 8.25), 1e-12);
    assert_near(look(s).y, 0.8 * exp(-2.0 * 1.75), 1e-12);
    set(s, "slab.transparency=0"); /* opaque: visible itself, and black */
    assert_true(look(s).x == 0.0);
    set_all(s, "slab.size=2,0.6,90 slab.position=2,1.2,0"); /* only in the lamp's path */
    assert_true(look(s).x == 0.0);
    scene_destroy(s);
}

/* Between the channels' wavelengths (611.4, 549.1 and 464.3 nm) the coefficient is linear, like a material's
 * absorb_per_m: a slab of that medium around everything gives the same film. */
static void a_spectral_film_uses_the_coefficient_by_wavelength(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    set(s, "render.spectrum=spectral");
    const vec3 seen = look(s);
    set_all(s, "background.absorb_per_m=0,0,0 slab.visible=on slab.size=90,90,90 slab.position=0,44,0 "
               "slab.absorb_per_m=0.1,0,0.3 floor.priority=1");
    const vec3 expected = look(s);
    assert_true(seen.x > 0.05);
    assert_near(seen.x, expected.x, 1e-11);
    assert_near(seen.y, expected.y, 1e-11);
    assert_near(seen.z, expected.z, 1e-11);
    scene_destroy(s);
}

static void the_sky_is_not_attenuated(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    set_all(s, "background.color=1,1,1 floor.diffuse=0 floor.visible=off");
    expect(look(s), 1.0, 0.0);
    /* The path to the mirror counts, but not the path from it to the sky. */
    set_all(s, "floor.visible=on floor.reflectivity=0.5");
    expect(look(s), 0.5, 5.0);
    set(s, "render.depth=0"); /* nor at the depth limit */
    expect(look(s), 0.5, 5.0);
    /* The slab of index 1 is left twice: no interface, no loss of light at it. */
    set_all(s, "render.depth=4 slab.visible=on");
    expect(look(s), 0.5, 4.0);
    scene_destroy(s);
}

/* From the camera by the floor, a mirror, to a matte wall and to the lamp: exp(-a R) along the reflected path. */
static void the_reflected_path_is_attenuated_too(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 1}\n"
                          "camera: {position: [0, 3, -4], target: [0, 0, 0], fov_deg: 1}\n"
                          "background: {color: [0, 0, 0], ambient: [0, 0, 0], absorb_per_m: [0.1, 0, 0.3]}\n"
                          "lights: {lamp: {position: [0, 6, 2]}}\n"
                          "solids:\n  floor: {shape: plane, reflectivity: 0.5}\n"
                          "  wall: {shape: plane, position: [0, 0, 8], rotation: [-90, 0, 0], diffuse: 1}\n");
    expect(look(s), 0.5, 5.0 + 10.0 + 6.0); /* the wall is hit at (0, 6, 8), straight in front of the lamp */
    set(s, "wall.diffuse=0");
    set(s, "wall.ambient=1");
    set(s, "background.ambient=1,1,1");
    expect(look(s), 0.5, 15.0);
    scene_destroy(s);
}

/* Through a clear slab across the path: before it, and behind it to an emitting wall. */
static void the_refracted_path_is_attenuated_too(void **state)
{
    (void)state;
    stage g = stage_of("render: {width: 1, height: 1, depth: 2, beyond: black}\n"
                       "background: {color: [0, 0, 0], ambient: [1, 1, 1], absorb_per_m: [0.1, 0, 0.3]}\n"
                       "solids:\n  pane: {shape: box, size: [9, 9, 2], transparency: 1, ior: 1.5}\n"
                       "  wall: {shape: plane, position: [0, 0, 8], rotation: [-90, 0, 0], ambient: 1}\n",
                       "");
    const ray_tree *tree = stage_way(&g, vec3_make(0.0, 0.0, -4.0), vec3_make(0.0, 0.0, 1.0), -1);
    const double T2 = 0.96 * 0.96;
    assert_int_equal(tree->count, 3);
    expect(vec3_make(tree->radiance[0], tree->radiance[1], tree->radiance[2]), T2, 3.0 + 7.0);
    for (int c = 0; c < 3; c++) {
        assert_near(tree->node[0].hit.transmittance[c], exp(-3.0 * a_per_m[c]), 1e-12);
        assert_true(tree->node[1].hit.transmittance[c] == 1.0);
        assert_near(tree->node[2].hit.transmittance[c], exp(-7.0 * a_per_m[c]), 1e-12);
    }
    stage_close(&g);
}

/* A light sphere seen by random paths: 5 units away minus its radius. */
static void the_path_to_a_visible_light_is_attenuated(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    set_all(s, "render.integrator=path render.filter=centre camera.position=0,0.1,0 camera.target=3,4.1,0 "
               "lamp.position=3,4.1,0 "
               "lamp.radius=0.5 lamp.reach=1");
    expect(look(s), 4.0, 4.5);
    scene_destroy(s);
}

/* The probe at one wavelength uses the surroundings' coefficient at that wavelength. */
static void the_probe_uses_the_coefficient_at_its_wavelength(void **state)
{
    (void)state;
    stage g =
        stage_of(floor_scene, "render.spectrum=spectral render.lambda_nm=580.25"); /* half way from 549.1 to 611.4 */
    const ray_tree *tree = stage_ray(&g, vec3_make(0.0, 3.0, -4.0), vec3_make(0.0, -0.6, 0.8));
    for (int c = 0; c < 3; c++)
        assert_near(tree->radiance[c], 0.8 * exp(-0.05 * 10.0), 1e-12);
    stage_close(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paths_to_the_camera_and_to_the_light_are_both_attenuated),
        cmocka_unit_test(the_scene_sets_the_length_of_a_unit),
        cmocka_unit_test(without_shadow_rays_the_path_to_the_light_is_not_absorbed),
        cmocka_unit_test(the_inside_of_solids_is_not_part_of_the_surroundings),
        cmocka_unit_test(a_spectral_film_uses_the_coefficient_by_wavelength),
        cmocka_unit_test(the_sky_is_not_attenuated),
        cmocka_unit_test(the_reflected_path_is_attenuated_too),
        cmocka_unit_test(the_refracted_path_is_attenuated_too),
        cmocka_unit_test(the_path_to_a_visible_light_is_attenuated),
        cmocka_unit_test(the_probe_uses_the_coefficient_at_its_wavelength),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
