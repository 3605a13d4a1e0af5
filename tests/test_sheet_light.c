/* Polarisers and wave plates in the rest of the program: interference colours against the observer's tables, shadows,
 * photons, random paths and unpolarised rays; what divides a passage does not double it; and one film. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "optics/spectrum.h"
#include "sheet_fixture.h"
#include "zbuffer_fixture.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

/* Daylight behind crossed polarisers with a plate of that path difference at 45 degrees, as linear sRGB, summed over
 * the tables of CIE 15 in steps of 0.05 nm. */
static void michel_levy(double path_nm, double rgb[3])
{
    enum { STEPS = 8000 };
    double xyz[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < STEPS; k++) {
        const double nm = OBSERVER_LOW_NM + (OBSERVER_HIGH_NM - OBSERVER_LOW_NM) * (k + 0.5) / STEPS;
        double eye[3];
        observer_weights(nm, eye);
        for (int c = 0; c < 3; c++)
            xyz[c] += eye[c] * observer_d65(nm) * 0.5 * squared(sin(180.0 * path_nm / nm * degree)) / STEPS;
    }
    xyz_to_linear_srgb(xyz, rgb);
}

static void a_spectral_film_shows_interference_colours(void **state)
{
    (void)state;
    static const double paths_nm[] = {100, 250, 350, 450, 550, 575, 700, 900, 1100, 1400};
    double yellow[3], purple[3];
    michel_levy(450.0, yellow), michel_levy(550.0, purple); /* Michel-Levy's chart: first order */
    assert_true(yellow[0] > 3.0 * yellow[2] && yellow[1] > 2.0 * yellow[2]);
    assert_true(purple[0] > 3.0 * purple[1] && purple[2] > 3.0 * purple[1]);
    for (size_t k = 0; k < COUNT(paths_nm); k++) {
        double expected[3];
        scene *s = crossed_with("sheet=retarder birefringence=0.01", 45.0);
        set_all(s, "render.spectrum=spectral render.wavelengths=400");
        s->render.unit_m = paths_nm[k] * 1e-9 / 0.01 / 0.01;
        michel_levy(paths_nm[k], expected);
        render_result *r = render(s);
        for (int c = 0; c < 3; c++)
            assert_near(film_value(r->img, 0, 0, c), expected[c], 1e-4);
        render_result_destroy(r);
        scene_destroy(s);
    }
}

/* A matte floor below a lamp, and sheets between. */
static scene *below_lamp(const char *assignments, double z_sheets)
{
    scene *s = scene_from("render: {width: 1, height: 1, depth: 4, polarisation: \"on\"}\n"
                          "camera: {position: [0, 1, -3], target: [0, 0, 0], fov_deg: 0.001}\n"
                          "background: {color: [0, 0, 0]}\n"
                          "lights: {lamp: {position: [0, 10, 0]}}\n"
                          "solids: {floor: {shape: plane, diffuse: 1}}\n");
    for (int i = 0; i < 3; i++) {
        add_sheet(s, z_sheets, i == 1 ? "sheet=retarder" : "sheet=polariser", 0.0, 0.0);
        solid *one = &s->solids[s->solid_count - 1];
        one->shape.position = vec3_make(0.0, 3.0 + i, 0.0);
        one->shape.size = vec3_make(3.0, 0.01, 3.0);
    }
    set_all(s, assignments);
    return s;
}

static void sheets_in_a_shadow_ray_are_crossed_too(void **state)
{
    (void)state;
    for (int a = 0; a <= 90; a += 15) {
        scene *s = below_lamp("", 0.0);
        s->solids[3].shape.rotation_deg.y = a;
        assert_near(look(s).x, 0.5 * squared(cos(a * degree)), 1e-12);
        set(s, "sheet_3.retardance_deg=70");
        s->solids[2].shape.rotation_deg.y = 45.0 + a;
        s->solids[3].shape.rotation_deg.y = 90.0;
        assert_near(look(s).y, 0.5 * squared(sin(2.0 * (45.0 + a) * degree) * sin(35.0 * degree)), 1e-12);
        set(s, "render.polarisation=off");
        assert_near(look(s).z, 0.25, 1e-12);
        set_all(s, "render.integrator=path render.paths=1 render.depth=0");
        assert_near(look(s).z, 0.25, 1e-9); /* at a random point of the pixel */
        set_all(s, "render.integrator=raycast render.polarisation=on");
        assert_near(look(s).z, 0.5 * squared(sin(2.0 * (45.0 + a) * degree) * sin(35.0 * degree)), 1e-12);
        scene_destroy(s);
    }
}

/* Through sheets of glass light comes as photons alone: their weights are those of the shadow rays above. */
static double by_photons(double turn_deg, const char *more)
{
    scene *s = below_lamp("render.caustics=photons render.photons=20000 sheet_2.ior=1.5 sheet_4.ior=1.5 "
                          "camera.fov_deg=10 render.width=8 render.height=8",
                          0.0);
    set_all(s, more);
    s->solids[3].shape.rotation_deg.y = turn_deg;
    render_result *r = render(s);
    double sum = 0.0;
    for (int k = 0; k < 64; k++)
        sum += film_value(r->img, k % 8, k / 8, 1) / 64.0;
    render_result_destroy(r);
    scene_destroy(s);
    return sum;
}

static void photons_pass_sheets(void **state)
{
    (void)state;
    const double clear = by_photons(0.0, "sheet_2.sheet=none sheet_4.sheet=none");
    assert_true(clear > 0.5);
    for (int a = 0; a <= 90; a += 30)
        assert_near(by_photons(a, "") / clear, 0.5 * squared(cos(a * degree)), 0.01);
}

/* A hidden solid, others that touch, a mesh, a start in it: a passage is one. */
static void a_passage_counts_once(void **state)
{
    (void)state;
    static const char half[] = "sheet=retarder retardance_deg=60";
    scene *s = crossed_with(half, 45.0); /* sheet_3 is 0.01 thick at 2 */
    const double once = 0.5 * squared(sin(30.0 * degree)), twice = 0.5 * squared(sin(60.0 * degree));
    assert_all(s, once, 1e-12);
    add_sheet(s, 2.0, "ior=1 color=1,0.999999,1", 0.0, 0.0); /* absorbs, but is hidden */
    set_all(s, "sheet_4.size=0.1,0.1,0.002 sheet_4.priority=-1");
    assert_all(s, once, 1e-12);
    add_sheet(s, 2.01, "color=1,1,1", 0.0, 0.0); /* touches it */
    assert_all(s, once, 1e-12);
    add_sheet(s, 1.99, half, 45.0, 0.0); /* touches it too, and adds its own */
    assert_all(s, twice, 1e-12);
    set(s, "sheet_6.visible=off");
    set(s, "sheet_4.priority=1"); /* in two: two passages */
    assert_near(look(s).x, twice, 1e-12);
    scene_destroy(s);
    s = crossed_with(half, 45.0); /* what the ray only touches divides the search */
    diagnostic why = {0};
    size_t at;
    set_all(s, "render.width=1 render.height=1");
    worked(scene_add_solid(s, "touched", SHAPE_SPHERE, &at, &why), &why);
    s->solids[at].shape.radius = 0x1p-9;
    s->solids[at].shape.position = vec3_make(0.0, 0x1p-9, 2.0);
    s->solids[at].surface.transparency = 1.0;
    add_sheet(s, 2.001, "color=1,1,1", 0.0, 0.0); /* thinner than the search distinguishes */
    set_all(s, "touched.priority=1 sheet_5.priority=1 sheet_5.size=0.1,0.1,1e-14");
    assert_near(look(s).x, once, 1e-12);
    scene_destroy(s);
    s = behind_air("camera.position=0,0,2"); /* in the sheet */
    add_sheet(s, 2.0, "sheet=polariser sheet_pass=0.8", 0.0, 0.0);
    assert_all(s, 0.4, 1e-12);
    scene_destroy(s);
}

static void as_a_mesh_or_among_many_it_is_the_same(void **state)
{
    (void)state;
    diagnostic why = {0};
    scene *s = scene_from("render: {width: 2, height: 2, polarisation: \"on\"}\n"
                          "camera: {position: [0, 0, 0], yaw_deg: 0, projection: orthographic, view_height: 0.1}\n"
                          "background: {color: [1, 1, 1]}\n"
                          "meshes: {cube: {generate: box}}\n"
                          "solids:\n"
                          "  a: {shape: mesh, mesh: cube, scale: [0.5, 0.5, 0.01], position: [0, 0, 1], rotation: "
                          "[0, 0, 90], transparency: 1, sheet: polariser}\n"
                          "  b: {shape: mesh, mesh: cube, scale: [0.5, 0.5, 0.01], position: [0, 0, 9], "
                          "transparency: 1, sheet: polariser}\n"
                          "  c: {shape: mesh, mesh: cube, scale: [0.5, 0.5, 0.01], position: [0, 0, 2], rotation: "
                          "[0, 0, 45], transparency: 1, sheet: retarder, retardance_deg: 100}\n");
    worked(scene_load(s, &why), &why);
    assert_all(s, 0.5 * squared(sin(50.0 * degree)), 1e-12);
    scene_destroy(s);
    s = crossed_with("sheet=retarder retardance_deg=9", 45.0);
    for (int k = 1; k < 90; k++)
        add_sheet(s, 1.0 + 2.0 * k / 100.0, "sheet=retarder retardance_deg=9", 45.0, 0.0);
    set(s, "sheet_3.position.z=2.9");
    assert_all(s, 0.5 * squared(sin(45.0 * 9.0 * degree)), 1e-12);
    scene_destroy(s);
}

/* Without polarisation a retarder is not there, to the bit. */
static void without_polarisation_a_retarder_does_nothing(void **state)
{
    (void)state;
    scene *s = rod_scene("render.width=40 render.height=30 render.depth=5");
    const uint64_t plain = film_hash_at(s, isa_best());
    set_all(s, "liquid.sheet=retarder liquid.retardance_deg=90");
    assert_true(film_hash_at(s, isa_best()) == plain);
    set(s, "render.polarisation=on");
    const uint64_t turned = film_hash_at(s, isa_best());
    set(s, "liquid.retardance_deg=0");
    assert_true(film_hash_at(s, isa_best()) != turned);
    set_all(s, "render.polarisation=off liquid.sheet=polariser render.integrator=zbuffer");
    const uint64_t drawn = film_hash_at(s, isa_best());
    set(s, "liquid.sheet=none");
    assert_true(film_hash_at(s, isa_best()) == drawn);
    scene_destroy(s);
}

static void a_sheet_needs_an_axis(void **state)
{
    (void)state;
    scene *s = behind_air("");
    diagnostic why = {0};
    add_sheet(s, 1.0, "sheet=polariser", 0.0, 0.0);
    s->solids[0].surface.sheet_axis = vec3_make(0.0, 0.0, 0.0);
    assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "sheet_axis has no direction"));
    s->solids[0].surface.sheet = 2; /* circular */
    assert_int_equal(scene_check(s, &why), STATUS_OK);
    scene_destroy(s);
}

static void one_film_for_threads_and_instruction_sets(void **state)
{
    (void)state;
    for (int spectral = 0; spectral <= 1; spectral++) {
        scene *s = NULL;
        diagnostic why = {0};
        worked(scene_read("experiments/scenes/polarisers.yaml", &s, &why), &why);
        set_all(s, "render.width=36 render.height=24 render.wavelengths=3 lens.ior=1.3");
        set(s, spectral ? "render.spectrum=spectral" : "render.spectrum=rgb");
        one_film_only(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_spectral_film_shows_interference_colours),
        cmocka_unit_test(sheets_in_a_shadow_ray_are_crossed_too),
        cmocka_unit_test(photons_pass_sheets),
        cmocka_unit_test(a_passage_counts_once),
        cmocka_unit_test(as_a_mesh_or_among_many_it_is_the_same),
        cmocka_unit_test(without_polarisation_a_retarder_does_nothing),
        cmocka_unit_test(a_sheet_needs_an_axis),
        cmocka_unit_test(one_film_for_threads_and_instruction_sets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
