/* Tests of mesh_finish: closedness, orientation, normals, bounds, checks; of shared ownership; and of moved
 * vertices. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "base/cancel.h"
#include "base/lanes.h"
#include "geometry/mesh/mesh.h"
#include "geometry/mesh/mesh_generators.h"
#include "geometry/mesh/mesh_private.h"
#include "mesh_fixture.h"
#include "random_stream.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static void a_cube_is_closed_and_has_its_volume_and_area(void **state)
{
    (void)state;
    mesh *m = cubes(1);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_true(m->closed && m->single);
    assert_near(mesh_volume(m), 8.0, 1e-14);
    assert_near(mesh_area(m), 24.0, 1e-14);
    assert_true(m->bounds.low.x == -1.0 && m->bounds.low.y == -1.0 && m->bounds.low.z == -1.0);
    assert_true(m->bounds.high.x == 1.0 && m->bounds.high.y == 1.0 && m->bounds.high.z == 1.0);
    mesh_release(m);
}

static void bounds_include_only_vertices_of_triangles(void **state)
{
    (void)state;
    const vec3 at[4] = {{1, 2, 3}, {4, 2, 3}, {1, 2.1, 3}, {100, 100, 100}};
    mesh *m = mesh_of(at, 4, &(mesh_triangle){{0, 1, 2}}, 1);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_true(m->bounds.low.x == 1.0 && m->bounds.high.x == 4.0 && m->bounds.high.y == 2.1 &&
                m->bounds.high.z == 3.0);
    assert_false(m->single); /* 2.1 is not a float */
    mesh_release(m);
    m = mesh_of(at, 4, NULL, 0); /* points */
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_true(m->bounds.low.x == 1.0 && m->bounds.low.z == 3.0 && m->bounds.high.y == 100.0);
    assert_false(m->closed);
    assert_int_equal(m->hole.sharing, 0);
    mesh_release(m);
}

static void a_missing_triangle_is_reported_by_an_edge_of_its_neighbour(void **state)
{
    (void)state;
    mesh *m = cubes(1);
    m->triangle_count = 11; /* 1, 7, 5 is missing; its first neighbour is 4, 5, 7 */
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_false(m->closed);
    assert_int_equal(m->hole.triangle, 2);
    assert_int_equal(m->hole.from, 5);
    assert_int_equal(m->hole.to, 7);
    assert_int_equal(m->hole.sharing, 1);
    mesh_release(m);
}

static void an_edge_of_three_triangles_is_reported(void **state)
{
    (void)state;
    mesh *m = NULL;
    assert_int_equal(mesh_create(9, 13, false, false, false, &m, NULL), STATUS_OK);
    put_cube(m, 0, vec3_make(0, 0, 0), 1.0);
    m->vertices[8] = vec3_make(0, -3, -1);
    m->triangles[12] = (mesh_triangle){{0, 1, 8}}; /* a fin on the edge 0-1 */
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_false(m->closed);
    assert_int_equal(m->hole.sharing, 3);
    assert_int_equal(m->hole.triangle, 1); /* 0, 3, 1 */
    assert_true(m->hole.from == 1 && m->hole.to == 0);
    mesh_release(m);
}

static void vertices_at_equal_positions_are_merged_whatever_the_sign_of_zero(void **state)
{
    (void)state;
    mesh *m = NULL, *cube = cubes(1);
    for (size_t v = 0; v < 8; v++)
        cube->vertices[v] = vec3_add(cube->vertices[v], vec3_make(1, 1, 1)); /* 0..2 */
    assert_int_equal(mesh_create(36, 12, false, false, false, &m, NULL), STATUS_OK);
    for (size_t k = 0; k < 36; k++) {
        m->vertices[k] = cube->vertices[cube->triangles[k / 3].corner[k % 3]];
        if (k % 2 && m->vertices[k].x == 0.0)
            m->vertices[k].x = -0.0;
        m->triangles[k / 3].corner[k % 3] = (uint32_t)k;
    }
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_true(m->closed);
    m->vertices[7].y = nextafter(m->vertices[7].y, 3.0);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_false(m->closed);
    assert_true(m->hole.triangle == 2 && m->hole.from == 6 && m->hole.to == 7);
    mesh_release(cube);
    mesh_release(m);
}

/* With `distinct`, the positions are not compared, until the next mesh_finish. */
static void the_search_for_equal_positions_can_be_skipped(void **state)
{
    (void)state;
    mesh *m = NULL, *cube = cubes(1);
    assert_int_equal(mesh_create(36, 12, false, false, false, &m, NULL), STATUS_OK);
    for (size_t k = 0; k < 36; k++) {
        m->vertices[k] = cube->vertices[cube->triangles[k / 3].corner[k % 3]];
        m->triangles[k / 3].corner[k % 3] = (uint32_t)k;
    }
    m->distinct = cube->distinct = true;
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_false(m->closed);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_true(m->closed);
    assert_int_equal(mesh_finish(cube, NULL), STATUS_OK);
    assert_true(cube->closed);
    mesh_release(cube);
    mesh_release(m);
}

static void triangles_with_two_equal_corners_are_ignored_for_closedness(void **state)
{
    (void)state;
    mesh *m = NULL;
    assert_int_equal(mesh_create(8, 14, false, false, false, &m, NULL), STATUS_OK);
    put_cube(m, 0, vec3_make(0, 0, 0), 1.0);
    m->triangles[12] = (mesh_triangle){{0, 0, 1}};
    m->triangles[13] = (mesh_triangle){{5, 2, 5}};
    turn_triangle(m, 3); /* so that orientation runs too */
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_true(m->closed);
    assert_near(mesh_volume(m), 8.0, 1e-14);
    mesh_release(m);
}

static void each_inverted_triangle_is_reoriented(void **state)
{
    (void)state;
    for (size_t wrong = 0; wrong < 12; wrong++) {
        mesh *m = cubes(1), *right = cubes(1);
        turn_triangle(m, wrong);
        assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
        assert_true(m->closed);
        assert_memory_equal(m->triangles, right->triangles, 12 * sizeof *m->triangles);
        mesh_release(right);
        mesh_release(m);
    }
}

static void an_inside_out_cube_is_reoriented(void **state)
{
    (void)state;
    mesh *m = cubes(1);
    for (size_t t = 0; t < 12; t++)
        turn_triangle(m, t);
    assert_near(mesh_volume(m), -8.0, 1e-14);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_true(m->closed);
    assert_near(mesh_volume(m), 8.0, 1e-14);
    mesh_release(m);
}

/* A cube of edge 2 with a hollow of edge 1, whose normals point into the hollow. */
static mesh *hollow_cube(void)
{
    mesh *m = cubes(2);
    put_cube(m, 1, vec3_make(0.1, 0.2, 0.0), 0.5);
    for (size_t t = 12; t < 24; t++)
        turn_triangle(m, t);
    return m;
}

static void a_hollow_keeps_its_orientation(void **state)
{
    (void)state;
    mesh *m = hollow_cube();
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_true(m->closed);
    assert_near(mesh_volume(m), 8.0 - 1.0, 1e-14);
    mesh_release(m);
    m = hollow_cube();
    turn_triangle(m, 12); /* one inverted triangle in the hollow, the first that is visited; one outside */
    turn_triangle(m, 5);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_near(mesh_volume(m), 8.0 - 1.0, 1e-14);
    mesh_release(m);
    m = hollow_cube();
    for (size_t t = 12; t < 15; t++) /* three of twelve: the other three quarters decide, and no volume */
        turn_triangle(m, t);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_near(mesh_volume(m), 8.0 - 1.0, 1e-14);
    mesh_release(m);
    m = hollow_cube();
    for (size_t t = 0; t < 24; t++)
        turn_triangle(m, t);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_near(mesh_volume(m), 8.0 - 1.0, 1e-14);
    mesh_release(m);
}

static void inconsistently_oriented_parts_are_oriented_outwards(void **state)
{
    (void)state;
    mesh *m = cubes(3);
    for (size_t t = 0; t < 36; t++) {
        const size_t at =
            t % 12; /* the first half of the first and the last cube, the other half and one more of the second */
        if (t / 12 == 1 ? at >= 5 : at < 6)
            turn_triangle(m, t);
    }
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_true(m->closed);
    assert_near(mesh_volume(m), 24.0, 1e-13);
    mesh_release(m);
    /* one cube alone, so that turning the whole mesh would not help: its first half, then its second */
    for (size_t from = 0; from <= 6; from += 6) {
        m = cubes(3);
        for (size_t t = from; t < from + 6; t++)
            turn_triangle(m, t);
        assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
        assert_true(m->closed);
        assert_near(mesh_volume(m), 24.0, 1e-13);
        mesh_release(m);
    }
}

/* The projective plane with six vertices: each edge joins two triangles, but there is no inside. */
static void a_one_sided_surface_is_not_closed(void **state)
{
    (void)state;
    const mesh_triangle plane[10] = {{{0, 1, 4}}, {{0, 1, 5}}, {{0, 2, 3}}, {{0, 2, 5}}, {{0, 3, 4}},
                                     {{1, 2, 3}}, {{1, 2, 4}}, {{1, 3, 5}}, {{2, 4, 5}}, {{3, 4, 5}}};
    const vec3 at[6] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}};
    mesh *m = mesh_of(at, 6, plane, 10);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_false(m->closed);
    assert_int_equal(m->hole.sharing, 2);
    assert_memory_equal(m->triangles, plane, sizeof plane);
    mesh_release(m);
}

/* Two cones over a polygon with many corners: thousands of edges share an apex. */
static void many_triangles_may_share_a_vertex(void **state)
{
    (void)state;
    enum { CORNERS = 5000 };
    mesh *m = NULL;
    assert_int_equal(mesh_create(CORNERS + 2, 2 * CORNERS, false, false, false, &m, NULL), STATUS_OK);
    m->vertices[0] = vec3_make(0, 1, 0);
    m->vertices[1] = vec3_make(0, -1, 0);
    for (uint32_t k = 0; k < CORNERS; k++) {
        const uint32_t here = k + 2, next = (k + 1) % CORNERS + 2;
        m->vertices[here] =
            vec3_make(cos(k * 2e-3 * 3.14159265358979 / 5.0), 0, sin(k * 2e-3 * 3.14159265358979 / 5.0));
        m->triangles[2 * k] = (mesh_triangle){{0, next, here}};
        m->triangles[2 * k + 1] = (mesh_triangle){{1, here, next}};
    }
    turn_triangle(m, 1234);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_true(m->closed);
    const double polygon = 0.5 * CORNERS * sin(2.0 * 3.14159265358979323846 / CORNERS);
    assert_near(mesh_volume(m), 2.0 * polygon / 3.0, 1e-9);
    mesh_release(m);
}

static void invalid_indices_and_coordinates_are_refused_and_named(void **state)
{
    (void)state;
    diagnostic why = {0};
    mesh *m = cubes(1);
    m->triangles[7].corner[1] = 8;
    assert_int_equal(mesh_finish(m, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "triangle 7 refers to vertex 8 of 8");
    mesh_release(m);
    const double wrong[] = {(double)NAN, (double)INFINITY, -1.001e9};
    for (size_t k = 0; k < 3; k++) {
        m = cubes(1);
        m->vertices[3].z = wrong[k];
        assert_int_equal(mesh_finish(m, &why), STATUS_BAD_INPUT);
        assert_non_null(strstr(why.what, "vertex 3 "));
        mesh_release(m);
    }
    assert_int_equal(mesh_create(3, 1, true, true, true, &m, NULL), STATUS_OK);
    m->normals[1].x = (double)NAN;
    assert_int_equal(mesh_finish(m, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "vertex 1 has a normal that is not finite");
    m->normals[1].x = 0.0;
    m->uvs[2].v = (double)INFINITY;
    assert_int_equal(mesh_finish(m, &why), STATUS_BAD_INPUT);
    m->uvs[2] = (mesh_uv){-1e9, 1e9}; /* the limit itself is allowed */
    m->slots[0] = 1;
    assert_int_equal(mesh_finish(m, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "triangle 0 refers to material slot 1 of 1");
    m->slot_count = 2;
    assert_int_equal(mesh_finish(m, &why), STATUS_OK);
    mesh_release(m);
}

static void too_large_meshes_are_refused(void **state)
{
    (void)state;
    mesh *m = NULL;
    diagnostic why = {0};
    assert_int_equal(mesh_create(3, (size_t)MESH_TRIANGLES_MAX + 1, false, false, false, &m, &why), STATUS_BAD_INPUT);
    assert_int_equal(mesh_create((size_t)MESH_VERTICES_MAX + 1, 1, false, false, false, &m, &why), STATUS_BAD_INPUT);
    assert_null(m);
}

static void normals_are_normalised_and_missing_ones_are_the_triangles(void **state)
{
    (void)state;
    const vec3 at[4] = {{0, 0, 0}, {1e-200, 0, 0}, {0, 1e-200, 0}, {5, 5, 5}};
    mesh *m = NULL;
    assert_int_equal(mesh_create(4, 1, true, false, false, &m, NULL), STATUS_OK);
    memcpy(m->vertices, at, sizeof at);
    m->triangles[0] = (mesh_triangle){{0, 1, 2}};
    m->normals[0] = vec3_make(3e300, 0, 4e300);
    m->normals[1] = vec3_make(0, 5e-324, 0);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_near(m->normals[0].x, 0.6, 1e-15);
    assert_near(m->normals[0].z, 0.8, 1e-15);
    assert_true(m->normals[1].y == 1.0);
    assert_true(m->normals[2].x == 0.0 && m->normals[2].y == 0.0 && m->normals[2].z == 1.0); /* x cross y is z */
    assert_near(vec3_length(m->normals[3]), 1.0, 1e-15);
    mesh_release(m);
}

static void *retain_and_release(void *shared)
{
    for (int k = 0; k < 20000; k++) {
        mesh_retain(shared);
        mesh_release(shared);
    }
    mesh_release(shared);
    return NULL;
}

static int destroyed;
static void destroy(hierarchy *h)
{
    assert_true(h == (hierarchy *)&destroyed);
    destroyed++;
}

static void the_last_owner_frees_the_hierarchies(void **state)
{
    (void)state;
    mesh *m = cubes(1);
    m->shared->destroy = destroy;
    m->shared->hierarchies[HIERARCHY_BVH] = (hierarchy *)&destroyed;
    destroyed = 0;
    pthread_t threads[2];
    for (int k = 0; k < 2; k++) {
        mesh_retain(m);
        assert_int_equal(pthread_create(&threads[k], NULL, retain_and_release, m), 0);
    }
    for (int k = 0; k < 2; k++)
        pthread_join(threads[k], NULL);
    assert_int_equal(m->shared->owners, 1);
    assert_int_equal(destroyed, 0);
    mesh_release(m);
    assert_int_equal(destroyed, 1);
    mesh_release(NULL);
}

/* Meshes whose vertices move: the recomputed values equal those of mesh_finish, and an invalid move has no
 * effect. */

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
enum { VERTICES = 5 };

/* Two triangles over four vertices, and an unused fifth. */
static mesh *sheet(bool with_normals)
{
    static const vec3 at[VERTICES] = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {2, 3, 1}, {-50, 60, 70}};
    mesh *m = NULL;
    assert_int_equal(mesh_create(VERTICES, 2, with_normals, false, false, &m, NULL), STATUS_OK);
    memcpy(m->vertices, at, sizeof at);
    for (int i = 0; with_normals && i < VERTICES; i++)
        m->normals[i] = vec3_make(0, 0, 1);
    m->triangles[0] = (mesh_triangle){{0, 1, 2}};
    m->triangles[1] = (mesh_triangle){{1, 3, 2}};
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    return m;
}

/* The result of mesh_finish for these vertices and normals. */
static mesh *finished(const mesh *like, const vec3 *vertices, const vec3 *normals)
{
    mesh *m = NULL;
    assert_int_equal(mesh_create(like->vertex_count, like->triangle_count, normals != NULL, false, false, &m, NULL),
                     STATUS_OK);
    memcpy(m->vertices, vertices, m->vertex_count * sizeof *vertices);
    memcpy(m->triangles, like->triangles, m->triangle_count * sizeof *m->triangles);
    if (normals)
        memcpy(m->normals, normals, m->vertex_count * sizeof *normals);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    return m;
}

static void same_place(vec3 a, vec3 b)
{
    assert_true(a.x == b.x && a.y == b.y && a.z == b.z);
}

static void moved_as_finished(mesh *m, const vec3 *vertices, const vec3 *normals)
{
    assert_int_equal(mesh_move(m, vertices, normals, NULL), STATUS_OK);
    mesh *expected = finished(m, vertices, normals);
    same_place(m->bounds.low, expected->bounds.low);
    same_place(m->bounds.high, expected->bounds.high);
    assert_int_equal(m->single, expected->single);
    assert_memory_equal(m->vertices, vertices, m->vertex_count * sizeof *vertices);
    if (normals)
        assert_memory_equal(m->normals, expected->normals, m->vertex_count * sizeof *normals);
    mesh_release(expected);
}

static void moved_bounds_include_only_vertices_of_triangles(void **state)
{
    (void)state;
    mesh *m = sheet(false);
    const vec3 to[VERTICES] = {{1, 1, 1}, {5, -1, 0.5}, {2, 7, -4}, {3, 3, 3}, {1e8, 1e8, -1e8}};
    moved_as_finished(m, to, NULL);
    same_place(m->bounds.low, vec3_make(1, -1, -4));
    same_place(m->bounds.high, vec3_make(5, 7, 3));
    mesh_release(m);
}

static void bounds_of_large_meshes_are_those_of_mesh_finish(void **state)
{
    (void)state;
    uint64_t seed = 1;
    mesh *m = NULL;
    assert_int_equal(generate_icosphere(4, &m, NULL), STATUS_OK);
    vec3 *to = malloc(m->vertex_count * sizeof *to);
    assert_non_null(to);
    for (int round = 0; round < 20; round++) {
        const bool single = random_below(&seed, 2);
        for (size_t i = 0; i < m->vertex_count; i++) {
            const vec3 p = random_point(&seed, round < 10 ? 3.0 : 1e-40);
            to[i] = single ? vec3_make(single_round(p.x), single_round(p.y), single_round(p.z)) : p;
        }
        moved_as_finished(m, to, NULL);
        assert_int_equal(m->single, single);
    }
    free(to);
    mesh_release(m);
}

static void a_coordinate_that_is_no_float_clears_single(void **state)
{
    (void)state;
    mesh *m = sheet(false);
    vec3 to[VERTICES] = {{1, 1, 1}, {5, -1, 0.5}, {2, 7, -4}, {3, 3, 3}, {0.1, 0, 0}}; /* the last is not a corner */
    moved_as_finished(m, to, NULL);
    assert_true(m->single);
    to[3].y = 3.0 + 0x1p-40;
    moved_as_finished(m, to, NULL);
    assert_false(m->single);
    to[3].y = 0x1p-149; /* the smallest float, and half of it */
    moved_as_finished(m, to, NULL);
    assert_true(m->single);
    to[3].y = 0x1p-150;
    moved_as_finished(m, to, NULL);
    assert_false(m->single);
    mesh_release(m);

    assert_int_equal(generate_icosphere(0, &m, NULL), STATUS_OK); /* triangles use every vertex */
    vec3 all[60] = {{0, 0, 0}};
    assert_true(m->vertex_count <= COUNT(all));
    moved_as_finished(m, all, NULL);
    assert_true(m->single);
    all[m->vertex_count - 1].z = 0x1p-150;
    moved_as_finished(m, all, NULL);
    assert_false(m->single);
    mesh_release(m);
}

static void normals_are_normalised(void **state)
{
    (void)state;
    mesh *m = sheet(true);
    const vec3 to[VERTICES] = {{0, 0, 0}, {0, 0, 2}, {0, 3, 0}, {0, 3, 2}, {0, 0, 0}};
    const vec3 normals[VERTICES] = {{0, 0, 0}, {3, 0, 4}, {1e-200, 0, 0}, {0, 1e300, 0}, {0, 0, 0}};
    moved_as_finished(m, to, normals);
    same_place(m->normals[0], vec3_make(-1, 0, 0)); /* zero normal: the triangle's, (0, 0, 2) x (0, 3, 0) */
    assert_true(fabs(m->normals[1].x - 0.6) < 1e-15 && fabs(m->normals[1].z - 0.8) < 1e-15);
    same_place(m->normals[2], vec3_make(1, 0, 0));
    same_place(m->normals[3], vec3_make(0, 1, 0));
    vec3 before[VERTICES];
    memcpy(before, m->normals, sizeof before);
    assert_int_equal(mesh_move(m, to, NULL, NULL), STATUS_OK); /* unchanged */
    assert_memory_equal(m->normals, before, sizeof before);
    mesh_release(m);
    m = sheet(false);
    assert_int_equal(mesh_move(m, to, normals, NULL), STATUS_OK); /* the mesh has no normals */
    assert_null(m->normals);
    mesh_release(m);
}

static void an_invalid_move_has_no_effect(void **state)
{
    (void)state;
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, 1.0000001e9, -2e9};
    mesh *m = sheet(true);
    const mesh before = *m;
    vec3 vertices[VERTICES], normals[VERTICES];
    memcpy(vertices, m->vertices, sizeof vertices);
    memcpy(normals, m->normals, sizeof normals);
    for (size_t i = 0; i < COUNT(bad); i++)
        for (int vertex = 0; vertex < VERTICES; vertex++)
            for (int part = 0; part < 6; part++) {
                vec3 to[VERTICES], turned[VERTICES];
                for (int k = 0; k < VERTICES; k++) {
                    to[k] = vec3_make(k, 0.1 * k, 1.0 / (k + 1.0));
                    turned[k] = vec3_make(1, 2, 3);
                }
                double *one = part < 3 ? &to[vertex].x + part : &turned[vertex].x + part - 3;
                *one = bad[i];
                diagnostic why = {0};
                char text[DIAGNOSTIC_TEXT_MAX], name[20];
                const status expected =
                    part < 3 || i < 3 ? STATUS_BAD_INPUT : STATUS_OK; /* normals may have any length */
                if (expected == STATUS_OK)
                    continue;
                assert_int_equal(mesh_move(m, to, turned, &why), expected);
                snprintf(name, sizeof name, "vertex %d ", vertex);
                assert_non_null(strstr(diagnostic_text(&why, text, sizeof text), name));
                assert_memory_equal(m, &before, sizeof before);
                assert_memory_equal(m->vertices, vertices, sizeof vertices);
                assert_memory_equal(m->normals, normals, sizeof normals);
            }
    const vec3 far[VERTICES] = {
        {1e9, 1e9, 1e9}, {-1e9, 0, 0}, {0, -1e9, 0}, {0, 0, -1e9}, {0, 0, 0}}; /* the limit itself is allowed */
    moved_as_finished(m, far, NULL);
    mesh_release(m);
}

static void an_empty_mesh_can_be_moved(void **state)
{
    (void)state;
    mesh *m = NULL;
    assert_int_equal(mesh_create(0, 0, false, false, false, &m, NULL), STATUS_OK);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_int_equal(mesh_move(m, &(vec3){0, 0, 0}, NULL, NULL), STATUS_OK);
    assert_true(m->bounds.low.x > m->bounds.high.x && m->single);
    mesh_release(m);
}

/* A caller that returns at once has nothing to free. */
static void a_cancelled_search_for_equal_positions_has_no_result(void **state)
{
    (void)state;
    mesh *m = NULL;
    assert_int_equal(generate_icosphere(1, &m, NULL), STATUS_OK);
    uint32_t nothing, *same = &nothing;
    cancel_token t = {.ask = NULL};
    cancel_begin(&t);
    cancel_set(&t);
    assert_int_equal(mesh_weld(m, &same, NULL), STATUS_INTERRUPTED);
    cancel_end(&t);
    assert_null(same);
    mesh_release(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_is_closed_and_has_its_volume_and_area),
        cmocka_unit_test(bounds_include_only_vertices_of_triangles),
        cmocka_unit_test(a_missing_triangle_is_reported_by_an_edge_of_its_neighbour),
        cmocka_unit_test(an_edge_of_three_triangles_is_reported),
        cmocka_unit_test(vertices_at_equal_positions_are_merged_whatever_the_sign_of_zero),
        cmocka_unit_test(the_search_for_equal_positions_can_be_skipped),
        cmocka_unit_test(a_cancelled_search_for_equal_positions_has_no_result),
        cmocka_unit_test(triangles_with_two_equal_corners_are_ignored_for_closedness),
        cmocka_unit_test(each_inverted_triangle_is_reoriented),
        cmocka_unit_test(an_inside_out_cube_is_reoriented),
        cmocka_unit_test(a_hollow_keeps_its_orientation),
        cmocka_unit_test(inconsistently_oriented_parts_are_oriented_outwards),
        cmocka_unit_test(a_one_sided_surface_is_not_closed),
        cmocka_unit_test(many_triangles_may_share_a_vertex),
        cmocka_unit_test(invalid_indices_and_coordinates_are_refused_and_named),
        cmocka_unit_test(too_large_meshes_are_refused),
        cmocka_unit_test(normals_are_normalised_and_missing_ones_are_the_triangles),
        cmocka_unit_test(the_last_owner_frees_the_hierarchies),
        cmocka_unit_test(moved_bounds_include_only_vertices_of_triangles),
        cmocka_unit_test(bounds_of_large_meshes_are_those_of_mesh_finish),
        cmocka_unit_test(a_coordinate_that_is_no_float_clears_single),
        cmocka_unit_test(normals_are_normalised),
        cmocka_unit_test(an_invalid_move_has_no_effect),
        cmocka_unit_test(an_empty_mesh_can_be_moved),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
