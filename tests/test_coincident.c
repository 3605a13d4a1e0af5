/* Tests of coincident faces, exact or up to the rounding of a rotation: one interface or none, and never a film of air
 * in between. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "optics/interface.h"
#include "quad.h"
#include "random_stream.h"
#include "ray_fixture.h"

enum { PARTS_MAX = 4, STEPS_MAX = 8 };

typedef struct assembly {
    int count;
    solid_shape shape[PARTS_MAX];
    int64_t priority[PARTS_MAX], medium[PARTS_MAX];
    vec3 turn; /* of the whole, about the origin */
    scene_geometry *solids;
} assembly;

static vec3 turned(vec3 v, vec3 degrees)
{
    quad3 w = quad3_turn(quad3_from(v), degrees, 0);
    return vec3_make((double)w.x, (double)w.y, (double)w.z);
}

/* The parts are described upright and rotated together here. */
static void assemble(assembly *m, vec3 turn)
{
    region_source sources[PARTS_MAX];
    m->turn = turn;
    for (int i = 0; i < m->count; i++) {
        m->shape[i].rotation_deg = turn;
        m->shape[i].position = turned(m->shape[i].position, turn);
        sources[i] = (region_source){.shape = &m->shape[i],
                                     .priority = m->priority[i],
                                     .medium = m->medium[i],
                                     .shadow_transmittance = 1.0,
                                     .solid = i};
    }
    assert_int_equal(scene_geometry_build(sources, m->count, 0, TREE_IF_MANY, &m->solids, NULL), STATUS_OK);
}

/* The media in order along the line, as digits: "01230". */
static void expect_media(const assembly *m, one_ray r, const char *expected)
{
    for (int k = 0; expected[k + 1]; k++) {
        const one_hit h = nearest_interface(m->solids, r);
        assert_true(h.hit_primitive >= 0);
        assert_int_equal(m->solids->regions[h.before].medium, expected[k] - '0');
        assert_int_equal(m->solids->regions[h.after].medium, expected[k + 1] - '0');
        r = (one_ray){h.point, r.d, h.face, h.inside_after};
    }
    assert_int_equal(nearest_interface(m->solids, r).hit_primitive, -1);
}

/* A line through a point of the contact plane y = level, from above, at an angle to that plane down to 1e-7 (both
 * upright). */
static one_ray line_through(const assembly *m, vec3 contact, double away, uint64_t *seed)
{
    const double steep = exp(random_real(seed, -16.0, 0.5)), turn = random_real(seed, 0.0, 6.2831853);
    vec3 d = turned(vec3_normalize(vec3_make(cos(turn), -steep, sin(turn))), m->turn);
    vec3 o = vec3_sub(turned(contact, m->turn), vec3_scale(d, away));
    return (one_ray){o, d, FACE_NONE, scene_geometry_inside(m->solids, o)};
}

static const vec3 turns[] = {{0.0, 0.0, 0.0}, {0.0, 0.0, 13.7}, {17.3, -33.1, 71.9}, {-5.7, 123.4, 3.3}};

typedef assembly assembly_maker(void);

static void through_the_contact(assembly_maker *make, const char *expected)
{
    uint64_t seed = 31;
    for (size_t k = 0; k < sizeof turns / sizeof *turns; k++) {
        assembly m = make();
        assemble(&m, turns[k]);
        for (int i = 0; i < 4000; i++) {
            vec3 contact = vec3_make(random_real(&seed, -0.4, 0.4), 0.3, random_real(&seed, -0.4, 0.4));
            expect_media(&m, line_through(&m, contact, 5.0, &seed), expected);
        }
        scene_geometry_destroy(m.solids);
    }
}

/* Two unit blocks, one on the other, touching at y = 0.3. */
static assembly blocks(int64_t lower, int64_t upper, int64_t lower_priority)
{
    assembly m = {.count = 2, .priority = {lower_priority, 2}, .medium = {lower, upper}};
    m.shape[0] = (solid_shape){.kind = SHAPE_BOX, .position = {0.0, 0.3 - 0.35, 0.0}, .size = {1.0, 0.7, 1.0}};
    m.shape[1] = (solid_shape){.kind = SHAPE_BOX, .position = {0.0, 0.3 + 0.15, 0.0}, .size = {1.0, 0.3, 1.0}};
    return m;
}

static assembly blocks_of_one_glass(void)
{
    return blocks(1, 1, 1);
}
static assembly blocks_of_two_glasses(void)
{
    return blocks(1, 2, 1);
}
static assembly blocks_of_which_the_lower_wins(void)
{
    return blocks(1, 2, 3);
}

static assembly block_on_a_plane(void)
{
    assembly m = {.count = 2, .priority = {0, 1}, .medium = {1, 2}};
    m.shape[0] = (solid_shape){.kind = SHAPE_PLANE, .position = {0.0, 0.3, 0.0}};
    m.shape[1] = (solid_shape){.kind = SHAPE_BOX, .position = {0.0, 0.3 + 0.15, 0.0}, .size = {1.0, 0.3, 1.0}};
    return m;
}

static assembly cylinder_on_a_plane_that_wins(void)
{
    assembly m = {.count = 2, .priority = {5, 1}, .medium = {1, 2}};
    m.shape[0] = (solid_shape){.kind = SHAPE_PLANE, .position = {0.0, 0.3, 0.0}};
    m.shape[1] =
        (solid_shape){.kind = SHAPE_CYLINDER, .position = {0.0, 0.3, 0.0}, .radius = 0.9, .height = 0.7, .m = 1.0};
    return m;
}

/* A gap of 1e-9 is not a rounding error: it must be resolved. */
static assembly blocks_with_a_gap(void)
{
    assembly m = blocks(1, 2, 3);
    m.shape[1].position.y += 1e-9;
    return m;
}

/* A sheet of a third glass, 1e-9 thick, between the blocks. */
static assembly blocks_with_a_sheet_between(void)
{
    assembly m = blocks(1, 2, 3);
    m.count = 3;
    m.shape[2] = (solid_shape){.kind = SHAPE_BOX, .position = {0.0, 0.3, 0.0}, .size = {1.0, 1e-9, 1.0}};
    m.priority[2] = 4;
    m.medium[2] = 3;
    return m;
}

static void films_of_1e_9_are_resolved(void **state)
{
    (void)state;
    through_the_contact(blocks_with_a_gap, "02010");
    through_the_contact(blocks_with_a_sheet_between, "02310");
}

static void blocks_of_one_glass_have_no_interface_in_contact(void **state)
{
    (void)state;
    through_the_contact(blocks_of_one_glass, "010");
}

static void blocks_of_two_glasses_in_contact_have_one_interface(void **state)
{
    (void)state;
    through_the_contact(blocks_of_two_glasses, "0210");
    through_the_contact(blocks_of_which_the_lower_wins, "0210");
}

static void a_solid_on_a_plane_has_one_interface_with_it(void **state)
{
    (void)state;
    through_the_contact(block_on_a_plane, "021");
    through_the_contact(cylinder_on_a_plane_that_wins, "021");
}

/* A ray mirrored at the contact returns through the upper block only. */
static void mirror_at_the_contact(assembly_maker *make)
{
    uint64_t seed = 32;
    for (size_t k = 0; k < sizeof turns / sizeof *turns; k++) {
        assembly m = make();
        assemble(&m, turns[k]);
        for (int i = 0; i < 4000; i++) {
            vec3 contact = vec3_make(random_real(&seed, -0.4, 0.4), 0.3, random_real(&seed, -0.4, 0.4));
            one_ray r = line_through(&m, contact, 5.0, &seed);
            one_hit h = nearest_interface(m.solids, r);
            h = nearest_interface(m.solids, (one_ray){h.point, r.d, h.face, h.inside_after});
            assert_int_equal(m.solids->regions[h.after].medium, 1);
            expect_media(&m, (one_ray){h.point, direction_reflect(r.d, h.normal, h.cos_i), h.face, h.inside_before},
                         "20");
        }
        scene_geometry_destroy(m.solids);
    }
}

static void a_ray_mirrored_at_the_contact_returns_through_the_upper_block(void **state)
{
    (void)state;
    mirror_at_the_contact(blocks_of_two_glasses);
    mirror_at_the_contact(blocks_of_which_the_lower_wins);
}

/* A liquid that fills its vessel exactly: same radius, same floor, same height; with a higher priority of the vessel,
 * then of the liquid. */
static void a_liquid_that_fits_its_vessel_exactly_has_one_interface_with_it(void **state)
{
    (void)state;
    uint64_t seed = 33;
    for (size_t k = 0; k < 2 * sizeof turns / sizeof *turns; k++) {
        assembly m = {.count = 2, .priority = {2, k % 2 ? 3 : 1}, .medium = {1, 2}};
        m.shape[0] = (solid_shape){.kind = SHAPE_CUP,
                                   .position = {0.0, -1.0, 0.0},
                                   .radius = 1.0,
                                   .inner_radius = 0.9,
                                   .m = k % 4 < 2 ? 1.0 : 1.6,
                                   .height = 2.0,
                                   .floor = 0.1};
        m.shape[1] = (solid_shape){
            .kind = SHAPE_CYLINDER, .position = {0.0, -0.9, 0.0}, .radius = 0.9, .height = 1.9, .m = m.shape[0].m};
        assemble(&m, turns[k / 2]);
        for (int i = 0; i < 4000; i++) {
            /* from the liquid, to a point of the wall well below the rim */
            vec3 from =
                vec3_make(random_real(&seed, -0.5, 0.5), random_real(&seed, -0.6, 0.6), random_real(&seed, -0.5, 0.5));
            const double turn = random_real(&seed, 0.0, 6.2831853);
            vec3 wall = vec3_make(0.9 * cos(turn), random_real(&seed, -0.5, 0.5), 0.9 * sin(turn));
            from.z /= m.shape[0].m, wall.z /= m.shape[0].m;
            one_ray r = {turned(from, m.turn), turned(vec3_normalize(vec3_sub(wall, from)), m.turn), FACE_NONE, 0};
            r.inside = scene_geometry_inside(m.solids, r.o);
            expect_media(&m, r, "210");
            /* and back from outside */
            vec3 far = vec3_add(r.o, vec3_scale(r.d, 4.0));
            const one_hit in = nearest_interface(
                m.solids, (one_ray){far, vec3_scale(r.d, -1.0), FACE_NONE, scene_geometry_inside(m.solids, far)});
            assert_int_equal(m.solids->regions[in.after].medium, 1);
            const one_hit wet =
                nearest_interface(m.solids, (one_ray){in.point, vec3_scale(r.d, -1.0), in.face, in.inside_after});
            assert_int_equal(m.solids->regions[wet.before].medium, 1);
            assert_int_equal(m.solids->regions[wet.after].medium, 2);
        }
        /* down the axis: through the surface and the floor */
        vec3 above = turned(vec3_make(0.1, 3.0, 0.2), m.turn);
        expect_media(&m,
                     (one_ray){above, turned(vec3_make(0.0, -1.0, 0.0), m.turn), FACE_NONE,
                               scene_geometry_inside(m.solids, above)},
                     "0210");
        scene_geometry_destroy(m.solids);
    }
}

/* As in the reference scene: the liquid overlaps the wall, which has the higher priority. */
static void a_liquid_overlapping_the_wall_has_one_interface_with_it(void **state)
{
    (void)state;
    static const double turning_points[] = {1.0, 1.1, 2.9, 3.0}; /* along x, from x = -2 */
    static const int64_t media[] = {0, 1, 2, 1, 0};
    assembly m = {.count = 2, .priority = {2, 1}, .medium = {1, 2}};
    m.shape[0] = (solid_shape){.kind = SHAPE_CUP,
                               .m = 1.0,
                               .position = {0.0, 0.001, 0.0},
                               .radius = 1.0,
                               .inner_radius = 0.9,
                               .height = 3.0,
                               .floor = 0.1};
    m.shape[1] =
        (solid_shape){.kind = SHAPE_CYLINDER, .position = {0.0, 0.051, 0.0}, .radius = 0.95, .height = 1.95, .m = 1.0};
    assemble(&m, turns[0]);
    one_ray r = {vec3_make(-2.0, 1.0, 0.0), vec3_make(1.0, 0.0, 0.0), FACE_NONE, 0};
    for (int k = 0; k < 4; k++) {
        const one_hit h = nearest_interface(m.solids, r);
        assert_true(fabs(h.point.x - (turning_points[k] - 2.0)) < 1e-15);
        assert_int_equal(m.solids->regions[h.before].medium, media[k]);
        assert_int_equal(m.solids->regions[h.after].medium, media[k + 1]);
        r = (one_ray){h.point, r.d, h.face, h.inside_after};
    }
    assert_int_equal(nearest_interface(m.solids, r).hit_primitive, -1);
    one_ray down = {vec3_make(0.2, 5.0, 0.1), vec3_make(0.0, -1.0, 0.0), FACE_NONE, 0};
    down.inside = scene_geometry_inside(m.solids, down.o);
    const one_hit surface = nearest_interface(m.solids, down);
    assert_true(fabs(surface.point.y - 2.001) < 1e-15);
    expect_media(&m, down, "0210");
    scene_geometry_destroy(m.solids);
}

/* Solids of the surrounding medium are invisible, alone or overlapping; in another medium they are bubbles. */
static void equal_media_have_no_interface(void **state)
{
    (void)state;
    assembly m = {.count = 3, .priority = {0, 1, 2}, .medium = {0, 0, 0}};
    m.shape[0] = (solid_shape){.kind = SHAPE_SPHERE, .radius = 1.0};
    m.shape[1] = (solid_shape){.kind = SHAPE_BOX, .position = {0.5, 0.0, 0.0}, .size = {1.0, 1.0, 1.0}};
    m.shape[2] = (solid_shape){.kind = SHAPE_CUP,
                               .m = 1.0,
                               .position = {0.0, -0.5, 0.0},
                               .radius = 1.0,
                               .inner_radius = 0.9,
                               .height = 1.5,
                               .floor = 0.1};
    assembly bubble = m;
    bubble.medium[0] = 1;
    bubble.count = 2;
    assemble(&m, turns[2]);
    uint64_t seed = 34;
    for (int i = 0; i < 5000; i++) {
        vec3 o = random_point(&seed, 2.0);
        assert_int_equal(nearest_interface(m.solids, (one_ray){o, random_direction(&seed), FACE_NONE,
                                                               scene_geometry_inside(m.solids, o)})
                             .hit_primitive,
                         -1);
    }
    scene_geometry_destroy(m.solids);
    bubble.shape[1].size = vec3_make(0.5, 0.5, 0.5);
    assemble(&bubble, turns[0]);
    expect_media(&bubble, (one_ray){vec3_make(-3.0, 0.1, 0.0), vec3_make(1.0, 0.0, 0.0), FACE_NONE, 0}, "01010");
    scene_geometry_destroy(bubble.solids);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_of_one_glass_have_no_interface_in_contact),
        cmocka_unit_test(blocks_of_two_glasses_in_contact_have_one_interface),
        cmocka_unit_test(films_of_1e_9_are_resolved),
        cmocka_unit_test(a_solid_on_a_plane_has_one_interface_with_it),
        cmocka_unit_test(a_ray_mirrored_at_the_contact_returns_through_the_upper_block),
        cmocka_unit_test(a_liquid_that_fits_its_vessel_exactly_has_one_interface_with_it),
        cmocka_unit_test(a_liquid_overlapping_the_wall_has_one_interface_with_it),
        cmocka_unit_test(equal_media_have_no_interface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
