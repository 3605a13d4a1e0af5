/* Tests of media by priority against brute force: all crossings of all shapes in quadruple precision; between two
 * crossings the winner is that of the midpoint by definition. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "optics/interface.h"
#include "room_fixture.h"

/* Traces a line through all its interfaces, each time as a ray that starts on the last one. */
static int walk_agrees(const room *m, vec3 from, vec3 direction)
{
    const reference_line line = {quad3_from(from), quad3_from(direction)};
    change expected[SOLIDS_MAX * REFERENCE_CROSSINGS_MAX];
    const int n = changes_of(m, &line, expected);
    if (n < 0)
        return 0;
    one_ray r = {from, direction, FACE_NONE, scene_geometry_inside(m->solids, from)};
    assert_int_equal(solid_of(m, scene_geometry_priority_index(m->solids, r.inside)), winner(m, from));
    double gone = 0.0;
    for (int k = 0; k < n; k++) {
        const one_hit h = nearest_interface(m->solids, r);
        assert_true(h.hit_primitive >= 0);
        gone += h.t;
        assert_true(quad_abs(expected[k].t - gone) < (quad)1e-8);
        assert_int_equal(solid_of(m, h.before), expected[k].before);
        assert_int_equal(solid_of(m, h.after), expected[k].after);
        assert_int_equal(solid_of(m, h.surface), owner_of_surface(m, expected[k].before, expected[k].after));
        assert_true(quad3_length(quad3_sub(quad3_from(h.point), reference_at(&line, expected[k].t))) < (quad)1e-8);
        /* the sets on both sides are those of the points there */
        assert_true(h.inside_before == scene_geometry_inside(m->solids, point_at(&line, expected[k].t - (quad)1e-7)));
        assert_true(h.inside_after == scene_geometry_inside(m->solids, point_at(&line, expected[k].t + (quad)1e-7)));
        r = (one_ray){h.point, direction, h.face, h.inside_after};
    }
    assert_int_equal(nearest_interface(m->solids, r).hit_primitive, -1);
    return n + 1;
}

static void random_rooms_agree_with_brute_force(void **state)
{
    (void)state;
    uint64_t seed = 21;
    int interfaces = 0;
    for (int trial = 0; trial < 600; trial++) {
        room m;
        room_fill(&m, &seed);
        for (int k = 0; k < 12; k++)
            interfaces += walk_agrees(&m, random_point(&seed, k % 2 ? 0.7 : 4.0),
                                      random_direction(&seed)); /* also from inside solids */
        scene_geometry_destroy(m.solids);
    }
    assert_true(interfaces > 10000);
}

static void rooms_full_of_coincident_faces_agree_with_brute_force(void **state)
{
    (void)state;
    uint64_t seed = 24;
    int interfaces = 0;
    for (int trial = 0; trial < 600; trial++) {
        room m;
        room_fill_on_a_grid(&m, &seed);
        for (int k = 0; k < 12; k++)
            interfaces += walk_agrees(&m, random_point(&seed, k % 2 ? 0.7 : 4.0), random_direction(&seed));
        scene_geometry_destroy(m.solids);
    }
    assert_true(interfaces > 8000);
}

/* For rays along the grid's own planes and edges every result is valid, but the ray must end: consecutive media match,
 * and finally the ray leaves. */
static void rays_in_coincident_faces_terminate(void **state)
{
    (void)state;
    uint64_t seed = 25;
    for (int trial = 0; trial < 1000; trial++) {
        room m;
        room_fill_on_a_grid(&m, &seed);
        for (int k = 0; k < 12; k++) {
            vec3 o = vec3_make(0.125 * (random_below(&seed, 33) - 16), 0.125 * (random_below(&seed, 33) - 16),
                               0.125 * (random_below(&seed, 33) - 16));
            vec3 d = vec3_make(random_below(&seed, 3) - 1, random_below(&seed, 3) - 1, random_below(&seed, 3) - 1);
            if (vec3_dot(d, d) == 0.0)
                continue;
            one_ray r = {o, vec3_normalize(d), FACE_NONE, scene_geometry_inside(m.solids, o)};
            int64_t medium = m.solids->regions[scene_geometry_priority_index(m.solids, r.inside)].medium;
            int steps = 0;
            for (one_hit h = nearest_interface(m.solids, r); h.hit_primitive >= 0;
                 h = nearest_interface(m.solids, r), steps++) {
                assert_int_equal(m.solids->regions[h.before].medium, medium);
                assert_true(m.solids->regions[h.after].medium != medium);
                assert_true(h.t >= 0.0 && steps < WALK_MAX);
                medium = m.solids->regions[h.after].medium;
                r = (one_ray){h.point, r.d, h.face, h.inside_after};
            }
            assert_true(has_plane(&m) || medium == 0); /* no set contains a solid that the ray left long ago */
        }
        scene_geometry_destroy(m.solids);
    }
}

/* Reflects or refracts at random at every interface. Halfway to the next interface the ray is in the medium of its set,
 * unless a surface is so near that rounding decides. */
static void walk_at_random(const room *m, one_ray r, uint64_t *seed)
{
    for (int step = 0; step < 100; step++) {
        const one_hit h = nearest_interface(m->solids, r);
        if (h.hit_primitive < 0)
            return;
        vec3 middle = vec3_add(r.o, vec3_scale(r.d, 0.5 * h.t));
        quad nearest = 1;
        for (int i = 0; i < m->count; i++)
            nearest = quad_min(nearest, quad_abs(reference_distance(&m->shape[i], quad3_from(middle))));
        if (nearest > (quad)1e-12)
            assert_int_equal(medium_of(m, winner(m, middle)), m->solids->regions[h.before].medium);
        const fresnel f = fresnel_dielectric(h.cos_i, 1.0 + 0.2 * h.before, 1.0 + 0.2 * h.after);
        if (f.total || random_below(seed, 2))
            r = (one_ray){h.point, direction_reflect(r.d, h.normal, h.cos_i), h.face, h.inside_before};
        else
            r = (one_ray){h.point, direction_refract(r.d, h.normal, h.cos_i, f.eta, f.cos_t), h.face, h.inside_after};
    }
}

static void region_sets_stay_correct_on_long_walks(void **state)
{
    (void)state;
    uint64_t seed = 26;
    for (int trial = 0; trial < 1000; trial++) {
        room m;
        if (trial % 2)
            room_fill_on_a_grid(&m, &seed);
        else
            room_fill(&m, &seed);
        for (int k = 0; k < 12; k++) {
            vec3 o = random_point(&seed, 1.5);
            walk_at_random(&m, (one_ray){o, random_direction(&seed), FACE_NONE, scene_geometry_inside(m.solids, o)},
                           &seed);
        }
        scene_geometry_destroy(m.solids);
    }
}

/* All instruction sets give identical bits, for whole batches and all outputs. */
static void instruction_sets_give_bit_identical_hits(void **state)
{
    (void)state;
    static double c[6][ROW];
    static int64_t start[ROW];
    static uint64_t inside[ROW];
    static ray_scratch scratch;
    static hit_batch hits[ISA_COUNT];
    static surface_batch points[ISA_COUNT];
    static double light[ISA_COUNT][2][ROW];
    uint64_t seed = 23;
    for (int trial = 0; trial < 300; trial++) {
        room m;
        room_fill(&m, &seed);
        const int count = trial % 3 ? BATCH : 1 + random_below(&seed, BATCH);
        for (int i = 0; i < count; i++) {
            vec3 o = random_point(&seed, 3.0), d = random_direction(&seed);
            if (random_below(&seed, 5) == 0)
                d = vec3_make(0.0, random_below(&seed, 2) ? 1.0 : -1.0, -0.0);
            c[0][i] = o.x, c[1][i] = o.y, c[2][i] = o.z, c[3][i] = d.x, c[4][i] = d.y, c[5][i] = d.z;
            start[i] = random_below(&seed, 4) ? FACE_NONE : random_below(&seed, m.solids->primitive_count) * FACES_MAX;
            inside[i] = scene_geometry_inside(m.solids, o);
        }
        const ray_batch rays = {count, c[0], c[1], c[2], c[3], c[4], c[5], start, inside};
        for (int level = 0; level <= (int)isa_best(); level++) {
            const geometry_kernels *kernels = kernels_of((isa)level);
            memset(&hits[level], 0, sizeof hits[level]);
            memset(&points[level], 0, sizeof points[level]);
            memset(light[level], 0, sizeof light[level]);
            kernels->nearest(m.solids, &rays, &scratch, &hits[level]);
            kernels->surface(m.solids, 0, &rays, hits[level].t, &points[level]);
            kernels->shadow(m.solids, &rays, 0, &scratch, light[level][0]);
            kernels->shadow(m.solids, &rays, 1, &scratch, light[level][1]);
            assert_memory_equal(&hits[level], &hits[0], sizeof hits[0]);
            assert_memory_equal(light[level], light[0], sizeof light[0]);
            assert_memory_equal(points[level].px, points[0].px, (size_t)count * sizeof(double));
            assert_memory_equal(points[level].cos_i, points[0].cos_i, (size_t)count * sizeof(double));
            assert_memory_equal(points[level].face, points[0].face, (size_t)count * sizeof(int64_t));
        }
        scene_geometry_destroy(m.solids);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_rooms_agree_with_brute_force),
        cmocka_unit_test(rooms_full_of_coincident_faces_agree_with_brute_force),
        cmocka_unit_test(rays_in_coincident_faces_terminate),
        cmocka_unit_test(region_sets_stay_correct_on_long_walks),
        cmocka_unit_test(instruction_sets_give_bit_identical_hits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
