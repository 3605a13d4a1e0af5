/* Tests of the hierarchies' queries: the same hits from every kind, batch and instruction set, and watertight
 * meshes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "base/isa.h"
#include "base/lanes.h"
#include "hierarchy_scenes.h"
#include "whole.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
enum { BATCH = 128 };

static const hierarchy_kernels *const kernels[ISA_COUNT] = ISA_ARRAY(hierarchy_kernels);
static const hierarchy_kind own_kinds[] = {HIERARCHY_NONE, HIERARCHY_SPHERE, HIERARCHY_OCTANT, HIERARCHY_BVH};

/* Less work in builds for analysis, such as sanitizers. */
static int effort(int full)
{
#ifdef __OPTIMIZE__
    return full;
#else
    return full / 20 + 1;
#endif
}

static void same_hit(const mesh_hit *a, const mesh_hit *b)
{
    assert_int_equal(a->triangle, b->triangle);
    assert_memory_equal(&a->t, &b->t, sizeof a->t);
    assert_memory_equal(&a->u, &b->u, sizeof a->u);
    assert_memory_equal(&a->v, &b->v, sizeof a->v);
    assert_int_equal(a->facing, b->facing);
}

/* All hits of a ray in an order-independent form. */
typedef struct gathered {
    uint64_t sum;
    long count;
    mesh_hit nearest;
} gathered;

static void gather(void *context, const mesh_hit *hit)
{
    gathered *g = context;
    uint64_t bits;
    memcpy(&bits, &hit->t, sizeof bits);
    g->sum += (bits ^ (uint64_t)hit->triangle << 32) * 0x9e3779b97f4a7c15u;
    g->count++;
    if (g->nearest.triangle == TRIANGLE_NONE || hit->t < g->nearest.t ||
        (hit->t == g->nearest.t && hit->triangle < g->nearest.triangle))
        g->nearest = *hit;
}

static void one_scene(uint64_t *seed, int rays)
{
    mesh *m = random_mesh(seed, 1 + random_below(seed, random_below(seed, 4) ? 60 : 500));
    assert_non_null(m);
    hierarchy *h[COUNT(own_kinds)];
    for (size_t k = 0; k < COUNT(own_kinds); k++)
        assert_int_equal(hierarchy_build(m, own_kinds[k], 1, &h[k], NULL), STATUS_OK);
    for (int first = 0; first < rays; first += BATCH) {
        mesh_ray r[BATCH];
        mesh_hit expected[BATCH], hits[BATCH];
        bool shadowed[BATCH];
        for (int i = 0; i < BATCH; i++)
            r[i] = random_ray(m, seed);
        kernels[isa_best()]->nearest_batch(h[0], r, BATCH, expected);
        const gathered nothing = {.nearest = {.triangle = TRIANGLE_NONE}};
        gathered all[2] = {nothing, nothing};
        kernels[isa_best()]->all(h[0], &r[0], gather, &all[0]);
        same_hit(&all[0].nearest, &expected[0]);
        for (size_t k = 1; k < COUNT(own_kinds); k++) {
            const hierarchy_kernels *kernel = kernels[(unsigned)(first / BATCH) % (unsigned)(isa_best() + 1)];
            for (int i = 0; i < BATCH; i++) {
                kernel->nearest(h[k], &r[i], &hits[i]);
                same_hit(&hits[i], &expected[i]);
                assert_int_equal(kernel->any(h[k], &r[i]), expected[i].triangle != TRIANGLE_NONE);
            }
            kernel->nearest_batch(h[k], r, BATCH, hits);
            kernel->any_batch(h[k], r, BATCH, shadowed);
            for (int i = 0; i < BATCH; i++) {
                same_hit(&hits[i], &expected[i]);
                assert_int_equal(shadowed[i], expected[i].triangle != TRIANGLE_NONE);
            }
            all[1] = nothing;
            kernel->all(h[k], &r[0], gather, &all[1]);
            assert_int_equal(all[1].count, all[0].count);
            assert_true(all[1].sum == all[0].sum);
        }
    }
    for (size_t k = 0; k < COUNT(own_kinds); k++)
        hierarchy_destroy(h[k]);
    mesh_release(m);
}

static void every_hierarchy_gives_the_same_hits(void **state)
{
    (void)state;
    uint64_t seed = 4;
    for (int scene = 0; scene < effort(trials_of(200)); scene++)
        one_scene(&seed, 5000);
}

/* Coherent rays, as from a camera, a lamp or the sun: parallel, or from one point, to corners, edges and anywhere.
 * Random rays are too different to share a traversal. */
static int coherent_rays(const mesh *m, uint64_t *seed, mesh_ray *r)
{
    const int count = 1 + random_below(seed, BATCH), how = random_below(seed, 3);
    const double reach = 1e-300 + vec3_length(vec3_sub(m->bounds.high, m->bounds.low));
    const vec3 middle = vec3_scale(vec3_add(m->bounds.low, m->bounds.high), 0.5);
    const vec3 along =
        random_below(seed, 4) ? random_direction(seed) : vec3_make(0.0, random_below(seed, 2) ? 1.0 : -1.0, 0.0);
    const vec3 eye = vec3_sub(middle, vec3_scale(along, random_real(seed, 0.1, 4.0) * reach));
    for (int i = 0; i < count; i++) {
        const vec3 target = random_target(m, seed);
        r[i] = random_ray(m, seed); /* for its limits, side and skipped triangle */
        r[i].origin = how ? eye : vec3_sub(target, vec3_scale(along, reach));
        r[i].direction = how ? vec3_sub(target, eye) : along;
        if (how == 1 || !(vec3_dot(r[i].direction, r[i].direction) > 0.0))
            r[i].direction = vec3_add(along, vec3_scale(random_direction(seed), 0.1));
    }
    return count;
}

/* One such bundle, or several in a batch, so that the rays of a packet are any part of a batch. */
static int coherent_bundles(const mesh *m, uint64_t *seed, mesh_ray *r)
{
    mesh_ray other[BATCH];
    const int count = coherent_rays(m, seed, r);
    for (int more = random_below(seed, 3); more > 0; more--) {
        const int first = random_below(seed, count), step = 1 + random_below(seed, 2),
                  others = coherent_rays(m, seed, other);
        for (int i = 0; i < others && first + i * step < count; i++)
            r[first + i * step] = other[i];
    }
    return count;
}

static void batches_of_coherent_rays_have_the_hits_of_single_rays(void **state)
{
    (void)state;
    uint64_t seed = 7;
    long hit_count = 0;
    for (int scene = 0; scene < effort(200); scene++) {
        mesh *m = random_mesh(&seed, 1 + random_below(&seed, random_below(&seed, 4) ? 60 : 500));
        hierarchy *h = NULL;
        assert_non_null(m);
        assert_int_equal(hierarchy_build(m, HIERARCHY_BVH, 1, &h, NULL), STATUS_OK);
        for (int k = 0; k < 40; k++) {
            mesh_ray r[BATCH];
            mesh_hit expected, hits[BATCH];
            bool shadowed[BATCH];
            const int count = coherent_bundles(m, &seed, r);
            const hierarchy_kernels *kernel = kernels[(unsigned)k % (unsigned)(isa_best() + 1)];
            kernel->nearest_batch(h, r, count, hits);
            kernel->any_batch(h, r, count, shadowed);
            for (int i = 0; i < count; i++) {
                kernels[ISA_BASE]->nearest(h, &r[i], &expected);
                same_hit(&hits[i], &expected);
                assert_int_equal(shadowed[i], expected.triangle != TRIANGLE_NONE);
                hit_count += shadowed[i];
            }
        }
        hierarchy_destroy(h);
        mesh_release(m);
    }
    assert_true(hit_count > 1000);
}

/* Rays from a far eye, as in the frame of a mesh that is small and distant, or scaled to a thin sheet: there the eye is
 * far away along one axis, and its rays are nearly parallel to that axis. */
static int far_rays(const mesh *m, uint64_t *seed, mesh_ray *r)
{
    const int count = 1 + random_below(seed, BATCH);
    const double reach = 1e-300 + vec3_length(vec3_sub(m->bounds.high, m->bounds.low));
    const double distance = reach * pow(10.0, random_real(seed, 0.0, 14.0));
    const vec3 middle = vec3_scale(vec3_add(m->bounds.low, m->bounds.high), 0.5);
    const double side = random_below(seed, 2) ? 1.0 : -1.0;
    const vec3 axes[] = {{side, 0.0, 0.0}, {0.0, side, 0.0}, {0.0, 0.0, side}};
    const vec3 away = random_below(seed, 4) ? axes[random_below(seed, 3)] : random_direction(seed),
               eye = vec3_add(middle, vec3_add(vec3_scale(away, distance), vec3_scale(random_direction(seed), reach)));
    for (int i = 0; i < count; i++) {
        r[i] = random_ray(m, seed); /* for its side and skipped triangle */
        r[i].t_min = 0.0;
        r[i].t_max = (double)INFINITY;
        r[i].origin = eye;
        r[i].direction = vec3_sub(random_target(m, seed), eye);
    }
    return count;
}

static void rays_from_afar_have_the_hits_of_all_triangles(void **state)
{
    (void)state;
    uint64_t seed = 11;
    long hit_count = 0;
    for (int scene = 0; scene < effort(400); scene++) {
        mesh *m = random_mesh(&seed, 1 + random_below(&seed, 100));
        hierarchy *all = NULL, *h = NULL;
        assert_non_null(m);
        assert_int_equal(hierarchy_build(m, HIERARCHY_NONE, 1, &all, NULL), STATUS_OK);
        assert_int_equal(hierarchy_build(m, HIERARCHY_BVH, 1, &h, NULL), STATUS_OK);
        for (int k = 0; k < 20; k++) {
            mesh_ray r[BATCH];
            mesh_hit expected, hit, hits[BATCH];
            const int count = far_rays(m, &seed, r);
            const hierarchy_kernels *kernel = kernels[(unsigned)k % (unsigned)(isa_best() + 1)];
            kernel->nearest_batch(h, r, count, hits);
            for (int i = 0; i < count; i++) {
                kernel->nearest(all, &r[i], &expected);
                kernel->nearest(h, &r[i], &hit);
                same_hit(&hit, &expected);
                same_hit(&hits[i], &expected);
                hit_count += expected.triangle != TRIANGLE_NONE;
            }
        }
        hierarchy_destroy(all);
        hierarchy_destroy(h);
        mesh_release(m);
    }
    assert_true(hit_count > effort(100000));
}

static void instruction_sets_give_the_same_hits(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int scene = 0; scene < 10; scene++) {
        mesh *m = random_mesh(&seed, 200);
        assert_non_null(m);
        for (size_t k = 0; k < COUNT(own_kinds); k++) {
            hierarchy *h = NULL;
            assert_int_equal(hierarchy_build(m, own_kinds[k], 1, &h, NULL), STATUS_OK);
            for (int i = 0; i < effort(2000); i++) {
                const mesh_ray r = random_ray(m, &seed);
                mesh_hit one, other;
                kernels[ISA_BASE]->nearest(h, &r, &one);
                for (int level = ISA_BASE + 1; level <= (int)isa_best(); level++) {
                    kernels[level]->nearest(h, &r, &other);
                    same_hit(&one, &other);
                }
            }
            hierarchy_destroy(h);
        }
        mesh_release(m);
    }
}

/* Rays from inside, to corners, to points of edges and anywhere: a ray that escapes has found a gap between
 * triangles. */
static void no_ray_escapes_from(mesh *m, int rays)
{
    uint64_t seed = 6;
    hierarchy *h = NULL;
    assert_true(m->closed);
    assert_int_equal(hierarchy_build(m, HIERARCHY_BVH, 1, &h, NULL), STATUS_OK);
    for (int first = 0; first < rays; first += BATCH) {
        mesh_ray r[BATCH];
        bool hit[BATCH];
        for (int i = 0; i < BATCH; i++) {
            const vec3 from = random_point(&seed, 0.3);
            r[i] =
                (mesh_ray){from,
                           random_below(&seed, 4) ? vec3_sub(random_target(m, &seed), from) : random_direction(&seed),
                           0.0,
                           (double)INFINITY,
                           TRIANGLE_NONE,
                           FACING_BACK};
        }
        kernels[isa_best()]->any_batch(h, r, BATCH, hit);
        for (int i = 0; i < BATCH; i++)
            assert_true(hit[i]);
    }
    hierarchy_destroy(h);
    mesh_release(m);
}

/* The icosphere with every corner moved in or out by up to `bumps`, in doubles or as floats. */
static mesh *bumpy_sphere(int level, double bumps, bool single)
{
    mesh *m = NULL, *round = NULL;
    assert_int_equal(generate_icosphere(level, &round, NULL), STATUS_OK);
    assert_int_equal(mesh_create(round->vertex_count, round->triangle_count, false, false, false, &m, NULL), STATUS_OK);
    for (size_t i = 0; i < m->vertex_count; i++) {
        const vec3 p = round->vertices[i];
        const double wild = 731.0 * p.x + 317.0 * p.y + 571.0 * p.z; /* equal for corners at one position */
        const vec3 v = vec3_scale(p, 1.0 + bumps * (2.0 * (wild - floor(wild)) - 1.0));
        m->vertices[i] = single ? vec3_make(single_round(v.x), single_round(v.y), single_round(v.z)) : v;
    }
    memcpy(m->triangles, round->triangles, m->triangle_count * sizeof *m->triangles);
    mesh_release(round);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_int_equal(m->single, single);
    return m;
}

static void closed_meshes_are_watertight(void **state)
{
    (void)state;
    no_ray_escapes_from(bumpy_sphere(3, 0.0, false), effort(4000000));
    no_ray_escapes_from(bumpy_sphere(3, 0.0, true), effort(3000000));
    no_ray_escapes_from(bumpy_sphere(4, 0.1, false), effort(3000000));
}

/* A triangle with known hits: in the plane z = 0, its front towards +z; from (0.25, 0.5, 2) downwards it is hit at t =
 * 2 with weights 0.25 and 0.5 of the second and third corner. */
static const vec3 known_corners[3] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
static const mesh_ray known_ray = {{0.25, 0.5, 2.0}, {0.0, 0.0, -1.0}, 0.0,
                                   (double)INFINITY, TRIANGLE_NONE,    FACING_ANY};

static void with_known_triangle(void (*check)(const hierarchy *h, const hierarchy_kernels *kernel))
{
    mesh *m = mesh_of_corners(known_corners, 1);
    assert_non_null(m);
    for (size_t k = 0; k < COUNT(own_kinds); k++) {
        hierarchy *h = NULL;
        assert_int_equal(hierarchy_build(m, own_kinds[k], 1, &h, NULL), STATUS_OK);
        for (int level = 0; level <= (int)isa_best(); level++)
            check(h, kernels[level]);
        hierarchy_destroy(h);
    }
    mesh_release(m);
}

static void check_known_hit(const hierarchy *h, const hierarchy_kernels *kernel)
{
    mesh_hit hit;
    mesh_ray r = known_ray;
    kernel->nearest(h, &r, &hit);
    assert_int_equal(hit.triangle, 0);
    assert_true(hit.t == 2.0 && hit.u == 0.25 && hit.v == 0.5);
    assert_int_equal(hit.facing, FACING_FRONT);
    r.direction = vec3_make(0.0, 0.0, -0.125); /* t is in units of the direction */
    kernel->nearest(h, &r, &hit);
    assert_true(hit.t == 16.0 && hit.u == 0.25 && hit.v == 0.5);
    r.origin.z = -2.0; /* from behind */
    r.direction = vec3_make(0.0, 0.0, 4.0);
    kernel->nearest(h, &r, &hit);
    assert_true(hit.t == 0.5 && hit.u == 0.25 && hit.v == 0.5);
    assert_int_equal(hit.facing, FACING_BACK);
    r = (mesh_ray){{1.25, 1.5, 2.0}, {-0.5, -0.5, -1.0}, 0.0,
                   (double)INFINITY, TRIANGLE_NONE,      FACING_ANY}; /* oblique */
    kernel->nearest(h, &r, &hit);
    assert_true(hit.t == 2.0 && hit.u == 0.25 && hit.v == 0.5);
}

static void a_known_triangle_is_hit_at_the_known_distance_and_weights(void **state)
{
    (void)state;
    with_known_triangle(check_known_hit);
}

static bool known_is_hit(const hierarchy *h, const hierarchy_kernels *kernel, mesh_ray r)
{
    mesh_hit hit;
    kernel->nearest(h, &r, &hit);
    assert_int_equal(kernel->any(h, &r), hit.triangle == 0);
    return hit.triangle == 0;
}

static void check_limits(const hierarchy *h, const hierarchy_kernels *kernel)
{
    mesh_ray r = known_ray;
    r.t_max = 2.0;
    assert_true(known_is_hit(h, kernel, r)); /* both ends belong to the interval */
    r.t_min = 2.0;
    assert_true(known_is_hit(h, kernel, r));
    r.t_max = 3.0;
    assert_true(known_is_hit(h, kernel, r));
    r.t_min = nextafter(2.0, 3.0);
    assert_false(known_is_hit(h, kernel, r));
    r.t_min = 0.0;
    r.t_max = nextafter(2.0, 1.0);
    assert_false(known_is_hit(h, kernel, r));
    r = known_ray;
    r.direction.z = 1.0; /* in the opposite direction */
    assert_false(known_is_hit(h, kernel, r));
    r = known_ray;
    r.origin.z = 0.0; /* starting in the triangle's plane */
    assert_true(known_is_hit(h, kernel, r));
}

static void the_ray_interval_includes_both_limits(void **state)
{
    (void)state;
    with_known_triangle(check_limits);
}

static void check_skip_and_side(const hierarchy *h, const hierarchy_kernels *kernel)
{
    mesh_ray r = known_ray;
    r.skip = 0;
    assert_false(known_is_hit(h, kernel, r));
    r.skip = 1;
    assert_true(known_is_hit(h, kernel, r));
    r.facing = FACING_FRONT;
    assert_true(known_is_hit(h, kernel, r));
    r.facing = FACING_BACK;
    assert_false(known_is_hit(h, kernel, r));
    r.origin.z = -2.0;
    r.direction.z = 1.0;
    assert_true(known_is_hit(h, kernel, r));
    r.facing = FACING_FRONT;
    assert_false(known_is_hit(h, kernel, r));
}

static void a_ray_can_skip_a_triangle_and_select_a_side(void **state)
{
    (void)state;
    with_known_triangle(check_skip_and_side);
}

static void check_edges(const hierarchy *h, const hierarchy_kernels *kernel)
{
    static const struct {
        double x, y;
        bool in;
    } places[] = {{0.0, 0.0, true},
                  {1.0, 0.0, true},
                  {0.0, 1.0, true},
                  {0.5, 0.0, true},
                  {0.0, 0.5, true},
                  {0.5, 0.5, true},
                  {-1e-16, 0.5, false},
                  {0.5, -1e-16, false},
                  {0.5, 0.5000000000000001, false},
                  {1.0000000000000002, 0.0, false}};
    for (size_t i = 0; i < COUNT(places); i++) {
        mesh_ray r = known_ray;
        r.origin.x = places[i].x;
        r.origin.y = places[i].y;
        assert_int_equal(known_is_hit(h, kernel, r), places[i].in);
    }
}

static void edges_and_corners_belong_to_a_triangle(void **state)
{
    (void)state;
    with_known_triangle(check_edges);
}

static void check_invalid_rays(const hierarchy *h, const hierarchy_kernels *kernel)
{
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, 1e300};
    for (size_t i = 0; i < COUNT(bad); i++) {
        mesh_ray r = known_ray;
        r.origin.x = bad[i];
        assert_false(known_is_hit(h, kernel, r));
        r = known_ray;
        r.direction.z = bad[i];
        assert_true(i == 3 || !known_is_hit(h, kernel, r));
    }
    mesh_ray r = known_ray;
    r.t_max = (double)NAN;
    assert_false(known_is_hit(h, kernel, r));
    r = known_ray;
    r.direction.z = 0.0;
    assert_false(known_is_hit(h, kernel, r));
    r = known_ray;
    r.direction.z = -1e-200; /* tiny, but a valid direction */
    assert_true(known_is_hit(h, kernel, r));
}

static void invalid_rays_hit_nothing(void **state)
{
    (void)state;
    with_known_triangle(check_invalid_rays);
}

static void of_equally_near_triangles_the_lowest_index_is_hit(void **state)
{
    (void)state;
    enum { COPIES = 100 };
    vec3 corners[3 * COPIES];
    for (int i = 0; i < COPIES; i++)
        memcpy(&corners[3 * i], known_corners, sizeof known_corners);
    mesh *m = mesh_of_corners(corners, COPIES);
    assert_non_null(m);
    for (size_t k = 0; k < COUNT(own_kinds); k++) {
        hierarchy *h = NULL;
        assert_int_equal(hierarchy_build(m, own_kinds[k], 1, &h, NULL), STATUS_OK);
        mesh_ray r = known_ray;
        mesh_hit hit;
        kernels[isa_best()]->nearest(h, &r, &hit);
        assert_int_equal(hit.triangle, 0);
        r.skip = 0;
        kernels[isa_best()]->nearest(h, &r, &hit);
        assert_int_equal(hit.triangle, 1);
        gathered all = {.nearest = {.triangle = TRIANGLE_NONE}};
        kernels[isa_best()]->all(h, &known_ray, gather, &all);
        assert_int_equal(all.count, COPIES); /* each once */
        hierarchy_destroy(h);
    }
    mesh_release(m);
}

static void a_mesh_without_triangles_is_never_hit(void **state)
{
    (void)state;
    mesh *m = mesh_of_corners(known_corners, 0);
    assert_non_null(m);
    for (size_t k = 0; k < COUNT(own_kinds); k++) {
        hierarchy *h = NULL;
        assert_int_equal(hierarchy_build(m, own_kinds[k], 1, &h, NULL), STATUS_OK);
        assert_false(known_is_hit(h, kernels[isa_best()], known_ray));
        hierarchy_destroy(h);
    }
    mesh_release(m);
}

static void a_mesh_caches_its_hierarchies(void **state)
{
    (void)state;
    mesh *m = mesh_of_corners(known_corners, 1);
    assert_non_null(m);
    for (size_t k = 0; k < COUNT(own_kinds); k++) {
        const hierarchy *one = NULL, *other = NULL;
        assert_int_equal(hierarchy_of_mesh(m, own_kinds[k], 1, &one, NULL), STATUS_OK);
        assert_int_equal(hierarchy_of_mesh(m, own_kinds[k], 1, &other, NULL), STATUS_OK);
        assert_non_null(one);
        assert_ptr_equal(one, other);
        assert_true(hierarchy_describe(one).bytes > 0);
    }
    mesh_release(m); /* frees them: the sanitizer would find a leak */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_known_triangle_is_hit_at_the_known_distance_and_weights),
        cmocka_unit_test(the_ray_interval_includes_both_limits),
        cmocka_unit_test(a_ray_can_skip_a_triangle_and_select_a_side),
        cmocka_unit_test(edges_and_corners_belong_to_a_triangle),
        cmocka_unit_test(invalid_rays_hit_nothing),
        cmocka_unit_test(of_equally_near_triangles_the_lowest_index_is_hit),
        cmocka_unit_test(a_mesh_without_triangles_is_never_hit),
        cmocka_unit_test(a_mesh_caches_its_hierarchies),
        cmocka_unit_test(batches_of_coherent_rays_have_the_hits_of_single_rays),
        cmocka_unit_test(rays_from_afar_have_the_hits_of_all_triangles),
        cmocka_unit_test(instruction_sets_give_the_same_hits),
        cmocka_unit_test(every_hierarchy_gives_the_same_hits),
        cmocka_unit_test(closed_meshes_are_watertight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
