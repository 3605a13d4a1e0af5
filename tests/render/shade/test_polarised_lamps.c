/* Polarised lamps: Malus's law between a lamp and a sheet in a shadow ray, and Fresnel's equations for the photons of a
 * lamp whose field is across the plane of incidence or in it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "sheet_fixture.h"
#include "zbuffer_fixture.h"

static double mean_of(const scene *s)
{
    render_result *r = render(s);
    double sum = 0.0;
    const int width = (int)s->render.width, height = (int)s->render.height;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            sum += film_value(r->img, x, y, 1);
    render_result_destroy(r);
    return sum / (width * height);
}

/* A matte floor seen at the origin, and a polariser whose normal points to the lamp. */
static scene *floor_under(const char *lamp, const char *sheet)
{
    char text[1000];
    snprintf(text, sizeof text,
             "render: {width: 1, height: 1, depth: 4, polarisation: \"on\"}\n"
             "camera: {position: [0, 1, -3], target: [0, 0, 0], fov_deg: 0.001}\n"
             "background: {color: [0, 0, 0]}\n"
             "lights: {lamp: %s}\n"
             "solids:\n"
             "  floor: {shape: plane, diffuse: 1}\n"
             "  sheet: {shape: box, transparency: 1, ior: 1, sheet: polariser, sheet_axis: [1, 0, 0], %s}\n",
             lamp, sheet);
    return scene_from(text);
}

/* Malus: light of degree P, of which (1 + P) / 2 has its field along one axis, passes with (1 + P cos 2 a) / 2. A
 * spotlight that shines down has its field along x at 0 degrees, and turns with +90 degrees to z; the sheet turns about
 * y, x towards -z. */
static void a_sheet_dims_a_polarised_lamp_by_malus(void **state)
{
    (void)state;
    static const char *const lamps[] = {
        "{kind: cone, position: [0, 10, 0], target: [0, 0, 0]}",
        "{kind: soft_cone, half_angle_deg: 40, position: [0, 10, 0], target: [0, 0, 0]}",
        "{kind: sun, angular_diameter_deg: 0, position: [0, 10, 0], target: [0, 0, 0]}",
        "{position: [0, 10, 0]}",
    };
    /* also by paths, but for the point: straight below it the horizontal turns with each point of a pixel */
    for (size_t k = 0; k < 2 * (sizeof lamps / sizeof *lamps) - 1; k++) {
        scene *s = floor_under(lamps[k / 2], "position: [0, 3, 0], size: [3, 0.01, 3]");
        if (k % 2)
            set_all(s, "render.integrator=path render.paths=1");
        for (int degree_of = 0; degree_of <= 4; degree_of++)
            for (int a = -90; a <= 90; a += 18)
                for (int b = 0; b <= 180; b += 60) {
                    const double p = 0.25 * degree_of;
                    s->lights[0].polarised = p, s->lights[0].polarisation_deg = b;
                    s->solids[1].shape.rotation_deg.y = a;
                    assert_near(look(s).x, 0.5 * (1.0 + p * cos(2.0 * (a + b) * degree)), 1e-9);
                }
        set(s, "render.polarisation=off");
        assert_near(look(s).x, 0.5, 1e-9);
        scene_destroy(s);
    }
}

/* Off its axis a spotlight's field turns by the shortest rotation from the axis to the ray: here of 45 degrees about z,
 * which leaves the horizontal field, along z, and brings the other, in the plane of both, to x. */
static void off_the_axis_the_field_turns_with_the_ray(void **state)
{
    (void)state;
    scene *s = floor_under("{kind: cone, half_angle_deg: 80, position: [0, 10, 0], target: [10, 0, 0], polarised: 0.7}",
                           "position: [0, 3, 0], size: [3, 0.01, 3]");
    for (int a = -90; a <= 90; a += 18)
        for (int b = 0; b <= 180; b += 45) {
            s->lights[0].polarisation_deg = b;
            s->solids[1].shape.rotation_deg.y = a;
            assert_near(look(s).x, 0.5 * (1.0 - 0.7 * cos(2.0 * (a + b) * degree)), 1e-9);
        }
    scene_destroy(s);
}

/* A point lamp's field is horizontal at 0 degrees, whichever way its light goes, and at 90 in the vertical plane. From
 * 45 degrees above, the sheet's axes are z and the direction across z and the ray. */
static void a_point_lamp_counts_from_the_horizontal(void **state)
{
    (void)state;
    scene *s = floor_under("{position: [10, 10, 0], polarised: 1}",
                           "position: [3, 3, 0], size: [3, 0.01, 3], rotation: [0, 0, -45]");
    const double full = sqrt(0.5);
    for (int b = -90; b <= 90; b += 15) {
        s->lights[0].polarisation_deg = b;
        set(s, "sheet.sheet_axis=0,0,1");
        assert_near(look(s).x, full * squared(cos(b * degree)), 1e-9);
        set(s, "sheet.sheet_axis=1,0,0");
        assert_near(look(s).x, full * squared(sin(b * degree)), 1e-9);
    }
    /* a retarder alone changes nothing that a matte surface tells; before the sheet a half-wave plate at 22.5 degrees
     * turns the field by 45 */
    set_all(s, "sheet.sheet=retarder sheet.retardance_deg=180");
    assert_near(look(s).x, full, 1e-9);
    scene_destroy(s);
}

/* Discs, rectangles and spheres far away are as the point. */
static void lamps_with_a_size_are_polarised(void **state)
{
    (void)state;
    static const char *const lamps[] = {
        "{kind: disc, radius: 0.05, reach: 10, position: [0, 10, 0], target: [0, 0, 0], polarised: 0.6}",
        "{kind: rectangle, width: 0.1, height: 0.1, reach: 10, roll_deg: 30, position: [0, 10, 0], target: [0, 0, 0], "
        "polarised: 0.6}",
        "{radius: 0.05, reach: 10, position: [0.01, 10, 0], polarised: 0.6, polarisation_deg: 90}",
        "{kind: sun, position: [0, 10, 0], target: [0, 0, 0], polarised: 0.6}",
    };
    for (size_t k = 0; k < sizeof lamps / sizeof *lamps; k++) {
        scene *s = floor_under(lamps[k], "position: [0, 3, 0], size: [3, 0.01, 3]");
        set_all(s, "render.soft_shadows=on render.samples=64");
        /* the sphere's light comes from all around the vertical, where a point's reference turns: not tested there */
        for (int a = 0; a <= 90 && k != 2; a += 30) {
            s->lights[0].polarisation_deg = a;
            assert_near(look(s).x, 0.5 * (1.0 + 0.6 * cos(2.0 * a * degree)), 1e-3);
        }
        if (k == 2) {
            set_all(s, "lamp.position=10,10,0 lamp.reach=14.142135623730951 lamp.polarisation_deg=0 "
                       "sheet.position=3,3,0 sheet.rotation=0,0,-45 sheet.sheet_axis=0,0,1");
            assert_near(look(s).x, sqrt(0.5) * 0.8, 2e-3);
        }
        scene_destroy(s);
    }
}

/* Malus, of a lamp that is seen through an analyser. The lamp faces the eye, and its right is the image's left. */
static void an_analyser_dims_the_lamp_itself(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 1, polarisation: \"on\", integrator: path, paths: 1}\n"
                          "camera: {position: [0, 0, 0], target: [0, 0, 10], fov_deg: 0.001, analyser: linear}\n"
                          "background: {color: [0, 0, 0]}\n"
                          "lights: {lamp: {kind: disc, radius: 1, reach: 10, intensity: 0.01, position: [0, 0, 10], "
                          "target: [0, 0, 0], polarised: 0.6}}\n"
                          "solids: {floor: {shape: plane, position: [0, -3, 0]}}\n");
    for (int a = 0; a <= 90; a += 15)
        for (int b = 0; b <= 90; b += 30) {
            s->camera.analyser_angle_deg = a, s->lights[0].polarisation_deg = b;
            assert_near(look(s).x, 0.5 * (1.0 + 0.6 * cos(2.0 * (a + b) * degree)), 1e-9);
        }
    scene_destroy(s);
}

/* At Brewster's angle a surface of glass reflects of a field across the plane of incidence ((n^2 - 1) / (n^2 + 1))^2,
 * and nothing of one within it. So does a dull surface of little roughness, on random paths that find the lamp and on
 * shadow rays to it. */
static void surfaces_reflect_a_polarised_lamp_by_fresnel(void **state)
{
    (void)state;
    scene *s =
        scene_from("render: {width: 1, height: 1, depth: 2, polarisation: \"on\", integrator: path, paths: 65536, "
                   "beyond: black}\n"
                   "camera: {position: [-2.4961508830135313, 1.6641005886756874, 0], target: [0, 0, 0], "
                   "fov_deg: 0.001}\n"
                   "background: {color: [0, 0, 0]}\n"
                   "lights: {lamp: {kind: rectangle, width: 12, height: 12, reach: 10, intensity: 0.1, "
                   "position: [8.320502943378437, 5.547001962252291, 0], target: [0, 0, 0]}}\n"
                   "solids: {glass: {shape: plane, transparency: 1, ior: 1.5}}\n");
    const double across = squared(1.25 / 3.25);
    set(s, "camera.target=8.320502943378437,5.547001962252291,0");
    set(s, "camera.position=0,0.01,0");
    const double lamp = look(s).x;
    assert_true(lamp > 0.1);
    set(s, "camera.target=0,0,0");
    set(s, "camera.position=-2.4961508830135313,1.6641005886756874,0");
    for (int rough = 0; rough < 2; rough++)
        for (int p = 0; p <= 2; p++) {
            set(s, rough ? "glass.roughness=0.02" : "glass.roughness=0");
            s->lights[0].polarised = p > 0 ? 1.0 : 0.0, s->lights[0].polarisation_deg = p == 2 ? 90.0 : 0.0;
            assert_near(look(s).x / lamp, p == 0 ? 0.5 * across : p == 1 ? across : 0.0, 4e-3);
        }
    scene_destroy(s);
}

/* A spotlight far away on a glass plate at Brewster's angle, tan i = n, and a wall that its reflection reaches: a field
 * in the plane of incidence is not reflected at either face, one across it with R_s, and with all reflections within
 * the plate 2 R_s / (1 + R_s) (Born and Wolf, 1.5.2 and 1.5.3). The floor receives the rest. */
static void photons_of_a_polarised_lamp_obey_fresnel(void **state)
{
    (void)state;
    static const char scene_text[] =
        "render: {width: 12, height: 12, depth: 8, caustics: photons, photons: 300000, integrator: raycast, "
        "polarisation: \"on\"}\n"
        "camera: {position: [-1, 2.55, 0], target: [-3, 2.55, 0], fov_deg: 15}\n"
        "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
        "lights: {lamp: {kind: cone, half_angle_deg: 0.07, position: [832.0502943378437, 555.1501962252291, 0], "
        "target: [0, 0.45, 0], intensity: 1, reach: 1000, polarised: 1}}\n"
        "solids:\n"
        "  ground: {shape: plane, diffuse: 1}\n"
        "  wall: {shape: box, position: [-4, 0, 0], size: [2, 20, 20], diffuse: 1}\n"
        "  slab: {shape: box, position: [0, 0.45, 0], size: [6, 0.2, 6], transparency: 1, ior: 1.5}\n";
    const double tangent = 1.5, cos_i = 1.0 / sqrt(1.0 + tangent * tangent), sin_i = tangent * cos_i,
                 /* i + t = 90 degrees: R_s = cos^2 2 i */
        a = squared(cos_i * cos_i - sin_i * sin_i), plate = 2.0 * a / (1.0 + a);
    scene *s = scene_from(scene_text);
    const double across = mean_of(s);
    assert_near(across, sin_i * plate, 0.01 * plate);
    set(s, "lamp.polarisation_deg=90");
    assert_near(mean_of(s), 0.0, 1e-5);
    set(s, "lamp.polarisation_deg=45");
    assert_near(mean_of(s), 0.5 * sin_i * plate, 0.005 * plate);
    set(s, "lamp.polarised=0");
    assert_near(mean_of(s), 0.5 * sin_i * plate, 0.005 * plate);
    set_all(s, "camera.position=-0.3,0.3,0 camera.target=-0.3,0,0.001 camera.fov_deg=90 render.photons=1000000 "
               "lamp.polarised=1 lamp.polarisation_deg=0");
    assert_near(mean_of(s), cos_i * (1.0 - plate), 0.01);
    set(s, "lamp.polarisation_deg=90");
    assert_near(mean_of(s), cos_i, 0.01);
    scene_destroy(s);
}

static void films_are_bit_identical(void **state)
{
    (void)state;
    static const char *const variants[] = {
        "",
        "render.soft_shadows=on lamp.radius=0.3 lamp.reach=9",
        "render.caustics=photons render.photons=3000",
        "render.spectrum=spectral render.wavelengths=3",
    };
    for (size_t v = 0; v < sizeof variants / sizeof *variants; v++) {
        scene *s = rod_scene("render.width=40 render.height=30 render.depth=4 render.polarisation=on "
                             "lamp.polarised=0.9 liquid.sheet=polariser");
        set_all(s, variants[v]);
        uint64_t hash = 0;
        for (int level = ISA_BASE; level <= (int)isa_best(); level++)
            for (int threads = 1; threads <= 3; threads += 2) {
                s->render.threads = threads;
                const uint64_t one = film_hash_at(s, (isa)level);
                assert_true(!hash || one == hash);
                hash = one;
            }
        set(s, "lamp.polarised=0");
        assert_true(film_hash_at(s, isa_best()) != hash);
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sheet_dims_a_polarised_lamp_by_malus),
        cmocka_unit_test(off_the_axis_the_field_turns_with_the_ray),
        cmocka_unit_test(a_point_lamp_counts_from_the_horizontal),
        cmocka_unit_test(lamps_with_a_size_are_polarised),
        cmocka_unit_test(an_analyser_dims_the_lamp_itself),
        cmocka_unit_test(surfaces_reflect_a_polarised_lamp_by_fresnel),
        cmocka_unit_test(photons_of_a_polarised_lamp_obey_fresnel),
        cmocka_unit_test(films_are_bit_identical),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
