/* Tests of the built hierarchies: completeness, enclosing boxes, depth, cost, the thread team, and the ends of their
 * ranges. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "base/isa.h"
#include "base/lanes.h"
#include "base/worker_pool.h"
#include "geometry/hierarchy/layout.h"
#include "hierarchy_fixture.h"
#include "hierarchy_scenes.h"
#include "random_stream.h"

/* The results of a walk over a tree. */
typedef struct walk {
    const fixture *f;
    uint8_t *leaf_count; /* the number of leaves that contain each triangle */
    size_t nodes, leaves, blocks;
    int depth;
    double node_area, leaf_area, block_area; /* sums of areas */
} walk;

typedef struct box {
    double low[3], high[3];
} box;

static double corner_of(const mesh *m, uint32_t triangle, int corner, int axis)
{
    const vec3 *v = &m->vertices[m->triangles[triangle].corner[corner]];
    return axis == 0 ? v->x : axis == 1 ? v->y : v->z;
}

static void widen(box *b, int axis, double v)
{
    b->low[axis] = v < b->low[axis] ? v : b->low[axis];
    b->high[axis] = v > b->high[axis] ? v : b->high[axis];
}

static box nothing(void)
{
    return (box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

static double half_area(const box *b)
{
    double x = b->high[0] - b->low[0], y = b->high[1] - b->low[1], z = b->high[2] - b->low[2];
    return x * y + y * z + z * x;
}

/* The bounds of a block's triangles, whose coordinates must be bit-identical to the mesh's. */
static void walk_block(walk *w, size_t block, bool last, uint32_t *before, box *b)
{
    const mesh *m = &w->f->m;
    const hierarchy *h = &w->f->h;
    const block_single *s = (const block_single *)h->blocks + block;
    const block_double *d = (const block_double *)h->blocks + block;
    uint32_t previous = *before;
    for (int lane = 0; lane < BLOCK; lane++) {
        uint32_t triangle = h->single ? s->triangle[lane] : d->triangle[lane];
        assert_true(triangle < m->triangle_count);
        assert_true(previous == TRIANGLE_NONE || triangle > previous || (last && triangle == previous));
        if (triangle != previous)
            w->leaf_count[triangle]++;
        previous = triangle;
        for (int corner = 0; corner < 3; corner++)
            for (int axis = 0; axis < 3; axis++) {
                double v = corner_of(m, triangle, corner, axis);
                assert_true((h->single ? (double)s->corner[corner][axis][lane] : d->corner[corner][axis][lane]) == v);
                widen(b, axis, v);
            }
    }
    *before = previous;
}

static box walk_leaf(walk *w, uint32_t child, double area)
{
    box b = nothing();
    uint32_t first = child_first_block(child), count = child_blocks(child), before = TRIANGLE_NONE;
    assert_true(first == w->blocks); /* in the order of the leaves */
    assert_true(first + count <= w->f->h.block_count);
    for (uint32_t i = 0; i < count; i++)
        walk_block(w, first + i, i + 1 == count, &before, &b);
    w->blocks += count;
    w->leaves++;
    w->leaf_area += area;
    w->block_area += area * count;
    return b;
}

static box walk_node(walk *w, uint32_t number, int depth, double area)
{
    const bvh_node *n = &w->f->h.nodes[number];
    assert_true(number == w->nodes); /* depth first */
    assert_true(depth <= BVH_DEPTH_MAX);
    assert_true(n->child_count <= WIDTH);
    w->nodes++;
    w->node_area += area;
    w->depth = depth > w->depth ? depth : w->depth;
    box all = nothing();
    for (uint32_t i = 0; i < WIDTH; i++) {
        box own = {{n->low[0][i], n->low[1][i], n->low[2][i]}, {n->high[0][i], n->high[1][i], n->high[2][i]}};
        if (i >= n->child_count) {
            for (int axis = 0; axis < 3; axis++)
                assert_true(own.low[axis] == INFINITY && own.high[axis] == -INFINITY);
            continue;
        }
        double child_area = half_area(&own);
        box b = n->child[i] & CHILD_LEAF ? walk_leaf(w, n->child[i], child_area)
                                         : walk_node(w, n->child[i], depth + 1, child_area);
        for (int axis = 0; axis < 3; axis++) {
            /* encloses, and the next float inwards does not */
            assert_true(own.low[axis] <= b.low[axis] && nextafterf(n->low[axis][i], INFINITY) > b.low[axis]);
            assert_true(own.high[axis] >= b.high[axis] && nextafterf(n->high[axis][i], -INFINITY) < b.high[axis]);
            widen(&all, axis, b.low[axis]);
            widen(&all, axis, b.high[axis]);
        }
    }
    return all;
}

/* Walks the whole tree; each triangle must be in one leaf, except for `left_out` of them. */
static walk walk_tree(const fixture *f, size_t left_out)
{
    walk w = {.f = f, .leaf_count = calloc(f->m.triangle_count + 1, 1)};
    assert_non_null(w.leaf_count);
    walk_node(&w, 0, 1, 0.0);
    size_t leaf_count = 0;
    for (size_t i = 0; i < f->m.triangle_count; i++) {
        assert_true(w.leaf_count[i] <= 1);
        leaf_count += w.leaf_count[i];
    }
    assert_int_equal(leaf_count, f->m.triangle_count - left_out);
    assert_int_equal(w.nodes, f->h.node_count);
    assert_int_equal(w.blocks, f->h.block_count);
    assert_int_equal(w.nodes, f->h.report.nodes);
    assert_int_equal(w.leaves, f->h.report.leaves);
    assert_int_equal(w.depth, f->h.report.depth);
    size_t block = f->h.single ? sizeof(block_single) : sizeof(block_double);
    assert_true(f->h.report.bytes >= w.nodes * sizeof(bvh_node) + w.blocks * block);
    free(w.leaf_count);
    return w;
}

/* Triangles of about that size in a cube of that half edge. */
static fixture soup(size_t count, double reach, double size, bool single, uint64_t seed)
{
    fixture f = fixture_make(count, single);
    for (size_t i = 0; i < count; i++) {
        vec3 center = random_point(&seed, reach);
        for (size_t k = 0; k < 3; k++) {
            vec3 v = vec3_add(center, random_point(&seed, size));
            f.m.vertices[3 * i + k] = single ? vec3_make(single_round(v.x), single_round(v.y), single_round(v.z)) : v;
        }
    }
    return f;
}

static void every_triangle_is_in_one_leaf_and_boxes_enclose_their_content(void **state)
{
    (void)state;
    static const size_t counts[] = {1, 2, 3, 4, 5, 8, 9, 33, 257, 1000, 20000};
    for (size_t k = 0; k < sizeof counts / sizeof counts[0]; k++)
        for (int variant = 0; variant < 4; variant++) {
            fixture f = soup(counts[k], 1.0, variant & 1 ? 0.5 : 0.02, variant & 2, 7 + k);
            fixture_build(&f, 2);
            walk_tree(&f, 0);
            fixture_free(&f);
        }
}

static void a_mesh_without_triangles_has_a_root_without_children(void **state)
{
    (void)state;
    fixture f = fixture_make(0, true);
    fixture_build(&f, 3);
    assert_int_equal(f.h.node_count, 1);
    assert_int_equal(f.h.nodes[0].child_count, 0);
    walk_tree(&f, 0);
    fixture_free(&f);
}

static void the_tree_is_the_same_for_any_number_of_threads(void **state)
{
    (void)state;
    static const int threads[] = {2, 5, 64};
    for (int variant = 0; variant < 3; variant++) {
        fixture one = soup(variant == 2 ? 1000 : 100000, 1.0, variant ? 0.3 : 0.01, variant == 1, 3);
        fixture_build(&one, 1);
        assert_int_equal(one.h.report.threads, 1);
        size_t block = one.h.single ? sizeof(block_single) : sizeof(block_double);
        for (size_t k = 0; k < 3; k++) {
            fixture other = {.m = one.m};
            fixture_build(&other, threads[k]);
            assert_int_equal(other.h.report.threads > 1, variant < 2); /* a thousand triangles are one task */
            assert_int_equal(other.h.node_count, one.h.node_count);
            assert_int_equal(other.h.block_count, one.h.block_count);
            assert_memory_equal(other.h.nodes, one.h.nodes, one.h.node_count * sizeof(bvh_node));
            assert_memory_equal(other.h.blocks, one.h.blocks, one.h.block_count * block);
            fixture_free_hierarchy(&other);
        }
        fixture_free(&one);
    }
}

static void coincident_triangles_are_split_at_the_median(void **state)
{
    (void)state;
    fixture f = fixture_make(100000, true);
    for (size_t i = 0; i < 100000; i++)
        fixture_set(&f, i, vec3_make(0.25, 0.5, 1.0), vec3_make(1.0, 0.5, 2.0), vec3_make(0.0, -1.0, 3.0));
    fixture_build(&f, 2);
    walk w = walk_tree(&f, 0);
    assert_true(w.depth <= 6);           /* 8^5 leaves of four would be enough */
    assert_true(w.blocks <= 100000 / 2); /* and blocks are at least half full */
    fixture_free(&f);
}

static void many_coincident_triangles_keep_the_tree_shallow(void **state)
{
    (void)state;
    uint64_t seed = 5;
    fixture f = soup(20000, 1.0, 0.1, false, 11);
    for (size_t i = 0; i < 20000; i++) {
        size_t from = 3 * (size_t)random_below(&seed, 4);
        if (i % 3)
            fixture_set(&f, i, f.m.vertices[from], f.m.vertices[from + 1], f.m.vertices[from + 2]);
    }
    fixture_build(&f, 2);
    assert_true(walk_tree(&f, 0).depth <= 16);
    fixture_free(&f);
}

/* Triangles at 2^-k, each scale smaller than a bin of the previous one: a split separates a few at a time. */
static void ever_smaller_triangles_keep_the_depth_bounded(void **state)
{
    (void)state;
    fixture f = fixture_make(60000, false);
    for (size_t i = 0; i < 60000; i++) {
        double s = ldexp(1.0 + (double)i / 60000.0, 25 - (int)(i % 1000));
        fixture_set(&f, i, vec3_make(s, 0.0, s), vec3_make(s, s, 0.0), vec3_make(2.0 * s, s, s));
    }
    fixture_build(&f, 2);
    walk_tree(&f, 0);
    fixture_free(&f);
}

static void huge_and_tiny_meshes_are_enclosed(void **state)
{
    (void)state;
    static const double reaches[] = {5e8, 1e-3, 1e-12, 1e-30, 1e-42, 1e-300};
    for (size_t k = 0; k < sizeof reaches / sizeof reaches[0]; k++) {
        fixture f = soup(3000, reaches[k], reaches[k] * 0.1, false, 23);
        fixture_build(&f, 1);
        assert_true(walk_tree(&f, 0).depth <= 16);
        fixture_free(&f);
    }
}

static void flat_and_straight_meshes_are_split(void **state)
{
    (void)state;
    for (int flat = 1; flat <= 2; flat++) {
        uint64_t seed = 9;
        fixture f = soup(5000, 1.0, 0.01, false, 31);
        for (size_t i = 0; i < f.m.vertex_count; i++) {
            f.m.vertices[i].y = 3.0;
            if (flat == 2)
                f.m.vertices[i].z = -1.0;
            f.m.vertices[i].x += random_real(&seed, 0.0, 0.01);
        }
        fixture_build(&f, 1);
        assert_true(walk_tree(&f, 0).depth <= 10);
        fixture_free(&f);
    }
}

static void triangles_without_area_are_omitted_and_slivers_are_kept(void **state)
{
    (void)state;
    fixture f = soup(50000, 1.0, 0.1, false, 17);
    size_t left_out = 0;
    for (size_t i = 0; i < 50000; i++) {
        vec3 *v = &f.m.vertices[3 * i];
        if (i % 5 == 1)
            v[i % 3] = v[(i + 1) % 3];
        else if (i % 5 == 2)
            v[2] = vec3_scale(vec3_add(v[0], v[1]), 0.5);
        left_out += i % 5 == 1;
    }
    fixture_build(&f, 2);
    walk_tree(&f, left_out);
    fixture_free(&f);
    fixture nothing_left = fixture_make(3, true);
    fixture_build(&nothing_left, 1);
    walk_tree(&nothing_left, 3);
    fixture_free(&nothing_left);
}

/* A plane of 64 x 64 squares of two triangles each. The squares can be distributed among leaves without overlap: a line
 * that hits the plane then visits one leaf and one node per level; nodes of eight over leaves of two squares need four
 * levels. */
static void leaves_of_a_plane_do_not_overlap(void **state)
{
    (void)state;
    fixture f = fixture_make(2 * 64 * 64, true);
    for (size_t i = 0; i < 64 * 64; i++) {
        double x = (double)(i % 64), y = (double)(i / 64);
        vec3 a = vec3_make(x, y, 0.0), b = vec3_make(x + 1.0, y, 0.0), c = vec3_make(x + 1.0, y + 1.0, 0.0),
             d = vec3_make(x, y + 1.0, 0.0);
        fixture_set(&f, 2 * i, a, b, c);
        fixture_set(&f, 2 * i + 1, a, c, d);
    }
    fixture_build(&f, 1);
    walk w = walk_tree(&f, 0);
    const double plane = 64.0 * 64.0;
    assert_true(w.leaf_area == plane);
    assert_true(w.block_area <= 1.5 * plane);
    assert_true(w.node_area <= 4.0 * plane);
    assert_true(w.blocks <= 2 * 64 * 64 / 2);
    fixture_free(&f);
}

/* A thousand small triangles far apart: leaves hold neighbours, so that few leaves are visited. A random line through
 * the cube hits boxes in proportion to their area; 4 triangles in a cell of 1/250 of the cube have at least
 * (1/250)^(2/3) of its area, in all 6.3 leaves. */
static void leaves_hold_neighbouring_triangles(void **state)
{
    (void)state;
    fixture f = soup(1000, 1.0, 0.001, false, 41);
    fixture_build(&f, 1);
    walk w = walk_tree(&f, 0);
    assert_true(w.leaf_area <= 12.0 * 6.3);
    fixture_free(&f);
}

typedef struct tally {
    atomic_int calls[1000];
    atomic_int bad_members;
    int size;
} tally;

static void count_call(void *context, size_t index, int member)
{
    tally *t = context;
    atomic_fetch_add(&t->calls[index], 1);
    if (member < 0 || member >= t->size)
        atomic_fetch_add(&t->bad_members, 1);
}

static void a_thread_team_runs_each_task_once(void **state)
{
    (void)state;
    for (int threads = 1; threads <= 5; threads += 2) {
        thread_team *t = thread_team_create(threads);
        assert_non_null(t);
        static const size_t counts[] = {1000, 0, 1, 999};
        for (size_t k = 0; k < 4; k++) {
            tally own = {.size = thread_team_size(t)};
            thread_team_run(t, count_call, &own, counts[k]);
            for (size_t i = 0; i < 1000; i++)
                assert_int_equal(own.calls[i], i < counts[k]);
            assert_int_equal(own.bad_members, 0);
        }
        thread_team_destroy(t);
    }
}

/* Hierarchies at the ends of their ranges: batches of any length, tiny and distant triangles, the bounds of
 * all boxes, the form of sphere trees, and kinds that there are not. */

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
        cmocka_unit_test(every_triangle_is_in_one_leaf_and_boxes_enclose_their_content),
        cmocka_unit_test(a_mesh_without_triangles_has_a_root_without_children),
        cmocka_unit_test(the_tree_is_the_same_for_any_number_of_threads),
        cmocka_unit_test(coincident_triangles_are_split_at_the_median),
        cmocka_unit_test(many_coincident_triangles_keep_the_tree_shallow),
        cmocka_unit_test(ever_smaller_triangles_keep_the_depth_bounded),
        cmocka_unit_test(huge_and_tiny_meshes_are_enclosed),
        cmocka_unit_test(flat_and_straight_meshes_are_split),
        cmocka_unit_test(triangles_without_area_are_omitted_and_slivers_are_kept),
        cmocka_unit_test(leaves_of_a_plane_do_not_overlap),
        cmocka_unit_test(leaves_hold_neighbouring_triangles),
        cmocka_unit_test(a_thread_team_runs_each_task_once),
        cmocka_unit_test(batches_have_any_length),
        cmocka_unit_test(tiny_triangles_far_from_the_origin_are_hit),
        cmocka_unit_test(the_reach_is_that_of_the_farther_side),
        cmocka_unit_test(only_octants_divide_a_sphere),
        cmocka_unit_test(leaves_are_the_nodes_with_triangles),
        cmocka_unit_test(an_unknown_kind_has_no_hierarchy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
