/* Tests of `cuvette fit`: known parameters are recovered from traced data, intervals cover the truth as often as they
 * say, sensitivities and tolerances have closed forms, rows are the same twice and after an interruption, and sections
 * with mistakes are refused with their place. */
#include "fit_fixture.h"

/* --- known parameters --- */

/* A ball lens with an index of its own, and rays at five heights. */
static const char ball_scene[] =
    "beams:\n"
    "  a: {kind: bundle, position: [-0.5, -4, 0], direction: [0, 1, 0], rays: 1, branches: off}\n"
    "  b: {kind: bundle, position: [-0.2, -4, 0], direction: [0, 1, 0], rays: 1, branches: off}\n"
    "  c: {kind: bundle, position: [0.1, -4, 0], direction: [0, 1, 0], rays: 1, branches: off}\n"
    "  d: {kind: bundle, position: [0.4, -4, 0], direction: [0, 1, 0], rays: 1, branches: off}\n"
    "  e: {kind: bundle, position: [0.6, -4, 0], direction: [0, 1, 0], rays: 1, branches: off}\n"
    "solids:\n"
    "  ball: {shape: sphere, transparency: 1, ior: 1.5, radius: 1, priority: 1}\n";
static const char ball_fit[] = "study: test\nscene: scene.yaml\nfit:\n"
                               "  parameters:\n"
                               "    ball.ior: {from: 1.2, to: 1.8, start: 1.45}\n"
                               "    ball.radius: {from: 0.8, to: 1.3, start: 1}\n"
                               "    ball.position.x: {from: -0.2, to: 0.2, start: 0}\n"
                               "  screen: {position: [0, 3, 0], normal: [0, 1, 0]}\n"
                               "  targets:\n"
                               "    a: {quantity: spot_u, beam: a, value: 0}\n"
                               "    b: {quantity: spot_u, beam: b, value: 0}\n"
                               "    c: {quantity: spot_u, beam: c, value: 0}\n"
                               "    d: {quantity: spot_u, beam: d, value: 0}\n"
                               "    e: {quantity: spot_u, beam: e, value: 0}\n";

static void recover(const fixture *folder, const char *scene_text, const char *text, int times, uint64_t seed)
{
    fit *f = fit_of(folder, scene_text, text);
    job *j = new_job();
    for (int i = 0; i < times; i++) {
        double truth[FIT_PARAMETERS_MAX];
        for (size_t k = 0; k < f->parameter_count; k++)
            truth[k] = random_real(&seed, f->parameters[k].from, f->parameters[k].to);
        aim(f, j, truth);
        fit_result *r = solve(f, NULL);
        for (size_t k = 0; k < f->parameter_count; k++)
            if (!(fabs(r->best.x[k] - truth[k]) < 1e-6))
                fail_msg("case %d: %s is %.12g, not %.12g; merit %g, %s", i, f->parameters[k].name, r->best.x[k],
                         truth[k], r->best.merit, r->ended);
        free(r);
    }
    job_destroy(j);
    fit_destroy(f);
}

static void parameters_are_recovered(void **state)
{
    recover(*state, slab_scene, SLAB_HEAD SLAB_TARGETS("weight: 1"), 20, 1);
    recover(*state, ball_scene, ball_fit, 20, 2);
}

static void every_method_finds_the_index(void **state)
{
    fit *f = fit_of(*state, ball_scene, ball_fit);
    job *j = new_job();
    const double truth[] = {1.52, 1.1, 0.05};
    aim(f, j, truth);
    for (int m = 0; m < FIT_METHOD_COUNT; m++) {
        const bool global = m == FIT_DIRECT || m == FIT_CRS;
        f->stages[0] = (fit_method)m;
        f->stages[1] = FIT_NELDER_MEAD;
        f->stage_count = m == FIT_NELDER_MEAD || m == FIT_DAMPED ? 1 : 2;
        f->evaluations = global ? 1000 : 4000;
        fit_result *r = solve(f, NULL);
        for (size_t k = 0; k < 3; k++)
            if (!(fabs(r->best.x[k] - truth[k]) < 1e-6))
                fail_msg("%s: %s is %.12g", fit_method_words[m], f->parameters[k].name, r->best.x[k]);
        free(r);
    }
    job_destroy(j);
    fit_destroy(f);
}

/* --- intervals --- */

/* How many of the 95 % intervals of noisy data cover the truth: between the 0.01 % quantiles of the binomial
 * distribution of 300 trials. */
static void count_covered(const fixture *folder, const char *text)
{
    enum { TRIALS = 300, LEAST = 269, MOST = 297 };
    fit *f = fit_of(folder, slab_scene, text);
    job *j = new_job();
    uint64_t seed = 5;
    int covered = 0;
    f->precision = 1e-7;
    for (int i = 0; i < TRIALS; i++) {
        const double truth = random_real(&seed, 1.3, 1.7);
        aim(f, j, &truth);
        for (size_t k = 0; k < f->target_count; k++)
            f->targets[k].value += 0.002 * normal(&seed);
        fit_result *r = solve(f, NULL);
        assert_true(r->has_interval);
        covered += fabs(r->best.x[0] - truth) <= r->half[0];
        free(r);
    }
    if (covered < LEAST || covered > MOST)
        fail_msg("%d of %d intervals cover the truth", covered, TRIALS);
    job_destroy(j);
    fit_destroy(f);
}

static void intervals_cover_the_truth(void **state)
{
    count_covered(*state, SLAB_HEAD SLAB_TARGETS("sigma: 0.002"));
    count_covered(*state, SLAB_HEAD SLAB_TARGETS("weight: 1")); /* Student's t with two degrees of freedom */
}

static void what_is_not_determined_has_no_interval(void **state)
{
    /* The slab's height changes no ray's displacement. */
    fit *f =
        fit_of(*state, slab_scene,
               "study: test\nscene: scene.yaml\nfit:\n  parameters: {slab.ior: {from: 1.1, to: 1.9}, slab.position.y: "
               "{from: 0.4, to: 0.6}}\n" SLAB_TARGETS("sigma: 0.002"));
    fit_result *r = solve(f, NULL);
    assert_false(r->has_interval);
    free(r);
    fit_destroy(f);
}

/* --- sensitivities and tolerances --- */

static void derivatives_and_tolerances_have_closed_forms(void **state)
{
    static const double angles[] = {20 * DEGREE, 40 * DEGREE, 60 * DEGREE};
    fit *f = fit_of(*state, slab_scene, SLAB_HEAD SLAB_TARGETS("sigma: 0.001"));
    job *j = new_job();
    const double truth = 1.47;
    double information = 0.0;
    aim(f, j, &truth);
    for (size_t i = 0; i < 3; i++) { /* from the unbent ray, in air */
        double air[FIT_TARGETS_MAX], glass[FIT_TARGETS_MAX], slope;
        const double one = 1.0;
        assert_int_equal(fit_measure_at(f, j, &one, air, NULL), STATUS_OK);
        assert_int_equal(fit_measure_at(f, j, &truth, glass, NULL), STATUS_OK);
        assert_true(fabs(fabs(glass[i] - air[i]) - plate_shift(truth, angles[i], &slope)) < 1e-13);
        information += slope * slope / 1e-6;
    }
    fit_result *r = solve(f, NULL);
    for (size_t i = 0; i < 3; i++) {
        double slope;
        plate_shift(truth, angles[i], &slope);
        assert_true(fabs(fabs(r->derivative.by[i][0]) - slope) < 1e-7);
    }
    assert_true(fabs(r->error[0] * sqrt(information) - 1.0) < 1e-6);
    assert_true(fabs(r->half[0] / r->error[0] - 1.959963984540054) < 1e-9);
    assert_true(r->worsening == 1.0);
    /* The merit is quadratic up to the curvature of the shift. */
    assert_true(fabs(r->tolerance[0][1] * sqrt(information) - 1.0) < 0.01);
    assert_true(fabs(-r->tolerance[0][0] * sqrt(information) - 1.0) < 0.01);
    for (int side = 0; side < 2; side++) {
        const double x = r->best.x[0] + r->tolerance[0][side];
        double values[FIT_TARGETS_MAX];
        assert_int_equal(fit_measure_at(f, j, &x, values, NULL), STATUS_OK);
        assert_true(fabs(fit_merit(f, values) - r->best.merit - 1.0) < 1e-5);
    }
    free(r);
    job_destroy(j);
    fit_destroy(f);
}

static void bounds_hold_and_are_told(void **state)
{
    fit *f = fit_of(*state, slab_scene, SLAB_HEAD SLAB_TARGETS("sigma: 0.001"));
    job *j = new_job();
    const double truth = 1.6;
    aim(f, j, &truth);
    f->parameters[0].to = 1.55;
    fit_result *r = solve(f, NULL);
    if (!(1.55 - r->best.x[0] < 1e-9 && r->best.x[0] <= 1.55 && r->derivative.at_bound[0]))
        fail_msg("%.17g", r->best.x[0]);
    assert_true(isnan(r->tolerance[0][1]) && r->tolerance[0][0] < 0.0);
    free(r);
    job_destroy(j);
    fit_destroy(f);
}

/* --- lenses --- */

static const char singlet_scene[] =
    "beams: {sun: {kind: bundle, position: [0, -10, 0], direction: [0, 1, 0], width: 4, rays: 40, branches: off}}\n"
    "solids: {glass: {shape: lens, transparency: 1, ior: 1.5, radius_1: 100, radius_2: -100, thickness: 0.12, "
    "diameter: 5, priority: 1}}\n";

/* Third order, thin lens, object at infinity: Jenkins and White, Fundamentals of Optics, 9.5. */
static void the_best_form_is_that_of_third_order(void **state)
{
    static const double indices[] = {1.4, 1.5, 1.7};
    for (size_t i = 0; i < COUNT(indices); i++) {
        char text[700];
        const double n = indices[i], curvature = 0.005 / (n - 1.0); /* focal length 100 */
        snprintf(
            text, sizeof text,
            "study: test\nscene: scene.yaml\nset: {glass.ior: %g}\nfit:\n  parameters: {q: {from: -1, to: 2, start: 0, "
            "reciprocal: on, sets: {glass.radius_1: [%.17g, %.17g], glass.radius_2: [%.17g, %.17g]}}}\n"
            "  minimise: {quantity: focus_rms, screen: {position: [0, 100, 0]}}\n  precision: 1e-6\n",
            n, curvature, curvature, -curvature, curvature);
        fit *f = fit_of(*state, singlet_scene, text);
        fit_result *r = solve(f, NULL);
        assert_true(fabs(r->best.x[0] - 2.0 * (n * n - 1.0) / (n + 2.0)) < 2e-3);
        assert_true(fabs(r->derivative.by[0][0]) < 1e-6);
        assert_true(r->worsening == 0.1 * r->best.merit && r->tolerance[0][1] > 0.0);
        free(r);
        fit_destroy(f);
    }
}

/* Two thin lenses in contact, whose surfaces are nearly at one place: of power 0.01 and without primary colour, the
 * powers are phi V1 / (V1 - V2) and -phi V2 / (V1 - V2) (Hecht, Optics, 6.3.2). */
static const char doublet_scene[] = "beams:\n"
                                    "  d: {kind: bundle, position: [0, -1, 0], direction: [0, 1, 0], width: 0.01, "
                                    "rays: 5, lambda_nm: 587.5618, branches: off}\n"
                                    "  F: {kind: bundle, position: [0, -1, 0], direction: [0, 1, 0], width: 0.01, "
                                    "rays: 5, lambda_nm: 486.1327, branches: off}\n"
                                    "  C: {kind: bundle, position: [0, -1, 0], direction: [0, 1, 0], width: 0.01, "
                                    "rays: 5, lambda_nm: 656.2725, branches: off}\n"
                                    "solids:\n"
                                    "  crown: {shape: lens, transparency: 1, medium: bk7, radius_1: 0, radius_2: 0, "
                                    "thickness: 0.01, diameter: 0.2, priority: 2}\n"
                                    "  flint: {shape: lens, transparency: 1, medium: sf11, position: [0, 0.015, 0], "
                                    "radius_1: 0, radius_2: 0, thickness: 0.01,\n"
                                    "    diameter: 0.2, priority: 1}\n";
static const char doublet_fit[] =
    "study: test\nscene: scene.yaml\nfit:\n"
    "  parameters: # powers over n - 1\n"
    "    crown: {from: -0.1, to: 0.1, start: 0, reciprocal: on, sets: {crown.radius_1: 1}}\n"
    "    flint: {from: -0.1, to: 0.1, start: 0, reciprocal: on, sets: {flint.radius_1: 1}}\n"
    "  screen: {position: [0, 1, 0]}\n"
    "  targets:\n"
    "    power: {beam: d, value: 0.01, weight: 1e4}\n"
    "    colour: {quantity: power, beam: F, minus: {quantity: power, beam: C}, value: 0, weight: 1e8}\n";

static void a_doublet_becomes_an_achromat(void **state)
{
    const double n1[] = {1.5168000345, 1.5223762897, 1.5143223473}; /* Schott's formulas at d, F and C */
    const double n2[] = {1.7847182, 1.8064517, 1.7759900};
    const double v1 = (n1[0] - 1) / (n1[1] - n1[2]), v2 = (n2[0] - 1) / (n2[1] - n2[2]);
    fit *f = fit_of(*state, doublet_scene, doublet_fit);
    fit_result *r = solve(f, NULL);
    const double crown = 0.01 * v1 / (v1 - v2) / (n1[0] - 1), flint = -0.01 * v2 / (v1 - v2) / (n2[0] - 1);
    assert_true(fabs(r->best.values[0] - 0.01) < 1e-9 && fabs(r->best.values[1]) < 1e-11);
    assert_true(fabs(r->best.x[0] / crown - 1.0) < 2e-3);
    assert_true(fabs(r->best.x[1] / flint - 1.0) < 2e-3);
    free(r);
    fit_destroy(f);
}

/* --- shipped fits --- */

static fit_result *shipped(const char *path, fit **f)
{
    diagnostic why = {.what = ""};
    if (fit_read(path, f, &why) != STATUS_OK)
        fail_msg("%s", why.what);
    return solve(*f, NULL);
}

static void shipped_fits_find_what_is_published(void **state)
{
    fit *f;
    (void)state;
    fit_result *r = shipped("experiments/fits/index_of_water.study", &f);
    assert_true(fabs(r->best.x[0] - 1.33340) < r->half[0] && r->half[0] < 0.005); /* water at the d line */
    free(r), fit_destroy(f);
    r = shipped("experiments/fits/least_spot.study", &f);
    assert_true(fabs(r->best.x[0] - 0.7143) < 2e-3);
    free(r), fit_destroy(f);
    r = shipped("experiments/fits/achromat.study", &f);
    static const double radii[] = {62.8, -45.7, -128.2}; /* Thorlabs AC254-100-A */
    for (int i = 0; i < 3; i++)
        assert_true(fabs(r->best.x[i] * radii[i] - 1.0) < 0.01);
    free(r), fit_destroy(f);
}

/* --- quantities --- */

/* A uniform sky, which is in every pixel but those of a black ball. */
static const char sky_scene[] =
    "render: {width: 24, height: 18, depth: 1}\n"
    "camera: {position: [0, 0, -5], target: [0, 0, 0]}\n"
    "background: {kind: uniform, color: [0.5, 0.25, 0.125]}\n"
    "solids: {ball: {shape: sphere, radius: 1, color: [0, 0, 0], ambient: 0, diffuse: 0}}\n";

static void frames_are_quantities(void **state)
{
    fit *f =
        fit_of(*state, sky_scene,
               "study: test\nscene: scene.yaml\nfit:\n"
               "  parameters: {ball.radius: {from: 0.1, to: 2}}\n"
               "  targets:\n"
               "    first_hits.ball: {value: 100}\n"
               "    rays_camera: {value: 0}\n"
               "    corner: {quantity: radiance, pixel: [0, 0], channel: green, value: 0}\n"
               "    mean: {quantity: radiance, channel: red, value: 0}\n"
               "    both: {quantity: radiance, pixel: [23, 17], value: 0}\n"
               "    none: {quantity: first_hits.ball, set: {ball.visible: off}, value: 0}\n"
               "    fewer: {quantity: first_hits.ball, minus: {quantity: first_hits.ball, set: {camera.fov_deg: 90}}, "
               "value: 0}\n");
    job *j = new_job();
    double v[FIT_TARGETS_MAX];
    assert_int_equal(f->setting_count, 3);
    assert_int_equal(fit_measure_at(f, j, &f->parameters[0].start, v, NULL), STATUS_OK);
    assert_true(f->parameters[0].start == 1.0); /* the scene's */
    assert_true(v[1] == 24 * 18 && v[0] > 0 && v[0] < v[1] && v[0] == floor(v[0]));
    assert_true(v[2] == 0.25 && fabs(v[4] - 0.875 / 3) < 1e-12);
    assert_true(fabs(v[3] - 0.5 * (1 - v[0] / v[1])) < 1e-12);
    assert_true(v[5] == 0.0 && v[6] > 0.0);
    job_destroy(j);
    fit_destroy(f);
}

static void lost_rays_are_not_measured(void **state)
{
    static const char text[] = "study: test\nscene: scene.yaml\nfit:\n"
                               "  parameters: {stop.position.x: {from: -3, to: 3, start: 3}}\n"
                               "  targets:\n"
                               "    x: {quantity: spot_u, value: 0}\n"
                               "    light: {quantity: received, value: 1}\n"
                               "  screen: {position: [0, 3, 0]}\n";
    static const char scene_text[] =
        "beams: {a: {kind: bundle, position: [0, -4, 0], direction: [0, 1, 0], rays: 1, branches: off}}\n"
        "solids: {stop: {shape: box, size: [2, 0.1, 2]}}\n";
    fit *f = fit_of(*state, scene_text, text);
    job *j = new_job();
    double open = 3, shut = 0, v[FIT_TARGETS_MAX];
    diagnostic why = {.what = ""};
    fit_result *r = calloc(1, sizeof *r);
    fit_run *run = NULL;
    assert_int_equal(fit_measure_at(f, j, &open, v, NULL), STATUS_OK);
    assert_true(v[0] == 0.0 && v[1] == 1.0);
    assert_int_equal(fit_measure_at(f, j, &shut, v, NULL), STATUS_OK);
    assert_true(isnan(v[0]) && v[1] == 0.0);
    f->parameters[0].start = 0.0;
    assert_int_equal(fit_run_begin(f, &(fit_options){.results = NULL}, &run, NULL), STATUS_OK);
    assert_int_equal(fit_search(run, r, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "x cannot be measured at the start");
    fit_run_end(run);
    free(r);
    job_destroy(j);
    fit_destroy(f);
}

/* --- rows --- */

static const char rows_study[] = "study: test\nscene: scene.yaml\nset: {render.threads: %d}\nfit:\n"
                                 "  parameters: {slab.ior: {from: 1.1, to: 1.9}, slab.position.x: {from: -3, to: 3}}\n"
                                 "  targets:\n"
                                 "    a: {quantity: spot_v, beam: a, value: 0.1, sigma: 0.01}\n"
                                 "    rays_total: {value: 300}\n"
                                 "    sky: {quantity: radiance, value: 0.3}\n"
                                 "  screen: {position: [0, 5, 0]}\n"
                                 "  evaluations: 30\n";

static char *rows_of(const fixture *folder, int threads, const char *results, size_t *new_rows)
{
    char text[1200], path[700];
    fit_run *run = NULL;
    fit_result *r = calloc(1, sizeof *r);
    snprintf(text, sizeof text, rows_study, threads);
    fit *f = fit_of(folder, slab_scene, text);
    snprintf(path, sizeof path, "%s/%s", folder->folder, results);
    assert_int_equal(fit_run_begin(f, &(fit_options){.results = path}, &run, NULL), STATUS_OK);
    assert_int_equal(fit_search(run, r, NULL), STATUS_OK);
    assert_int_equal(fit_spread(run, r, NULL), STATUS_OK);
    *new_rows = fit_run_new(run);
    fit_run_end(run);
    fit_destroy(f);
    free(r);
    snprintf(path, sizeof path, "%s/test/fit.csv", results);
    return fixture_text(folder, path);
}

static void rows_are_the_same_twice_and_for_any_threads(void **state)
{
    size_t one_new, three_new, again_new;
    char *one = rows_of(*state, 1, "one", &one_new), *three = rows_of(*state, 3, "three", &three_new);
    char *again = rows_of(*state, 1, "one", &again_new);
    assert_true(one_new > 30 && three_new == one_new && again_new == 0);
    assert_int_equal(fixture_count(one, "\n"), one_new + 1);
    assert_string_equal(one, three);
    assert_string_equal(one, again);
    free(one), free(three), free(again);
}

/* Killed after any row, or within one, and run again: the rows of an unbroken run. */
static void a_fit_goes_on_where_it_stopped(void **state)
{
    size_t count;
    char *whole = rows_of(*state, 1, "whole", &count);
    const size_t size = strlen(whole);
    for (size_t cut = size; cut > strcspn(whole, "\n"); cut -= cut > size / 7 ? size / 7 : cut) {
        char path[400];
        size_t rest;
        fixture_path(*state, "whole/test/fit.csv", path);
        assert_int_equal(truncate(path, (off_t)cut), 0);
        char *resumed = rows_of(*state, 1, "whole", &rest);
        assert_string_equal(resumed, whole);
        assert_true(rest < count && (cut == size) == (rest == 0));
        free(resumed);
    }
    free(whole);
}

/* Rows that were edited, and of another scene, are kept and not used. */
static void rows_of_something_else_are_not_used(void **state)
{
    char path[400], text[1200];
    size_t count, rest;
    char *whole = rows_of(*state, 1, "edited", &count), *copy = strdup(whole);
    char *digit = strstr(copy, ",start,") + strlen(",start,1.5,0,0.0"); /* of the start's first target */
    *digit = *digit == '1' ? '2' : '1';
    fixture_write(*state, "edited/test/fit.csv", copy);
    fixture_path(*state, "edited/test/fit.csv", path);
    char *after = rows_of(*state, 1, "edited", &rest);
    assert_int_equal(rest, 1);
    assert_true(strncmp(after, copy, strlen(copy)) == 0);
    snprintf(text, sizeof text, rows_study, 1);
    fit *f = fit_of(*state, singlet_scene,
                    "study: test\nscene: scene.yaml\nfit:\n  parameters: {glass.ior: {from: 1.4, to: "
                    "1.6}}\n  minimise: received\n  screen: {position: [0, 9, 0]}\n");
    fit_run *run = NULL;
    char results[600];
    snprintf(results, sizeof results, "%s/edited", ((fixture *)*state)->folder);
    assert_int_equal(fit_run_begin(f, &(fit_options){.results = results}, &run, NULL), STATUS_OK);
    assert_int_equal(fit_run_set_aside(run), count + 1);
    fit_run_end(run);
    fit_destroy(f);
    free(whole), free(copy), free(after);
}

/* --- mistakes --- */

static void mistakes_are_refused_with_their_place(void **state)
{
    static const struct {
        const char *section, *what;
        long line, column;
    } bad[] = {
        {"fit: {}", "fit is not a map", 3, 6},
        {"fit: {targets: {a: {quantity: spot_u, value: 0}}}", "the fit has no parameters", 3, 6},
        {"fit: {parameters: {slab.ior: {from: 1, to: 2}}}", "the fit has no goal", 3, 6},
        {"fit: {parameters: {slab.ior: {from: 1}}}", "the parameter has no 'to'", 3, 30},
        {"fit: {parameters: {slab.ior: {from: 2, to: 1}}}", "from 2 is not less than to 1", 3, 30},
        {"fit: {parameters: {slab.ior: {from: 1, to: 2, start: 3}}}", "start: 3 is out of range", 3, 54},
        {"fit: {parameters: {slab.ior: {from: -1, to: 2}}}", "slab.ior: -1 is out of range", 3, 37},
        {"fit: {parameters: {slab.iro: {from: 1, to: 2}}}", "slab has no parameter 'iro'", 3, 20},
        {"fit: {parameters: {render.depth: {from: 1, to: 2}}}", "render.depth is not a real number", 3, 20},
        {"fit: {parameters: {x: {from: 1, to: 2, sets: {slab.ior: 0}}}}",
         "with the factor 0 the parameter does nothing", 3, 57},
        {"fit: {parameters: {x: {from: 1, to: 2, sets: {slab.ior: 1}}, slab.ior: {from: 1, to: 2}}}",
         "slab.ior is already set by the parameter x", 3, 62},
        {"fit: {parameters: {x: {from: 1, to: 2, sets: {slab.ior: 1}, reciprocal: maybe}}}",
         "reciprocal is neither on nor off", 3, 73},
        {"set: {slab.ior: 1.4}\nfit: {parameters: {slab.ior: {from: 1, to: 2}}}",
         "slab.ior is already set for the whole study", 4, 20},
        {"grid: [{render.depth: [1]}]\nfit: {}", "unknown key 'grid'", 3, 1},
        {"fit: {parameters: {merit: {from: 1, to: 2, sets: {slab.ior: 1}}}}", "'merit' cannot be the name of a column",
         3, 20},
#define GOAL "fit:\n  parameters: {slab.ior: {from: 1.1, to: 1.9}}\n"
        {GOAL "  targets: {spot_u: {value: 0}}", "spot_u needs a screen", 5, 21},
        {GOAL "  targets: {spot_x: {value: 0}}", "unknown quantity 'spot_x'", 5, 13},
        {GOAL "  targets: {wall_s: {value: 0}}", "wall_s cannot be fitted", 5, 13},
        {GOAL "  targets: {rays_total: {weight: 1}}", "the target has no value", 5, 25},
        {GOAL "  targets: {rays_total: {value: 1, sigma: 1, weight: 1}}", "the target has a sigma and a weight", 5, 25},
        {GOAL "  targets: {rays_total: {value: 1, sigma: 0}}", "sigma: 0 is out of range", 5, 43},
        {GOAL "  targets: {rays_total: {value: 1, beam: a}}", "beam has no effect on rays_total", 5, 42},
        {GOAL "  targets: {slab.ior: {quantity: rays_total, value: 1}}", "slab.ior is already a parameter of the fit",
         5, 13},
        {GOAL "  targets: {focus: {beam: z, value: 1}}\n  screen: {position: [0, 1, 0]}", "the scene has no beam 'z'",
         5, 27},
        {GOAL "  targets: {focus: {beam: a, lambda_nm: 400, value: 1}}\n  screen: {position: [0, 1, 0]}",
         "the scene has no such beam with this wavelength", 5, 20},
        {GOAL "  targets: {radiance: {pixel: [1.5, 2], value: 1}}", "this is not a pixel", 5, 31},
        {GOAL "  targets: {radiance: {set: {slab.ior: 2}, value: 1}}",
         "slab.ior is already set by the parameter slab.ior", 5, 29},
        {GOAL "  minimise: rays_total\n  maximise: rays_total", "the fit has two goals", 6, 13},
        {GOAL "  minimise: rays_total\n  method: newton", "unknown method", 6, 11},
        {GOAL "  minimise: rays_total\n  method: bobyqa", "bobyqa needs two parameters", 6, 11},
        {GOAL "  minimise: rays_total\n  method: [direct, damped]", "damped least squares needs targets", 6, 20},
        {GOAL "  minimise: rays_total\n  evaluations: 1.5", "evaluations is not an integer", 6, 16},
        {GOAL "  minimise: rays_total\n  interval: linear", "only targets give intervals", 6, 13},
        {GOAL "  targets: {rays_total: {value: 1}}\n  interval: exact", "interval is neither linear nor profile", 6,
         13},
        {GOAL "  minimise: rays_total\n  screen: {normal: [0, 0, 0]}", "the screen's normal is zero", 6, 20},
        {"repetitions: 3", "the study has no section fit", 1, 1},
    };
    int wrong = 0;
    for (size_t i = 0; i < COUNT(bad); i++) {
        char text[600];
        diagnostic why = {.what = ""};
        fit *f = NULL;
        snprintf(text, sizeof text, "study: test\nscene: scene.yaml\n%s\n", bad[i].section);
        assert_int_equal(read_fit(*state, slab_scene, text, &f, &why), STATUS_BAD_INPUT);
        assert_null(f);
        if (!strstr(why.what, bad[i].what) || why.line != bad[i].line || why.column != bad[i].column ||
            !why.remedy[0]) {
            print_error("%zu: %ld:%ld: %s; %s\n", i, why.line, why.column, why.what, why.remedy);
            wrong++;
        }
    }
    assert_int_equal(wrong, 0);
}

/* What only the first measurement shows, too. */
static void quantities_without_a_value_are_refused_with_their_place(void **state)
{
    static const struct {
        const char *targets, *what;
        long column;
    } bad[] = {
        {"{rays_total: {value: 1}, lens.powr: {value: 1}}", "there is no visible cup named 'vessel'", 37},
        {"{rays_total: {value: 1}, p: {quantity: radiance, pixel: [99, 0], value: 1}}",
         "pixel 99,0 is outside the image", 51},
        {"{rays_total: {value: 1}, f: {quantity: focus, beam: a, value: 1, screen: {position: [0, 5, 0]}}}",
         "f cannot be measured at the start", 51},
    };
    for (size_t i = 0; i < COUNT(bad); i++) {
        char text[600];
        diagnostic why = {.what = ""};
        fit_result *r = calloc(1, sizeof *r);
        fit_run *run = NULL;
        snprintf(text, sizeof text, SLAB_HEAD "  targets: %s\n", bad[i].targets);
        fit *f = fit_of(*state, slab_scene, text);
        assert_int_equal(fit_run_begin(f, &(fit_options){.results = NULL}, &run, NULL), STATUS_OK);
        assert_int_equal(fit_search(run, r, &why), STATUS_BAD_INPUT);
        if (strcmp(why.what, bad[i].what) != 0 || why.line != 5 || why.column != bad[i].column ||
            !strstr(why.file, "test.study"))
            fail_msg("%zu: %s:%ld:%ld: %s", i, why.file, why.line, why.column, why.what);
        fit_run_end(run);
        free(r);
        fit_destroy(f);
    }
}

static void a_study_with_a_fit_is_not_swept(void **state)
{
    char path[400];
    diagnostic why = {.what = ""};
    study *s = NULL;
    fixture_write(*state, "scene.yaml", slab_scene);
    fixture_write(*state, "test.study", SLAB_HEAD SLAB_TARGETS("weight: 1"));
    fixture_path(*state, "test.study", path);
    assert_int_equal(study_read(path, &s, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.remedy, "run it with 'cuvette fit'");
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, fixture_setup, fixture_teardown)
    const struct CMUnitTest tests[] = {
        IN_FOLDER(parameters_are_recovered),
        IN_FOLDER(every_method_finds_the_index),
        IN_FOLDER(intervals_cover_the_truth),
        IN_FOLDER(what_is_not_determined_has_no_interval),
        IN_FOLDER(derivatives_and_tolerances_have_closed_forms),
        IN_FOLDER(bounds_hold_and_are_told),
        IN_FOLDER(the_best_form_is_that_of_third_order),
        IN_FOLDER(a_doublet_becomes_an_achromat),
        cmocka_unit_test(shipped_fits_find_what_is_published),
        IN_FOLDER(frames_are_quantities),
        IN_FOLDER(lost_rays_are_not_measured),
        IN_FOLDER(rows_are_the_same_twice_and_for_any_threads),
        IN_FOLDER(a_fit_goes_on_where_it_stopped),
        IN_FOLDER(rows_of_something_else_are_not_used),
        IN_FOLDER(mistakes_are_refused_with_their_place),
        IN_FOLDER(quantities_without_a_value_are_refused_with_their_place),
        IN_FOLDER(a_study_with_a_fit_is_not_swept),
    };
    return cmocka_run_group_tests_name("fit", tests, NULL, NULL);
}
