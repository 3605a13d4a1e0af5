/* Tests of the solid tree: every hit, set and shadow is that of the same scene whose primitives are all direct, which
 * test_media.c checks against brute force; and scenes with more solids than bits, against closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "mesh_room.h"
#include "optics/interface.h"

/* The same solids in two geometries. Primitives have other numbers in the tree's geometry: planes first. */
typedef struct both_ways {
    scene_geometry *direct, *tree;
} both_ways;

/* trees: of the solids that are meshes; NULL if none is. */
static both_ways build_both(const room *m, hierarchy *const *trees)
{
    both_ways b;
    region_source sources[SOLIDS_MAX];
    for (int i = 0; i < m->count; i++)
        sources[i] = (region_source){.shape = &m->shape[i],
                                     .tree = trees ? trees[i] : NULL,
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
        const both_ways b = build_both(&m, NULL);
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

/* Between random points; half of the pairs share one. */
static void compare_shadows(const both_ways *b, uint64_t *seed, double blocked[2])
{
    for (int k = 0; k < 24; k++) {
        const vec3 from = random_point(seed, k % 2 ? 0.7 : 3.0), to = random_point(seed, 3.0);
        const one_ray one = {from, vec3_sub(to, from), FACE_NONE, scene_geometry_inside(b->direct, from)};
        const one_ray other = {from, vec3_sub(to, from), FACE_NONE, scene_geometry_inside(b->tree, from)};
        for (int opaque = 0; opaque < 2; opaque++) {
            const double light = light_through(b->direct, one, opaque), same = light_through(b->tree, other, opaque);
            assert_memory_equal(&light, &same, sizeof light);
            blocked[light == 0.0]++;
        }
    }
}

static void shadows_are_those_of_direct_primitives(void **state)
{
    (void)state;
    uint64_t seed = 303;
    double blocked[2] = {0.0, 0.0};
    for (int trial = 0; trial < 1000; trial++) {
        room m;
        (trial % 2 ? room_fill_on_a_grid : room_fill)(&m, &seed);
        const both_ways b = build_both(&m, NULL);
        compare_shadows(&b, &seed, blocked);
        destroy_both(&b);
        scene_geometry_destroy(m.solids);
    }
    assert_true(blocked[0] > 5000.0 && blocked[1] > 5000.0);
}

static void hits_among_meshes_are_those_of_direct_primitives(void **state)
{
    (void)state;
    uint64_t seed = 304;
    int interfaces = 0;
    double blocked[2] = {0.0, 0.0};
    for (int trial = 0; trial < 400; trial++) {
        mesh_room m;
        mesh_room_fill(&m, &seed, trial % 2);
        const both_ways b = build_both(&m.r, m.tree);
        for (int k = 0; k < 12; k++)
            interfaces += walk_both(&b, random_point(&seed, k % 2 ? 0.9 : 4.0), random_direction(&seed), &seed);
        compare_shadows(&b, &seed, blocked);
        destroy_both(&b);
        mesh_room_empty(&m);
    }
    assert_true(interfaces > 4000);
}

/* Along an axis, faces of meshes and of other solids on a grid are met at exactly one distance: either geometry takes
 * the same one. */
static void hits_at_equal_distances_are_those_of_direct_primitives(void **state)
{
    (void)state;
    uint64_t seed = 306;
    int interfaces = 0;
    for (int trial = 0; trial < 300; trial++) {
        mesh_room m;
        mesh_room_fill(&m, &seed, true);
        const both_ways b = build_both(&m.r, m.tree);
        for (int k = 0; k < 12; k++) {
            const double way = k % 2 ? 1.0 : -1.0;
            const vec3 d = vec3_make(k % 3 == 0 ? way : 0.0, k % 3 == 1 ? way : 0.0, k % 3 == 2 ? way : 0.0);
            interfaces += walk_both(&b, vec3_sub(random_point(&seed, 0.9), vec3_scale(d, 4.0)), d, &seed);
        }
        destroy_both(&b);
        mesh_room_empty(&m);
    }
    assert_true(interfaces > 4000);
}

enum { CONE = 96 };

/* A bundle of rays from one point, narrow enough to be traced in a view of the few solids ahead (rays.h). */
typedef struct bundle {
    double o[3][CONE], d[3][CONE];
    int64_t start[CONE];
    uint64_t direct[CONE], tree[CONE];
} bundle;

static void aim_bundle(const both_ways *b, uint64_t *seed, bundle *u)
{
    const vec3 from = random_point(seed, 2.0), axis = random_direction(seed);
    const double wide = pow(10.0, random_real(seed, -3.0, -0.3)), length = random_real(seed, 0.5, 4.0);
    const uint64_t direct = scene_geometry_inside(b->direct, from), tree = scene_geometry_inside(b->tree, from);
    for (int i = 0; i < CONE; i++) {
        const vec3 d = vec3_scale(vec3_normalize(vec3_add(axis, vec3_scale(random_direction(seed), wide))), length);
        u->o[0][i] = from.x, u->o[1][i] = from.y, u->o[2][i] = from.z;
        u->d[0][i] = d.x, u->d[1][i] = d.y, u->d[2][i] = d.z;
        u->start[i] = FACE_NONE, u->direct[i] = direct, u->tree[i] = tree;
    }
}

static ray_batch batch_of(const bundle *u, const uint64_t *inside)
{
    return (ray_batch){CONE, u->o[0], u->o[1], u->o[2], u->d[0], u->d[1], u->d[2], u->start, inside};
}

static void bundles_meet_what_they_meet_among_direct_primitives(void **state)
{
    (void)state;
    static ray_scratch scratch;
    static hit_batch one, other;
    static double light[ROW], same[ROW];
    static bundle u;
    const geometry_kernels *kernels = kernels_of(isa_best());
    uint64_t seed = 305;
    int hits = 0;
    for (int trial = 0; trial < 2000; trial++) {
        room m;
        (trial % 2 ? room_fill_on_a_grid : room_fill)(&m, &seed);
        const both_ways b = build_both(&m, NULL);
        aim_bundle(&b, &seed, &u);
        const ray_batch direct = batch_of(&u, u.direct), tree = batch_of(&u, u.tree);
        kernels->shadow(b.direct, &direct, trial / 2 % 2, &scratch, light);
        kernels->shadow(b.tree, &tree, trial / 2 % 2, &scratch, same);
        assert_memory_equal(light, same, sizeof(double[CONE]));
        kernels->nearest(b.direct, &direct, &scratch, &one);
        kernels->nearest(b.tree, &tree, &scratch, &other);
        for (int i = 0; i < CONE; i++) {
            assert_int_equal(one.before[i], other.before[i]);
            assert_int_equal(one.hit_primitive[i] < 0, other.hit_primitive[i] < 0);
            if (one.hit_primitive[i] < 0)
                continue;
            hits++;
            assert_int_equal(in_tree(&b, (int)one.hit_primitive[i]), other.hit_primitive[i]);
            assert_memory_equal(&one.t[i], &other.t[i], sizeof one.t[i]);
            assert_int_equal(one.after[i], other.after[i]);
            assert_int_equal(one.surface[i], other.surface[i]);
            assert_same_set(&b, one.inside_before[i], other.inside_before[i]);
            assert_same_set(&b, one.inside_after[i], other.inside_after[i]);
        }
        destroy_both(&b);
        scene_geometry_destroy(m.solids);
    }
    assert_true(hits > 50000);
}

enum { SHELLS = 200 };

/* Concentric balls, the smaller the denser and of higher priority: the shells of a lens with a gradient. */
static scene_geometry *shells(double n[SHELLS + 1])
{
    static solid_shape ball[SHELLS];
    region_source sources[SHELLS];
    n[0] = 1.0; /* by solid, from 1; outside: 0 */
    for (int i = 0; i < SHELLS; i++) {
        ball[i] = (solid_shape){.kind = SHAPE_SPHERE, .radius = 1.0 - i / (double)SHELLS};
        n[i + 1] = 1.0 + 0.5 * (i + 1) / SHELLS;
        sources[i] =
            (region_source){.shape = &ball[i], .priority = i, .medium = i + 1, .shadow_transmittance = 1.0, .solid = i};
    }
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(sources, SHELLS, 0, TREE_IF_TOO_MANY, &a, NULL), STATUS_OK);
    assert_non_null(a->tree);
    return a;
}

static double index_of(const scene_geometry *a, const double *n, int priority_index)
{
    return n[a->regions[priority_index].solid + 1];
}

/* Bouguer's law: in spherical shells n r sin(theta) is the same along the whole path (Born and Wolf, Principles of
 * Optics, 3.2.1). More than 64 solids contain the middle of the path. */
static void a_ray_through_200_shells_obeys_the_law_of_bouguer(void **state)
{
    (void)state;
    double n[SHELLS + 1];
    scene_geometry *a = shells(n);
    for (int k = 0; k < 40; k++) {
        const double off = 0.01 + 0.024 * k;
        one_ray r = {vec3_make(off, 0.0, -3.0), vec3_make(0.0, 0.0, 1.0), FACE_NONE, 0};
        int interfaces = 0, deepest = 0;
        for (one_hit h = nearest_interface(a, r); h.hit_primitive >= 0; h = nearest_interface(a, r), interfaces++) {
            const double from = index_of(a, n, h.before), to = index_of(a, n, h.after);
            assert_true(fabs(from * vec3_length(vec3_cross(h.point, r.d)) - off) < 1e-12);
            const fresnel f = fresnel_dielectric(h.cos_i, from, to);
            assert_false(f.total);
            r = (one_ray){h.point, direction_refract(r.d, h.normal, h.cos_i, f.eta, f.cos_t), h.face, h.inside_after};
            deepest = h.after > deepest ? h.after : deepest;
            assert_int_equal(scene_geometry_set_has(a, h.inside_after, a->regions[1].outside), h.after > 0);
        }
        assert_int_equal(interfaces, 2 * deepest); /* in through each shell, and out again */
        assert_int_equal(r.inside, 0);
        assert_true(k > 0 || deepest > 64);
    }
    scene_geometry_destroy(a);
}

/* Balls in one place: of all boundaries that coincide, the highest priority's is the interface. */
static void a_hundred_equal_balls_in_one_place_are_one(void **state)
{
    (void)state;
    enum { BALLS = 100 };
    const solid_shape ball = {.kind = SHAPE_SPHERE, .radius = 1.0};
    region_source sources[BALLS];
    for (int i = 0; i < BALLS; i++)
        sources[i] = (region_source){
            .shape = &ball, .priority = i * 37 % BALLS, .medium = i + 1, .shadow_transmittance = 0.5, .solid = i};
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(sources, BALLS, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    one_ray r = {vec3_make(0.3, 0.2, -3.0), vec3_make(0.0, 0.0, 1.0), FACE_NONE, 0};
    const double light = light_through(a, (one_ray){r.o, vec3_make(0.0, 0.0, 6.0), FACE_NONE, 0}, 0);
    assert_true(light == 0.25);
    for (int side = 0; side < 2; side++) {
        const one_hit h = nearest_interface(a, r);
        assert_int_equal(h.surface, BALLS);
        assert_int_equal(side ? h.before : h.after, BALLS);
        assert_int_equal(side ? h.after : h.before, 0);
        assert_true(fabs(vec3_length(h.point) - 1.0) < 1e-15);
        r = (one_ray){h.point, r.d, h.face, h.inside_after};
    }
    assert_int_equal(nearest_interface(a, r).hit_primitive, -1);
    scene_geometry_destroy(a);
}

/* The distance of a point from the segment o .. o + d. */
static double distance_from_segment(vec3 point, vec3 o, vec3 d)
{
    const vec3 from = vec3_sub(point, o);
    const double t = fmin(fmax(vec3_dot(from, d) / vec3_dot(d, d), 0.0), 1.0);
    return vec3_length(vec3_sub(from, vec3_scale(d, t)));
}

enum { CLOUD = 300 };

/* Batches of shadow rays in all directions, some parallel to an axis, through a cloud of opaque balls. None starts in a
 * ball. */
static void a_cloud_of_balls_casts_the_shadows_of_its_closed_form(void **state)
{
    (void)state;
    static ray_scratch scratch;
    static double light[ROW];
    static bundle u;
    static solid_shape ball[CLOUD];
    static region_source sources[CLOUD];
    uint64_t seed = 308;
    int blocked = 0, clear = 0;
    for (int i = 0; i < CLOUD; i++) {
        ball[i] = (solid_shape){
            .kind = SHAPE_SPHERE, .position = random_point(&seed, 2.0), .radius = random_real(&seed, 0.01, 0.2)};
        sources[i] = (region_source){.shape = &ball[i], .priority = i, .medium = 1, .opaque = true, .solid = i};
    }
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(sources, CLOUD, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    for (int trial = 0; trial < 60; trial++) {
        for (int i = 0; i < CONE; i++) {
            vec3 o, d = vec3_sub(random_point(&seed, 3.0), random_point(&seed, 3.0));
            do
                o = random_point(&seed, 3.0);
            while (scene_geometry_inside(a, o) != 0);
            d = i % 8 ? d : vec3_make(d.x, i % 16 ? -0.0 : 0.0, i % 24 ? d.z : 0.0);
            u.o[0][i] = o.x, u.o[1][i] = o.y, u.o[2][i] = o.z, u.d[0][i] = d.x, u.d[1][i] = d.y, u.d[2][i] = d.z;
            u.start[i] = FACE_NONE, u.tree[i] = 0;
        }
        const ray_batch batch = batch_of(&u, u.tree);
        for (int level = ISA_BASE; level <= (int)isa_best(); level++) {
            kernels_of((isa)level)->shadow(a, &batch, 0, &scratch, light);
            for (int i = 0; i < CONE; i++) {
                const vec3 o = vec3_make(u.o[0][i], u.o[1][i], u.o[2][i]),
                           d = vec3_make(u.d[0][i], u.d[1][i], u.d[2][i]);
                double deepest = -1.0;
                for (int k = 0; k < CLOUD; k++)
                    deepest = fmax(deepest, ball[k].radius - distance_from_segment(ball[k].position, o, d));
                assert_true(light[i] == (deepest > 0.0 ? 0.0 : 1.0) || fabs(deepest) < 1e-9);
                *(deepest > 0.0 ? &blocked : &clear) += 1;
            }
        }
    }
    assert_true(blocked > 1000 && clear > 1000);
    scene_geometry_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hits_are_those_of_direct_primitives),
        cmocka_unit_test(hits_at_coincident_faces_are_those_of_direct_primitives),
        cmocka_unit_test(hits_among_meshes_are_those_of_direct_primitives),
        cmocka_unit_test(hits_at_equal_distances_are_those_of_direct_primitives),
        cmocka_unit_test(shadows_are_those_of_direct_primitives),
        cmocka_unit_test(bundles_meet_what_they_meet_among_direct_primitives),
        cmocka_unit_test(a_ray_through_200_shells_obeys_the_law_of_bouguer),
        cmocka_unit_test(a_hundred_equal_balls_in_one_place_are_one),
        cmocka_unit_test(a_cloud_of_balls_casts_the_shadows_of_its_closed_form),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
