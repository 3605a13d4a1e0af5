/* Hierarchies of meshes that move: a refitted one gives to the bit the hits of one built anew and of no hierarchy at all. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "base/isa.h"
#include "base/single.h"
#include "geometry/hierarchy_bvh.h"
#include "hierarchy_scenes.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
enum { BATCH = 128, SHOWN_MAX = 4096 };

static const hierarchy_kernels *const kernels[ISA_COUNT] = {&hierarchy_kernels_sse2, &hierarchy_kernels_avx2, &hierarchy_kernels_avx512};
static void (*const refit_nodes[ISA_COUNT])(hierarchy *) = {hierarchy_refit_nodes_sse2, hierarchy_refit_nodes_avx2, hierarchy_refit_nodes_avx512};

static int effort(int full)
{
#ifdef __OPTIMIZE__
    return full;
#else
    return full / 20 + 1;
#endif
}

static hierarchy *built(const mesh *m, hierarchy_kind kind)
{
    hierarchy *h = NULL;
    assert_int_equal(hierarchy_build(m, kind, 1, &h, NULL), STATUS_OK);
    return h;
}

static mesh *icosphere(int level)
{
    mesh *m = NULL;
    assert_int_equal(body_icosphere(level, &m, NULL), STATUS_OK);
    return m;
}

static vec3 *copy_of_vertices(const mesh *m)
{
    vec3 *copy = malloc(m->vertex_count * sizeof *copy);
    assert_non_null(copy);
    memcpy(copy, m->vertices, m->vertex_count * sizeof *copy);
    return copy;
}

static void move(mesh *m, const vec3 *to)
{
    assert_int_equal(mesh_move(m, to, NULL, NULL), STATUS_OK);
}

/* Ways to deform a body; each is a function of the place alone, or of a place's number where that says nothing. */
typedef vec3 deformation(vec3 p, size_t vertex, uint64_t *seed);

static vec3 squash(vec3 p, size_t vertex, uint64_t *seed)
{
    (void)vertex, (void)seed;
    return vec3_make(1.3 * p.x, 0.05 * p.y, 1.3 * p.z);
}

static vec3 twist(vec3 p, size_t vertex, uint64_t *seed)
{
    (void)vertex, (void)seed;
    const double angle = 4.0 * p.y;
    return vec3_make(cos(angle) * p.x - sin(angle) * p.z, p.y, sin(angle) * p.x + cos(angle) * p.z);
}

static vec3 scatter(vec3 p, size_t vertex, uint64_t *seed)
{
    (void)vertex;
    return vec3_add(p, random_point(seed, 5.0));
}

/* Most triangles lose their area: whole parts fall into one place, others onto a line or into a plane. */
static vec3 collapse(vec3 p, size_t vertex, uint64_t *seed)
{
    (void)vertex, (void)seed;
    return p.x > 0.3 ? vec3_make(0.3, 0.1, -0.2) : p.x > -0.2 ? vec3_make(p.x, 0.0, 0.0) : p.y > 0.0 ? vec3_make(p.x, 0.0, p.z) : p;
}

static vec3 far_away(vec3 p, size_t vertex, uint64_t *seed)
{
    (void)vertex, (void)seed;
    return vec3_make(1e6 + 1e3 * p.x, 1e6 * p.y, -1e6 + p.z);
}

static vec3 tiny(vec3 p, size_t vertex, uint64_t *seed)
{
    (void)vertex, (void)seed;
    return vec3_scale(p, 1e-39); /* a float cannot hold all of its bits */
}

static vec3 on_floats(vec3 p, size_t vertex, uint64_t *seed)
{
    const vec3 q = twist(p, vertex, seed);
    return vec3_make(single_round(q.x), single_round(q.y), single_round(q.z));
}

static deformation *const deformations[] = {squash, twist, scatter, collapse, far_away, tiny, on_floats};

static void deform(mesh *m, const vec3 *rest, deformation *way, uint64_t *seed)
{
    vec3 *to = malloc(m->vertex_count * sizeof *to);
    assert_non_null(to);
    for (size_t i = 0; i < m->vertex_count; i++)
        to[i] = way(rest[i], i, seed);
    move(m, to);
    free(to);
}

static void same_hit(const mesh_hit *a, const mesh_hit *b)
{
    assert_int_equal(a->triangle, b->triangle);
    assert_memory_equal(&a->t, &b->t, sizeof a->t);
    assert_memory_equal(&a->u, &b->u, sizeof a->u);
    assert_memory_equal(&a->v, &b->v, sizeof a->v);
    assert_int_equal(a->facing, b->facing);
}

/* All hits of a ray, or all triangles shown to it, in a form that does not depend on their order. */
typedef struct gathered { uint64_t sum; long count; uint32_t triangle[SHOWN_MAX]; } gathered;

static void gather(void *context, const mesh_hit *hit)
{
    gathered *g = context;
    uint64_t bits;
    memcpy(&bits, &hit->t, sizeof bits);
    g->sum += (bits ^ (uint64_t)hit->triangle << 32) * 0x9e3779b97f4a7c15u;
    assert_true(g->count < SHOWN_MAX);
    g->triangle[g->count++] = hit->triangle;
}

static double gather_box(void *context, uint32_t triangle, double t_max)
{
    gathered *g = context;
    assert_true(g->count < SHOWN_MAX);
    g->triangle[g->count++] = triangle;
    return t_max;
}

/* Every triangle that is hit is shown, and none twice. */
static void shows_what_is_hit(const hierarchy_kernels *kernel, const hierarchy *h, const mesh_ray *r, const gathered *hits)
{
    static gathered shown;
    uint8_t *times = calloc(h->of->triangle_count, 1);
    assert_non_null(times);
    shown.count = 0;
    kernel->boxes(h, r, gather_box, &shown);
    for (long i = 0; i < shown.count; i++)
        assert_int_equal(times[shown.triangle[i]]++, 0);
    for (long i = 0; i < hits->count; i++)
        assert_int_equal(times[hits->triangle[i]], 1);
    free(times);
}

/* Sends random rays through all three; returns how many hit. */
static long compare(const mesh *m, const hierarchy *refitted, int batches, uint64_t *seed)
{
    static gathered all[2];
    hierarchy *const none = built(m, HIERARCHY_NONE), *const fresh = built(m, HIERARCHY_BVH);
    long met = 0;
    for (int batch = 0; batch < batches; batch++) {
        const hierarchy_kernels *kernel = kernels[(unsigned)batch % (unsigned)(isa_best() + 1)];
        mesh_ray r[BATCH];
        mesh_hit expected[BATCH], hits[BATCH], one;
        bool shadowed[BATCH];
        for (int i = 0; i < BATCH; i++)
            r[i] = random_ray(m, seed);
        kernels[ISA_SSE2]->nearest_batch(none, r, BATCH, expected);
        kernel->nearest_batch(refitted, r, BATCH, hits);
        kernel->any_batch(refitted, r, BATCH, shadowed);
        for (int i = 0; i < BATCH; i++) {
            const bool hit = expected[i].triangle != TRIANGLE_NONE;
            same_hit(&hits[i], &expected[i]);
            assert_int_equal(shadowed[i], hit);
            kernel->nearest(refitted, &r[i], &one);
            same_hit(&one, &expected[i]);
            kernel->nearest(fresh, &r[i], &one);
            same_hit(&one, &expected[i]);
            assert_int_equal(kernel->any(refitted, &r[i]), hit);
            met += hit;
        }
        for (int i = 0; i < 8; i++) {
            memset(all, 0, sizeof all);
            kernel->all(none, &r[i], gather, &all[0]);
            kernel->all(refitted, &r[i], gather, &all[1]);
            assert_int_equal(all[1].count, all[0].count);
            assert_true(all[1].sum == all[0].sum);
            shows_what_is_hit(kernel, refitted, &r[i], &all[0]);
        }
    }
    hierarchy_destroy(fresh);
    hierarchy_destroy(none);
    return met;
}

static void a_refitted_hierarchy_gives_the_hits_of_a_new_one(void **state)
{
    (void)state;
    uint64_t seed = 1;
    mesh *bodies[] = {icosphere(3), NULL, NULL};
    assert_int_equal(body_torus(1.0, 0.4, 40, 17, &bodies[1], NULL), STATUS_OK);
    assert_int_equal(body_sparse(1001, &bodies[2], NULL), STATUS_OK); /* of floats */
    for (size_t k = 0; k < COUNT(bodies); k++) {
        mesh *m = bodies[k];
        vec3 *rest = copy_of_vertices(m);
        hierarchy *h = built(m, HIERARCHY_BVH);
        for (size_t way = 0; way < COUNT(deformations); way++) {
            deform(m, rest, deformations[way], &seed); /* from one to the next, as bodies move */
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
                assert_true(a[i].low[axis][slot] == b[i].low[axis][slot] && a[i].high[axis][slot] == b[i].high[axis][slot]);
    }
}

/* Boxes and blocks of a mesh that came back are those of the build to the bit, on every instruction set; in between they were others. */
static void there_and_back(mesh *m, deformation *way, uint64_t *seed)
{
    vec3 *rest = copy_of_vertices(m);
    hierarchy *h = built(m, HIERARCHY_BVH);
    const size_t node_bytes = h->node_count * sizeof *h->nodes, block_bytes = h->block_count * (h->single ? sizeof(block_single) : sizeof(block_double));
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

static void boxes_are_rounded_as_at_the_build(void **state)
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

static void what_cannot_be_refitted_is_refused(void **state)
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
    hierarchy *h = built(m, HIERARCHY_BVH); /* leaves some out, which come back */
    move(m, rest);
    assert_false(hierarchy_refit(h));
    hierarchy_destroy(h);
    deform(m, rest, on_floats, &seed);
    h = built(m, HIERARCHY_BVH);
    assert_true(hierarchy_refit(h));
    move(m, rest); /* no floats */
    assert_false(hierarchy_refit(h));
    deform(m, rest, on_floats, &seed);
    assert_true(hierarchy_refit(h));
    hierarchy_destroy(h);
    free(rest);
    mesh_release(m);
}

/* --- cost --- */

/* Four triangles that reach through the unit cube at x. */
static void cluster(vec3 *corners, double x)
{
    for (int i = 0; i < 4; i++) {
        corners[3 * i] = vec3_make(x, 0.0, 0.0);
        corners[3 * i + 1] = vec3_make(x + 1.0, 1.0, 0.0);
        corners[3 * i + 2] = vec3_make(x, 0.25 * (i + 1), 1.0);
    }
}

static void cost_is_that_of_the_areas(void **state)
{
    (void)state;
    vec3 corners[24];
    cluster(corners, 0.0);
    cluster(corners + 12, 99.0);
    mesh *m = mesh_of_corners(corners, 4), *two = mesh_of_corners(corners, 8), *empty = mesh_of_corners(corners, 0);
    hierarchy *h = built(m, HIERARCHY_BVH), *h2 = built(two, HIERARCHY_BVH), *none = built(m, HIERARCHY_NONE), *nothing = built(empty, HIERARCHY_BVH);
    assert_true(hierarchy_cost(h) == 2.0); /* the root, and one block in a box as large */
    /* Boxes 1 x 1 x 1, half of their surface 3, twice in one of 100 x 1 x 1, half of its surface 201. */
    assert_true(fabs(hierarchy_cost(h2) - (1.0 + 2.0 * 3.0 / 201.0)) < 1e-15);
    assert_true(hierarchy_cost(none) == 0.0 && hierarchy_cost(nothing) == 0.0);
    assert_true(hierarchy_refit(nothing));
    cluster(corners + 12, 9.0); /* the same boxes in one of 10 x 1 x 1 */
    move(two, corners);
    assert_true(hierarchy_refit(h2));
    assert_true(fabs(hierarchy_cost(h2) - (1.0 + 2.0 * 3.0 / 21.0)) < 1e-15);
    for (int i = 0; i < 24; i++)
        corners[i] = vec3_make(1.0, 2.0, 3.0);
    move(two, corners); /* into one place, which no ray meets */
    assert_true(hierarchy_refit(h2));
    assert_true(hierarchy_cost(h2) == 0.0);
    hierarchy *const all[] = {h, h2, none, nothing};
    for (size_t i = 0; i < COUNT(all); i++)
        hierarchy_destroy(all[i]);
    mesh_release(m);
    mesh_release(two);
    mesh_release(empty);
}

/* Vertices change places across the whole body. */
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

static void cost_grows_when_the_body_is_shuffled(void **state)
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

/* --- following --- */

static const hierarchy *kept(const mesh *m, hierarchy_kind kind)
{
    const hierarchy *h = NULL;
    assert_int_equal(hierarchy_of_mesh(m, kind, 1, &h, NULL), STATUS_OK);
    return h;
}

static hierarchy_moves follow(const mesh *m, double ratio)
{
    hierarchy_moves moves;
    assert_int_equal(hierarchy_follow(m, ratio, 2, &moves, NULL), STATUS_OK);
    assert_true(moves.refit_s >= 0.0 && moves.build_s >= 0.0);
    return moves;
}

static void same_by_all_kinds(const mesh *m, uint64_t *seed)
{
    assert_true(compare(m, kept(m, HIERARCHY_BVH), effort(8), seed) > 10);
    for (int i = 0; i < effort(1000); i++) {
        const mesh_ray r = random_ray(m, seed);
        mesh_hit expected, hit;
        kernels[ISA_SSE2]->nearest(kept(m, HIERARCHY_BVH), &r, &expected);
        kernels[ISA_SSE2]->nearest(kept(m, HIERARCHY_NONE), &r, &hit);
        same_hit(&hit, &expected);
        kernels[ISA_SSE2]->nearest(kept(m, HIERARCHY_OCTANT), &r, &hit);
        same_hit(&hit, &expected);
    }
}

static void a_mesh_keeps_what_followed_it(void **state)
{
    (void)state;
    uint64_t seed = 5;
    mesh *m = icosphere(3);
    vec3 *rest = copy_of_vertices(m);
    hierarchy_moves moves = follow(m, 1.0); /* keeps none */
    assert_true(moves.refitted == 0 && moves.rebuilt == 0 && moves.growth == 0.0);
    const hierarchy *bvh = kept(m, HIERARCHY_BVH);
    const double cost = hierarchy_cost(bvh);
    moves = follow(m, 1.0); /* has not moved: costs what it did */
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
    assert_true(moves.growth == hierarchy_cost(kept(m, HIERARCHY_BVH)) / rebuilt); /* over that of the last build, not of the first */
    free(rest);
    mesh_release(m);
}

static void what_cannot_be_refitted_is_built_anew(void **state)
{
    (void)state;
    uint64_t seed = 6;
    mesh *m = icosphere(2);
    vec3 *rest = copy_of_vertices(m);
    deform(m, rest, on_floats, &seed);
    (void)kept(m, HIERARCHY_BVH);
    move(m, rest); /* doubles */
    hierarchy_moves moves = follow(m, 1e9);
    assert_true(moves.refitted == 0 && moves.rebuilt == 1 && moves.growth == 0.0);
    assert_true(compare(m, kept(m, HIERARCHY_BVH), effort(8), &seed) > 10);
    deform(m, rest, squash, &seed);
    moves = follow(m, 1e9);
    assert_true(moves.refitted == 1 && moves.rebuilt == 0);
    free(rest);
    mesh_release(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_refitted_hierarchy_gives_the_hits_of_a_new_one),
        cmocka_unit_test(boxes_are_rounded_as_at_the_build),
        cmocka_unit_test(what_cannot_be_refitted_is_refused),
        cmocka_unit_test(cost_is_that_of_the_areas),
        cmocka_unit_test(cost_grows_when_the_body_is_shuffled),
        cmocka_unit_test(a_mesh_keeps_what_followed_it),
        cmocka_unit_test(what_cannot_be_refitted_is_built_anew),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
