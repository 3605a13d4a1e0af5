/* Tests of study files: the grammar, identities of cells and located diagnostics. Run from the repository root. */
#include "base/hash.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "study_fixture.h"
#include "whole.h"
#include <dirent.h>

static const char bad_folder[] = "tests/bad/studies";

static const char *axis_value(const study *s, size_t cell, size_t axis, size_t path)
{
    return s->axes[axis].points[study_cell_point(s, cell, axis)].values[path];
}

static void the_whole_grammar_is_read(void **state)
{
    const fixture *f = *state;
    study *s =
        fixture_study(f, "study: all\n"
                         "title: All there is\n"
                         "scene: scene.yaml\n"
                         "set: {render.width: 32, lamp.position.y: 9.50}\n"
                         "grid:\n"
                         "  - {render.depth: [0, 4]}\n"
                         "  - name: pair\n"
                         "    points:\n"
                         "      - {ball.ior: 1.0, lamp.position.x: 1}\n"
                         "      - {lamp.position.x: 2, ball.ior: 1.50}\n"
                         "      - {ball.ior: 1.33, lamp.position.x: 3}\n"
                         "repetitions: {min: 5, max: 20, relative_width: 0.02}\n"
                         "warmups: 2\n"
                         "order: {shuffle: off, seed: 42}\n"
                         "keep: {image: on, pfm: yes, workers: true, pixel_rays: off, pixel_time: no, timeline: on}\n");
    assert_string_equal(s->name, "all");
    assert_string_equal(s->title, "All there is");
    assert_int_equal(s->repetitions_min, 5);
    assert_int_equal(s->repetitions_max, 20);
    assert_true(s->relative_width == 0.02);
    assert_int_equal(s->warmups, 2);
    assert_false(s->shuffle);
    assert_int_equal(s->seed, 42);
    assert_true(s->keep_image && s->keep_pfm && s->keep_workers && s->keep_timeline);
    assert_false(s->keep_pixel_rays || s->keep_pixel_time);
    assert_int_equal(s->base->render.width, 32);
    assert_true(s->base->lights[0].position.y == 9.5);
    assert_int_equal(study_cell_count(s), 6);
    assert_int_equal(s->axis_count, 2);
    assert_string_equal(s->axes[0].name, "render.depth");
    assert_string_equal(s->axes[1].name, "pair");
    /* The last axis runs fastest; values are as written by scene_get; paths are in the order of the first point. */
    assert_string_equal(axis_value(s, 0, 0, 0), "0");
    assert_string_equal(axis_value(s, 2, 0, 0), "0");
    assert_string_equal(axis_value(s, 3, 0, 0), "4");
    assert_string_equal(axis_value(s, 4, 1, 0), "1.5");
    assert_string_equal(axis_value(s, 4, 1, 1), "2");
    scene *setting;
    assert_int_equal(study_cell_scene(s, 4, &setting, NULL), STATUS_OK);
    assert_int_equal(setting->render.depth, 4);
    assert_int_equal(setting->render.width, 32);
    assert_true(setting->solids[scene_find_solid(setting, "ball")].surface.ior == 1.5);
    assert_true(setting->lights[0].position.x == 2 && setting->lights[0].position.y == 9.5);
    scene_destroy(setting);
    study_destroy(s);
}

static void omitted_study_keys_have_their_defaults(void **state)
{
    study *s = fixture_study(*state, "study: small\nscene: scene.yaml\n");
    assert_string_equal(s->title, "small");
    assert_int_equal(study_cell_count(s), 1);
    assert_int_equal(s->repetitions_min, 6);
    assert_int_equal(s->repetitions_max, 6);
    assert_int_equal(s->warmups, 1);
    assert_true(s->shuffle);
    assert_int_equal(s->seed, 1);
    assert_false(s->keep_image);
    scene *setting;
    assert_int_equal(study_cell_scene(s, 0, &setting, NULL), STATUS_OK);
    assert_int_equal(setting->render.width, 24);
    scene_destroy(setting);
    study_destroy(s);
}

static void values_of_ranges_are_evenly_spaced(void **state)
{
    study *s = fixture_study(*state, "study: ranges\nscene: scene.yaml\ngrid:\n"
                                     "  - {ball.ior: {from: 1.0, to: 1.6, steps: 4}}\n"
                                     "  - {render.depth: {from: 4, to: 0, steps: 3}}\n"
                                     "  - {lamp.position.x: {from: 0, to: 1, steps: 4}}\n");
    static const char *const expected[3][4] = {
        {"1", "1.2", "1.4", "1.6"}, {"4", "2", "0"}, {"0", "0.333333333333333", "0.666666666666667", "1"}};
    assert_int_equal(study_cell_count(s), 4 * 3 * 4);
    for (size_t axis = 0; axis < 3; axis++)
        for (size_t i = 0; i < s->axes[axis].count; i++)
            assert_string_equal(s->axes[axis].points[i].values[0], expected[axis][i]);
    study_destroy(s);
}

/* STATUS_OK for a study with that name, a range of that many steps, and as many axes. */
static status read_sized(const fixture *f, int name_length, int steps, int axes)
{
    static const char *const paths[] = {"ball.ior",        "ball.radius",     "ball.position.x", "ball.position.y",
                                        "ball.position.z", "lamp.position.x", "lamp.position.y", "lamp.position.z",
                                        "camera.yaw_deg",  "camera.fov_deg",  "camera.roll_deg", "render.depth",
                                        "render.width",    "render.height",   "render.tile",     "render.seed",
                                        "lamp.intensity"};
    char text[4096] = "study: ";
    int length = 7;
    for (int i = 0; i < name_length; i++)
        text[length++] = 'a';
    length += snprintf(text + length, 256, "\nscene: scene.yaml\ngrid:\n  - {%s: {from: 1, to: 2, steps: %d}}\n",
                       paths[0], steps);
    for (int i = 1; i < axes; i++)
        length += snprintf(text + length, 256, "  - {%s: [1]}\n", paths[i]);
    fixture_write(f, "sized.study", text);
    char path[400];
    fixture_path(f, "sized.study", path);
    study *s = NULL;
    const status code = study_read(path, &s, NULL);
    study_destroy(s);
    return code;
}

static void the_largest_studies_are_read_and_larger_ones_refused(void **state)
{
    ONLY_IN_CHECK();
    const fixture *f = *state;
    assert_int_equal(read_sized(f, 64, 4096, 16), STATUS_OK);
    assert_int_equal(read_sized(f, 65, 4096, 16), STATUS_BAD_INPUT);
    assert_int_equal(read_sized(f, 64, 4097, 16), STATUS_BAD_INPUT);
    assert_int_equal(read_sized(f, 64, 4096, 17), STATUS_BAD_INPUT);
    assert_int_equal(read_sized(f, 1, 2, 1), STATUS_OK);
    assert_int_equal(read_sized(f, 0, 2, 1), STATUS_BAD_INPUT);
    assert_int_equal(read_sized(f, 1, 1, 1), STATUS_BAD_INPUT);
}

/* A hash of the identities of all cells, in their order. */
static uint64_t hash_of(const fixture *f, const char *text)
{
    study *s = fixture_study(f, text);
    uint64_t hash = HASH_START;
    for (size_t cell = 0; cell < study_cell_count(s); cell++)
        hash = hash_words(hash, &(const int64_t){(int64_t)s->identity[cell]}, 1);
    study_destroy(s);
    return hash;
}

/* Identities depend on the meaning of a row, not on the form of the file or the number of repetitions. */
static void equivalent_studies_have_the_same_identities(void **state)
{
    const fixture *f = *state;
    uint64_t hash =
        hash_of(f, "study: x\nscene: scene.yaml\nset: {render.width: 32}\ngrid:\n  - {ball.ior: [1.0, 1.5]}\n");
    assert_int_equal(
        hash_of(f, "# why\nstudy: x\ntitle: T\nscene: scene.yaml\nset:\n  render.width: 32\n"
                   "grid: [{ball.ior: [1, 1.50]}]\nrepetitions: 9\nwarmups: 0\norder: {seed: 2}\nkeep: {image: on}\n"),
        hash);
    static const char *const others[] = {
        "study: x\nscene: scene.yaml\nset: {render.width: 33}\ngrid:\n  - {ball.ior: [1.0, 1.5]}\n",
        "study: x\nscene: scene.yaml\nset: {render.width: 32}\ngrid:\n  - {ball.ior: [1.0, 1.6]}\n",
        "study: x\nscene: scene.yaml\nset: {render.width: 32}\ngrid:\n  - {ball.ior: [1.5, 1.0]}\n",
        "study: x\nscene: scene.yaml\nset: {render.width: 32}\ngrid:\n  - {clear.ior: [1.0, 1.5]}\n",
        "study: x\nscene: scene.yaml\nset: {render.width: 32}\n",
    };
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        assert_int_not_equal(hash_of(f, others[i]), hash);
    fixture_write(f, "scene.yaml",
                  "title: a ball alone\n"
                  "render: {width: 24, height: 18, depth: 2, tile: 8}\n"
                  "materials: {clear: {transparency: 1, ior: 1.5}}\n"
                  "solids: {ball: {shape: sphere, material: clear, position: [0, 1, 0], radius: 1, priority: 1}}\n");
    assert_int_not_equal(
        hash_of(f, "study: x\nscene: scene.yaml\nset: {render.width: 32}\ngrid:\n  - {ball.ior: [1.0, 1.5]}\n"), hash);
}

/* The same names with other contents are other cells: for a mesh's positions, colours and normals. */
static void contents_of_files_are_part_of_an_identity(void **state)
{
    const fixture *f = *state;
    static const char text[] = "study: x\nscene: painted.yaml\n";
    static const char *const files[][2] = {
        {"tri.obj", "mtllib tri.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 2\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl red\nf 1/1 2/2 3/3\n"},
        {"tri.obj", "mtllib tri.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 2\nvt 0 0\nvt 1 0\nvt 0 0.5\nusemtl red\nf 1/1 2/2 3/3\n"},
        {"tri.mtl", "newmtl red\nKd 1 0 0.5\n"},
        {"spots.pfm", "PF\n1 1\n1.0\n0000AAAA1111"},
    };
    fixture_write(f, "painted.yaml",
                  "meshes: {tri: {file: tri.obj}}\ntextures: {spots: {file: spots.pfm}}\n"
                  "solids: {one: {shape: mesh, mesh: tri}}\n");
    fixture_write(f, "tri.obj",
                  "mtllib tri.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl red\nf 1/1 2/2 3/3\n");
    fixture_write(f, "tri.mtl", "newmtl red\nKd 1 0 0\n");
    fixture_write(f, "spots.pfm", "PF\n1 1\n1.0\n000000000000");
    uint64_t hash = hash_of(f, text);
    assert_int_equal(hash_of(f, text), hash);
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        fixture_write(f, files[i][0], files[i][1]);
        const uint64_t other = hash_of(f, text);
        assert_int_not_equal(other, hash);
        hash = other;
    }
}

static void paths_of_scenes_are_relative_to_the_study(void **state)
{
    const fixture *f = *state;
    char folder[400], path[400], absolute[512];
    fixture_path(f, "deeper", folder);
    assert_int_equal(mkdir(folder, 0777), 0);
    fixture_write(f, "deeper/a.study", "study: a\nscene: ../scene.yaml\n");
    fixture_path(f, "deeper/a.study", path);
    study *s = NULL;
    assert_int_equal(study_read(path, &s, NULL), STATUS_OK);
    assert_string_equal(s->scene_text, fixture_scene);
    study_destroy(s);
    snprintf(absolute, sizeof absolute, "study: a\nscene: %s/scene.yaml\n", f->folder);
    s = fixture_study(f, absolute);
    assert_string_equal(s->scene_text, fixture_scene);
    study_destroy(s);
}

/* A mistake in the scene is located in the scene. */
static void errors_in_scenes_of_studies_are_located_in_the_scene(void **state)
{
    const fixture *f = *state;
    char path[400], scene_path[400];
    diagnostic why = {0};
    study *s = NULL;
    fixture_write(f, "scene.yaml", "render:\n  widht: 5\n");
    fixture_write(f, "test.study", "study: a\nscene: scene.yaml\n");
    fixture_path(f, "test.study", path);
    fixture_path(f, "scene.yaml", scene_path);
    assert_int_equal(study_read(path, &s, &why), STATUS_BAD_INPUT);
    assert_null(s);
    assert_string_equal(why.file, scene_path);
    assert_int_equal(why.line, 2);
}

static void check_bad(const char *name, long line, long column, const char *what)
{
    char path[1100];
    diagnostic why = {0};
    study *s = NULL;
    snprintf(path, sizeof path, "%s/%s", bad_folder, name);
    status code = study_read(path, &s, &why);
    if (code != STATUS_BAD_INPUT || s || strcmp(why.file, path) != 0 || why.line != line || why.column != column ||
        strcmp(why.what, what) != 0 || strchr(why.remedy, '\n'))
        fail_msg("%s: status %d, %s:%ld:%ld: %s", name, code, why.file, why.line, why.column, why.what);
}

/* tests/bad/studies/expected.tsv lists every file of the folder with its diagnostic. */
static void errors_in_studies_are_located(void **state)
{
    (void)state;
    char line[1024], path[400];
    size_t listed = 0, there = 0;
    snprintf(path, sizeof path, "%s/expected.tsv", bad_folder);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        if (line[0] == '#')
            continue;
        line[strcspn(line, "\n")] = 0;
        char *place = strchr(line, '\t'), *what = place ? strchr(place + 1, '\t') : NULL;
        assert_non_null(what);
        *place++ = 0;
        *what++ = 0;
        long row, column;
        assert_int_equal(sscanf(place, "%ld:%ld", &row, &column), 2);
        check_bad(line, row, column, what);
        listed++;
    }
    fclose(file);
    DIR *folder = opendir(bad_folder);
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));)
        there += strlen(entry->d_name) > 6 && strcmp(entry->d_name + strlen(entry->d_name) - 6, ".study") == 0;
    closedir(folder);
    assert_int_equal(listed, there);
    assert_true(listed >= 25);
}

/* A truncated file is an error or a smaller study, never a crash. */
static void truncated_studies_are_valid_or_refused(void **state)
{
    const fixture *f = *state;
    static const char text[] =
        "study: cut\nscene: scene.yaml\nset: {render.width: 32}\n"
        "grid:\n  - {render.depth: [0, 1]}\n  - name: p\n    points: [{ball.ior: 1.2}]\n"
        "repetitions: {min: 2, max: 3, relative_width: 0.1}\norder: {shuffle: on}\nkeep: {image: on}\n";
    char name[400];
    fixture_path(f, "test.study", name);
    for (size_t size = 0; size < sizeof text; size++) {
        diagnostic why = {0};
        study *s = NULL;
        status code = study_read_text(name, text, size, &s, &why);
        assert_true(code == STATUS_OK ? s != NULL : code == STATUS_BAD_INPUT && !s && why.what[0]);
        study_destroy(s);
    }
}

static void every_study_of_the_project_is_read(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        size_t cells;
    } known[] = {{"depth", 9},          {"threads", 44},     {"ior", 4},
                 {"full/ior-grid", 25}, {"profile", 12},     {"full/pool", 10},
                 {"full/maps", 1},      {"portrait", 1},     {"full/convergence", 30},
                 {"methods", 7},        {"lighting", 3},     {"full/absorption", 5},
                 {"full/absorber", 11}, {"full/liquids", 5}, {"full/photons", 10}};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        char path[400], message[DIAGNOSTIC_TEXT_MAX];
        diagnostic why = {0};
        study *s = NULL;
        snprintf(path, sizeof path, "experiments/%s.study", known[i].name);
        if (study_read(path, &s, &why) != STATUS_OK)
            fail_msg("%s", diagnostic_text(&why, message, sizeof message));
        assert_non_null(strstr(known[i].name, s->name));
        assert_int_equal(study_cell_count(s), known[i].cells);
        study_destroy(s);
    }
}

typedef struct guard_notes {
    int opens, loads, refuse_open, refuse_load; /* which call is refused, from 1; 0: none */
    bool seen_image;
} guard_notes;

static status note_open(void *context, const char *path, diagnostic *why)
{
    guard_notes *n = context;
    assert_non_null(strstr(path, "scene.yaml"));
    return ++n->opens == n->refuse_open ? diagnose(why, STATUS_BAD_INPUT, "stay inside", "this lies outside")
                                        : STATUS_OK;
}

static status note_load(void *context, const scene *setting, diagnostic *why)
{
    guard_notes *n = context;
    assert_null(setting->background.img);
    n->seen_image |= strcmp(setting->background.image_path, "far.png") == 0;
    return ++n->loads == n->refuse_load ? diagnose(why, STATUS_BAD_INPUT, "stay inside", "that lies outside")
                                        : STATUS_OK;
}

/* Files of the scene, the cells and the reference: access to each is checked before any is read. */
static void the_guard_is_called_before_any_file_is_read(void **state)
{
    const fixture *f = *state;
    const char *text = "study: test\nscene: scene.yaml\ngrid: [{background.image: [near.png, far.png]}]\nreference: "
                       "{render.depth: 3}\n";
    char path[400];
    fixture_write(f, "test.study", text);
    fixture_path(f, "test.study", path);
    for (int refused = 0; refused <= 6; refused++) {
        guard_notes n = {.refuse_open = refused == 6, .refuse_load = refused};
        const study_guard guard = {.may_open = note_open, .may_load = note_load, .context = &n};
        study *s = NULL;
        diagnostic why = {0};
        const status code = study_read_guarded(path, &guard, &s, &why);
        assert_int_equal(n.opens, 1);
        assert_int_equal(code, refused ? STATUS_BAD_INPUT : STATUS_OK);
        assert_int_equal(n.loads, refused == 0   ? 5
                                  : refused == 6 ? 0
                                                 : refused); /* the scene, two cells, two references */
        assert_int_equal(refused == 0, n.seen_image && s);
        if (refused)
            assert_string_equal(why.what, refused == 6 ? "this lies outside" : "that lies outside");
        study_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_whole_grammar_is_read, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(the_guard_is_called_before_any_file_is_read, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(omitted_study_keys_have_their_defaults, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(values_of_ranges_are_evenly_spaced, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(the_largest_studies_are_read_and_larger_ones_refused, fixture_setup,
                                        fixture_teardown),
        cmocka_unit_test_setup_teardown(equivalent_studies_have_the_same_identities, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(contents_of_files_are_part_of_an_identity, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(paths_of_scenes_are_relative_to_the_study, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(errors_in_scenes_of_studies_are_located_in_the_scene, fixture_setup,
                                        fixture_teardown),
        cmocka_unit_test(errors_in_studies_are_located),
        cmocka_unit_test_setup_teardown(truncated_studies_are_valid_or_refused, fixture_setup, fixture_teardown),
        cmocka_unit_test(every_study_of_the_project_is_read),
    };
    return cmocka_run_group_tests_name("study_read", tests, NULL, NULL);
}
