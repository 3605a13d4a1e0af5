/* Tests of meshes whose vertices move: the recomputed values equal those of mesh_finish, and an invalid move has no
 * effect. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "base/lanes.h"
#include "geometry/mesh/mesh_generators.h"
#include "geometry/mesh/mesh.h"
#include "random_stream.h"

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

static void bounds_include_only_vertices_of_triangles(void **state)
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds_include_only_vertices_of_triangles),
        cmocka_unit_test(bounds_of_large_meshes_are_those_of_mesh_finish),
        cmocka_unit_test(a_coordinate_that_is_no_float_clears_single),
        cmocka_unit_test(normals_are_normalised),
        cmocka_unit_test(an_invalid_move_has_no_effect),
        cmocka_unit_test(an_empty_mesh_can_be_moved),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
