/* Tests of the realism check on the rod in its vessel: theory at textbook numbers, metrics and curves. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "realism/metrics.h"
#include "realism/realism.h"
#include "realism/setup.h"
#include "realism/theory.h"
#include "render/inspect/probe.h"
#include "render_fixture.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define DEGREE (M_PI / 180.0)
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* --- theory at textbook numbers */

static void critical_angles_of_water_glass_and_diamond_equal_the_textbooks_values(void **state)
{
    (void)state;
    /* Hecht, Optics, 5th ed., table 4.2: 48.6 (n = 1.333), 41.8 (1.50), and 24.4 degrees for diamond (2.417). */
    assert_near(theory_critical_angle(1.333, 1.0) / DEGREE, 48.6, 0.05);
    assert_near(theory_critical_angle(1.50, 1.0) / DEGREE, 41.8, 0.05);
    assert_near(theory_critical_angle(2.417, 1.0) / DEGREE, 24.4, 0.05);
    assert_true(isnan(theory_critical_angle(1.0, 1.5)));
    assert_true(isnan(theory_critical_angle(1.5, 1.5)));
}

static void reflectances_at_known_angles_equal_the_textbooks_values(void **state)
{
    (void)state;
    assert_near(theory_fresnel(0.0, 1.0, 1.5), 0.04, 1e-15);        /* 4% of glass at normal incidence */
    assert_near(theory_fresnel_p(atan(1.5), 1.0, 1.5), 0.0, 1e-30); /* Brewster, 56.3 degrees */
    assert_near(theory_fresnel_s(atan(1.5), 1.0, 1.5), pow(1.25 / 3.25, 2), 1e-15); /* cos(2 Brewster)^2 */
    assert_near(theory_fresnel(45.0 * DEGREE, 1.5, 1.0), 1.0, 0.0);                 /* total */
    /* At 45 degrees R_p = R_s^2, whatever the indices. */
    assert_near(theory_fresnel_p(45.0 * DEGREE, 1.0, 1.33), pow(theory_fresnel_s(45.0 * DEGREE, 1.0, 1.33), 2), 1e-16);
}

static void the_transmittance_of_a_slab_is_a_geometric_series(void **state)
{
    (void)state;
    assert_near(theory_slab(0.04, 1), 0.9216, 1e-15); /* the two surfaces alone */
    assert_near(theory_slab(0.04, 2), 0.9216 * 1.0016, 1e-15);
    assert_near(theory_slab(0.04, 100), 0.96 / 1.04, 1e-15);
    assert_near(theory_slab(0.04, 0), 0.0, 0.0);
    assert_near(theory_slab(1.0, 5), 0.0, 0.0);
}

/* Stokes, 1862: m plates transmit (1 - R) / (1 + (2 m - 1) R) in all, and (1 - R)^(2 m) without reflections. */
static void a_pile_of_plates_transmits_what_stokes_derived(void **state)
{
    (void)state;
    for (int plates = 1; plates <= 8; plates++)
        for (double R = 0.01; R < 0.9; R += 0.11) {
            assert_near(theory_pile(R, 2 * plates, 2 * plates), pow(1.0 - R, 2 * plates), 1e-15);
            assert_near(theory_pile(R, 2 * plates, 2 * plates - 1), 0.0, 0.0);
            assert_near(theory_pile(R, 2 * plates, 100000), (1.0 - R) / (1.0 + (2 * plates - 1) * R), 1e-12);
        }
    /* One plate: each order of the series of a slab meets two interfaces more. */
    for (int order = 1; order <= 6; order++)
        assert_near(theory_pile(0.3, 2, 2 * order), theory_slab(0.3, order), 1e-15);
    assert_true(isnan(theory_pile(0.1, 17, 20)));
}

/* --- bounds of rounding errors */

/* Higham, Accuracy and Stability, 2nd ed., 3.1: gamma_n = n u / (1 - n u). */
static void gamma_is_highams(void **state)
{
    (void)state;
    const double u = 0.5 * DBL_EPSILON;
    assert_near(bound_gamma(8), 8.0 * u, 100.0 * u * u);
    assert_true(bound_gamma(8) >= 8.0 * u);
    assert_near(bound_difference(8), 16.0 * u, 200.0 * u * u);
}

static long double exact_share(long double sine, long double n_from, long double n_to)
{
    const long double in = sqrtl(1.0L - sine * sine), eta = n_from / n_to, out = 1.0L - eta * eta * sine * sine;
    if (out <= 0.0L)
        return 1.0L;
    const long double a = n_from * in, b = n_to * sqrtl(out);
    return (a - b) / (a + b) * ((a - b) / (a + b));
}

/* The bound exceeds what a change of sin i by a unit in the last place does, also next to the critical angle, where it
 * grows as the square root of the error. */
static void the_bound_of_a_reflectance_covers_a_rounded_sine(void **state)
{
    (void)state;
    const double n_from = 1.5, n_to = 1.33, critical = asin(n_to / n_from);
    for (int k = 0; k <= 50; k++) {
        const double angle = critical - pow(10.0, -0.3 * k);
        if (angle < 0.0)
            continue;
        const long double sine = sinl((long double)angle), off = 2.0L * DBL_EPSILON * sine;
        const long double change =
            fmaxl(fabsl(exact_share(sine + off, n_from, n_to) - exact_share(sine, n_from, n_to)),
                  fabsl(exact_share(sine - off, n_from, n_to) - exact_share(sine, n_from, n_to)));
        const reflectance_bound b = bound_reflectances(angle, 0.0, n_from, n_to);
        assert_true((double)change <= b.R_s && b.R_s < 1e-6);
    }
    assert_true(bound_reflectances(0.5 * critical, 0.0, n_from, n_to).R < 1e-14);
    assert_true(bound_reflectances(critical + 1e-3, 0.0, n_from, n_to).R == 0.0);
}

static void a_failed_measurement_remains_the_worst(void **state)
{
    (void)state;
    worst_pair w = WORST_NONE;
    worst_pair_add(&w, 1.0, NAN, 1.0); /* the closed form has no such point */
    assert_false(w.any);
    worst_pair_add(&w, 1.0, 1.5, 1.0);
    worst_pair_add(&w, 1.0, 1.1, 0.1); /* larger in units of its tolerance */
    assert_true(w.theory == 1.1);
    worst_pair_add(&w, NAN, 1.0, 1.0);
    worst_pair_add(&w, 1.0, 2.0, 1e-9);
    assert_true(isnan(w.measured));
}

static void one_medium_focuses_like_a_ball_lens(void **state)
{
    (void)state;
    /* f = n R / (2 (n - 1)): 1.5 radii for glass, 2 for n = 4/3, and its own rim for n = 2. */
    const double n[] = {1.5, 4.0 / 3.0, 2.0}, focal[] = {1.5, 2.0, 1.0};
    for (size_t i = 0; i < COUNT(n); i++) {
        const theory_shells c = {.n_around = 1.0, .n_wall = n[i], .n_core = n[i], .outer = 3.0, .inner = 2.9};
        assert_near(1.0 / theory_shells_power(&c), 3.0 * focal[i], 1e-14);
        assert_near(theory_shells_deviation(&c, 1e-5) / 1e-5, theory_shells_power(&c), 1e-9);
    }
}

static void an_empty_vessel_is_a_diverging_lens(void **state)
{
    (void)state;
    const theory_shells c = {.n_around = 1.0, .n_wall = 1.5, .n_core = 1.0, .outer = 1.0, .inner = 0.9};
    assert_near(theory_shells_power(&c), 2.0 / 3.0 * (1.0 - 1.0 / 0.9), 1e-15);
    assert_near(theory_shells_reach(&c), 0.9, 0.0);
}

static void apparent_depth_of_a_pond_follows_from_its_index(void **state)
{
    (void)state;
    /* Straight down: depth / n. At 45 degrees in air, water at 4/3 has sin t = 0.5303. */
    assert_near(1e-4 / theory_apparent_tangent(1.0, 1.0, 1e-4, 1.0, 4.0 / 3.0), 1.0 + 0.75, 1e-8);
    const double t = asin(0.75 * sin(45.0 * DEGREE));
    assert_near(theory_apparent_tangent(2.0, 3.0, 2.0 + 3.0 * tan(t), 1.0, 4.0 / 3.0), 1.0, 1e-12);
    assert_true(isnan(theory_apparent_tangent(-1.0, 1.0, 1.0, 1.0, 1.33)));
}

static void the_view_equals_the_cameras(void **state)
{
    (void)state;
    scene *s = rod_scene("camera.position=2,3,-5 camera.target=-0.3,1,0.4 camera.roll_deg=-70");
    probe *p = NULL;
    diagnostic why = {0};
    worked(probe_create(s, isa_best(), &p, &why), &why);
    const view v = view_of(s);
    for (int i = 0; i <= 20; i++) {
        const double x = 40.0 * i, y = 30.0 * (i * 7 % 21);
        const vec3 d = probe_camera_direction(p, x, y);
        const sight own = view_through(&v, x, y);
        assert_near(own.x, d.x, 1e-15), assert_near(own.y, d.y, 1e-15), assert_near(own.z, d.z, 1e-15);
        double px, py;
        assert_true(view_place(&v, v.x + 3.0 * d.x, v.y + 3.0 * d.y, v.z + 3.0 * d.z, &px, &py));
        assert_near(px, x, 1e-10), assert_near(py, y, 1e-10);
    }
    double px, py;
    assert_false(view_place(&v, 5.0, 5.0, -20.0, &px, &py));
    probe_destroy(p);
    scene_destroy(s);
}

/* --- metrics */

static realism_report measured_against(const scene *traced, const scene *supposed)
{
    realism_report r;
    diagnostic why = {0};
    worked(realism_measure_against(traced, supposed, isa_best(), &r, &why), &why);
    return r;
}

static const realism_value *value(const realism_report *r, const char *metric)
{
    for (int i = 0; i < r->count; i++)
        if (strcmp(r->value[i].metric, metric) == 0)
            return &r->value[i];
    fail_msg("there is no metric %s", metric);
    return NULL;
}

static void one_metric_equals_that_of_the_report(void **state)
{
    (void)state;
    static const char *const names[] = {"edges.left", "lens.focal_length", "reversal.path"};
    scene *s = rod_scene("");
    const realism_report r = measured_against(s, s);
    realism_value one;
    diagnostic why = {.what = ""};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        worked(realism_measure_one(s, isa_best(), names[i], &one, &why), &why);
        assert_string_equal(one.metric, names[i]);
        assert_true(one.measured == value(&r, names[i])->measured && one.theory == value(&r, names[i])->theory);
    }
    assert_int_equal(realism_measure_one(s, isa_best(), "lens.pover", &one, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "no metric 'lens.pover'"));
    scene_destroy(s);
}

static bool starts_with(const char *text, const char *words)
{
    return strncmp(text, words, strlen(words)) == 0;
}

static const char *const settings[] = {
    "vessel.ior=1.5 liquid.ior=1.33",
    "vessel.ior=1.3 liquid.ior=1.5",
    "vessel.ior=2.4 liquid.visible=off",
    "vessel.ior=2.4 liquid.ior=1",
    "vessel.ior=1 liquid.ior=1",
    "vessel.ior=1.5 liquid.ior=1.5",
    "background.ior=1.4",
    "vessel.medium=bk7 liquid.medium=water background.medium=air render.lambda_nm=450",
    "camera.position=3,0.5,-4 rod.rotation=0,30,0 rod.position=-0.2,2.1,0.3 vessel.inner_radius=0.7",
    ("liquid.priority=3 vessel.position=0.5,0.001,0.25 liquid.position=0.5,0.051,0.25 rod.position=0.4,2.1,0.2 "
     "rod.priority=4"),
    "liquid.absorb_per_m=0.7,0.2,0 render.unit_m=0.05 render.depth=0 render.samples=4",
    "render.radiance=basic background.ior=1.1",
};

static void all_metrics_pass_for_various_indices(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(settings); i++) {
        scene *s = rod_scene(settings[i]);
        const realism_report r = measured_against(s, s);
        assert_int_equal(r.count, 35);
        for (int k = 0; k < r.count; k++)
            if (realism_is_defined(&r.value[k]) && !realism_passes(&r.value[k]))
                fail_msg("%s: %s is %.17g, not %.17g", settings[i], r.value[k].metric, r.value[k].measured,
                         r.value[k].theory);
        assert_true(realism_is_defined(value(&r, "edges.left")));
        scene_destroy(s);
    }
}

static void undefined_metrics_are_reported_as_undefined(void **state)
{
    (void)state;
    scene *usual = rod_scene(""), *empty = rod_scene("liquid.visible=off"), *leaning = rod_scene("rod.rotation.z=10");
    realism_report r = measured_against(usual, usual);
    for (int i = 0; i < r.count; i++)
        assert_true(realism_is_defined(&r.value[i]));
    r = measured_against(empty, empty);
    const char *const none[] = {"water_line.break", "critical.liquid", "fresnel.wall", "radiance.sky_under_water",
                                "absorption.slope"};
    for (size_t i = 0; i < COUNT(none); i++) {
        assert_false(realism_is_defined(value(&r, none[i])));
        assert_false(realism_passes(value(&r, none[i])));
        assert_string_equal(value(&r, none[i])->what, "there is no liquid");
    }
    r = measured_against(leaning, leaning);
    assert_false(realism_is_defined(value(&r, "edges.left")));
    assert_true(realism_passes(value(&r, "edges.round_magnification")));
    scene_destroy(usual), scene_destroy(empty), scene_destroy(leaning);
}

/* At 85 degrees light is still under way at depth 16, which the closed form counts. */
static void plates_near_grazing_agree_within_rounding(void **state)
{
    (void)state;
    static const char *const settings_of[] = {"render.polarisation=on", "render.polarisation=off"};
    for (size_t i = 0; i < COUNT(settings_of); i++) {
        scene *s = NULL;
        realism_value v;
        diagnostic why = {0};
        worked(scene_read("experiments/scenes/plates.yaml", &s, &why), &why);
        set_all(s, "plate1.rotation.y=85 plate2.rotation.y=85");
        set(s, settings_of[i]);
        worked(realism_measure_one(s, isa_best(), "stack.whole", &v, &why), &why);
        assert_true(realism_passes(&v) && v.tolerance < 1e-12);
        const double n = 1.5, R_s = theory_fresnel_s(85.0 * DEGREE, 1.0, n), all = (1.0 - R_s) / (1.0 + 3.0 * R_s);
        assert_true(all - theory_pile(R_s, 4, 16) > 0.01);
        scene_destroy(s);
    }
}

/* Compares measurements in the scene with `changed` applied to theory for the scene without it. Exactly the metrics
 * that start with these words must fail. */
static void expect_failures(const char *base, const char *changed, const char *const *words, size_t count)
{
    scene *s = rod_scene(base), *other = rod_scene(base);
    set_all(other, changed);
    const realism_report r = measured_against(other, s);
    for (int i = 0; i < r.count; i++) {
        const realism_value *v = &r.value[i];
        bool expected = false;
        for (size_t k = 0; k < count; k++)
            expected |= starts_with(v->metric, words[k]);
        if (realism_is_defined(v) && realism_passes(v) == expected)
            fail_msg("%s, then %s: %s %s at %.17g for %.17g", base, changed, v->metric, expected ? "passes" : "fails",
                     v->measured, v->theory);
    }
    scene_destroy(s), scene_destroy(other);
}

static void a_relative_error_of_the_index_of_1e_8_fails(void **state)
{
    (void)state;
    const char *const of_air[] = {
        "edges",          "water_line",     "lens", "dispersion", "critical.vessel", "critical.liquid",
        "fresnel.vessel", "fresnel.liquid", "slab", "gap",        "radiance",        "reversal"};
    expect_failures("", "background.ior=1.00000001", of_air, COUNT(of_air));
    expect_failures("vessel.ior=1.3 liquid.ior=1.5", "background.ior=1.00000001", of_air, COUNT(of_air));
    const char *const of_glass[] = {"edges.left",    "edges.right",    "edges.magnification", "lens", "critical.vessel",
                                    "critical.wall", "fresnel.vessel", "fresnel.wall",        "slab", "gap",
                                    "reversal"};
    expect_failures("", "vessel.ior=1.50000001", of_glass, COUNT(of_glass));
    const char *const of_water[] = {"edges",          "water_line",   "lens",     "critical.liquid", "critical.wall",
                                    "fresnel.liquid", "fresnel.wall", "radiance", "reversal"};
    expect_failures("", "liquid.ior=1.33000001", of_water, COUNT(of_water));
    const char *const of_empty[] = {
        "edges.left", "edges.right", "edges.magnification", "lens", "critical", "fresnel", "slab", "gap", "reversal"};
    expect_failures("vessel.ior=2.4 liquid.visible=off", "vessel.ior=2.40000001", of_empty, COUNT(of_empty));
}

static void wrong_transmittance_and_absorption_fail(void **state)
{
    (void)state;
    const char *const balance[] = {"balance", "slab", "gap", "radiance", "reversal.throughput"};
    expect_failures("", "clear.transparency=0.999999", balance, COUNT(balance));
    const char *const absorption[] = {"absorption", "reversal.throughput"};
    expect_failures("liquid.absorb_per_m=0.7,0,0", "liquid.absorb_per_m=0.7000007,0,0", absorption, COUNT(absorption));
    scene *s = rod_scene("clear.transparency=0.9 clear.reflectivity=0.1 render.weights=constant");
    const realism_report r = measured_against(s, s);
    assert_false(realism_passes(value(&r, "fresnel.vessel")));
    assert_false(realism_passes(value(&r, "slab.depth")));
    assert_true(realism_passes(value(&r, "balance.furnace"))); /* its shares add up to 1 */
    scene_destroy(s);
}

static void water_in_glass_disperses_as_published(void **state)
{
    (void)state;
    /* n_F and n_C of N-BK7 by Schott's data sheet, and of water at 20 C to the digits that handbooks agree on. */
    const double glass[] = {1.52238, 1.51432}, water[] = {1.3371, 1.3311};
    scene *s = rod_scene("background.medium=air");
    const realism_report r = measured_against(s, s);
    double deviation[2];
    for (int i = 0; i < 2; i++) {
        const theory_shells c = {1.0, glass[i], water[i], 1.0, 0.9};
        deviation[i] = theory_shells_deviation(&c, 0.45);
    }
    assert_near(value(&r, "dispersion.F-C")->measured, deviation[0] - deviation[1], 5e-5);
    scene_destroy(s);
}

static void scenes_without_vessel_rod_or_common_axis_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *change, *what;
    } wrong[] = {
        {"vessel.visible=off", "'vessel'"}, {"rod.visible=off", "'rod'"},        {"liquid.radius=0.5", "wall"},
        {"liquid.position.x=0.01", "wall"}, {"liquid.m=1.1", "round"},           {"vessel.m=1.1", "elliptic"},
        {"vessel.rotation.x=5", "rotated"}, {"vessel.transparency=0", "opaque"}, {"rod.transparency=1", "not opaque"},
        {"rod.priority=1", "displaces"},    {"liquid.position.y=0.5", "floor"},  {"liquid.priority=9", "displaces"},
    };
    for (size_t i = 0; i < COUNT(wrong); i++) {
        scene *s = rod_scene(wrong[i].change);
        realism_report r;
        diagnostic why = {0};
        assert_int_equal(realism_measure(s, isa_best(), &r, &why), STATUS_BAD_INPUT);
        if (!strstr(why.what, wrong[i].what))
            fail_msg("%s: %s", wrong[i].change, why.what);
        assert_true(why.remedy[0] != '\0');
        scene_destroy(s);
    }
}

static void curves_equal_theory(void **state)
{
    (void)state;
    static const int counts[REALISM_CURVE_PRISM] = {180, 180, 180, 201, 17, 100, 61, 180, 86};
    scene *s = rod_scene("");
    realism_points p;
    diagnostic why = {0};
    for (int which = 0; which < REALISM_CURVE_PRISM; which++) {
        worked(realism_measure_curve(s, isa_best(), (realism_curve)which, &p, &why), &why);
        assert_int_equal(p.count, counts[which]);
        for (int i = 0; i < p.count; i++) {
            assert_near(p.at[i].measured, p.at[i].theory, 1e-9);
            assert_true(i == 0 || p.at[i].x > p.at[i - 1].x);
        }
    }
    worked(realism_measure_curve(s, isa_best(), REALISM_CURVE_EDGES, &p, &why), &why);
    /* By the liquid's index: at index 1 the displacement is that of the glass alone. */
    assert_true(p.at[0].measured != p.at[60].measured);
    assert_int_equal(realism_measure_curve(s, isa_best(), REALISM_CURVE_PRISM, &p, &why), STATUS_BAD_INPUT);
    set(s, "liquid.visible=off");
    assert_int_equal(realism_measure_curve(s, isa_best(), REALISM_CURVE_EDGES, &p, &why), STATUS_BAD_INPUT);
    scene_destroy(s);
}

static void curves_of_other_scenes_equal_theory(void **state)
{
    (void)state;
    static const struct {
        const char *file;
        realism_curve which;
        int least;
        double lowest, highest; /* range of the theory */
    } cases[] = {
        {"experiments/scenes/prism.yaml", REALISM_CURVE_PRISM, 100, 60.0, 90.0},
        {"experiments/scenes/rainbow.yaml", REALISM_CURVE_RAINBOW, 100, 0.0, 42.6},
        {"experiments/scenes/plates.yaml", REALISM_CURVE_PLATES, 86, 0.0, 0.86},
        {"experiments/scenes/malus.yaml", REALISM_CURVE_MALUS, 91, 0.0, 0.5},
        {"experiments/scenes/coin.yaml", REALISM_CURVE_COIN, 60, 0.28, 1.2},
        {"experiments/scenes/arrow.yaml", REALISM_CURVE_ARROW, 90, -3.0, 1.0},
        {"experiments/scenes/soap.yaml", REALISM_CURVE_SOAP, 200, 0.0, 0.081},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        scene *s = NULL;
        realism_points p;
        diagnostic why = {0};
        worked(scene_read(cases[k].file, &s, &why), &why);
        worked(realism_measure_curve(s, isa_best(), cases[k].which, &p, &why), &why);
        assert_true(p.count >= cases[k].least);
        for (int i = 0; i < p.count; i++) {
            assert_near(p.at[i].measured, p.at[i].theory, 1e-9);
            assert_true(p.at[i].theory >= cases[k].lowest && p.at[i].theory <= cases[k].highest);
        }
        scene_destroy(s);
    }
}

/* The filters stand before a white sky, whatever else the scene has; and cos^2 / 2 without a plate (Hecht, 8.2.1). */
static void malus_depends_on_the_filters_alone(void **state)
{
    (void)state;
    scene *s = NULL;
    realism_points p;
    diagnostic why = {0};
    worked(scene_read("experiments/scenes/malus.yaml", &s, &why), &why);
    worked(scene_set_assignment(s, "plate.visible=off", &why), &why);
    worked(scene_set_assignment(s, "board.color=0.2,0.1,0", &why), &why);
    worked(realism_measure_curve(s, isa_best(), REALISM_CURVE_MALUS, &p, &why), &why);
    for (int i = 0; i < p.count; i++) {
        const double c = cos(p.at[i].x * 3.14159265358979323846 / 180.0);
        assert_near(p.at[i].measured, 0.5 * c * c, 1e-9);
    }
    scene_destroy(s);
}

/* An eye that looks down at 45 degrees over the rim of a cup, n = 4/3: sin t = 0.5303. By hand, in the plane of sight:
 * the line of sight meets the far edge of the coin, 1.5 from the rim and 1.16 below it, if
 * (1.16 - w) tan 45 + w tan t = 1.5, whose w is negative: the empty cup shows the coin already. At 1.9 below it does so
 * with w = 0.4 / (1 - tan t). */
static void a_coin_appears_where_snells_law_puts_it(void **state)
{
    (void)state;
    const double tan_t = 0.75 * sqrt(0.5) / sqrt(1.0 - 0.5625 * 0.5);
    assert_near(theory_least_depth(1.9, 1.5, 1.0, 4.0 / 3.0), 0.4 / (1.0 - tan_t), 1e-14);
    assert_true(theory_least_depth(1.16, 1.5, 1.0, 4.0 / 3.0) < 0.0);
    /* The traced cup: eye 5 before the rim's inner edge and 3.33 above it; the coin's upper face is 1.16 below it. */
    scene *s = NULL;
    realism_points p;
    diagnostic why = {0};
    worked(scene_read("experiments/scenes/coin.yaml", &s, &why), &why);
    worked(realism_measure_curve(s, isa_best(), REALISM_CURVE_COIN, &p, &why), &why);
    for (int i = 0; i < p.count; i++) {
        const double tan_i = 5.0 / 3.33, sine = tan_i / sqrt(1.0 + tan_i * tan_i) / p.at[i].x,
                     below = sine / sqrt(1.0 - sine * sine);
        assert_near(p.at[i].measured, (1.16 * tan_i - 1.5) / (tan_i - below) + 0.04, 1e-9);
        assert_true(i == 0 || p.at[i].measured < p.at[i - 1].measured);
    }
    static const struct {
        const char *change, *what;
    } wrong[] = {{"camera.position.y=1", "over the rim"},
                 {"camera.position=0.1,9,0.1", "over the rim"},
                 {"coin.rotation.x=5", "upright"},
                 {"liquid.m=1.1", "upright"},
                 {"liquid.capillary_length=0.1", "meniscus"},
                 {"cup.transparency=1", "opaque"},
                 {"coin.position.x=0.5", "in the plane"}};
    for (size_t i = 0; i < COUNT(wrong); i++) {
        scene *other = scene_clone(s);
        set(other, wrong[i].change);
        assert_int_equal(realism_measure_curve(other, isa_best(), REALISM_CURVE_COIN, &p, &why), STATUS_BAD_INPUT);
        if (!strstr(why.what, wrong[i].what) || !why.remedy[0])
            fail_msg("%s: %s", wrong[i].change, why.what);
        scene_destroy(other);
    }
    scene_destroy(s);
}

/* One medium, no wall: the place is 1 + s / L - s / f of the offset, with f = n R / (2 (n - 1)) (Hecht, table 6.1), so
 * the arrow turns around at s = L f / (L - f): behind the focal line, and just there for an eye far away. */
static void an_arrow_turns_around_behind_the_focal_line(void **state)
{
    (void)state;
    static const struct {
        double n, eye;
    } cases[] = {{1.333, 8.0}, {1.333, 400.0}, {1.5, 6.0}};
    scene *s = NULL;
    realism_points p;
    diagnostic why = {0};
    worked(scene_read("experiments/scenes/arrow.yaml", &s, &why), &why);
    for (size_t k = 0; k < COUNT(cases); k++) {
        const double n = cases[k].n, L = cases[k].eye, f = n / (2.0 * (n - 1.0));
        char text[120];
        snprintf(text, sizeof text, "vessel.ior=%g liquid.ior=%g camera.position.z=%g", n, n, -L);
        set_all(s, text);
        worked(realism_measure_curve(s, isa_best(), REALISM_CURVE_ARROW, &p, &why), &why);
        for (int i = 0; i < p.count; i++) {
            const double behind = p.at[i].x;
            assert_near(p.at[i].measured, (1.0 + behind / L - behind / f) / (1.0 + behind / L), 1e-6);
            if (fabs(behind - L * f / (L - f)) > 1e-3)
                assert_true((p.at[i].measured < 0.0) == (behind > L * f / (L - f)));
        }
    }
    set(s, "camera.position.z=-0.5");
    assert_int_equal(realism_measure_curve(s, isa_best(), REALISM_CURVE_ARROW, &p, &why), STATUS_BAD_INPUT);
    set(s, "liquid.visible=off");
    assert_int_equal(realism_measure_curve(s, isa_best(), REALISM_CURVE_ARROW, &p, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "'liquid'"));
    scene_destroy(s);
}

/* Straight on, the film of index n in air reflects nothing at multiples of lambda / (2 n), and 4 times an interface's
 * amplitude squared, ((n^2 - 1) / (n^2 + 1))^2, a quarter of lambda / n further (Hecht, 9.4.1 and 9.7). A quarter
 * wave of index sqrt(n) on a medium of index n reflects nothing. */
static void a_soap_film_is_dark_where_its_faces_cancel(void **state)
{
    (void)state;
    const double n = 1.33, bright = pow((n * n - 1.0) / (n * n + 1.0), 2);
    for (int order = 0; order < 4; order++) {
        assert_near(theory_film(0.0, 1.0, n, 1.0, order / (2.0 * n)), 0.0, 1e-15);
        assert_near(theory_film(0.0, 1.0, n, 1.0, (order + 0.5) / (2.0 * n)), bright, 1e-15);
    }
    assert_near(theory_film(0.0, 1.0, sqrt(1.5), 1.5, 0.25 / sqrt(1.5)), 0.0, 1e-15);
    assert_near(theory_film(50.0 * DEGREE, 1.0, 1.4, 1.6, 0.0), theory_fresnel(50.0 * DEGREE, 1.0, 1.6), 1e-15);
    scene *s = NULL;
    realism_points p;
    diagnostic why = {0};
    worked(scene_read("experiments/scenes/soap.yaml", &s, &why), &why);
    set_all(s, "soap.film_ior=1.25 render.lambda_nm=500 camera.position.x=0 camera.position.y=0");
    worked(realism_measure_curve(s, isa_best(), REALISM_CURVE_SOAP, &p, &why), &why);
    for (int i = 0; i < p.count; i++) {
        if (fmod(p.at[i].x, 200.0) == 0.0)
            assert_near(p.at[i].measured, 0.0, 1e-12);
        if (fmod(p.at[i].x, 200.0) == 100.0)
            assert_near(p.at[i].measured, pow(0.5625 / 2.5625, 2), 1e-12);
    }
    /* Askew, and on glass. */
    set_all(s, "soap.ior=1.5 camera.position.x=6");
    worked(realism_measure_curve(s, isa_best(), REALISM_CURVE_SOAP, &p, &why), &why);
    for (int i = 0; i < p.count; i++)
        assert_near(p.at[i].measured, p.at[i].theory, 1e-12);
    set(s, "film1.film_thickness_nm=0");
    assert_int_equal(realism_measure_curve(s, isa_best(), REALISM_CURVE_SOAP, &p, &why), STATUS_BAD_INPUT);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(critical_angles_of_water_glass_and_diamond_equal_the_textbooks_values),
        cmocka_unit_test(reflectances_at_known_angles_equal_the_textbooks_values),
        cmocka_unit_test(the_transmittance_of_a_slab_is_a_geometric_series),
        cmocka_unit_test(a_pile_of_plates_transmits_what_stokes_derived),
        cmocka_unit_test(gamma_is_highams),
        cmocka_unit_test(the_bound_of_a_reflectance_covers_a_rounded_sine),
        cmocka_unit_test(a_failed_measurement_remains_the_worst),
        cmocka_unit_test(plates_near_grazing_agree_within_rounding),
        cmocka_unit_test(one_medium_focuses_like_a_ball_lens),
        cmocka_unit_test(an_empty_vessel_is_a_diverging_lens),
        cmocka_unit_test(apparent_depth_of_a_pond_follows_from_its_index),
        cmocka_unit_test(the_view_equals_the_cameras),
        cmocka_unit_test(one_metric_equals_that_of_the_report),
        cmocka_unit_test(all_metrics_pass_for_various_indices),
        cmocka_unit_test(malus_depends_on_the_filters_alone),
        cmocka_unit_test(a_coin_appears_where_snells_law_puts_it),
        cmocka_unit_test(an_arrow_turns_around_behind_the_focal_line),
        cmocka_unit_test(a_soap_film_is_dark_where_its_faces_cancel),
        cmocka_unit_test(undefined_metrics_are_reported_as_undefined),
        cmocka_unit_test(a_relative_error_of_the_index_of_1e_8_fails),
        cmocka_unit_test(wrong_transmittance_and_absorption_fail),
        cmocka_unit_test(water_in_glass_disperses_as_published),
        cmocka_unit_test(scenes_without_vessel_rod_or_common_axis_are_refused),
        cmocka_unit_test(curves_equal_theory),
        cmocka_unit_test(curves_of_other_scenes_equal_theory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
