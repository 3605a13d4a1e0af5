/* Tests of a torus's special cases: up to four crossings with a line. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "random_stream.h"
#include "ray_fixture.h"
#include "solid_reference.h"
#include "whole.h"

static solid_shape torus_of(double radius, double tube_radius)
{
    return (solid_shape){.kind = SHAPE_TORUS, .radius = radius, .tube_radius = tube_radius};
}

/* All crossings of a ray, each from the last one's point. */
static int walk(const scene_geometry *a, one_ray r, one_hit *hits, int most)
{
    int n = 0;
    for (one_hit h = nearest_interface(a, r); h.hit_primitive >= 0; h = nearest_interface(a, r)) {
        assert_true(n < most);
        hits[n++] = h;
        r = (one_ray){h.point, r.d, h.face, h.inside_after};
    }
    return n;
}

static void a_line_through_both_tubes_has_four_crossings(void **state)
{
    (void)state;
    const solid_shape s = torus_of(1.0, 0.25);
    scene_geometry *a = scene_geometry_of(&s, 1);
    one_hit hits[8];
    const one_ray across = {{-3.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, FACE_NONE, 0};
    assert_int_equal(walk(a, across, hits, 8), 4);
    static const double lengths[4] = {1.75, 0.5, 1.5, 0.5}; /* to the tube, through it, the hole, the tube */
    for (int k = 0; k < 4; k++) {
        assert_true(fabs(hits[k].t - lengths[k]) <= 1e-15 * 4.0);
        assert_int_equal(hits[k].before, k % 2);
        assert_int_equal(hits[k].after, 1 - k % 2);
        assert_true(hits[k].normal.x == -1.0 && hits[k].cos_i == 1.0);
    }
    const one_ray along_axis = {{0.0, -3.0, 0.0}, {0.0, 1.0, 0.0}, FACE_NONE, 0};
    assert_int_equal(walk(a, along_axis, hits, 8), 0);
    const one_ray down = {{1.0, 3.0, 0.0}, {0.0, -1.0, 0.0}, FACE_NONE, 0};
    assert_int_equal(walk(a, down, hits, 8), 2);
    assert_true(hits[1].t == 0.5 && hits[0].normal.y == 1.0);
    scene_geometry_destroy(a);
}

/* Every crossing of a random line, from hit to hit (including starts on the surface), against quadruple precision, and
 * its point's distance from the surface in units of its bound. */
static void crossings_of_random_lines_agree_with_quadruple_precision(void **state)
{
    (void)state;
    const int rays = trials_of(120000);
    uint64_t seed = 1;
    double worst = 0.0, worst_along = 0.0;
    long crossings = 0, with_four = 0, unlike = 0;
    for (int ray = 0; ray < rays; ray++) {
        const double R = exp(random_real(&seed, -3.0, 3.0));
        solid_shape s = torus_of(R, R * (1.0 - exp(random_real(&seed, -6.0, -0.002))));
        s.position = random_point(&seed, random_below(&seed, 4) ? 1.0 : 1000.0);
        if (random_below(&seed, 2))
            s.rotation_deg = random_point(&seed, 180.0);
        scene_geometry *a = scene_geometry_of(&s, 1);
        const double size = R + s.tube_radius, off = exp(random_real(&seed, 0.5, random_below(&seed, 8) ? 1.0 : 9.0));
        const vec3 from = vec3_add(s.position, vec3_scale(random_direction(&seed), size * off));
        const vec3 to = vec3_add(s.position, vec3_scale(random_direction(&seed), size * random_real(&seed, 0.0, 1.0)));
        const one_ray r = {from, vec3_normalize(vec3_sub(to, from)), FACE_NONE, 0};
        const reference_line line = {quad3_from(r.o), quad3_from(r.d)};
        quad t[REFERENCE_CROSSINGS_MAX], passed = 0;
        one_hit hits[8];
        const int events = reference_events(&s, &line, 0, t), n = walk(a, r, hits, 8);
        bool grazes = false; /* its crossings may differ in double precision */
        for (int k = 0; k + 1 < events; k++)
            grazes |= t[k + 1] - t[k] < (quad)1e-5 * size;
        unlike += n != events;
        assert_true(n == events || grazes);
        for (int k = 0; k < n; k++) {
            const quad away = quad_abs(reference_distance(&s, quad3_from(hits[k].point)));
            worst = fmax(worst, (double)(away / hits[k].error));
            passed += hits[k].t;
            if (n == events && hits[k].cos_i > 0.01) {
                const double bound = (k + 1) * hits[k].error / hits[k].cos_i + hits[0].error / hits[0].cos_i;
                worst_along = fmax(worst_along, (double)(quad_abs(passed - t[k]) / bound));
            }
        }
        crossings += n;
        with_four += n == 4;
        scene_geometry_destroy(a);
    }
    print_message("%d rays, %ld crossings, %ld rays with four, %ld grazing ones that differ; errors are at most %.3f "
                  "of the bound "
                  "for points, %.3f for distances\n",
                  rays, crossings, with_four, unlike, worst, worst_along);
    assert_true(worst <= 1.0 && worst_along <= 1.0);
    assert_true(with_four > rays / 100 && crossings > rays / 2);
}

/* Pappus and Guldin: 2 pi^2 R r^2. */
static void the_volume_of_a_torus_equals_that_of_pappus(void **state)
{
    (void)state;
    enum { POINTS = 200000 };
    uint64_t seed = 2;
    solid_shape s = torus_of(0.8, 0.3);
    s.position = vec3_make(0.1, -0.2, 0.3);
    s.rotation_deg = vec3_make(20.0, 40.0, 60.0);
    scene_geometry *a = scene_geometry_of(&s, 1);
    int inside = 0;
    for (int i = 0; i < POINTS; i++)
        inside += scene_geometry_inside(a, vec3_add(s.position, random_point(&seed, 1.2))) == 1;
    const double pi = acos(-1.0), share = 2.0 * pi * pi * 0.8 * 0.09 / pow(2.4, 3.0);
    assert_true(fabs((double)inside / POINTS - share) < 4.0 * sqrt(share * (1.0 - share) / POINTS));
    scene_geometry_destroy(a);
}

/* A ball that fills the hole overlaps the tube, which has the higher priority: no air between them, and the tube's
 * inner side is an interface between the two. */
static void a_lower_priority_is_hidden_inside_the_tube(void **state)
{
    (void)state;
    const solid_shape shapes[2] = {torus_of(1.0, 0.25), {.kind = SHAPE_SPHERE, .radius = 0.9}};
    scene_geometry *a = scene_geometry_of(shapes, 2);
    const one_ray across = {{-3.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, FACE_NONE, 0};
    one_hit hits[8];
    assert_int_equal(walk(a, across, hits, 8), 4);
    static const int solids[5] = {-1, 0, 1, 0, -1};
    for (int k = 0; k < 4; k++) {
        assert_int_equal(a->regions[hits[k].before].solid, solids[k]);
        assert_int_equal(a->regions[hits[k].after].solid, solids[k + 1]);
        assert_int_equal(a->regions[hits[k].surface].solid, 0);
    }
    scene_geometry_destroy(a);
    const solid_shape over[2] = {
        shapes[1], shapes[0]}; /* now the ball has the higher priority and hides two of the tube's crossings */
    a = scene_geometry_of(over, 2);
    assert_int_equal(walk(a, across, hits, 8), 4);
    static const int covered[5] = {-1, 1, 0, 1, -1};
    for (int k = 0; k < 4; k++)
        assert_int_equal(a->regions[hits[k].after].solid, covered[k + 1]);
    scene_geometry_destroy(a);
}

/* Light through both tubes is attenuated by each interface; an opaque torus blocks with either tube, and lets light
 * through its hole. */
static void shadows_include_both_tubes_of_a_torus(void **state)
{
    (void)state;
    const solid_shape s = torus_of(1.0, 0.25);
    region_source source = {.shape = &s, .medium = 1, .shadow_transmittance = 0.5};
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(&source, 1, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    const one_ray whole = {{-3.0, 0.0, 0.0}, {6.0, 0.0, 0.0}, FACE_NONE, 0},
                  half = {{-3.0, 0.0, 0.0}, {3.0, 0.0, 0.0}, FACE_NONE, 0};
    const one_ray hole = {{0.0, -3.0, 0.0}, {0.1, 6.0, 0.0}, FACE_NONE, 0},
                  far = {{0.0, 0.0, 0.0}, {6.0, 0.0, 0.0}, FACE_NONE, 0};
    assert_true(light_through(a, whole, 0) == 0.0625 && light_through(a, half, 0) == 0.25);
    assert_true(light_through(a, hole, 0) == 1.0 && light_through(a, far, 0) == 0.25);
    scene_geometry_destroy(a);
    source.opaque = true;
    assert_int_equal(scene_geometry_build(&source, 1, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    assert_true(light_through(a, whole, 0) == 0.0 && light_through(a, far, 0) == 0.0);
    assert_true(light_through(a, hole, 0) == 1.0);
    scene_geometry_destroy(a);
}

/* Mirrored inside repeatedly: every chord ends on the surface, ahead, and none escapes. */
static void nothing_escapes_from_a_mirrored_tube(void **state)
{
    (void)state;
    uint64_t seed = 3;
    for (int trial = 0; trial < trials_of(20); trial++) {
        solid_shape s = torus_of(1.0, random_real(&seed, 0.02, 0.98));
        s.rotation_deg = trial % 2 ? vec3_make(17.0, -33.0, 71.0) : vec3_make(0.0, 0.0, 0.0);
        scene_geometry *a = scene_geometry_of(&s, 1);
        const quad3 middle = quad3_turn(quad3_make(1, 0, 0), s.rotation_deg, 0);
        one_ray r = {vec3_make((double)middle.x, (double)middle.y, (double)middle.z), random_direction(&seed),
                     FACE_NONE, 1};
        for (int i = 0; i < 5000; i++) {
            const one_hit h = nearest_interface(a, r);
            assert_true(h.hit_primitive == 0 && h.before == 1 && h.after == 0 && h.t >= 0.0);
            assert_true(quad_abs(reference_distance(&s, quad3_from(h.point))) <= (quad)1e-15);
            const vec3 d = vec3_add(r.d, vec3_scale(h.normal, 2.0 * h.cos_i));
            r = (one_ray){h.point, d, h.face, h.inside_before};
        }
        scene_geometry_destroy(a);
    }
}

/* A start on the surface, with a set that states the side: inside and directed outwards it leaves at once, and outside
 * it enters no sooner than it has left. */
static void the_region_set_decides_on_the_starting_surface(void **state)
{
    (void)state;
    uint64_t seed = 4;
    const solid_shape s = torus_of(1.0, 0.4);
    scene_geometry *a = scene_geometry_of(&s, 1);
    for (int trial = 0; trial < 20000; trial++) {
        const double around = random_real(&seed, 0.0, 6.3), tube = random_real(&seed, 0.0, 6.3);
        const vec3 n = vec3_make(cos(tube) * cos(around), sin(tube), cos(tube) * sin(around));
        const vec3 at = vec3_add(vec3_make(cos(around), 0.0, sin(around)), vec3_scale(n, 0.4));
        const vec3 along = vec3_normalize(vec3_cross(n, random_direction(&seed)));
        const double lean = exp(random_real(&seed, -28.0, 0.0));
        const vec3 out = vec3_normalize(vec3_add(along, vec3_scale(n, lean))),
                   in = vec3_normalize(vec3_sub(along, vec3_scale(n, lean)));
        const one_hit left = nearest_interface(a, (one_ray){at, out, 0, 1});
        assert_true(left.hit_primitive == 0 && left.before == 1 && left.t >= 0.0);
        const one_hit inner = nearest_interface(a, (one_ray){at, in, 0, 1});
        assert_true(inner.hit_primitive == 0 && inner.before == 1 && inner.t >= 0.0 && inner.t < 2.9);
        const one_hit missed = nearest_interface(a, (one_ray){at, in, 0, 0});
        assert_true(missed.hit_primitive < 0 || missed.before == 0);
        if (lean > 1e-3)
            assert_true(left.t == 0.0 && (missed.hit_primitive < 0 || missed.t > 1e-3));
    }
    scene_geometry_destroy(a);
}

static void a_torus_without_a_hole_is_refused(void **state)
{
    (void)state;
    solid_shape s = torus_of(1.0, 1.0);
    diagnostic why = {0};
    assert_int_equal(solid_shape_check(&s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.remedy, "make tube_radius smaller"));
    s.tube_radius = 0.999;
    assert_int_equal(solid_shape_check(&s, &why), STATUS_OK);
    s.tube_radius = 0.0;
    assert_int_equal(solid_shape_check(&s, &why), STATUS_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_through_both_tubes_has_four_crossings),
        cmocka_unit_test(crossings_of_random_lines_agree_with_quadruple_precision),
        cmocka_unit_test(the_volume_of_a_torus_equals_that_of_pappus),
        cmocka_unit_test(a_lower_priority_is_hidden_inside_the_tube),
        cmocka_unit_test(shadows_include_both_tubes_of_a_torus),
        cmocka_unit_test(nothing_escapes_from_a_mirrored_tube),
        cmocka_unit_test(the_region_set_decides_on_the_starting_surface),
        cmocka_unit_test(a_torus_without_a_hole_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
