/* Tests of transmission through clear surfaces: Whitted's model term by term, simple transmission (undeflected, with
 * the material's constants), and indices so high that a surface is a mirror. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "probe_fixture.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980, with all five coefficients at one
 * point of a clear pane: I = k_a I_a C + k_d I_d C + k_s I_s + k_r I_r + k_t I_t. The camera sees the origin at V = (0,
 * 0.6, -0.8); the lamp is at L = (0.6, 0.8, 0), so N.L = 0.8 and R.V = 0.48. The sky is reflected; behind the pane, at
 * a distance of 10, is an emitting mirror, seen through the tint. */
static const char pane_scene[] =
    "render: {width: 1, height: 1, depth: 1, weights: constant}\n"
    "camera: {position: [0, 3, -4], target: [0, 0, 0], fov_deg: 1}\n"
    "background: {color: [0.1, 0.2, 0.3], ambient: [0.5, 1, 2]}\n"
    "lights: {lamp: {position: [3, 4, 0], color: [1, 0.5, 0.25], intensity: 2}}\n"
    "solids:\n"
    "  pane: {shape: plane, ior: 1, color: [0.9, 0.6, 0.3], tint_distance: 20, ambient: 0.1, diffuse: 0.2, specular: "
    "0.15,\n"
    "    shininess: 3, reflectivity: 0.25, transparency: 0.3}\n"
    "  mirror: {shape: plane, position: [0, -6, 0], priority: 1, color: [0.4, 0.4, 0.4], ambient: 1,\n"
    "    reflectivity: 0.5}\n";
static const double sky[3] = {0.1, 0.2, 0.3}, around[3] = {0.5, 1.0, 2.0}, lamp[3] = {2.0, 1.0, 0.5},
                    color[3] = {0.9, 0.6, 0.3};

/* eye, to_lamp and behind: transmittances of the paths from the camera, to the lamp, and through the pane's medium. */
static void expect_whitteds_sum(const scene *s, const double *eye, const double *to_lamp, const double *behind)
{
    const vec3 seen = look(s);
    const double seen_by[3] = {seen.x, seen.y, seen.z};
    for (int c = 0; c < 3; c++) {
        const double I_d = lamp[c] * to_lamp[c] * 0.8, I_s = lamp[c] * to_lamp[c] * 0.48 * 0.48 * 0.48, I_r = sky[c];
        const double I_t = behind[c] * sqrt(color[c]) * (0.4 * around[c] + 0.5 * sky[c]);
        const double I = 0.1 * around[c] * color[c] + 0.2 * I_d * color[c] + 0.15 * I_s + 0.25 * I_r + 0.3 * I_t;
        assert_near(seen_by[c], eye[c] * I, 1e-12);
    }
}

static void whitteds_model_has_its_five_terms(void **state)
{
    (void)state;
    static const double all[3] = {1.0, 1.0, 1.0};
    static const char *const alike[] = {"", "render.transmission=simple", "render.weights=fresnel", "pane.ior=1.7"};
    scene *s = scene_from(pane_scene);
    for (size_t k = 0; k < COUNT(alike); k++) {
        set_all(s, alike[k]);
        expect_whitteds_sum(s, all, all, all);
    }
    scene_destroy(s);
}

/* exp(-a R) along each path: five units from the camera, five to the lamp; ten in the pane. */
static void whitteds_model_is_attenuated_along_its_paths(void **state)
{
    (void)state;
    const double air[3] = {exp(-0.5), 1.0, exp(-1.0)}, glass[3] = {exp(-0.2), exp(-0.5), 1.0};
    scene *s = scene_from(pane_scene);
    set_all(s, "background.absorb_per_m=0.1,0,0.2 pane.absorb_per_m=0.02,0.05,0");
    expect_whitteds_sum(s, air, air, glass);
    set_all(s, "render.transmission=simple pane.ior=1.5");
    expect_whitteds_sum(s, air, air, glass);
    scene_destroy(s);
}

/* A block of glass in front of a wall: under simple transmission every ray ends where it would without the block, with
 * a bit-identical direction; with Snell's law it ends elsewhere. */
static void simple_transmission_is_not_refracted(void **state)
{
    (void)state;
    static const char block[] =
        "render: {width: 1, height: 1, depth: 4, transmission: %s}\n"
        "background: {color: [1, 1, 1], ambient: [0, 0, 0]}\n"
        "solids:\n  block: {shape: %s, transparency: 0.8, reflectivity: 0.1, ior: 1.5, rotation: [20, 30, 0]}\n"
        "  wall: {shape: plane, position: [0, 0, 6], rotation: [-90, 0, 0], ambient: 1}\n";
    static const char *const shapes[] = {"sphere, radius: 1", "box, size: [3, 3, 1]",
                                         "cylinder, radius: 1, height: 0.7"};
    for (size_t k = 0; k < COUNT(shapes); k++)
        for (int simple = 0; simple <= 1; simple++) {
            char text[640];
            snprintf(text, sizeof text, block, simple ? "simple" : "refract", shapes[k]);
            stage g = stage_of(text, "");
            const vec3 from = vec3_make(0.1, 0.2, -4.0), to = vec3_normalize(vec3_make(0.03, -0.01, 1.0));
            const ray_tree *tree = stage_way(&g, from, to, -1);
            assert_int_equal(tree->count, 3);
            const ray_node *last = &tree->node[2];
            const vec3 expected = vec3_add(from, vec3_scale(to, 10.0 / to.z));
            assert_true((apart(last->hit.point, expected) < 1e-12) == simple);
            assert_true((memcmp(&last->direction, &tree->node[0].direction, sizeof last->direction) == 0) == simple);
            if (simple) {
                assert_near(last->throughput[0], 0.64, 1e-15);
                assert_true(tree->node[0].hit.R == 0.1 && tree->node[0].hit.cos_t == tree->node[0].hit.cos_i &&
                            !tree->node[1].hit.tir);
            }
            stage_close(&g);
        }
}

/* From inside, far beyond the critical angle. */
static void simple_transmission_has_no_total_reflection(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 1, transmission: simple, beyond: black}\n"
                          "camera: {position: [0, -1, 0], pitch_deg: 10}\n"
                          "background: {color: [1, 1, 1], ambient: [0, 0, 0]}\n"
                          "solids: {sea: {shape: plane, transparency: 0.7, reflectivity: 0.2, ior: 1.33}}\n");
    render_result *r = render(s); /* light reflected down sees the sky below: the sea has no floor */
    assert_near(film_value(r->img, 0, 0, 0), 0.7 + 0.2, 1e-12);
    assert_int_equal(r->counters.total_internal, 0);
    assert_int_equal(r->counters.refract, CUVETTE_COUNTERS);
    render_result_destroy(r);
    set(s, "render.transmission=refract");
    r = render(s);
    assert_near(film_value(r->img, 0, 0, 0), 1.0, 1e-12);
    assert_int_equal(r->counters.refract, 0);
    render_result_destroy(r);
    scene_destroy(s);
}

/* Inside a block, at 45 degrees to four faces, all 31 reflections within the depth limit are total, and take the
 * transmitted share too. */
static void constant_shares_reflect_totally(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 30, weights: constant}\n"
                          "camera: {position: [0.1, 0.03, 0], target: [1.1, 1.05, 0.3], fov_deg: 0.001}\n"
                          "background: {color: [1, 1, 1]}\n"
                          "solids: {block: {shape: box, transparency: 0.75, reflectivity: 0.25, ior: 1.6, "
                          "size: [2, 2, 1000]}}\n");
    render_result *r = render(s);
    assert_near(film_value(r->img, 0, 0, 0), 1.0, 1e-12);
    assert_int_equal(r->counters.total_internal, CUVETTE_COUNTERS ? 31 : 0);
    assert_int_equal(r->counters.refract, 0);
    render_result_destroy(r);
    scene_destroy(s);
}

/* Two media of equal index are two surfaces: with k_r = 0.1 and k_t = 0.9 the first of three surfaces reflects 0.1, the
 * next 0.9 0.1 0.9 ... A depth of 2 has the rays of up to two surfaces. */
static void under_simple_transmission_equal_indices_are_two_surfaces(void **state)
{
    (void)state;
    stage g = stage_of("render: {width: 1, height: 1, depth: 3, beyond: black, transmission: simple}\n"
                       "background: {color: [1, 1, 1], ambient: [0, 0, 0]}\n"
                       "materials: {clear: {transparency: 0.9, reflectivity: 0.1, ior: 1}}\n"
                       "solids:\n  upper: {shape: box, material: clear, size: [9, 1, 9], position: [0, 0.5, 0]}\n"
                       "  lower: {shape: box, material: clear, size: [9, 1, 9], position: [0, -0.5, 0]}\n",
                       "");
    const ray_tree *tree = stage_ray(&g, vec3_make(0.1, 5.0, 0.2), vec3_make(0.0, -1.0, 0.0));
    /* through three surfaces; back from the first; back from the second through the first */
    assert_near(tree->radiance[0], 0.9 * 0.9 * 0.9 + 0.1 + 0.9 * 0.1 * 0.9, 1e-12);
    stage_close(&g);
}

/* Every integrator with branches: the sky through a ball, constant r and t at two surfaces, to 1e-9 of the whole
 * series. */
static void simple_transmission_conserves_light_with_spectra_and_random_paths(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 60, transmission: simple, beyond: black}\n"
                          "camera: {position: [0, 0, -4], yaw_deg: 0, fov_deg: 1}\n"
                          "background: {color: [1, 1, 1], ambient: [0, 0, 0]}\n"
                          "solids: {ball: {shape: sphere, transparency: 0.6, reflectivity: 0.4, ior: 1.5}}\n");
    set(s, "render.depth=20");
    assert_near(look(s).x, 1.0, 1e-7); /* r + t = 1, and what is cut at depth 20 is 0.4^20 */
    set_all(s, "render.spectrum=spectral");
    assert_near(look(s).y, 1.0, 1e-7);
    set_all(s, "render.spectrum=rgb render.integrator=path");
    assert_near(look(s).y, 1.0, 1e-7);
    scene_destroy(s);
}

static void weights_above_one_and_polarisation_are_refused(void **state)
{
    (void)state;
    diagnostic why = {0};
    char text[DIAGNOSTIC_TEXT_MAX];
    scene *s = scene_from("solids: {pane: {shape: plane, transparency: 0.7, reflectivity: 0.5, ior: 1.5}}\n");
    set(s, "render.transmission=simple");
    assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(diagnostic_text(&why, text, sizeof text),
                           "pane: with simple transmission, reflectivity 0.5 + transparency 0.7 exceeds 1"));
    set_all(s, "pane.reflectivity=0.3 render.polarisation=on");
    assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(diagnostic_text(&why, text, sizeof text), "set render.transmission to refract"));
    set(s, "render.polarisation=off");
    worked(scene_check(s, &why), &why);
    scene_destroy(s);
}

/* The camera sees the sky in a pane. */
static const char mirror_scene[] = "render: {width: 1, height: 1, depth: 2, beyond: black}\n"
                                   "camera: {position: [0, 3, -4], target: [0, 0, 0], fov_deg: 1}\n"
                                   "background: {color: [1, 1, 1], ambient: [0, 0, 0]}\n"
                                   "solids: {pane: {shape: box, size: [9, 2, 9], position: [0, -1, 0],\n"
                                   "  transparency: 0.5, reflectivity: 0.3, ior: 10001}}\n";

static void an_index_above_ten_thousand_is_a_mirror(void **state)
{
    (void)state;
    static const struct {
        const char *settings;
        double share;
    } cases[] = {{"", 1.0},
                 {"pane.ior=1e9", 1.0},
                 {"render.polarisation=on", 1.0},
                 {"render.polarisation=off render.spectrum=spectral", -1.0},
                 {"render.spectrum=rgb render.integrator=path", 1.0},
                 {"render.integrator=whitted render.weights=constant", 0.8},
                 {"render.weights=fresnel render.transmission=simple", 0.8},
                 {"pane.transparency=0.7", 1.0}};
    scene *s = scene_from(mirror_scene);
    for (size_t k = 0; k < COUNT(cases); k++) {
        set_all(s, cases[k].settings);
        render_result *r = render(s);
        const double seen = film_value(r->img, 0, 0, 1);
        if (cases[k].share == 1.0)
            assert_true(seen == 1.0);
        else
            assert_near(seen, fabs(cases[k].share), cases[k].share < 0.0 ? 1e-9 : 1e-12);
        assert_int_equal(r->counters.refract, 0);
        render_result_destroy(r);
    }
    scene_destroy(s);
}

/* At 10000 itself Fresnel still transmits some light. */
static void an_index_of_ten_thousand_still_transmits(void **state)
{
    (void)state;
    stage g = stage_of(mirror_scene, "pane.ior=10000 pane.reflectivity=0");
    const ray_tree *tree = stage_ray(&g, vec3_make(0.0, 3.0, 0.0), vec3_make(0.0, -1.0, 0.0));
    assert_near(tree->node[0].hit.R, pow(9999.0 / 10001.0, 2.0), 1e-14);
    assert_non_null(child_of(tree, &tree->node[0], RAY_REFRACT));
    set(g.setting, "pane.ior=10000.5");
    stage_look(&g);
    tree = stage_ray(&g, vec3_make(0.0, 3.0, 0.0), vec3_make(0.0, -1.0, 0.0));
    assert_true(tree->node[0].hit.R == 1.0 && tree->node[0].hit.opaque);
    assert_null(child_of(tree, &tree->node[0], RAY_REFRACT));
    stage_close(&g);
}

/* It is a mirror at any priority: under glass that overlaps it all light is reflected; and it casts a shadow. */
static void an_index_mirror_reflects_under_glass_and_casts_shadows(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 12}\n"
                          "camera: {position: [0, 3, -4], target: [0, 0, 0], fov_deg: 1}\n"
                          "background: {color: [1, 1, 1], ambient: [0, 0, 0]}\n"
                          "solids:\n  glass: {shape: box, size: [90, 1, 90], position: [0, 0, 0], transparency: 1, "
                          "ior: 1.5, priority: 1}\n"
                          "  mirror: {shape: plane, transparency: 1, ior: 20000}\n");
    render_result *r = render(s);
    assert_near(film_value(r->img, 0, 0, 0), 1.0, 1e-12);
    assert_true(!CUVETTE_COUNTERS || r->counters.reflect > 1);
    render_result_destroy(r);
    scene_destroy(s);
    s = scene_from("render: {width: 1, height: 1, depth: 0}\n"
                   "camera: {position: [0, 3, -4], target: [0, 0, 0]}\n"
                   "background: {ambient: [0, 0, 0]}\n"
                   "lights: {lamp: {position: [3, 4, 0]}}\n"
                   "solids:\n  ground: {shape: plane, diffuse: 1}\n"
                   "  between: {shape: sphere, radius: 0.5, position: [1.5, 2, 0], transparency: 1, ior: 1.5}\n");
    assert_near(look(s).x, 0.8, 1e-12);
    set(s, "between.ior=20000");
    assert_true(look(s).x == 0.0);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whitteds_model_has_its_five_terms),
        cmocka_unit_test(whitteds_model_is_attenuated_along_its_paths),
        cmocka_unit_test(simple_transmission_is_not_refracted),
        cmocka_unit_test(simple_transmission_has_no_total_reflection),
        cmocka_unit_test(constant_shares_reflect_totally),
        cmocka_unit_test(under_simple_transmission_equal_indices_are_two_surfaces),
        cmocka_unit_test(simple_transmission_conserves_light_with_spectra_and_random_paths),
        cmocka_unit_test(weights_above_one_and_polarisation_are_refused),
        cmocka_unit_test(an_index_above_ten_thousand_is_a_mirror),
        cmocka_unit_test(an_index_of_ten_thousand_still_transmits),
        cmocka_unit_test(an_index_mirror_reflects_under_glass_and_casts_shadows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
