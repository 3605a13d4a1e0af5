/* Tests of polarised light on random paths. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "path_fixture.h"
#include "polarised_chain.h"
#include "sheet_fixture.h"

/* Polarised light on random paths: against the film of whole trees, whose rays test_polarised_film.c compares
 * with fields, and against closed forms of the textbooks: Brewster, the pile of plates, a white furnace, metals; and
 * by a rotation of everything about the optical axis. */

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

/* --- the whole tree, sampled at random --- */

/* Tilted glass, with total reflections, that is seen in mirrors and through a polariser and a wave plate of glass. */
static const char solids_scene[] =
    "render: {width: 32, height: 24, depth: 6, shadows: off, polarisation: \"on\", filter: centre, paths: 512}\n"
    "camera: {position: [0.3, 2.5, -5], target: [0, 1, 0], fov_deg: 40}\n"
    "background: {kind: gradient, color: [1, 0.2, 0.5], horizon: [0.1, 0.9, 0.4]}\n"
    "materials: {clear: {transparency: 1}}\n"
    "solids:\n"
    "  lake: {shape: plane, material: clear, ior: 1.33, priority: -1}\n"
    "  vessel: {shape: cup, material: clear, ior: 1.5, radius: 1, inner_radius: 0.9, height: 3, floor: 0.1, priority: "
    "2}\n"
    "  ball: {shape: sphere, material: clear, ior: 2.4, position: [0.2, 1.2, 0.1], radius: 0.5, priority: 3}\n"
    "  block: {shape: box, material: clear, ior: 1.6, position: [-1.5, 1.2, -1], size: [0.8, 1, 0.8], "
    "rotation: [10, 20, 30], priority: 5}\n"
    "  filter: {shape: box, transparency: 1, sheet: polariser, sheet_axis: [1, 2, 0], sheet_block: 0.1, ior: 1.4, "
    "position: [1.3, 1.6, -1], size: [0.9, 0.9, 0.1], rotation: [20, 30, 0], priority: 6}\n"
    "  plate: {shape: box, transparency: 1, sheet: retarder, retardance_deg: 70, ior: 1, position: [0.9, 1.2, -2], "
    "size: [0.9, 0.9, 0.1], priority: 7}\n"
    "  mirror: {shape: sphere, reflectivity: 0.9, position: [1.7, 0.5, -1], radius: 0.4, priority: 8}\n";

static void paths_have_the_mean_of_polarised_trees(void **state)
{
    (void)state;
    scene *s = scene_from(solids_scene);
    static const char *const settings[] = {"render.depth=6", "camera.analyser=linear camera.analyser_angle_deg=30",
                                           "camera.analyser_angle_deg=120 render.depth=10 render.roulette=on",
                                           "camera.analyser=circular_left render.sampler=philox render.beyond=black"};
    for (size_t k = 0; k < COUNT(settings); k++)
        expect_mean_of_trees(s, settings[k]);
    scene_destroy(s);
}

/* --- one surface --- */

/* Unpolarised light that glass reflects, behind an analyser at an angle a from s: (R_s cos^2 a + R_p sin^2 a) / 2. At
 * Brewster's angle it is fully polarised. */
static void an_analyser_sees_fresnels_reflectances(void **state)
{
    (void)state;
    static const double incidences[] = {0.3, 0.9, 0.98279372324732907 /* atan 1.5 */, 1.3};
    scene *s =
        scene_from("render: {width: 1, height: 1, depth: 1, beyond: black, polarisation: \"on\", integrator: path, "
                   "paths: 65536, sampler: philox}\n"
                   "camera: {position: [0, 9, 0], yaw_deg: 0, fov_deg: 0.001, analyser: linear}\n"
                   "background: {kind: gradient, color: [1, 1, 1], horizon: [0, 0, 0]}\n"
                   "solids: {glass: {shape: plane, transparency: 1, ior: 1.5}}\n");
    for (size_t i = 0; i < COUNT(incidences); i++) {
        const reflectances R = reflectances_at(incidences[i], 1.5);
        double most = 0.0, least = 1.0;
        for (int a = 0; a <= 90; a += 30) {
            const double angle = a * degree, sky = cos(incidences[i]);
            s->camera.pitch_deg = incidences[i] / degree - 90.0;
            s->camera.analyser_angle_deg = a;
            const estimate e = look_by_chance(s, 0);
            expect_estimate(e, 0.5 * (R.s * squared(cos(angle)) + R.p * squared(sin(angle))) * sky);
            most = fmax(most, e.value), least = fmin(least, e.value);
        }
        if (i == 2)
            assert_true((most - least) / (most + least) > 1.0 - 1e-9);
    }
    scene_destroy(s);
}

/* --- the pile of plates --- */

/* m plates transmit (1 - R) / (1 + (2 m - 1) R) of each polarisation, with all reflections (Stokes, Proc. R. Soc. 11,
 * 545, 1862; Hecht, 8.6); and the mean of both without a filter. */
static void a_pile_of_plates_obeys_stokes_formula(void **state)
{
    (void)state;
    enum { PLATES = 4 };
    const double incidence = 60.0 * degree;
    const reflectances R = reflectances_at(incidence, 1.5);
    scene *s = scene_from("render: {width: 1, height: 1, depth: 60, beyond: black, polarisation: \"on\", shadows: off, "
                          "integrator: path, paths: 65536}\n"
                          "camera: {position: [0, 0, -50], target: [0, 0, 0], fov_deg: 0.0001}\n"
                          "background: {color: [0, 0, 0]}\n"
                          "materials: {glass: {transparency: 1, ior: 1.5}}\n"
                          "solids:\n"
                          "  a: {shape: box, material: glass, size: [60, 60, 0.01], rotation: [60, 0, 0]}\n"
                          "  b: {shape: box, material: glass, size: [60, 60, 0.01], rotation: [60, 0, 0], "
                          "position: [0, 0, 0.1]}\n"
                          "  c: {shape: box, material: glass, size: [60, 60, 0.01], rotation: [60, 0, 0], "
                          "position: [0, 0, 0.2]}\n"
                          "  d: {shape: box, material: glass, size: [60, 60, 0.01], rotation: [60, 0, 0], "
                          "position: [0, 0, 0.3]}\n"
                          "  wall: {shape: box, emission: 1, size: [100, 100, 1], position: [0, 0, 60]}\n");
    for (int m = 1; m <= PLATES; m++) {
        for (int k = 0; k < PLATES; k++)
            s->solids[k].visible = k < m;
        const double by_s = (1.0 - R.s) / (1.0 + (2.0 * m - 1.0) * R.s),
                     by_p = (1.0 - R.p) / (1.0 + (2.0 * m - 1.0) * R.p);
        set(s, "camera.analyser=none");
        const estimate both = look_by_chance(s, 0);
        expect_estimate(both, 0.5 * (by_s + by_p));
        set_all(s, "camera.analyser=linear camera.analyser_angle_deg=0");
        const estimate across = look_by_chance(s, 0);
        expect_estimate(across, 0.5 * by_s);
        set(s, "camera.analyser_angle_deg=90");
        const estimate along = look_by_chance(s, 0);
        expect_estimate(along, 0.5 * by_p);
        print_message("%d plates: %.5f +- %.1e, expected %.5f; s %.5f, expected %.5f; p %.5f, expected %.5f\n", m,
                      both.value, both.standard_error, 0.5 * (by_s + by_p), across.value, 0.5 * by_s, along.value,
                      0.5 * by_p);
        assert_true(both.standard_error < 2e-3);
    }
    scene_destroy(s);
}

/* --- energy --- */

/* Under a white sky everything that absorbs nothing is white: clear, mirrors, matte, milky; half with a filter. */
static void every_pixel_of_a_white_furnace_is_white(void **state)
{
    (void)state;
    scene *s = scene_from(solids_scene);
    set_all(s, "background.kind=uniform background.color=1,1,1 filter.sheet=none mirror.reflectivity=0.5 "
               "mirror.diffuse=0.5 render.integrator=path render.paths=16");
    set_all(s, "vessel.scatter_per_m=0.7 ball.sheet=retarder ball.retardance_deg=33 block.roughness=0");
    for (int depth = 0; depth <= 20; depth += 5)
        for (int filter = 0; filter <= 1; filter++) {
            s->render.depth = depth;
            s->render.roulette = depth % 2;
            set(s, filter ? "camera.analyser=linear" : "camera.analyser=none");
            render_result *r = render(s);
            for (int i = 0; i < 32 * 24; i++)
                if (fabs(film_value(r->img, i % 32, i / 32, i % 3) - (filter ? 0.5 : 1.0)) > 1e-9)
                    fail_msg("depth %d, filter %d, pixel %d: %.12g", depth, filter, i,
                             film_value(r->img, i % 32, i / 32, i % 3));
            render_result_destroy(r);
        }
    scene_destroy(s);
}

/* --- metals --- */

/* The ray meets two mirrors of a metal with the same index at all wavelengths, each at 45 degrees; the second plane of
 * incidence is turned by 0 or 90 degrees against the first: (R_s^2 + R_p^2) / 2, or R_s R_p. Fresnel's formulas for a
 * complex index, Born and Wolf 14.2: tan(i) by (n cos i)^2 as there. */
static void two_metal_mirrors(void **state)
{
    (void)state;
    const double n = 0.8, k = 2.0, c = sqrt(0.5), c2 = 0.5;
    /* a^2 and b^2 of Born and Wolf, 14.2 (11) */
    const double x = n * n - k * k - 0.5, root = sqrt(x * x + squared(2.0 * n * k)), a2 = 0.5 * (root + x),
                 a = sqrt(a2);
    const double R_s = (root - 2.0 * a * c + c2) / (root + 2.0 * a * c + c2),
                 R_p = R_s * (root - 2.0 * a * c + 0.5) / (root + 2.0 * a * c + 0.5);
    for (int turned = 0; turned <= 1; turned++) {
        scene *s = scene_from("render: {width: 1, height: 1, depth: 2, beyond: black, polarisation: \"on\", "
                              "spectrum: spectral, integrator: path, paths: 65536}\n"
                              "camera: {position: [0, 0, 0], target: [0, 0, 1], fov_deg: 0.001}\n"
                              "background: {color: [1, 1, 1]}\n"
                              "solids:\n"
                              "  one: {shape: box, ior: 0.8, extinction: 2, size: [1, 1, 0.1], position: [0, 0, 5], "
                              "rotation: [0, 45, 0]}\n"
                              "  two: {shape: box, ior: 0.8, extinction: 2, size: [1, 1, 0.1]}\n");
        const vec3 first = mat3_apply(rotation_from_deg(vec3_make(0, 45, 0)), vec3_make(0.0, 0.0, 1.0));
        const double side = first.x > 0.0 ? -1.0 : 1.0; /* where the first mirror sends the ray */
        s->solids[1].shape.position = vec3_make(3.0 * side, 0.0, 5.0);
        s->solids[1].shape.rotation_deg = turned ? vec3_make(0.0, 90.0, 45.0) : vec3_make(0.0, 45.0, 0.0);
        const estimate e = look_by_chance(s, 1);
        print_message("mirrors %d: %.5f +- %.1e, expected %.5f\n", turned, e.value, e.standard_error,
                      turned ? R_s * R_p : 0.5 * (R_s * R_s + R_p * R_p));
        expect_estimate(e, turned ? R_s * R_p : 0.5 * (R_s * R_s + R_p * R_p));
        scene_destroy(s);
    }
}

/* Two panes with films on both faces, at 65 degrees, before a wall: the tree of all wavelengths, which test_layered.c
 * compares with the characteristic matrix. */
static void coated_panes_have_the_mean_of_the_tree(void **state)
{
    (void)state;
    static const char *const filters[] = {"camera.analyser=none", "camera.analyser=linear camera.analyser_angle_deg=90",
                                          "camera.analyser=linear camera.analyser_angle_deg=20"};
    scene *s = scene_from("render: {width: 1, height: 1, depth: 12, beyond: black, shadows: off, filter: centre, "
                          "spectrum: spectral, wavelengths: 400, paths: 65536}\n"
                          "camera: {position: [0, 0, -50], target: [0, 0, 0], fov_deg: 0.0001}\n"
                          "background: {color: [0, 0, 0]}\n"
                          "materials: {coated: {transparency: 1, ior: 1.5, film_ior: 2.2, film_thickness_nm: 130}}\n"
                          "solids:\n"
                          "  one: {shape: box, material: coated, size: [60, 60, 0.01], rotation: [65, 0, 0]}\n"
                          "  two: {shape: box, material: coated, size: [60, 60, 0.01], rotation: [65, 0, 0], "
                          "position: [0, 0, 0.1]}\n"
                          "  wall: {shape: box, emission: 1, size: [100, 100, 1], position: [0, 0, 60]}\n");
    const double unpolarised = look(s).y;
    set(s, "render.polarisation=on");
    assert_true(fabs(look(s).y - unpolarised) > 0.01);
    for (size_t k = 0; k < COUNT(filters); k++) {
        set_all(s, filters[k]);
        set(s, "render.integrator=whitted");
        const double tree = look(s).y;
        set(s, "render.integrator=path");
        const double chance = look(s).y, noise = 1.5e-3; /* as cuvette render reports it */
        print_message("%s: %.5f, tree %.5f\n", filters[k], chance, tree);
        assert_near(chance, tree, 4.0 * noise);
    }
    scene_destroy(s);
}

/* --- frames --- */

/* A glass block and a mirror, lit by a ball, with everything and the filter turned about the ray. */
static void turned_about_the_axis_it_is_the_same(void **state)
{
    (void)state;
    static const double turns[] = {0.0, 37.0, 90.0, 161.0, 250.0};
    for (int filter = 0; filter <= 1; filter++) {
        estimate first = {0}, other = {0};
        for (size_t k = 0; k < COUNT(turns); k++) {
            scene *s = scene_from(
                "render: {width: 1, height: 1, depth: 12, beyond: black, shadows: off, polarisation: \"on\", "
                "integrator: path, paths: 65536}\n"
                "camera: {position: [0, 0, -9], target: [0, 0, 0], fov_deg: 0.001}\n"
                "background: {color: [0, 0, 0]}\n"
                "solids:\n"
                "  pane: {shape: box, transparency: 1, ior: 1.8, size: [3, 3, 0.2], rotation: [0, 60, 0]}\n"
                "  block: {shape: box, transparency: 1, ior: 1.6, size: [1.3, 1, 1.7], rotation: [0, 35, 20], "
                "position: [0.2, 0.1, 3]}\n"
                "  lit: {shape: sphere, emission: 1, radius: 3, position: [-8.66, 0, 5]}\n"
                "  far: {shape: box, emission: 0.3, size: [40, 40, 1], position: [0, 0, 20]}\n");
            for (size_t i = 0; i < s->solid_count; i++) {
                solid_shape *shape = &s->solids[i].shape;
                shape->position = mat3_apply(rotation_from_deg(vec3_make(0.0, 0.0, turns[k])), shape->position);
                shape->rotation_deg.z += turns[k];
            }
            set(s, filter ? "camera.analyser=linear" : "camera.analyser=circular_left");
            s->camera.analyser_angle_deg = 20.0 + turns[k];
            const estimate e = look_by_chance(s, 0);
            print_message("turned by %g: %.6f +- %.1e\n", turns[k], e.value, e.standard_error);
            if (k == 0)
                first = e;
            else
                assert_near(e.value, first.value, 5.0 * hypot(e.standard_error, first.standard_error) + ROUNDINGS);
            if (k == 1 && filter) { /* not turned with it, the filter sees other light */
                set(s, "camera.analyser_angle_deg=20");
                other = look_by_chance(s, 0);
                assert_true(fabs(other.value - first.value) > 20.0 * hypot(other.standard_error, first.standard_error));
            }
            scene_destroy(s);
        }
        assert_true(first.value > 0.01);
    }
}

/* Polarisers and wave plates on random paths against closed forms (Hecht, Optics, 8.2 and 8.7), and of what
 * depolarises: matte surfaces, and media that scatter. */

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
        cmocka_unit_test(paths_have_the_mean_of_polarised_trees),
        cmocka_unit_test(an_analyser_sees_fresnels_reflectances),
        cmocka_unit_test(a_pile_of_plates_obeys_stokes_formula),
        cmocka_unit_test(every_pixel_of_a_white_furnace_is_white),
        cmocka_unit_test(two_metal_mirrors),
        cmocka_unit_test(coated_panes_have_the_mean_of_the_tree),
        cmocka_unit_test(turned_about_the_axis_it_is_the_same),
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
