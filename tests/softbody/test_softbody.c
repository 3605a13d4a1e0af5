/* Tests of masses and springs against closed forms of mechanics, and of irregular nets. */
#include "random_stream.h"
#include "softbody_fixture.h"

/* Masses and springs against closed forms of mechanics. */

static const softbody_integrator all[] = {SOFTBODY_EULER, SOFTBODY_VERLET, SOFTBODY_IMPLICIT};
enum { ALL = sizeof all / sizeof all[0] };

/* Two masses on a spring oscillate with omega^2 = k / m_reduced, m_reduced = m1 m2 / (m1 + m2) (Landau and Lifshitz,
 * Mechanics, 13 and 21). The steps of an integrator oscillate with another omega_d (eigenvalues of the step's matrix):
 * (2/dt) asin(omega dt / 2) for semi-implicit Euler and Verlet, atan(omega dt) / dt for backward Euler, whose amplitude
 * decreases by (1 + omega^2 dt^2)^(-1/2) per step. So the length after any number of steps is known. */
static void the_oscillation_of_a_spring_equals_the_integrators_closed_form(void **state)
{
    (void)state;
    const double m1 = 0.3, m2 = 0.7, k = 50.0, stretch = 0.01, dt = 0.004, omega = sqrt(k / (m1 * m2 / (m1 + m2)));
    const double folded = 2.0 / dt * asin(0.5 * omega * dt);
    for (int i = 0; i < ALL; i++) {
        const softbody_settings s = settings_in_space(all[i], dt);
        softbody *b = pair_of(m1, m2, k, 0.0, stretch, &s);
        for (long n = 1; n <= 500; n++) {
            steps_of(b, 1);
            const double t = (double)n * dt, z = omega * dt;
            /* semi-implicit Euler begins with v_0 = 0: x_n = cos((n + 1/2) w) / cos(w / 2) in its own frequency;
             * Verlet: cos(n w) */
            const double theory = all[i] == SOFTBODY_EULER ? cos(folded * (t + 0.5 * dt)) / cos(0.5 * folded * dt)
                                  : all[i] == SOFTBODY_VERLET
                                      ? cos(folded * t)
                                      : cos(atan(z) * (double)n) * pow(1.0 + z * z, -0.5 * (double)n);
            assert_near((pair_length(b) - 1.0) / stretch, theory, 2e-8);
        }
        softbody_destroy(b);
    }
}

/* Largest error against cos(omega t) over one second, in position and velocity. */
static double distance_from_swing(softbody_integrator integrator, double dt)
{
    const double k = 40.0, omega = sqrt(k / 0.5), stretch = 0.01;
    const softbody_settings s = settings_in_space(integrator, dt);
    softbody *b = pair_of(1.0, 1.0, k, 0.0, stretch, &s);
    double worst = 0.0;
    for (long n = 1; n <= lround(1.0 / dt); n++) {
        vec3 v[2];
        steps_of(b, 1);
        softbody_velocities(b, v);
        const double t = (double)n * dt;
        worst = fmax(worst, fabs((pair_length(b) - 1.0) / stretch - cos(omega * t)) +
                                fabs((v[1].x - v[0].x) / (stretch * omega) + sin(omega * t)));
    }
    softbody_destroy(b);
    return worst;
}

static void the_orders_of_the_integrators_are_one_two_and_one(void **state)
{
    (void)state;
    const double expected[ALL] = {1.0, 2.0, 1.0};
    for (int i = 0; i < ALL; i++) {
        const double order = log2(distance_from_swing(all[i], 1.0 / 8192) / distance_from_swing(all[i], 1.0 / 16384));
        assert_near(order, expected[i], 0.01);
    }
}

/* Damped oscillation: exp(-gamma t / 2) cos + ..., gamma = k_d / m_reduced (Landau and Lifshitz, 25.4). */
static void a_damped_spring_equals_the_closed_form(void **state)
{
    (void)state;
    const double k = 40.0, kd = 0.8, gamma = kd / 0.5, omega = sqrt(k / 0.5 - 0.25 * gamma * gamma), stretch = 0.01;
    for (int i = 0; i < ALL; i++) {
        const softbody_settings s = settings_in_space(all[i], 1e-4);
        softbody *b = pair_of(1.0, 1.0, k, kd, stretch, &s);
        steps_of(b, 7000);
        const double t = 0.7, theory = exp(-0.5 * gamma * t) * (cos(omega * t) + 0.5 * gamma / omega * sin(omega * t));
        assert_near((pair_length(b) - 1.0) / stretch, theory, all[i] == SOFTBODY_VERLET ? 1e-5 : 4e-3);
        softbody_destroy(b);
    }
}

/* -g t^2 / 2; semi-implicit Euler, which adds a dt^2 instead of half of that, falls by -g t (t + dt) / 2, and so does
 * backward Euler. */
static void free_fall_equals_the_closed_form(void **state)
{
    (void)state;
    for (int i = 0; i < ALL; i++) {
        softbody_settings s = settings_in_space(all[i], 0x1p-10);
        s.gravity = vec3_make(0.0, -9.81, 0.0);
        softbody *b = point_at(vec3_make(0.0, 0.0, 0.0), vec3_make(2.0, 0.0, 0.0), &s);
        steps_of(b, 1024);
        vec3 at, v;
        softbody_positions(b, &at);
        softbody_velocities(b, &v);
        const double late = all[i] == SOFTBODY_VERLET ? 0.0 : s.dt_s;
        assert_near(at.y, -0.5 * 9.81 * (1.0 + late), 1e-12);
        assert_near(at.x, 2.0, 1e-12);
        assert_near(v.y, -9.81, 1e-12);
        softbody_destroy(b);
    }
}

/* A mass that falls from h bounces to e^2 h, up to the height of one step at the speed of impact. */
static void a_bounce_reaches_restitution_squared_times_the_height(void **state)
{
    (void)state;
    const double rest[] = {0.0, 0.5, 0.9, 1.0};
    for (int i = 0; i < ALL; i++) {
        for (int k = 0; k < 4; k++) {
            softbody_settings s = settings_in_space(all[i], 1e-5);
            s.gravity = vec3_make(0.0, -9.81, 0.0);
            s.ground = 1;
            s.restitution = rest[k];
            softbody *b = point_at(vec3_make(0.0, 1.0, 0.0), vec3_make(0.0, 0.0, 0.0), &s);
            const double down_s = sqrt(2.0 / 9.81);
            steps_of(b, lround(1.001 * down_s / s.dt_s));
            double top = 0.0;
            for (long n = 0; n < lround((1.9 * rest[k] + 0.1) * down_s / s.dt_s); n++) {
                steps_of(b, 1);
                top = fmax(top, softbody_measure(b).center.y);
            }
            assert_near(top, rest[k] * rest[k], 4.0 * s.dt_s * sqrt(2.0 * 9.81));
            assert_true(softbody_measure(b).low >= 0.0);
            softbody_destroy(b);
        }
    }
}

/* Coulomb: a sliding mass stops after v^2 / (2 mu g). */
static void coulomb_friction_stops_a_mass_after_the_computed_distance(void **state)
{
    (void)state;
    softbody_settings s = settings_in_space(SOFTBODY_EULER, 1e-4);
    s.gravity = vec3_make(0.0, -10.0, 0.0);
    s.ground = 1;
    s.friction = 0.25;
    softbody *b = point_at(vec3_make(0.0, 0.0, 0.0), vec3_make(0.6, 0.0, -0.8), &s);
    steps_of(b, 20000);
    vec3 at, v;
    softbody_positions(b, &at);
    softbody_velocities(b, &v);
    const double distance = 1.0 / (2.0 * 0.25 * 10.0);
    assert_near(at.x, 0.6 * distance, 1e-4);
    assert_near(at.z, -0.8 * distance, 1e-4);
    assert_true(vec3_length(v) == 0.0);
    softbody_destroy(b);
}

/* Coulomb's impulse is proportional to the change of normal speed, (1 + e) v: an oblique impact loses mu (1 + e) v of
 * tangential speed. */
static void oblique_impacts_have_coulombs_impulse_of_friction(void **state)
{
    (void)state;
    softbody_settings s = settings_in_space(SOFTBODY_EULER, 1e-4);
    s.ground = 1;
    s.friction = 0.2;
    s.restitution = 0.5;
    softbody *b = point_at(vec3_make(0.0, 0.0005, 0.0), vec3_make(3.0, -2.0, 0.0), &s);
    vec3 v;
    steps_of(b, 10);
    softbody_velocities(b, &v);
    assert_near(v.y, 1.0, 1e-15);
    assert_near(v.x, 3.0 - 0.2 * 1.5 * 2.0, 1e-14);
    softbody_destroy(b);
}

/* Dampers alone: energy never increases, at any stable step. */
static void damping_never_adds_energy(void **state)
{
    (void)state;
    for (int i = 0; i < ALL; i++) {
        softbody_settings s = settings_in_space(all[i], 0.001);
        s.level = 2;
        s.stiffness = s.bending = s.through = s.pressure = 0.0;
        s.damping = 0.3;
        softbody *b = toy_of(&s);
        const size_t count = softbody_mass_count(b);
        vec3 *at = malloc(count * sizeof *at), *v = malloc(count * sizeof *v);
        softbody_positions(b, at);
        for (size_t k = 0; k < count; k++)
            v[k] = vec3_make(sin(7.0 * (double)k), cos(5.0 * (double)k), sin(3.0 * (double)k));
        softbody_place(b, at, v);
        double before = softbody_measure(b).kinetic;
        const double first = before;
        for (int n = 0; n < 1000; n++) {
            steps_of(b, 1);
            const double now = softbody_measure(b).kinetic;
            assert_true(now <= before * (1.0 + 1e-14));
            before = now;
        }
        assert_true(before < 0.9 * first);
        free(at);
        free(v);
        softbody_destroy(b);
    }
}

static void divergence_is_reported_with_its_step(void **state)
{
    (void)state;
    softbody_settings s = settings_in_space(SOFTBODY_EULER, 0.01);
    s.stiffness = 1e6;
    s.velocity = vec3_make(0.0, 0.0, 0.0);
    softbody *b = toy_of(&s);
    diagnostic why = {.what = ""};
    vec3 *at = malloc(softbody_mass_count(b) * sizeof *at), *v = calloc(softbody_mass_count(b), sizeof *v);
    softbody_positions(b, at);
    at[0].x += 0.01;
    softbody_place(b, at, v);
    status code = STATUS_OK;
    int n = 0;
    for (; n < 1000 && code == STATUS_OK; n++)
        code = softbody_step(b, &why);
    char step[40];
    snprintf(step, sizeof step, "diverged in step %d, at", n);
    assert_int_equal(code, STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, step));
    assert_non_null(strstr(why.what, "speed of mass"));
    assert_non_null(strstr(why.remedy, "adaptive"));
    assert_int_equal(softbody_step(b, NULL), STATUS_BAD_INPUT); /* and stays 0 */
    free(at);
    free(v);
    softbody_destroy(b);
}

/* A step that diverges is stable with splitting, and with backward Euler. */
static void substeps_and_backward_euler_are_stable_with_stiff_springs(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        softbody_settings s = settings_in_space(i == 0   ? SOFTBODY_EULER
                                                : i == 1 ? SOFTBODY_VERLET
                                                         : SOFTBODY_IMPLICIT,
                                                0.01);
        s.level = 1;
        s.stiffness = 1e5;
        s.damping = 1.0;
        s.adaptive = i < 2;
        softbody *b = toy_of(&s);
        vec3 at[42], v[42] = {{0.0, 0.0, 0.0}};
        softbody_positions(b, at);
        at[0] = vec3_scale(at[0], 1.02);
        softbody_place(b, at, v);
        const double before = energy_of(b);
        steps_of(b, 100);
        assert_true(energy_of(b) < before);
        assert_true(i == 2 || softbody_measure(b).substeps > 200);
        softbody_destroy(b);
    }
}

/* A damper's rate gamma limits semi-implicit Euler to gamma dt < 2 and Verlet, which predicts the velocity, to gamma dt
 * < 1: substeps are below both. */
static void substeps_are_stable_with_strong_dampers(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        softbody_settings s = settings_in_space(i == 0 ? SOFTBODY_EULER : SOFTBODY_VERLET, 1e-3);
        s.adaptive = 1;
        softbody *b = pair_of(1.0, 1.0, 1.0, 890.0, 0.001, &s);
        vec3 at[2], v[2] = {{-0.001, 0.0, 0.0}, {0.001, 0.0, 0.0}};
        softbody_positions(b, at);
        softbody_place(b, at, v);
        steps_of(b, 500);
        assert_true(softbody_measure(b).kinetic < 1e-6);
        softbody_destroy(b);
    }
}

/* Backward Euler with springs compressed to half their length, and with a pressure a thousand times as stiff as the
 * toy's: energy only decreases. */
static void backward_euler_is_stable_under_compression(void **state)
{
    (void)state;
    softbody_settings s = settings_in_space(SOFTBODY_IMPLICIT, 0.02);
    s.level = 2;
    s.stiffness = 1e4;
    s.pressure = 3e5;
    softbody *b = toy_of(&s);
    vec3 at[162], v[162] = {{0.0, 0.0, 0.0}};
    softbody_positions(b, at);
    for (int i = 0; i < 162; i++)
        at[i] = vec3_scale(at[i], 0.98);
    softbody_place(b, at, v);
    const double first = energy_of(b);
    double before = first;
    for (int n = 0; n < 100; n++) {
        steps_of(b, 1);
        assert_true(energy_of(b) <= before + 1e-9 * first);
        before = energy_of(b);
    }
    assert_near(softbody_measure(b).volume / softbody_measure(b).volume_at_rest, 1.0, 1e-3);
    softbody_destroy(b);
}

/* A compressed spring has negative stiffness across its axis: the solver omits it (Choi and Ko), so that a speed across
 * stays unchanged for a step, whereas the true stiffness, -k dt^2 > m / 2 here, would reverse it. */
static void backward_euler_omits_the_negative_stiffness_of_compressed_springs(void **state)
{
    (void)state;
    const softbody_settings s = settings_in_space(SOFTBODY_IMPLICIT, 0.1);
    softbody *b = pair_of(1.0, 1.0, 400.0, 0.0, 0.0, &s);
    const vec3 at[2] = {{0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}};
    vec3 v[2] = {{0.0, -0.01, 0.0}, {0.0, 0.01, 0.0}};
    softbody_place(b, at, v);
    steps_of(b, 1);
    softbody_velocities(b, v);
    assert_near(v[1].y - v[0].y, 0.02, 1e-14);
    /* along the axis: dv = dt f / (m / 2 + dt^2 k), f = k (1 - 1/2) on each of the reduced mass */
    assert_near(v[1].x - v[0].x, 0.1 * 400.0 * 0.5 / (0.5 + 0.01 * 400.0), 1e-9);
    softbody_destroy(b);
}

/* A body that moves fast as a whole has not diverged, however far it moves in a step; and NaN is reported. */
static void a_fast_body_is_not_reported_as_diverged(void **state)
{
    (void)state;
    softbody_settings s = settings_in_space(SOFTBODY_EULER, 0.01);
    s.level = 1;
    s.radius = 0.1;
    s.velocity = vec3_make(300.0, 0.0, 0.0);
    softbody *b = toy_of(&s);
    steps_of(b, 10);
    assert_near(softbody_measure(b).center.x, 30.0, 1e-9);
    softbody_destroy(b);
}

static void a_body_below_its_floor_is_refused(void **state)
{
    (void)state;
    softbody_settings s = default_toy();
    softbody *b;
    diagnostic why = {.what = ""};
    s.ground_y = 1.0;
    assert_int_equal(softbody_create(&s, isa_best(), &b, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "below its floor"));
    s.ground_y = NAN;
    assert_int_equal(softbody_create(&s, isa_best(), &b, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "ground_y"));
}

static void invalid_settings_are_reported(void **state)
{
    (void)state;
    struct {
        const char *name;
        size_t offset;
        double value;
    } bad[] = {
        {"mass_kg", offsetof(softbody_settings, mass_kg), -1.0},
        {"mass_kg", offsetof(softbody_settings, mass_kg), 0.0},
        {"dt_s", offsetof(softbody_settings, dt_s), 0.0},
        {"dt_s", offsetof(softbody_settings, dt_s), NAN},
        {"radius", offsetof(softbody_settings, radius), 0.0},
        {"stiffness", offsetof(softbody_settings, stiffness), -40.0},
        {"restitution", offsetof(softbody_settings, restitution), 1.5},
        {"friction", offsetof(softbody_settings, friction), INFINITY},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        softbody_settings s = default_toy();
        memcpy((char *)&s + bad[i].offset, &bad[i].value, sizeof(double));
        softbody *b;
        diagnostic why = {.what = ""};
        assert_int_equal(softbody_create(&s, isa_best(), &b, &why), STATUS_BAD_INPUT);
        assert_non_null(strstr(why.what, bad[i].name));
        assert_null(b);
    }
}

/* Irregular nets: the forces of springs, which are computed once for both ends, compared with a sum over the list. */

enum { MASSES = 61, SPRINGS = 400 };
#define DT_S 1e-3

typedef struct random_net {
    vec3 position[MASSES], velocity[MASSES];
    double mass_kg[MASSES];
    softbody_spring springs[SPRINGS];
} random_net;

/* A hub with many springs, springs with the same ends, in both directions, and two masses at one position; the last
 * mass has no spring. */
static softbody_net fill_net(random_net *n)
{
    uint64_t seed = 3;
    for (int i = 0; i < MASSES; i++) {
        n->position[i] = random_point(&seed, 1.0);
        n->velocity[i] = random_point(&seed, 1.0);
        n->mass_kg[i] = random_real(&seed, 0.5, 1.5);
    }
    n->position[11] = n->position[10];
    for (int i = 0; i < SPRINGS; i++) {
        const int a = i % 4 == 0 ? 0 : random_below(&seed, MASSES - 1), b = random_below(&seed, MASSES - 1);
        n->springs[i] = (softbody_spring){{(uint32_t)a, (uint32_t)(a == b ? (a + 1) % (MASSES - 1) : b)},
                                          random_real(&seed, 0.0, 2.0),
                                          random_real(&seed, 0.0, 10.0),
                                          random_real(&seed, 0.0, 1.0)};
    }
    n->springs[1] = (softbody_spring){{10, 11}, 0.3, 5.0, 1.0};
    n->springs[2] = n->springs[3] = (softbody_spring){{4, 7}, 0.3, 5.0, 1.0};
    n->springs[5] = (softbody_spring){{7, 4}, 0.3, 5.0, 1.0};
    return (softbody_net){.mass_count = MASSES,
                          .spring_count = SPRINGS,
                          .position = n->position,
                          .velocity = n->velocity,
                          .mass_kg = n->mass_kg,
                          .springs = n->springs};
}

/* Hooke and damping of softbody.h. */
static void add_forces(const random_net *n, vec3 *force)
{
    for (int i = 0; i < SPRINGS; i++) {
        const softbody_spring *s = &n->springs[i];
        const uint32_t a = s->end[0], b = s->end[1];
        const vec3 x = vec3_sub(n->position[a], n->position[b]), v = vec3_sub(n->velocity[a], n->velocity[b]);
        const double length = vec3_length(x);
        if (!(length > 0.0))
            continue;
        const double along = -s->stiffness * (length - s->rest) / length - s->damping * vec3_dot(v, x) / vec3_dot(x, x);
        force[a] = vec3_add(force[a], vec3_scale(x, along));
        force[b] = vec3_sub(force[b], vec3_scale(x, along));
    }
}

/* Velocities after a step of euler, which adds dt F / m. */
static void velocities_after_a_step(const softbody_net *net, isa level, vec3 *after)
{
    const softbody_settings s = settings_in_space(SOFTBODY_EULER, DT_S);
    softbody *b;
    assert_int_equal(softbody_create_net(net, &s, level, &b, NULL), STATUS_OK);
    steps_of(b, 1);
    softbody_velocities(b, after);
    softbody_destroy(b);
}

static void forces_of_an_irregular_net_equal_the_sum_over_its_springs(void **state)
{
    (void)state;
    random_net n;
    const softbody_net net = fill_net(&n);
    vec3 force[MASSES] = {{0.0, 0.0, 0.0}}, after[MASSES];
    add_forces(&n, force);
    velocities_after_a_step(&net, isa_best(), after);
    for (int i = 0; i < MASSES; i++) {
        const vec3 got = vec3_scale(vec3_sub(after[i], n.velocity[i]), n.mass_kg[i] / DT_S);
        assert_near(vec3_length(vec3_sub(got, force[i])), 0.0, 1e-10); /* forces of 1 to 100 N; rounding over DT_S */
    }
}

static void an_irregular_net_has_the_same_bits_on_all_instruction_sets(void **state)
{
    (void)state;
    random_net n;
    const softbody_net net = fill_net(&n);
    vec3 expected[MASSES], got[MASSES];
    velocities_after_a_step(&net, ISA_BASE, expected);
    for (int level = ISA_BASE + 1; level <= (int)isa_best(); level++) {
        velocities_after_a_step(&net, (isa)level, got);
        assert_memory_equal(got, expected, sizeof expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_oscillation_of_a_spring_equals_the_integrators_closed_form),
        cmocka_unit_test(the_orders_of_the_integrators_are_one_two_and_one),
        cmocka_unit_test(a_damped_spring_equals_the_closed_form),
        cmocka_unit_test(free_fall_equals_the_closed_form),
        cmocka_unit_test(a_bounce_reaches_restitution_squared_times_the_height),
        cmocka_unit_test(coulomb_friction_stops_a_mass_after_the_computed_distance),
        cmocka_unit_test(oblique_impacts_have_coulombs_impulse_of_friction),
        cmocka_unit_test(damping_never_adds_energy),
        cmocka_unit_test(divergence_is_reported_with_its_step),
        cmocka_unit_test(substeps_and_backward_euler_are_stable_with_stiff_springs),
        cmocka_unit_test(substeps_are_stable_with_strong_dampers),
        cmocka_unit_test(backward_euler_is_stable_under_compression),
        cmocka_unit_test(backward_euler_omits_the_negative_stiffness_of_compressed_springs),
        cmocka_unit_test(a_fast_body_is_not_reported_as_diverged),
        cmocka_unit_test(a_body_below_its_floor_is_refused),
        cmocka_unit_test(invalid_settings_are_reported),
        cmocka_unit_test(forces_of_an_irregular_net_equal_the_sum_over_its_springs),
        cmocka_unit_test(an_irregular_net_has_the_same_bits_on_all_instruction_sets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
