/* Tests of the whole toy: its net, conserved quantities, volume, hands; and bit-identical results of all threads and
 * instruction sets. */
#include "softbody_fixture.h"
#include "whole.h"

static double sum_of_lengths(const vec3 *v, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++)
        sum += vec3_length(v[i]);
    return sum;
}

/* A smooth deformation and a rotation: u = a (x, -2 y, z) + w x r. */
static void stir(softbody *b, double wobble, vec3 spin)
{
    const size_t count = softbody_mass_count(b);
    vec3 *at = malloc(count * sizeof *at), *v = malloc(count * sizeof *v);
    const vec3 center = softbody_measure(b).center;
    softbody_positions(b, at);
    for (size_t i = 0; i < count; i++) {
        const vec3 r = vec3_sub(at[i], center);
        v[i] = vec3_add(vec3_make(wobble * r.x, -2.0 * wobble * r.y, wobble * r.z), vec3_cross(spin, r));
    }
    softbody_place(b, at, v);
    free(at);
    free(v);
}

/* 12, 42, 162 .. masses; by Euler's formula 3 (V - 2) edges, as many springs across, and one per two masses. */
static void the_net_has_the_numbers_of_eulers_formula(void **state)
{
    (void)state;
    for (int level = 0; level <= 5; level++) {
        softbody_settings s = default_toy();
        s.level = level;
        softbody *b = toy_of(&s);
        const size_t masses = 10 * ((size_t)1 << 2 * level) + 2;
        assert_int_equal(softbody_mass_count(b), masses);
        assert_int_equal(softbody_spring_count(b), 2 * 3 * (masses - 2) + masses / 2);
        const softbody_quantities a = softbody_measure(b);
        assert_near(a.elastic, 0.0, 1e-25);
        assert_near(a.volume, a.volume_at_rest, 1e-13);
        assert_near(a.center.y, 1.0, 1e-12);
        /* inscribed in the sphere */
        assert_true(a.volume < 4.0 / 3.0 * M_PI && (level < 4 || a.volume > 0.997 * 4.0 / 3.0 * M_PI));
        softbody_destroy(b);
    }
}

/* Newton's third law, for each pair of forces and around each ring: 10^5 steps of a damped body that deforms, rotates
 * and moves. The rounding error is a random walk of 10^5 steps, each about 1e-16 of the total. */
static void momenta_are_conserved_up_to_rounding(void **state)
{
    (void)state;
    const softbody_integrator both[] = {SOFTBODY_EULER, SOFTBODY_VERLET};
    for (int i = 0; i < 2; i++) {
        softbody_settings s = settings_in_space(both[i], 0.001);
        s.level = 1;
        softbody *b = toy_of(&s);
        stir(b, 0.5, vec3_make(0.3, 0.7, -0.4));
        const softbody_quantities before = softbody_measure(b);
        steps_of(b, 100000);
        const softbody_quantities after = softbody_measure(b);
        assert_near(vec3_length(vec3_sub(after.momentum, before.momentum)), 0.0, 1e-13);
        assert_near(vec3_length(vec3_sub(after.angular_momentum, before.angular_momentum)), 0.0, 1e-12);
        assert_true(vec3_length(before.angular_momentum) > 0.3);
        softbody_destroy(b);
    }
}

/* Each row of backward Euler's matrix sums to the mass, and the solver starts from zero: momentum is conserved without
 * drift. Angular momentum is not: forces act at the positions of the start of the step. */
static void backward_euler_conserves_momentum(void **state)
{
    (void)state;
    softbody_settings s = settings_in_space(SOFTBODY_IMPLICIT, 0.01);
    s.level = 1;
    s.velocity = vec3_make(0.1, 0.2, -0.3);
    softbody *b = toy_of(&s);
    const vec3 before = softbody_measure(b).momentum;
    steps_of(b, 2000);
    assert_near(vec3_length(vec3_sub(softbody_measure(b).momentum, before)), 0.0, 1e-12);
    softbody_destroy(b);
}

/* The energy of semi-implicit Euler and Verlet oscillates about a conserved one (Hairer, Lubich and Wanner, IX); the
 * amplitude decreases as dt and dt^2. */
static double energy_swing(softbody_integrator integrator, double dt)
{
    softbody_settings s = settings_in_space(integrator, dt);
    s.level = 1;
    s.damping = 0.0;
    softbody *b = toy_of(&s);
    stir(b, 0.2, vec3_make(0.0, 0.0, 0.0));
    const double before = energy_of(b);
    double worst = 0.0;
    for (long n = 0; n < lround(1.0 / dt); n++) {
        steps_of(b, 1);
        worst = fmax(worst, fabs(energy_of(b) - before) / before);
    }
    softbody_destroy(b);
    return worst;
}

static void the_energy_error_decreases_with_the_step(void **state)
{
    (void)state;
    assert_near(log2(energy_swing(SOFTBODY_EULER, 0.002) / energy_swing(SOFTBODY_EULER, 0.001)), 1.0, 0.15);
    assert_near(log2(energy_swing(SOFTBODY_VERLET, 0.002) / energy_swing(SOFTBODY_VERLET, 0.001)), 2.0, 0.3);
    assert_true(energy_swing(SOFTBODY_VERLET, 0.001) < 1e-3);
}

/* A damped toy loses energy, by more between two samples than semi-implicit Euler's oscillation. */
static void a_damped_toy_loses_energy(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        softbody_settings s = settings_in_space((softbody_integrator)i, 0.0002);
        s.level = 2;
        softbody *b = toy_of(&s);
        stir(b, 0.5, vec3_make(0.0, 0.0, 0.0));
        const double first = energy_of(b);
        double before = first;
        for (int n = 0; n < 100; n++) {
            steps_of(b, 50);
            const double now = energy_of(b);
            assert_true(now <= before + 2e-3 * first);
            before = now;
        }
        assert_true(before < 0.8 * first);
        softbody_destroy(b);
    }
}

/* Pressure alone, on an inflated sphere: the force on each mass is p times its area, so the first step's velocities are
 * p A / 3m outwards, p = K (V0 - V) / V0 with V = f^3 V0. */
static void pressure_acts_along_the_area_normals(void **state)
{
    (void)state;
    softbody_settings s = settings_in_space(SOFTBODY_EULER, 1e-6);
    s.level = 2;
    s.stiffness = s.bending = s.through = s.damping = 0.0;
    softbody *b = toy_of(&s);
    const size_t count = softbody_mass_count(b);
    vec3 *at = malloc(count * sizeof *at), *v = calloc(count, sizeof *v);
    softbody_positions(b, at);
    for (size_t i = 0; i < count; i++)
        at[i] = vec3_scale(at[i], 0.95);
    softbody_place(b, at, v);
    const softbody_quantities a = softbody_measure(b);
    assert_near(a.volume / a.volume_at_rest, 0.95 * 0.95 * 0.95, 1e-14);
    steps_of(b, 1);
    softbody_velocities(b, v);
    double outwards = 0.0;
    vec3 sum = {0.0, 0.0, 0.0};
    for (size_t i = 0; i < count; i++) {
        outwards += s.mass_kg / (double)count * vec3_dot(v[i], at[i]);
        sum = vec3_add(sum, v[i]);
    }
    /* sum of force . position is 3 p V (the volume is homogeneous of degree 3) */
    const double p = s.pressure * (1.0 - 0.95 * 0.95 * 0.95);
    assert_near(outwards / s.dt_s, 3.0 * p * a.volume, 1e-9 * p);
    assert_near(vec3_length(sum), 0.0, 1e-12 * sum_of_lengths(v, count));
    free(at);
    free(v);
    softbody_destroy(b);
}

/* The force on a displaced mass is minus the gradient of the energy, by finite differences. */
static void forces_are_minus_the_gradient_of_the_energy(void **state)
{
    (void)state;
    softbody_settings s = settings_in_space(SOFTBODY_EULER, 1e-9);
    s.level = 1;
    s.damping = 0.0;
    softbody *b = toy_of(&s);
    const size_t count = softbody_mass_count(b);
    vec3 *at = malloc(count * sizeof *at), *still = calloc(count, sizeof *still), *v = malloc(count * sizeof *v);
    softbody_positions(b, at);
    for (size_t i = 0; i < count; i++)
        at[i] = vec3_add(vec3_scale(at[i], 0.97),
                         vec3_make(0.05 * sin((double)i), 0.04 * cos(3.0 * (double)i), 0.03 * sin(2.0 * (double)i)));
    softbody_place(b, at, still);
    steps_of(b, 1);
    softbody_velocities(b, v);
    for (size_t i = 0; i < count; i += 5) {
        const double h = 1e-5, original = at[i].y;
        at[i].y = original + h;
        softbody_place(b, at, still);
        const double above = energy_of(b);
        at[i].y = original - h;
        softbody_place(b, at, still);
        const double below = energy_of(b);
        at[i].y = original;
        assert_near(v[i].y * s.mass_kg / (double)count / s.dt_s, -(above - below) / (2.0 * h), 2e-7);
    }
    free(at);
    free(still);
    free(v);
    softbody_destroy(b);
}

/* A grab ray through a vertex or an edge does not miss. */
static void grab_rays_through_vertices_and_edges_hit(void **state)
{
    (void)state;
    const vec3 eyes[] = {{0.0, 1.0, -6.0}, {0.0, 4.0, -5.0}, {3.0, 1.3, -2.0}};
    softbody_settings s = default_toy();
    s.level = 3;
    softbody *b = toy_of(&s);
    steps_of(b, 50);
    mesh *surface = NULL;
    diagnostic why = {.what = ""};
    assert_int_equal(softbody_surface(b, &surface, &why), STATUS_OK);
    size_t reached = 0;
    for (size_t e = 0; e < sizeof eyes / sizeof *eyes; e++)
        for (size_t i = 0; i < 3 * surface->triangle_count; i++) {
            const mesh_triangle *face = &surface->triangles[i / 3];
            const vec3 from = surface->vertices[face->corner[i % 3]], to = surface->vertices[face->corner[(i + 1) % 3]];
            const vec3 ends[] = {from, vec3_scale(vec3_add(from, to), 0.5)};
            for (size_t k = 0; k < 2; k++) {
                const vec3 direction = vec3_sub(ends[k], eyes[e]);
                vec3 where;
                if (vec3_dot(surface->normals[face->corner[i % 3]], direction) > -0.2 * vec3_length(direction))
                    continue; /* not towards the camera */
                assert_true(softbody_pick(b, eyes[e], direction, &where));
                reached++;
            }
        }
    assert_true(reached > 1000);
    mesh_release(surface);
    softbody_destroy(b);
}

static void hands_grab_hold_and_release_masses(void **state)
{
    (void)state;
    softbody_settings s = default_toy();
    s.level = 3;
    softbody *b = toy_of(&s);
    vec3 where;
    assert_false(softbody_pick(b, vec3_make(0.0, 1.0, -6.0), vec3_make(0.0, 1.0, 0.0), &where));
    assert_true(softbody_pick(b, vec3_make(0.0, 1.0, -6.0), vec3_make(0.0, 0.0, 2.0), &where));
    assert_near(where.z, -1.0, 0.02);
    const int hand = softbody_grab(b, where, 0.3), other = softbody_grab(b, vec3_make(0.0, 1.0, 1.0), 0.0);
    assert_true(hand >= 0 && other >= 0 && other != hand);
    const softbody_quantities held = softbody_measure(b);
    assert_true(held.held > 5 && held.held < 60);
    const size_t count = softbody_mass_count(b);
    vec3 *at = malloc(count * sizeof *at), *later = malloc(count * sizeof *later);
    softbody_positions(b, at);
    softbody_release(b, other);
    for (int n = 1; n <= 400; n++) {
        softbody_hold(b, hand, vec3_add(where, vec3_make(0.0, 0.0, -0.002 * n)));
        steps_of(b, 1);
    }
    softbody_positions(b, later);
    size_t moved = 0;
    for (size_t i = 0; i < count; i++)
        if (vec3_length(vec3_sub(at[i], where)) <= 0.3) {
            assert_near(vec3_length(vec3_sub(vec3_sub(later[i], at[i]), vec3_make(0.0, 0.0, -0.8))), 0.0, 1e-12);
            moved++;
        }
    assert_int_equal(moved, softbody_measure(b).held);
    softbody_release(b, hand);
    assert_int_equal(softbody_measure(b).held, 0);
    steps_of(b, 100);
    softbody_positions(b, at);
    assert_true(vec3_length(vec3_sub(at[0], later[0])) > 0.0);
    free(at);
    free(later);
    softbody_destroy(b);
}

static hand_key key_of(hand_act act, double time_s, vec3 by)
{
    return (hand_key){
        .time_s = time_s, .act = act, .origin = {0.0, 1.0, -6.0}, .direction = {0.0, 0.0, 1.0}, .reach = 0.2, .by = by};
}

/* The mean position of the held masses, relative to that at the grab. */
static vec3 held_at(const softbody *b, const vec3 *first, size_t count)
{
    vec3 *at = malloc(count * sizeof *at), sum = {0.0, 0.0, 0.0};
    size_t held = 0;
    softbody_positions(b, at);
    for (size_t i = 0; i < count; i++)
        if (vec3_length(vec3_sub(first[i], vec3_make(0.0, 1.0, -1.0))) <
            0.15) { /* well within reach of the ray's hit */
            sum = vec3_add(sum, vec3_sub(at[i], first[i]));
            held++;
        }
    free(at);
    assert_true(held > 0);
    return vec3_scale(sum, 1.0 / (double)held);
}

/* Grabbed at 0.01 s and moved by 2 until 0.05 s: after each step the masses are on a straight line at constant speed; a
 * step with a fast hand is split if requested, including the first one. */
static void a_script_moves_the_held_masses_in_every_step(void **state)
{
    (void)state;
    softbody_settings s = settings_in_space(SOFTBODY_EULER, 0.001);
    s.position = vec3_make(0.0, 1.0, 0.0);
    s.level = 3;
    s.adaptive = 1;
    softbody *b = toy_of(&s);
    hand_script *script = hand_script_create("");
    const hand_key keys[] = {key_of(HAND_GRAB, 0.01, vec3_make(0, 0, 0)),
                             key_of(HAND_MOVE, 0.05, vec3_make(0.0, 0.0, -2.0)),
                             key_of(HAND_RELEASE, 0.06, vec3_make(0, 0, 0))};
    for (int i = 0; i < 3; i++)
        assert_int_equal(hand_script_add(script, "one", &keys[i], NULL), STATUS_OK);
    assert_int_equal(softbody_follow(b, script, NULL), STATUS_OK);
    const size_t count = softbody_mass_count(b);
    vec3 *first = malloc(count * sizeof *first);
    softbody_positions(b, first);
    for (int n = 1; n <= 60; n++) {
        const uint64_t before = softbody_measure(b).substeps;
        steps_of(b, 1);
        const double theory = n <= 10 ? 0.0 : n <= 50 ? -2.0 * (n - 10) / 40.0 : -2.0;
        const vec3 moved = held_at(b, first, count);
        assert_near(moved.z, theory, 1e-12);
        assert_near(moved.x, 0.0, 1e-12);
        assert_true(n != 11 || softbody_measure(b).substeps - before > 1);
        assert_int_equal(softbody_measure(b).held > 0, n > 10);
    }
    steps_of(b, 1);
    assert_int_equal(softbody_measure(b).held, 0);
    hand_script_destroy(script);
    free(first);
    softbody_destroy(b);
}

/* A hand that finds only masses held by others is reported. */
static void a_hand_that_grabs_nothing_is_reported_with_its_line(void **state)
{
    (void)state;
    softbody_settings s = default_toy();
    s.level = 1;
    softbody *b = toy_of(&s);
    hand_script *script = hand_script_create("two.yaml");
    hand_key all = key_of(HAND_GRAB, 0.001, vec3_make(0, 0, 0)), late = key_of(HAND_GRAB, 0.002, vec3_make(0, 0, 0));
    all.reach = 10.0;
    late.line = 7;
    assert_int_equal(hand_script_add(script, "all", &all, NULL), STATUS_OK);
    assert_int_equal(hand_script_add(script, "late", &late, NULL), STATUS_OK);
    assert_int_equal(softbody_follow(b, script, NULL), STATUS_OK);
    diagnostic why = {.what = ""};
    assert_int_equal(softbody_advance(b, 0.01, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "the hand late grabs nothing"));
    assert_string_equal(why.file, "two.yaml");
    assert_int_equal(why.line, 7);
    hand_script_destroy(script);
    softbody_destroy(b);
}

static void threads_and_instruction_sets_give_bit_identical_motion(void **state)
{
    (void)state;
    for (int integrator = is_whole() ? 0 : SOFTBODY_IMPLICIT; integrator < 3; integrator++) {
        vec3 *first = NULL;
        for (int run = 0; run < 5; run++) {
            const isa next = isa_best() > ISA_BASE ? (isa)(ISA_BASE + 1) : ISA_BASE;
            const isa levels[] = {isa_best(), isa_best(), isa_best(), ISA_BASE, next};
            const int threads[] = {1, 2, 7, 3, 1};
            softbody_settings s = default_toy();
            s.level = 6; /* enough to start all threads */
            s.dt_s = 5e-5;
            s.integrator = integrator;
            s.threads = threads[run];
            s.velocity.y = -10.0;
            softbody *b;
            assert_int_equal(softbody_create(&s, levels[run], &b, NULL), STATUS_OK);
            steps_of(b, integrator == SOFTBODY_IMPLICIT ? 4 : 40);
            const size_t count = softbody_mass_count(b);
            vec3 *at = malloc(count * sizeof *at);
            softbody_positions(b, at);
            if (first)
                assert_memory_equal(at, first, count * sizeof *at);
            else
                first = at, at = NULL;
            free(at);
            softbody_destroy(b);
        }
        free(first);
    }
}

/* Faces with a hole, and springs without two ends. */
static void invalid_nets_are_refused(void **state)
{
    (void)state;
    const vec3 at[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double mass_kg[4] = {1, 1, 1, 1};
    const mesh_triangle faces[4] = {{{0, 2, 1}}, {{0, 1, 3}}, {{0, 3, 2}}, {{1, 2, 3}}};
    const softbody_spring springs[2] = {{{0, 1}, 1.0, 1.0, 0.0}, {{0, 0}, 1.0, 1.0, 0.0}};
    const softbody_settings s = settings_in_space(SOFTBODY_EULER, 0.001);
    softbody_net net = {.mass_count = 4,
                        .spring_count = 1,
                        .face_count = 4,
                        .position = at,
                        .mass_kg = mass_kg,
                        .springs = springs,
                        .faces = faces};
    softbody *b;
    assert_int_equal(softbody_create_net(&net, &s, isa_best(), &b, NULL), STATUS_OK);
    assert_near(softbody_measure(b).volume, 1.0 / 6.0, 1e-16);
    softbody_destroy(b);
    diagnostic why = {.what = ""};
    net.face_count = 3;
    assert_int_equal(softbody_create_net(&net, &s, isa_best(), &b, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "are not closed"));
    net.face_count = 4;
    net.spring_count = 2;
    assert_int_equal(softbody_create_net(&net, &s, isa_best(), &b, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "spring 1 connects"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_net_has_the_numbers_of_eulers_formula),
        cmocka_unit_test(momenta_are_conserved_up_to_rounding),
        cmocka_unit_test(backward_euler_conserves_momentum),
        cmocka_unit_test(the_energy_error_decreases_with_the_step),
        cmocka_unit_test(a_damped_toy_loses_energy),
        cmocka_unit_test(pressure_acts_along_the_area_normals),
        cmocka_unit_test(forces_are_minus_the_gradient_of_the_energy),
        cmocka_unit_test(hands_grab_hold_and_release_masses),
        cmocka_unit_test(a_script_moves_the_held_masses_in_every_step),
        cmocka_unit_test(grab_rays_through_vertices_and_edges_hit),
        cmocka_unit_test(a_hand_that_grabs_nothing_is_reported_with_its_line),
        cmocka_unit_test(threads_and_instruction_sets_give_bit_identical_motion),
        cmocka_unit_test(invalid_nets_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
