/* Tests of the trials of a soft body's motion against their theory. Tolerances follow from the methods' orders; angle
 * is omega dt throughout. */
#include "softbody_fixture.h"

#include "softbody/trials.h"
#include "whole.h"

static softbody_settings toy_settings(int64_t level, softbody_integrator integrator, double dt_s)
{
    softbody_settings s = default_toy();
    s.level = level;
    s.integrator = integrator;
    s.dt_s = dt_s;
    return s;
}

static softbody_trial_report report_of(const softbody_settings *s, isa level)
{
    softbody_trial_report r;
    diagnostic why = {.what = ""};
    const status code = softbody_trials(s, level, &r, &why);
    assert_string_equal(why.what, "");
    assert_int_equal(code, STATUS_OK);
    return r;
}

static softbody_trial value_of(const softbody_trial_report *r, const char *name)
{
    for (int i = 0; i < SOFTBODY_TRIAL_COUNT; i++)
        if (strcmp(r->value[i].name, name) == 0)
            return r->value[i];
    fail_msg("no trial is called %s", name);
    return (softbody_trial){0};
}

/* Three integrators, level 1, 1 ms and a quarter of that: computed once, since they are slow. */
typedef struct reports {
    softbody_settings set[3];
    softbody_trial_report whole[3], quarter[3];
} reports;
static reports all;

static int make_reports(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        all.set[i] = toy_settings(1, (softbody_integrator)i, 0.001);
        all.whole[i] = report_of(&all.set[i], isa_best());
        softbody_settings finer = all.set[i];
        finer.dt_s *= 0.25;
        all.quarter[i] = report_of(&finer, isa_best());
    }
    return 0;
}

static double measured(const softbody_trial_report *r, const char *name)
{
    return value_of(r, name).measured;
}
static double error(const softbody_trial_report *r, const char *name)
{
    const softbody_trial v = value_of(r, name);
    return softbody_trial_error(&v);
}

static double angle_of(const softbody_settings *s)
{
    return sqrt(2.0 * s->stiffness * 42.0 / s->mass_kg) * s->dt_s; /* 42 masses at level 1 */
}

/* Against each integrator's own closed form to rounding: with an amplitude of 1e-3 the position is known to 1e-13.
 * Against mechanics to the first term of the closed form: asin and atan are x (1 + x^2 / 6) and x (1 - x^2 / 3), so
 * periods differ by -angle^2 / 24 and angle^2 / 3. */
static void the_oscillation_of_a_spring_equals_the_integrators_closed_form(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        const double angle = angle_of(&all.set[i]), period_s = 2.0 * M_PI * all.set[i].dt_s / angle;
        const softbody_trial_report *r = &all.whole[i];
        const softbody_trial period = value_of(r, "spring.period_s"), own = value_of(r, "spring.period_discrete_s");
        const softbody_trial decay = value_of(r, "spring.decay");
        const double first = i == SOFTBODY_IMPLICIT ? angle * angle / 3.0 : -angle * angle / 24.0;
        assert_near(period.theory, period_s, 1e-14 * period_s);
        assert_near(period.measured, period_s * (1.0 + first), pow(angle, 4.0) * period_s);
        assert_near(own.measured, own.theory, 1e-11 * period_s);
        assert_near(decay.measured, decay.theory, 1e-11);
        assert_near(decay.theory, i == SOFTBODY_IMPLICIT ? 1.0 - 0.5 * angle * angle : 1.0, pow(angle, 4.0));
    }
}

/* A step is 1/64 of a quarter period, h = 0.025: an error c h^p (1 + d h) gives the order p + d h / (2 log 2), with d
 * of about 1; verlet's next term is h^2. */
static void the_spring_trial_measures_the_order_of_the_integrator(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        const softbody_trial order = value_of(&all.whole[i], "spring.order");
        assert_near(order.theory, i == SOFTBODY_VERLET ? 2.0 : 1.0, 0.0);
        assert_near(order.measured, order.theory, i == SOFTBODY_VERLET ? 6e-4 : 0.018);
    }
}

/* Sums of 1000 steps round by up to 1000 half units in the last place of 5. */
static void free_fall_equals_the_integrators_closed_form(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        assert_near(value_of(&all.whole[i], "fall.depth").theory, 0.5 * 9.81, 1e-12);
        assert_near(error(&all.whole[i], "fall.depth"), i == SOFTBODY_VERLET ? 0.0 : 0.5 * 9.81 * 0.001, 1e-12);
        assert_near(error(&all.whole[i], "fall.depth_discrete"), 0.0, 5e-13);
    }
}

/* The mass enters the floor by up to v dt, v = sqrt(2 g h), which lengthens the fall and is then removed; and each of
 * the e v / (g dt) steps upwards is wrong by up to g dt^2 / 2. So the error of the height is at most e^2 v dt + e v dt
 * / 2, and smaller with shorter steps. */
static void the_bounce_trial_measures_restitution_squared(void **state)
{
    (void)state;
    const double e = default_toy().restitution, v = sqrt(2.0 * 9.81);
    for (int i = 0; i < 3; i++) {
        assert_near(value_of(&all.whole[i], "bounce.height").theory, e * e, 1e-16);
        assert_near(error(&all.whole[i], "bounce.height"), 0.0, (e * e + 0.5 * e) * v * 0.001);
        assert_near(error(&all.quarter[i], "bounce.height"), 0.0, (e * e + 0.5 * e) * v * 0.00025);
        assert_near(measured(&all.quarter[i], "bounce.body"), measured(&all.whole[i], "bounce.body"), 0.05);
        assert_true(measured(&all.quarter[i], "bounce.body") > 0.1 && measured(&all.quarter[i], "bounce.body") < 1.0);
    }
}

/* The energy of symplectic methods oscillates by O(dt^p) without drift (Hairer, Lubich, Wanner, IX.8): a quarter of the
 * step gives 4^-p of it. Backward Euler only loses: it damps every mode by omega^2 dt / 2, proportional to dt for small
 * losses. With damping nothing increases, except by euler's oscillation in one step. */
static void the_energy_error_has_the_order_of_the_method(void **state)
{
    (void)state;
    const double euler = measured(&all.whole[0], "energy.drift") / measured(&all.quarter[0], "energy.drift");
    const double verlet = measured(&all.whole[1], "energy.drift") / measured(&all.quarter[1], "energy.drift");
    assert_true(euler > 3.0 && euler < 5.5);
    assert_true(verlet > 12.0 && verlet < 22.0);
    assert_true(measured(&all.whole[1], "energy.drift") < 0.1 * measured(&all.whole[0], "energy.drift"));
    const double lost = -log1p(measured(&all.whole[2], "energy.end")),
                 lost_of_quarter = -log1p(measured(&all.quarter[2], "energy.end"));
    assert_true(lost > 0.0 && lost_of_quarter > lost / 6.0 && lost_of_quarter < lost / 2.5);
    for (int i = 0; i < 3; i++) {
        assert_true(fabs(measured(&all.whole[i], "energy.end")) <= measured(&all.whole[i], "energy.drift"));
        assert_true(measured(&all.whole[i], "energy.rise") >= 0.0 && measured(&all.whole[i], "energy.rise") < 1e-3);
    }
    assert_true(measured(&all.whole[2], "energy.rise") == 0.0);
}

/* Forces are pairs along springs, and the explicit methods add a multiple of them at the current positions: both
 * momenta are conserved up to rounding, 1000 steps of 1e-16. Backward Euler adds forces of the next positions at the
 * current ones: they have a torque, so angular momentum is conserved to the method's order, and momentum to the
 * solver's residual of 1e-10. */
static void momenta_are_conserved_in_the_trials(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        assert_near(error(&all.whole[i], "momentum.drift"), 0.0, i == SOFTBODY_IMPLICIT ? 1e-9 : 1e-13);
        if (i != SOFTBODY_IMPLICIT)
            assert_near(error(&all.whole[i], "angular_momentum.drift"), 0.0, 1e-13);
    }
    const double turned =
        measured(&all.whole[2], "angular_momentum.drift") / measured(&all.quarter[2], "angular_momentum.drift");
    assert_true(turned > 2.5 && turned < 5.5);
}

/* The body's weight compresses it, by about m g / A over the pressure's K, with A = 2 pi r^2 at most. A larger K
 * preserves more of the volume. */
static void a_stiffer_pressure_preserves_more_volume(void **state)
{
    (void)state;
    softbody_settings stiff = toy_settings(1, SOFTBODY_EULER, 0.00025);
    stiff.pressure *= 10.0;
    const softbody_trial_report r = report_of(&stiff, isa_best());
    const double soft = measured(&all.whole[0], "volume.drift"), held = measured(&r, "volume.drift");
    assert_true(soft < 0.0 && soft > -0.1);
    assert_true(held < 0.0 && held > 0.3 * soft);
    assert_near(measured(&all.quarter[0], "volume.drift"), soft, 2e-3);
}

static double speed_of_rest(double dt_s)
{
    softbody_settings s = settings_in_space(SOFTBODY_EULER, dt_s);
    s.level = 1;
    softbody *b = toy_of(&s);
    status code = STATUS_OK;
    for (int i = 0; i < 1000 && code == STATUS_OK; i++)
        code = softbody_step(b, NULL);
    const double speed = code == STATUS_OK ? softbody_measure(b).speed_max : INFINITY;
    softbody_destroy(b);
    return speed;
}

/* For the spring to 1e-5, as derived in trials_spring.c. For the toy at least the bound, up to the bisection's 1/512;
 * and a toy at rest, excited only by rounding, stays so with steps shorter by a tenth, and diverges with longer ones:
 * by exp(2 acosh 1.1) = 2.4 per step. */
static void the_longest_stable_step_is_found(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        const softbody_trial spring = value_of(&all.whole[i], "stable_dt.spring_s"),
                             toy = value_of(&all.whole[i], "stable_dt.toy_s");
        assert_near(spring.measured, spring.theory, 1e-5 * spring.theory);
        assert_near(spring.theory, 2.0 * all.set[i].dt_s / angle_of(&all.set[i]), 1e-14);
        assert_true(toy.measured > toy.theory * (1.0 - 1.0 / 512.0));
        assert_near(measured(&all.quarter[i], "stable_dt.toy_s"), toy.measured, 0.0);
    }
    const double limit_s = measured(&all.whole[0], "stable_dt.toy_s");
    assert_true(speed_of_rest(0.9 * limit_s) < 1e-9);
    assert_true(speed_of_rest(1.1 * limit_s) == INFINITY);
    assert_true(isnan(measured(&all.whole[2], "stable_dt.spring_s")) &&
                isnan(measured(&all.whole[2], "stable_dt.toy_s")));
}

static void assert_same(const softbody_trial_report *a, const softbody_trial_report *b)
{
    for (int i = 0; i < SOFTBODY_TRIAL_COUNT; i++) {
        const softbody_trial *p = &a->value[i], *q = &b->value[i];
        assert_string_equal(p->name, q->name);
        assert_memory_equal(&p->theory, &q->theory, sizeof p->theory);
        if (strcmp(p->unit, "s") == 0 && strncmp(p->name, "rate.", 5) == 0)
            continue;
        if (strcmp(p->name, "rate.simulated_s_per_s") != 0 &&
            memcmp(&p->measured, &q->measured, sizeof p->measured) != 0)
            fail_msg("%s is %.17g and %.17g", p->name, p->measured, q->measured);
    }
}

/* Level 3 has two chunks of masses, so that two threads have work. */
static void threads_and_instruction_sets_do_not_change_the_trials(void **state)
{
    (void)state;
    for (int i = is_whole() ? 0 : SOFTBODY_IMPLICIT; i < 3; i++) {
        softbody_settings s = toy_settings(3, (softbody_integrator)i, i == SOFTBODY_IMPLICIT ? 0.01 : 0.002);
        const softbody_trial_report one = report_of(&s, isa_best());
        for (int level = ISA_BASE; level < (int)isa_best(); level++) {
            const softbody_trial_report other = report_of(&s, (isa)level);
            assert_same(&one, &other);
        }
        s.threads = 2;
        const softbody_trial_report two = report_of(&s, isa_best());
        assert_same(&one, &two);
    }
}

static void names_are_unique_and_have_units(void **state)
{
    (void)state;
    const softbody_trial_report *r = &all.whole[0];
    for (int i = 0; i < SOFTBODY_TRIAL_COUNT; i++) {
        assert_true(r->value[i].name[0] && r->value[i].what[0]);
        for (int k = 0; k < i; k++)
            assert_string_not_equal(r->value[i].name, r->value[k].name);
        for (int k = 1; k < 3; k++) {
            assert_string_equal(r->value[i].name, all.whole[k].value[i].name);
            assert_string_equal(r->value[i].unit, all.whole[k].value[i].unit);
        }
    }
}

/* A step of 0.1 s is six times the spring's limit. */
static void diverged_trials_have_no_value(void **state)
{
    (void)state;
    const softbody_settings s = toy_settings(1, SOFTBODY_EULER, 0.1);
    const softbody_trial_report r = report_of(&s, isa_best());
    const char *const lost[] = {"spring.period_s", "spring.decay",   "bounce.body",  "energy.drift", "energy.end",
                                "energy.rise",     "momentum.drift", "volume.drift", "rate.step_s"};
    for (size_t i = 0; i < sizeof lost / sizeof lost[0]; i++)
        if (!isnan(measured(&r, lost[i])))
            fail_msg("%s is %g", lost[i], measured(&r, lost[i]));
    assert_true(value_of(&r, "spring.period_s").theory > 0.0);
    assert_true(isnan(value_of(&r, "spring.period_discrete_s").theory));
    assert_near(error(&r, "fall.depth_discrete"), 0.0, 1e-13);
    assert_near(measured(&r, "stable_dt.toy_s"), measured(&all.whole[0], "stable_dt.toy_s"), 0.0);
}

/* Without stiffness, pressure or gravity: no spring to measure, no bounce, and no error. */
static void trials_accept_a_slime_without_forces(void **state)
{
    (void)state;
    softbody_settings s = toy_settings(0, SOFTBODY_VERLET, 0.01);
    s.stiffness = s.bending = s.through = s.pressure = s.damping = 0.0;
    s.gravity = vec3_make(0.0, 0.0, 0.0);
    const softbody_trial_report r = report_of(&s, isa_best());
    const char *const none[] = {"spring.period_s", "spring.order",       "bounce.height",  "bounce.body",
                                "energy.drift",    "stable_dt.spring_s", "stable_dt.toy_s"};
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++)
        assert_true(isnan(measured(&r, none[i])));
    assert_near(measured(&r, "volume.drift"), 0.0, 1e-15);
    s.level = 8;
    softbody_trial_report unused;
    assert_int_equal(softbody_trials(&s, isa_best(), &unused, NULL), STATUS_BAD_INPUT);
}

static void one_trial_equals_that_of_the_report(void **state)
{
    (void)state;
    const char *const names[] = {"spring.period_s", "fall.depth",   "bounce.height",
                                 "momentum.drift",  "volume.drift", "stable_dt.spring_s"};
    softbody_trial one;
    diagnostic why = {.what = ""};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        assert_true(softbody_has_trial(names[i]));
        assert_int_equal(softbody_trial_one(&all.set[0], isa_best(), names[i], &one, &why), STATUS_OK);
        assert_string_equal(one.name, names[i]);
        assert_near(one.measured, measured(&all.whole[0], names[i]), 0.0);
    }
    assert_false(softbody_has_trial("spring."));
    assert_int_equal(softbody_trial_one(&all.set[0], isa_best(), "spring.", &one, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "'spring.'"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_oscillation_of_a_spring_equals_the_integrators_closed_form),
        cmocka_unit_test(the_spring_trial_measures_the_order_of_the_integrator),
        cmocka_unit_test(free_fall_equals_the_integrators_closed_form),
        cmocka_unit_test(the_bounce_trial_measures_restitution_squared),
        cmocka_unit_test(the_energy_error_has_the_order_of_the_method),
        cmocka_unit_test(momenta_are_conserved_in_the_trials),
        cmocka_unit_test(a_stiffer_pressure_preserves_more_volume),
        cmocka_unit_test(the_longest_stable_step_is_found),
        cmocka_unit_test(threads_and_instruction_sets_do_not_change_the_trials),
        cmocka_unit_test(names_are_unique_and_have_units),
        cmocka_unit_test(diverged_trials_have_no_value),
        cmocka_unit_test(trials_accept_a_slime_without_forces),
        cmocka_unit_test(one_trial_equals_that_of_the_report),
    };
    return cmocka_run_group_tests(tests, make_reports, NULL);
}
