/* Tests of the solid tree: every hit, set and shadow is that of the same scene whose primitives are all direct, which
 * test_media.c checks against brute force; and scenes with more solids than bits, against closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "geometry/set_table.h"
#include "optics/interface.h"
#include "room_fixture.h"

/* The same solids, built both ways. Primitives have other numbers in the tree's geometry: planes first. */
typedef struct both_ways {
    scene_geometry *direct, *tree;
} both_ways;

static both_ways build_both(const room *m)
{
    both_ways b;
    region_source sources[SOLIDS_MAX];
    for (int i = 0; i < m->count; i++)
        sources[i] = (region_source){.shape = &m->shape[i],
                                     .priority = m->priority[i],
                                     .medium = m->medium[i],
                                     .opaque = m->opaque[i],
                                     .shadow_transmittance = m->opaque[i] ? 0.0 : m->shadow_transmittance[i],
                                     .solid = i};
    assert_int_equal(scene_geometry_build(sources, m->count, 0, TREE_IF_TOO_MANY, &b.direct, NULL), STATUS_OK);
    assert_int_equal(scene_geometry_build(sources, m->count, 0, TREE_ALWAYS, &b.tree, NULL), STATUS_OK);
    return b;
}

static void destroy_both(const both_ways *b)
{
    scene_geometry_destroy(b->direct);
    scene_geometry_destroy(b->tree);
}

/* A region's primitive of the one geometry in the other. */
static int in_tree(const both_ways *b, int p)
{
    const int r = b->direct->primitives[p].priority_index;
    return p == b->direct->regions[r].hollow ? b->tree->regions[r].hollow : b->tree->regions[r].outside;
}

static void assert_same_set(const both_ways *b, uint64_t direct, uint64_t tree)
{
    for (int r = 1; r <= b->direct->region_count; r++) {
        const int parts[2] = {b->direct->regions[r].outside, b->direct->regions[r].hollow};
        /* a hollow's bit counts only within the solid's outside */
        const int count = scene_geometry_set_has(b->direct, direct, parts[0]) ? 2 : 1;
        for (int k = 0; k < count && parts[k] >= 0; k++)
            assert_int_equal(scene_geometry_set_has(b->tree, tree, in_tree(b, parts[k])),
                             scene_geometry_set_has(b->direct, direct, parts[k]));
    }
}

/* Traces a ray through all its interfaces, or reflected at random, in both geometries. Returns the interfaces. */
static int walk_both(const both_ways *b, vec3 from, vec3 direction, uint64_t *seed)
{
    one_ray one = {from, direction, FACE_NONE, scene_geometry_inside(b->direct, from)};
    one_ray other = {from, direction, FACE_NONE, scene_geometry_inside(b->tree, from)};
    int interfaces = 0;
    for (; interfaces < WALK_MAX; interfaces++) {
        assert_same_set(b, one.inside, other.inside);
        const one_hit h = nearest_interface(b->direct, one), g = nearest_interface(b->tree, other);
        assert_int_equal(h.hit_primitive < 0, g.hit_primitive < 0);
        assert_int_equal(h.before, g.before);
        if (h.hit_primitive < 0)
            break;
        assert_int_equal(in_tree(b, h.hit_primitive), g.hit_primitive);
        assert_memory_equal(&h.t, &g.t, sizeof h.t);
        assert_int_equal(h.after, g.after);
        assert_int_equal(h.surface, g.surface);
        assert_same_set(b, h.inside_before, g.inside_before);
        assert_same_set(b, h.inside_after, g.inside_after);
        assert_memory_equal(&h.point, &g.point, sizeof h.point);
        assert_memory_equal(&h.normal, &g.normal, sizeof h.normal);
        assert_int_equal(h.face % FACES_MAX, g.face % FACES_MAX);
        const bool back = random_below(seed, 3) == 0;
        const vec3 d = back ? direction_reflect(one.d, h.normal, h.cos_i) : one.d;
        one = (one_ray){h.point, d, h.face, back ? h.inside_before : h.inside_after};
        other = (one_ray){g.point, d, g.face, back ? g.inside_before : g.inside_after};
    }
    return interfaces;
}

static int walks_agree(void (*fill)(room *m, uint64_t *seed), uint64_t seed, int rooms)
{
    int interfaces = 0;
    for (int trial = 0; trial < rooms; trial++) {
        room m;
        fill(&m, &seed);
        const both_ways b = build_both(&m);
        for (int k = 0; k < 12; k++)
            interfaces += walk_both(&b, random_point(&seed, k % 2 ? 0.7 : 4.0), random_direction(&seed), &seed);
        destroy_both(&b);
        scene_geometry_destroy(m.solids);
    }
    return interfaces;
}

static void hits_are_those_of_direct_primitives(void **state)
{
    (void)state;
    assert_true(walks_agree(room_fill, 301, 1000) > 10000);
}

static void hits_at_coincident_faces_are_those_of_direct_primitives(void **state)
{
    (void)state;
    assert_true(walks_agree(room_fill_on_a_grid, 302, 1000) > 10000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hits_are_those_of_direct_primitives),
        cmocka_unit_test(hits_at_coincident_faces_are_those_of_direct_primitives),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
