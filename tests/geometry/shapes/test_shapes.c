/* Tests that each shape's rule is consistent: its sizes, primitives and drawings hold for the points that it contains.
 * A new shape is tested here without a new line. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "geometry/mesh/mesh_generators.h"
#include "geometry/primitives/primitive.h"
#include "geometry/scene_geometry.h"
#include "geometry/shapes/shape.h"
#include "random_stream.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <math.h>
#include <string.h>

enum { POINTS = 20000, DIRECTIONS = 24 };
#define SLACK 1e-9

static uint64_t seed = 20260101;

/* At its defaults, fitted to a cube of 2, rotated, and elliptic if it has m. */
static solid_shape an_example(shape_kind kind)
{
    solid one = {.shape.kind = kind};
    assert_int_equal(param_set_defaults(PARAM_SOLID, &one, NULL), STATUS_OK);
    one.shape.kind = kind;
    shape_of_kind(kind)->fit(&one.shape, 2.0);
    one.shape.m = shape_has(shape_of_kind(kind), "m") ? 0.7 : 1.0;
    one.shape.position = vec3_make(0.3, -0.2, 0.5);
    one.shape.rotation_deg = vec3_make(30.0, -50.0, 110.0);
    return one.shape;
}

/* Calls test for each shape whose sizes are known without a mesh. */
static void each_bounded(void test(const shape_rule *rule, const placed_shape *placed))
{
    const shape_rule *rule;
    int count = 0;
    for (int k = 0; (rule = shape_of_kind((shape_kind)k)); k++) {
        if (rule->unbounded || rule->triangles)
            continue;
        const solid_shape shape = an_example((shape_kind)k);
        assert_int_equal(solid_shape_check(&shape, NULL), STATUS_OK);
        const placed_shape placed = shape_placed(&shape);
        test(rule, &placed);
        count++;
    }
    assert_true(count >= 4);
}

static vec3 point_in(bounds3 b, double around)
{
    return vec3_make(random_real(&seed, b.low.x - around, b.high.x + around),
                     random_real(&seed, b.low.y - around, b.high.y + around),
                     random_real(&seed, b.low.z - around, b.high.z + around));
}

static vec3 in_world(const placed_shape *placed, vec3 local)
{
    return vec3_add(placed->shape.position, mat3_apply(placed->turn, local));
}

static bool is_in(bounds3 b, vec3 p)
{
    return p.x >= b.low.x - SLACK && p.x <= b.high.x + SLACK && p.y >= b.low.y - SLACK && p.y <= b.high.y + SLACK &&
           p.z >= b.low.z - SLACK && p.z <= b.high.z + SLACK;
}

static void every_parameter_has_a_row(void **state)
{
    (void)state;
    const shape_rule *rule;
    for (int k = 0; (rule = shape_of_kind((shape_kind)k)); k++) {
        shape_kind named;
        assert_true(shape_named(rule->word, &named) && (int)named == k && rule->meaning);
        for (const char *const *name = rule->parameters; name && *name; name++) {
            const param *row = param_find(PARAM_SOLID, *name);
            assert_true(row && row->group == PARAM_SOLID && row->by_shape);
        }
    }
    for (size_t i = 0; i < param_count(); i++) {
        bool used = !param_at(i)->by_shape;
        for (int k = 0; (rule = shape_of_kind((shape_kind)k)); k++)
            used |= shape_has(rule, param_at(i)->name);
        assert_true(used);
    }
}

/* "About a cube": a cone is narrower at its top, a ring flat. */
static void fitted(const shape_rule *rule, const placed_shape *placed)
{
    for (double size = 0.01; size < 200.0; size *= 7.0) {
        solid_shape shape = placed->shape;
        shape.m = 1.0;
        rule->fit(&shape, size);
        const bounds3 b = rule->extent(&shape).box;
        const double wide = fmax(b.high.x - b.low.x, fmax(b.high.y - b.low.y, b.high.z - b.low.z));
        assert_true(wide > 0.9 * size && wide < 1.1 * size);
        assert_int_equal(solid_shape_check(&shape, NULL), STATUS_OK);
    }
}

static void shapes_fit_the_size_that_is_asked_for(void **state)
{
    (void)state;
    each_bounded(fitted);
}

static void sizes(const shape_rule *rule, const placed_shape *placed)
{
    const solid_shape *shape = &placed->shape;
    const shape_extent e = rule->extent(shape);
    const bounds3 world = shape_world_box(shape);
    const vec3 middle = vec3_scale(vec3_add(e.box.low, e.box.high), 0.5);
    const round_frame frames[2] = {{random_direction(&seed), rotation_from_deg(vec3_make(10, 20, 30)), 0.8, false},
                                   {random_direction(&seed), rotation_from_deg(vec3_make(0, 0, 0)), 1.0, true}};
    vec3 along[DIRECTIONS];
    double most[DIRECTIONS];
    for (int i = 0; i < DIRECTIONS; i++)
        along[i] = random_direction(&seed), most[i] = -INFINITY;
    for (int n = 0; n < POINTS; n++) {
        const vec3 p = point_in(e.box, 0.1), at = in_world(placed, p);
        if (!rule->contains(shape, p))
            continue;
        assert_true(is_in(e.box, p) && is_in(world, at));
        assert_true(vec3_length(vec3_sub(p, middle)) <= e.ball + SLACK);
        for (int i = 0; i < 2; i++)
            assert_true(round_distance(&frames[i], at) <= placed_farthest_from(placed, &frames[i]) + SLACK);
        for (int i = 0; i < DIRECTIONS; i++)
            most[i] = fmax(most[i], vec3_dot(along[i], p));
    }
    for (int i = 0; i < DIRECTIONS; i++) {
        assert_true(most[i] <= rule->farthest(shape, along[i]) + SLACK);
        assert_true(most[i] >= rule->farthest(shape, along[i]) - 0.3 * e.ball);
    }
    assert_true(rule->thickness(shape) > 0.0 && rule->thickness(shape) <= 2.0 * e.ball + SLACK);
}

static void contained_points_are_within_the_bounds(void **state)
{
    (void)state;
    each_bounded(sizes);
}

static void primitives(const shape_rule *rule, const placed_shape *placed)
{
    const solid_shape *shape = &placed->shape;
    const region_source source = {.shape = shape, .medium = 1, .shadow_transmittance = 1.0};
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(&source, 1, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    for (int n = 0; n < POINTS; n++) {
        const vec3 p = point_in(rule->extent(shape).box, 0.3), at = in_world(placed, p);
        bool inside = primitive_contains(&a->primitives[0], at);
        for (int i = 1; i < rule->primitive_count; i++)
            inside &= !primitive_contains(&a->primitives[i], at);
        assert_int_equal(inside, rule->contains(shape, p));
        assert_int_equal(inside, solid_shape_contains(shape, at));
    }
    scene_geometry_destroy(a);
}

static void primitives_contain_the_points_of_the_solid(void **state)
{
    (void)state;
    each_bounded(primitives);
}

static void covers(const shape_rule *rule, const placed_shape *placed)
{
    int covered = 0, contained = 0;
    for (int n = 0; n < POINTS && rule->covers; n++) {
        const vec3 p = point_in(rule->extent(&placed->shape).box, 0.2);
        const solid_shape point = shape_point(in_world(placed, p));
        const placed_shape hidden = shape_placed(&point);
        const bool is_covered = rule->covers(placed, &hidden), is_contained = rule->contains(&placed->shape, p);
        assert_true(!is_covered || is_contained);
        covered += is_covered, contained += is_contained;
    }
    assert_true(!rule->covers || covered > contained / 2);
}

static void a_covered_point_is_contained(void **state)
{
    (void)state;
    each_bounded(covers);
}

static void drawings(const shape_rule *rule, const placed_shape *placed)
{
    const solid_shape *shape = &placed->shape;
    const bounds3 box = rule->extent(shape).box;
    shape_ring rings[RINGS_MAX];
    const int count = rule->rings ? rule->rings(shape, rings) : 0;
    vec3 most = {0.0, 0.0, 0.0};
    assert_true(count <= RINGS_MAX);
    for (int i = 0; i < count; i++) {
        const int corners = rings[i].corners ? rings[i].corners : 48;
        for (int k = 0; k < corners; k++) {
            const double angle = (rings[i].from_deg + 360.0 * k / corners) * (M_PI / 180.0);
            const vec3 at = vec3_make(rings[i].x * cos(angle), rings[i].y, rings[i].z * sin(angle));
            assert_true(is_in(box, at));
            most = vec3_make(fmax(most.x, at.x), 0.0, fmax(most.z, at.z));
        }
    }
    /* round the axis they reach the sides of the box; both of a cylinder do */
    assert_true(count == 0 || (most.x > box.high.x - SLACK && most.z > box.high.z - SLACK));
    for (int i = 0; i < count && shape->kind == SHAPE_CYLINDER; i++)
        assert_true(fabs(rings[i].x - box.high.x) < SLACK && fabs(rings[i].z - box.high.z) < SLACK);
    const vec3 scale = rule->tessellation_scale ? rule->tessellation_scale(shape) : vec3_make(1, 1, 1);
    for (int part = 0; part < rule->primitive_count; part++) {
        mesh *m = NULL;
        assert_int_equal(rule->tessellation(shape, part, &m, NULL), STATUS_OK);
        for (size_t i = 0; i < m->vertex_count; i++) {
            const vec3 v = m->vertices[i];
            assert_true(is_in(box, vec3_make(v.x * scale.x, v.y * scale.y, v.z * scale.z)));
        }
        mesh_release(m);
    }
    assert_true(strlen(shape_face_name(rule, 0)) > 0);
}

static void drawings_are_within_the_bounding_box(void **state)
{
    (void)state;
    each_bounded(drawings);
}

/* Just behind each triangle a point is in the primitive, and just in front of it a point is not: fronts face outwards,
 * and no triangle deviates from the surface by more than the segments of a round edge. The parts of a cup share its rim
 * and are open there. */
static void surfaces(const shape_rule *rule, const placed_shape *placed)
{
    const solid_shape *shape = &placed->shape;
    const region_source source = {.shape = shape, .medium = 1, .shadow_transmittance = 1.0};
    const vec3 scale = rule->tessellation_scale ? rule->tessellation_scale(shape) : vec3_make(1, 1, 1);
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(&source, 1, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    for (int part = 0; part < rule->primitive_count && !rule->hollow; part++) {
        mesh *m = NULL;
        assert_int_equal(rule->tessellation(shape, part, &m, NULL), STATUS_OK);
        assert_true(m->closed);
        for (size_t i = 0; i < m->triangle_count; i++) {
            vec3 corner[3];
            for (int k = 0; k < 3; k++) {
                const vec3 v = m->vertices[m->triangles[i].corner[k]];
                corner[k] = vec3_make(v.x * scale.x, v.y * scale.y, v.z * scale.z);
            }
            const vec3 across = vec3_cross(vec3_sub(corner[1], corner[0]), vec3_sub(corner[2], corner[0]));
            const vec3 hair = vec3_scale(vec3_normalize(across), 5e-4);
            const vec3 middle = vec3_scale(vec3_add(corner[0], vec3_add(corner[1], corner[2])), 1.0 / 3.0);
            assert_true(primitive_contains(&a->primitives[part], in_world(placed, vec3_sub(middle, hair))));
            assert_false(primitive_contains(&a->primitives[part], in_world(placed, vec3_add(middle, hair))));
        }
        mesh_release(m);
    }
    scene_geometry_destroy(a);
}

static void triangles_are_on_the_surface(void **state)
{
    (void)state;
    each_bounded(surfaces);
}

static void flat_faces_bound_the_solid(void **state)
{
    (void)state;
    const shape_rule *rule;
    for (int k = 0; (rule = shape_of_kind((shape_kind)k)); k++) {
        if (rule->unbounded || rule->triangles || !rule->flat)
            continue;
        solid_shape shape = an_example((shape_kind)k);
        if (shape_has(rule, "radius_2"))
            shape.radius_2 = 0.0; /* a lens need not have a flat side */
        vec3 normal, point;
        size_t i = 0;
        for (; rule->flat(&shape, i, &normal, &point); i++) {
            bool below = false, above = false;
            for (int n = 0; n < POINTS; n++) { /* near the plane some point is inside, on one side or the other */
                const vec3 p = point_in(rule->extent(&shape).box, 0.1);
                const double side = vec3_dot(vec3_normalize(normal), vec3_sub(p, point));
                below |= fabs(side) < 0.05 && side < 0.0 && rule->contains(&shape, p);
                above |= fabs(side) < 0.05 && side > 0.0 && rule->contains(&shape, p);
            }
            assert_true(below || above);
        }
        assert_true(i > 0);
    }
}

/* By the definition of a primitive's contains, surfaces are part of it: here of sizes without rounding. */
static void points_of_the_surface_belong_to_a_solid(void **state)
{
    (void)state;
    static const struct {
        solid_shape shape;
        vec3 on[4];
    } cases[] = {
        {{.kind = SHAPE_BOX, .size = {2, 4, 6}}, {{1, 0, 0}, {0, -2, 0}, {0, 0, 3}, {-1, 2, -3}}},
        {{.kind = SHAPE_CYLINDER, .m = 1, .radius = 2, .height = 3}, {{2, 1, 0}, {0, 0, -2}, {0, 3, 1}, {0, 3, 2}}},
        {{.kind = SHAPE_LENS, .radius_1 = 8, .radius_2 = 0, .thickness = 2, .diameter = 4},
         {{0, 0, 0}, {0, 2, 0}, {2, 1, 0}, {0, 2, -2}}},
        {{.kind = SHAPE_TORUS, .radius = 4, .tube_radius = 1}, {{5, 0, 0}, {4, 1, 0}, {0, -1, -4}, {0, 0, -5}}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const region_source source = {.shape = &cases[i].shape, .medium = 1, .shadow_transmittance = 1.0};
        scene_geometry *a = NULL;
        assert_int_equal(scene_geometry_build(&source, 1, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
        for (int k = 0; k < 4; k++) {
            const vec3 p = cases[i].on[k], out = vec3_scale(p, 1.0 + 1e-9);
            assert_true(shape_of(&cases[i].shape)->contains(&cases[i].shape, p));
            assert_true(primitive_contains(&a->primitives[0], p));
            assert_true(vec3_length(p) == 0.0 || !primitive_contains(&a->primitives[0], out));
        }
        scene_geometry_destroy(a);
    }
}

/* An image that is fitted to an end, seen from outside: its corners are those of the square around the end, its upper
 * edge at -z on top and at +z below, as a leaf turns. */
static void an_image_covers_an_end_exactly(void **state)
{
    (void)state;
    static const solid_shape shapes[] = {
        {.kind = SHAPE_CYLINDER, .m = 1, .radius = 2, .height = 3},
        {.kind = SHAPE_CONE, .radius = 2, .top_radius = 2, .height = 3},
        {.kind = SHAPE_LENS, .radius_1 = 8, .radius_2 = 0, .thickness = 2, .diameter = 4},
    };
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        const region_source source = {.shape = &shapes[i], .medium = 1, .shadow_transmittance = 1.0};
        scene_geometry *a = NULL;
        assert_int_equal(scene_geometry_build(&source, 1, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
        const primitive *p = &a->primitives[0];
        for (int face = 1; face <= 2; face++)
            for (int corner = 0; corner < 4; corner++) {
                const double x = corner & 1 ? 2 : -2, z = corner & 2 ? 2 : -2;
                const surface_mapping m = primitive_mapping(p, p->first_face + face, vec3_make(x, 0.0, z), 0.0);
                assert_true(fabs(m.u - (x + 2) / 4) < SLACK && fabs(m.v - (face == 1 ? 2 - z : z + 2) / 4) < SLACK);
                assert_true(fabs(m.per_length - 0.25) < SLACK);
            }
        scene_geometry_destroy(a);
    }
}

/* The farthest point of a mesh's box along any direction, also across its axes. */
static void a_mesh_reaches_as_far_as_its_box(void **state)
{
    (void)state;
    mesh *m = NULL;
    assert_int_equal(generate_box(vec3_make(2, 4, 6), &m, NULL), STATUS_OK);
    const solid_shape shape = {.kind = SHAPE_MESH, .mesh = m, .scale = {1, 1, 1}, .copies = {1, 1, 1}};
    static const double directions[][4] = {
        {1, 0, 0, 1}, {0, -1, 0, 2}, {0, 0, 1, 3}, {0.6, 0, 0.8, 3}, {-0.6, 0.8, 0, 2.2}};
    for (size_t i = 0; i < sizeof directions / sizeof *directions; i++) {
        const double *d = directions[i];
        assert_true(fabs(shape_reach(&shape, vec3_make(d[0], d[1], d[2])) - d[3]) < SLACK);
    }
    mesh_release(m);
}

static void copies_are_whole_numbers(void **state)
{
    (void)state;
    mesh *m = NULL;
    assert_int_equal(generate_box(vec3_make(2, 4, 6), &m, NULL), STATUS_OK);
    solid_shape shape = {.kind = SHAPE_MESH, .mesh = m, .scale = {1, 1, 1}, .copies = {2, 3, 4}};
    double *const counts[] = {&shape.copies.x, &shape.copies.y, &shape.copies.z};
    static const double wrong[] = {0.0, -1.0, 1.5, (double)NAN, 4194305.0};
    assert_int_equal(solid_shape_check(&shape, NULL), STATUS_OK);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        for (int axis = 0; axis < 3; axis++) {
            const double kept = *counts[axis];
            *counts[axis] = wrong[i];
            assert_int_equal(solid_shape_check(&shape, NULL), STATUS_BAD_INPUT);
            *counts[axis] = kept;
        }
    mesh_release(m);
}

/* The ends of a prism are covered as the squares around their corners, each side as a whole. */
static void an_image_covers_the_faces_of_a_prism(void **state)
{
    (void)state;
    const solid_shape shape = {.kind = SHAPE_PRISM, .sides = 6, .radius = 2, .height = 3};
    const region_source source = {.shape = &shape, .medium = 1, .shadow_transmittance = 1.0};
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(&source, 1, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    const primitive *p = &a->primitives[0];
    for (int face = 0; face < 2; face++)
        for (int corner = 0; corner < 4; corner++) {
            const double x = corner & 1 ? 2 : -2, z = corner & 2 ? 2 : -2;
            const surface_mapping m = primitive_mapping(p, p->first_face + face, vec3_make(x, 0.0, z), 0.0);
            assert_true(fabs(m.u - (x + 2) / 4) < SLACK && fabs(m.v - (face == 0 ? 2 - z : z + 2) / 4) < SLACK);
        }
    for (int side = 2; side < 8; side++) /* from its bottom to its top */
        for (int k = 0; k < 3; k++)
            assert_true(fabs(primitive_mapping(p, p->first_face + side, vec3_make(0, k * 1.5, 0), 0.0).v - 0.5 * k) <
                        SLACK);
    scene_geometry_destroy(a);
}

/* The image on the inner side of a cup begins at the floor, is as high as the hollow is wide, and runs around as on the
 * outer side of a cylinder, mirrored. */
static void an_image_lines_the_hollow_of_a_cup(void **state)
{
    (void)state;
    const solid_shape shape = {.kind = SHAPE_CUP, .m = 1, .radius = 2, .inner_radius = 1.5, .height = 6, .floor = 0.5};
    const region_source source = {.shape = &shape, .medium = 1, .shadow_transmittance = 1.0};
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(&source, 1, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    const primitive *hollow = &a->primitives[1];
    for (int k = 0; k < 4; k++) {
        const vec3 q = vec3_make(0.9, 0.5 + k, 1.2), opposite = vec3_make(-0.9, 0.5 + k, 1.2);
        const surface_mapping m = primitive_mapping(hollow, hollow->first_face, q, 0.0);
        assert_true(fabs(m.v - k / 3.0) < SLACK);
        const surface_mapping outer = primitive_mapping(&a->primitives[0], a->primitives[0].first_face, opposite, 0.0);
        assert_true(fabs(m.u - outer.u) < SLACK);
    }
    scene_geometry_destroy(a);
}

/* The planes of a prism's faces: ends, then sides, whose normals are level and which are all equally far away. */
static void a_prism_has_the_planes_of_its_faces(void **state)
{
    (void)state;
    const solid_shape shape = {.kind = SHAPE_PRISM, .sides = 5, .radius = 2, .height = 3};
    vec3 normal, point, sum = {0, 0, 0};
    for (size_t i = 0; i < 7; i++) {
        assert_true(shape_of(&shape)->flat(&shape, i, &normal, &point));
        const double at = vec3_dot(normal, point), expected = i == 0 ? 0.0 : i == 1 ? 3.0 : 2.0 * cos(M_PI / 5.0);
        assert_true(fabs(at - expected) < SLACK && fabs(fabs(normal.y) - (i < 2 ? 1.0 : 0.0)) < SLACK);
        sum = vec3_add(sum, normal);
    }
    assert_true(fabs(sum.x) < SLACK && fabs(sum.z) < SLACK); /* the sides are around it evenly */
    assert_false(shape_of(&shape)->flat(&shape, 7, &normal, &point));
}

static void faces_have_their_names(void **state)
{
    (void)state;
    const solid_shape cup = {.kind = SHAPE_CUP}, prism = {.kind = SHAPE_PRISM}, model = {.kind = SHAPE_MESH};
    assert_string_equal(shape_face_name(shape_of(&cup), 0), "outer side");
    assert_string_equal(shape_face_name(shape_of(&cup), 2), "rim");
    assert_string_equal(shape_face_name(shape_of(&cup), HOLLOW_FACES), "inner side");
    assert_string_equal(shape_face_name(shape_of(&cup), HOLLOW_FACES + 1), "floor");
    assert_string_equal(shape_face_name(shape_of(&prism), 1), "top");
    assert_string_equal(shape_face_name(shape_of(&prism), 2), shape_face_name(shape_of(&prism), HOLLOW_FACES + 3));
    assert_string_equal(shape_face_name(shape_of(&model), 5), "surface");
}

/* Each face of a box has the whole image: its corners are corners of the image. */
static void an_image_covers_each_face_of_a_box(void **state)
{
    (void)state;
    const solid_shape shape = {.kind = SHAPE_BOX, .size = {2, 4, 6}};
    const region_source source = {.shape = &shape, .medium = 1, .shadow_transmittance = 1.0};
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(&source, 1, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    const primitive *p = &a->primitives[0];
    for (int face = 0; face < 6; face++)
        for (int corner = 0; corner < 8; corner++) {
            const vec3 q = {corner & 1 ? 1 : -1, corner & 2 ? 2 : -2, corner & 4 ? 3 : -3};
            const surface_mapping m = primitive_mapping(p, p->first_face + face, q, 0.0);
            if ((corner >> (face / 2) & 1) != (face & 1)) /* not of this face */
                continue;
            assert_true(fmin(fabs(m.u), fabs(m.u - 1.0)) < SLACK && fmin(fabs(m.v), fabs(m.v - 1.0)) < SLACK);
        }
    scene_geometry_destroy(a);
}

/* Around a truncated cone in lengths of its wider end, along it in lengths of its slant. */
static void an_image_has_the_lengths_of_a_cones_side(void **state)
{
    (void)state;
    const solid_shape shape = {.kind = SHAPE_CONE, .radius = 2, .top_radius = 1, .height = 3};
    const region_source source = {.shape = &shape, .medium = 1, .shadow_transmittance = 1.0};
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(&source, 1, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    const primitive *p = &a->primitives[0];
    const double size = 5.0;
    const surface_mapping low = primitive_mapping(p, p->first_face, vec3_make(2, 0, 0), size),
                          high = primitive_mapping(p, p->first_face, vec3_make(1, 3, 0), size),
                          left = primitive_mapping(p, p->first_face, vec3_make(0, 0, -2), size),
                          right = primitive_mapping(p, p->first_face, vec3_make(0, 0, 2), size);
    assert_true(fabs(fabs(high.v - low.v) * size - sqrt(10.0)) < SLACK);
    assert_true(fabs(fmin(fabs(left.u - low.u), fabs(right.u - low.u)) * size - M_PI) < 1e-9); /* not over the seam */
    for (int corner = 0; corner < 4; corner++) {
        const vec3 q = {corner & 1 ? 1 : -1, 3, corner & 2 ? 1 : -1};
        const surface_mapping m = primitive_mapping(p, p->first_face + 2, q, 0.0);
        assert_true(fmin(fabs(m.u), fabs(m.u - 1.0)) < SLACK && fmin(fabs(m.v), fabs(m.v - 1.0)) < SLACK);
    }
    scene_geometry_destroy(a);
}

/* All rings of an elliptic cup are as elliptic, and a ring is as thick as its tube. */
static void rings_and_thickness_of_cups_and_tori(void **state)
{
    (void)state;
    const solid_shape cup = {.kind = SHAPE_CUP, .m = 2, .radius = 2, .inner_radius = 1.5, .height = 3, .floor = 0.2};
    const solid_shape torus = {.kind = SHAPE_TORUS, .radius = 4, .tube_radius = 1};
    shape_ring rings[RINGS_MAX];
    const int count = shape_of(&cup)->rings(&cup, rings);
    assert_true(count > 2);
    for (int i = 0; i < count; i++)
        assert_true(fabs(rings[i].z - rings[i].x / 2.0) < SLACK);
    assert_true(fabs(shape_of(&torus)->thickness(&torus) - 2.0) < SLACK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_parameter_has_a_row),
        cmocka_unit_test(shapes_fit_the_size_that_is_asked_for),
        cmocka_unit_test(contained_points_are_within_the_bounds),
        cmocka_unit_test(primitives_contain_the_points_of_the_solid),
        cmocka_unit_test(a_covered_point_is_contained),
        cmocka_unit_test(drawings_are_within_the_bounding_box),
        cmocka_unit_test(triangles_are_on_the_surface),
        cmocka_unit_test(flat_faces_bound_the_solid),
        cmocka_unit_test(points_of_the_surface_belong_to_a_solid),
        cmocka_unit_test(an_image_covers_an_end_exactly),
        cmocka_unit_test(an_image_covers_the_faces_of_a_prism),
        cmocka_unit_test(an_image_lines_the_hollow_of_a_cup),
        cmocka_unit_test(a_prism_has_the_planes_of_its_faces),
        cmocka_unit_test(faces_have_their_names),
        cmocka_unit_test(an_image_covers_each_face_of_a_box),
        cmocka_unit_test(an_image_has_the_lengths_of_a_cones_side),
        cmocka_unit_test(rings_and_thickness_of_cups_and_tori),
        cmocka_unit_test(a_mesh_reaches_as_far_as_its_box),
        cmocka_unit_test(copies_are_whole_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
