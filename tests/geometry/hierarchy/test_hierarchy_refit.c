/* Tests of the refit: its hits, its cost, and the choice between refit and rebuild after the mesh moved. */
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <cmocka.h>

#include "geometry/hierarchy/bvh.h"
#include "geometry/mesh/mesh_private.h"
#include "refit_fixture.h"

/* A refitted hierarchy gives hits bit-identical to those of a rebuilt one and of no hierarchy. */

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

/* A hierarchy's cost, and the choice between refit and rebuild after its mesh moved. */

/* Four triangles that span the unit cube at x. */
static void cluster(vec3 *corners, double x)
{
    for (int i = 0; i < 4; i++) {
        corners[3 * i] = vec3_make(x, 0.0, 0.0);
        corners[3 * i + 1] = vec3_make(x + 1.0, 1.0, 0.0);
        corners[3 * i + 2] = vec3_make(x, 0.25 * (i + 1), 1.0);
    }
}

static void cost_is_the_ratio_of_surface_areas(void **state)
{
    (void)state;
    vec3 corners[24];
    cluster(corners, 0.0);
    cluster(corners + 12, 99.0);
    mesh *m = mesh_of_corners(corners, 4), *two = mesh_of_corners(corners, 8), *empty = mesh_of_corners(corners, 0);
    hierarchy *h = built(m, HIERARCHY_BVH), *h2 = built(two, HIERARCHY_BVH), *none = built(m, HIERARCHY_NONE),
              *nothing = built(empty, HIERARCHY_BVH);
    assert_true(hierarchy_cost(h) == 2.0); /* the root, and one block in an equal box */
    /* Boxes of 1 x 1 x 1 with half surface area 3, two of them in one of 100 x 1 x 1 with half surface area 201. */
    assert_true(fabs(hierarchy_cost(h2) - (1.0 + 2.0 * 3.0 / 201.0)) < 1e-15);
    assert_true(hierarchy_cost(none) == 0.0 && hierarchy_cost(nothing) == 0.0);
    assert_true(hierarchy_refit(nothing));
    cluster(corners + 12, 9.0); /* the same boxes in one of 10 x 1 x 1 */
    move(two, corners);
    assert_true(hierarchy_refit(h2));
    assert_true(fabs(hierarchy_cost(h2) - (1.0 + 2.0 * 3.0 / 21.0)) < 1e-15);
    for (int i = 0; i < 24; i++)
        corners[i] = vec3_make(1.0, 2.0, 3.0);
    move(two, corners); /* collapsed into one point, which no ray hits */
    assert_true(hierarchy_refit(h2));
    assert_true(hierarchy_cost(h2) == 0.0);
    hierarchy *const all[] = {h, h2, none, nothing};
    for (size_t i = 0; i < COUNT(all); i++)
        hierarchy_destroy(all[i]);
    mesh_release(m);
    mesh_release(two);
    mesh_release(empty);
}

/* Permutes vertices across the whole mesh. */
static void shuffle(mesh *m, uint64_t *seed)
{
    vec3 *to = copy_of_vertices(m);
    for (int i = (int)m->vertex_count - 1; i > 0; i--) {
        const int other = random_below(seed, i + 1);
        const vec3 kept = to[i];
        to[i] = to[other];
        to[other] = kept;
    }
    move(m, to);
    free(to);
}

static void cost_grows_when_the_vertices_are_shuffled(void **state)
{
    (void)state;
    uint64_t seed = 4;
    mesh *m = icosphere(3);
    hierarchy *h = built(m, HIERARCHY_BVH);
    const double before = hierarchy_cost(h);
    assert_true(before > 2.0 && before < 40.0);
    shuffle(m, &seed);
    assert_true(hierarchy_refit(h));
    assert_true(hierarchy_cost(h) > 5.0 * before);
    hierarchy_destroy(h);
    mesh_release(m);
}

static const hierarchy *kept(const mesh *m, hierarchy_kind kind)
{
    const hierarchy *h = NULL;
    assert_int_equal(hierarchy_of_mesh(m, kind, 1, &h, NULL), STATUS_OK);
    return h;
}

static hierarchy_update_counts follow(const mesh *m, double ratio)
{
    hierarchy_update_counts moves;
    assert_int_equal(hierarchy_update(m, ratio, 2, &moves, NULL), STATUS_OK);
    assert_true(moves.refit_s >= 0.0 && moves.build_s >= 0.0);
    return moves;
}

static void same_by_all_kinds(const mesh *m, uint64_t *seed)
{
    assert_true(compare(m, kept(m, HIERARCHY_BVH), effort(8), seed) > 10);
    for (int i = 0; i < effort(1000); i++) {
        const mesh_ray r = random_ray(m, seed);
        mesh_hit expected, hit;
        kernels[ISA_BASE]->nearest(kept(m, HIERARCHY_BVH), &r, &expected);
        kernels[ISA_BASE]->nearest(kept(m, HIERARCHY_NONE), &r, &hit);
        same_hit(&hit, &expected);
        kernels[ISA_BASE]->nearest(kept(m, HIERARCHY_OCTANT), &r, &hit);
        same_hit(&hit, &expected);
    }
}

static void moved_meshes_refit_or_rebuild_their_hierarchies_by_cost(void **state)
{
    (void)state;
    uint64_t seed = 5;
    mesh *m = icosphere(3);
    vec3 *rest = copy_of_vertices(m);
    hierarchy_update_counts moves = follow(m, 1.0); /* has no hierarchies */
    assert_true(moves.refitted == 0 && moves.rebuilt == 0 && moves.growth == 0.0);
    const hierarchy *bvh = kept(m, HIERARCHY_BVH);
    const double cost = hierarchy_cost(bvh);
    moves = follow(m, 1.0); /* the mesh did not move: same cost */
    assert_true(moves.refitted == 1 && moves.rebuilt == 0 && moves.growth == 1.0);
    assert_ptr_equal(kept(m, HIERARCHY_BVH), bvh);

    shuffle(m, &seed);
    moves = follow(m, 1e9);
    assert_true(moves.refitted == 1 && moves.rebuilt == 0 && moves.growth > 5.0);
    assert_ptr_equal(kept(m, HIERARCHY_BVH), bvh);
    assert_true(moves.growth == hierarchy_cost(bvh) / cost);
    assert_true(compare(m, bvh, effort(8), &seed) > 10);

    (void)kept(m, HIERARCHY_NONE);
    (void)kept(m, HIERARCHY_OCTANT);
    deform(m, rest, scatter, &seed);
    moves = follow(m, 1.0);
    assert_true(moves.refitted == 0 && moves.rebuilt == 3 && moves.growth > 1.0);
    hierarchy *fresh = built(m, HIERARCHY_BVH);
    const double rebuilt = hierarchy_cost(fresh);
    assert_true(hierarchy_cost(kept(m, HIERARCHY_BVH)) == rebuilt);
    hierarchy_destroy(fresh);
    same_by_all_kinds(m, &seed);

    deform(m, rest, twist, &seed);
    moves = follow(m, 1e9);
    assert_true(moves.refitted == 1 && moves.rebuilt == 2);
    assert_true(moves.growth ==
                hierarchy_cost(kept(m, HIERARCHY_BVH)) / rebuilt); /* relative to the last build, not to the first */
    free(rest);
    mesh_release(m);
}

static void hierarchies_that_cannot_be_refitted_are_rebuilt(void **state)
{
    (void)state;
    uint64_t seed = 6;
    mesh *m = icosphere(2);
    vec3 *rest = copy_of_vertices(m);
    deform(m, rest, on_floats, &seed);
    (void)kept(m, HIERARCHY_BVH);
    move(m, rest); /* doubles */
    hierarchy_update_counts moves = follow(m, 1e9);
    assert_true(moves.refitted == 0 && moves.rebuilt == 1 && moves.growth == 0.0);
    assert_true(compare(m, kept(m, HIERARCHY_BVH), effort(8), &seed) > 10);
    deform(m, rest, squash, &seed);
    moves = follow(m, 1e9);
    assert_true(moves.refitted == 1 && moves.rebuilt == 0);
    free(rest);
    mesh_release(m);
}

static atomic_bool followed;

static void *follow_aside(void *m)
{
    assert_int_equal(hierarchy_update(m, 1.0, 1, NULL, NULL), STATUS_OK);
    atomic_store(&followed, true);
    return NULL;
}

/* A thread that builds a hierarchy of the mesh holds the lock. */
static void hierarchies_follow_only_while_no_other_thread_builds_them(void **state)
{
    (void)state;
    mesh *m = icosphere(1);
    pthread_t other;
    assert_int_equal(pthread_mutex_lock(&m->shared->mutex), 0);
    assert_int_equal(pthread_create(&other, NULL, follow_aside, m), 0);
    nanosleep(&(struct timespec){.tv_nsec = 50000000}, NULL);
    assert_false(atomic_load(&followed));
    assert_int_equal(pthread_mutex_unlock(&m->shared->mutex), 0);
    assert_int_equal(pthread_join(other, NULL), 0);
    assert_true(atomic_load(&followed));
    mesh_release(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_refitted_hierarchy_has_the_hits_of_a_rebuilt_one),
        cmocka_unit_test(refitted_boxes_are_rounded_as_in_the_build),
        cmocka_unit_test(refits_that_need_a_rebuild_are_refused),
        cmocka_unit_test(cost_is_the_ratio_of_surface_areas),
        cmocka_unit_test(cost_grows_when_the_vertices_are_shuffled),
        cmocka_unit_test(moved_meshes_refit_or_rebuild_their_hierarchies_by_cost),
        cmocka_unit_test(hierarchies_that_cannot_be_refitted_are_rebuilt),
        cmocka_unit_test(hierarchies_follow_only_while_no_other_thread_builds_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
