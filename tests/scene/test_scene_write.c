/* Tests of scenes as text: reading the text gives the same scene, and writing that gives the same bytes. Run from the
 * repository root. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "render_fixture.h"
#include "scene/file/write.h"
#include "scene/model/edit/edit.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "whole.h"
#include <dirent.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#define SCENES "experiments/scenes/"

static char *written(const scene *s, const char *path, bool all)
{
    char *text = NULL;
    diagnostic why = {0};
    worked(scene_write_text(s, path, all, &text, &why), &why);
    return text;
}

static status add_line(void *context, const char *path, const param *row, const char *value)
{
    if (strcmp(row->name, "ior") != 0 && row->type != PARAM_PATH)
        fprintf(context, "%s=%s\n", path, value);
    return STATUS_OK;
}

/* Every parameter in use except those that another one would override, every shape, every material. */
static char *account(const scene *s)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    fprintf(out, "%s\n", s->title);
    assert_int_equal(scene_each_param(s, add_line, out), STATUS_OK);
    for (size_t i = 0; i < s->solid_count; i++)
        fprintf(out, "%s %d %d\n", s->solids[i].name, (int)s->solids[i].shape.kind, s->solids[i].material_index);
    fclose(out);
    return text;
}

/* Writes, reads, compares, writes again; returns the scene that was read. */
static scene *there_and_back(const scene *s, bool all)
{
    char *first = written(s, "", all);
    scene *again = scene_from(first);
    char *second = written(again, "", all);
    assert_string_equal(first, second);
    free(first);
    free(second);
    return again;
}

static void assert_same_scene(const scene *a, const scene *b)
{
    char *first = account(a), *second = account(b);
    assert_string_equal(first, second);
    free(first);
    free(second);
}

/* Both forms of writing preserve the scene. */
static void assert_survives(const scene *s)
{
    for (int all = 0; all < 2; all++) {
        scene *again = there_and_back(s, all);
        assert_same_scene(s, again);
        scene_destroy(again);
    }
}

static uint64_t hash_of(scene *s)
{
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    render_result *result = render(s);
    uint64_t hash = film_hash(result->img);
    render_result_destroy(result);
    return hash;
}

static scene *committed_scene(const char *name)
{
    char path[300];
    scene *s = NULL;
    diagnostic why = {0};
    snprintf(path, sizeof path, SCENES "%s", name);
    worked(scene_read(path, &s, &why), &why);
    return s;
}

static void every_scene_of_the_project_round_trips_with_the_same_film(void **state)
{
    (void)state;
    DIR *folder = opendir(SCENES);
    assert_non_null(folder);
    size_t count = 0;
    for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        if (!strstr(entry->d_name, ".yaml"))
            continue;
        scene *s = committed_scene(entry->d_name);
        assert_survives(s);
        set_all(s, "render.width=32 render.height=24 render.samples=1 render.wavelengths=4 render.photons=3000 "
                   "render.paths=2");
        const uint64_t hash = hash_of(s);
        for (int all = 0; all < 2; all++) {
            scene *again = there_and_back(s, all);
            assert_true(hash_of(again) == hash);
            scene_destroy(again);
        }
        scene_destroy(s);
        count++;
    }
    closedir(folder);
    assert_true(count >= 8);
}

static const char one_of_each[] =
    "meshes: {body: {generate: box}, model: {file: model.obj}, toy: {generate: slime}}\n"
    "textures: {wood: {file: wood.png}, bark: {file: bark.png}}\n"
    "data: {measured: {file: a.csv}}\n"
    "materials: {paint: {}}\n"
    "lights: {lamp: {}}\n"
    "beams: {ray: {}}\n"
    "solids: {plane1: {shape: plane}, cylinder1: {shape: cylinder}, cup1: {shape: cup}, box1: {shape: box},\n"
    "  sphere1: {shape: sphere}, mesh1: {shape: mesh, mesh: model}, painted: {shape: box, material: paint},\n"
    "  cone1: {shape: cone}, torus1: {shape: torus}, prism1: {shape: prism}, lens1: {shape: lens},\n"
    "  rider: {shape: sphere, follows: plane1, offset: [1, 2, 3]}}\n";

/* Values to try, some of which are valid for a row; NULL at the end. */
static size_t candidates(const param *row, char text[][100], size_t room)
{
    size_t count = 0;
    for (; row->choices && row->choices[count] && count < room; count++)
        snprintf(text[count], 100, "%s", row->choices[count]);
    if (count)
        return count;
    double fallback = strtod(row->fallback, NULL), low = row->lowest, high = row->highest;
    switch (row->type) {
    case PARAM_INT:
        snprintf(text[0], 100, "%.0f", low + 1);
        snprintf(text[1], 100, "%.0f", high);
        return 2;
    case PARAM_REAL:
        snprintf(text[0], 100, "%.17g", fallback * 0.7310585786300049 + low / 3);
        snprintf(text[1], 100, "%.17g", low + (high - low) * 0.1234567890123456789);
        snprintf(text[2], 100, "%.17g", fallback + 0.007310585786300049); /* for coefficients of lenses */
        snprintf(text[3], 100, "%.17g", fallback - 0.003678794411714423);
        return 4;
    case PARAM_VECTOR:
    case PARAM_COLOR:
        snprintf(text[0], 100, "%.17g,%.17g,%.17g", low + (high - low) / 3, low + (high - low) / 7, high);
        snprintf(text[1], 100, "2,3,1"); /* where only certain integers are valid */
        return 2;
    case PARAM_LIST: snprintf(text[0], 100, "[400,0.1,500,%.17g]", 1.0 / 3.0); return 1;
    case PARAM_PATH: snprintf(text[0], 100, "images/it's: a sky #1.png"); return 1;
    case PARAM_WORD:
        snprintf(text[0], 100,
                 strstr(row->name, "_data")                ? "measured"
                 : strncmp(row->name, "material_", 9) == 0 ? "paint"
                 : row->group == PARAM_MATERIAL            ? "bark"
                 : strcmp(row->name, "follows") == 0       ? "cylinder1"
                                                           : "body");
        return 1;
    case PARAM_LAYERS:
        snprintf(text[0], 100, "ar-broad");
        snprintf(text[1], 100, "2x(mgf2 550/4, 2.1+0.3i 20), silver 10");
        return 2;
    case PARAM_CHOICE: break;
    }
    return 0;
}

static bool is_right(const scene *s, const char *path, const char *value)
{
    scene *trial = scene_clone(s);
    bool right = scene_set(trial, path, value, NULL) == STATUS_OK && scene_check(trial, NULL) == STATUS_OK;
    scene_destroy(trial);
    return right;
}

/* The number of values other than the current one that round-trip. */
static size_t carry_row(const scene *s, const char *owner, const param *row)
{
    char text[64][100], path[200];
    snprintf(path, sizeof path, "%s.%s", owner, row->name);
    size_t count = candidates(row, text, 64), carried = 0;
    const size_t wanted = is_whole() ? 2 : 1;
    for (size_t i = 0; i < count && carried < wanted; i++) {
        char *before = NULL, *after = NULL;
        if (!is_right(s, path, text[i]))
            continue;
        scene *changed = scene_clone(s);
        assert_int_equal(scene_get(changed, path, &before, NULL), STATUS_OK);
        assert_int_equal(scene_set(changed, path, text[i], NULL), STATUS_OK);
        assert_int_equal(scene_get(changed, path, &after, NULL), STATUS_OK);
        carried += strcmp(before, after) != 0;
        for (int all = 0; all < 2; all++) {
            scene *again = there_and_back(changed, all);
            char *read = NULL;
            assert_same_scene(changed, again);
            assert_int_equal(scene_get(again, path, &read, NULL), STATUS_OK);
            assert_string_equal(read, after);
            free(read);
            scene_destroy(again);
        }
        scene_destroy(changed);
        free(before);
        free(after);
    }
    return carried;
}

static void every_parameter_round_trips_with_other_values(void **state)
{
    (void)state;
    static const char *const owners[] = {"render",    "camera",   "background", "body",    "model", "toy",
                                         "wood",      "measured", "ray",        "lamp",    "paint", "plane1",
                                         "cylinder1", "cup1",     "box1",       "sphere1", "mesh1", "painted",
                                         "cone1",     "torus1",   "prism1",     "lens1",   "rider"};
    scene *s = scene_from(one_of_each);
    bool seen[512] = {false};
    for (size_t o = 0; o < sizeof owners / sizeof *owners; o++) {
        for (size_t i = 0; i < param_count(); i++) {
            param_place at;
            char path[200];
            snprintf(path, sizeof path, "%s.%s", owners[o], param_at(i)->name);
            if (param_place_find(s, path, &at, NULL) != STATUS_OK || at.row != param_at(i))
                continue;
            if (at.object_group == PARAM_MESH && strcmp(owners[o], at.row->makers               ? "toy"
                                                                   : at.row->type == PARAM_PATH ? "model"
                                                                                                : "body") != 0)
                continue; /* skipped: a file replaces a generator, and slimes have rows of their own */
            if (at.object_group == PARAM_SOLID && strcmp(at.row->name, "follows") == 0 &&
                strcmp(owners[o], "rider") != 0)
                continue; /* another solid would also lose its place */
            if (at.object_group == PARAM_SOLID && at.row->group == PARAM_MATERIAL && strcmp(owners[o], "painted") != 0)
                continue; /* one solid is sufficient */
            if (carry_row(s, owners[o], param_at(i)) == 0)
                fail_msg("%s was not changed", path);
            seen[i] = true;
        }
    }
    for (size_t i = 0; i < param_count(); i++)
        assert_true(seen[i]);
    scene_destroy(s);
}

static void random_scenes_round_trip(void **state)
{
    (void)state;
    for (unsigned seed = 1; seed <= 40; seed++) {
        scene *s = scene_from(one_of_each);
        unsigned x = seed;
        for (size_t i = 0; i < param_count(); i++) {
            static const char *const owners[] = {"lamp",    "paint",  "painted", "cup1",
                                                 "sphere1", "render", "camera",  "background"};
            x = x * 1664525u + 1013904223u;
            char path[200], text[64][100];
            snprintf(path, sizeof path, "%s.%s", owners[(x >> 16) % 8], param_at(i)->name);
            size_t count = candidates(param_at(i), text, 64);
            param_place at;
            if (param_place_find(s, path, &at, NULL) == STATUS_OK && at.row == param_at(i) &&
                is_right(s, path, text[(x >> 20) % count]))
                assert_int_equal(scene_set(s, path, text[(x >> 20) % count], NULL), STATUS_OK);
        }
        assert_survives(s);
        scene_destroy(s);
    }
}

static void assert_written(scene *s, const char *expected)
{
    char *text = written(s, "", false);
    assert_string_equal(text, expected);
    free(text);
    scene_destroy(there_and_back(s, false));
    scene_destroy(there_and_back(s, true));
}

static void only_changed_values_are_written_and_materials_by_reference(void **state)
{
    (void)state;
    scene *s = scene_from(
        "render: {depth: 4, width: 640}\n"
        "lights: {lamp: {position: [0, 10, 0]}}\n"
        "materials: {glass: {ior: 1.5, transparency: 1}, dull: {}}\n"
        "solids: {a: {shape: box, material: glass, ior: 1.5, transparency: 0.1}, b: {shape: sphere, ior: 1.25}}\n");
    assert_written(s, "render:\n  width: 640\n\n"
                      "materials:\n  glass:\n    transparency: 1\n    ior: 1.5\n  dull: {}\n\n"
                      "lights:\n  lamp: {}\n\n"
                      "solids:\n  a:\n    shape: box\n    material: glass\n    transparency: 0.1\n  b:\n    shape: "
                      "sphere\n    ior: 1.25\n");
    scene_destroy(s);
}

static void an_empty_scene_round_trips(void **state)
{
    (void)state;
    scene *s = scene_create();
    assert_written(s, "solids: {}\n");
    scene_destroy(s);
}

static void numbers_are_short_and_round_trip(void **state)
{
    (void)state;
    scene *s = scene_from("{}");
    set_all(s, "camera.position=0.1,1e-9,-123456.78901234567 camera.fov_deg=30.000000000000004");
    assert_written(s, "camera:\n  position: [0.1, 1e-09, -123456.78901234567]\n  fov_deg: 30.000000000000004\n");
    scene_destroy(s);
}

static void a_camera_given_by_angles_keeps_them_even_at_zero(void **state)
{
    (void)state;
    scene *s = scene_from("camera: {yaw_deg: 0}\n");
    assert_int_equal(s->camera.aimed, 0);
    assert_written(s, "camera:\n  yaw_deg: 0\n");
    set(s, "camera.pitch_deg=-12.5");
    assert_written(s, "camera:\n  yaw_deg: 0\n  pitch_deg: -12.5\n");
    scene_destroy(s);
}

static void the_medium_that_overrides_an_index_is_written(void **state)
{
    (void)state;
    scene *s = scene_from("background: {medium: air}\n"
                          "materials: {wet: {ior: 1.7}, plain: {ior: 1.5}}\n"
                          "solids: {a: {shape: box, material: wet}, b: {shape: box, material: wet, ior: 1.25},\n"
                          "  c: {shape: box, material: plain, medium: water}}\n");
    set(s, "wet.medium=water"); /* of a, and also of b */
    set(s, "a.ior=1.7");        /* as is the material's, which has no effect any more */
    assert_written(s, "background:\n  medium: air\n\n"
                      "materials:\n  wet:\n    medium: water\n  plain:\n    ior: 1.5\n\n"
                      "solids:\n  a:\n    shape: box\n    material: wet\n    ior: 1.7\n    medium: ior\n"
                      "  b:\n    shape: box\n    material: wet\n"
                      "  c:\n    shape: box\n    material: plain\n    medium: water\n");
    scene_destroy(s);
}

static void a_mesh_is_written_with_one_source(void **state)
{
    (void)state;
    scene *s =
        scene_from("meshes: {body: {file: a.obj}}\nsolids: {thing: {shape: mesh, mesh: body, scale: [1, 2, 1]}}\n");
    assert_written(s, "meshes:\n  body:\n    file: a.obj\n\nsolids:\n  thing:\n    shape: mesh\n    mesh: body\n    "
                      "scale: [1, 2, 1]\n");
    set_all(s, "body.generate=sparse body.count=50");
    assert_written(s, "meshes:\n  body:\n    generate: sparse\n    count: 50\n\n"
                      "solids:\n  thing:\n    shape: mesh\n    mesh: body\n    scale: [1, 2, 1]\n");
    s->meshes[0].source = MESH_ARRAYS;
    char *text;
    diagnostic why = {0};
    assert_int_equal(scene_write_text(s, "", false, &text, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "the mesh body was given as arrays, which cannot be stored in a scene file");
    scene_destroy(s);
}

static void an_unused_sky_is_not_written(void **state)
{
    (void)state;
    scene *s = scene_from("background: {image: sky.png}\n");
    assert_written(s, "background:\n  kind: image\n  image: sky.png\n");
    set(s, "background.kind=uniform");
    assert_written(s, "solids: {}\n");
    scene_destroy(s);
}

static void texts_are_quoted_where_yaml_requires_it(void **state)
{
    (void)state;
    static const char *const titles[][2] = {
        {"Rod in a vessel", "Rod in a vessel"},
        {"it's, and (so) on; 50%", "it's, and (so) on; 50%"},
        {"yes", "\"yes\""},
        {"Null", "\"Null\""},
        {"2 rods", "\"2 rods\""},
        {"1e3", "\"1e3\""},
        {"~", "\"~\""},
        {"rod: leaning", "\"rod: leaning\""},
        {"rod #2", "\"rod #2\""},
        {"rod:", "\"rod:\""},
        {"- rod", "\"- rod\""},
        {"[rod]", "\"[rod]\""},
        {"say \"rod\"", "\"say \\\"rod\\\"\""},
        {"back\\slash", "\"back\\\\slash\""},
        {" before and after ", "\" before and after \""},
        {"two\nlines", "\"two\\nlines\""},
        {"a\ttab", "\"a\\x09tab\""},
        {"Brechzahl f\xc3\xbcr Gl\xc3\xa4ser", "Brechzahl f\xc3\xbcr Gl\xc3\xa4ser"},
        {"\xe2\x80\xa8separator", "\"\\u2028separator\""},
        {"next\xc2\x85line", "\"next\\x85line\""},
        {"\xf0\x9f\x94\xac", "\xf0\x9f\x94\xac"},
        {"&anchor", "\"&anchor\""},
        {"!tag", "\"!tag\""},
        {"%directive", "\"%directive\""},
        {"a\x01z\x7f", "\"a\\x01z\\x7F\""},
        {"\xef\xbb\xbfmark", "\"\\uFEFFmark\""},
    };
    for (size_t i = 0; i < sizeof titles / sizeof *titles; i++) {
        scene *s = scene_create();
        char expected[200];
        assert_int_equal(scene_set_title(s, titles[i][0], NULL), STATUS_OK);
        snprintf(expected, sizeof expected, "title: %s\n", titles[i][1]);
        assert_written(s, expected);
        scene_destroy(s);
    }
}

static void names_that_are_yaml_keywords_are_quoted(void **state)
{
    (void)state;
    scene *s = scene_from("materials: {no: {ambient: 1}}\nsolids: {On: {shape: sphere, material: no}}\n");
    assert_written(
        s, "materials:\n  \"no\":\n    ambient: 1\n\nsolids:\n  \"On\":\n    shape: sphere\n    material: \"no\"\n");
    scene_destroy(s);
}

static void invalid_utf8_is_refused(void **state)
{
    (void)state;
    static const char *const wrong[] = {"\xff",         "half \xc3",        "\xc0\x80",
                                        "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x28\xa1"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        scene *s = scene_create();
        char *text;
        diagnostic why = {0};
        assert_int_equal(scene_set_title(s, wrong[i], NULL), STATUS_OK);
        assert_int_equal(scene_write_text(s, "", false, &text, &why), STATUS_BAD_INPUT);
        assert_null(text);
        assert_string_equal(why.what, "title is not UTF-8, which a scene file requires");
        scene_destroy(s);
    }
}

/* The text of the path image when a scene with the path from is written to the path to. */
static void assert_moved(const char *from, const char *img, const char *to, const char *expected)
{
    scene *s = NULL;
    char text[700], *there, *value = NULL;
    diagnostic why = {0};
    snprintf(text, sizeof text, "background: {image: \"%s\"}\n", img);
    worked(scene_read_text(from, text, strlen(text), &s, &why), &why);
    there = written(s, to, false);
    scene_destroy(s);
    worked(scene_read_text(to, there, strlen(there), &s, &why), &why);
    worked(scene_get(s, "background.image", &value, &why), &why);
    assert_string_equal(value, expected);
    char *again = written(s, to, false);
    assert_string_equal(there, again);
    free(again);
    free(value);
    free(there);
    scene_destroy(s);
}

static void paths_are_adjusted_when_a_scene_is_written_to_another_folder(void **state)
{
    (void)state;
    char root[] = "/tmp/cuvette-write-XXXXXX", here[4096];
    assert_non_null(mkdtemp(root));
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(chdir(root), 0);
    assert_int_equal(
        mkdir("a", 0777) | mkdir("a/b", 0777) | mkdir("c", 0777) | mkdir("ab", 0777) | symlink("a/b", "link"), 0);
    char absolute[300];
    snprintf(absolute, sizeof absolute, "%s/c/sky.png", root);
    assert_moved("a/s.yaml", "sky.png", "a/t.yaml", "sky.png");
    assert_moved("a/s.yaml", "./x/../sky.png", "a/t.yaml", "./x/../sky.png");
    assert_moved("a/s.yaml", "sky.png", "./a/t.yaml", "sky.png");
    assert_moved("s.yaml", "c/sky.png", "a/t.yaml", "../c/sky.png");
    assert_moved("a/b/s.yaml", "../../c/sky.png", "c/t.yaml", "sky.png");
    assert_moved("a/b/s.yaml", "../../c/sky.png", "", "c/sky.png");
    assert_moved("a/s.yaml", "sky.png", "ab/t.yaml", "../a/sky.png");
    assert_moved("a/b/s.yaml", "sky.png", "a/t.yaml", "b/sky.png");
    assert_moved("link/s.yaml", "../sky.png", "t.yaml", "a/sky.png"); /* .. of a link refers to its target */
    assert_moved("s.yaml", "sky.png", "link/t.yaml", "../../sky.png");
    assert_moved("s.yaml", absolute, "a/t.yaml", absolute);
    assert_moved("c/s.yaml", "sky.png", "/dev/t.yaml", absolute); /* nothing in common */
    assert_moved("", "c/sky.png", "a/t.yaml", "../c/sky.png");
    assert_moved("none/s.yaml", "sky.png", "a/t.yaml", "../none/sky.png");
    assert_int_equal(unlink("link") | rmdir("a/b") | rmdir("a") | rmdir("ab") | rmdir("c"), 0);
    assert_int_equal(chdir(here), 0);
    rmdir(root);
}

static void a_scene_file_round_trips_and_an_unwritable_path_fails(void **state)
{
    (void)state;
    char path[] = "/tmp/cuvette-write-XXXXXX.yaml";
    int fd = mkstemps(path, 5);
    assert_true(fd >= 0);
    close(fd);
    scene *s = rod_scene(""), *again = NULL;
    diagnostic why = {0};
    worked(scene_write(s, path, false, &why), &why);
    worked(scene_read(path, &again, &why), &why);
    assert_same_scene(s, again);
    scene_destroy(again);
    assert_int_equal(scene_write(s, "/nowhere/at/all.yaml", false, &why), STATUS_FAILURE);
    scene_destroy(s);
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scene_of_the_project_round_trips_with_the_same_film),
        cmocka_unit_test(every_parameter_round_trips_with_other_values),
        cmocka_unit_test(random_scenes_round_trip),
        cmocka_unit_test(only_changed_values_are_written_and_materials_by_reference),
        cmocka_unit_test(an_empty_scene_round_trips),
        cmocka_unit_test(numbers_are_short_and_round_trip),
        cmocka_unit_test(a_camera_given_by_angles_keeps_them_even_at_zero),
        cmocka_unit_test(the_medium_that_overrides_an_index_is_written),
        cmocka_unit_test(a_mesh_is_written_with_one_source),
        cmocka_unit_test(an_unused_sky_is_not_written),
        cmocka_unit_test(texts_are_quoted_where_yaml_requires_it),
        cmocka_unit_test(names_that_are_yaml_keywords_are_quoted),
        cmocka_unit_test(invalid_utf8_is_refused),
        cmocka_unit_test(paths_are_adjusted_when_a_scene_is_written_to_another_folder),
        cmocka_unit_test(a_scene_file_round_trips_and_an_unwritable_path_fails),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
