/* Tests of media in scenes: laws by name and by coefficients, absorption, and the diagnostics of invalid media. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "render_fixture.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include <stdlib.h>

static double index_at(const scene *s, const char *name, double lambda_nm)
{
    index_law law;
    diagnostic why = {0};
    const solid *owner = &s->solids[scene_find_solid(s, name)];
    worked(material_index_law(&owner->surface, name, &law, &why), &why);
    return index_law_at(&law, lambda_nm);
}

static void near(double got, double expected, double tolerance)
{
    if (!(fabs(got - expected) <= tolerance))
        fail_msg("%.12f is not %.12f within %g", got, expected, tolerance);
}

static const char three_laws[] =
    "materials: {glass: {transparency: 1, medium: bk7}}\n"
    "solids:\n"
    "  a: {shape: sphere, material: glass}\n"
    "  b: {shape: sphere, material: glass, ior: 1.25}\n"
    "  c: {shape: sphere, transparency: 1, medium: cauchy, coefficients: [1.5, 0.004, 0.0001]}\n"
    "  d: {shape: sphere, transparency: 1, medium: table, coefficients: [400, 1.6, 600, 1.5]}\n"
    "  e: {shape: sphere, transparency: 1, medium: sellmeier, coefficients: [0.5684027565, 0.005101829712, "
    "0.1726177391, 0.01821153936, 0.02086189578, 0.02620722293, 0.1130748688, 10.69792721]}\n";

/* Catalogue glasses are measured in air; Schott gives N-BK7 n_d = 1.51680, and dry air has n_d = 1.000277 (Ciddor
 * 1996). */
static void indices_by_name_and_by_coefficients_equal_published_values(void **state)
{
    (void)state;
    scene *s = scene_from(three_laws);
    near(index_at(s, "a", 587.5618), 1.51680 * 1.000277, 5e-6);
    near(index_at(s, "b", 450.0), 1.25, 0.0);
    near(index_at(s, "c", 500.0), 1.5 + 0.004 / 0.25 + 0.0001 / 0.0625, 1e-15); /* Cauchy, um */
    near(index_at(s, "d", 450.0), 1.575, 1e-15);
    near(index_at(s, "e", 589.3), 1.33336, 5e-5); /* water at 20 C: Daimon and Masumura 2007, and any handbook */
    scene_destroy(s);
}

/* The last setting wins; printed parameters give the same scene. */
static void the_last_of_index_and_medium_applies(void **state)
{
    (void)state;
    scene *s = scene_from(three_laws);
    set(s, "a.ior=1.7");
    near(index_at(s, "a", 500.0), 1.7, 0.0);
    set(s, "a.medium=diamond");
    assert_true(index_at(s, "a", 587.5618) > 2.4);
    set(s, "glass.ior=1.1");
    near(index_at(s, "a", 500.0), 1.1, 0.0);
    near(index_at(s, "b", 500.0), 1.1, 0.0);
    set(s, "background.medium=water");
    index_law around = surrounding_index_law(&s->background);
    near(index_law_at(&around, 587.5618), 1.33340, 1e-5);
    set(s, "background.ior=1.2");
    around = surrounding_index_law(&s->background);
    near(index_law_at(&around, 587.5618), 1.2, 0.0);
    char *text = NULL;
    assert_int_equal(scene_get(s, "c.coefficients", &text, NULL), STATUS_OK);
    assert_string_equal(text, "[1.5,0.004,0.0001]");
    free(text);
    scene_destroy(s);
}

static void absorption_is_given_by_channel_or_by_wavelength(void **state)
{
    (void)state;
    scene *s = scene_from("solids:\n"
                          "  a: {shape: sphere, transparency: 1, absorb_per_m: [3, 2, 1]}\n"
                          "  b: {shape: sphere, transparency: 1, absorb_spectrum: [400, 0, 500, 10, 700, 10]}\n"
                          "  c: {shape: sphere, transparency: 1}\n");
    const material *a = &s->solids[0].surface, *b = &s->solids[1].surface, *c = &s->solids[2].surface;
    assert_true(material_absorbs(a) && material_absorbs(b) && !material_absorbs(c));
    near(material_absorption(a).y, 2.0, 0.0);
    near(material_absorption_at(a, 549.1), 2.0, 1e-15);
    near(material_absorption_at(a, 0.5 * (549.1 + 611.4)), 2.5, 1e-14);
    near(material_absorption_at(a, 780.0), 3.0, 0.0);
    near(material_absorption_at(a, 380.0), 1.0, 0.0);
    near(material_absorption_at(b, 450.0), 5.0, 1e-14);
    near(material_absorption(b).z, 10.0 * 0.643, 1e-12); /* at 464.3 nm */
    scene_destroy(s);
}

static void expect_error(const char *text, const char *expected)
{
    scene *s = NULL;
    diagnostic why = {.what = ""};
    char line[DIAGNOSTIC_TEXT_MAX];
    assert_int_equal(scene_read_text("test.yaml", text, strlen(text), &s, &why), STATUS_BAD_INPUT);
    assert_null(s);
    assert_string_equal(diagnostic_text(&why, line, sizeof line), expected);
}

static void invalid_media_are_refused_with_a_location(void **state)
{
    (void)state;
    expect_error("solids:\n  a: {shape: sphere, ior: 1.5, medium: water}\n",
                 "test.yaml:2:27: both an ior and a medium are given; keep either the ior or the medium");
    expect_error("materials:\n  a: {medium: water, ior: 1.5}\n",
                 "test.yaml:2:27: both an ior and a medium are given; keep either the ior or the medium");
    expect_error("background: {medium: water, ior: 1.5}\n",
                 "test.yaml:1:34: both an ior and a medium are given; keep either the ior or the medium");
    expect_error(
        "solids:\n  a: {shape: sphere, medium: cauchy}\n",
        "test.yaml:2:3: a: medium cauchy has no coefficients; give A, B (um^2), ..., for example 'coefficients: "
        "[1.5046, 0.0042]'");
    expect_error(
        "solids:\n  a: {shape: sphere, medium: wather}\n",
        "test.yaml:2:30: a.medium: 'wather' is not one of the choices; did you mean 'water'? It is one of: ior, "
        "sellmeier, cauchy, "
        "table, air, "
        "water, ethanol, glycerol, toluene, olive-oil, bk7-liquid, fused-silica, bk7, sf11, n-sf11, soda-lime, pmma, "
        "sapphire, diamond, silver, gold, copper, aluminium");
    expect_error("solids:\n  a: {shape: sphere, absorb_spectrum: [400, 1, 500]}\n",
                 "test.yaml:2:3: a: absorb_spectrum is not a list of pairs of wavelength and coefficient; "
                 "write nm,1/m,nm,1/m.. with ascending wavelengths, as [400, 0.1, 700, 2]");
    expect_error("solids:\n  a: {shape: sphere, coefficients: [1, x]}\n",
                 "test.yaml:2:36: a.coefficients: 'x' is not a finite number; give a number -1000000..1000000");
    expect_error("render: {integrator: path}\nlights:\n  l: {radius: 1}\n",
                 "test.yaml:3:3: l: a light with a size falls off with distance, and its reach is 0; set "
                 "'reach', the distance at which the intensity applies, or set radius to 0");
    expect_error("render: {weights: constant, polarisation: on}\n",
                 "test.yaml:1:9: constant weights do not support polarisation, which requires the Fresnel "
                 "equations; set render.weights to fresnel");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(indices_by_name_and_by_coefficients_equal_published_values),
        cmocka_unit_test(the_last_of_index_and_medium_applies),
        cmocka_unit_test(absorption_is_given_by_channel_or_by_wavelength),
        cmocka_unit_test(invalid_media_are_refused_with_a_location),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
