/* Tests of the mesh generators: volumes and areas in closed form, convergence, orientation, texture coordinates, and
 * refused arguments. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "base/budget.h"
#include "geometry/mesh/mesh_generators.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))
static const double pi = 3.14159265358979323846;

/* FNV-1a over nine little-endian floats per triangle. */
static uint64_t float_hash(const mesh *m, size_t *bytes)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    *bytes = 0;
    for (size_t k = 0; k < 3 * m->triangle_count; k++) {
        const vec3 p = m->vertices[m->triangles[k / 3].corner[k % 3]];
        const float at[3] = {(float)p.x, (float)p.y, (float)p.z};
        for (size_t b = 0; b < sizeof at; b++, ++*bytes) {
            uint32_t bits;
            memcpy(&bits, &at[b / 4], sizeof bits);
            hash = (hash ^ (bits >> 8 * (b % 4) & 0xff)) * UINT64_C(1099511628211);
        }
    }
    return hash;
}

/* The expected hashes are those of the triangles that the reference program embree_bench (gcc -O3 -march=native, with
 * fused multiply-add) dumped with -d bin. */
static void triangle_sets_are_bit_identical_to_the_reference_programs(void **state)
{
    (void)state;
    static const struct {
        status (*make)(size_t, mesh **, diagnostic *);
        size_t count, bytes;
        uint64_t hash;
    } sets[] = {{generate_sparse_soup, 1, 36, UINT64_C(0xd64de1c1e91d32c2)},
                {generate_sparse_soup, 100, 3600, UINT64_C(0x7eacf0a42b082d09)},
                {generate_sparse_soup, 10000, 360000, UINT64_C(0xa2609235fbe7e590)},
                {generate_dense_soup, 100, 3600, UINT64_C(0x3d6e20f701788277)},
                {generate_dense_soup, 10000, 360000, UINT64_C(0xdd835771b80b8ee0)},
                {generate_sphere, 1, 720, UINT64_C(0x504b601cebf7d85d)},
                {generate_sphere, 1000, 35280, UINT64_C(0x9633bdb2308747b9)},
                {generate_sphere, 10000, 348480, UINT64_C(0xa35ec90e3a58af01)}};
    for (size_t k = 0; k < COUNT(sets); k++) {
        mesh *m;
        size_t bytes;
        assert_int_equal(sets[k].make(sets[k].count, &m, NULL), STATUS_OK);
        assert_true(float_hash(m, &bytes) == sets[k].hash);
        assert_int_equal(bytes, sets[k].bytes);
        assert_true(m->single);
        mesh_release(m);
    }
}

static int compare_positions(const void *a, const void *b)
{
    const double *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p[k] != q[k])
            return p[k] < q[k] ? -1 : 1;
    return 0;
}

static size_t positions(const mesh *m)
{
    vec3 *sorted = malloc(m->vertex_count * sizeof *sorted);
    memcpy(sorted, m->vertices, m->vertex_count * sizeof *sorted);
    qsort(sorted, m->vertex_count, sizeof *sorted, compare_positions);
    size_t count = 1;
    for (size_t v = 1; v < m->vertex_count; v++)
        count += compare_positions(&sorted[v - 1], &sorted[v]) != 0;
    free(sorted);
    return count;
}

/* V - E + F, with E = 3 F / 2 where each edge joins two triangles. */
static int euler(const mesh *m)
{
    return (int)positions(m) - (int)m->triangle_count / 2;
}

/* Normals are on the side of the fronts; textures are not mirrored: in a left-handed frame their orientation is
 * opposite to that of the vector product. */
static void assert_fronts(const mesh *m)
{
    for (size_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *k = m->triangles[t].corner;
        const vec3 a = m->vertices[k[0]],
                   normal = vec3_cross(vec3_sub(m->vertices[k[1]], a), vec3_sub(m->vertices[k[2]], a));
        const mesh_uv p = m->uvs[k[0]], q = m->uvs[k[1]], r = m->uvs[k[2]];
        for (int corner = 0; corner < 3; corner++) {
            assert_true(vec3_dot(m->normals[k[corner]], normal) > 0.0);
            assert_near(vec3_length(m->normals[k[corner]]), 1.0, 1e-15);
        }
        assert_true((q.u - p.u) * (r.v - p.v) - (r.u - p.u) * (q.v - p.v) < 0.0);
    }
}

static void assert_sound(const mesh *m, int characteristic)
{
    assert_true(m->closed);
    assert_int_equal(euler(m), characteristic);
    assert_true(mesh_volume(m) > 0.0);
    assert_fronts(m);
}

/* An icosahedron in the unit sphere: edge 4 / sqrt(10 + 2 sqrt 5), area 5 sqrt 3 a^2, volume 5 (3 + sqrt 5) a^3 / 12
 * (Coxeter). */
static void the_coarsest_icosphere_is_an_icosahedron(void **state)
{
    (void)state;
    const double a = 4.0 / sqrt(10.0 + 2.0 * sqrt(5.0));
    mesh *m;
    assert_int_equal(generate_icosphere(0, &m, NULL), STATUS_OK);
    assert_int_equal(m->triangle_count, 20);
    assert_near(mesh_area(m), 5.0 * sqrt(3.0) * a * a, 1e-14);
    assert_near(mesh_volume(m), 5.0 * (3.0 + sqrt(5.0)) * a * a * a / 12.0, 1e-14);
    mesh_release(m);
}

/* The error of an inscribed polyhedron is proportional to the square of its edge, which bisection halves. */
static void icospheres_converge_quadratically_to_the_sphere(void **state)
{
    (void)state;
    double volume_short = 0.0, area_short = 0.0;
    for (int level = 2; level <= 6; level++) {
        mesh *m;
        assert_int_equal(generate_icosphere(level, &m, NULL), STATUS_OK);
        assert_int_equal(m->triangle_count, 20 << (2 * level));
        assert_sound(m, 2);
        const double volume = 4.0 / 3.0 * pi - mesh_volume(m), area = 4.0 * pi - mesh_area(m);
        if (level > 2) {
            assert_near(volume_short / volume, 4.0, 0.1);
            assert_near(area_short / area, 4.0, 0.1);
        }
        volume_short = volume;
        area_short = area;
        for (size_t v = 0; v < m->vertex_count; v++)
            assert_near(vec3_length(m->vertices[v]), 1.0, 3e-16);
        mesh_release(m);
    }
}

static void spheres_of_every_subdivision_are_closed(void **state)
{
    (void)state;
    for (size_t f = 1; f <= 40; f++) {
        mesh *m;
        assert_int_equal(generate_sphere(20 * f * f, &m, NULL), STATUS_OK);
        assert_int_equal(m->triangle_count, 20 * f * f);
        assert_sound(m, 2);
        assert_true(m->single);
        mesh_release(m);
    }
}

static void a_spheres_texture_coordinates_are_longitude_and_latitude(void **state)
{
    (void)state;
    mesh *m;
    assert_int_equal(generate_sphere(2000, &m, NULL), STATUS_OK);
    for (size_t v = 0; v < m->vertex_count; v++) {
        const vec3 p = m->vertices[v];
        const mesh_uv at = m->uvs[v];
        assert_near(sin((at.v - 0.5) * pi), p.y, 1e-7);
        assert_near(cos((at.v - 0.5) * pi) * sin((at.u - 0.5) * 2.0 * pi), p.x, 1e-7);
        assert_near(cos((at.v - 0.5) * pi) * cos((at.u - 0.5) * 2.0 * pi), -p.z, 1e-7);
    }
    /* a pole's longitude is that of its triangle's centre, at most a quarter turn from each corner */
    size_t poles = 0;
    for (size_t k = 0; k < 3 * m->triangle_count; k++) {
        const uint32_t *corner = m->triangles[k / 3].corner;
        if (fabs(m->vertices[corner[k % 3]].y) != 1.0)
            continue;
        poles++;
        for (size_t other = 0; other < 3; other++)
            assert_near(m->uvs[corner[other]].u, m->uvs[corner[k % 3]].u, 0.25 + 1e-12);
    }
    assert_int_equal(poles, 12);
    mesh_release(m);
}

/* Prisms about the axis: the volume of the solid of revolution times n sin(2 pi / n) / (2 pi); a polygon's is given by
 * Pappus. */
static void a_torus_of_flat_faces_has_its_exact_volume(void **state)
{
    (void)state;
    static const int segments[][2] = {{3, 3}, {4, 5}, {7, 3}, {64, 32}, {101, 57}};
    const double major = 1.7, minor = 0.6;
    for (size_t k = 0; k < COUNT(segments); k++) {
        const int n = segments[k][0], tube = segments[k][1];
        mesh *m;
        assert_int_equal(generate_torus(major, minor, n, tube, &m, NULL), STATUS_OK);
        assert_int_equal(m->triangle_count, 2 * n * tube);
        assert_sound(m, 0);
        assert_near(mesh_volume(m), n * sin(2.0 * pi / n) * major * 0.5 * tube * minor * minor * sin(2.0 * pi / tube),
                    1e-12);
        mesh_release(m);
    }
}

/* 2 pi^2 R r^2 and 4 pi^2 R r; the error decreases with the square of the number of segments. */
static void torus_meshes_converge_quadratically_to_the_torus(void **state)
{
    (void)state;
    double volume_short = 0.0, area_short = 0.0;
    for (int n = 32; n <= 256; n *= 2) {
        mesh *m;
        assert_int_equal(generate_torus(2.0, 0.5, n, n / 2, &m, NULL), STATUS_OK);
        const double volume = 2.0 * pi * pi * 2.0 * 0.25 - mesh_volume(m),
                     area = 4.0 * pi * pi * 2.0 * 0.5 - mesh_area(m);
        if (n > 32) {
            assert_near(volume_short / volume, 4.0, 0.1);
            assert_near(area_short / area, 4.0, 0.1);
        }
        volume_short = volume;
        area_short = area;
        mesh_release(m);
    }
}

static mesh *lathe_of(const profile_point *profile, size_t count, int around, double crease_deg)
{
    mesh *m = NULL;
    assert_int_equal(generate_lathe(profile, count, around, crease_deg, &m, NULL), STATUS_OK);
    return m;
}

static void lathed_cylinders_and_cones_are_prisms_and_pyramids(void **state)
{
    (void)state;
    const profile_point cylinder[] = {{0, -1}, {2, -1}, {2, 2}, {0, 2}},
                        cone[] = {{0, 3}, {1.5, 0}, {0, 0}}; /* one profile runs up, the other down */
    for (int n = 3; n <= 40; n += n < 8 ? 1 : 11) {
        const double polygon = 0.5 * n * sin(2.0 * pi / n), side = 2.0 * sin(pi / n), inner = cos(pi / n);
        mesh *m = lathe_of(cylinder, COUNT(cylinder), n, 30.0);
        assert_sound(m, 2);
        assert_int_equal(m->triangle_count, 4 * n);
        assert_near(mesh_volume(m), polygon * 4.0 * 3.0, 1e-13);
        assert_near(mesh_area(m), 2.0 * polygon * 4.0 + n * 2.0 * side * 3.0, 1e-13);
        mesh_release(m);
        m = lathe_of(cone, COUNT(cone), n, 30.0);
        assert_sound(m, 2);
        assert_int_equal(m->triangle_count, 2 * n);
        const double radius = 1.5, slant = sqrt(9.0 + radius * radius * inner * inner);
        assert_near(mesh_volume(m), polygon * radius * radius * 3.0 / 3.0, 1e-13);
        assert_near(mesh_area(m), polygon * radius * radius + 0.5 * n * radius * side * slant, 1e-13);
        mesh_release(m);
    }
}

static void a_lathed_ring_is_a_torus(void **state)
{
    (void)state;
    const profile_point up[] = {{1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 0}},
                        down[] = {{1, 0}, {1, 1}, {2, 1}, {2, 0}, {1, 0}};
    mesh *a = lathe_of(up, 5, 12, 30.0), *b = lathe_of(down, 5, 12, 180.0);
    assert_sound(a, 0);
    assert_sound(b, 0);
    assert_near(mesh_volume(a), 6.0 * sin(pi / 6.0) * (4.0 - 1.0), 1e-13);
    assert_near(mesh_volume(b), mesh_volume(a), 1e-13);
    for (size_t v = 0; v < b->vertex_count; v++) /* smooth at each right angle, also where the profile closes */
        assert_near(fabs(b->normals[v].y), sqrt(0.5), 1e-15);
    mesh_release(a);
    mesh_release(b);
}

static void edges_above_the_crease_angle_are_sharp_and_others_are_smooth(void **state)
{
    (void)state;
    const profile_point barrel[] = {
        {0, 0}, {1, 0}, {1.1, 1}, {1, 2}, {0, 2}}; /* turns by 90 - 5.7 degrees, 11.4, and so on */
    mesh *m = lathe_of(barrel, COUNT(barrel), 16, 30.0);
    bool round = false, flat = false, slanted = false;
    for (size_t v = 0; v < m->vertex_count; v++) {
        const vec3 p = m->vertices[v], n = m->normals[v];
        if (p.y == 1.0) {
            assert_true(fabs(n.y) < 1e-15); /* the mean of two mirrored normals */
            round = true;
        } else if (p.y == 0.0) {
            flat |= n.y == -1.0;
            slanted |= fabs(n.y + 0.1 / sqrt(1.01)) < 1e-15;
            assert_true(n.y == -1.0 || fabs(n.y + 0.1 / sqrt(1.01)) < 1e-15);
        }
    }
    assert_true(round && flat && slanted);
    mesh_release(m);
    m = lathe_of((profile_point[]){{1, 0}, {1, 1}}, 2, 8, 30.0); /* a tube without thickness */
    assert_false(m->closed);
    assert_int_equal(m->hole.sharing, 1);
    assert_fronts(m);
    mesh_release(m);
}

/* A lens's apex turns by 2 atan 0.1 = 11.4 degrees across the axis. */
static void an_apex_below_the_crease_angle_is_smooth(void **state)
{
    (void)state;
    const profile_point lens[] = {{0, -0.1}, {1, 0}, {0, 0.1}};
    for (int sharp = 0; sharp < 2; sharp++) {
        mesh *m = lathe_of(lens, 3, 12, sharp ? 11.0 : 12.0);
        assert_sound(m, 2);
        for (size_t v = 0; v < m->vertex_count; v++)
            if (m->vertices[v].y > 0.0)
                assert_near(m->normals[v].y, sharp ? 1.0 / sqrt(1.01) : 1.0, 1e-15);
        mesh_release(m);
    }
}

/* Two cones that touch at their apices: there each is smooth across the axis, and not into the other. */
static void cones_that_touch_on_the_axis_keep_their_own_normals(void **state)
{
    (void)state;
    int up = 0, down = 0;
    mesh *m = lathe_of((profile_point[]){{1, -1}, {0, 0}, {1, 1}}, 3, 8, 180.0);
    for (size_t v = 0; v < m->vertex_count; v++)
        if (m->vertices[v].y == 0.0) {
            assert_near(fabs(m->normals[v].y), 1.0, 1e-15);
            up += m->normals[v].y > 0.0, down += m->normals[v].y < 0.0;
        }
    assert_true(up > 0 && down > 0);
    mesh_release(m);
}

/* The normals at the two rims of a bowl without thickness are those of its first and its last segment. */
static void the_ends_of_an_open_profile_have_their_own_normals(void **state)
{
    (void)state;
    mesh *m = lathe_of((profile_point[]){{1, 0}, {1.5, 0.5}, {1.6, 1.5}}, 3, 8, 90.0);
    for (size_t v = 0; v < m->vertex_count; v++) {
        const double y = m->vertices[v].y, mean = 0.5 * (atan2(-1.0, 1.0) + atan2(-0.1, 1.0));
        assert_near(m->normals[v].y, y == 0.0 ? -sqrt(0.5) : y == 1.5 ? -0.1 / sqrt(1.01) : sin(mean), 1e-15);
    }
    mesh_release(m);
}

static void seams_coincide_and_texture_coordinates_are_continuous(void **state)
{
    (void)state;
    mesh *m;
    assert_int_equal(generate_torus(2.0, 1.0, 8, 6, &m, NULL), STATUS_OK);
    for (size_t j = 0; j <= 6; j++) {
        assert_memory_equal(&m->vertices[9 * j], &m->vertices[9 * j + 8], sizeof(vec3));
        assert_true(m->uvs[9 * j].u == 0.0 && m->uvs[9 * j + 8].u == 1.0);
    }
    for (size_t i = 0; i <= 8; i++) {
        assert_memory_equal(&m->vertices[i], &m->vertices[54 + i], sizeof(vec3));
        assert_true(m->uvs[i].v == 0.0 && m->uvs[54 + i].v == 1.0);
    }
    mesh_release(m);
}

static void a_box_has_its_volume_and_a_whole_texture_on_each_side(void **state)
{
    (void)state;
    mesh *m;
    assert_int_equal(generate_box(vec3_make(1.0, 2.0, 4.0), &m, NULL), STATUS_OK);
    assert_sound(m, 2);
    assert_near(mesh_volume(m), 8.0, 1e-14);
    assert_near(mesh_area(m), 28.0, 1e-14);
    assert_true(m->bounds.high.x == 0.5 && m->bounds.high.y == 1.0 && m->bounds.low.z == -2.0);
    /* the side in front of a viewer at -z: the lower left corner of the texture image is at -x, -y */
    assert_true(m->vertices[0].x == -0.5 && m->vertices[0].y == -1.0 && m->vertices[0].z == -2.0 &&
                m->uvs[0].u == 0.0 && m->uvs[0].v == 0.0);
    mesh_release(m);
}

/* Under a plane y = p + q x the volume is size_x size_z (p + depth). */
static void a_plane_height_field_has_its_exact_volume(void **state)
{
    (void)state;
    double heights[3 * 4];
    for (int k = 0; k < 12; k++)
        heights[k] = 0.25 + 0.5 * (4.0 * (k % 3) / 2.0 - 2.0); /* at x = -2, 0, 2 */
    mesh *m;
    assert_int_equal(generate_height_field(heights, 3, 4, 4.0, 6.0, 1.5, &m, NULL), STATUS_OK);
    assert_sound(m, 2);
    assert_near(mesh_volume(m), 4.0 * 6.0 * (0.25 + 1.5), 1e-13);
    const double slope = sqrt(1.25);
    for (size_t v = 0; v < 12; v++)
        assert_near(vec3_length(vec3_sub(m->normals[v], vec3_make(-0.5 / slope, 1.0 / slope, 0.0))), 0.0, 1e-15);
    assert_true(m->vertices[0].x == -2.0 && m->vertices[0].z == -3.0 && m->vertices[11].x == 2.0 &&
                m->vertices[11].z == 3.0);
    int on_walls = 0;
    for (size_t v = 12; v < m->vertex_count; v++) { /* a texture covers each wall, from one edge to the other */
        const vec3 p = m->vertices[v], n = m->normals[v];
        const double along = fabs(n.x) > 0.5 ? p.z / 6.0 + 0.5 : p.x / 4.0 + 0.5, u = m->uvs[v].u;
        if (fabs(n.y) > 0.5)
            continue;
        assert_true(fabs(u - along) < 1e-15 || fabs(1.0 - u - along) < 1e-15);
        assert_true(m->uvs[v].v == (p.y == -1.5 ? 0.0 : 1.0));
        on_walls++;
    }
    assert_int_equal(on_walls, 2 * 2 * (3 + 4));
    mesh_release(m);
    assert_int_equal(generate_height_field(heights, 3, 4, 4.0, 6.0, 0.0, &m, NULL), STATUS_OK);
    assert_false(m->closed);
    assert_int_equal(m->triangle_count, 12);
    assert_fronts(m);
    assert_near(mesh_area(m), 4.0 * 6.0 * slope, 1e-13);
    mesh_release(m);
}

/* Two by two heights are one square, and the deepest icosphere is refused only where its memory is. */
static void the_least_field_and_the_deepest_icosphere_are_in_range(void **state)
{
    (void)state;
    const double heights[4] = {0.5, 0.5, 0.5, 0.5};
    mesh *m = NULL;
    assert_int_equal(generate_height_field(heights, 2, 2, 3.0, 2.0, 1.0, &m, NULL), STATUS_OK);
    assert_near(mesh_volume(m), 3.0 * 2.0 * 1.5, 1e-14);
    mesh_release(m);
    diagnostic why = {.line = 0};
    memory_budget_set(1 << 20);
    assert_int_equal(generate_icosphere(ICOSPHERE_LEVEL_MAX, &m, &why), STATUS_BAD_INPUT);
    memory_budget_set(0);
    assert_non_null(strstr(why.what, "of memory"));
}

static void invalid_arguments_are_refused_with_a_remedy(void **state)
{
    (void)state;
    mesh *m = NULL;
    const double heights[4] = {0.0, 0.0, -2.0, 0.0}, high[4] = {1.0, 1.0, 1.0, 1.0};
    const profile_point fine[] = {{0, 0}, {1, 0}, {0, 1}}, twice[] = {{1, 0}, {1, 0}, {0, 1}},
                        axis[] = {{0, 0}, {0, 1}}, minus[] = {{0, 0}, {-1, 0}};
    diagnostic why[20] = {{.remedy = ""}};
    const status got[] = {generate_sparse_soup(0, &m, &why[0]),
                          generate_dense_soup((size_t)MESH_TRIANGLES_MAX + 1, &m, &why[1]),
                          generate_sphere(0, &m, &why[2]),
                          generate_icosphere(-1, &m, &why[3]),
                          generate_icosphere(ICOSPHERE_LEVEL_MAX + 1, &m, &why[4]),
                          generate_torus(1.0, 1.0, 8, 8, &m, &why[5]),
                          generate_torus((double)NAN, 0.5, 8, 8, &m, &why[6]),
                          generate_torus(1.0, 0.5, 2, 8, &m, &why[7]),
                          generate_torus(1.0, 1e-300, 8, 8, &m, &why[8]),
                          generate_lathe(fine, 3, 2, 0.0, &m, &why[9]),
                          generate_lathe(fine, 3, 8, -1.0, &m, &why[10]),
                          generate_lathe(twice, 3, 8, 0.0, &m, &why[11]),
                          generate_lathe(axis, 2, 8, 0.0, &m, &why[12]),
                          generate_lathe(minus, 2, 8, 0.0, &m, &why[13]),
                          generate_height_field(heights, 1, 4, 1, 1, 1, &m, &why[14]),
                          generate_height_field(heights, 2, 2, 1, 1, 2.0, &m, &why[15]),
                          generate_box(vec3_make(1, 0, 1), &m, &why[16]),
                          generate_box(vec3_make(1, (double)INFINITY, 1), &m, &why[17]),
                          generate_height_field(high, 2, 2, 1, 1, -0.5, &m, &why[18]),
                          generate_height_field(high, 2, 2, 1, 1, 1.001e9, &m, &why[19])};
    for (size_t k = 0; k < COUNT(got); k++) {
        assert_int_equal(got[k], STATUS_BAD_INPUT);
        assert_true(why[k].what[0] && why[k].remedy[0]);
    }
    assert_null(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangle_sets_are_bit_identical_to_the_reference_programs),
        cmocka_unit_test(the_coarsest_icosphere_is_an_icosahedron),
        cmocka_unit_test(icospheres_converge_quadratically_to_the_sphere),
        cmocka_unit_test(spheres_of_every_subdivision_are_closed),
        cmocka_unit_test(a_spheres_texture_coordinates_are_longitude_and_latitude),
        cmocka_unit_test(a_torus_of_flat_faces_has_its_exact_volume),
        cmocka_unit_test(torus_meshes_converge_quadratically_to_the_torus),
        cmocka_unit_test(lathed_cylinders_and_cones_are_prisms_and_pyramids),
        cmocka_unit_test(a_lathed_ring_is_a_torus),
        cmocka_unit_test(edges_above_the_crease_angle_are_sharp_and_others_are_smooth),
        cmocka_unit_test(an_apex_below_the_crease_angle_is_smooth),
        cmocka_unit_test(cones_that_touch_on_the_axis_keep_their_own_normals),
        cmocka_unit_test(the_ends_of_an_open_profile_have_their_own_normals),
        cmocka_unit_test(seams_coincide_and_texture_coordinates_are_continuous),
        cmocka_unit_test(a_box_has_its_volume_and_a_whole_texture_on_each_side),
        cmocka_unit_test(a_plane_height_field_has_its_exact_volume),
        cmocka_unit_test(the_least_field_and_the_deepest_icosphere_are_in_range),
        cmocka_unit_test(invalid_arguments_are_refused_with_a_remedy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
