/* Tests of media by priority, among analytic solids and meshes, and of shadow rays, against brute force. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "mesh_room.h"
#include "optics/interface.h"
#include "room_fixture.h"

/* Media by priority against brute force: all crossings of all shapes in quadruple precision; between two
 * crossings the winner is that of the midpoint by definition. */

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

/* Meshes among analytic solids, by priority, against brute force: every crossing of every triangle and shape;
 * between two crossings the winner is that of the midpoint by definition. test_media.c does the same without meshes. */

typedef struct walks {
    int interfaces, skipped, seen_meshes, hidden_meshes;
} walks;

static void mesh_walk_agrees(const mesh_room *m, vec3 from, vec3 direction, walks *sum)
{
    const reference_line line = {quad3_from(from), quad3_from(direction)};
    const scene_geometry *a = m->r.solids;
    change expected[ROOM_CROSSINGS_MAX];
    const int n = changes_in_room(m, &line, expected);
    if (n < 0) {
        sum->skipped++;
        return;
    }
    one_ray r = {from, direction, FACE_NONE, scene_geometry_inside(a, from)};
    assert_int_equal(solid_of(&m->r, scene_geometry_priority_index(a, r.inside)), winner_in_room(m, from));
    double gone = 0.0;
    for (int k = 0; k < n; k++) {
        const one_hit h = nearest_interface(a, r);
        assert_true(h.hit_primitive >= 0);
        gone += h.t;
        assert_true(quad_abs(expected[k].t - gone) < (quad)1e-8);
        assert_int_equal(solid_of(&m->r, h.before), expected[k].before);
        assert_int_equal(solid_of(&m->r, h.after), expected[k].after);
        assert_int_equal(solid_of(&m->r, h.surface), owner_of_surface(&m->r, expected[k].before, expected[k].after));
        assert_true(quad3_length(quad3_sub(quad3_from(h.point), reference_at(&line, expected[k].t))) < (quad)1e-8);
        assert_true(h.inside_before == scene_geometry_inside(a, point_at(&line, expected[k].t - (quad)1e-7)));
        assert_true(h.inside_after == scene_geometry_inside(a, point_at(&line, expected[k].t + (quad)1e-7)));
        sum->seen_meshes += is_mesh_face(h.face);
        r = (one_ray){h.point, direction, h.face, h.inside_after};
    }
    assert_int_equal(nearest_interface(a, r).hit_primitive, -1);
    sum->interfaces += n + 1;
}

static walks walk_random_rooms(int trials, uint64_t seed, bool on_a_grid)
{
    walks sum = {0, 0, 0, 0};
    for (int trial = 0; trial < trials; trial++) {
        mesh_room m;
        mesh_room_fill(&m, &seed, on_a_grid);
        for (int k = 0; k < 12; k++)
            mesh_walk_agrees(&m, random_point(&seed, k % 2 ? 0.9 : 4.0), random_direction(&seed), &sum);
        mesh_room_empty(&m);
    }
    return sum;
}

static void rooms_with_meshes_agree_with_brute_force(void **state)
{
    (void)state;
    const walks sum = walk_random_rooms(440, 41, false);
    assert_true(sum.interfaces > 8000 && sum.seen_meshes > 3000 && sum.skipped < 200);
}

static void mesh_boxes_with_coincident_faces_agree_with_brute_force(void **state)
{
    (void)state;
    const walks sum = walk_random_rooms(500, 42, true);
    assert_true(sum.interfaces > 5000 && sum.seen_meshes > 2000 && sum.skipped < 2500);
}

/* For rays along faces and edges every result is valid, but the ray must end: consecutive media match. A ray that is
 * restarted each time may hit the two sides of an edge in turn, at one position. */
static void rays_in_coincident_mesh_faces_terminate(void **state)
{
    (void)state;
    uint64_t seed = 43;
    int rays = 0, stuck = 0;
    for (int trial = 0; trial < 500; trial++) {
        mesh_room m;
        mesh_room_fill(&m, &seed, true);
        const scene_geometry *a = m.r.solids;
        for (int k = 0; k < 12; k++) {
            const vec3 o = vec3_make(0.125 * (random_below(&seed, 33) - 16), 0.125 * (random_below(&seed, 33) - 16),
                                     0.125 * (random_below(&seed, 33) - 16));
            const vec3 d =
                vec3_make(random_below(&seed, 3) - 1, random_below(&seed, 3) - 1, random_below(&seed, 3) - 1);
            if (vec3_dot(d, d) == 0.0)
                continue;
            one_ray r = {o, vec3_normalize(d), FACE_NONE, scene_geometry_inside(a, o)};
            int64_t medium = a->regions[scene_geometry_priority_index(a, r.inside)].medium;
            int steps = 0, standing = 0;
            for (one_hit h = nearest_interface(a, r); h.hit_primitive >= 0; h = nearest_interface(a, r), steps++) {
                assert_int_equal(a->regions[h.before].medium, medium);
                assert_true(a->regions[h.after].medium != medium);
                assert_true(h.t >= 0.0 && steps < WALK_MAX);
                standing = h.t < 1e-12 ? standing + 1 : 0;
                rays += steps == 0, stuck += standing == 3;
                if (standing == 3)
                    break;
                medium = a->regions[h.after].medium;
                r = (one_ray){h.point, r.d, h.face, h.inside_after};
            }
        }
        mesh_room_empty(&m);
    }
    assert_true(rays > 1000 && stuck * 10 < rays);
}

/* Is a point farther than the given distance from every triangle's bounding box and every shape's surface? A fast,
 * conservative test. */
static bool is_clear_of_surfaces(const mesh_room *m, vec3 at)
{
    for (int i = 0; i < m->r.count; i++) {
        if (!m->mesh_solid[i] && !(quad_abs(reference_distance(&m->r.shape[i], quad3_from(at))) > (quad)1e-12))
            return false;
        for (size_t k = 0; m->mesh_solid[i] && k < m->count[i]; k++) {
            const vec3 *v = (const vec3 *)m->triangle[i][k], n = vec3_cross(vec3_sub(v[1], v[0]), vec3_sub(v[2], v[0]));
            if (!(fabs(vec3_dot(n, vec3_sub(at, v[0]))) > 1e-11 * vec3_length(n)))
                return false;
        }
    }
    return true;
}

/* Reflects or refracts at random at every interface: halfway to the next one the ray is in the medium of its set. */
static void mesh_walk_at_random(const mesh_room *m, one_ray r, uint64_t *seed, int *checked)
{
    const scene_geometry *a = m->r.solids;
    for (int step = 0; step < 60; step++) {
        const one_hit h = nearest_interface(a, r);
        if (h.hit_primitive < 0)
            return;
        const vec3 middle = vec3_add(r.o, vec3_scale(r.d, 0.5 * h.t));
        if (is_clear_of_surfaces(m, middle)) {
            assert_int_equal(medium_of(&m->r, winner_in_room(m, middle)), a->regions[h.before].medium);
            ++*checked;
        }
        const fresnel f = fresnel_dielectric(h.cos_i, 1.0 + 0.2 * h.before, 1.0 + 0.2 * h.after);
        if (f.total || random_below(seed, 2))
            r = (one_ray){h.point, direction_reflect(r.d, h.normal, h.cos_i), h.face, h.inside_before};
        else
            r = (one_ray){h.point, direction_refract(r.d, h.normal, h.cos_i, f.eta, f.cos_t), h.face, h.inside_after};
    }
}

static void region_sets_stay_correct_on_long_walks_among_meshes(void **state)
{
    (void)state;
    uint64_t seed = 44;
    int checked = 0;
    for (int trial = 0; trial < 600; trial++) {
        mesh_room m;
        mesh_room_fill(&m, &seed, trial % 2 == 0);
        for (int k = 0; k < 8; k++) {
            const vec3 o = random_point(&seed, 1.5);
            mesh_walk_at_random(&m,
                                (one_ray){o, random_direction(&seed), FACE_NONE, scene_geometry_inside(m.r.solids, o)},
                                &seed, &checked);
        }
        mesh_room_empty(&m);
    }
    assert_true(checked > 10000);
}

/* By definition: the product of the higher solid's transmittance at each change of medium, and 0 through opaque
 * solids. */
static double light_by_definition(const mesh_room *m, const change *changes, int count, quad end, int start,
                                  bool solid_shadows)
{
    double share = is_opaque(&m->r, start) ? 0.0 : 1.0;
    for (int k = 0; k < count && changes[k].t < end; k++) {
        const int before = changes[k].before, after = changes[k].after;
        const bool blocked = solid_shadows || is_opaque(&m->r, before) || is_opaque(&m->r, after);
        share *= blocked ? 0.0 : m->r.shadow_transmittance[higher_of(&m->r, before, after)];
    }
    return share;
}

static void shadow_rays_among_meshes_agree_with_brute_force(void **state)
{
    (void)state;
    uint64_t seed = 45;
    int lit = 0, dark = 0, between = 0;
    for (int trial = 0; trial < 400; trial++) {
        mesh_room m;
        mesh_room_fill(&m, &seed, trial % 2 == 0);
        for (int k = 0; k < 16; k++) {
            const vec3 o = random_point(&seed, 1.6), to = random_point(&seed, k % 2 ? 1.0 : 4.0), d = vec3_sub(to, o);
            const reference_line line = {quad3_from(o), quad3_from(d)};
            change changes[ROOM_CROSSINGS_MAX];
            const int n = changes_in_room(&m, &line, changes), start = winner_in_room(&m, o);
            if (n < 0 || is_opaque(&m.r, start))
                continue;
            const one_ray r = {o, d, FACE_NONE, scene_geometry_inside(m.r.solids, o)};
            for (int solid = 0; solid < 2; solid++) {
                const double expected = light_by_definition(&m, changes, n, 1, start, solid),
                             got = light_through(m.r.solids, r, solid);
                assert_true(fabs(expected - got) < 1e-12);
                lit += expected == 1.0, dark += expected == 0.0, between += expected > 0.0 && expected < 1.0;
            }
        }
        mesh_room_empty(&m);
    }
    assert_true(lit > 500 && dark > 500 && between > 100);
}

static void instruction_sets_give_bit_identical_hits_on_meshes(void **state)
{
    (void)state;
    static double c[6][ROW];
    static int64_t start[ROW];
    static uint64_t inside[ROW];
    static ray_scratch scratch;
    static mesh_scratch meshes[ISA_COUNT];
    static hit_batch hits[ISA_COUNT];
    static double light[ISA_COUNT][2][ROW];
    uint64_t seed = 46;
    for (int trial = 0; trial < 200; trial++) {
        mesh_room m;
        mesh_room_fill(&m, &seed, trial % 4 == 0);
        const int count = trial % 3 ? BATCH : 1 + random_below(&seed, BATCH);
        for (int i = 0; i < count; i++) {
            const vec3 o = random_point(&seed, 3.0), d = random_direction(&seed);
            c[0][i] = o.x, c[1][i] = o.y, c[2][i] = o.z, c[3][i] = d.x, c[4][i] = d.y, c[5][i] = d.z;
            start[i] = FACE_NONE;
            inside[i] = scene_geometry_inside(m.r.solids, o);
        }
        const ray_batch rays = {count, c[0], c[1], c[2], c[3], c[4], c[5], start, inside};
        memset(meshes, 0, sizeof meshes);
        for (int level = 0; level <= (int)isa_best(); level++) {
            const geometry_kernels *kernels = kernels_of((isa)level);
            memset(&hits[level], 0, sizeof hits[level]);
            memset(light[level], 0, sizeof light[level]);
            scratch.meshes = &meshes[level];
            kernels->nearest(m.r.solids, &rays, &scratch, &hits[level]);
            for (int i = 0; i < count && level > 0; i++) {
                if (hits[0].hit_primitive[i] < 0 || m.r.solids->primitives[hits[0].hit_primitive[i]].rule)
                    continue;
                assert_int_equal(meshes[level].hit[i].face, meshes[0].hit[i].face);
                assert_memory_equal(&meshes[level].hit[i].u, &meshes[0].hit[i].u, 2 * sizeof(double));
            }
            kernels->shadow(m.r.solids, &rays, 0, &scratch, light[level][0]);
            kernels->shadow(m.r.solids, &rays, 1, &scratch, light[level][1]);
            assert_memory_equal(&hits[level], &hits[0], sizeof hits[0]);
            assert_memory_equal(light[level], light[0], sizeof light[0]);
        }
        mesh_room_empty(&m);
    }
}

/* Shadow rays against marching from interface to interface. */

/* The product of the transmittances of the interfaces, 0 to 1, each of the region with the higher priority; opaque
 * regions transmit nothing. */
static double light_by_marching(const room *m, const reference_line *line, int solid_shadows)
{
    change changes[SOLIDS_MAX * REFERENCE_CROSSINGS_MAX];
    const int n = changes_of(m, line, changes);
    double light = 1.0;
    for (int k = 0; k < n && changes[k].t < 1; k++) {
        if (solid_shadows || is_opaque(m, changes[k].before) || is_opaque(m, changes[k].after))
            return 0.0;
        light *= m->shadow_transmittance[higher_of(m, changes[k].before, changes[k].after)];
    }
    return n < 0 ? -1.0 : light;
}

static void shadows_agree_with_marching(void **state)
{
    (void)state;
    uint64_t seed = 22;
    int partly = 0, dark = 0, lit = 0;
    for (int trial = 0; trial < 800; trial++) {
        room m;
        room_fill(&m, &seed);
        for (int k = 0; k < 12; k++) {
            vec3 from = random_point(&seed, 3.0), to = random_point(&seed, 5.0);
            if (winner(&m, from) >= 0 && m.opaque[winner(&m, from)])
                continue; /* no light reaches a point inside an opaque solid */
            one_ray r = {from, vec3_sub(to, from), FACE_NONE, scene_geometry_inside(m.solids, from)};
            const reference_line line = {quad3_from(r.o), quad3_from(r.d)};
            const double expected = light_by_marching(&m, &line, k % 2), got = light_through(m.solids, r, k % 2);
            if (expected < 0.0)
                continue;
            assert_true(fabs(got - expected) <= 1e-15);
            partly += expected > 0.0 && expected < 1.0;
            dark += expected == 0.0;
            lit += expected == 1.0;
        }
        scene_geometry_destroy(m.solids);
    }
    assert_true(partly > 300 && dark > 600 && lit > 600);
}

/* An opaque cup: light enters only through its open top. */
static void light_enters_an_opaque_cup_from_above(void **state)
{
    (void)state;
    room m = {.count = 1, .opaque = {1}, .medium = {1}};
    m.shape[0] =
        (solid_shape){.kind = SHAPE_CUP, .m = 1.0, .radius = 1.0, .inner_radius = 0.9, .height = 3.0, .floor = 0.1};
    room_build(&m);
    const vec3 floor_point = vec3_make(0.0, 0.1, 0.0);
    const uint64_t inside = scene_geometry_inside(m.solids, vec3_make(0.0, 0.2, 0.0));
    const int64_t floor_face = FACES_MAX + 1;
    for (int k = 0; k <= 100; k++) {
        const double slope = k * 0.01; /* the lamp is 29 above the floor; the rim is 2.9 above it at 0.9 */
        one_ray r = {floor_point, vec3_make(29.0 * slope, 29.0, 0.0), floor_face, inside};
        if (fabs(slope - 0.9 / 2.9) > 1e-9)
            assert_true(light_through(m.solids, r, 0) == (slope < 0.9 / 2.9 ? 1.0 : 0.0));
    }
    one_ray below = {vec3_make(0.5, -1.0, 0.0), vec3_make(0.0, 10.0, 0.0), FACE_NONE, 0};
    assert_true(light_through(m.solids, below, 0) == 0.0); /* through the bottom */
    one_ray across = {vec3_make(-2.0, 1.0, 0.0), vec3_make(4.0, 0.0, 0.0), FACE_NONE, 0};
    assert_true(light_through(m.solids, across, 0) == 0.0);
    across.o.y = 3.5;
    assert_true(light_through(m.solids, across, 0) == 1.0);
    across.o.y = 1.0;
    across.d.x = 0.99; /* the lamp is in front of the wall */
    assert_true(light_through(m.solids, across, 0) == 1.0);
    scene_geometry_destroy(m.solids);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_rooms_agree_with_brute_force),
        cmocka_unit_test(rooms_full_of_coincident_faces_agree_with_brute_force),
        cmocka_unit_test(rays_in_coincident_faces_terminate),
        cmocka_unit_test(region_sets_stay_correct_on_long_walks),
        cmocka_unit_test(instruction_sets_give_bit_identical_hits),
        cmocka_unit_test(rooms_with_meshes_agree_with_brute_force),
        cmocka_unit_test(mesh_boxes_with_coincident_faces_agree_with_brute_force),
        cmocka_unit_test(rays_in_coincident_mesh_faces_terminate),
        cmocka_unit_test(region_sets_stay_correct_on_long_walks_among_meshes),
        cmocka_unit_test(shadow_rays_among_meshes_agree_with_brute_force),
        cmocka_unit_test(instruction_sets_give_bit_identical_hits_on_meshes),
        cmocka_unit_test(shadows_agree_with_marching),
        cmocka_unit_test(light_enters_an_opaque_cup_from_above),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
