/* Tests of the intervals of `cuvette fit` that follow the profile: its closed form for the displacement by a plate, to
 * which the thickness is proportional; how many cover the truth where linear ones do not; and what is said at a bound,
 * without a scale of the errors, of a missed minimum, and when evaluations do not suffice. */
#include "fit_fixture.h"

static const double angles[] = {20 * DEGREE, 40 * DEGREE, 60 * DEGREE};

/* --- closed forms --- */

typedef struct plate {
    double displacement[3], weight;
} plate;

/* The merit at an index and a thickness. */
static double plate_merit(const plate *p, double n, double thickness)
{
    double sum = 0.0, slope;
    for (int i = 0; i < 3; i++) {
        const double off = thickness * plate_shift(n, angles[i], &slope) - p->displacement[i];
        sum += p->weight * off * off;
    }
    return sum;
}

/* The least merit at an index: the best thickness is that of linear least squares (Golub and Pereyra, SIAM J. Numer.
 * Anal. 10, 1973). */
static double profile_of_index(const plate *p, double n)
{
    double up = 0.0, down = 0.0, slope;
    for (int i = 0; i < 3; i++) {
        const double shift = plate_shift(n, angles[i], &slope);
        up += shift * p->displacement[i], down += shift * shift;
    }
    return plate_merit(p, n, up / down);
}

static double merit_of_index(const plate *p, double n)
{
    return plate_merit(p, n, 1.0);
}

/* The least merit at a thickness, by golden sections over the index. */
static double profile_of_thickness(const plate *p, double thickness)
{
    double low = 1.05, high = 2.5;
    while (high - low > 1e-12) {
        const double a = high - 0.6180339887498949 * (high - low), b = low + 0.6180339887498949 * (high - low);
        if (plate_merit(p, a, thickness) < plate_merit(p, b, thickness))
            high = b;
        else
            low = a;
    }
    return plate_merit(p, 0.5 * (low + high), thickness);
}

/* Where the profile is `rise` above its least value, between there and beyond it. */
static double crossing(double (*profile)(const plate *, double), const plate *p, double least, double inside,
                       double outside, double rise)
{
    for (int i = 0; i < 100; i++) {
        const double middle = 0.5 * (inside + outside);
        if (profile(p, middle) - least < rise)
            inside = middle;
        else
            outside = middle;
    }
    return 0.5 * (inside + outside);
}

/* The fit's targets as displacements of the plate, from the unbent ray. */
static plate plate_of(const fit *f, job *j)
{
    plate p = {.weight = f->targets[0].weight};
    double air[FIT_TARGETS_MAX];
    double x[FIT_PARAMETERS_MAX] = {1.0, 1.0};
    assert_int_equal(fit_measure_at(f, j, x, air, NULL), STATUS_OK);
    for (int i = 0; i < 3; i++)
        p.displacement[i] = fabs(f->targets[i].value - air[i]);
    return p;
}

static void expect_end(const char *what, double found, double expected, double width)
{
    if (!(fabs(found - expected) < 1e-5 * width))
        fail_msg("%s: %.12g, not %.12g", what, found, expected);
}

#define THICKNESS_HEAD                       \
    "study: test\nscene: scene.yaml\nfit:\n" \
    "  parameters:\n"                        \
    "    slab.ior: {from: 1.02, to: 2.6}\n"  \
    "    slab.size.y: {from: 0.2, to: 4}\n"  \
    "  method: damped\n"
#define INDEX_HEAD "study: test\nscene: scene.yaml\nfit:\n  parameters: {slab.ior: {from: 1.02, to: 2.6}}\n"

static void the_profile_of_one_parameter_has_a_closed_form(void **state)
{
    fit *f = fit_of(*state, slab_scene, INDEX_HEAD SLAB_TARGETS("sigma: 0.05"));
    job *j = new_job();
    const double truth = 1.5;
    aim(f, j, &truth);
    f->targets[0].value += 0.02, f->targets[1].value -= 0.03, f->targets[2].value += 0.01;
    fit_result *r = solve(f, NULL);
    const plate p = plate_of(f, j);
    const double n = r->best.x[0], least = merit_of_index(&p, n), rise = 3.841458820694124; /* chi-squared, 1 degree */
    assert_true(fabs(least - r->best.merit) < 1e-9);
    assert_true(r->has_profile[0] && !r->open[0][0] && !r->open[0][1]);
    const double width = r->profile[0][1] - r->profile[0][0];
    expect_end("low", r->profile[0][0], crossing(merit_of_index, &p, least, n, 1.02, rise), width);
    expect_end("high", r->profile[0][1], crossing(merit_of_index, &p, least, n, 2.6, rise), width);
    assert_true(r->profile[0][1] - n > 1.1 * (n - r->profile[0][0])); /* a linear interval would be symmetric */
    free(r);
    job_destroy(j);
    fit_destroy(f);
}

/* Two parameters with one degree of freedom: Student's t 12.7062, its square the quantile of F(1, 1). And with standard
 * deviations. */
static void profiles_of_two_parameters_have_closed_forms(void **state)
{
    static const char *const errors[] = {"weight: 1", "sigma: 0.002"};
    for (size_t k = 0; k < COUNT(errors); k++) {
        char text[1200];
        snprintf(text, sizeof text, THICKNESS_HEAD SLAB_TARGETS("%s"), errors[k], errors[k], errors[k]);
        fit *f = fit_of(*state, slab_scene, text);
        job *j = new_job();
        const double truth[] = {1.5, 1.0};
        aim(f, j, truth);
        const double noise = k == 0 ? 1e-4 : 2e-3;
        f->targets[0].value += noise, f->targets[1].value -= noise, f->targets[2].value += 0.5 * noise;
        fit_result *r = solve(f, NULL);
        const plate p = plate_of(f, j);
        const double n = r->best.x[0], t = r->best.x[1], least = profile_of_index(&p, n),
                     rise = k == 0 ? 12.706204736174698 * 12.706204736174698 * least : 3.841458820694124;
        assert_true(fabs(least / r->best.merit - 1.0) < 1e-6);
        for (int i = 0; i < 2; i++)
            assert_true(r->has_profile[i] && !r->open[i][0] && !r->open[i][1]);
        const double width[] = {r->profile[0][1] - r->profile[0][0], r->profile[1][1] - r->profile[1][0]};
        expect_end("index, low", r->profile[0][0], crossing(profile_of_index, &p, least, n, 1.05, rise), width[0]);
        expect_end("index, high", r->profile[0][1], crossing(profile_of_index, &p, least, n, 2.5, rise), width[0]);
        expect_end("thickness, low", r->profile[1][0], crossing(profile_of_thickness, &p, least, t, 0.2, rise),
                   width[1]);
        expect_end("thickness, high", r->profile[1][1], crossing(profile_of_thickness, &p, least, t, 4.0, rise),
                   width[1]);
        free(r);
        job_destroy(j);
        fit_destroy(f);
    }
}

/* --- coverage --- */

/* Of 400 fits to noisy displacements, how many intervals of the index cover the truth: [0]
 * profile, [1] linear. */
static void count_covered(const fixture *folder, const char *text, double index, double noise, int covered[2])
{
    enum { TRIALS = 400 };
    fit *f = fit_of(folder, slab_scene, text);
    job *j = new_job();
    uint64_t seed = 7;
    f->worsening = 1e-300; /* tolerances are not wanted */
    covered[0] = covered[1] = 0;
    for (int i = 0; i < TRIALS; i++) {
        const double truth[] = {index, 1.0};
        aim(f, j, truth);
        for (size_t k = 0; k < f->target_count; k++)
            f->targets[k].value += noise * normal(&seed);
        fit_result *r = solve(f, NULL);
        assert_true(r->has_profile[0]);
        covered[0] += truth[0] >= r->profile[0][0] && truth[0] <= r->profile[0][1];
        covered[1] += fabs(r->best.x[0] - truth[0]) <= r->half[0];
        free(r);
    }
    job_destroy(j);
    fit_destroy(f);
}

static void profiles_cover_the_truth_where_linear_intervals_do_not(void **state)
{
    enum { LEAST = 363, MOST = 395 }; /* the 0.01 % quantiles of the binomial distribution of 400 trials */
    int covered[2];
    count_covered(*state, THICKNESS_HEAD SLAB_TARGETS("sigma: 0.01"), 1.4, 0.01, covered);
    assert_in_range(covered[0], LEAST, MOST);
    count_covered(*state, INDEX_HEAD SLAB_TARGETS("weight: 1"), 1.4, 0.01, covered);
    assert_in_range(covered[0], LEAST, MOST);
    /* Noise over which the displacement is far from linear in the index; bounds only add to what is covered. */
    count_covered(*state, THICKNESS_HEAD SLAB_TARGETS("sigma: 0.05"), 1.8, 0.05, covered);
    print_message("# far from linear: %d profiles and %d linear intervals of 400 cover the truth\n", covered[0],
                  covered[1]);
    assert_in_range(covered[0], LEAST, 400);
    assert_true(covered[1] < LEAST);
}

/* --- what a profile cannot say --- */

static void an_end_at_the_bound_is_told(void **state)
{
    fit *f = fit_of(*state, slab_scene, INDEX_HEAD SLAB_TARGETS("sigma: 0.05"));
    job *j = new_job();
    const double truth = 1.5;
    aim(f, j, &truth);
    f->parameters[0].to = 1.52;
    fit_result *r = solve(f, NULL);
    assert_true(!r->open[0][0] && r->open[0][1] && r->profile[0][1] == 1.52 && r->profile[0][0] > 1.02);
    free(r);
    f->parameters[0].to = 1.45; /* the best value is at the bound */
    r = solve(f, NULL);
    assert_true(r->derivative.at_bound[0] && r->open[0][1] && r->profile[0][1] == 1.45);
    free(r);
    job_destroy(j);
    fit_destroy(f);
}

/* The slab's height changes no ray's displacement: any is allowed, while the index has its interval. */
static void what_is_not_determined_is_open(void **state)
{
    fit *f = fit_of(*state, slab_scene,
                    "study: test\nscene: scene.yaml\nfit:\n  parameters: {slab.ior: {from: 1.02, to: 2.6}, "
                    "slab.position.y: {from: 0.4, to: 0.6}}\n" SLAB_TARGETS("sigma: 0.002"));
    job *j = new_job();
    const double truth[] = {1.5, 0.5};
    aim(f, j, truth);
    fit_result *r = solve(f, NULL);
    assert_false(r->has_interval);
    assert_true(r->has_profile[0] && !r->open[0][0] && !r->open[0][1]);
    assert_true(r->has_profile[1] && r->open[1][0] && r->open[1][1]);
    assert_true(r->profile[1][0] == 0.4 && r->profile[1][1] == 0.6);
    free(r);
    job_destroy(j);
    fit_destroy(f);
}

static void linear_intervals_and_few_evaluations(void **state)
{
    fit *f = fit_of(*state, slab_scene, THICKNESS_HEAD "  interval: linear\n" SLAB_TARGETS("sigma: 0.01"));
    job *j = new_job();
    const double truth[] = {1.5, 1.0};
    aim(f, j, truth);
    fit_result *r = solve(f, NULL);
    assert_true(r->has_interval && !r->has_profile[0] && r->profile_lacking == 0);
    free(r);
    f->linear = false;
    f->stage_count = 0; /* the search would end early, too */
    f->parameters[0].start = truth[0], f->parameters[1].start = truth[1];
    f->evaluations = 2;
    r = solve(f, NULL);
    assert_true(r->has_interval && !r->has_profile[0] && !r->has_profile[1] && r->profile_lacking == 2);
    free(r);
    f->evaluations = 80;
    r = solve(f, NULL);
    assert_true(r->has_profile[0] && !r->has_profile[1] && r->profile_lacking == 1);
    free(r);
    job_destroy(j);
    fit_destroy(f);
}

/* A search that did not move from its start far from the least merit. */
static void a_better_point_is_told(void **state)
{
    fit *f = fit_of(*state, slab_scene, THICKNESS_HEAD SLAB_TARGETS("sigma: 0.002"));
    job *j = new_job();
    const double truth[] = {1.5, 1.0};
    aim(f, j, truth);
    f->stage_count = 0;
    f->parameters[0].start = 1.6, f->parameters[1].start = 1.0;
    fit_result *r = solve(f, NULL);
    assert_true(r->has_better && r->better.merit < r->best.merit);
    free(r);
    job_destroy(j);
    fit_destroy(f);
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, fixture_setup, fixture_teardown)
    const struct CMUnitTest tests[] = {
        IN_FOLDER(the_profile_of_one_parameter_has_a_closed_form),
        IN_FOLDER(profiles_of_two_parameters_have_closed_forms),
        IN_FOLDER(profiles_cover_the_truth_where_linear_intervals_do_not),
        IN_FOLDER(an_end_at_the_bound_is_told),
        IN_FOLDER(what_is_not_determined_is_open),
        IN_FOLDER(linear_intervals_and_few_evaluations),
        IN_FOLDER(a_better_point_is_told),
    };
    return cmocka_run_group_tests_name("fit_profile", tests, NULL, NULL);
}
