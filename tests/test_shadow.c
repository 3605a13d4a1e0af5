/* Tests of shadow rays against marching from interface to interface. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "room_fixture.h"

/* The product of the transmittances of the interfaces, 0 to 1, each of the region with the higher priority; opaque
 * regions transmit nothing. */
static double light_by_marching(const room *m, const reference_line *line, int solid_shadows)
{
    change changes[SOLIDS_MAX * REFERENCE_CROSSINGS_MAX];
    const int n = changes_of(m, line, changes);
    double light = 1.0;
    for (int k = 0; k < n && changes[k].t < 1; k++) {
        if (solid_shadows || is_opaque(m, changes[k].before) || is_opaque(m, changes[k].after))
            return 0.0;
        light *= m->shadow_transmittance[higher_of(m, changes[k].before, changes[k].after)];
    }
    return n < 0 ? -1.0 : light;
}

static void shadows_agree_with_marching(void **state)
{
    (void)state;
    uint64_t seed = 22;
    int partly = 0, dark = 0, lit = 0;
    for (int trial = 0; trial < 800; trial++) {
        room m;
        room_fill(&m, &seed);
        for (int k = 0; k < 12; k++) {
            vec3 from = random_point(&seed, 3.0), to = random_point(&seed, 5.0);
            if (winner(&m, from) >= 0 && m.opaque[winner(&m, from)])
                continue; /* no light reaches a point inside an opaque solid */
            one_ray r = {from, vec3_sub(to, from), FACE_NONE, scene_geometry_inside(m.solids, from)};
            const reference_line line = {quad3_from(r.o), quad3_from(r.d)};
            const double expected = light_by_marching(&m, &line, k % 2), got = light_through(m.solids, r, k % 2);
            if (expected < 0.0)
                continue;
            assert_true(fabs(got - expected) <= 1e-15);
            partly += expected > 0.0 && expected < 1.0;
            dark += expected == 0.0;
            lit += expected == 1.0;
        }
        scene_geometry_destroy(m.solids);
    }
    assert_true(partly > 300 && dark > 600 && lit > 600);
}

/* An opaque cup: light enters only through its open top. */
static void light_enters_an_opaque_cup_from_above(void **state)
{
    (void)state;
    room m = {.count = 1, .opaque = {1}, .medium = {1}};
    m.shape[0] =
        (solid_shape){.kind = SHAPE_CUP, .m = 1.0, .radius = 1.0, .inner_radius = 0.9, .height = 3.0, .floor = 0.1};
    room_build(&m);
    const vec3 floor_point = vec3_make(0.0, 0.1, 0.0);
    const uint64_t inside = scene_geometry_inside(m.solids, vec3_make(0.0, 0.2, 0.0));
    const int64_t floor_face = FACES_MAX + 1;
    for (int k = 0; k <= 100; k++) {
        const double slope = k * 0.01; /* the lamp is 29 above the floor; the rim is 2.9 above it at 0.9 */
        one_ray r = {floor_point, vec3_make(29.0 * slope, 29.0, 0.0), floor_face, inside};
        if (fabs(slope - 0.9 / 2.9) > 1e-9)
            assert_true(light_through(m.solids, r, 0) == (slope < 0.9 / 2.9 ? 1.0 : 0.0));
    }
    one_ray below = {vec3_make(0.5, -1.0, 0.0), vec3_make(0.0, 10.0, 0.0), FACE_NONE, 0};
    assert_true(light_through(m.solids, below, 0) == 0.0); /* through the bottom */
    one_ray across = {vec3_make(-2.0, 1.0, 0.0), vec3_make(4.0, 0.0, 0.0), FACE_NONE, 0};
    assert_true(light_through(m.solids, across, 0) == 0.0);
    across.o.y = 3.5;
    assert_true(light_through(m.solids, across, 0) == 1.0);
    across.o.y = 1.0;
    across.d.x = 0.99; /* the lamp is in front of the wall */
    assert_true(light_through(m.solids, across, 0) == 1.0);
    scene_geometry_destroy(m.solids);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shadows_agree_with_marching),
        cmocka_unit_test(light_enters_an_opaque_cup_from_above),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
