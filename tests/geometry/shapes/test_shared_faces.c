/* Tests of faces that two solids may have in common: "no" is certain, up to rounding; "yes" may be wrong. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "geometry/mesh/mesh_generators.h"
#include "geometry/shapes/shape.h"
#include "geometry/solid.h"

static bool share(solid_shape a, solid_shape b)
{
    const bool found = solid_shapes_may_coincide(&a, &b);
    assert_int_equal(solid_shapes_may_coincide(&b, &a), found);
    return found;
}

static solid_shape box_at(double x, double y, double z)
{
    return (solid_shape){.kind = SHAPE_BOX, .position = {x, y, z}, .size = {1, 1, 1}, .scale = {1, 1, 1}};
}

static void boxes_share_faces_where_their_planes_are_equal(void **state)
{
    (void)state;
    const solid_shape one = box_at(0, 0, 0);
    assert_true(share(one, one));
    assert_true(share(one, box_at(0.3, 1, 0.2))); /* one stands on the other: planes at y = 0.5 */
    assert_false(share(one, box_at(7, 0.5, 0.5)));
    assert_true(share(one, box_at(7, 0, 0.5)));           /* the planes are equal, however far apart the faces are */
    assert_true(share(one, box_at(0.3, 1 + 1e-12, 0.2))); /* rounding */
    assert_false(share(one, box_at(0.3, 1 + 1e-7, 0.2)));
    assert_true(share(box_at(0, 1e6, 0), box_at(0.3, 1e6 + 1 + 1e-5, 0.2))); /* rounding, far away */
    assert_false(share(box_at(0, 1e6, 0), box_at(0.3, 1e6 + 1.01, 0.2)));
}

static void a_turned_face_is_another(void **state)
{
    (void)state;
    const solid_shape one = box_at(0, 0, 0);
    solid_shape turned = box_at(0.3, 1, 0.2);
    turned.rotation_deg = (vec3){0, 33, 0}; /* about the normal of the common plane */
    assert_true(share(one, turned));
    turned.rotation_deg = (vec3){180, 0, 0}; /* the normals are opposite */
    assert_true(share(one, turned));
    turned.position.x = 0.35;
    turned.rotation_deg = (vec3){0.01, 33, 0.01};
    assert_false(share(one, turned));
}

static void round_solids_may_share_their_sides_and_their_ends(void **state)
{
    (void)state;
    const solid_shape rod = {.kind = SHAPE_CYLINDER, .radius = 0.2, .height = 2, .m = 1, .scale = {1, 1, 1}},
                      ball = {.kind = SHAPE_SPHERE, .position = {5, 5, 5}, .radius = 0.2, .scale = {1, 1, 1}};
    assert_true(share(rod, ball)); /* both are curved: not compared */
    assert_true(share(rod, box_at(0, 2.5, 0)));
    assert_true(share(rod, box_at(3, -0.5, 0)));
    assert_false(share(rod, box_at(0, 0.7, 0)));
    assert_false(share(ball, box_at(0, 0, 0)));
}

static void meshes_are_compared_by_their_triangles(void **state)
{
    (void)state;
    mesh *m = NULL;
    assert_int_equal(generate_box((vec3){1, 1, 1}, &m, NULL), STATUS_OK);
    solid_shape of_mesh = {.kind = SHAPE_MESH, .mesh = m, .scale = {1, 1, 1}, .copies = {1, 1, 1}};
    const solid_shape above = box_at(0.3, 1, 0.2), lower = box_at(0.3, 0.7, 0.2);
    assert_true(share(of_mesh, above));
    assert_false(share(of_mesh, lower));
    of_mesh.scale.y = 1.4; /* then its top is at the other's bottom */
    assert_false(share(of_mesh, above));
    of_mesh.position.y = 0.5;
    assert_true(share(of_mesh, lower)); /* 0.5 + 0.7 = 0.7 + 0.5 */
    of_mesh.copies.z = 2.0;             /* several copies, and a mesh that is not loaded: unknown */
    assert_true(share(of_mesh, box_at(9, 9, 9)));
    of_mesh.copies.z = 1.0;
    assert_false(share(of_mesh, box_at(9, 9, 9)));
    of_mesh.mesh = NULL;
    assert_true(share(of_mesh, box_at(9, 9, 9)));
    mesh_release(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_share_faces_where_their_planes_are_equal),
        cmocka_unit_test(a_turned_face_is_another),
        cmocka_unit_test(round_solids_may_share_their_sides_and_their_ends),
        cmocka_unit_test(meshes_are_compared_by_their_triangles),
    };
    return cmocka_run_group_tests_name("shared_faces", tests, NULL, NULL);
}
