/* Tests of hierarchies at the ends of their ranges: batches of any length, tiny and distant triangles, the bounds of
 * all boxes, the form of sphere trees, and kinds that there are not. */
#include <setjmp.h>
#include <stdarg.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "base/isa.h"
#include "geometry/hierarchy/layout.h"
#include "hierarchy_scenes.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

static const hierarchy_kernels *const kernels[ISA_COUNT] = ISA_ARRAY(hierarchy_kernels);
static const hierarchy_kind own_kinds[] = {HIERARCHY_NONE, HIERARCHY_SPHERE, HIERARCHY_OCTANT, HIERARCHY_BVH};

static hierarchy *built(mesh *m, hierarchy_kind kind)
{
    hierarchy *h = NULL;
    assert_non_null(m);
    assert_int_equal(hierarchy_build(m, kind, 1, &h, NULL), STATUS_OK);
    return h;
}

/* Answers go to the batch's own rays, each that of the ray alone, and nothing beyond them is written. */
static void batches_have_any_length(void **state)
{
    (void)state;
    enum { MOST = 300, UNTOUCHED = 12345 };
    uint64_t seed = 11;
    mesh *m = random_mesh(&seed, 200);
    mesh_ray rays[MOST];
    mesh_hit hits[MOST], alone;
    bool blocked[MOST];
    for (int i = 0; i < MOST; i++)
        rays[i] = random_ray(m, &seed);
    for (size_t k = 0; k < COUNT(own_kinds); k++) {
        hierarchy *h = built(m, own_kinds[k]);
        for (int level = 0; level <= (int)isa_best(); level++)
            for (int count = 1; count < MOST; count += count < 126 ? 25 : 1 + count / 130 * 29) {
                for (int i = 0; i < MOST; i++)
                    hits[i].triangle = UNTOUCHED, blocked[i] = i >= count;
                kernels[level]->nearest_batch(h, rays, count, hits);
                kernels[level]->any_batch(h, rays, count, blocked);
                for (int i = 0; i < count; i++) {
                    kernels[level]->nearest(h, &rays[i], &alone);
                    assert_int_equal(hits[i].triangle, alone.triangle);
                    assert_int_equal(blocked[i], alone.triangle != TRIANGLE_NONE);
                }
                for (int i = count; i < MOST; i++)
                    assert_true(hits[i].triangle == UNTOUCHED && blocked[i]);
            }
        hierarchy_destroy(h);
    }
    mesh_release(m);
}

/* Triangles of 2^-40 and of 2^-30 at a distance of 1000 from the origin, where bounds have rounding errors as large:
 * rays at their middles and at their corners, which belong to them, hit them by every hierarchy. */
static void tiny_triangles_far_from_the_origin_are_hit(void **state)
{
    (void)state;
    const double far = 1024.0;
    for (int k = 0; k < 2 * (int)COUNT(own_kinds); k++) {
        const double e = k % 2 ? 0x1p-40 : 0x1p-30;
        const vec3 at[4] = {{far - e, far - e, far}, {far + e, far - e, far}, {far, far + e, far}, {far, far, far}};
        mesh *m = mesh_of_corners(at, 1);
        hierarchy *h = built(m, own_kinds[k / 2]);
        for (int i = 0; i < 8 * ((int)isa_best() + 1); i++) {
            const hierarchy_kernels *kernel = kernels[i / 8];
            const double side = i % 2 ? 1.0 : -1.0;
            const vec3 to = at[i / 2 % 4];
            const mesh_ray ray = {
                {to.x, to.y, far - 2.0 * side}, {0.0, 0.0, side}, 0.0, (double)INFINITY, TRIANGLE_NONE, FACING_ANY};
            mesh_hit hit;
            kernel->nearest(h, &ray, &hit);
            assert_true(hit.triangle == 0 && hit.t == 2.0);
            assert_true(kernel->any(h, &ray));
        }
        hierarchy_destroy(h);
        mesh_release(m);
    }
}

/* By axis the largest magnitude of a coordinate, on whichever side of the origin it is. */
static void the_reach_is_that_of_the_farther_side(void **state)
{
    (void)state;
    const vec3 corners[3] = {{-8, 1, 1}, {2, 4, -1}, {-3, 2, -6}};
    mesh *m = mesh_of_corners(corners, 1);
    hierarchy *h = built(m, HIERARCHY_BVH);
    const float expected[3] = {8, 4, 6};
    for (int axis = 0; axis < 3; axis++)
        assert_true(h->reach[axis] >= expected[axis] && h->reach[axis] < expected[axis] * 1.0001f);
    hierarchy_destroy(h);
    mesh_release(m);
}

/* The bounding sphere is one; octants divide it, and leave at their parent the triangles of at least a quarter of its
 * radius. */
static void only_octants_divide_a_sphere(void **state)
{
    (void)state;
    uint64_t seed = 12;
    mesh *m = random_mesh(&seed, 500);
    hierarchy *h = built(m, HIERARCHY_SPHERE);
    assert_int_equal(h->node_count, 1);
    assert_int_equal(h->spheres[0].children, 0);
    assert_int_equal(h->report.depth, 1);
    hierarchy_destroy(h);
    h = built(m, HIERARCHY_OCTANT);
    assert_true(h->node_count > 1 && h->spheres[0].children > 0);
    hierarchy_destroy(h);
    mesh_release(m);
}

/* Three small triangles at either end of a diagonal: octants part them at once, and the root keeps none. */
static void leaves_are_the_nodes_with_triangles(void **state)
{
    (void)state;
    vec3 at[18];
    for (int i = 0; i < 6; i++) {
        const double x = (i < 3 ? -8.0 : 8.0) + 0.25 * (i % 3), y = i < 3 ? -8.0 : 8.0;
        at[3 * i] = vec3_make(x, y, y);
        at[3 * i + 1] = vec3_make(x + 0.125, y, y);
        at[3 * i + 2] = vec3_make(x, y + 0.125, y);
    }
    mesh *m = mesh_of_corners(at, 6);
    for (int parts = 0; parts < 2; parts++) {
        hierarchy *h = built(m, parts ? HIERARCHY_OCTANT : HIERARCHY_SPHERE);
        const hierarchy_report r = hierarchy_describe(h);
        assert_int_equal(r.nodes, parts ? 3 : 1);
        assert_int_equal(r.leaves, parts ? 2 : 1);
        assert_int_equal(r.depth, parts ? 2 : 1);
        hierarchy_destroy(h);
    }
    mesh_release(m);
}

static void an_unknown_kind_has_no_hierarchy(void **state)
{
    (void)state;
    const vec3 corners[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh *m = mesh_of_corners(corners, 1);
    const hierarchy *h = NULL;
    assert_int_equal(hierarchy_of_mesh(m, HIERARCHY_BVH, 1, &h, NULL), STATUS_OK);
    assert_non_null(h);
    assert_int_equal(hierarchy_of_mesh(m, HIERARCHY_KIND_COUNT, 1, &h, NULL), STATUS_BAD_INPUT);
    assert_null(h);
    mesh_release(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(batches_have_any_length),
        cmocka_unit_test(tiny_triangles_far_from_the_origin_are_hit),
        cmocka_unit_test(the_reach_is_that_of_the_farther_side),
        cmocka_unit_test(only_octants_divide_a_sphere),
        cmocka_unit_test(leaves_are_the_nodes_with_triangles),
        cmocka_unit_test(an_unknown_kind_has_no_hierarchy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
