/* Open meshes are closed: vertices joined, triangles dropped and turned, holes filled. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

#include "geometry/mesh/mesh_generators.h"
#include "mesh_fixture.h"
#include "random_stream.h"

static mesh *finished(mesh *m)
{
    diagnostic why = {0};
    if (mesh_finish(m, &why) != STATUS_OK)
        fail_msg("%s", why.what);
    return m;
}

/* Consumes m. The caller frees repairs->fills. */
static mesh *repaired(mesh *m, double weld, mesh_repairs *repairs)
{
    mesh *out = NULL;
    diagnostic why = {0};
    if (mesh_repair(m, weld, repairs, &out, &why) != STATUS_OK)
        fail_msg("%s; %s", why.what, why.remedy);
    assert_true(out->closed);
    mesh_release(m);
    return out;
}

static void without(mesh *m, size_t triangle)
{
    m->triangles[triangle] = m->triangles[--m->triangle_count];
}

static mesh *sphere_of(int level)
{
    mesh *m = NULL;
    assert_int_equal(generate_icosphere(level, &m, NULL), STATUS_OK);
    return m;
}

/* The vertices of a soup of triangles, each its own, moved by up to `off`. */
static mesh *soup_of(const mesh *m, double off, uint64_t seed)
{
    mesh *soup = NULL;
    assert_int_equal(mesh_create(3 * m->triangle_count, m->triangle_count, false, false, false, &soup, NULL),
                     STATUS_OK);
    for (size_t i = 0; i < soup->vertex_count; i++) {
        soup->vertices[i] = vec3_add(m->vertices[m->triangles[i / 3].corner[i % 3]], random_point(&seed, off));
        soup->triangles[i / 3].corner[i % 3] = (uint32_t)i;
    }
    return soup;
}

static void a_closed_mesh_stays_as_it_is(void **state)
{
    (void)state;
    mesh_repairs r;
    mesh *m = repaired(finished(cubes(2)), 0.0, &r);
    assert_int_equal(r.welded + r.degenerate + r.duplicate + r.turned + r.holes + r.triangles, 0);
    assert_int_equal(m->triangle_count, 24);
    assert_true(fabs(mesh_volume(m) - 16.0) < 1e-12);
    free(r.fills);
    mesh_release(m);
}

/* Each corner of the sphere is several vertices a little apart. */
static void a_soup_is_welded(void **state)
{
    (void)state;
    mesh *ball = sphere_of(3);
    const double volume = mesh_volume(ball), least = 0.1; /* half the length of an edge */
    mesh_repairs r;
    mesh *m = repaired(finished(soup_of(ball, 1e-4, 3)), least / 8, &r);
    assert_int_equal(m->vertex_count, 10 * 64 + 2);
    assert_int_equal(m->triangle_count, 20 * 64);
    assert_int_equal(r.welded, 3 * 20 * 64 - (10 * 64 + 2));
    assert_int_equal(r.holes, 0);
    assert_true(fabs(mesh_volume(m) - volume) < 1e-3);
    free(r.fills);
    mesh_release(m);
    mesh_release(ball);
}

/* Welding by a grid equals welding by trying all earlier vertices. */
static void the_first_vertex_within_the_distance_is_taken(void **state)
{
    (void)state;
    mesh *ball = sphere_of(1), *soup = finished(soup_of(ball, 0.05, 4));
    const double weld = 0.08;
    int choices = 0; /* vertices with two that were kept within the distance */
    vec3 *expected = calloc(soup->vertex_count, sizeof *expected);
    bool *kept = calloc(soup->vertex_count, sizeof *kept);
    for (size_t v = 0; v < soup->vertex_count; v++) {
        size_t at = 0;
        while (at < v && !(kept[at] && vec3_length(vec3_sub(soup->vertices[at], soup->vertices[v])) <= weld))
            at++;
        kept[v] = at == v;
        expected[v] = soup->vertices[at];
        for (at++; at < v; at++)
            choices += kept[at] && vec3_length(vec3_sub(soup->vertices[at], soup->vertices[v])) <= weld;
    }
    assert_true(choices > 10);
    mesh_repairs r;
    mesh *m = NULL;
    assert_int_equal(mesh_repair(soup, weld, &r, &m, NULL), STATUS_OK);
    assert_int_equal(r.degenerate + r.duplicate + r.turned, 0);
    for (size_t t = 0; t < soup->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            const vec3 p = m->vertices[m->triangles[t].corner[k]], q = expected[3 * t + (size_t)k];
            assert_true(p.x == q.x && p.y == q.y && p.z == q.z);
        }
    free(r.fills);
    free(expected);
    free(kept);
    mesh_release(m);
    mesh_release(soup);
    mesh_release(ball);
}

static void triangles_are_dropped(void **state)
{
    (void)state;
    mesh *m = NULL, *c = cubes(1);
    assert_int_equal(mesh_create(8, 15, false, false, false, &m, NULL), STATUS_OK);
    memcpy(m->vertices, c->vertices, 8 * sizeof *m->vertices);
    memcpy(m->triangles, c->triangles, 12 * sizeof *m->triangles);
    m->triangles[0] = m->triangles[12] = (mesh_triangle){{3, 3, 5}}; /* and a hole */
    m->triangles[13] = c->triangles[7];
    m->triangles[14] =
        (mesh_triangle){{c->triangles[7].corner[1], c->triangles[7].corner[0], c->triangles[7].corner[2]}};
    mesh_release(c);
    mesh_repairs r;
    m = repaired(finished(m), 0.0, &r);
    assert_int_equal(r.degenerate, 2);
    assert_int_equal(r.duplicate, 2);
    assert_int_equal(r.holes, 1);
    assert_int_equal(m->triangle_count, 12);
    free(r.fills);
    mesh_release(m);
}

/* Triangles of an open mesh with random directions. */
static void triangles_are_turned_to_agree(void **state)
{
    (void)state;
    uint64_t seed = 5;
    mesh *m = sphere_of(3);
    const double volume = mesh_volume(m);
    without(m, 100);
    for (size_t t = 0; t < m->triangle_count; t++)
        if (random_below(&seed, 3) == 0)
            turn_triangle(m, t);
    mesh_repairs r;
    m = repaired(finished(m), 0.0, &r);
    assert_int_equal(r.holes, 1);
    assert_int_equal(r.fills[0].edges, 3);
    assert_true(r.turned > 300 && r.turned < 550);
    assert_true(fabs(mesh_volume(m) - volume) < 1e-12);
    free(r.fills);
    mesh_release(m);
}

/* A cube without its front, and without two neighbouring triangles of other faces: the volume is whole again. */
static void a_flat_hole_is_filled_flat(void **state)
{
    (void)state;
    mesh *m = cubes(1);
    without(m, 1);
    without(m, 0);
    mesh_repairs r;
    m = repaired(finished(m), 0.0, &r);
    assert_int_equal(r.holes, 1);
    assert_int_equal(r.fills[0].edges, 4);
    assert_true(r.fills[0].span == 2.0);
    assert_int_equal(r.triangles, 2);
    assert_true(fabs(mesh_volume(m) - 8.0) < 1e-12 && fabs(mesh_area(m) - 24.0) < 1e-12);
    free(r.fills);
    mesh_release(m);
}

/* The star-shaped end of a prism: concave, so that the least area is the star's own. */
static void a_concave_hole_is_filled_within_its_border(void **state)
{
    (void)state;
    enum { N = 14 };
    mesh *m = NULL;
    assert_int_equal(mesh_create(2 * N, 2 * N, false, false, false, &m, NULL), STATUS_OK);
    double area = 0.0;
    for (int i = 0; i < N; i++) {
        const double turn = 2.0 * 3.141592653589793 * i / N, radius = i % 2 ? 1.0 : 0.3;
        m->vertices[i] = vec3_make(radius * cos(turn), radius * sin(turn), 0.0);
        m->vertices[N + i] = vec3_add(m->vertices[i], vec3_make(0.0, 0.0, 2.0));
        m->triangles[2 * i] = (mesh_triangle){{(uint32_t)i, (uint32_t)((i + 1) % N), (uint32_t)(N + i)}};
        m->triangles[2 * i + 1] =
            (mesh_triangle){{(uint32_t)((i + 1) % N), (uint32_t)(N + (i + 1) % N), (uint32_t)(N + i)}};
        area += 0.5 * 0.3 * 1.0 * sin(2.0 * 3.141592653589793 / N);
    }
    const double side = mesh_area(m);
    mesh_repairs r;
    m = repaired(finished(m), 0.0, &r);
    assert_int_equal(r.holes, 2);
    assert_true(fabs(mesh_volume(m) - 2.0 * area) < 1e-12);
    assert_true(fabs(mesh_area(m) - side - 2.0 * area) < 1e-12);
    free(r.fills);
    mesh_release(m);
}

/* More corners than are triangulated: a vertex in the middle. */
static void a_large_hole_is_filled_around_its_middle(void **state)
{
    (void)state;
    const profile_point tube[] = {{1.0, 0.0}, {1.0, 3.0}};
    mesh *m = NULL;
    assert_int_equal(generate_lathe(tube, 2, 500, 30.0, &m, NULL), STATUS_OK);
    mesh_repairs r;
    m = repaired(m, 0.0, &r);
    assert_int_equal(r.holes, 2);
    assert_int_equal(r.fills[0].edges, 500);
    assert_int_equal(r.triangles, 1000);
    const double expected = 3.0 * 0.5 * 500 * sin(2.0 * 3.141592653589793 / 500);
    assert_true(fabs(mesh_volume(m) - expected) < 1e-9);
    assert_non_null(m->normals);
    for (size_t t = m->triangle_count - 1000; t < m->triangle_count; t++) /* the caps have normals of their own */
        assert_true(fabs(m->normals[m->triangles[t].corner[0]].y) > 0.999);
    free(r.fills);
    mesh_release(m);
}

/* Two holes that meet in a corner, and a hole whose only diagonals are edges of the mesh. */
static void holes_that_meet_are_filled(void **state)
{
    (void)state;
    mesh *m = sphere_of(2);
    const uint32_t shared = m->triangles[7].corner[0];
    size_t around[6], count = 0;
    for (size_t t = 0; t < m->triangle_count && count < 6; t++)
        for (int k = 0; k < 3; k++)
            if (m->triangles[t].corner[k] == shared)
                around[count++] = t;
    without(m, around[count - 1]);
    without(m, around[0]);
    mesh_repairs r;
    m = repaired(finished(m), 0.0, &r);
    assert_true(r.holes == 1 || r.holes == 2);
    assert_int_equal(m->triangle_count, 320);
    free(r.fills);
    mesh_release(m);
    m = cubes(1); /* without all but the two triangles of one face: its border is filled by both, turned over */
    m->triangle_count = 2;
    m->vertices[3].z -= 1.0; /* not flat */
    m = repaired(finished(m), 0.0, &r);
    assert_int_equal(r.fills[0].edges, 4);
    free(r.fills);
    mesh_release(m);
}

/* Two pyramids whose square bases are divided by one diagonal: four triangles meet there, as where a reader divides two
 * quadrilaterals between the same corners. A hole keeps the mesh from being closed as it is. */
static void two_divisions_by_one_diagonal_are_made_different(void **state)
{
    (void)state;
    static const vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, -1, 1}, {0.4, 3, -2}};
    /* the quadrilaterals 0 1 2 3 and 0 4 2 5, and sides between them */
    static const mesh_triangle list[] = {{{0, 1, 2}}, {{0, 2, 3}}, {{0, 4, 2}}, {{0, 2, 5}},
                                         {{1, 0, 4}}, {{2, 1, 4}}, {{0, 3, 5}}, {{3, 2, 5}}};
    for (size_t count = 7; count <= 8; count++) {
        mesh *m = finished(mesh_of(corners, 6, list, count));
        assert_int_equal(m->closed, count == 8);
        mesh_repairs r;
        mesh *out = NULL;
        assert_int_equal(mesh_repair(m, 0.0, &r, &out, NULL), STATUS_OK);
        assert_true(out->closed);
        assert_int_equal(out->crowded, count == 8);
        assert_int_equal(r.swapped, count == 8 ? 0 : 1);
        assert_int_equal(r.holes, count == 8 ? 0 : 1);
        assert_int_equal(out->triangle_count, 8);
        free(r.fills);
        mesh_release(out);
        mesh_release(m);
    }
}

/* Two holes whose least areas have one diagonal: the other one is an edge of each: the second hole
 * is filled around its middle. */
static void a_diagonal_is_used_once(void **state)
{
    (void)state;
    static const vec3 corners[] = {{0.4, 0.4, 0}, {1, 0, 1}, {0.6, 0.6, 0}, {0, 1, 1}, {1, 0, -1}, {0, 1, -1.5}};
    static const mesh_triangle list[] = {{{1, 0, 4}}, {{2, 1, 4}}, {{0, 3, 5}}, {{3, 2, 5}}};
    mesh_repairs r;
    mesh *m = repaired(finished(mesh_of(corners, 6, list, 4)), 0.0, &r);
    assert_int_equal(r.holes, 2);
    assert_int_equal(m->triangle_count, 4 + 2 + 4);
    assert_false(m->crowded);
    free(r.fills);
    mesh_release(m);
}

/* What vertices and triangles have stays; a filled hole has the material of a neighbour. */
static void attributes_are_kept(void **state)
{
    (void)state;
    uint64_t seed = 9;
    mesh *m = NULL, *c = cubes(1);
    assert_int_equal(mesh_create(8, 11, true, true, true, &m, NULL), STATUS_OK);
    memcpy(m->vertices, c->vertices, 8 * sizeof *m->vertices);
    memcpy(m->triangles, c->triangles, 11 * sizeof *m->triangles); /* without half of the face x = 1 */
    mesh_release(c);
    m->slot_count = 9;
    assert_non_null(m->slot_names[3] = strdup("glass"));
    for (size_t v = 0; v < 8; v++) {
        m->normals[v] = random_point(&seed, 1.0);
        m->uvs[v] = (mesh_uv){random_real(&seed, 0.0, 1.0), (double)v};
    }
    for (size_t t = 0; t < 11; t++)
        m->slots[t] = (uint8_t)(1 + random_below(&seed, 8));
    finished(m);
    mesh_retain(m);
    mesh_repairs r;
    mesh *out = repaired(m, 0.0, &r);
    assert_int_equal(out->slot_count, 9);
    assert_string_equal(out->slot_names[3], "glass");
    assert_int_equal(out->triangle_count, 12);
    assert_true(r.fills[0].span == 2.0); /* along y and z */
    for (size_t t = 0; t < 11; t++) {
        assert_int_equal(out->slots[t], m->slots[t]);
        for (int k = 0; k < 3; k++) {
            const uint32_t v = out->triangles[t].corner[k], w = m->triangles[t].corner[k];
            assert_memory_equal(&out->vertices[v], &m->vertices[w], sizeof(vec3));
            assert_true(vec3_length(vec3_sub(out->normals[v], m->normals[w])) < 1e-15);
            assert_memory_equal(&out->uvs[v], &m->uvs[w], sizeof(mesh_uv));
        }
    }
    bool neighbour = false;
    for (size_t t = 0; t < 11; t++) /* two corners on the filled triangle */
        for (int i = 0, common = 0; i < 9; i++) {
            common += m->triangles[t].corner[i / 3] == (uint32_t[]){1, 5, 7}[i % 3];
            neighbour |= i == 8 && common == 2 && m->slots[t] == out->slots[11];
        }
    assert_true(neighbour);
    for (int k = 0; k < 3; k++) {
        const uint32_t v = out->triangles[11].corner[k];
        assert_true(out->normals[v].x == 1.0);
        assert_true(out->uvs[v].v == 1.0 || out->uvs[v].v == 5.0 || out->uvs[v].v == 7.0);
    }
    free(r.fills);
    mesh_release(out);
    mesh_release(m);
}

/* A sphere that is inside out. */
static void all_that_is_turned_is_counted(void **state)
{
    (void)state;
    mesh *m = sphere_of(2);
    without(m, 7);
    for (size_t t = 0; t < m->triangle_count; t++)
        turn_triangle(m, t);
    mesh_repairs r;
    m = repaired(finished(m), 0.0, &r);
    assert_int_equal(r.turned, 319);
    assert_true(mesh_volume(m) > 4.0);
    free(r.fills);
    mesh_release(m);
}

/* Random spheres with random triangles missing. */
static void random_holes_are_filled(void **state)
{
    (void)state;
    uint64_t seed = 6;
    for (int round = 0; round < 40; round++) {
        mesh *m = sphere_of(3);
        for (int gone = random_below(&seed, 700); gone > 0; gone--)
            without(m, (size_t)random_below(&seed, (int)m->triangle_count));
        mesh_repairs r, again;
        mesh *one = repaired(finished(m), 0.0, &r), *other = NULL;
        assert_true(r.holes > 0 || round == 0);
        assert_int_equal(mesh_repair(one, 0.0, &again, &other, NULL), STATUS_OK);
        assert_true(other->closed && again.turned == 0);
        free(r.fills);
        free(again.fills);
        mesh_release(one);
        mesh_release(other);
    }
}

static void refused_with(mesh *m, double weld, const char *text, const char *remedy)
{
    mesh_repairs r;
    mesh *out;
    diagnostic why = {0};
    assert_int_equal(mesh_repair(finished(m), weld, &r, &out, &why), STATUS_BAD_INPUT);
    assert_null(out);
    if (!strstr(why.what, text) || (remedy && strcmp(why.remedy, remedy) != 0))
        fail_msg("%s; %s", why.what, why.remedy);
    free(r.fills);
    mesh_release(m);
}

static void refused(mesh *m, double weld, const char *text)
{
    refused_with(m, weld, text, NULL);
}

#define SEPARATE "separate the parts, or remove the faces that they share"

/* Welding is named where it is the cause only. */
static void crowded_edges_are_refused(void **state)
{
    (void)state;
    static const vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {5, 0, 0}, {5.01, 0, 0}};
    static const mesh_triangle fin[] = {{{0, 1, 2}}, {{0, 1, 3}}, {{0, 1, 4}}, {{2, 3, 5}}, {{2, 4, 6}}};
    refused_with(mesh_of(corners, 7, fin, 3), 0.0, "to (1, 0, 0) more than two triangles meet", SEPARATE);
    refused_with(mesh_of(corners, 7, fin, 5), 0.1, "to (1, 0, 0) more than two triangles meet", SEPARATE);
    mesh *m = cubes(2); /* with a common edge, after welding, and a hole */
    put_cube(m, 1, vec3_make(2.01, 2.01, 0.0), 1.0);
    m->triangle_count--;
    refused_with(m, 0.1, "from (1, 1, 1) to (1, 1, -1) more than two triangles meet",
                 SEPARATE ", or use another distance to weld");
}

static void shells_that_touch_after_welding_are_closed(void **state)
{
    (void)state;
    mesh *m = cubes(2);
    put_cube(m, 1, vec3_make(2.01, 0.0, 0.0), 1.0);
    mesh_repairs r;
    m = repaired(finished(m), 0.1, &r);
    assert_true(m->closed && m->crowded);
    assert_int_equal(m->shell_count, 1);
    assert_int_equal(m->triangle_count, 24);
    assert_int_equal(r.welded, 4);
    free(r.fills);
    mesh_release(m);
}

static void what_has_no_volume_is_refused(void **state)
{
    (void)state;
    static const vec3 line[] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, small[] = {{0, 0, 0}, {1, 0, 0}, {0.1, 0.1, 0}},
                      tilted[] = {{0.1, 0.7, 0.3}, {1.3, 0.2, 0.9}, {0.4, 2.1, 0.6}};
    static const mesh_triangle one[] = {{{0, 1, 2}}}, none[] = {{{0, 1, 1}}};
    refused_with(mesh_of(small, 3, one, 1), 0.5, "all triangles have two equal corners",
                 "use a smaller distance to weld");
    refused_with(mesh_of(small, 3, none, 1), 0.0, "all triangles have two equal corners",
                 "give a mesh with triangles that have an area");
    refused(mesh_of(line, 3, one, 1), 0.0, "a volume of 0");
    refused(mesh_of(tilted, 3, one, 1), 0.0, "a volume of 0");
}

static void what_cannot_be_closed_is_refused(void **state)
{
    (void)state;
    static const vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}};
    static const mesh_triangle fin[] = {{{0, 1, 2}}, {{0, 1, 3}}, {{0, 1, 4}}};
    refused(mesh_of(corners, 5, fin, 3), 0.0, "at the edge from (0, 0, 0) to (1, 0, 0) more than two triangles meet");
    enum { N = 7 }; /* a Moebius strip */
    vec3 at[2 * N];
    mesh_triangle strip[2 * N];
    for (int i = 0; i < N; i++) {
        const double turn = 2.0 * 3.141592653589793 * i / N;
        const vec3 middle = vec3_make(cos(turn), sin(turn), 0.0),
                   arm =
                       vec3_make(0.3 * cos(turn / 2) * cos(turn), 0.3 * cos(turn / 2) * sin(turn), 0.3 * sin(turn / 2));
        const uint32_t a = (uint32_t)(2 * i), last = i == N - 1;
        at[a] = vec3_sub(middle, arm), at[a + 1] = vec3_add(middle, arm);
        const uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
        strip[a] = (mesh_triangle){{a, a + 1, c}}, strip[a + 1] = (mesh_triangle){{a + 1, d, c}};
    }
    refused(mesh_of(at, 2 * N, strip, 2 * N), 0.0, "turns its other side");
    refused(mesh_of(corners, 5, fin, 1), 7.0, "cannot be welded within 7");
    refused(mesh_of(corners, 5, fin, 1), 1e-300, "cannot be welded within 1e-300");
    refused(mesh_of(corners, 5, fin, 0), 0.0, "no triangles");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_closed_mesh_stays_as_it_is),
        cmocka_unit_test(a_soup_is_welded),
        cmocka_unit_test(the_first_vertex_within_the_distance_is_taken),
        cmocka_unit_test(triangles_are_dropped),
        cmocka_unit_test(triangles_are_turned_to_agree),
        cmocka_unit_test(a_flat_hole_is_filled_flat),
        cmocka_unit_test(a_concave_hole_is_filled_within_its_border),
        cmocka_unit_test(a_large_hole_is_filled_around_its_middle),
        cmocka_unit_test(holes_that_meet_are_filled),
        cmocka_unit_test(two_divisions_by_one_diagonal_are_made_different),
        cmocka_unit_test(a_diagonal_is_used_once),
        cmocka_unit_test(attributes_are_kept),
        cmocka_unit_test(all_that_is_turned_is_counted),
        cmocka_unit_test(random_holes_are_filled),
        cmocka_unit_test(crowded_edges_are_refused),
        cmocka_unit_test(shells_that_touch_after_welding_are_closed),
        cmocka_unit_test(what_has_no_volume_is_refused),
        cmocka_unit_test(what_cannot_be_closed_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
