/* Tests of sections against plane geometry: circles, rectangles, walls. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "render/inspect/section.h"
#include "render_fixture.h"

#define PI 3.14159265358979323846

static probe *probe_of(const scene *s)
{
    probe *p = NULL;
    diagnostic why = {0};
    worked(probe_create(s, isa_best(), &p, &why), &why);
    return p;
}

static section cut(const probe *p, const section_plane *plane, int cells)
{
    section out = {0};
    diagnostic why = {0};
    worked(section_cut(p, plane, cells, &out, &why), &why);
    return out;
}

static double length_of(const section *s, const section_line *line)
{
    double length = 0.0;
    for (size_t k = 1; k < line->count; k++) {
        const section_point a = s->point[line->first + k - 1], b = s->point[line->first + k];
        length += hypot(b.u - a.u, b.v - a.v);
    }
    return length;
}

/* Length of all boundaries between two media. */
static double length_between(const section *s, int a, int b)
{
    double length = 0.0;
    for (size_t i = 0; i < s->line_count; i++)
        if (s->line[i].a == (a < b ? a : b) && s->line[i].b == (a < b ? b : a))
            length += length_of(s, &s->line[i]);
    return length;
}

/* Shoelace formula over the rings of a medium's area; rings of holes would have to be reversed for a plain sum, so the
 * parts are added by the even-odd rule: the largest minus those inside it. */
static double area_of(const section *s, int medium)
{
    section_step step[256];
    assert_true(s->line_count <= 256);
    size_t steps = 0;
    diagnostic why = {.what = ""};
    worked(section_area(s, medium, step, &steps, &why), &why);
    double ring = 0.0, largest = 0.0, sum = 0.0;
    section_point last = {0.0, 0.0};
    for (size_t i = 0; i < steps; i++) {
        const section_line *line = &s->line[step[i].line];
        if (step[i].starts_ring)
            sum += fabs(ring), largest = fmax(largest, fabs(ring)), ring = 0.0;
        for (size_t k = 0; k < line->count; k++) {
            const section_point at = s->point[line->first + (step[i].backwards ? line->count - 1 - k : k)];
            if (k > 0 || !step[i].starts_ring)
                ring += 0.5 * (last.u * at.v - at.u * last.v);
            last = at;
        }
    }
    sum += fabs(ring), largest = fmax(largest, fabs(ring));
    return 2.0 * largest - sum;
}

static const section_plane upright = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, -2, 2, -2, 2};

/* A plane at distance d from a sphere's centre cuts a circle of radius sqrt(R^2 - d^2). */
static void a_spheres_section_is_a_circle(void **state)
{
    (void)state;
    const double distances[] = {0.0, 0.3, 0.8, -0.95};
    scene *s = scene_from(
        "solids: {ball: {shape: sphere, transparency: 1, ior: 1.5, radius: 1, position: [0.11, 0.07, 0]}}\n");
    probe *p = probe_of(s);
    for (int i = 0; i < 4; i++) {
        section_plane plane = upright;
        plane.origin.z = distances[i];
        section out = cut(p, &plane, 60);
        const double radius = sqrt(1.0 - distances[i] * distances[i]);
        size_t seen = 0;
        for (size_t k = 0; k < out.line_count; k++) {
            const section_line *line = &out.line[k];
            if (line->a == SECTION_EDGE)
                continue;
            seen++;
            assert_true(line->a == RAY_OUTSIDE && line->b == 0 && line->end[0] == -1 && line->end[1] == -1);
            assert_memory_equal(&out.point[line->first], &out.point[line->first + line->count - 1],
                                sizeof(section_point));
            for (size_t m = 0; m < line->count; m++) {
                const section_point at = out.point[line->first + m];
                assert_true(fabs(hypot(at.u - 0.11, at.v - 0.07) - radius) < 1e-9);
            }
            assert_true(fabs(length_of(&out, line) - 2.0 * PI * radius) < 1e-3);
        }
        assert_int_equal(seen, 1);
        assert_true(fabs(area_of(&out, 0) - PI * radius * radius) < 1e-3);
        assert_true(fabs(area_of(&out, RAY_OUTSIDE) - (16.0 - PI * radius * radius)) < 1e-3);
        section_release(&out);
    }
    probe_destroy(p);
    scene_destroy(s);
}

/* Water, a post in it, and the air: three media meet in two points of a section. */
static void media_meet_in_a_junction(void **state)
{
    (void)state;
    scene *s = scene_from("solids:\n"
                          "  water: {shape: plane, position: [0, 0.0741, 0], transparency: 1, ior: 1.33}\n"
                          "  post: {shape: box, size: [0.4, 1.1, 0.6], position: [0.3137, 0.1, 0], priority: 1}\n");
    probe *p = probe_of(s);
    for (int cells = 40; cells < 100; cells += 3) {
        section out = cut(p, &upright, cells);
        for (int side = -1; side <= 1; side += 2) {
            double nearest = HUGE_VAL;
            for (size_t i = 0; i < out.line_count; i++)
                for (size_t k = 0; k < out.line[i].count; k += out.line[i].count - 1) {
                    const section_point at = out.point[out.line[i].first + k];
                    nearest = fmin(nearest, hypot(at.u - (0.3137 + 0.2 * side), at.v - 0.0741));
                }
            assert_true(nearest < 4.0 / cells / 4096.0); /* 2^-12 of a cell */
        }
        section_release(&out);
    }
    probe_destroy(p);
    scene_destroy(s);
}

/* Corners are exact, whatever the grid and the box's rotation. */
static void the_section_of_a_box_has_exact_corners(void **state)
{
    (void)state;
    const char *const turns[] = {"box.rotation=0,0,0", "box.rotation=0,0,30", "box.rotation=0,0,45"};
    for (int i = 0; i < 3; i++) {
        scene *s = scene_from("solids: {box: {shape: box, transparency: 1, ior: 1.5, size: [1.3, 0.7, 1]}}\n");
        set(s, turns[i]);
        probe *p = probe_of(s);
        section out = cut(p, &upright, 50);
        assert_true(fabs(length_between(&out, RAY_OUTSIDE, 0) - 4.0) < 1e-3);
        assert_true(fabs(area_of(&out, 0) - 1.3 * 0.7) < 1e-3);
        section_release(&out);
        probe_destroy(p);
        scene_destroy(s);
    }
}

/* rod.yaml in a vertical plane through the vessel's axis: the liquid, 1.8 wide, from the floor at y = 0.101 to 2.001,
 * the vessel's wall of 0.1; the rod, 0.25 wide, is in it from 0.601 up. */
static void a_vessels_section_shows_wall_and_floor(void **state)
{
    (void)state;
    enum { GROUND, VESSEL, LIQUID, ROD };
    scene *s = rod_scene("");
    probe *p = probe_of(s);
    const section_plane plane = {{0, 1.5, 0}, {1, 0, 0}, {0, 1, 0}, -2.03, 2.01, -2.04, 2.6};
    section out = cut(p, &plane, 300);
    assert_true(fabs(length_between(&out, VESSEL, LIQUID) - (1.8 + 2.0 * 1.9)) < 1e-3);
    assert_true(fabs(length_between(&out, LIQUID, ROD) - (0.25 + 2.0 * 1.4)) < 1e-3);
    assert_true(fabs(length_between(&out, LIQUID, RAY_OUTSIDE) - (1.8 - 0.25)) < 1e-3);
    assert_true(fabs(length_between(&out, ROD, RAY_OUTSIDE) - (0.25 + 2.0 * 1.6)) < 1e-3);
    assert_true(fabs(length_between(&out, VESSEL, RAY_OUTSIDE) - (2.0 * 3.0 + 2.0 * 0.1 + 2.0 * 0.999)) < 5e-3);
    assert_true(fabs(area_of(&out, VESSEL) - (2.0 * 3.0 - 1.8 * 2.9)) < 2e-3);
    assert_true(fabs(area_of(&out, LIQUID) - (1.8 * 1.9 - 0.25 * 1.4)) < 1e-3);
    section_release(&out);
    /* From above, below the water: rings. */
    const section_plane level = {{0, 0.4, 0}, {1, 0, 0}, {0, 0, 1}, -1.51, 1.52, -1.23, 1.24};
    out = cut(p, &level, 200);
    assert_true(fabs(length_between(&out, VESSEL, LIQUID) - 2.0 * PI * 0.9) < 1e-3);
    assert_true(fabs(length_between(&out, VESSEL, RAY_OUTSIDE) - 2.0 * PI) < 1e-3);
    assert_true(fabs(area_of(&out, VESSEL) - PI * (1.0 - 0.81)) < 1e-3);
    section_release(&out);
    probe_destroy(p);
    scene_destroy(s);
}

/* Two halves of one glass: light is not refracted there, but a section shows the boundary. */
static void sections_have_boundaries_between_equal_media(void **state)
{
    (void)state;
    scene *s = scene_from("solids:\n"
                          "  left: {shape: box, transparency: 1, ior: 1.5, position: [-0.5, 0, 0], size: [1, 1, 1]}\n"
                          "  right: {shape: box, transparency: 1, ior: 1.5, position: [0.4, 0, 0], size: [1, 1, 1]}\n");
    probe *p = probe_of(s);
    section out = cut(p, &upright, 77);
    assert_true(fabs(length_between(&out, 0, 1) - 1.0) < 1e-3);
    assert_true(fabs(length_between(&out, 0, RAY_OUTSIDE) - 3.0) < 1e-3);
    assert_true(fabs(length_between(&out, 1, RAY_OUTSIDE) - 2.8) < 1e-3);
    section_release(&out);
    probe_destroy(p);
    scene_destroy(s);
}

static void a_window_without_extent_is_refused(void **state)
{
    (void)state;
    scene *s = rod_scene("");
    probe *p = probe_of(s);
    section out = {0};
    section_plane plane = upright;
    plane.u1 = plane.u0;
    assert_int_equal(section_cut(p, &plane, 50, &out, NULL), STATUS_BAD_INPUT);
    plane = upright;
    plane.v1 = plane.v0;
    assert_int_equal(section_cut(p, &plane, 50, &out, NULL), STATUS_BAD_INPUT);
    assert_int_equal(section_cut(p, &upright, 1, &out, NULL), STATUS_BAD_INPUT);
    section_release(&out);
    probe_destroy(p);
    scene_destroy(s);
}

/* A coat far thinner than a cell: all four sides are drawn along the same face of it, not two along one face and two
 * along the other. */
static void a_thin_coat_is_drawn_along_one_face(void **state)
{
    (void)state;
    scene *s = scene_from(
        "solids:\n"
        "  core: {shape: box, transparency: 1, ior: 1.5, position: [0.01, 0.02, 0], size: [2, 2, 2], priority: 1}\n"
        "  coat: {shape: box, transparency: 1, ior: 1.3, position: [0.01, 0.02, 0], size: [2.000002, 2.000002, 2]}\n");
    probe *p = probe_of(s);
    section out = cut(p, &upright, 60);
    double least = HUGE_VAL, largest = 0.0;
    int sides[4] = {0};
    for (size_t k = 0; k < out.line_count; k++) {
        const section_line *line = &out.line[k];
        for (size_t i = 0; i < line->count && line->a != SECTION_EDGE && line->b != SECTION_EDGE; i++) {
            const section_point at = out.point[line->first + i];
            const double u = at.u - 0.01, v = at.v - 0.02, away = fmax(fabs(u), fabs(v));
            if (fmin(fabs(u), fabs(v)) > 0.8)
                continue; /* at a corner */
            sides[fabs(u) > fabs(v) ? u > 0.0 : 2 + (v > 0.0)]++;
            least = fmin(least, away), largest = fmax(largest, away);
        }
    }
    for (int k = 0; k < 4; k++)
        assert_true(sides[k] > 0);
    assert_true(largest - least < 1e-9 && (fabs(least - 1.0) < 1e-9 || fabs(least - 1.000001) < 1e-9));
    section_release(&out);
    probe_destroy(p);
    scene_destroy(s);
}

/* A box of triangles is drawn like one of six faces: corners (0.65, 0.35). */
static void the_section_of_a_mesh_box_equals_that_of_a_box(void **state)
{
    (void)state;
    scene *s =
        scene_from("meshes: {block: {generate: box, size: [1.3, 0.7, 1]}}\n"
                   "solids: {box: {shape: mesh, mesh: block, transparency: 1, ior: 1.5, position: [0.1, 0, 0]}}\n");
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    probe *p = probe_of(s);
    section out = cut(p, &upright, 50);
    assert_true(fabs(length_between(&out, RAY_OUTSIDE, 0) - 4.0) < 1e-3);
    assert_true(fabs(area_of(&out, 0) - 1.3 * 0.7) < 1e-3);
    section_release(&out);
    probe_destroy(p);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_spheres_section_is_a_circle),
        cmocka_unit_test(media_meet_in_a_junction),
        cmocka_unit_test(the_section_of_a_box_has_exact_corners),
        cmocka_unit_test(the_section_of_a_mesh_box_equals_that_of_a_box),
        cmocka_unit_test(a_vessels_section_shows_wall_and_floor),
        cmocka_unit_test(sections_have_boundaries_between_equal_media),
        cmocka_unit_test(a_window_without_extent_is_refused),
        cmocka_unit_test(a_thin_coat_is_drawn_along_one_face),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
