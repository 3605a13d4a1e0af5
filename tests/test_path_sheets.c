/* Tests of polarisers and wave plates on random paths against closed forms (Hecht, Optics, 8.2 and 8.7), and of what
 * depolarises: matte surfaces, and media that scatter. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "path_fixture.h"
#include "sheet_fixture.h"

/* --- sheets; but for the last test nothing is random --- */

#define BY_CHANCE "render.integrator=path render.paths=4"

/* Malus: cos^2; and a third one between two that are crossed: cos^2 sin^2 (Hecht, Optics, 8.2). */
static void malus(void **state)
{
    (void)state;
    for (int a = -90; a <= 180; a += 15) {
        scene *s = behind_air(BY_CHANCE);
        add_sheet(s, 1.0, "sheet=polariser", 110.0, 0.0);
        add_sheet(s, 3.0, "sheet=polariser", 110.0 + a, 0.0);
        assert_all(s, 0.5 * squared(cos(a * degree)), 1e-9);
        set_all(s, "camera.analyser=linear camera.analyser_angle_deg=20"); /* crossed with the first */
        assert_all(s, 0.0, 1e-9);
        s->solids[0].shape.rotation_deg.z = 20.0 + a;
        s->solids[1].shape.rotation_deg.z = 110.0;
        assert_all(s, 0.5 * squared(cos(a * degree) * sin(a * degree)), 1e-9);
        scene_destroy(s);
    }
}

/* Crossed polarisers with a plate at an angle a: sin^2(2 a) sin^2(delta / 2) of the light behind the first; a half-wave
 * plate at 45 degrees passes all, a quarter-wave plate half (Hecht, 8.7). */
static void wave_plates_between_crossed_polarisers(void **state)
{
    (void)state;
    for (int a = -45; a <= 90; a += 15)
        for (int delta = 0; delta <= 360; delta += 45) {
            char plate[100];
            snprintf(plate, sizeof plate, "sheet=retarder retardance_deg=%d", delta);
            scene *s = crossed_with(plate, a);
            set_all(s, BY_CHANCE);
            assert_all(s, 0.5 * squared(sin(2.0 * a * degree) * sin(0.5 * delta * degree)), 1e-9);
            scene_destroy(s);
        }
}

/* A wave plate of glass, with its slow axis at 45 degrees, behind a circular filter and before a polariser: light of
 * the polariser becomes (1 +- sin delta) / 2 of each hand (Hecht, 8.7), times (1 - R)^2. */
static void a_glass_plate_makes_light_circular(void **state)
{
    (void)state;
    const double R = squared(0.5 / 2.5);
    for (int delta = 0; delta <= 180; delta += 45)
        for (int right = 0; right <= 1; right++) {
            char plate[100];
            snprintf(plate, sizeof plate, "sheet=retarder retardance_deg=%d ior=1.5", delta);
            scene *s = behind_air("render.integrator=path render.paths=4096 render.depth=2 render.beyond=black");
            set_all(s, "render.sampler=philox render.width=1 render.height=1");
            set(s, right ? "camera.analyser=circular_right" : "camera.analyser=circular_left");
            add_sheet(s, 2.0, plate, 45.0, 0.0);
            add_sheet(s, 3.0, "sheet=polariser", 0.0, 0.0); /* light meets it first */
            /* what the front reflects comes from the sky before it */
            expect_estimate(look_by_chance(s, 0),
                            0.5 * R + squared(1.0 - R) * 0.25 * (1.0 + (right ? -1.0 : 1.0) * sin(delta * degree)));
            scene_destroy(s);
        }
}

/* --- what depolarises --- */

/* A white matte floor under a lamp and a black sky. */
static const char floor_scene[] =
    "render: {width: 1, height: 1, depth: 0, integrator: path, paths: 8, filter: centre, beyond: black, "
    "polarisation: \"on\"}\n"
    "camera: {position: [0, 0.8, -0.6], target: [0, 0, 0], fov_deg: 0.001}\n"
    "background: {color: [0, 0, 0]}\n"
    "lights: {lamp: {position: [0.6, 4, 3.5], intensity: 1, reach: 2}}\n"
    "solids: {floor: {shape: plane, color: [1, 1, 1], diffuse: 1}}\n";

/* A polariser that covers it, with its axis along x. */
static void cover(scene *s)
{
    add_sheet(s, 0.0, "sheet=polariser", 0.0, 0.0);
    s->solids[1].shape.position = vec3_make(0.0, 1.5, 0.0);
    s->solids[1].shape.size = vec3_make(1e4, 0.01, 1e4);
}

/* The floor is lit through the polariser, and seen with an analyser at any angle. */
static void a_matte_surface_depolarises(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    const double bare = look(s).x;
    assert_true(bare > 0.01);
    cover(s);
    assert_near(look(s).x, 0.5 * bare, 1e-9);
    for (int angle = 0; angle < 180; angle += 30) {
        s->camera.analyser = ANALYSER_LINEAR;
        s->camera.analyser_angle_deg = angle;
        assert_near(look(s).x, 0.25 * bare, 1e-9);
    }
    scene_destroy(s);
}

/* And by a white sky: its paths go on unpolarised. */
static void paths_from_a_matte_surface_are_unpolarised(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    set_all(s, "background.color=1,1,1 lamp.intensity=0 render.paths=1024 render.depth=1 camera.analyser=linear");
    cover(s);
    for (int angle = 0; angle < 180; angle += 30) {
        s->camera.analyser_angle_deg = angle;
        assert_near(look(s).x, 0.25, 1e-4);
    }
    scene_destroy(s);
}

/* The camera in a ball of milky air with a polariser around it, under a white sky. What is not scattered obeys Malus,
 * the rest is unpolarised: e^-t cos^2 / 2 + (1 - e^-t) / 4. */
static void what_is_scattered_is_unpolarised(void **state)
{
    (void)state;
    const double thickness = 1.5;
    scene *s =
        scene_from("render: {width: 1, height: 1, depth: 64, integrator: path, paths: 16384, beyond: black, "
                   "polarisation: \"on\"}\n"
                   "camera: {position: [0, 0, 0], target: [0, 0, 1], fov_deg: 0.001, analyser: linear}\n"
                   "background: {color: [1, 1, 1]}\n"
                   "solids:\n"
                   "  air: {shape: sphere, radius: 5, transparency: 1, ior: 1, scatter_per_m: 0.3, priority: 1}\n"
                   "  filter: {shape: sphere, radius: 6, transparency: 1, ior: 1, sheet: polariser, "
                   "sheet_axis: [1, 0, 0]}\n");
    for (int angle = 0; angle < 180; angle += 30) {
        s->camera.analyser_angle_deg = angle;
        expect_estimate(look_by_chance(s, 0),
                        0.5 * exp(-thickness) * squared(cos(angle * degree)) + 0.25 * (1.0 - exp(-thickness)));
    }
    scene_destroy(s);
}

/* Milky air, of the surroundings' index, in front of the camera, and a lamp in it: sheets divide the light of all its
 * points, which the lamp samples along each ray, and of those where the ray's flight ends. */
static void sheets_act_on_what_is_lit_behind_them(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 0, integrator: path, paths: 4096, beyond: black, "
                          "polarisation: \"on\"}\n"
                          "camera: {position: [0, 0, 0], target: [0, 0, 1], fov_deg: 0.001}\n"
                          "background: {color: [0, 0, 0]}\n"
                          "lights: {lamp: {position: [0.7, 0, 5], intensity: 2, reach: 1}}\n");
    add_sheet(s, 12.0, "scatter_per_m=0.2", 0.0, 0.0);
    s->solids[0].shape.size = vec3_make(40.0, 40.0, 20.0);
    const double bare = look(s).x;
    assert_true(bare > 0.01);
    add_sheet(s, 1.0, "sheet=polariser sheet_pass=0.9 sheet_block=0.2", 0.0, 0.0);
    assert_near(look(s).x, 0.55 * bare, 1e-9);
    set(s, "render.polarisation=off");
    assert_near(look(s).x, 0.55 * bare, 1e-9);
    set_all(s, "render.polarisation=on sheet_2.sheet_pass=1 sheet_2.sheet_block=0");
    for (int a = 0; a <= 90; a += 30) {
        s->camera.analyser = ANALYSER_LINEAR;
        s->camera.analyser_angle_deg = a;
        assert_near(look(s).x, 0.5 * squared(cos(a * degree)) * bare, 1e-9);
    }
    set(s, "camera.analyser=none");
    /* two crossed ones within the medium, large and black: what is lit before them alone */
    for (int k = 0; k < 2; k++) {
        if (k)
            add_sheet(s, 4.01, "sheet=polariser", 90.0, 0.0);
        s->solids[1 + k].shape.position.z = 4.0 + 0.01 * k; /* they touch: no point between them is lit */
        s->solids[1 + k].shape.size = vec3_make(60.0, 60.0, 0.01);
        s->solids[1 + k].surface.sheet_pass = 1.0, s->solids[1 + k].surface.sheet_block = 0.0;
        s->solids[1 + k].priority = 1;
    }
    assert_near(look(s).x, 0.0, 1e-9); /* the lamp is behind them, too */
    set(s, "lamp.position=0.7,0,3");
    const double before = look(s).x;
    s->solids[1].surface.sheet = s->solids[2].surface.sheet = 0;
    s->solids[1].surface.absorb_per_m = vec3_make(1e6, 1e6, 1e6);
    assert_true(before > 0.01);
    assert_near(look(s).x, before, 1e-9);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(malus),
        cmocka_unit_test(wave_plates_between_crossed_polarisers),
        cmocka_unit_test(a_glass_plate_makes_light_circular),
        cmocka_unit_test(a_matte_surface_depolarises),
        cmocka_unit_test(paths_from_a_matte_surface_are_unpolarised),
        cmocka_unit_test(what_is_scattered_is_unpolarised),
        cmocka_unit_test(sheets_act_on_what_is_lit_behind_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
