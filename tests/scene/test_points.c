/* Tests of solids at the points of a file: the film is that of the same solids one by one; bad files; edits. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/text.h"
#include "geometry/shapes/shape.h"
#include "lint/lint.h"
#include "package_fixture.h"
#include "random_stream.h"
#include "render/inspect/probe.h"
#include "report/mesh_writers.h"
#include "scene/assets/mesh_stream.h"
#include "scene/file/write.h"
#include "scene/model/edit/edit.h"
#include "scene/model/place/placement.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- the film --- */

enum { POINTS = 40 };

static const char head[] = "render: {width: 40, height: 30, depth: 4}\n"
                           "camera: {position: [0.3, 0.6, -6], target: [0, 0, 0], fov_deg: 40}\n"
                           "background: {kind: gradient, color: [0.2, 0.4, 0.9], horizon: [0.9, 0.8, 0.6]}\n"
                           "lights: {lamp: {position: [3, 5, -4]}}\n"
                           "materials: {glass: {transparency: 1, ior: 1.5, color: [0.9, 0.95, 1]}}\n";

/* Writes `count` points to points.xyz. */
static void put_points(const vec3 *points, int count)
{
    text_writer w;
    char *text;
    assert_int_equal(text_writer_open(&w, NULL), STATUS_OK);
    for (int i = 0; i < count; i++)
        fprintf(w.stream, "%.17g %.17g,%.17g\n", points[i].x, points[i].y, points[i].z);
    assert_int_equal(text_writer_close(&w, &text, NULL, NULL), STATUS_OK);
    put_text("points.xyz", text);
    free(text);
}

static scene *read_loaded(const char *text)
{
    put_text("scene.yaml", text);
    char *path = in_folder("scene.yaml");
    scene *s = NULL;
    diagnostic why = {.what = ""};
    worked(scene_read(path, &s, &why), &why);
    worked(scene_load(s, &why), &why);
    free(path);
    return s;
}

static scene *cloud_of(const char *keys)
{
    char *text = text_format("%smeshes: {places: {file: points.xyz}}\nsolids:\n  floor: {shape: plane, position: [0, "
                             "-2, 0]}\n  drop: {points: places, %s}\n  last: {shape: box, size: [1, 1, 1], "
                             "material: glass}\n",
                             head, keys);
    scene *s = read_loaded(text);
    free(text);
    return s;
}

/* The scene with a solid for each point of the cloud. */
static scene *one_by_one(const scene *cloud, const char *keys)
{
    text_writer w;
    char *text;
    const solid_shape shape = scene_loaded_shape(cloud, &cloud->solids[1]);
    assert_int_equal(text_writer_open(&w, NULL), STATUS_OK);
    fprintf(w.stream, "%ssolids:\n  floor: {shape: plane, position: [0, -2, 0]}\n", head);
    for (size_t i = 0; i < solid_shape_count(&shape); i++)
        fprintf(w.stream, "  s%zu: {%s}\n", i, keys);
    fputs("  last: {shape: box, size: [1, 1, 1], material: glass}\n", w.stream);
    assert_int_equal(text_writer_close(&w, &text, NULL, NULL), STATUS_OK);
    scene *s = read_loaded(text);
    free(text);
    for (size_t i = 0; i < solid_shape_count(&shape); i++) { /* the scale is that of the points */
        s->solids[i + 1].shape.position = solid_shape_copy(&shape, i).position;
        s->solids[i + 1].shape.scale = vec3_make(1.0, 1.0, 1.0);
    }
    return s;
}

static uint64_t film_of(const scene *s, isa level)
{
    render_result *r = render_at(s, level, NULL);
    const uint64_t hash = film_hash(r->img);
    render_result_destroy(r);
    return hash;
}

static void a_cloud_has_the_film_of_its_solids(void **state)
{
    (void)state;
    static const char *const solids[] = {
        "shape: sphere, radius: 0.35, material: glass",
        "shape: sphere, radius: 0.3, diffuse: 0.7, reflectivity: 0.3, priority: 3",
        "shape: sphere, radius: 0.4, transparency: 0.8, reflectivity: 0.1, ior: 1.3, checker: 0.1",
        "shape: box, size: [0.3, 0.4, 0.5], rotation: [10, 20, 30], scale: [1.2, 0.7, 1], position: [0.1, 0.2, 0.3], "
        "material: glass",
        "shape: cup, radius: 0.3, inner_radius: 0.25, height: 0.5, floor: 0.05, material: glass, ior: 1.7",
        "shape: lens, diameter: 0.6, thickness: 0.2, material: glass",
        "shape: cylinder, radius: 0.3, height: 0.4, transparency: 1, ior: 1.33, capillary_length: 0.1, "
        "contact_angle_deg: 20"};
    static const char *const settings[] = {"", "render.weights=constant", "render.accel=none",
                                           "render.integrator=path render.paths=2", "render.spectrum=spectral"};
    uint64_t seed = 5;
    vec3 points[POINTS];
    for (int i = 0; i < POINTS; i++)
        points[i] = random_point(&seed, 1.5);
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
        put_points(points, i % 2 ? POINTS : 6); /* with a tree, and without */
        for (size_t k = 0; k < sizeof settings / sizeof *settings; k++) {
            scene *a = cloud_of(solids[i]), *b = one_by_one(a, solids[i]);
            set_all(a, settings[k]), set_all(b, settings[k]);
            const uint64_t hash = film_of(b, isa_best());
            assert_true(film_of(a, isa_best()) == hash);
            set(a, "drop.visible=off"); /* the cloud is seen at all */
            assert_true(film_of(a, isa_best()) != hash);
            scene_destroy(a);
            scene_destroy(b);
        }
    }
}

static void a_cloud_is_where_its_solids_are(void **state)
{
    (void)state;
    uint64_t seed = 9;
    vec3 points[POINTS];
    for (int i = 0; i < POINTS; i++)
        points[i] = random_point(&seed, 1.5);
    put_points(points, POINTS);
    scene *s = cloud_of("shape: cone, radius: 0.2, height: 0.5, rotation: [20, 30, 40], position: [1, 2, 3], scale: "
                        "[1, 2, 3]");
    const solid_shape shape = scene_loaded_shape(s, &s->solids[1]);
    assert_int_equal(solid_shape_count(&shape), POINTS);
    vec3 centre;
    double radius;
    assert_true(placement_bounding_sphere(s, &s->solids[1], &centre, &radius));
    const bounds3 all = shape_world_box(&shape);
    const placed_shape placed = shape_placed(&shape);
    for (size_t i = 0; i < POINTS; i++) {
        const solid_shape one = solid_shape_copy(&shape, i);
        assert_null(one.points);
        const shape_extent e = shape_of(&one)->extent(&one);
        const vec3 middle = vec3_add(one.position, mat3_apply(rotation_from_deg(one.rotation_deg),
                                                              vec3_scale(vec3_add(e.box.low, e.box.high), 0.5)));
        assert_true(vec3_length(vec3_sub(middle, centre)) + e.ball <= radius * (1.0 + 1e-12));
        const bounds3 b = shape_world_box(&one);
        assert_true(b.low.x >= all.low.x - 1e-12 && b.low.y >= all.low.y - 1e-12 && b.low.z >= all.low.z - 1e-12);
        assert_true(b.high.x <= all.high.x + 1e-12 && b.high.y <= all.high.y + 1e-12 && b.high.z <= all.high.z + 1e-12);
        const placed_shape single = shape_placed(&one);
        for (int k = 0; k < 20; k++) {
            const vec3 d = random_direction(&seed);
            assert_true(placed_farthest(&single, d) <= placed_farthest(&placed, d) + 1e-12);
        }
    }
    scene_destroy(s);
}

/* --- notes, and media of points --- */

/* The notes on overlaps and gaps. */
typedef struct last_note {
    int count;
    char text[NOTE_TEXT_MAX];
} last_note;

static void keep_note(void *context, const scene_note *note)
{
    last_note *last = context;
    if (!strstr(note->text, "overlap") && !strstr(note->text, "gap"))
        return;
    last->count++;
    memcpy(last->text, note->text, sizeof last->text);
}

/* Boxes of 1 around the points, and around the origin: one note for any number of pairs. */
static void a_cloud_has_the_notes_of_its_solids(void **state)
{
    (void)state;
    static const struct {
        vec3 points[3];
        const char *words; /* NULL: no note */
    } cases[] = {{{{0, 2, 0}, {2, 0, 0}, {-2, 0, 0}}, NULL},
                 {{{0, 2, 0}, {0.9, 0, 0}, {-0.9, 0, 0}}, "drop and last overlap with equal priority"},
                 {{{0, 2, 0}, {1.0005, 0, 0}, {-1.0005, 0, 0}}, "the gap between drop and last is about 0.0005"},
                 {{{1.0005, 2, 0}, {0, 2, 0}, {-1.0005, 2, 0}}, "the gap between drop and another copy of it"},
                 {{{0.9, 2, 0}, {0, 2, 0}, {-0.9, 2, 0}}, NULL}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        put_points(cases[i].points, 3);
        scene *s = cloud_of("shape: box, size: [1, 1, 1], material: glass, ior: 1.3");
        last_note last = {.count = 0};
        diagnostic why = {.what = ""};
        worked(lint_scene(s, isa_best(), &(note_sink){keep_note, &last}, &why), &why);
        if (last.count != (cases[i].words != NULL) || (cases[i].words && !strstr(last.text, cases[i].words)))
            fail_msg("case %zu: %d notes, '%s'", i, last.count, last.text);
        scene_destroy(s);
    }
}

static void points_are_in_the_medium_of_a_copy(void **state)
{
    (void)state;
    const vec3 points[] = {{-2, 0, 0}, {2, 0, 0}};
    put_points(points, 2);
    scene *s = cloud_of("shape: sphere, radius: 0.5, material: glass, ior: 1.3");
    probe *p = NULL;
    diagnostic why = {.what = ""};
    worked(probe_create(s, isa_best(), &p, &why), &why);
    assert_int_equal(probe_medium_at(p, points[0]), 1);
    assert_int_equal(probe_medium_at(p, points[1]), 1);
    assert_int_equal(probe_medium_at(p, vec3_make(0, 0, 0)), 2);
    assert_int_equal(probe_medium_at(p, vec3_make(0, 2, 0)), RAY_OUTSIDE);
    probe_destroy(p);
    scene_destroy(s);
}

/* --- files --- */

static status parse(const char *text, size_t size, mesh_import **out, diagnostic *why)
{
    *why = (diagnostic){.what = ""};
    return mesh_points_parse("p.xyz", text, size, false, out, why);
}

static void points_are_three_numbers_a_line(void **state)
{
    (void)state;
    static const char text[] = "# x y z\n\n1 2 3\r\n -1.5e-3,+2 ,\t.5# a comment\n\t4,5,6";
    mesh_import *got;
    diagnostic why;
    assert_int_equal(parse(text, sizeof text - 1, &got, &why), STATUS_OK);
    assert_int_equal(got->mesh->vertex_count, 3);
    const vec3 expected[] = {{1, 2, 3}, {-1.5e-3, 2, 0.5}, {4, 5, 6}};
    assert_memory_equal(got->mesh->vertices, expected, sizeof expected);
    assert_true(got->mesh->bounds.low.x == -1.5e-3 && got->mesh->bounds.high.z == 6.0);
    text_writer w;
    char *described;
    assert_int_equal(text_writer_open(&w, NULL), STATUS_OK);
    mesh_rows_text(w.stream, got->mesh, NULL);
    assert_int_equal(text_writer_close(&w, &described, NULL, NULL), STATUS_OK);
    assert_non_null(strstr(described, "\nto         4 5 6\n"));
    assert_non_null(strstr(described, "\nclosed     no: it has points only\n"));
    free(described);
    mesh_import_destroy(got);
}

static void bad_files_have_a_place(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        long line, column;
        const char *what;
    } cases[] = {{"1 2 3\n1 2\n", 2, 4, "missing"},
                 {"1 2 3\n4,\n", 2, 3, "missing"},
                 {"1 2 3\n1 2 3 4\n", 2, 7, "follows"},
                 {"1 2 3,\n", 1, 6, "follows"},
                 {"1 two 3\n", 1, 3, "not a finite number"},
                 {"1 nan 3\n", 1, 3, "not a finite number"},
                 {"1 1e999 3\n", 1, 3, "not a finite number"},
                 {"1,,3\n", 1, 3, "not a finite number"},
                 {"1 2 0x3\n", 1, 5, "not a finite number"},
                 {"1 2 1000001\n", 1, 5, "too large"},
                 {"\xc3\xa9 1 2\n", 1, 1, "not a finite number"},
                 {"1 2 \xc3\xa9\xc3\xa9\n1", 1, 5, "not a finite number"},
                 {"", 1, 1, "no points"},
                 {"# nothing\n\n", 3, 1, "no points"}};
    mesh_import *got;
    diagnostic why;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(parse(cases[i].text, strlen(cases[i].text), &got, &why), STATUS_BAD_INPUT);
        assert_null(got);
        assert_int_equal(why.line, cases[i].line);
        assert_int_equal(why.column, cases[i].column);
        assert_non_null(strstr(why.what, cases[i].what));
        assert_true(why.remedy[0]);
    }
    assert_int_equal(parse("1 2 3\n\0", 7, &got, &why), STATUS_BAD_INPUT);
    assert_true(why.line == 2 && why.column == 1 && strstr(why.what, "NUL"));
    char digits[300];
    memset(digits, '1', sizeof digits - 1);
    digits[sizeof digits - 1] = 0;
    assert_int_equal(parse(digits, sizeof digits - 1, &got, &why), STATUS_BAD_INPUT);
}

static void points_are_limited(void **state)
{
    (void)state;
    const size_t most = SCENE_PRIMITIVES_MAX, size = 6 * (most + 1);
    char *text = malloc(size + 1);
    assert_non_null(text);
    for (size_t i = 0; i <= most; i++)
        memcpy(text + 6 * i, "1 2 3\n", 7);
    mesh_import *got;
    diagnostic why;
    assert_int_equal(parse(text, size, &got, &why), STATUS_BAD_INPUT);
    assert_true(why.line == (long)most + 1 && why.column == 1 && strstr(why.what, "more than 2097151 points"));
    text[6 * (most / 2 + 2)] = 0;
    put_text("many.xyz", text);
    free(text);
    scene *s = read_loaded("meshes: {p: {file: many.xyz}}\nsolids: {r: {shape: sphere, points: p}}\n");
    assert_int_equal(scene_check(s, &why), STATUS_OK);
    set(s, "r.points=");
    assert_int_equal(scene_set_property(s, "r.shape", "cup", NULL), STATUS_OK); /* counts as two */
    set(s, "r.points=p");
    assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "more than 2097151 solids"));
    scene_destroy(s);
}

static void refuse(const char *text, const char *what)
{
    diagnostic why = {.what = ""};
    put_text("scene.yaml", text);
    char *path = in_folder("scene.yaml");
    scene *s = NULL;
    status code = scene_read(path, &s, &why);
    THEN(code, scene_load(s, &why));
    THEN(code, scene_check(s, &why));
    free(path);
    assert_int_equal(code, STATUS_BAD_INPUT);
    if (!strstr(why.what, what))
        fail_msg("'%s' instead of '%s'", why.what, what);
    scene_destroy(s);
}

static void references_are_checked(void **state)
{
    (void)state;
    put_text("p.xyz", "0 0 0\n1 2 3\n");
    refuse("solids: {a: {shape: sphere, points: p}}\n", "no mesh 'p'");
    refuse("meshes: {p: {generate: icosphere, level: 0}}\nsolids: {a: {shape: sphere, points: p}}\n",
           "p is not a file of points");
    refuse("meshes: {p: {file: p.xyz}}\nsolids: {a: {shape: mesh, mesh: p}}\n", "p has no triangles");
    refuse("meshes: {p: {file: p.xyz}}\nsolids: {a: {shape: plane, points: p}}\n", "a is a plane, which has no points");
    put_text("q.xyz", "0 0 0\n1 2\n");
    refuse("meshes: {p: {file: q.xyz}}\nsolids: {a: {shape: sphere, points: p}}\n", "missing");
}

/* --- edits, texts and packages --- */

static void a_cloud_is_edited_like_a_solid(void **state)
{
    (void)state;
    const vec3 points[] = {{0, 0, 0}, {1, 2, 3}};
    put_points(points, 2);
    scene *s = cloud_of("shape: sphere, radius: 0.5, position: [0.5, 0, 0]");
    diagnostic why = {.what = ""};
    assert_int_equal(scene_remove(s, "places", &why), STATUS_BAD_INPUT);
    worked(scene_rename(s, "places", "spots", &why), &why);
    assert_string_equal(s->solids[1].points, "spots");
    worked(scene_scale(s, "all", 2.0, &why), &why);
    worked(scene_move(s, "drop", vec3_make(1, 0, 0), &why), &why);
    const solid_shape shape = scene_loaded_shape(s, &s->solids[1]);
    const vec3 at = solid_shape_copy(&shape, 1).position;
    assert_true(shape.radius == 1.0 && at.x == 4.0 && at.y == 4.0 && at.z == 6.0);
    char *text;
    worked(scene_write_text(s, s->path, false, &text, &why), &why);
    assert_non_null(strstr(text, "points: spots"));
    scene *again = read_loaded(text);
    assert_true(film_of(again, isa_best()) == film_of(s, isa_best()));
    free(text);
    scene_destroy(again);
    package p = packed(s);
    again = unpacked(&p);
    assert_memory_equal(&again->meshes[0].data->bounds, &s->meshes[0].data->bounds, sizeof(bounds3));
    assert_true(film_of(again, isa_best()) == film_of(s, isa_best()));
    free(p.at);
    scene_destroy(again);
    set(s, "drop.points=");
    worked(scene_remove(s, "spots", &why), &why);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cloud_has_the_film_of_its_solids),
        cmocka_unit_test(a_cloud_is_where_its_solids_are),
        cmocka_unit_test(a_cloud_has_the_notes_of_its_solids),
        cmocka_unit_test(points_are_in_the_medium_of_a_copy),
        cmocka_unit_test(points_are_three_numbers_a_line),
        cmocka_unit_test(bad_files_have_a_place),
        cmocka_unit_test(points_are_limited),
        cmocka_unit_test(references_are_checked),
        cmocka_unit_test(a_cloud_is_edited_like_a_solid),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
