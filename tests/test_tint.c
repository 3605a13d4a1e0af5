/* Tests of tint: inside a clear solid light has the solid's colour after tint_distance, and by Beer and Lambert's law
 * color^(d / tint_distance) after d (Hecht, Optics, 5th ed., eq. 4.79, with -ln(color) / tint_distance as the
 * coefficient). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "probe_fixture.h"

static const double color[3] = {0.8, 1.0, 0.1};

/* A pane across y = 0 without refraction, and the path straight down through it. */
static stage pane(double thickness, const char *assignments)
{
    char more[128];
    scene_text text = scene_begin(1.0, 4);
    snprintf(more, sizeof more, "color: [0.8, 1, 0.1], shape: box, size: [50, %.17g, 50]", thickness);
    add_clear(&text, "pane", 1.0, 0, vec3_make(0.0, 0.0, 0.0), vec3_make(0.0, 0.0, 0.0), more);
    stage g = stage_of(text.at, assignments);
    set_all(g.setting, "camera.position=0,30,0 camera.target=0,0,0 camera.fov_deg=0.001");
    return g;
}

static const ray_tree *down(stage *g)
{
    return stage_ray(g, vec3_make(0.0, 30.0, 0.0), vec3_make(0.0, -1.0, 0.0));
}

static void a_tint_is_the_transmittance_after_its_distance(void **state)
{
    (void)state;
    static const double distance[] = {0.05, 1.0, 3.0};
    for (size_t k = 0; k < COUNT(distance); k++) {
        for (double d = 0.1; d < 4.0; d += 0.37) {
            char assignments[64];
            snprintf(assignments, sizeof assignments, "pane.tint_distance=%.17g", distance[k]);
            stage g = pane(d, assignments);
            const ray_tree *tree = down(&g);
            for (int c = 0; c < 3; c++)
                assert_true(fabs(tree->radiance[c] - pow(color[c], d / distance[k])) <= 1e-12);
            stage_close(&g);
        }
    }
}

/* On a slanted path the tint is that of the path's length, not of the pane's thickness. */
static void tint_depends_on_the_length_of_the_path(void **state)
{
    (void)state;
    stage g = pane(0.5, "");
    for (double angle = 0.0; angle < 1.4; angle += 0.1) {
        const ray_tree *tree = stage_ray(&g, vec3_make(0.0, 1.0, 0.0), vec3_make(sin(angle), -cos(angle), 0.0));
        for (int c = 0; c < 3; c++)
            assert_true(fabs(tree->radiance[c] - pow(color[c], 0.5 / cos(angle))) <= 1e-12);
    }
    stage_close(&g);
}

/* Absorption is per metre, tint per scene unit. */
static void absorption_and_tint_add_up(void **state)
{
    (void)state;
    stage g = pane(0.5, "pane.absorb_per_m=70,10,0 render.unit_m=0.01");
    static const double a[3] = {0.7, 0.1, 0.0};
    const ray_tree *tree = down(&g);
    for (int c = 0; c < 3; c++)
        assert_true(fabs(tree->radiance[c] - pow(color[c], 0.5) * exp(-a[c] * 0.5)) <= 1e-12);
    stage_close(&g);
}

static void black_transmits_nothing_and_white_all(void **state)
{
    (void)state;
    stage g = pane(0.001, "pane.color=0,1,0");
    const ray_tree *tree = down(&g);
    assert_true(tree->radiance[0] == 0.0 && tree->radiance[1] == 1.0 && tree->radiance[2] == 0.0);
    stage_close(&g);
}

/* An opaque solid has no inside. */
static void opaque_solids_have_no_tint(void **state)
{
    (void)state;
    stage g = pane(0.5, "pane.transparency=0 pane.ambient=1");
    const vec3 seen = look(g.setting);
    assert_true(fabs(seen.x - 0.8) <= 1e-12 && fabs(seen.y - 1.0) <= 1e-12 && fabs(seen.z - 0.1) <= 1e-12);
    stage_close(&g);
}

/* Every integrator and kind of weights. */
static void every_film_is_tinted(void **state)
{
    (void)state;
    static const char *const films[] = {"", "render.integrator=path", "render.weights=constant",
                                        "render.transmission=simple", "render.polarisation=on"};
    for (size_t k = 0; k < COUNT(films); k++) {
        stage g = pane(0.5, films[k]);
        const vec3 seen = look(g.setting);
        assert_true(fabs(seen.x - pow(0.8, 0.5)) <= 1e-9 && fabs(seen.y - 1.0) <= 1e-9 &&
                    fabs(seen.z - pow(0.1, 0.5)) <= 1e-9);
        stage_close(&g);
    }
}

/* A grey has equal transmittance at all wavelengths, so its film is grey too; a colour uses its upsampled spectrum. */
static void a_spectral_film_is_tinted_by_the_upsampled_color(void **state)
{
    (void)state;
    stage g = pane(2.0, "render.spectrum=spectral render.wavelengths=64 pane.color=0.5,0.5,0.5");
    vec3 seen = look(g.setting);
    assert_true(fabs(seen.x - 0.25) <= 2e-3 && fabs(seen.y - 0.25) <= 2e-3 && fabs(seen.z - 0.25) <= 2e-3);
    stage_close(&g);
    g = pane(1.0, "render.spectrum=spectral render.wavelengths=64 pane.color=0.6,0.3,0.2");
    seen = look(g.setting); /* after the distance the light has the colour */
    assert_true(fabs(seen.x - 0.6) <= 5e-3 && fabs(seen.y - 0.3) <= 5e-3 && fabs(seen.z - 0.2) <= 5e-3);
    stage_close(&g);
}

/* Shadow rays go straight through: N.L color^(d / cos). */
static void light_through_a_tinted_pane_is_tinted(void **state)
{
    (void)state;
    static const char lit_ground[] = "background: {color: [0, 0, 0]}\n"
                                     "render: {width: 1, height: 1}\n"
                                     "lights: {lamp: {position: [0, 4, 0]}}\n"
                                     "solids:\n"
                                     "  ground: {shape: plane, diffuse: 1}\n"
                                     "  pane: {shape: box, transparency: 1, ior: 1.5, color: [0.8, 1, 0.1], position: "
                                     "[0, 2, 0], size: [50, 0.5, 50]}\n";
    stage g = stage_of(lit_ground, "");
    for (double x = 0.0; x < 6.0; x += 0.5) {
        const double n_l = 4.0 / sqrt(16.0 + x * x);
        const ray_tree *tree = stage_ray(&g, vec3_make(x, 1.0, 1.0), vec3_make(0.0, -1.0, -1.0));
        for (int c = 0; c < 3; c++)
            assert_true(fabs(tree->radiance[c] - n_l * pow(color[c], 0.5 / n_l)) <= 1e-12);
    }
    stage_close(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tint_is_the_transmittance_after_its_distance),
        cmocka_unit_test(tint_depends_on_the_length_of_the_path),
        cmocka_unit_test(absorption_and_tint_add_up),
        cmocka_unit_test(black_transmits_nothing_and_white_all),
        cmocka_unit_test(opaque_solids_have_no_tint),
        cmocka_unit_test(every_film_is_tinted),
        cmocka_unit_test(a_spectral_film_is_tinted_by_the_upsampled_color),
        cmocka_unit_test(light_through_a_tinted_pane_is_tinted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
