/* Tests of contact and of coincident faces: where two boundaries are one crossing, and where a gap between them is
 * resolved. */
#include <float.h>
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

/* Contact: where two boundaries are one crossing, and where a gap between them is resolved. The limit is that
 * of the manual: 16 DBL_EPSILON times the sum, over both solids, of the distance of the ray's start from the solid, the
 * path to the crossing, and the solid's extent. */

/* Two boxes below and above y = 0, with a gap; optionally a solid far away. */
static scene_geometry *halves(double gap, double x, bool upper_wins, bool far_solid)
{
    const solid_shape shapes[3] = {
        {.kind = SHAPE_BOX, .position = {x, 0.5, 0.0}, .size = {4.0, 1.0, 4.0}},
        {.kind = SHAPE_BOX, .position = {x, -1.0 - gap, 0.0}, .size = {4.0, 2.0, 4.0}},
        {.kind = SHAPE_SPHERE, .position = {0.0, 1e6, 0.0}, .radius = 10.0},
    };
    const region_source sources[3] = {
        {.shape = &shapes[0], .priority = upper_wins ? 2 : 1, .medium = 1, .shadow_transmittance = 1.0, .solid = 0},
        {.shape = &shapes[1], .priority = upper_wins ? 1 : 2, .medium = 2, .shadow_transmittance = 1.0, .solid = 1},
        {.shape = &shapes[2], .priority = 9, .medium = 3, .shadow_transmittance = 1.0, .solid = 2},
    };
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(sources, far_solid ? 3 : 2, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    return a;
}

static one_ray downwards_ray(const scene_geometry *a, double x, double angle, double height)
{
    one_ray r = {{x, height, 0.0}, {sin(angle), -cos(angle), 0.0}, FACE_NONE, 0};
    r.inside = scene_geometry_inside(a, r.o);
    return r;
}

/* Is the surrounding medium next to the upper box? */
static bool sees_gap(double gap, double x, double angle, bool upper_wins, bool far_solid)
{
    scene_geometry *a = halves(gap, x, upper_wins, far_solid);
    const one_hit h = nearest_interface(a, downwards_ray(a, x, angle, 0.5));
    assert_true(h.hit_primitive >= 0 && fabs(h.t * cos(angle) - 0.5) < 1e-9);
    const bool outside = h.after == 0;
    scene_geometry_destroy(a);
    return outside;
}

/* The narrowest gap that is resolved, by bisection of its logarithm. */
static double narrowest_gap(double x, double angle, bool upper_wins, bool far_solid)
{
    double contact = 1e-17, gap = 1e-6;
    while (gap > 1.01 * contact) {
        const double middle = sqrt(gap * contact);
        *(sees_gap(middle, x, angle, upper_wins, far_solid) ? &gap : &contact) = middle;
    }
    return gap;
}

/* The sum of magnitudes that a box's error bound is computed from. */
static double magnitudes(double x, double middle, double size, double angle)
{
    const double start = 0.5 - middle, path = 0.5 + 0.5 * fabs(tan(angle));
    return fabs(start) + path + fmax(fabs(x), fabs(middle)) + size;
}

static void the_narrowest_resolved_gap_is_that_of_the_manual(void **state)
{
    (void)state;
    const double angles[] = {0.0, 0.3, 0.8, 1.2}, places[] = {0.0, 30.0, 1000.0};
    for (int k = 0; k < 12; k++) {
        const double angle = angles[k % 4], x = places[k / 4];
        const double limit = 16.0 * DBL_EPSILON * (magnitudes(x, 0.5, 4.0, angle) + magnitudes(x, -1.0, 4.0, angle));
        for (int upper_wins = 0; upper_wins < 2; upper_wins++) {
            const double narrowest = narrowest_gap(x, angle, upper_wins, false);
            /* a box's position is itself rounded, to a few 1e-16 */
            if (!(fabs(narrowest / limit - 1.0) <= 0.05))
                fail_msg("x %g, angle %g: %g, not %g", x, angle, narrowest, limit);
        }
    }
}

static void the_limit_is_independent_of_the_priorities(void **state)
{
    (void)state;
    const double limit = 16.0 * DBL_EPSILON * (magnitudes(0.0, 0.5, 4.0, 0.4) + magnitudes(0.0, -1.0, 4.0, 0.4));
    for (int upper_wins = 0; upper_wins < 2; upper_wins++) {
        assert_true(sees_gap(1.2 * limit, 0.0, 0.4, upper_wins, false));
        assert_false(sees_gap(0.8 * limit, 0.0, 0.4, upper_wins, false));
    }
}

static void a_distant_solid_does_not_change_the_limit(void **state)
{
    (void)state;
    for (int upper_wins = 0; upper_wins < 2; upper_wins++)
        assert_true(narrowest_gap(0.0, 0.4, upper_wins, false) == narrowest_gap(0.0, 0.4, upper_wins, true));
}

/* A film that touches a solid is entered, however thin it is; its other side is not taken instead. */
static void a_film_in_contact_is_entered(void **state)
{
    (void)state;
    for (int order = 0; order < 6; order++) {
        for (double thickness = 1e-12; thickness < 1.0; thickness *= 10.0) {
            const solid_shape shapes[2] = {
                {.kind = SHAPE_BOX, .position = {0.0, 0.5, 0.0}, .size = {4.0, 1.0, 4.0}},
                {.kind = SHAPE_BOX, .position = {0.0, -0.5 * thickness, 0.0}, .size = {4.0, thickness, 4.0}},
            };
            const region_source sources[2] = {
                {.shape = &shapes[0], .priority = order % 2, .medium = 1, .shadow_transmittance = 1.0, .solid = 0},
                {.shape = &shapes[1], .priority = 1 - order % 2, .medium = 2, .shadow_transmittance = 1.0, .solid = 1},
            };
            scene_geometry *a = NULL;
            assert_int_equal(scene_geometry_build(sources, 2, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
            one_ray r = downwards_ray(a, 0.0, 0.3 * (order / 2), 0.5);
            one_hit h = nearest_interface(a, r);
            assert_int_equal(a->regions[h.after].medium, 2);
            r = (one_ray){h.point, r.d, h.face, h.inside_after};
            h = nearest_interface(a, r);
            assert_int_equal(h.after, 0);
            assert_true(fabs(h.t * cos(0.3 * (order / 2)) - thickness) <= 1e-14);
            scene_geometry_destroy(a);
        }
    }
}

/* A ring that begins again where a box ends: the ray leaves the box, which hides the ring's near side, into the ring's
 * far side. */
static void the_far_side_of_a_ring_in_contact_is_entered(void **state)
{
    (void)state;
    const solid_shape shapes[2] = {
        {.kind = SHAPE_BOX, .position = {-8.5, 0.0, 0.0}, .size = {23.0, 4.0, 4.0}},
        {.kind = SHAPE_TORUS, .radius = 4.0, .tube_radius = 1.0},
    };
    for (int first = 0; first < 2; first++) {
        region_source sources[2];
        sources[first] = (region_source){
            .shape = &shapes[0], .priority = 2, .medium = 1, .shadow_transmittance = 1.0, .solid = first};
        sources[1 - first] = (region_source){
            .shape = &shapes[1], .priority = 1, .medium = 2, .shadow_transmittance = 1.0, .solid = 1 - first};
        scene_geometry *a = NULL;
        assert_int_equal(scene_geometry_build(sources, 2, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
        one_ray r = {{-10.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, FACE_NONE, 0};
        r.inside = scene_geometry_inside(a, r.o);
        one_hit h = nearest_interface(a, r);
        assert_true(fabs(h.t - 13.0) < 1e-12);
        assert_int_equal(a->regions[h.before].medium, 1);
        assert_int_equal(a->regions[h.after].medium, 2);
        h = nearest_interface(a, (one_ray){h.point, r.d, h.face, h.inside_after});
        assert_true(fabs(h.t - 2.0) < 1e-12);
        assert_int_equal(h.after, 0);
        scene_geometry_destroy(a);
    }
}

/* Two rotated discs of clear glass, one above the other: the light of a shadow ray that crosses 2 or 4 interfaces. */
static double light_through_discs(double gap, const vec3 *turn_deg)
{
    const mat3 turn = rotation_from_deg(*turn_deg);
    solid_shape shapes[2] = {
        {.kind = SHAPE_CYLINDER, .position = {0.0, 0.0, 0.0}, .radius = 2.0, .height = 1.0, .m = 1.0},
        {.kind = SHAPE_CYLINDER, .position = {0.0, -1.0 - gap, 0.0}, .radius = 2.0, .height = 1.0, .m = 1.0},
    };
    region_source sources[2];
    for (int i = 0; i < 2; i++) {
        shapes[i].position = mat3_apply(turn, shapes[i].position);
        shapes[i].rotation_deg = *turn_deg;
        sources[i] = (region_source){
            .shape = &shapes[i], .priority = i, .medium = i + 1, .shadow_transmittance = 0.5, .solid = i};
    }
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(sources, 2, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    const vec3 from = mat3_apply(turn, vec3_make(0.1, 3.0, 0.2)), to = mat3_apply(turn, vec3_make(0.6, -4.0, -0.3));
    const double light = light_through(a, (one_ray){from, vec3_sub(to, from), FACE_NONE, 0}, 0);
    scene_geometry_destroy(a);
    return light;
}

/* In and out of each disc, or from one into the other: a factor of 0.5 each. A shadow ray's direction is not a unit
 * vector. */
static void shadow_rays_resolve_the_same_gaps(void **state)
{
    (void)state;
    const vec3 turns[] = {{0.0, 0.0, 0.0}, {17.0, -33.0, 71.0}, {90.0, 0.0, 45.0}};
    for (size_t k = 0; k < sizeof turns / sizeof *turns; k++) {
        for (double gap = 1e-12; gap < 0.5; gap *= 10.0)
            assert_true(light_through_discs(gap, &turns[k]) == 0.0625);
        for (double gap = 0.0; gap < 1e-14; gap += 2e-15)
            assert_true(light_through_discs(gap, &turns[k]) == 0.125);
    }
}

/* Coincident faces, exact or up to the rounding of a rotation: one interface or none, and never a film of air
 * in between. */

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
    assert_int_equal(scene_geometry_build(sources, m->count, 0, TREE_IF_TOO_MANY, &m->solids, NULL), STATUS_OK);
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
        cmocka_unit_test(the_narrowest_resolved_gap_is_that_of_the_manual),
        cmocka_unit_test(the_limit_is_independent_of_the_priorities),
        cmocka_unit_test(a_distant_solid_does_not_change_the_limit),
        cmocka_unit_test(a_film_in_contact_is_entered),
        cmocka_unit_test(the_far_side_of_a_ring_in_contact_is_entered),
        cmocka_unit_test(shadow_rays_resolve_the_same_gaps),
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
