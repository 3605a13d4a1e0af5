/* Irregular nets: the forces of springs, which are computed once for both ends, compared with a sum over the list. */
#include "random_stream.h"
#include "softbody_fixture.h"

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
        cmocka_unit_test(forces_of_an_irregular_net_equal_the_sum_over_its_springs),
        cmocka_unit_test(an_irregular_net_has_the_same_bits_on_all_instruction_sets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
