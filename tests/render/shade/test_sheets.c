/* Tests of polarisers and wave plates. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "optics/mueller.h"
#include "optics/spectrum.h"
#include "random_stream.h"
#include "render/inspect/probe.h"
#include "render_fixture.h"
#include "sheet_fixture.h"
#include "zbuffer_fixture.h"

/* Polarisers and wave plates in the scene against closed forms of the textbooks (Hecht, Optics, 8.2 and 8.7; Goldstein,
 * Polarized Light, the chapter on Mueller matrices): as images of one white sky behind sheets, along z. What the eye
 * sees of a field is computed from the oscillation itself, without Stokes parameters. */

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

static void malus(void **state)
{
    (void)state;
    for (int a = -90; a <= 180; a += 15)
        for (int turned = 0; turned <= 1; turned++) { /* the solid, or the axis in it */
            scene *s = behind_air("");
            add_sheet(s, 1.0, "sheet=polariser", 20.0, 0.0);
            add_sheet(s, 2.0, "sheet=polariser", turned ? 20.0 + a : 20.0, turned ? 0.0 : a);
            assert_all(s, 0.5 * squared(cos(a * degree)), 1e-12);
            scene_destroy(s);
        }
}

/* Two alike that are not ideal: parallel (k1^2 + k2^2) / 2, crossed k1 k2. Goldstein. */
static void partial_polarisers(void **state)
{
    (void)state;
    const double k1 = 0.83, k2 = 0.07;
    for (int a = 0; a <= 90; a += 10) {
        scene *s = behind_air("");
        for (int i = 0; i < 2; i++)
            add_sheet(s, 1.0 + i, "sheet=polariser sheet_pass=0.83 sheet_block=0.07", i * a, 0.0);
        assert_all(s, 0.5 * (k1 * k1 + k2 * k2) * squared(cos(a * degree)) + k1 * k2 * squared(sin(a * degree)), 1e-12);
        set(s, "render.polarisation=off"); /* grey filters */
        assert_all(s, squared(0.5 * (k1 + k2)), 1e-12);
        scene_destroy(s);
    }
}

/* A third one between two that are crossed lets light through. */
static void three_polarisers(void **state)
{
    (void)state;
    for (int a = -90; a <= 90; a += 10) {
        scene *s = behind_air("");
        add_sheet(s, 1.0, "sheet=polariser", 90.0, 0.0);
        assert_all(s, 0.5, 1e-12);
        add_sheet(s, 3.0, "sheet=polariser", 0.0, 0.0);
        assert_all(s, 0.0, 1e-12);
        add_sheet(s, 2.0, "sheet=polariser", a, 0.0);
        assert_all(s, 0.5 * squared(cos(a * degree) * sin(a * degree)), 1e-12);
        scene_destroy(s);
    }
}

/* Does the field rotate clockwise for the eye? A quarter of a period later; x to the right, y up. Light of the field
 * cos(omega t) along `axis_deg`, after a plate whose slow axis is at `slow_deg` and retards by delta. */
static double clockwise(double axis_deg, double slow_deg, double delta_deg)
{
    double at[2][2];
    for (int quarter = 0; quarter <= 1; quarter++) {
        const double phase = quarter * 90.0 * degree, between = (axis_deg - slow_deg) * degree;
        const double slow = cos(between) * cos(phase - delta_deg * degree), fast = sin(between) * cos(phase);
        at[quarter][0] = slow * cos(slow_deg * degree) - fast * sin(slow_deg * degree);
        at[quarter][1] = slow * sin(slow_deg * degree) + fast * cos(slow_deg * degree);
    }
    return at[0][1] * at[1][0] - at[0][0] * at[1][1]; /* twice the rate at which area is swept, clockwise */
}

/* Light passes a polariser, then a plate: circular filters see (I +- V) / 2, with V the area that the field sweeps, 1
 * for circular light of power 1. The filter is that of the camera, and another sheet. */
static void plates_turn_linear_light_circular(void **state)
{
    (void)state;
    static const double deltas[] = {90, -90, 30, 180, 0, 270, 450};
    for (size_t k = 0; k < COUNT(deltas); k++)
        for (int slow = -75; slow <= 90; slow += 15) {
            char plate[100];
            snprintf(plate, sizeof plate, "sheet=retarder retardance_deg=%g", deltas[k]);
            const double v = 2.0 * clockwise(10.0, slow, deltas[k]);
            for (int right = 0; right <= 1; right++) {
                scene *s = behind_air("");
                add_sheet(s, 2.0, plate, slow, 0.0);
                add_sheet(s, 3.0, "sheet=polariser", 10.0, 0.0); /* light meets it first */
                set(s, right ? "camera.analyser=circular_right" : "camera.analyser=circular_left");
                assert_all(s, 0.25 * (1.0 + (right ? v : -v)), 1e-12);
                set(s, "camera.analyser=none");
                add_sheet(s, 1.0, right ? "sheet=circular_right" : "sheet=circular_left", 0.0, 0.0);
                assert_all(s, 0.25 * (1.0 + (right ? v : -v)), 1e-12);
                scene_destroy(s);
            }
        }
    assert_near(2.0 * clockwise(0.0, 45.0, 90.0), -1.0, 1e-12); /* left circular: the order matters, see below */
}

/* In the other order the plate meets unpolarised light and does nothing, and the light is linear. */
static void the_order_of_sheets_matters(void **state)
{
    (void)state;
    static const char quarter[] = "sheet=retarder retardance_deg=90";
    for (int right = 0; right <= 1; right++) {
        scene *s = behind_air(right ? "camera.analyser=circular_right" : "camera.analyser=circular_left");
        add_sheet(s, 2.0, "sheet=polariser", 0.0, 0.0);
        add_sheet(s, 3.0, quarter, 45.0, 0.0);
        assert_all(s, 0.25, 1e-12);
        scene_destroy(s);
        s = behind_air(right ? "camera.analyser=circular_right" : "camera.analyser=circular_left");
        add_sheet(s, 2.0, quarter, 45.0, 0.0);
        add_sheet(s, 3.0, "sheet=polariser", 0.0, 0.0);
        assert_all(s, right ? 0.0 : 0.5, 1e-12);
        scene_destroy(s);
    }
}

static void a_half_wave_plate_turns_by_twice_its_angle(void **state)
{
    (void)state;
    for (int slow = 0; slow < 180; slow += 10) {
        scene *s = behind_air("camera.analyser=linear");
        add_sheet(s, 2.0, "sheet=retarder retardance_deg=180", slow, 0.0);
        add_sheet(s, 3.0, "sheet=polariser", 15.0, 0.0);
        for (int across = 0; across <= 1; across++) {
            s->camera.analyser_angle_deg = 2.0 * slow - 15.0 + 90.0 * across;
            assert_all(s, across ? 0.0 : 0.5, 1e-12);
        }
        scene_destroy(s);
    }
}

/* Crossed polarisers with a plate at an angle: sin^2(2 a) sin^2(delta / 2) of the light behind the first. */
static void a_plate_between_crossed_polarisers(void **state)
{
    (void)state;
    for (int a = -45; a <= 90; a += 15)
        for (int delta = 0; delta <= 720; delta += 40) {
            char plate[100];
            snprintf(plate, sizeof plate, "sheet=retarder retardance_deg=%d", delta);
            scene *s = crossed_with(plate, a);
            assert_all(s, 0.5 * squared(sin(2.0 * a * degree) * sin(0.5 * delta * degree)), 1e-12);
            scene_destroy(s);
        }
}

/* The same by the path in the plate, 0.01 scene units thick, at several wavelengths, with another plate that adds its
 * retardance or takes it away. */
static void birefringence_retards_by_path_and_wavelength(void **state)
{
    (void)state;
    static const double nm[] = {400, 500, 589.3, 650, 700};
    const double dn = 0.0091, path_nm = dn * 0.01 * 0.005 * 1e9; /* render.unit_m=0.005: 455 nm */
    scene *s = crossed_with("sheet=retarder birefringence=0.0091", 45.0);
    set(s, "render.unit_m=0.005");
    for (size_t k = 0; k < COUNT(nm); k++) {
        s->render.lambda_nm = nm[k];
        assert_all(s, 0.5 * squared(sin(180.0 * path_nm / nm[k] * degree)), 1e-10);
    }
    add_sheet(s, 2.5, "sheet=retarder birefringence=0.0091 retardance_deg=40", 45.0, 0.0);
    assert_all(s, 0.5 * squared(sin((180.0 * 2.0 * path_nm / 700.0 + 20.0) * degree)), 1e-10);
    set(s, "sheet_4.rotation.z=-45");
    assert_all(s, 0.5 * squared(sin(20.0 * degree)), 1e-10);
    scene_destroy(s);
}

/* An axis at an angle b to the ray, and a plate whose normal is at an angle t to it: dn sin^2 b, and 1 / cos t of the
 * thickness. */
static void oblique_passages(void **state)
{
    (void)state;
    for (int b = 0; b <= 90; b += 15)
        for (int t = 0; t <= 60; t += 20) {
            scene *s = crossed_with("sheet=retarder birefringence=0.002 sheet_axis=0,1,0", 0.0);
            s->render.lambda_nm = 500.0;
            solid *plate = &s->solids[2];
            /* turned by t about the horizontal axis, then by 45 degrees about the ray */
            plate->shape.rotation_deg = vec3_make(t, 0.0, 45.0);
            plate->surface.sheet_axis = vec3_make(0.0, sin((b + t) * degree), cos((b + t) * degree));
            const double path_nm = 0.002 * 0.01 / cos(t * degree) * squared(sin(b * degree)) * 1e9;
            set(s, "render.unit_m=0.1");
            assert_all(s, 0.5 * squared(sin(180.0 * 0.1 * path_nm / 500.0 * degree)), 1e-10);
            scene_destroy(s);
        }
}

/* The rows against whole matrices in the direction of the light, with the elements' matrices as the textbooks print
 * them, rotated by a: Goldstein, Polarized Light (a retarder with -delta, where the fast axis is x). */
static void rows_are_those_of_the_textbooks_matrices(void **state)
{
    (void)state;
    uint64_t seed = 24;
    for (int trial = 0; trial < 2000; trial++) {
        const double p1 = random_real(&seed, 0, 1), p2 = random_real(&seed, 0, 1), a = random_real(&seed, -180, 180),
                     delta = random_real(&seed, -360, 360) * degree, c = cos(2 * a * degree), z = sin(2 * a * degree);
        const bool plate = trial % 2;
        const double A = 0.5 * (p1 + p2), B = 0.5 * (p1 - p2), C = sqrt(p1 * p2), cd = cos(delta), sd = sin(delta);
        const double polariser[4][4] = {{A, B * c, B * z, 0},
                                        {B * c, A * c * c + C * z * z, (A - C) * c * z, 0},
                                        {B * z, (A - C) * c * z, A * z * z + C * c * c, 0},
                                        {0, 0, 0, C}},
                     retarder[4][4] = {{1, 0, 0, 0},
                                       {0, c * c + cd * z * z, (1 - cd) * z * c, -sd * z},
                                       {0, (1 - cd) * z * c, z * z + cd * c * c, sd * c},
                                       {0, sd * z, -sd * c, cd}};
        const double(*m)[4] = plate ? retarder : polariser;
        const double row[4] = {random_real(&seed, 0, 1), random_real(&seed, -1, 1), random_real(&seed, -1, 1),
                               random_real(&seed, -1, 1)};
        const vec3 d = random_direction(&seed);
        vec3 x, y;
        polarisation_frame(d, &x, &y);
        const vec3 axis =
            vec3_add(vec3_scale(d, 0.7), vec3_add(vec3_scale(x, cos(a * degree)), vec3_scale(y, sin(a * degree))));
        const stokes got = analyser_element((stokes){row[0], row[1], row[2], row[3]}, d, axis,
                                            plate ? sp_retarder(sd, cd) : sp_polariser(p1, p2));
        const double out[4] = {got.i, got.q, got.u, got.v};
        for (int k = 0; k < 4; k++) {
            double expected = 0.0;
            for (int r = 0; r < 4; r++)
                expected += row[r] * m[r][k];
            assert_near(out[k], expected, 1e-12);
        }
    }
}

/* Light that goes the other way is transmitted alike: through twelve sheets of every kind, tilted, and of glass too. */
static void transmission_is_the_same_in_reverse(void **state)
{
    (void)state;
    static const char *const kinds[] = {"sheet=polariser sheet_block=0.2",
                                        "sheet=retarder retardance_deg=77",
                                        "sheet=circular_left sheet_pass=0.9 sheet_block=0.3",
                                        "sheet=retarder birefringence=0.00003",
                                        "sheet=polariser sheet_block=0.5 ior=1.5",
                                        "ior=1.7"};
    uint64_t seed = 7;
    for (int trial = 0; trial < 20; trial++) {
        scene *s = behind_air("render.depth=30");
        for (int k = 0; k < 12; k++) {
            add_sheet(s, 1.0 + k, kinds[random_below(&seed, (int)COUNT(kinds))], random_real(&seed, -90, 90), 0.0);
            s->solids[k].shape.rotation_deg.x = random_real(&seed, -50, 50);
        }
        ray_tree there = {0}, back = {0};
        probe *p = NULL;
        worked(probe_create(s, isa_best(), &p, NULL), NULL);
        worked(probe_path(p, vec3_make(0.01, 0.02, -1), vec3_make(0, 0, 1), -1, &there, NULL), NULL);
        const ray_node *last = &there.node[there.count - 1];
        worked(probe_path(p, vec3_add(last->origin, vec3_scale(last->direction, 20.0)), vec3_scale(last->direction, -1),
                          -1, &back, NULL),
               NULL);
        assert_int_equal(there.count, back.count);
        assert_true(last->contribution[0] > 1e-5);
        assert_near(last->contribution[0], back.node[back.count - 1].contribution[0], 1e-11);
        ray_tree_release(&there), ray_tree_release(&back);
        probe_destroy(p);
        scene_destroy(s);
    }
}

/* Polarisers and wave plates in the rest of the program: interference colours against the observer's tables, shadows,
 * photons, random paths and unpolarised rays; what divides a passage does not double it; and one film. */

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
        cmocka_unit_test(malus),
        cmocka_unit_test(partial_polarisers),
        cmocka_unit_test(three_polarisers),
        cmocka_unit_test(plates_turn_linear_light_circular),
        cmocka_unit_test(the_order_of_sheets_matters),
        cmocka_unit_test(a_half_wave_plate_turns_by_twice_its_angle),
        cmocka_unit_test(a_plate_between_crossed_polarisers),
        cmocka_unit_test(birefringence_retards_by_path_and_wavelength),
        cmocka_unit_test(oblique_passages),
        cmocka_unit_test(rows_are_those_of_the_textbooks_matrices),
        cmocka_unit_test(transmission_is_the_same_in_reverse),
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
