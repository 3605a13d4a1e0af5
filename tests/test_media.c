#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "random_stream.h"
#include "ray_fixture.h"
#include "solid_reference.h"

/* Media by priority against brute force: all crossings of all shapes in quadruple precision, and between each two of them the winner at
 * the midpoint by definition. */

enum { SOLIDS_MAX = 9, WALK_MAX = 64 };
#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

typedef struct room {
    int count;
    solid_shape shape[SOLIDS_MAX];
    int64_t priority[SOLIDS_MAX], medium[SOLIDS_MAX];
    int opaque[SOLIDS_MAX];
    double clearness[SOLIDS_MAX];
    arrangement *solids;
} room;

typedef struct change { quad t; int before, after; } change; /* solids' indices; -1 for none */

static void room_build(room *m)
{
    body_source sources[SOLIDS_MAX];
    for (int i = 0; i < m->count; i++)
        sources[i] = (body_source){&m->shape[i], m->priority[i], m->medium[i], m->opaque[i], m->opaque[i] ? 0.0 : m->clearness[i], i};
    assert_int_equal(arrangement_build(sources, m->count, 0, &m->solids, NULL), STATUS_OK);
}

/* The definition: the highest priority wins, of equals the one that comes first. */
static int winner(const room *m, vec3 at)
{
    int best = -1;
    for (int i = 0; i < m->count; i++)
        if (solid_shape_contains(&m->shape[i], at) && (best < 0 || m->priority[i] > m->priority[best]))
            best = i;
    return best;
}

static int64_t medium_of(const room *m, int i)
{
    return i < 0 ? 0 : m->medium[i];
}

static int solid_of(const room *m, int rank)
{
    return m->solids->bodies[rank].solid;
}

static vec3 point_at(const reference_line *line, quad t)
{
    quad3 p = reference_at(line, t);
    return vec3_make((double)p.x, (double)p.y, (double)p.z);
}

/* All t > 0 where the line crosses any shape's surface, in order. */
static int crossings_of(const room *m, const reference_line *line, quad *t)
{
    int n = 0;
    for (int i = 0; i < m->count; i++) {
        quad own[REFERENCE_CROSSINGS_MAX];
        const int found = reference_events(&m->shape[i], line, 0, own);
        for (int k = 0; k < found; k++)
            t[n++] = own[k];
    }
    reference_sort(t, n);
    return n;
}

/* Changes of the winning solid along the line; those between equal media are left out. A returned -1: two crossings so close
 * together that doubles may see them otherwise. */
static int changes_of(const room *m, const reference_line *line, change *out)
{
    quad t[SOLIDS_MAX * REFERENCE_CROSSINGS_MAX];
    const int n = crossings_of(m, line, t);
    int count = 0;
    for (int i = 0; i < n; i++) {
        const quad low = i > 0 ? t[i - 1] : 0, high = i < n - 1 ? t[i + 1] : t[i] + 1;
        if (t[i] - low < (quad)1e-6 || high - t[i] < (quad)1e-6)
            return -1;
        const int before = winner(m, point_at(line, (low + t[i]) / 2)), after = winner(m, point_at(line, (t[i] + high) / 2));
        if (medium_of(m, before) != medium_of(m, after))
            out[count++] = (change){t[i], before, after};
    }
    return count;
}

static solid_shape random_shape(uint64_t *seed)
{
    solid_shape s = {.kind = (shape_kind)random_below(seed, SHAPE_COUNT), .position = random_point(seed, 0.8)};
    if (random_below(seed, 3))
        s.rotation_deg = random_point(seed, 180.0);
    s.radius = random_real(seed, 0.3, 1.2);
    s.height = random_real(seed, 0.4, 2.0);
    s.m = random_below(seed, 2) ? 1.0 : random_real(seed, 0.5, 2.0);
    s.inner_radius = s.radius * random_real(seed, 0.4, 0.95);
    s.floor = s.height * random_real(seed, 0.05, 0.6);
    s.size = vec3_make(random_real(seed, 0.2, 2.0), random_real(seed, 0.2, 2.0), random_real(seed, 0.2, 2.0));
    return s;
}

/* Shuffled priorities with ties, a few clear media shared, some of them the surrounding one. */
static void room_fill(room *m, uint64_t *seed)
{
    m->count = 1 + random_below(seed, SOLIDS_MAX);
    for (int i = 0; i < m->count; i++) {
        m->shape[i] = random_shape(seed);
        m->priority[i] = random_below(seed, 6) - 2;
        m->opaque[i] = random_below(seed, 4) == 0;
        m->medium[i] = m->opaque[i] || random_below(seed, 3) ? i + 1 : -random_below(seed, 3);
        m->clearness[i] = random_below(seed, 3) ? random_real(seed, 0.1, 1.0) : 1.0;
    }
    room_build(m);
}

/* Follows a line through all its interfaces, each time as a ray that starts on the last one. */
static int walk_agrees(const room *m, vec3 from, vec3 direction)
{
    const reference_line line = {quad3_from(from), quad3_from(direction)};
    change wanted[SOLIDS_MAX * REFERENCE_CROSSINGS_MAX];
    const int n = changes_of(m, &line, wanted);
    if (n < 0)
        return 0;
    one_ray r = {from, direction, FACE_NONE, arrangement_inside(m->solids, from)};
    assert_int_equal(solid_of(m, arrangement_rank(m->solids, r.inside)), winner(m, from));
    double gone = 0.0;
    for (int k = 0; k < n; k++) {
        const one_hit h = nearest_interface(m->solids, r);
        assert_true(h.crossed >= 0);
        gone += h.t;
        assert_true(quad_abs(wanted[k].t - gone) < (quad)1e-8);
        assert_int_equal(solid_of(m, h.before), wanted[k].before);
        assert_int_equal(solid_of(m, h.after), wanted[k].after);
        assert_int_equal(h.surface, arrangement_surface(m->solids, h.before, h.after));
        assert_true(quad3_length(quad3_sub(quad3_from(h.point), reference_at(&line, wanted[k].t))) < (quad)1e-8);
        /* the sets on both sides are what the points there are in */
        assert_true(h.inside_before == arrangement_inside(m->solids, point_at(&line, wanted[k].t - (quad)1e-7)));
        assert_true(h.inside_after == arrangement_inside(m->solids, point_at(&line, wanted[k].t + (quad)1e-7)));
        r = (one_ray){h.point, direction, h.face, h.inside_after};
    }
    assert_int_equal(nearest_interface(m->solids, r).crossed, -1);
    return n + 1;
}

static void random_rooms_agree_with_brute_force(void **state)
{
    (void)state;
    uint64_t seed = 21;
    int interfaces = 0;
    for (int trial = 0; trial < 1200; trial++) {
        room m;
        room_fill(&m, &seed);
        for (int k = 0; k < 12; k++)
            interfaces += walk_agrees(&m, random_point(&seed, k % 2 ? 0.7 : 4.0), random_direction(&seed)); /* also from inside solids */
        arrangement_destroy(m.solids);
    }
    assert_true(interfaces > 20000);
}

/* From 0 to 1: the product of what each interface lets through, by the body of the higher rank; opaque matter lets nothing. */
static double light_by_marching(const room *m, const reference_line *line, int solid_shadows)
{
    change met[SOLIDS_MAX * REFERENCE_CROSSINGS_MAX];
    const int n = changes_of(m, line, met);
    double light = 1.0;
    for (int k = 0; k < n && met[k].t < 1; k++) {
        const int a = met[k].before, b = met[k].after;
        if (solid_shadows || (a >= 0 && m->opaque[a]) || (b >= 0 && m->opaque[b]))
            return 0.0;
        const int higher = a < 0 ? b : b < 0 ? a : m->priority[a] != m->priority[b] ? (m->priority[a] > m->priority[b] ? a : b) : a < b ? a : b;
        light *= m->clearness[higher];
    }
    return n < 0 ? -1.0 : light;
}

static void shadows_agree_with_marching(void **state)
{
    (void)state;
    uint64_t seed = 22;
    int partly = 0, dark = 0, lit = 0;
    for (int trial = 0; trial < 1200; trial++) {
        room m;
        room_fill(&m, &seed);
        for (int k = 0; k < 12; k++) {
            vec3 from = random_point(&seed, 3.0), to = random_point(&seed, 5.0);
            if (winner(&m, from) >= 0 && m.opaque[winner(&m, from)])
                continue; /* no light falls on a point within opaque matter */
            one_ray r = {from, vec3_sub(to, from), FACE_NONE, arrangement_inside(m.solids, from)};
            const reference_line line = {quad3_from(r.o), quad3_from(r.d)};
            const double wanted = light_by_marching(&m, &line, k % 2), got = light_through(m.solids, r, k % 2);
            if (wanted < 0.0)
                continue;
            assert_true(fabs(got - wanted) <= 1e-15);
            partly += wanted > 0.0 && wanted < 1.0;
            dark += wanted == 0.0;
            lit += wanted == 1.0;
        }
        arrangement_destroy(m.solids);
    }
    assert_true(partly > 500 && dark > 1000 && lit > 1000);
}

/* An opaque cup: light comes in by its open top and through nothing else. */
static void light_enters_an_opaque_cup_from_above(void **state)
{
    (void)state;
    room m = {.count = 1, .opaque = {1}, .medium = {1}};
    m.shape[0] = (solid_shape){.kind = SHAPE_CUP, .radius = 1.0, .inner_radius = 0.9, .height = 3.0, .floor = 0.1};
    room_build(&m);
    const vec3 floor_point = vec3_make(0.0, 0.1, 0.0);
    const uint64_t inside = arrangement_inside(m.solids, vec3_make(0.0, 0.2, 0.0));
    const int64_t floor_face = FACES_MAX + 1;
    for (int k = 0; k <= 100; k++) {
        const double slope = k * 0.01; /* the lamp is 29 high above the floor; the rim stands 2.9 high at 0.9 */
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
    arrangement_destroy(m.solids);
}

/* The same bits from all instruction sets, whole batches, all outputs. */
static void instruction_sets_agree_to_the_bit(void **state)
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
            inside[i] = arrangement_inside(m.solids, o);
        }
        const ray_batch rays = {count, c[0], c[1], c[2], c[3], c[4], c[5], start, inside};
        for (int level = 0; level <= (int)isa_best(); level++) {
            const geometry_kernels *kernels = kernels_of((isa)level);
            memset(&hits[level], 0, sizeof hits[level]);
            memset(&points[level], 0, sizeof points[level]);
            memset(light[level], 0, sizeof light[level]);
            kernels->nearest(m.solids, &rays, &scratch, &hits[level]);
            kernels->surface(&m.solids->primitives[0], &rays, hits[level].t, 0, &points[level]);
            kernels->shadow(m.solids, &rays, 0, &scratch, light[level][0]);
            kernels->shadow(m.solids, &rays, 1, &scratch, light[level][1]);
            assert_memory_equal(&hits[level], &hits[0], sizeof hits[0]);
            assert_memory_equal(light[level], light[0], sizeof light[0]);
            assert_memory_equal(points[level].px, points[0].px, (size_t)count * sizeof(double));
            assert_memory_equal(points[level].cos_i, points[0].cos_i, (size_t)count * sizeof(double));
            assert_memory_equal(points[level].face, points[0].face, (size_t)count * sizeof(int64_t));
        }
        arrangement_destroy(m.solids);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_rooms_agree_with_brute_force),
        cmocka_unit_test(shadows_agree_with_marching),
        cmocka_unit_test(light_enters_an_opaque_cup_from_above),
        cmocka_unit_test(instruction_sets_agree_to_the_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
