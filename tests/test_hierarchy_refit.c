/* Tests of the refit: a refitted hierarchy gives hits bit-identical to those of a rebuilt one and of no hierarchy. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "geometry/hierarchy/bvh.h"
#include "refit_fixture.h"

static hierarchy_refitter *const refit_nodes[ISA_COUNT] = ISA_ARRAY(hierarchy_refit_nodes);
static deformation *const deformations[] = {squash, twist, scatter, collapse, far_away, tiny, on_floats};

static void a_refitted_hierarchy_has_the_hits_of_a_rebuilt_one(void **state)
{
    (void)state;
    uint64_t seed = 1;
    mesh *bodies[] = {icosphere(3), NULL, NULL};
    assert_int_equal(generate_torus(1.0, 0.4, 40, 17, &bodies[1], NULL), STATUS_OK);
    assert_int_equal(generate_sparse_soup(1001, &bodies[2], NULL), STATUS_OK); /* of floats */
    for (size_t k = 0; k < COUNT(bodies); k++) {
        mesh *m = bodies[k];
        vec3 *rest = copy_of_vertices(m);
        hierarchy *h = built(m, HIERARCHY_BVH);
        for (size_t way = 0; way < COUNT(deformations); way++) {
            deform(m, rest, deformations[way], &seed); /* from one deformation to the next, as in an animation */
            const bool fits = m->single || !h->single;
            assert_int_equal(hierarchy_refit(h), fits);
            if (fits)
                assert_true(compare(m, h, effort(24), &seed) > 10);
        }
        hierarchy_destroy(h);
        free(rest);
        mesh_release(m);
    }
}

static void same_boxes(const bvh_node *a, const bvh_node *b, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        assert_memory_equal(a[i].child, b[i].child, sizeof a[i].child);
        for (int axis = 0; axis < 3; axis++)
            for (int slot = 0; slot < WIDTH; slot++) /* 0 may have either sign */
                assert_true(a[i].low[axis][slot] == b[i].low[axis][slot] &&
                            a[i].high[axis][slot] == b[i].high[axis][slot]);
    }
}

/* After a mesh returns to its original shape, boxes and blocks are bit-identical to those of the build, on every
 * instruction set; in between they differ. */
static void there_and_back(mesh *m, deformation *way, uint64_t *seed)
{
    vec3 *rest = copy_of_vertices(m);
    hierarchy *h = built(m, HIERARCHY_BVH);
    const size_t node_bytes = h->node_count * sizeof *h->nodes,
                 block_bytes = h->block_count * (h->single ? sizeof(block_single) : sizeof(block_double));
    bvh_node *nodes = aligned_alloc(64, node_bytes);
    void *blocks = malloc(block_bytes);
    assert_non_null(nodes);
    assert_non_null(blocks);
    memcpy(nodes, h->nodes, node_bytes);
    memcpy(blocks, h->blocks, block_bytes);
    for (int level = 0; level <= (int)isa_best(); level++) {
        deform(m, rest, way, seed);
        refit_nodes[level](h);
        assert_memory_not_equal(h->blocks, blocks, block_bytes);
        assert_memory_not_equal(h->nodes, nodes, node_bytes);
        move(m, rest);
        refit_nodes[level](h);
        assert_memory_equal(h->blocks, blocks, block_bytes);
        same_boxes(h->nodes, nodes, h->node_count);
    }
    free(blocks);
    free(nodes);
    free(rest);
    hierarchy_destroy(h);
    mesh_release(m);
}

static void refitted_boxes_are_rounded_as_in_the_build(void **state)
{
    (void)state;
    uint64_t seed = 2;
    there_and_back(icosphere(4), scatter, &seed);
    there_and_back(icosphere(4), tiny, &seed);
    for (int scene = 0; scene < effort(200); scene++) /* of floats and of doubles, with triangles that are left out */
        there_and_back(random_mesh(&seed, 5 + random_below(&seed, 400)), on_floats, &seed);
    mesh *m = icosphere(3); /* built where floats are denormal */
    vec3 *rest = copy_of_vertices(m);
    deform(m, rest, tiny, &seed);
    free(rest);
    there_and_back(m, far_away, &seed);
}

static void refits_that_need_a_rebuild_are_refused(void **state)
{
    (void)state;
    uint64_t seed = 3;
    mesh *m = icosphere(1);
    vec3 *rest = copy_of_vertices(m);
    for (int kind = HIERARCHY_NONE; kind <= HIERARCHY_BVH; kind++) {
        hierarchy *h = built(m, (hierarchy_kind)kind);
        assert_int_equal(hierarchy_refit(h), kind == HIERARCHY_BVH);
        hierarchy_destroy(h);
    }
    deform(m, rest, collapse, &seed);
    hierarchy *h = built(m, HIERARCHY_BVH); /* the build omits some triangles, which get an area again */
    move(m, rest);
    assert_false(hierarchy_refit(h));
    hierarchy_destroy(h);
    deform(m, rest, on_floats, &seed);
    h = built(m, HIERARCHY_BVH);
    assert_true(hierarchy_refit(h));
    move(m, rest); /* the coordinates are not floats */
    assert_false(hierarchy_refit(h));
    deform(m, rest, on_floats, &seed);
    assert_true(hierarchy_refit(h));
    hierarchy_destroy(h);
    free(rest);
    mesh_release(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_refitted_hierarchy_has_the_hits_of_a_rebuilt_one),
        cmocka_unit_test(refitted_boxes_are_rounded_as_in_the_build),
        cmocka_unit_test(refits_that_need_a_rebuild_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
