/* Tests of mesh faces with their own transmittance and reflectivity, by their materials, under simple transmission. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>
#include <cmocka.h>

#include "lint/lint.h"
#include "path_fixture.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static char folder[] = "/tmp/cuvette-shares-XXXXXX";

static void put(const char *name, const char *text)
{
    char path[64];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

/* A sheet of two triangles, the left one clear, and a cube whose front and back transmit a half and a quarter; the rest
 * of it is opaque. */
static int make_files(void **state)
{
    (void)state;
    assert_non_null(mkdtemp(folder));
    put("m.mtl", "newmtl left\nKd 0 0 0\nd 0.25\nnewmtl right\nKd 0 0 0\nKe 0.5 0.5 0.5\n"
                 "newmtl half\nKd 0 0 0\nd 0.5\nnewmtl quarter\nKd 0 0 0\nTr 0.25\n");
    put("sheet.obj",
        "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl left\nf 1 4 3\nusemtl right\nf 1 3 2\n");
    put("cube.obj", "mtllib m.mtl\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                    "usemtl half\nf 1 4 3 2\nusemtl quarter\nf 5 6 7 8\nusemtl right\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 "
                    "7\nf 4 1 5 8\n");
    return 0;
}

static int remove_files(void **state)
{
    (void)state;
    static const char *const names[] = {"m.mtl", "sheet.obj", "cube.obj"};
    char path[64];
    for (size_t k = 0; k < COUNT(names); k++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[k]);
        unlink(path);
    }
    return rmdir(folder);
}

/* A camera that looks along +z at a wall that emits 2, under a sky of 0.5. */
static scene *view(const char *more, const char *assignments)
{
    char text[2048];
    snprintf(text, sizeof text,
             "render: {width: 1, height: 1, depth: 8, paths: 8, transmission: simple}\ncamera: {position: [-0.4, 0.5, "
             "-4], yaw_deg: 0, fov_deg: 0.01}\n"
             "background: {color: [0.5, 0.5, 0.5], ambient: [0, 0, 0]}\n"
             "meshes: {sheet: {file: %s/sheet.obj}, cube: {file: %s/cube.obj}}\n%s"
             "  wall: {shape: box, emission: 2, size: [40, 40, 1], position: [0, 0, 20]}\n",
             folder, folder, more);
    scene *s = scene_from(text);
    diagnostic why = {0};
    set_all(s, assignments);
    worked(scene_load(s, &why), &why);
    return s;
}

static void expect_seen(scene *s, double expected, double tolerance)
{
    const double seen = look(s).x;
    if (!(fabs(seen - expected) <= tolerance))
        fail_msg("%.12g instead of %.12g", seen, expected);
}

static void each_face_transmits_its_own_share(void **state)
{
    (void)state;
    static const char *const integrators[] = {"render.integrator=whitted", "render.integrator=zbuffer",
                                              "render.integrator=path"};
    for (size_t k = 0; k < COUNT(integrators); k++) {
        scene *s = view("solids:\n  pane: {shape: mesh, mesh: sheet}\n", integrators[k]);
        expect_seen(s, 0.75 * 2.0, 1e-9);
        set(s, "camera.position=0.4,-0.5,-4");
        expect_seen(s, 0.5, 1e-9);       /* opaque, and emits */
        set(s, "pane.transparency=0.5"); /* of faces without a value */
        expect_seen(s, 0.5 + 0.5 * 2.0, 1e-9);
        set_all(s, "camera.position=-0.4,0.5,-4 pane.transparency=0 render.transmission=refract");
        expect_seen(s, 0.0, 0.0);
        scene_destroy(s);
        s = view("solids:\n  block: {shape: mesh, mesh: cube}\n", integrators[k]);
        expect_seen(s, 0.5 * 0.25 * 2.0, 1e-9);
        set(s, "camera.position=-4,0.5,0.4");
        set(s, "camera.yaw_deg=90");
        expect_seen(s, 0.5, 1e-9);
        scene_destroy(s);
    }
}

/* A scene material with the slot's name sets the reflectivity, too. */
static void each_face_reflects_its_own_share(void **state)
{
    (void)state;
    static const char solids[] =
        "materials: {left: {transparency: 0.6, reflectivity: 0.3}}\nsolids:\n  pane: {shape: mesh, mesh: sheet, "
        "transparency: 0.9}\n";
    scene *s = view(solids, "");
    expect_seen(s, 0.6 * 2.0 + 0.3 * 0.5, 1e-9);
    set(s, "render.integrator=zbuffer");
    expect_seen(s, 0.6 * 2.0 + 0.3 * 0.5, 1e-9);
    set_all(s, "render.integrator=path render.paths=4096");
    expect_estimate(look_by_chance(s, 0), 0.6 * 2.0 + 0.3 * 0.5);
    set_all(s, "render.integrator=whitted left.reflectivity=0.5");
    diagnostic why = {0};
    assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "left"));
    set(s, "render.transmission=refract");
    assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT); /* a clear sheet is open: it contains nothing */
    set(s, "pane.transparency=0");
    assert_int_equal(scene_check(s, &why), STATUS_OK);
    scene_destroy(s);
}

/* Shadow rays and view rays have the same transmittance through each face. */
static void shadows_depend_on_the_faces(void **state)
{
    (void)state;
    static const char solids[] =
        "lights: {lamp: {position: [0, 0, -100]}}\nsolids:\n  pane: {shape: mesh, mesh: sheet}\n"
        "  screen: {shape: box, diffuse: 1, size: [4, 4, 1], position: [0, 0, 2.5], priority: 1}\n";
    scene *s = view(solids, "camera.position=-0.4,0.5,1");
    const double clear = 0.75, away = 102.0;
    const double n_l = away / sqrt(away * away + 0.4 * 0.4 + 0.5 * 0.5);
    expect_seen(s, clear * n_l, 1e-6);
    set(s, "camera.position=0.4,-0.5,1");
    expect_seen(s, 0.0, 0.0);
    set(s, "render.shadows=off");
    expect_seen(s, n_l, 1e-6);
    set_all(s, "render.shadows=attenuated camera.position=-0.4,0.5,1 render.transmission=refract");
    expect_seen(s, 0.0, 0.0);
    scene_destroy(s);
    s = view("lights: {lamp: {position: [0, 0, -100]}}\nsolids:\n  block: {shape: mesh, mesh: cube}\n"
             "  screen: {shape: box, diffuse: 1, size: [4, 4, 1], position: [0, 0, 2.5], priority: 1}\n",
             "camera.position=-0.4,0.5,1.5");
    expect_seen(s, 0.5 * 0.25 * n_l, 1e-6);
    scene_destroy(s);
}

static void keep_last(void *context, const scene_note *note)
{
    char line[NOTE_LINE_MAX];
    snprintf(context, NOTE_LINE_MAX, "%s", note_line(note, line, sizeof line));
}

static void a_note_names_the_solid_whose_shares_are_ignored(void **state)
{
    (void)state;
    char note[NOTE_LINE_MAX] = "";
    const note_sink taker = {keep_last, note};
    scene *s = view("solids:\n  pane: {shape: mesh, mesh: sheet}\n", "");
    scene_hints(s, &taker);
    assert_string_equal(note, "");
    set(s, "render.transmission=refract");
    scene_hints(s, &taker);
    assert_non_null(
        strstr(note, "pane.transparency: the transparency and reflectivity of the faces of pane have no effect"));
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_face_transmits_its_own_share),
        cmocka_unit_test(each_face_reflects_its_own_share),
        cmocka_unit_test(shadows_depend_on_the_faces),
        cmocka_unit_test(a_note_names_the_solid_whose_shares_are_ignored),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
