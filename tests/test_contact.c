/* Tests of contact: where two boundaries are one crossing, and where a gap between them is resolved. The limit is that
 * of the manual: 16 DBL_EPSILON times the sum, over both solids, of the distance of the ray's start from the solid, the
 * path to the crossing, and the solid's extent. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "ray_fixture.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_narrowest_resolved_gap_is_that_of_the_manual),
        cmocka_unit_test(the_limit_is_independent_of_the_priorities),
        cmocka_unit_test(a_distant_solid_does_not_change_the_limit),
        cmocka_unit_test(a_film_in_contact_is_entered),
        cmocka_unit_test(the_far_side_of_a_ring_in_contact_is_entered),
        cmocka_unit_test(shadow_rays_resolve_the_same_gaps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
