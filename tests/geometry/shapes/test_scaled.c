/* Tests of solids that are scaled or mirrored as a whole: against the same solids with other lengths, against closed
 * forms, and against rays through the solid in its own frame. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "asphere_fixture.h"
#include "geometry/primitives/primitive.h"
#include "geometry/shapes/shape.h"
#include "ray_fixture.h"
#include "room_fixture.h"
#include "solid_reference.h"

static one_ray random_ray(uint64_t *seed)
{
    const vec3 to = random_point(seed, 1.0), d = random_direction(seed);
    return (one_ray){vec3_sub(to, vec3_scale(d, 6.0)), d, FACE_NONE, 0};
}

/* All hits along a line; returns their number. */
static int walk(const scene_geometry *a, one_ray r, one_hit hits[8])
{
    int n = 0;
    for (one_hit h = nearest_interface(a, r); h.hit_primitive >= 0; h = nearest_interface(a, r)) {
        assert_true(n < 8);
        hits[n++] = h;
        r = (one_ray){h.point, r.d, h.face, h.inside_after};
    }
    return n;
}

/* Both solids have the same hits, and normals, along random rays. faces: whether the faces have the same numbers. */
static void expect_same(const solid_shape *scaled, const solid_shape *other, bool faces, uint64_t *seed)
{
    assert_int_equal(solid_shape_check(scaled, NULL), STATUS_OK);
    assert_int_equal(solid_shape_check(other, NULL), STATUS_OK);
    scene_geometry *a = scene_geometry_of(scaled, 1), *b = scene_geometry_of(other, 1);
    int found = 0;
    for (int i = 0; i < 400; i++) {
        const one_ray r = random_ray(seed);
        one_hit one[8], two[8];
        const int n = walk(a, r, one);
        assert_int_equal(walk(b, r, two), n);
        for (int k = 0; k < n; k++) {
            const double apart = vec3_length(vec3_sub(one[k].point, two[k].point));
            assert_true(apart <= 4.0 * (one[k].error + two[k].error) / fmin(1.0, two[k].cos_i));
            if (two[k].cos_i > 1e-3)
                assert_true(vec3_length(vec3_sub(one[k].normal, two[k].normal)) < 1e-9);
            assert_true(!faces || one[k].face % FACES_MAX == two[k].face % FACES_MAX);
        }
        found += n;
    }
    assert_true(found > 40);
    const bounds3 box = shape_world_box(scaled), same = shape_world_box(other);
    assert_true(vec3_length(vec3_sub(box.low, same.low)) + vec3_length(vec3_sub(box.high, same.high)) < 1e-12);
    scene_geometry_destroy(a);
    scene_geometry_destroy(b);
}

static solid_shape placed(shape_kind kind, uint64_t *seed)
{
    solid_shape s = {.kind = kind,
                     .radius = 0.5,
                     .height = 1.2,
                     .m = 1.0,
                     .inner_radius = 0.4,
                     .floor = 0.1,
                     .sides = 5,
                     .top_radius = 0.2,
                     .tube_radius = 0.15,
                     .size = {0.6, 0.8, 1.0}};
    s.radius_1 = 0.9, s.radius_2 = -1.4, s.thickness = 0.5, s.diameter = 1.0;
    s.position = random_point(seed, 0.4);
    s.rotation_deg = random_point(seed, 180.0);
    return s;
}

/* A box, a cylinder, a cup and a lens have other lengths instead of a scale. */
static void a_scale_is_other_lengths(void **state)
{
    (void)state;
    uint64_t seed = 1;
    solid_shape s = placed(SHAPE_BOX, &seed), t = s;
    s.scale = vec3_make(1.5, 0.5, -0.7), t.size = vec3_make(0.9, 0.4, 0.7);
    expect_same(&s, &t, false, &seed);
    for (int cup = 0; cup < 2; cup++) { /* x^2 + z^2 = r^2 with z / 0.5 in it: m = 2 */
        s = placed(cup ? SHAPE_CUP : SHAPE_CYLINDER, &seed), t = s;
        s.scale = vec3_make(1.2, 0.8, 0.6), t.m = 2.0;
        t.radius *= 1.2, t.inner_radius *= 1.2, t.height *= 0.8, t.floor *= 0.8;
        expect_same(&s, &t, true, &seed);
    }
    s = placed(SHAPE_LENS, &seed), t = s;
    s.scale = vec3_make(1.3, 1.3, 1.3);
    s.even_1[0] = t.even_1[0] = -0.2, s.diameter_2 = t.diameter_2 = 0.7;
    scale_lens(&t, 1.3);
    expect_same(&s, &t, true, &seed);
    const shape_kind kinds[] = {SHAPE_SPHERE, SHAPE_CONE, SHAPE_PRISM, SHAPE_TORUS};
    for (int i = 0; i < 4; i++) {
        s = placed(kinds[i], &seed), t = s;
        s.scale = vec3_make(0.7, 0.7, 0.7);
        t.radius *= 0.7, t.height *= 0.7, t.top_radius *= 0.7, t.tube_radius *= 0.7;
        expect_same(&s, &t, true, &seed);
    }
}

/* A lens mirrored along its axis is the lens with its sides exchanged, which begins below its position. */
static void a_mirrored_lens_has_its_sides_exchanged(void **state)
{
    (void)state;
    uint64_t seed = 2;
    solid_shape s = placed(SHAPE_LENS, &seed), t = s;
    s.conic_1 = t.conic_2 = -0.8, s.scale = vec3_make(1.0, -1.0, 1.0);
    t.radius_1 = -s.radius_2, t.radius_2 = -s.radius_1;
    const mat3 turn = rotation_from_deg(s.rotation_deg);
    t.position = vec3_sub(s.position, mat3_apply(turn, vec3_make(0.0, s.thickness, 0.0)));
    expect_same(&s, &t, false, &seed);
}

/* The ellipsoid x^2 / a^2 + y^2 / b^2 + z^2 / c^2 = 1: roots of its quadratic, normals (x / a^2, y / b^2, z / c^2), for
 * half axes that differ by up to a factor of 1000. */
static void an_ellipsoid_has_the_roots_of_its_quadratic(void **state)
{
    (void)state;
    uint64_t seed = 3;
    double worst = 0.0, worst_normal = 0.0;
    long hits = 0;
    for (int i = 0; i < 20000; i++) {
        const double a = pow(10.0, random_real(&seed, -3.0, 0.0)), b = random_real(&seed, 0.3, 1.0),
                     c = random_real(&seed, 0.3, 1.0);
        const solid_shape s = {.kind = SHAPE_SPHERE, .radius = 1.0, .scale = {a, b, -c}};
        scene_geometry *g = scene_geometry_of(&s, 1);
        const one_ray r = random_ray(&seed);
        const one_hit h = nearest_interface(g, r);
        const quad A = (quad)r.d.x * r.d.x / ((quad)a * a) + (quad)r.d.y * r.d.y / ((quad)b * b) +
                       (quad)r.d.z * r.d.z / ((quad)c * c),
                   B = (quad)r.o.x * r.d.x / ((quad)a * a) + (quad)r.o.y * r.d.y / ((quad)b * b) +
                       (quad)r.o.z * r.d.z / ((quad)c * c),
                   C = (quad)r.o.x * r.o.x / ((quad)a * a) + (quad)r.o.y * r.o.y / ((quad)b * b) +
                       (quad)r.o.z * r.o.z / ((quad)c * c) - 1;
        const quad discriminant = B * B - A * C;
        if (fabs((double)(discriminant / (B * B))) > 1e-9)
            assert_int_equal(h.hit_primitive >= 0, discriminant > 0);
        if (h.hit_primitive >= 0 && discriminant > 0) {
            const double t = (double)((-B - quad_sqrt(discriminant)) / A);
            const vec3 p = vec3_add(r.o, vec3_scale(r.d, t)),
                       n = vec3_normalize(vec3_make(p.x / (a * a), p.y / (b * b), p.z / (c * c)));
            if (h.cos_i > 0.01) {
                worst = fmax(worst, fabs(h.t - t) * h.cos_i / h.error);
                worst_normal = fmax(worst_normal, vec3_length(vec3_sub(n, h.normal)) * a);
            }
            hits++;
        }
        scene_geometry_destroy(g);
    }
    print_message("%ld hits; t is within %.3f of its error, normals within %.2g of the closed form\n", hits, worst,
                  worst_normal);
    assert_true(hits > 4000 && worst <= 1.0 && worst_normal < 1e-12);
}

/* Of any shape: points of hits are on the surface by quadruple precision, insides alternate, and there is the same
 * number of hits as crossings. */
static void hits_of_any_shape_are_on_its_surface(void **state)
{
    (void)state;
    uint64_t seed = 4;
    long scaled = 0, hits = 0;
    double worst = 0.0;
    for (int i = 0; i < 12000; i++) {
        const solid_shape s = random_shape(&seed);
        if (!shape_is_scaled(&s) || s.kind == SHAPE_TORUS)
            continue;
        scaled++;
        scene_geometry *g = scene_geometry_of(&s, 1);
        const one_ray r = random_ray(&seed);
        one_hit found[8];
        const int n = walk(g, r, found);
        for (int k = 0; k < n; k++) {
            worst = fmax(worst, fabs((double)reference_distance(&s, quad3_from(found[k].point))) / found[k].error);
            assert_int_equal(found[k].after, 1 - k % 2);
        }
        const reference_line line = {quad3_from(r.o), quad3_from(r.d)};
        quad t[REFERENCE_CROSSINGS_MAX];
        assert_int_equal(reference_events(&s, &line, 0, t), n);
        hits += n;
        scene_geometry_destroy(g);
    }
    print_message("%ld scaled solids, %ld hits, within %.3f of the error bound\n", scaled, hits, worst);
    assert_true(scaled > 1000 && hits > 1000 && worst <= 1.0);
}

/* Rays that start on the surface of a scaled solid and reflect within it stay there. */
static void reflected_rays_stay_within(void **state)
{
    (void)state;
    uint64_t seed = 5;
    const shape_kind kinds[] = {SHAPE_SPHERE, SHAPE_CYLINDER, SHAPE_BOX, SHAPE_CONE, SHAPE_PRISM, SHAPE_LENS};
    long bounces = 0;
    for (int trial = 0; trial < 120; trial++) {
        solid_shape s = placed(kinds[trial % 6], &seed);
        s.scale = vec3_make(random_real(&seed, 0.1, 3.0), random_real(&seed, -3.0, -0.1), random_real(&seed, 0.1, 3.0));
        scene_geometry *g = scene_geometry_of(&s, 1);
        const double y = kinds[trial % 6] == SHAPE_BOX || kinds[trial % 6] == SHAPE_SPHERE ? 0.0 : 0.25 * s.scale.y;
        const vec3 middle = vec3_add(s.position, mat3_apply(rotation_from_deg(s.rotation_deg), vec3_make(0.0, y, 0.0)));
        assert_true(solid_shape_contains(&s, middle));
        one_ray r = {middle, random_direction(&seed), FACE_NONE, 1};
        for (int k = 0; k < 100; k++, bounces++) {
            const one_hit h = nearest_interface(g, r);
            assert_int_equal(h.hit_primitive, 0);
            assert_true(fabs((double)reference_distance(&s, quad3_from(h.point))) <= h.error);
            r = (one_ray){h.point, vec3_normalize(vec3_sub(r.d, vec3_scale(h.normal, 2.0 * vec3_dot(r.d, h.normal)))),
                          h.face, 1};
        }
        scene_geometry_destroy(g);
    }
    assert_int_equal(bounces, 12000);
}

/* The flat faces of a mirrored block are at half its edges, outwards of it; its textures are those of the cube. */
static void faces_and_textures_are_scaled(void **state)
{
    (void)state;
    const solid_shape cube = {.kind = SHAPE_BOX, .size = {1.0, 1.0, 1.0}};
    solid_shape block = cube;
    block.scale = vec3_make(2.0, -4.0, -6.0);
    scene_geometry *a = scene_geometry_of(&cube, 1), *b = scene_geometry_of(&block, 1);
    flat_face flat[FLATS_MAX];
    assert_int_equal(primitive_flats(&b->primitives[0], flat), 6);
    for (int i = 0; i < 6; i++) {
        assert_true(fabs(flat[i].at) == 1.0 + flat[i].axis);
        assert_true(flat[i].outwards == (flat[i].at < 0.0 ? -1.0 : 1.0));
    }
    uint64_t seed = 6;
    for (int face = 0; face < 6; face++) {
        const vec3 q = random_point(&seed, 0.5), k = block.scale;
        const surface_mapping one = primitive_mapping(&a->primitives[0], face, q, 0.25),
                              two = primitive_mapping(&b->primitives[0], face,
                                                      vec3_make(k.x * q.x, k.y * q.y, k.z * q.z), 0.25);
        assert_true(fabs(one.u - two.u) + fabs(one.v - two.v) < 1e-12 && two.per_length == one.per_length / 2.0);
    }
    scene_geometry_destroy(a);
    scene_geometry_destroy(b);
}

/* A solid at points is not scaled by the scale of its points. */
static void the_scale_of_points_is_theirs(void **state)
{
    (void)state;
    vec3 at[] = {{1.0, 0.0, 0.0}};
    const mesh points = {.vertices = at, .vertex_count = 1, .bounds = {at[0], at[0]}};
    const solid_shape s = {.kind = SHAPE_SPHERE, .radius = 0.5, .points = &points, .scale = {3.0, 1.0, 1.0}};
    assert_false(shape_is_scaled(&s));
    const solid_shape one = solid_shape_copy(&s, 0);
    assert_false(shape_is_scaled(&one));
    assert_true(one.position.x == 3.0);
}

static void a_scale_of_0_is_refused(void **state)
{
    (void)state;
    const solid_shape s = {.kind = SHAPE_SPHERE, .radius = 0.5, .scale = {1.0, 0.0, 1.0}};
    diagnostic why = {.what = ""};
    assert_int_equal(solid_shape_check(&s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "scale is 1, 0, 1"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scale_is_other_lengths),
        cmocka_unit_test(a_mirrored_lens_has_its_sides_exchanged),
        cmocka_unit_test(an_ellipsoid_has_the_roots_of_its_quadratic),
        cmocka_unit_test(hits_of_any_shape_are_on_its_surface),
        cmocka_unit_test(reflected_rays_stay_within),
        cmocka_unit_test(faces_and_textures_are_scaled),
        cmocka_unit_test(the_scale_of_points_is_theirs),
        cmocka_unit_test(a_scale_of_0_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
