/* A mesh whose shells overlap is the union of them: its film is that of separate solids of one medium. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

#include "geometry/hierarchy/hierarchy.h"
#include "geometry/mesh/mesh_generators.h"
#include "mesh_fixture.h"
#include "random_stream.h"
#include "render_fixture.h"
#include "scene/model/open.h"

enum { BOXES_MAX = 5 };

typedef struct box {
    vec3 center, size, turn_deg;
} box;

static box random_box(uint64_t *seed)
{
    box b = {.center = random_point(seed, 0.7), .turn_deg = random_point(seed, 180.0)};
    b.size = vec3_make(random_real(seed, 0.3, 1.6), random_real(seed, 0.3, 1.6), random_real(seed, 0.3, 1.6));
    return b;
}

/* One shell for each box; inside out if the bit of its number is set. */
static mesh *mesh_of_boxes(const box *boxes, size_t count, unsigned inside_out)
{
    mesh *m = cubes(count);
    for (size_t c = 0; c < count; c++) {
        const mat3 turn = rotation_from_deg(boxes[c].turn_deg);
        put_cube(m, c, vec3_make(0.0, 0.0, 0.0), 1.0);
        for (size_t v = 8 * c; v < 8 * c + 8; v++) {
            const vec3 p = m->vertices[v], s = vec3_scale(boxes[c].size, 0.5);
            m->vertices[v] = vec3_add(boxes[c].center, mat3_apply(turn, vec3_make(p.x * s.x, p.y * s.y, p.z * s.z)));
        }
        for (size_t t = 12 * c; t < 12 * c + 12; t++)
            if (inside_out >> c & 1)
                turn_triangle(m, t);
    }
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_true(m->closed);
    assert_int_equal(m->shell_count, count);
    return m;
}

#define HEAD                                                                                                     \
    "render: {width: 48, height: 36, depth: 9}\nbackground: {kind: gradient, color: [0.2, 0.4, 0.9], horizon: "  \
    "[0.9, 0.8, 0.3]}\ncamera: {position: [0.3, 0.5, -4], target: [0, 0, 0]}\nlights: {lamp: {position: [4, 7, " \
    "-5]}}\n"
#define GLASS "transparency: 1, ior: 1.5"

static scene *scene_of_mesh(const mesh *m)
{
    scene *s = scene_from(HEAD "meshes: {body: {generate: box}}\nsolids: {s: {shape: mesh, mesh: body, " GLASS
                               ", shading: flat}}\n");
    mesh_retain(m);
    s->meshes[0].data = m;
    return s;
}

/* An analytic solid for each box; `air`: the number of one that is air, before the others, or -1. */
static scene *scene_of_boxes(const box *boxes, size_t count, int air)
{
    char text[4096];
    int at = snprintf(text, sizeof text, HEAD "solids:\n");
    for (size_t i = 0; i < count; i++) {
        const box *b = &boxes[i];
        at += snprintf(text + at, sizeof text - (size_t)at,
                       "  b%zu: {shape: box, position: [%.17g, %.17g, %.17g], size: [%.17g, %.17g, %.17g], "
                       "rotation: [%.17g, %.17g, %.17g], %s}\n",
                       i, b->center.x, b->center.y, b->center.z, b->size.x, b->size.y, b->size.z, b->turn_deg.x,
                       b->turn_deg.y, b->turn_deg.z, (int)i == air ? "transparency: 1, ior: 1, priority: 2" : GLASS);
    }
    return scene_from(text);
}

/* Pixels that differ by more than 1e-9. */
static int different(scene *one, scene *other)
{
    worked(scene_load(one, NULL), NULL);
    worked(scene_load(other, NULL), NULL);
    render_result *a = render(one), *b = render(other);
    int count = 0;
    for (int i = 0; i < a->img->width * a->img->height; i++) {
        bool same = true;
        for (int c = 0; c < 3; c++)
            same &= fabs(film_value(a->img, i % a->img->width, i / a->img->width, c) -
                         film_value(b->img, i % a->img->width, i / a->img->width, c)) <= 1e-9;
        count += !same;
    }
    render_result_destroy(a);
    render_result_destroy(b);
    scene_destroy(one);
    scene_destroy(other);
    return count;
}

static int operands_of(const mesh *m, const mesh *const **operands)
{
    int count;
    diagnostic why = {0};
    const mesh *const *list;
    worked(hierarchy_operands(m, 1, &list, &count, &why), &why);
    if (operands)
        *operands = list;
    return count;
}

static void overlapping_boxes_are_their_union(void **state)
{
    (void)state;
    uint64_t seed = 1;
    int most = 0;
    for (int round = 0; round < 12; round++) {
        box boxes[BOXES_MAX];
        const size_t count = 2 + (size_t)random_below(&seed, BOXES_MAX - 1);
        for (size_t i = 0; i < count; i++)
            boxes[i] = random_box(&seed);
        mesh *m = mesh_of_boxes(boxes, count, 0);
        const int operands = operands_of(m, NULL);
        most = operands > most ? operands : most;
        assert_int_equal(different(scene_of_mesh(m), scene_of_boxes(boxes, count, -1)), 0);
        mesh_release(m);
    }
    assert_true(most > 2);
}

/* From within the glass, too, and from both sides: the camera of the one scene is in a box. */
static void a_camera_inside_sees_the_union(void **state)
{
    (void)state;
    uint64_t seed = 2;
    for (int round = 0; round < 6; round++) {
        box boxes[3];
        for (size_t i = 0; i < 3; i++)
            boxes[i] = random_box(&seed);
        mesh *m = mesh_of_boxes(boxes, 3, 0);
        scene *one = scene_of_mesh(m), *other = scene_of_boxes(boxes, 3, -1);
        char place[256];
        snprintf(place, sizeof place, "camera.position=%.17g,%.17g,%.17g camera.target=%.17g,%.17g,%.17g",
                 boxes[1].center.x, boxes[1].center.y, boxes[1].center.z, boxes[0].center.x, boxes[0].center.y,
                 boxes[0].center.z + 0.1);
        set_all(one, place);
        set_all(other, place);
        assert_int_equal(different(one, other), 0);
        mesh_release(m);
    }
}

static const box unit = {{0, 0, 0}, {2, 2, 2}, {0, 30, 10}}, small = {{0.1, -0.1, 0.2}, {0.8, 0.7, 0.6}, {20, 0, 5}},
                 apart = {{3, 0.5, 0}, {1, 1, 1}, {0, 10, 0}};

static void a_shell_in_a_shell_is_hidden(void **state)
{
    (void)state;
    const box both[2] = {unit, small};
    mesh *m = mesh_of_boxes(both, 2, 0);
    assert_int_equal(operands_of(m, NULL), 2);
    assert_int_equal(different(scene_of_mesh(m), scene_of_boxes(both, 1, -1)), 0);
    mesh_release(m);
}

static void a_hollow_stays_one(void **state)
{
    (void)state;
    const box both[2] = {unit, small};
    mesh *m = mesh_of_boxes(both, 2, 2);
    const mesh *const *operands;
    assert_int_equal(operands_of(m, &operands), 1);
    assert_ptr_equal(operands[0], m);
    assert_int_equal(different(scene_of_mesh(m), scene_of_boxes(both, 2, 1)), 0);
    mesh_release(m);
}

/* Solid in a hollow in a solid, and a hollow that a further shell covers in part. */
static void hollows_count_by_winding(void **state)
{
    (void)state;
    const box nest[3] = {unit, small, {{0.1, -0.1, 0.2}, {0.3, 0.3, 0.2}, {1, 2, 3}}};
    mesh *m = mesh_of_boxes(nest, 3, 2);
    assert_int_equal(operands_of(m, NULL), 1);
    mesh_release(m);
    const box part[3] = {unit, small, {{0.4, 0.1, 0.2}, {0.5, 0.6, 0.3}, {7, 2, 3}}};
    m = mesh_of_boxes(part, 3, 2);
    assert_int_equal(operands_of(m, NULL), 2);
    scene *other = scene_of_boxes(part, 3, 1);
    set(other, "b2.priority=3");
    assert_int_equal(different(scene_of_mesh(m), other), 0);
    mesh_release(m);
}

static void shells_apart_are_one_operand(void **state)
{
    (void)state;
    const box both[2] = {unit, apart};
    mesh *m = mesh_of_boxes(both, 2, 0);
    const mesh *const *operands;
    assert_int_equal(operands_of(m, &operands), 1);
    assert_ptr_equal(operands[0], m);
    mesh_release(m);
}

/* Boxes of shells that overlap though the shells do not. */
static void shells_that_miss_each_other_are_one_operand(void **state)
{
    (void)state;
    const box both[2] = {{{0, 0, 0}, {4, 0.2, 0.2}, {0, 0, 45}}, {{0.5, -0.5, 0}, {4, 0.2, 0.2}, {0, 0, 45}}};
    mesh *m = mesh_of_boxes(both, 2, 0);
    assert_int_equal(operands_of(m, NULL), 1);
    mesh_release(m);
}

static void a_shell_that_is_inside_out_is_turned(void **state)
{
    (void)state;
    const box both[2] = {unit, apart};
    mesh *m = mesh_of_boxes(both, 2, 2);
    const mesh *const *operands;
    assert_int_equal(operands_of(m, &operands), 1);
    assert_ptr_not_equal(operands[0], m);
    assert_int_equal(operands[0]->triangle_count, 24);
    assert_int_equal(operands[0]->numbers[13], 13);
    assert_int_equal(different(scene_of_mesh(m), scene_of_boxes(both, 2, -1)), 0);
    mesh_release(m);
}

static void a_hollow_that_crosses_a_shell_is_refused(void **state)
{
    (void)state;
    const box both[2] = {{{0, 0, 0}, {2, 2, 2}, {0, 0, 0}}, {{1, 0, 0}, {1, 1, 1}, {0, 0, 0}}};
    mesh *m = mesh_of_boxes(both, 2, 2);
    const mesh *const *operands;
    int count;
    diagnostic why = {0};
    assert_int_equal(hierarchy_operands(m, 1, &operands, &count, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "those of triangles 12 and 0 at (1, 0.5, 0.5), and one is a hollow"));
    scene *s = scene_of_mesh(m);
    worked(scene_load(s, &why), &why);
    assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "s: shells of the mesh overlap"));
    set(s, "s.transparency=0"); /* rays do not see the inside */
    worked(scene_check(s, &why), &why);
    scene_destroy(s);
    mesh_release(m);
}

static void refused_at(const mesh *m, const char *text)
{
    const mesh *const *operands;
    int count;
    diagnostic why = {0};
    assert_int_equal(hierarchy_operands(m, 1, &operands, &count, &why), STATUS_BAD_INPUT);
    if (!strstr(why.what, text))
        fail_msg("%s", why.what);
}

/* The place is a corner of the innermost, whose first triangle is the first of the file. */
static void more_than_32_in_one_another_are_refused(void **state)
{
    (void)state;
    enum { N = 33 };
    mesh *m = cubes(N);
    for (size_t c = 0; c < N; c++)
        put_cube(m, c, vec3_make(5.0, 0.0, 0.0), 1.0 + (double)c);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    refused_at(m, "those of triangles 0 and 12 at (4, -1, -1), and are nested more than 32 deep");
    mesh_release(m);
}

/* A prism over a star of five points, drawn in one line, winds twice around its middle. */
static void a_shell_in_one_that_winds_twice_is_refused(void **state)
{
    (void)state;
    enum { N = 5, MIDDLE = 8 + 2 * N };
    mesh *m = NULL;
    assert_int_equal(mesh_create(MIDDLE + 2, 12 + 4 * N, false, false, false, &m, NULL), STATUS_OK);
    put_cube(m, 0, vec3_make(0.0, 0.0, 0.0), 0.05);
    for (int i = 0; i <= 2 * N + 1; i++) {
        const double turn = 2.0 * 3.141592653589793 * (2 * (i / 2) + 0.1) / N, radius = i / 2 == N ? 0.0 : 1.0;
        m->vertices[8 + i] = vec3_make(radius * cos(turn), radius * sin(turn), i % 2 ? 1.0 : -1.0);
    }
    for (uint32_t i = 0; i < N; i++) {
        const uint32_t a = 8 + 2 * i, b = 8 + 2 * ((i + 1) % N);
        m->triangles[12 + 4 * i] = (mesh_triangle){{MIDDLE, b, a}};
        m->triangles[13 + 4 * i] = (mesh_triangle){{MIDDLE + 1, a + 1, b + 1}};
        m->triangles[14 + 4 * i] = (mesh_triangle){{a, b, b + 1}};
        m->triangles[15 + 4 * i] = (mesh_triangle){{a, b + 1, a + 1}};
    }
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_int_equal(m->shell_count, 2);
    refused_at(m, "those of triangles 0 and 12 at (-0.05, -0.05, -0.05), and it is not clear");
    mesh_release(m);
}

/* --- shells that touch --- */

static vec3 turned = {17, 40, 9}; /* degrees, of all that follows */

typedef struct cell_faces {
    mesh *m; /* NULL while triangles are counted */
    size_t count;
    bool inside_out;
} cell_faces;

static void add_quad(cell_faces *f, vec3 from, vec3 to, int axis, bool high)
{
    static const int corners[2][3] = {{0, 1, 3}, {0, 3, 2}};
    const bool turn = f->inside_out != high;
    for (int i = 0; i < 2; i++, f->count++)
        for (int k = 0; f->m && k < 3; k++) {
            const int at = corners[i][turn && k ? 3 - k : k], u = (axis + 1) % 3, v = (axis + 2) % 3;
            double p[3] = {from.x, from.y, from.z};
            const double end[3] = {to.x, to.y, to.z};
            p[u] = at & 1 ? end[u] : p[u];
            p[v] = at & 2 ? end[v] : p[v];
            f->m->triangles[f->count].corner[k] = (uint32_t)(3 * f->count) + (uint32_t)k;
            f->m->vertices[3 * f->count + (size_t)k] =
                mat3_apply(rotation_from_deg(turned), vec3_make(p[0], p[1], p[2]));
        }
}

/* The faces of a box of whole coordinates, in squares of size 1 if `cells`, otherwise in rectangles. */
static void add_box(cell_faces *f, const box *b, bool cells)
{
    const vec3 half = vec3_scale(b->size, 0.5), low = vec3_sub(b->center, half), high = vec3_add(b->center, half);
    const double l[3] = {low.x, low.y, low.z}, h[3] = {high.x, high.y, high.z};
    for (int side = 0; side < 6; side++) {
        const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const double su = cells ? 1.0 : h[u] - l[u], sv = cells ? 1.0 : h[v] - l[v];
        for (double x = l[u]; x < h[u]; x += su)
            for (double y = l[v]; y < h[v]; y += sv) {
                double from[3], to[3];
                from[axis] = to[axis] = side % 2 ? h[axis] : l[axis];
                from[u] = x, to[u] = x + su, from[v] = y, to[v] = y + sv;
                add_quad(f, vec3_make(from[0], from[1], from[2]), vec3_make(to[0], to[1], to[2]), axis, side % 2);
            }
    }
}

/* Boxes of whole coordinates, which have common vertices where they touch if they consist of cells. The mesh is turned,
 * so that its faces are not along the axes. */
static mesh *mesh_of_cells(const box *boxes, size_t count, unsigned inside_out, bool cells)
{
    mesh *m = NULL;
    cell_faces f = {0};
    for (size_t i = 0; i < count; i++)
        add_box(&f, &boxes[i], cells);
    assert_int_equal(mesh_create(3 * f.count, f.count, false, false, false, &m, NULL), STATUS_OK);
    f = (cell_faces){.m = m};
    for (size_t i = 0; i < count; i++) {
        f.inside_out = inside_out >> i & 1;
        add_box(&f, &boxes[i], cells);
    }
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    return m;
}

/* From eight sides, the film of the mesh is that of analytic boxes, which are turned alike. */
static void is_union(const mesh *m, const box *boxes, size_t count, int air)
{
    assert_true(m->closed);
    box alike[BOXES_MAX];
    for (size_t i = 0; i < count; i++) {
        alike[i] = boxes[i];
        alike[i].center = mat3_apply(rotation_from_deg(turned), boxes[i].center);
        alike[i].turn_deg = turned;
    }
    for (int side = 0; side < 8; side++) {
        scene *one = scene_of_mesh(m), *other = scene_of_boxes(alike, count, air);
        char place[160];
        snprintf(place, sizeof place, "camera.position=%d.3,%d.5,%d render.depth=6", side & 1 ? 8 : -8,
                 side & 2 ? 5 : -5, side & 4 ? 9 : -9);
        set_all(one, place);
        set_all(other, place);
        const int count_different = different(one, other);
        if (count_different)
            fail_msg("%d pixels from side %d", count_different, side);
    }
}

static void touch_is_union(const box *boxes, size_t count, int shells, int operands)
{
    for (int cells = 0; cells < 2; cells++) {
        mesh *m = mesh_of_cells(boxes, count, 0, cells);
        is_union(m, boxes, count, -1);
        if (cells) {
            assert_int_equal(m->shell_count, shells);
            assert_int_equal(operands_of(m, NULL), operands);
        }
        mesh_release(m);
    }
}

#define BOX(x, y, z, a, b, c) \
    {                         \
        {x, y, z}, {a, b, c}, \
        {                     \
            0, 0, 0           \
        }                     \
    }

static void glued_boxes_are_one_box(void **state)
{
    (void)state;
    const box two[2] = {BOX(-1, 0, 0, 2, 2, 2), BOX(1, 0, 0, 2, 2, 2)}, long_one = BOX(0, 0, 0, 4, 2, 2);
    for (int cells = 0; cells < 2; cells++) {
        mesh *m = mesh_of_cells(two, 2, 0, cells);
        const mesh *const *operands;
        assert_int_equal(m->shell_count, 1);
        assert_int_equal(operands_of(m, &operands), 1);
        assert_int_equal(operands[0]->triangle_count, m->triangle_count - (cells ? 16 : 4));
        is_union(m, &long_one, 1, -1);
        mesh_release(m);
    }
    box block[8]; /* with faces, edges and a corner inside */
    for (int i = 0; i < 8; i++)
        block[i] = (box){{i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1}, {2, 2, 2}, {0, 0, 0}};
    const box large = BOX(0, 0, 0, 4, 4, 4);
    mesh *m = mesh_of_cells(block, 8, 0, false);
    assert_int_equal(m->shell_count, 1);
    is_union(m, &large, 1, -1);
    mesh_release(m);
}

static void shells_that_touch_are_their_union(void **state)
{
    (void)state;
    const box unit_box = BOX(0, 0, 0, 2, 2, 2);
    const box edge[2] = {unit_box, BOX(2, 2, 0, 2, 2, 2)}, vertex[2] = {unit_box, BOX(2, 2, 2, 2, 2, 2)},
              knob[2] = {BOX(0, 0, 0, 2, 4, 4), BOX(2, 0, 0, 2, 2, 2)}, /* on a part of a face */
        flush[2] = {BOX(0, 0, 0, 2, 4, 4), BOX(2, 0, 0, 2, 2, 4)},
              cross[2] = {BOX(0, 0, 0, 2, 2, 6), BOX(2, 0, 0, 2, 6, 2)},
              within[2] = {BOX(0, 0, 0, 4, 4, 4), BOX(1, 0, 0, 2, 2, 2)}, /* with a common face */
        slab[2] = {BOX(0, 0, 0, 4, 4, 4), BOX(1, 0, 0, 2, 4, 4)},
              corner[3] = {unit_box, BOX(2, 0, 0, 2, 2, 2), BOX(2, 2, 0, 2, 2, 2)};
    touch_is_union(edge, 2, 2, 2);
    touch_is_union(vertex, 2, 2, 2);
    touch_is_union(knob, 2, 1, 1);
    touch_is_union(flush, 2, 1, 1);
    touch_is_union(cross, 2, 1, 1);
    touch_is_union(within, 2, 2, 2);
    touch_is_union(slab, 2, 2, 2);
    touch_is_union(corner, 3, 1, 1);
}

/* Layers only, for more places of corners and edges next to faces than can be rendered. */
static void touching_faces_are_found_however_turned(void **state)
{
    (void)state;
    static const box pairs[][2] = {
        {BOX(0, 0, 0, 2, 4, 4), BOX(2, 0, 0, 2, 2, 2)}, {BOX(0, 0, 0, 2, 4, 4), BOX(2, 0, 0, 2, 2, 4)},
        {BOX(0, 0, 0, 2, 2, 6), BOX(2, 0, 0, 2, 6, 2)}, {BOX(0, 0, 0, 4, 4, 4), BOX(1, 0, 0, 2, 2, 2)},
        {BOX(0, 0, 0, 4, 4, 4), BOX(1, 0, 0, 2, 4, 4)}, {BOX(0, 0, 0, 4, 4, 4), BOX(0, 0, 0, 4, 4, 2)},
        {BOX(0, 0, 0, 2, 6, 2), BOX(2, 2, 0, 2, 6, 2)}};
    uint64_t seed = 4;
    const vec3 before = turned;
    for (int round = 0; round < 200; round++) {
        turned = round == 0 ? vec3_make(0, 0, 0) : random_point(&seed, 180.0);
        for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
            for (int cells = 0; cells < 2; cells++) {
                mesh *m = mesh_of_cells(pairs[i], 2, 0, cells);
                assert_int_equal(operands_of(m, NULL), m->shell_count);
                mesh_release(m);
            }
    }
    turned = before;
}

static void doubled_shells_count_once(void **state)
{
    (void)state;
    const box twice[3] = {BOX(0, 0, 0, 2, 4, 2), BOX(0, 0, 0, 2, 4, 2), BOX(0, 0, 0, 2, 4, 2)};
    for (unsigned inside_out = 0; inside_out < 8; inside_out += 7) {
        mesh *m = mesh_of_cells(twice, 3, inside_out, false);
        const mesh *const *operands;
        assert_int_equal(m->shell_count, 1);
        assert_int_equal(operands_of(m, &operands), 1);
        assert_int_equal(operands[0]->triangle_count, 12);
        is_union(m, twice, 1, -1);
        mesh_release(m);
    }
}

/* Overlapping, nested, glued and touching in every manner; one may be inside out, which is turned unless it is a
 * hollow. */
static void random_boxes_of_a_grid_are_their_union(void **state)
{
    (void)state;
    uint64_t seed = 3;
    for (int round = 0; round < 24; round++) {
        box boxes[BOXES_MAX];
        const size_t count = 2 + (size_t)random_below(&seed, BOXES_MAX - 1);
        for (size_t i = 0; i < count; i++) {
            double low[3], size[3];
            for (int k = 0; k < 3; k++) {
                low[k] = (double)random_below(&seed, 4) - 2.0;
                size[k] = 1.0 + (double)random_below(&seed, 2);
            }
            boxes[i] = (box){.size = {size[0], size[1], size[2]}};
            boxes[i].center = vec3_make(low[0] + size[0] / 2, low[1] + size[1] / 2, low[2] + size[2] / 2);
        }
        for (int cells = 0; cells < 2; cells++) {
            mesh *m = mesh_of_cells(boxes, count, 0, cells);
            is_union(m, boxes, count, -1);
            mesh_release(m);
        }
    }
}

/* The face of the cavity cancels a part of the solid's face; elsewhere one at an edge. */
static void a_cavity_at_a_face_is_a_notch(void **state)
{
    (void)state;
    const box notch[2] = {BOX(0, 0, 0, 4, 4, 4), BOX(1, 0, 0, 2, 2, 2)},
              groove[2] = {BOX(0, 0, 0, 4, 4, 4), BOX(1, 1, 0, 2, 2, 2)};
    for (int i = 0; i < 2; i++) {
        mesh *m = mesh_of_cells(i ? groove : notch, 2, 2, true);
        assert_int_equal(m->shell_count, 1);
        is_union(m, i ? groove : notch, 2, 1);
        mesh_release(m);
    }
}

static void refused_as(mesh *m, mesh_fault fault, const char *text)
{
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_false(m->closed);
    assert_int_equal(m->hole.fault, fault);
    diagnostic why = {0};
    scene *s = scene_of_mesh(m);
    worked(scene_load(s, &why), &why);
    assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
    if (!strstr(why.what, text) || strstr(why.what, "is open") || strstr(why.remedy, "--close"))
        fail_msg("%s; %s", why.what, why.remedy);
    scene_destroy(s);
    mesh_release(m);
}

static void shells_that_do_not_pair_are_refused(void **state)
{
    (void)state;
    mesh *m = cubes(2); /* a wall between two rooms that is there once */
    put_cube(m, 1, vec3_make(2.0, 0.0, 0.0), 1.0);
    for (size_t t = 20; t < 22; t++) /* its face to the first one */
        m->triangles[t] = (mesh_triangle){{8, 8, 8}};
    refused_as(m, MESH_ODD, "which 3 share");
    m = cubes(2);
    put_cube(m, 1, vec3_make(2.0, 0.0, 0.0), 1.0);
    turn_triangle(m, 22);
    turn_triangle(m, 10);
    turn_triangle(m, 9);
    refused_as(m, MESH_UNBALANCED, "do not agree");
    m = cubes(2); /* each face looks to both sides */
    put_cube(m, 1, vec3_make(0.0, 0.0, 0.0), 1.0);
    for (size_t t = 0; t < 12; t++)
        turn_triangle(m, t);
    refused_as(m, MESH_CANCELLED, "faces the other way");
}

/* A box and its double whose faces have the other diagonals, whose triangles are in the order of the file,
 * or not. */
static void shells_in_the_planes_of_others_are_refused(void **state)
{
    (void)state;
    for (int mixed = 0; mixed < 2; mixed++) {
        mesh *m = cubes(2), *other = cubes(2);
        put_cube(m, 1, vec3_make(0.0, 0.0, 0.0), 1.0);
        for (size_t t = 12; t < 24; t += 2) { /* a b c, a c d becomes a b d, b c d */
            const uint32_t *one = m->triangles[t].corner, d = m->triangles[t + 1].corner[2];
            const mesh_triangle first = {{one[0], one[1], d}}, second = {{one[1], one[2], d}};
            m->triangles[t] = first;
            m->triangles[t + 1] = second;
        }
        memcpy(other->triangles, m->triangles, 24 * sizeof *m->triangles);
        if (mixed) {
            m->triangles[1] = other->triangles[13];
            m->triangles[13] = other->triangles[1];
        }
        mesh_release(other);
        assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
        assert_true(m->closed && m->crowded);
        if (mixed)
            refused_at(m, "parts of the mesh that share edges lie in each other");
        else
            assert_int_equal(operands_of(m, NULL), 2);
        mesh_release(m);
    }
}

/* Vertices with all that they have, materials, and numbers in the mesh. */
static void operands_are_copies_of_shells(void **state)
{
    (void)state;
    enum { N = 3 };
    mesh *m = NULL;
    uint64_t seed = 8;
    assert_int_equal(mesh_create(8 * N, 12 * N, true, true, true, &m, NULL), STATUS_OK);
    for (size_t c = 0; c < N; c++)
        put_cube(m, c, vec3_make(0.5 * (double)c, 0.3 * (double)c, 0.0), 1.0);
    for (size_t v = 0; v < m->vertex_count; v++) {
        m->normals[v] = random_point(&seed, 1.0);
        m->uvs[v] = (mesh_uv){random_real(&seed, 0.0, 1.0), (double)v};
    }
    m->slot_count = 7;
    for (size_t t = 0; t < m->triangle_count; t++)
        m->slots[t] = (uint8_t)random_below(&seed, 7);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    const mesh *const *operands;
    bool seen[12 * N] = {false};
    assert_int_equal(operands_of(m, &operands), N);
    for (int i = 0; i < N; i++) {
        assert_int_equal(operands[i]->slot_count, 7);
        assert_int_equal(operands[i]->triangle_count, 12);
        for (size_t t = 0; t < 12; t++) {
            const uint32_t in = operands[i]->numbers[t];
            assert_false(seen[in]);
            seen[in] = true;
            assert_int_equal(operands[i]->slots[t], m->slots[in]);
            for (int k = 0; k < 3; k++) {
                const uint32_t v = operands[i]->triangles[t].corner[k], w = m->triangles[in].corner[k];
                assert_memory_equal(&operands[i]->vertices[v], &m->vertices[w], sizeof(vec3));
                assert_true(vec3_length(vec3_sub(operands[i]->normals[v], m->normals[w])) < 1e-15);
                assert_true(operands[i]->uvs[v].u == m->uvs[w].u && operands[i]->uvs[v].v == m->uvs[w].v);
            }
        }
    }
    mesh_release(m);
}

/* A mesh that moves has other operands. */
static void moved_shells_are_divided_again(void **state)
{
    (void)state;
    box both[2] = {unit, apart};
    mesh *m = mesh_of_boxes(both, 2, 0);
    assert_int_equal(operands_of(m, NULL), 1);
    both[1].center.x = 1.0;
    mesh *over = mesh_of_boxes(both, 2, 0);
    assert_int_equal(mesh_move(m, over->vertices, NULL, NULL), STATUS_OK);
    assert_int_equal(operands_of(m, NULL), 2);
    mesh_release(m);
    mesh_release(over);
}

/* Spheres of many triangles: one mesh of two against two meshes. */
static void overlapping_spheres_are_their_union(void **state)
{
    (void)state;
    mesh *ball = NULL, *m = NULL;
    assert_int_equal(generate_icosphere(3, &ball, NULL), STATUS_OK);
    const size_t n = ball->vertex_count, count = ball->triangle_count;
    assert_int_equal(mesh_create(2 * n, 2 * count, false, false, false, &m, NULL), STATUS_OK);
    for (size_t i = 0; i < 2 * n; i++)
        m->vertices[i] = vec3_add(ball->vertices[i % n], vec3_make(i < n ? -0.5 : 0.5, 0.0, 0.0));
    for (size_t t = 0; t < 2 * count; t++)
        for (int k = 0; k < 3; k++)
            m->triangles[t].corner[k] = ball->triangles[t % count].corner[k] + (t < count ? 0 : (uint32_t)n);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    scene *two = scene_from(HEAD "meshes: {ball: {generate: icosphere, level: 3}}\nsolids:\n"
                                 "  a: {shape: mesh, mesh: ball, position: [-0.5, 0, 0], shading: flat, " GLASS "}\n"
                                 "  b: {shape: mesh, mesh: ball, position: [0.5, 0, 0], shading: flat, " GLASS "}\n");
    assert_int_equal(different(scene_of_mesh(m), two), 0);
    mesh_release(m);
    mesh_release(ball);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(overlapping_boxes_are_their_union),
        cmocka_unit_test(a_camera_inside_sees_the_union),
        cmocka_unit_test(a_shell_in_a_shell_is_hidden),
        cmocka_unit_test(a_hollow_stays_one),
        cmocka_unit_test(hollows_count_by_winding),
        cmocka_unit_test(shells_apart_are_one_operand),
        cmocka_unit_test(shells_that_miss_each_other_are_one_operand),
        cmocka_unit_test(a_shell_that_is_inside_out_is_turned),
        cmocka_unit_test(a_hollow_that_crosses_a_shell_is_refused),
        cmocka_unit_test(more_than_32_in_one_another_are_refused),
        cmocka_unit_test(a_shell_in_one_that_winds_twice_is_refused),
        cmocka_unit_test(glued_boxes_are_one_box),
        cmocka_unit_test(shells_that_touch_are_their_union),
        cmocka_unit_test(touching_faces_are_found_however_turned),
        cmocka_unit_test(doubled_shells_count_once),
        cmocka_unit_test(random_boxes_of_a_grid_are_their_union),
        cmocka_unit_test(a_cavity_at_a_face_is_a_notch),
        cmocka_unit_test(shells_that_do_not_pair_are_refused),
        cmocka_unit_test(shells_in_the_planes_of_others_are_refused),
        cmocka_unit_test(operands_are_copies_of_shells),
        cmocka_unit_test(moved_shells_are_divided_again),
        cmocka_unit_test(overlapping_spheres_are_their_union),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
