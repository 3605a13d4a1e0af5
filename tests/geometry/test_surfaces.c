/* Tests of rays that start on a surface: its own root is exact, so that rays neither escape nor stick nor drift. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "optics/interface.h"
#include "random_stream.h"
#include "ray_fixture.h"
#include "solid_reference.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(quad_abs((quad)(a) - (quad)(b)) <= (quad)(tolerance))

static const vec3 turns[] = {{0.0, 0.0, 0.0}, {17.0, -33.0, 71.0}};

static scene_geometry *arrange_one(const solid_shape *shape)
{
    const region_source source = {.shape = shape, .medium = 1, .shadow_transmittance = 1.0};
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(&source, 1, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    return a;
}

static quad apart(vec3 a, vec3 b)
{
    return quad3_length(quad3_sub(quad3_from(a), quad3_from(b)));
}

/* The reflected ray, on the side of the incident one. */
static one_ray mirrored(one_ray r, const one_hit *h)
{
    return (one_ray){h->point, direction_reflect(r.d, h->normal, h->cos_i), h->face, h->inside_before};
}

/* Repeated reflection inside; returns the number of chords. Every one ends on the surface, at a positive distance. */
static int bounce_inside(const solid_shape *s, scene_geometry *a, one_ray r, int bounces, double loosest)
{
    for (int i = 0; i < bounces; i++) {
        const one_hit h = nearest_interface(a, r);
        if (h.hit_primitive != 0 || h.before != 1 || h.after != 0 || h.t < 0.0 || h.t > 100.0)
            return i;
        if (quad_abs(reference_distance(s, quad3_from(h.point))) > loosest ||
            quad_abs(vec3_length(h.normal) - 1.0) > 1e-15)
            return i;
        r = mirrored(r, &h);
    }
    return bounces;
}

/* Reflection in a sphere: all chords are 2 r cos_i, in one plane, for any number of reflections. */
static void chords_of_reflections_in_a_sphere_are_equal(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (int trial = 0; trial < 12; trial++) {
        const double radius = exp(random_real(&seed, -5.0, 5.0));
        solid_shape s = {.kind = SHAPE_SPHERE, .radius = radius, .rotation_deg = turns[trial % 2]};
        scene_geometry *a = arrange_one(&s);
        one_ray r = {.o = vec3_scale(random_direction(&seed), 0.7 * radius),
                     .d = random_direction(&seed),
                     .start = FACE_NONE,
                     .inside = 1};
        one_hit h = nearest_interface(a, r);
        const double cos_i = h.cos_i;
        for (int i = 0; i < 10000; i++) {
            r = mirrored(r, &h);
            h = nearest_interface(a, r);
            assert_int_equal(h.hit_primitive, 0);
            assert_near(h.t, 2.0 * radius * cos_i, 1e-11 * radius); /* 10000 half-ulps, at random or not */
            assert_near(apart(r.o, h.point), h.t, 1e-15 * radius * 4.0);
            assert_near(quad3_length(quad3_from(h.point)), radius, 5e-16 * radius);
            assert_near(h.cos_i, cos_i, 1e-11);
        }
        scene_geometry_destroy(a);
    }
}

/* In a round cylinder the chords between two hits with the side are 2 r cos_i / sin^2 of the angle to the axis. */
static void chords_of_reflections_in_a_cylinder_equal_the_closed_form(void **state)
{
    (void)state;
    uint64_t seed = 2;
    for (int trial = 0; trial < 12; trial++) {
        const double radius = random_real(&seed, 0.2, 2.0), tall = 2000.0;
        solid_shape s = {
            .kind = SHAPE_CYLINDER, .position = {0.0, -tall / 2, 0.0}, .radius = radius, .height = tall, .m = 1.0};
        scene_geometry *a = arrange_one(&s);
        one_ray r = {.o = vec3_make(0.3 * radius, 0.0, 0.2 * radius),
                     .d = random_direction(&seed),
                     .start = FACE_NONE,
                     .inside = 1};
        r.d = vec3_normalize(vec3_make(r.d.x, 0.01 * r.d.y, r.d.z));
        one_hit h = nearest_interface(a, r);
        const double cos_i = h.cos_i, rise = r.d.y, level = h.point.y;
        quad length = 0;
        for (int i = 0; i < 10000; i++) {
            r = mirrored(r, &h);
            h = nearest_interface(a, r);
            assert_int_equal(h.face, 0);
            assert_near(h.t, 2.0 * radius * cos_i / (1.0 - rise * rise), 1e-10 * radius);
            assert_near(quad_sqrt((quad)h.point.x * h.point.x + (quad)h.point.z * h.point.z), radius, 5e-16 * radius);
            length += h.t;
        }
        assert_near(h.point.y - level, length * rise, 2e-9); /* the slope is constant */
        scene_geometry_destroy(a);
    }
}

static void nothing_escapes_from_a_closed_mirror(void **state)
{
    (void)state;
    static const solid_shape shapes[] = {
        {.kind = SHAPE_CYLINDER, .position = {0.1, -0.7, 0.2}, .radius = 0.95, .height = 1.95, .m = 1.0},
        {.kind = SHAPE_CYLINDER, .position = {-0.1, -0.4, 0.2}, .radius = 0.8, .height = 1.1, .m = 2.5},
        {.kind = SHAPE_CYLINDER, .radius = 0.9, .height = 1e-4, .m = 1.0},
        {.kind = SHAPE_BOX, .position = {0.2, 0.1, 0.0}, .size = {0.25, 3.0, 0.5}},
        {.kind = SHAPE_BOX, .position = {20.0, 10.0, -30.0}, .size = {1.0, 1.0, 1.0}},
        {.kind = SHAPE_SPHERE, .position = {0.1, 0.2, 0.3}, .radius = 0.9},
        {.kind = SHAPE_CONE, .position = {0.1, -0.7, 0.2}, .radius = 0.95, .top_radius = 0.3, .height = 1.2},
        {.kind = SHAPE_PRISM, .position = {0.1, -0.7, 0.2}, .radius = 0.95, .sides = 3, .height = 1.2},
    };
    uint64_t seed = 3;
    for (size_t i = 0; i < COUNT(shapes); i++) {
        for (int trial = 0; trial < 8; trial++) {
            solid_shape s = shapes[i];
            s.rotation_deg = turns[trial % 2];
            scene_geometry *a = arrange_one(&s);
            const double up = s.height > 0.0 ? s.height / 2 : 0.0;
            quad3 middle = quad3_turn(quad3_make(0, up, 0), s.rotation_deg, 0);
            one_ray r = {.o = vec3_add(s.position, vec3_make((double)middle.x, (double)middle.y, (double)middle.z)),
                         .d = random_direction(&seed),
                         .start = FACE_NONE,
                         .inside = 1};
            /* 1e-15 of the coordinates' magnitude: their own rounding */
            assert_int_equal(bounce_inside(&s, a, r, 10000, 1e-15 * (1.0 + vec3_length(s.position))), 10000);
            scene_geometry_destroy(a);
        }
    }
}

/* Whispering gallery: at grazing incidence the chords are as short as 2e-9 radii and must still be positive. */
static void grazing_chords_have_positive_lengths(void **state)
{
    (void)state;
    uint64_t seed = 4;
    solid_shape s = {.kind = SHAPE_SPHERE, .radius = 1.0};
    scene_geometry *a = arrange_one(&s);
    for (int trial = 0; trial < 200; trial++) {
        vec3 n = random_direction(&seed), side = vec3_normalize(vec3_cross(n, random_direction(&seed)));
        const double steep = exp(random_real(&seed, -20.0, 0.0));
        one_ray r = {.o = n, .d = vec3_normalize(vec3_sub(side, vec3_scale(n, steep))), .start = 0, .inside = 1};
        for (int i = 0; i < 100; i++) {
            const one_hit h = nearest_interface(a, r);
            assert_int_equal(h.hit_primitive, 0);
            assert_true(h.t > 0.5 * steep && h.t < 2.001);
            r = mirrored(r, &h);
        }
    }
    scene_geometry_destroy(a);
}

/* A ray that leaves a convex solid, by reflection or refraction, never hits it again; a ray that enters leaves on the
 * far side, with the chord of quadruple precision. */
static void a_line_crosses_a_convex_solid_at_most_twice(void **state)
{
    (void)state;
    static const solid_shape shapes[] = {
        {.kind = SHAPE_CYLINDER, .position = {0.1, -0.7, 0.2}, .radius = 0.95, .height = 1.95, .m = 1.0},
        {.kind = SHAPE_CYLINDER, .position = {-0.1, -0.4, 0.2}, .radius = 0.8, .height = 1.1, .m = 2.5},
        {.kind = SHAPE_BOX, .position = {0.2, 0.1, 0.0}, .size = {0.25, 3.0, 0.5}},
        {.kind = SHAPE_SPHERE, .position = {0.1, 0.2, 0.3}, .radius = 0.9},
        {.kind = SHAPE_CONE, .position = {0.1, -0.7, 0.2}, .radius = 0.95, .top_radius = 0.3, .height = 1.2},
        {.kind = SHAPE_PRISM, .position = {0.1, -0.7, 0.2}, .radius = 0.95, .sides = 3, .height = 1.2},
    };
    uint64_t seed = 5;
    int entered = 0;
    for (int trial = 0; trial < 20000; trial++) {
        solid_shape s = shapes[trial % (int)COUNT(shapes)];
        s.rotation_deg = turns[trial / (int)COUNT(shapes) % 2];
        scene_geometry *a = arrange_one(&s);
        vec3 from = vec3_scale(random_direction(&seed), 5.0), to = random_point(&seed, 1.0);
        one_ray r = {.o = from, .d = vec3_normalize(vec3_sub(to, from)), .start = FACE_NONE, .inside = 0};
        const one_hit in = nearest_interface(a, r);
        if (in.hit_primitive >= 0) {
            entered++;
            assert_int_equal(nearest_interface(a, mirrored(r, &in)).hit_primitive, -1);
            const one_ray on = {in.point, r.d, in.face, in.inside_after};
            const one_hit out = nearest_interface(a, on);
            assert_int_equal(out.hit_primitive, 0);
            assert_true(out.after == 0 && out.before == 1 && out.t >= 0.0);
            assert_int_equal(nearest_interface(a, (one_ray){out.point, r.d, out.face, 0}).hit_primitive, -1);
            const reference_line line = {quad3_from(in.point), quad3_from(r.d)};
            quad t[REFERENCE_CROSSINGS_MAX];
            const int n = reference_events(&s, &line, (quad)1e-9, t);
            if (n > 0 && in.cos_i > 1e-3 && out.cos_i > 1e-3)
                assert_near(out.t, t[n - 1], 2e-15 * 8.0 / (in.cos_i * out.cos_i));
        }
        scene_geometry_destroy(a);
    }
    assert_true(entered > 8000);
}

/* For a ray on a face of solid a at h: the next event of a ray along the face that leans slightly outwards. */
typedef void face_check(const scene_geometry *a, const one_hit *h, vec3 along, vec3 outward, double lean);

/* Every face of every convex shape, with and without rotation. */
static void on_all_faces(face_check *check)
{
    static const solid_shape shapes[] = {
        {.kind = SHAPE_PLANE, .position = {0.3, -0.2, 0.1}},
        {.kind = SHAPE_CYLINDER, .position = {0.1, -0.7, 0.2}, .radius = 0.95, .height = 1.95, .m = 1.0},
        {.kind = SHAPE_CYLINDER, .position = {-0.1, -0.4, 0.2}, .radius = 0.8, .height = 1.1, .m = 2.5},
        {.kind = SHAPE_BOX, .position = {0.2, 0.1, 0.0}, .size = {0.25, 3.0, 0.5}},
        {.kind = SHAPE_SPHERE, .position = {0.1, 0.2, 0.3}, .radius = 0.9},
        {.kind = SHAPE_CONE, .position = {0.1, -0.7, 0.2}, .radius = 0.95, .top_radius = 0.3, .height = 1.2},
        {.kind = SHAPE_PRISM, .position = {0.1, -0.7, 0.2}, .radius = 0.95, .sides = 3, .height = 1.2},
    };
    uint64_t seed = 6;
    int faces[COUNT(shapes)] = {0};
    for (int trial = 0; trial < 20000; trial++) {
        const int which = trial % (int)COUNT(shapes);
        solid_shape s = shapes[which];
        s.rotation_deg = turns[trial / (int)COUNT(shapes) % 2];
        scene_geometry *a = arrange_one(&s);
        vec3 from = vec3_scale(random_direction(&seed), 5.0), to = random_point(&seed, 1.0);
        const one_ray r = {from, vec3_normalize(vec3_sub(to, from)), FACE_NONE, scene_geometry_inside(a, from)};
        const one_hit h = nearest_interface(a, r);
        if (h.hit_primitive >= 0) {
            const vec3 outward = h.before == 0 ? h.normal : vec3_scale(h.normal, -1.0);
            const vec3 along = vec3_normalize(vec3_cross(outward, random_direction(&seed)));
            check(a, &h, along, outward, exp(random_real(&seed, -28.0, 0.0)));
            faces[which] |= 1 << h.face;
        }
        scene_geometry_destroy(a);
    }
    static const int all[COUNT(shapes)] = {1, 7, 7, 63, 1, 7, 31};
    assert_memory_equal(faces, all, sizeof all);
}

static void leaves_at_once(const scene_geometry *a, const one_hit *h, vec3 along, vec3 outward, double lean)
{
    const vec3 d = vec3_normalize(vec3_add(along, vec3_scale(outward, lean)));
    const one_hit out = nearest_interface(a, (one_ray){h->point, d, h->face, 1});
    assert_int_equal(out.hit_primitive, 0);
    assert_true(out.t == 0.0 && out.after == 0);
}

/* A ray inside, on a face, that leans outwards by any amount leaves immediately: the root of its own face is exactly
 * zero. */
static void the_root_of_the_starting_face_is_exactly_zero(void **state)
{
    (void)state;
    on_all_faces(leaves_at_once);
}

static void stays_outside(const scene_geometry *a, const one_hit *h, vec3 along, vec3 outward, double lean)
{
    const vec3 d = vec3_normalize(vec3_sub(along, vec3_scale(outward, lean)));
    assert_int_equal(nearest_interface(a, (one_ray){h->point, d, h->face, 0}).hit_primitive, -1);
}

/* A ray outside, on a face, does not enter there, even if rounding turns it inwards: its set decides. */
static void a_ray_outside_its_starting_face_does_not_enter_there(void **state)
{
    (void)state;
    on_all_faces(stays_outside);
}

static void is_on_one_side_or_the_other(const scene_geometry *a, const one_hit *h, vec3 along, vec3 outward,
                                        double lean)
{
    (void)lean;
    const uint64_t inside = scene_geometry_inside(a, h->point);
    const one_hit in =
        nearest_interface(a, (one_ray){h->point, vec3_normalize(vec3_sub(along, outward)), FACE_NONE, inside});
    const one_hit out =
        nearest_interface(a, (one_ray){h->point, vec3_normalize(vec3_add(along, outward)), FACE_NONE, inside});
    if (inside) {
        assert_true(in.before == 1 && in.t > 0.0 && (in.hit_primitive == 0 || a->shapes[1].kind == SHAPE_PLANE));
        assert_true(out.hit_primitive == 0 && out.before == 1 && out.t <= 1e-13);
    } else {
        assert_true(in.hit_primitive == 0 && in.before == 0 && in.after == 1 && in.t <= 1e-13);
        assert_int_equal(out.hit_primitive, -1);
    }
}

/* A ray that starts on a surface up to rounding, as from a camera: its set defines whether it is inside or outside, and
 * inwards it enters immediately or is inside already. It cannot pass without an event. */
static void a_ray_that_starts_on_a_surface_cannot_pass_without_an_event(void **state)
{
    (void)state;
    on_all_faces(is_on_one_side_or_the_other);
}

/* A reflected ray on the wall of a cup's hollow crosses it to the other side, and leaves it by the open top. */
static void a_ray_across_a_cups_hollow_hits_the_opposite_wall(void **state)
{
    (void)state;
    const solid_shape s = {
        .kind = SHAPE_CUP, .m = 1.0, .radius = 1.0, .inner_radius = 0.9, .height = 3.0, .floor = 0.1};
    scene_geometry *a = arrange_one(&s);
    one_ray r = {.o = vec3_make(0.0, 1.0, 0.0),
                 .d = vec3_make(0.6, 0.8, 0.0),
                 .start = FACE_NONE,
                 .inside = scene_geometry_inside(a, vec3_make(0, 1, 0))};
    assert_int_equal(scene_geometry_priority_index(a, r.inside), 0);
    one_hit h = nearest_interface(a, r);
    assert_near(h.t, 1.5, 1e-15);
    assert_int_equal(h.face, FACES_MAX); /* the hollow's side */
    assert_true(h.before == 0 && h.after == 1 && h.normal.x == -1.0);
    r = mirrored(r, &h);
    assert_int_equal(nearest_interface(a, r).hit_primitive, -1); /* it rises by 2.4 while crossing */
    r.d = vec3_make(-0.8, 0.6, 0.0);
    r.o.y = 0.5;
    h = nearest_interface(a, r);
    assert_near(h.t, 2.25, 1e-15);
    assert_near(h.point.y, 1.85, 1e-15);
    const one_ray wall = {h.point, r.d, h.face, h.inside_after};
    h = nearest_interface(a, wall);
    assert_near(h.t, 0.125, 1e-15); /* 0.1 of wall at cosine 0.8 */
    assert_true(h.face == 0 && h.before == 1 && h.after == 0);
    scene_geometry_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chords_of_reflections_in_a_sphere_are_equal),
        cmocka_unit_test(chords_of_reflections_in_a_cylinder_equal_the_closed_form),
        cmocka_unit_test(nothing_escapes_from_a_closed_mirror),
        cmocka_unit_test(grazing_chords_have_positive_lengths),
        cmocka_unit_test(a_line_crosses_a_convex_solid_at_most_twice),
        cmocka_unit_test(the_root_of_the_starting_face_is_exactly_zero),
        cmocka_unit_test(a_ray_outside_its_starting_face_does_not_enter_there),
        cmocka_unit_test(a_ray_that_starts_on_a_surface_cannot_pass_without_an_event),
        cmocka_unit_test(a_ray_across_a_cups_hollow_hits_the_opposite_wall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
