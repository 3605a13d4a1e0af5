/* Tests of packed hierarchies, and of packed meshes, whose values are not those of a tree that the traversals can walk,
 * or of a mesh: each is refused. The hash of a package does not help here, since whoever writes the package makes
 * it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/hash.h"
#include "geometry/hierarchy/hierarchy.h"
#include "geometry/hierarchy/layout.h"
#include "geometry/mesh/mesh_generators.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct buffer {
    char *at;
    size_t size, read;
} buffer;

static status give(void *context, const void *bytes, size_t size, diagnostic *why)
{
    buffer *b = context;
    (void)why;
    b->at = realloc(b->at, b->size + size);
    assert_non_null(b->at);
    memcpy(b->at + b->size, bytes, size);
    b->size += size;
    return STATUS_OK;
}

static status take(void *context, void *bytes, size_t size, diagnostic *why)
{
    buffer *b = context;
    (void)why;
    assert_true(b->read + size <= b->size);
    memcpy(bytes, b->at + b->read, size);
    b->read += size;
    return STATUS_OK;
}

/* The status of unpacking what the hierarchy is packed as. The caller destroys *again. */
static status copied(const hierarchy *h, hierarchy **again)
{
    buffer b = {.at = NULL};
    pack_writer to = {.write = give, .context = &b, .hash = HASH_START};
    diagnostic why = {.what = ""};
    assert_int_equal(hierarchy_pack(h, &to, &why), STATUS_OK);
    pack_reader from = {.read = take, .context = &b, .left = b.size, .hash = HASH_START};
    hierarchy_kind kind;
    const status code = hierarchy_unpack(h->of, &from, again, &kind, &why);
    if (code != STATUS_OK)
        assert_non_null(strstr(why.what, "hierarchy"));
    free(b.at);
    return code;
}

static status passed_on(const hierarchy *h)
{
    hierarchy *again = NULL;
    const status code = copied(h, &again);
    hierarchy_destroy(again);
    return code;
}

/* The same of a mesh. */
static status mesh_passed_on(const mesh *m)
{
    buffer b = {.at = NULL};
    pack_writer to = {.write = give, .context = &b, .hash = HASH_START};
    diagnostic why = {.what = ""};
    assert_int_equal(mesh_pack(m, &to, &why), STATUS_OK);
    pack_reader from = {.read = take, .context = &b, .left = b.size, .hash = HASH_START};
    const mesh *again = NULL;
    const status code = mesh_unpack(&from, &again, &why);
    if (code == STATUS_OK)
        mesh_release(again);
    else
        assert_non_null(strstr(why.what, "mesh"));
    free(b.at);
    return code;
}

static hierarchy *tree_of(hierarchy_kind kind, const mesh **m)
{
    mesh *made = NULL;
    hierarchy *h = NULL;
    assert_int_equal(generate_icosphere(3, &made, NULL), STATUS_OK);
    assert_int_equal(hierarchy_build(made, kind, 1, &h, NULL), STATUS_OK);
    *m = made;
    assert_int_equal(passed_on(h), STATUS_OK);
    return h;
}

#define REFUSED_BY(attempt, place, value)            \
    do {                                             \
        const __typeof__(place) kept_ = (place);     \
        (place) = (value);                           \
        assert_int_equal(attempt, STATUS_BAD_INPUT); \
        (place) = kept_;                             \
        assert_int_equal(attempt, STATUS_OK);        \
    } while (0)
#define REFUSED(place, value) REFUSED_BY(passed_on(h), place, value)

static void boxes_that_are_none_are_refused(void **state)
{
    (void)state;
    const mesh *m;
    hierarchy *h = tree_of(HIERARCHY_BVH, &m);
    bvh_node *last = &h->nodes[h->node_count - 1], *part = last;
    while (part->child_count == WIDTH) /* a node with an unused child */
        part--;
    for (int axis = 0; axis < 3; axis++) {
        REFUSED(last->low[axis][0], nextafterf(last->high[axis][0], INFINITY));
        REFUSED(last->low[axis][0], NAN);
        REFUSED(last->low[axis][0], -INFINITY);
        REFUSED(last->high[axis][0], NAN);
        REFUSED(last->high[axis][0], INFINITY);
        REFUSED(part->low[axis][WIDTH - 1], 0.0F);
        REFUSED(part->high[axis][WIDTH - 1], 0.0F);
    }
    REFUSED(part->child[WIDTH - 1], 1u);
    hierarchy_destroy(h);
    mesh_release(m);
}

static void nodes_that_are_no_tree_are_refused(void **state)
{
    (void)state;
    const mesh *m;
    hierarchy *h = tree_of(HIERARCHY_BVH, &m);
    bvh_node *root = &h->nodes[0];
    assert_true(root->child_count > 1 && !(root->child[0] & CHILD_LEAF) && !(root->child[1] & CHILD_LEAF));
    REFUSED(root->child_count, WIDTH + 1u);
    REFUSED(root->child[0], 0u);                                      /* a loop */
    REFUSED(root->child[0], root->child[1]);                          /* two parents */
    REFUSED(root->child[0], (uint32_t)h->node_count);                 /* beyond the nodes */
    REFUSED(root->child[0], child_leaf((uint32_t)h->block_count, 1)); /* beyond the blocks; and its nodes are orphans */
    bvh_node *last = &h->nodes[h->node_count - 1];
    assert_true(last->child[0] & CHILD_LEAF);
    REFUSED(last->child[0], child_leaf((uint32_t)h->block_count - 1, 2));
    hierarchy_destroy(h);
    mesh_release(m);
}

static void spheres_that_are_none_are_refused(void **state)
{
    (void)state;
    const hierarchy_kind kinds[] = {HIERARCHY_SPHERE, HIERARCHY_OCTANT};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        const mesh *m;
        hierarchy *h = tree_of(kinds[i], &m);
        sphere_node *last = &h->spheres[h->node_count - 1], *root = h->spheres;
        while (last->blocks == 0)
            last--;
        REFUSED(last->radius, -1.0F);
        REFUSED(last->radius, INFINITY);
        REFUSED(last->radius, NAN);
        for (int axis = 0; axis < 3; axis++)
            REFUSED(last->center[axis], INFINITY);
        REFUSED(last->blocks, (uint32_t)h->block_count + 1);
        REFUSED(last->first_block, (uint32_t)h->block_count);
        REFUSED(root->children, 9u);
        if (kinds[i] == HIERARCHY_OCTANT) { /* the other has one node */
            REFUSED(root->first_child, 0u);
            REFUSED(root->first_child, (uint32_t)h->node_count);
        }
        hierarchy_destroy(h);
        mesh_release(m);
    }
}

static void heads_of_no_mesh_are_refused(void **state)
{
    (void)state;
    mesh *m = NULL;
    assert_int_equal(generate_icosphere(1, &m, NULL), STATUS_OK);
    REFUSED_BY(mesh_passed_on(m), m->slot_count, 0);
    REFUSED_BY(mesh_passed_on(m), m->hole.from, (uint32_t)m->vertex_count);
    REFUSED_BY(mesh_passed_on(m), m->hole.to, (uint32_t)m->vertex_count);
    REFUSED_BY(mesh_passed_on(m), m->hole.triangle, m->triangle_count);
    REFUSED_BY(mesh_passed_on(m), m->shell_count, m->triangle_count + 1);
    REFUSED_BY(mesh_passed_on(m), m->shell_count, SIZE_MAX); /* one more than that is 0 */
    mesh_release(m);
}

static const uint32_t *triangles_of(const hierarchy *h, size_t block)
{
    return h->single ? ((const block_single *)h->blocks)[block].triangle
                     : ((const block_double *)h->blocks)[block].triangle;
}

/* Of more blocks than travel together each keeps its triangles. */
static void many_blocks_keep_their_triangles(void **state)
{
    (void)state;
    mesh *m = NULL;
    hierarchy *h = NULL, *again = NULL;
    assert_int_equal(generate_icosphere(5, &m, NULL), STATUS_OK);
    assert_int_equal(hierarchy_build(m, HIERARCHY_SPHERE, 1, &h, NULL), STATUS_OK);
    assert_true(h->block_count > 4096);
    assert_int_equal(copied(h, &again), STATUS_OK);
    assert_int_equal(again->block_count, h->block_count);
    for (size_t i = 0; i < h->block_count; i++)
        assert_memory_equal(triangles_of(again, i), triangles_of(h, i), BLOCK * sizeof(uint32_t));
    hierarchy_destroy(again);
    hierarchy_destroy(h);
    mesh_release(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_that_are_none_are_refused),   cmocka_unit_test(nodes_that_are_no_tree_are_refused),
        cmocka_unit_test(spheres_that_are_none_are_refused), cmocka_unit_test(heads_of_no_mesh_are_refused),
        cmocka_unit_test(many_blocks_keep_their_triangles),
    };
    return cmocka_run_group_tests_name("hierarchy_pack", tests, NULL, NULL);
}
