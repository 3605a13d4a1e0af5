/* Rays that pass a mesh's box by are not traced through its hierarchy; rays close to the box find what a query of the
 * hierarchy finds. */
#include "geometry/hierarchy/layout.h"
#include "geometry/mesh/mesh_generators.h"
#include "geometry/regions/box_tests.h"
#include "geometry/regions/instance_set.h"
#include "random_stream.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

typedef struct placed_mesh {
    mesh *m;
    hierarchy *tree;
    instance_set *set;
    vec3 position;
} placed_mesh;

static placed_mesh place(mesh *m, vec3 position)
{
    placed_mesh p = {.m = m, .position = position};
    assert_int_equal(hierarchy_build(m, HIERARCHY_BVH, 1, &p.tree, NULL), STATUS_OK);
    const vec3 ones = {1.0, 1.0, 1.0};
    const solid_shape shape = {.mesh = m, .position = position, .scale = ones, .copies = ones};
    const instance_source source = {.shape = &shape, .tree = p.tree, .primitive = 0, .priority_index = 1};
    assert_int_equal(instance_set_build(&source, 1, source.priority_index, &p.set, NULL), STATUS_OK);
    return p;
}

static void remove_mesh(placed_mesh p)
{
    instance_set_destroy(p.set);
    hierarchy_destroy(p.tree);
    mesh_release(p.m);
}

/* Aimed at a vertex, many of which are on the box, from 0.001 to 10^5 away, past it by 10^-17 to 1 of the distance. */
static instance_ray ray_near(const placed_mesh *p, uint64_t *seed)
{
    const vec3 at = vec3_add(p->position, p->m->vertices[random_below(seed, (int)p->m->vertex_count)]);
    const double distance = pow(10.0, random_real(seed, -3.0, 5.0)), aside = pow(10.0, random_real(seed, -17.0, 0.0));
    const vec3 away = random_below(seed, 3) ? random_direction(seed) : vec3_make(0.0, 0.0, 1.0);
    const vec3 off = vec3_add(away, vec3_scale(random_direction(seed), aside));
    return (instance_ray){.origin = vec3_add(at, vec3_scale(away, distance)),
                          .direction = vec3_scale(off, -random_real(seed, 0.1, 2.0)),
                          .t_max = HUGE_VAL,
                          .start = FACE_NONE,
                          .before = 0,
                          .wanted = 1};
}

static void compare(const placed_mesh *p, uint64_t *seed, int *hits, int *misses)
{
    const instance_ray ray = ray_near(p, seed);
    const mesh_ray local = {.origin = vec3_sub(ray.origin, p->position),
                            .direction = ray.direction,
                            .t_max = HUGE_VAL,
                            .skip = TRIANGLE_NONE,
                            .facing = p->m->closed ? FACING_FRONT : FACING_ANY};
    mesh_hit expected;
    instance_hit got;
    bool blocked;
    ISA_BASE_OF(hierarchy_kernels).nearest(p->tree, &local, &expected);
    ISA_BASE_OF(instance_kernels).nearest(p->set, &ray, 1, &got);
    ISA_BASE_OF(instance_kernels).any(p->set, &ray, 1, &blocked);
    assert_int_equal(got.face != FACE_NONE, expected.triangle != TRIANGLE_NONE);
    assert_int_equal(blocked, expected.triangle != TRIANGLE_NONE);
    if (expected.triangle != TRIANGLE_NONE) {
        assert_int_equal(mesh_face_triangle(got.face), expected.triangle);
        assert_true(got.t == expected.t);
        assert_false(ray_misses_box(p->set->world.low, p->set->world.high, ray.origin, ray.direction));
    }
    (*hits) += blocked;
    (*misses) += !blocked;
}

static void rays_close_to_the_box_of_a_mesh_find_what_its_hierarchy_has(void **state)
{
    (void)state;
    mesh *meshes[2];
    assert_int_equal(generate_icosphere(1, &meshes[0], NULL), STATUS_OK);
    assert_int_equal(generate_box(vec3_make(1.0, 2.0, 1e-3), &meshes[1], NULL), STATUS_OK);
    for (int i = 0; i < 2; i++) {
        const placed_mesh p = place(meshes[i], vec3_make(0.1, -7.0, 1e3));
        uint64_t seed = 5;
        int hits = 0, misses = 0;
        for (int k = 0; k < 20000; k++)
            compare(&p, &seed, &hits, &misses);
        assert_true(hits > 1000 && misses > 1000);
        remove_mesh(p);
    }
}

/* In front of an outer vertex, and away from it. */
static void the_box_of_a_set_has_the_vertices_of_all_copies(void **state)
{
    (void)state;
    mesh *m;
    hierarchy *tree;
    instance_set *set;
    assert_int_equal(generate_icosphere(1, &m, NULL), STATUS_OK);
    assert_int_equal(hierarchy_build(m, HIERARCHY_BVH, 1, &tree, NULL), STATUS_OK);
    const solid_shape shape = {.mesh = m,
                               .position = {1e4, -3.0, 0.1},
                               .rotation_deg = {10.0, 20.0, 30.0},
                               .scale = {1.0, 2.0, 0.5},
                               .copies = {2.0, 3.0, 1.0},
                               .spacing = {5.0, 7.0, 0.0}};
    const instance_source source = {.shape = &shape, .tree = tree, .primitive = 0, .priority_index = 1};
    assert_int_equal(instance_set_build(&source, 1, source.priority_index, &set, NULL), STATUS_OK);
    const vec3 low = set->world.low, high = set->world.high, outside = vec3_make(high.x + 1.0, low.y, low.z);
    for (uint32_t copy = 0; copy < 6; copy++)
        for (uint32_t vertex = 0; vertex < m->vertex_count; vertex++) {
            const vec3 at = instance_set_vertex_point(set->parts, copy, vertex);
            assert_true(at.x >= low.x && at.y >= low.y && at.z >= low.z);
            assert_true(at.x <= high.x && at.y <= high.y && at.z <= high.z);
            assert_int_equal(ray_misses_box(low, high, outside, vec3_sub(at, outside)), 0);
            assert_int_equal(ray_misses_box(low, high, outside, vec3_sub(outside, at)), -1);
        }
    instance_set_destroy(set);
    hierarchy_destroy(tree);
    mesh_release(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_close_to_the_box_of_a_mesh_find_what_its_hierarchy_has),
        cmocka_unit_test(the_box_of_a_set_has_the_vertices_of_all_copies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
