/* Tests of the other scenes of the realism check: a prism, a drop, two plates. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "realism/realism.h"
#include "render_fixture.h"

#define DEGREE (M_PI / 180.0)

static scene *scene_of(const char *name, const char *assignments)
{
    scene *s = NULL;
    char path[100];
    diagnostic why = {0};
    snprintf(path, sizeof path, "experiments/scenes/%s.yaml", name);
    worked(scene_read(path, &s, &why), &why);
    set_all(s, assignments);
    return s;
}

static realism_report measured(const scene *traced, const scene *supposed)
{
    realism_report r;
    diagnostic why = {0};
    worked(realism_measure_against(traced, supposed, isa_best(), &r, &why), &why);
    return r;
}

static const realism_value *value_of(const realism_report *r, const char *metric)
{
    for (int i = 0; i < r->count; i++)
        if (strcmp(r->value[i].metric, metric) == 0)
            return &r->value[i];
    fail_msg("no metric %s", metric);
    return NULL;
}

static void near(double got, double expected, double tolerance)
{
    if (!(fabs(got - expected) <= tolerance))
        fail_msg("%.12f is not %.12f within %g", got, expected, tolerance);
}

static void all_pass(const char *name, const char *assignments)
{
    scene *s = scene_of(name, assignments);
    const realism_report r = measured(s, s);
    assert_true(r.count > 0);
    for (int i = 0; i < r.count; i++)
        if (!realism_passes(&r.value[i]))
            fail_msg("%s %s: %s is %.15g, not %.15g", name, assignments, r.value[i].metric, r.value[i].measured,
                     r.value[i].theory);
    scene_destroy(s);
}

static void every_scene_passes_for_various_media(void **state)
{
    (void)state;
    all_pass("prism", "");
    all_pass("prism", "glass.medium=bk7");
    all_pass("prism", "glass.ior=1.5");
    all_pass("rainbow", "");
    all_pass("rainbow", "water.medium=olive-oil");
    all_pass("plates", "");
    all_pass("plates", "render.polarisation=on plate1.rotation.y=56.3 plate2.rotation.y=56.3");
    all_pass("plates", "plate1.rotation.y=-75 plate2.rotation.y=-75 glass.ior=1.8");
    all_pass("plates", "render.polarisation=on plate1.rotation.y=75 plate2.rotation.y=75");
}

/* A 60 degree prism of n = 1.5 deviates light by at least 2 asin(0.75) - 60 = 37.18 degrees (Hecht, Optics, 5th ed.,
 * 5.5.1). */
static void minimum_deviation_of_a_prism_equals_the_textbooks_value(void **state)
{
    (void)state;
    scene *s = scene_of("prism", "glass.ior=1.5");
    const realism_report r = measured(s, s);
    near(value_of(&r, "prism.d")->measured / DEGREE, 37.1808, 1e-4);
    near(value_of(&r, "prism.F-C")->measured, 0.0, 1e-12); /* without dispersion */
    scene_destroy(s);
}

/* 42.0 degrees for n = 4/3: Descartes; 42.3 for red and 40.6 for violet water, Minnaert, Light and Colour in the
 * Outdoors. */
static void a_drop_shows_the_rainbow_at_42_degrees(void **state)
{
    (void)state;
    scene *s = scene_of("rainbow", "water.ior=1.3333333333333333");
    const realism_report r = measured(s, s);
    near(value_of(&r, "rainbow.d")->measured / DEGREE, 42.03, 0.005);
    scene_destroy(s);
    s = scene_of("rainbow", "");
    const realism_report water = measured(s, s);
    near(value_of(&water, "rainbow.C")->measured / DEGREE, 42.3, 0.05);
    assert_true(value_of(&water, "rainbow.F")->measured < value_of(&water, "rainbow.C")->measured);
    scene_destroy(s);
}

/* At Brewster's angle p light passes all four interfaces and s light loses 1 - (2 n / (n^2 + 1))^2 at each: Born and
 * Wolf, 1.5.3. */
static void a_stack_of_plates_polarises_at_brewsters_angle(void **state)
{
    (void)state;
    scene *off = scene_of("plates", "plate1.rotation.y=56.309932474020215 plate2.rotation.y=56.309932474020215");
    scene *on = scene_clone(off);
    set(on, "render.polarisation=on");
    const double T_s = pow(2.0 * 1.5 / 3.25, 2);
    const realism_report mean = measured(off, off), apart = measured(on, on);
    near(value_of(&apart, "stack.straight")->measured, 0.5 * (1.0 + pow(T_s, 4)), 1e-12);
    near(value_of(&mean, "stack.straight")->measured, pow(0.5 * (1.0 + T_s), 4), 1e-12);
    scene_destroy(on);
    scene_destroy(off);
}

/* With another scene's theory, a relative difference of 1e-6 of the index must be detected. */
static void a_wrong_index_fails(void **state)
{
    (void)state;
    static const struct {
        const char *scene, *traced, *supposed, *metric;
    } cases[] = {
        {"prism", "glass.ior=1.5", "glass.ior=1.500001", "prism.own"},
        {"rainbow", "water.ior=1.333", "water.ior=1.333001", "rainbow.own"},
        {"plates", "glass.ior=1.5", "glass.ior=1.500001", "stack.straight"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        scene *traced = scene_of(cases[i].scene, cases[i].traced),
              *supposed = scene_of(cases[i].scene, cases[i].supposed);
        const realism_report r = measured(traced, supposed);
        assert_false(realism_passes(value_of(&r, cases[i].metric)));
        scene_destroy(traced);
        scene_destroy(supposed);
    }
}

/* An index that lets no ray through, or makes no rainbow, is reported and not hidden. */
static void metrics_without_a_ray_are_undefined(void **state)
{
    (void)state;
    scene *s = scene_of("rainbow", "water.ior=2.5");
    realism_report r = measured(s, s);
    assert_false(realism_is_defined(value_of(&r, "rainbow.d")));
    scene_destroy(s);
    s = scene_of("prism", "glass.ior=2.5"); /* total internal reflection of every ray: sin(A / 2) n > 1 */
    r = measured(s, s);
    assert_false(realism_is_defined(value_of(&r, "prism.d")));
    assert_true(isnan(value_of(&r, "prism.d")->measured));
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scene_passes_for_various_media),
        cmocka_unit_test(minimum_deviation_of_a_prism_equals_the_textbooks_value),
        cmocka_unit_test(a_drop_shows_the_rainbow_at_42_degrees),
        cmocka_unit_test(a_stack_of_plates_polarises_at_brewsters_angle),
        cmocka_unit_test(a_wrong_index_fails),
        cmocka_unit_test(metrics_without_a_ray_are_undefined),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
