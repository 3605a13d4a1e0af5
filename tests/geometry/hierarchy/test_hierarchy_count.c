/* Tests of hierarchy_count: the tests of a ray in trees small or regular enough to count by hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "base/isa.h"
#include "hierarchy_fixture.h"
#include "hierarchy_scenes.h"
#include "render_fixture.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

static const hierarchy_kernels *const kernels[ISA_COUNT] = ISA_ARRAY(hierarchy_kernels);

/* Nearly along x: a ray exactly across two axes is not culled on the far side of a box (query.h). */
static mesh_ray along_x(double x, double y, double z)
{
    return (mesh_ray){{x, y, z}, {1.0, 0x1p-10, 0x1p-10}, 0.0, (double)INFINITY, TRIANGLE_NONE, FACING_ANY};
}

static query_counts counts_of(const hierarchy *h, const mesh_ray *ray, enum query_mode mode)
{
    query_counts c = {0};
    hierarchy_count(h, ray, mode, &c);
    assert_int_equal(c.rays, 1);
    return c;
}

static void expect(query_counts c, uint64_t nodes, uint64_t boxes, uint64_t triangles)
{
    assert_int_equal(c.nodes, nodes);
    assert_int_equal(c.boxes, boxes);
    assert_int_equal(c.triangles, triangles);
}

/* --- a perfect tree, built by hand --- */

/* A perfect octree over the cube [0, 1]^3 as a BVH: 8^levels cells, whose boxes are half as wide as the cells, so that
 * they are disjoint; and in each a triangle across the x axis at its middle, large enough that a ray through the
 * middle of the row hits it, or, with `holes`, next to the row's middle, so that the ray enters every box and hits
 * nothing. */
static void fill_node(fixture *f, uint32_t number, uint32_t *next_node, uint32_t *next_block, const double *corner,
                      double edge, int level, bool holes)
{
    const double half = 0.5 * edge;
    for (uint32_t i = 0; i < WIDTH; i++) {
        double at[3];
        for (int k = 0; k < 3; k++) {
            at[k] = corner[k] + (i >> k & 1 ? half : 0.0);
            f->h.nodes[number].low[k][i] = (float)(at[k] + 0.25 * half * (level == 1));
            f->h.nodes[number].high[k][i] = (float)(at[k] + half - 0.25 * half * (level == 1));
        }
        if (level > 1) {
            const uint32_t child = (*next_node)++;
            f->h.nodes[number].child[i] = child;
            fill_node(f, child, next_node, next_block, at, half, level - 1, holes);
            continue;
        }
        const double x = at[0] + 0.5 * half, y = at[1] + 0.5 * half, z = at[2] + 0.5 * half, e = 0.2 * half,
                     aside = holes ? 0.1 * half : -e;
        const uint32_t triangle = *next_block;
        fixture_set(f, triangle, vec3_make(x, y + aside, z - e), vec3_make(x, y + e, z - e),
                    vec3_make(x, y + aside, z + e));
        f->h.nodes[number].child[i] = child_leaf((*next_block)++, 1);
    }
    f->h.nodes[number].child_count = WIDTH;
}

/* Blocks of one triangle each. */
static void fill_blocks(fixture *f, size_t triangles)
{
    f->h.single = false;
    f->h.block_count = triangles;
    f->h.blocks = calloc(triangles, sizeof(block_double));
    assert_non_null(f->h.blocks);
    for (size_t i = 0; i < triangles; i++)
        for (int lane = 0; lane < BLOCK; lane++) {
            block_double *b = (block_double *)f->h.blocks + i;
            b->triangle[lane] = (uint32_t)i;
            for (int corner = 0; corner < 3; corner++) {
                const vec3 v = f->m.vertices[3 * i + (size_t)corner];
                b->corner[corner][0][lane] = v.x, b->corner[corner][1][lane] = v.y, b->corner[corner][2][lane] = v.z;
            }
        }
}

static fixture perfect_tree(int levels, bool holes)
{
    size_t cells = 1, nodes = 0;
    for (int i = 0; i < levels; i++)
        nodes += cells, cells *= 8;
    fixture f = fixture_make(cells, false);
    const double corner[3] = {0.0, 0.0, 0.0};
    uint32_t next_node = 1, next_block = 0;
    f.h = (hierarchy){.of = &f.m, .kind = HIERARCHY_BVH, .node_count = nodes, .reach = {1.0f, 1.0f, 1.0f}};
    f.h.nodes = aligned_alloc(64, nodes * sizeof *f.h.nodes);
    assert_non_null(f.h.nodes);
    memset(f.h.nodes, 0, nodes * sizeof *f.h.nodes);
    fill_node(&f, 0, &next_node, &next_block, corner, 1.0, levels, holes);
    fill_blocks(&f, cells);
    return f;
}

/* A ray that hits nothing passes along one row of 2^k of the 8^k cells: 2^j of the nodes of each level j, that is
 * 8 (2^k - 1) boxes and 2^k triangles, which grow as the cube root of their number; a ray that hits the first triangle
 * descends once, through 8 k boxes to one triangle, which grow as its logarithm. */
static void a_perfect_tree_has_both_laws(void **state)
{
    (void)state;
    for (int k = 1; k <= 4; k++) {
        const uint64_t row = UINT64_C(1) << k;
        const double middle = 0.45 / (double)row; /* near that of the first cell, and on no edge */
        const mesh_ray ray = along_x(-1.0, middle, middle);
        fixture f = perfect_tree(k, true);
        mesh_hit hit;
        kernels[0]->nearest(&f.h, &ray, &hit);
        assert_int_equal(hit.triangle, TRIANGLE_NONE);
        expect(counts_of(&f.h, &ray, QUERY_NEAREST), row - 1, 8 * (row - 1), row);
        expect(counts_of(&f.h, &ray, QUERY_ANY), row - 1, 8 * (row - 1), row);
        fixture_free(&f);
        f = perfect_tree(k, false);
        kernels[0]->nearest(&f.h, &ray, &hit);
        assert_int_equal(hit.triangle, 0);
        expect(counts_of(&f.h, &ray, QUERY_NEAREST), (uint64_t)k, 8 * (uint64_t)k, 1);
        expect(counts_of(&f.h, &ray, QUERY_ANY), (uint64_t)k, 8 * (uint64_t)k, 1);
        expect(counts_of(&f.h, &ray, QUERY_ALL), row - 1, 8 * (row - 1), row);
        mesh_ray past = ray;
        past.origin.y = 2.0; /* past the tree: the root's boxes alone */
        expect(counts_of(&f.h, &past, QUERY_NEAREST), 1, 8, 0);
        fixture_free(&f);
    }
}

/* --- the builders' trees --- */

/* A wall of single small triangles across the x axis, one behind the other, 8 apart. */
static mesh *row_of_triangles(int count)
{
    vec3 at[3 * 64];
    for (int i = 0; i < count; i++)
        for (int j = 0; j < 3; j++)
            at[3 * i + j] = vec3_make(8.0 * i, j == 1 ? 1.0 : -1.0, j == 2 ? 1.0 : -1.0);
    mesh *m = mesh_of_corners(at, (size_t)count);
    assert_non_null(m);
    return m;
}

static hierarchy *built(const mesh *m, hierarchy_kind kind)
{
    hierarchy *h = NULL;
    assert_int_equal(hierarchy_build(m, kind, 1, &h, NULL), STATUS_OK);
    return h;
}

/* Without a hierarchy every ray tests every triangle, padding apart; with any hit, blocks of four up to the one that is
 * hit. One sphere is one more test, and saves the triangles of rays that miss it. */
static void none_and_one_sphere_test_every_triangle(void **state)
{
    (void)state;
    static const int counts[] = {1, 3, 4, 5, 7, 50};
    for (size_t i = 0; i < COUNT(counts); i++) {
        mesh *m = row_of_triangles(counts[i]);
        const uint64_t all = (uint64_t)counts[i], block = all < BLOCK ? all : BLOCK;
        hierarchy *none = built(m, HIERARCHY_NONE), *sphere = built(m, HIERARCHY_SPHERE);
        const mesh_ray hits = along_x(-5.0, -0.5, -0.5), misses = along_x(-5.0, 900.0, 0.0);
        const mesh_ray between = {{4.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.0, (double)INFINITY, TRIANGLE_NONE, FACING_ANY};
        expect(counts_of(none, &hits, QUERY_NEAREST), 0, 0, all);
        expect(counts_of(none, &misses, QUERY_NEAREST), 0, 0, all);
        expect(counts_of(none, &hits, QUERY_ANY), 0, 0, block);
        expect(counts_of(none, &hits, QUERY_ALL), 0, 0, all);
        expect(counts_of(sphere, &hits, QUERY_NEAREST), 1, 1, all);
        expect(counts_of(sphere, &hits, QUERY_ANY), 1, 1, block);
        expect(counts_of(sphere, &misses, QUERY_NEAREST), 0, 1, 0);
        if (counts[i] > 1) /* inside the sphere, past every triangle */
            expect(counts_of(sphere, &between, QUERY_NEAREST), 1, 1, all);
        hierarchy_destroy(none);
        hierarchy_destroy(sphere);
        mesh_release(m);
    }
}

/* Three small triangles at either end of a diagonal (test_hierarchy_build.c): the octants' root keeps none and
 * has two children. A ray through one end tests the three spheres and the three triangles of that end. */
static void two_octants_by_hand(void **state)
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
    hierarchy *h = built(m, HIERARCHY_OCTANT);
    const mesh_ray end = {{-8.0, -8.0, -20.0}, {0.0, 0.0, 1.0}, 0.0, (double)INFINITY, TRIANGLE_NONE, FACING_ANY};
    const mesh_ray middle = {{8.0, -8.0, -20.0}, {0.0, 0.0, 1.0}, 0.0, (double)INFINITY, TRIANGLE_NONE, FACING_ANY};
    const mesh_ray past = along_x(-20.0, 50.0, 0.0);
    expect(counts_of(h, &end, QUERY_NEAREST), 2, 3, 3);
    expect(counts_of(h, &middle, QUERY_NEAREST), 1, 3, 0);
    expect(counts_of(h, &past, QUERY_NEAREST), 0, 1, 0);
    hierarchy_destroy(h);
    mesh_release(m);
}

/* A ray that cannot hit anything is a query without tests. */
static void impossible_rays_test_nothing(void **state)
{
    (void)state;
    mesh *m = row_of_triangles(5);
    mesh_ray still = along_x(0.0, 0.0, 0.0);
    still.direction = vec3_make(0.0, 0.0, 0.0);
    for (int kind = 0; kind < HIERARCHY_KIND_COUNT; kind++) {
        hierarchy *h = built(m, (hierarchy_kind)kind);
        expect(counts_of(h, &still, QUERY_NEAREST), 0, 0, 0);
        hierarchy_destroy(h);
    }
    mesh_release(m);
}

/* --- in a frame --- */

static const char soup[] =
    "render: {width: 40, height: 30, depth: 2, shadows: opaque}\n"
    "camera: {position: [0, 0, -3], target: [0, 0, 0]}\n"
    "meshes:\n  soup: {generate: sparse, count: 3000}\n"
    "materials:\n  glass: {ior: 1.5, transparency: 0.5, reflectivity: 0.5}\n"
    "  clay: {color: [0.8, 0.5, 0.3]}\n"
    "lights:\n  lamp: {position: [2, 3, -4]}\n"
    "solids:\n  ball: {shape: sphere, radius: 0.5, material: glass}\n"
    "  model: {shape: mesh, mesh: soup, material: clay, copies: [2, 1, 1], spacing: [2.5, 0, 0]}\n";

static query_counts frame_counts(const char *settings, isa level, uint64_t *hash)
{
    scene *s = scene_from(soup);
    set_all(s, settings);
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    render_result *r = render_at(s, level, NULL);
    const query_counts c = r->counters.queries;
    *hash = film_hash(r->img);
    render_result_destroy(r);
    scene_destroy(s);
    return c;
}

/* The counts of a frame depend on no thread, tile, schedule or instruction set, and change no film. */
static void counts_depend_on_scene_and_hierarchy_alone(void **state)
{
    (void)state;
    need_counters();
    static const char *const variants[] = {
        "render.threads=3", "render.tile=7 render.threads=2 render.tiles_per_worker=0",
        "render.schedule=rows render.threads=4", "render.pool=off render.build_threads=3"};
    static const char *const kinds[] = {"none", "sphere", "octant", "bvh"};
    uint64_t hash, plain_hash;
    const query_counts off = frame_counts("render.count_tests=off", isa_best(), &plain_hash);
    assert_true(off.rays == 0 && off.nodes == 0 && off.boxes == 0 && off.triangles == 0);
    for (size_t kind = 0; kind < COUNT(kinds); kind++) {
        char settings[160];
        snprintf(settings, sizeof settings, "render.count_tests=on render.accel=%s", kinds[kind]);
        const query_counts first = frame_counts(settings, isa_best(), &hash);
        assert_true(hash == plain_hash && first.rays > 0 && first.triangles > 0);
        assert_true(kind > 0 || first.boxes == 0);
        for (size_t i = 0; i < COUNT(variants) + (size_t)isa_best() + 1; i++) {
            const isa level = i < COUNT(variants) ? isa_best() : (isa)(i - COUNT(variants));
            snprintf(settings, sizeof settings, "render.count_tests=on render.accel=%s %s", kinds[kind],
                     i < COUNT(variants) ? variants[i] : "render.threads=1");
            const query_counts c = frame_counts(settings, level, &hash);
            assert_memory_equal(&c, &first, sizeof c);
            assert_true(hash == plain_hash);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_perfect_tree_has_both_laws),
        cmocka_unit_test(none_and_one_sphere_test_every_triangle),
        cmocka_unit_test(two_octants_by_hand),
        cmocka_unit_test(impossible_rays_test_nothing),
        cmocka_unit_test(counts_depend_on_scene_and_hierarchy_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
