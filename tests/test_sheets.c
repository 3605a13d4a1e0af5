/* Polarisers and wave plates in the scene against closed forms of the textbooks (Hecht, Optics, 8.2 and 8.7; Goldstein,
 * Polarized Light, the chapter on Mueller matrices): as images of one white sky behind sheets, along z. What the eye
 * sees of a field is computed from the oscillation itself, without Stokes parameters. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "optics/mueller.h"
#include "random_stream.h"
#include "render/inspect/probe.h"
#include "render_fixture.h"
#include "sheet_fixture.h"

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
        const stokes got = analyser_through((stokes){row[0], row[1], row[2], row[3]}, d, axis,
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
        assert_true(last->brought[0] > 1e-5);
        assert_near(last->brought[0], back.node[back.count - 1].brought[0], 1e-11);
        ray_tree_release(&there), ray_tree_release(&back);
        probe_destroy(p);
        scene_destroy(s);
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
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
