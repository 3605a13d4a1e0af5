/* Tests of the laboratory's folder: names inside and outside, files that a scene may use, and the list of files. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/text.h"
#include "scene/model/edit/edit.h"
#include "scene/model/open.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "web/document/folder.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct room {
    char *above, *inside;
    folder *f;
} room; /* inside is the folder; secret.yaml is next to it */

static void put(const char *at, const char *name, const char *text)
{
    char *path = text_format("%s/%s", at, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    free(path);
}

static void link_to(const char *at, const char *name, const char *target)
{
    char *path = text_format("%s/%s", at, name);
    assert_int_equal(symlink(target, path), 0);
    free(path);
}

static void make_folder(const char *at, const char *name)
{
    char *path = text_format("%s/%s", at, name);
    assert_int_equal(mkdir(path, 0700), 0);
    free(path);
}

static int enter(void **state)
{
    room *r = calloc(1, sizeof *r);
    char place[] = "/tmp/cuvette-folder-XXXXXX";
    r->above = strdup(mkdtemp(place));
    r->inside = text_format("%s/lab", r->above);
    make_folder(r->above, "lab");
    put(r->above, "secret.yaml", "solids: {}\n");
    make_folder(r->above, "labour"); /* a sibling whose name begins with the folder's name */
    put(r->above, "labour/secret.yaml", "solids: {}\n");
    make_folder(r->inside, "sub");
    put(r->inside, "a scene.yaml", "solids: {}\n");
    put(r->inside, "sub/Kuh-\xc3\xbc.yml", "camera: {}\n");
    put(r->inside, "sub/pull.yaml", "hands: {left: []}\n");
    put(r->inside, "sub/other.yaml", "jobs: {build: 1}\n");
    put(r->inside, "broken.yaml", "solids: {\n");
    link_to(r->inside, "out.yaml", "../secret.yaml");
    link_to(r->inside, "up", "..");
    link_to(r->inside, "gone.yaml", "nowhere.yaml");
    link_to(r->inside, "gone-out.yaml", "../nowhere.yaml");
    link_to(r->inside, "in.yaml", "sub/Kuh-\xc3\xbc.yml");
    diagnostic why = {.what = ""};
    assert_int_equal(folder_open(r->inside, &r->f, &why), STATUS_OK);
    *state = r;
    return 0;
}

static int leave(void **state)
{
    room *r = *state;
    folder_close(r->f);
    char *command = text_format("rm -r '%s'", r->above);
    assert_int_equal(system(command), 0);
    free(command);
    free(r->inside);
    free(r->above);
    free(r);
    return 0;
}

static bool leads(const room *r, const char *name, bool must_exist)
{
    char *path = NULL;
    diagnostic why = {.what = ""};
    const status code = folder_path(r->f, name, must_exist, &path, &why);
    assert_true(code == STATUS_OK || (code == STATUS_BAD_INPUT && why.what[0] && !path));
    if (code == STATUS_OK) {
        char *whole = text_format("%s/%s", r->inside, name);
        assert_string_equal(path, whole);
        free(whole);
    }
    free(path);
    return code == STATUS_OK;
}

static void names_inside_the_folder_are_accepted(void **state)
{
    const room *r = *state;
    assert_true(leads(r, "a scene.yaml", true));
    assert_true(leads(r, "a scene.yaml", false));
    assert_true(leads(r, "sub/Kuh-\xc3\xbc.yml", true));
    assert_true(leads(r, "in.yaml", true));
    assert_true(leads(r, "new.yaml", false));
    assert_true(leads(r, "sub/new.yaml", false));
    assert_true(leads(r, "..new.yaml", false));
    assert_false(leads(r, "new.yaml", true));
    assert_false(leads(r, "sub", true));
    assert_false(leads(r, "sub", false));
    assert_false(leads(r, "not/there.yaml", false));
    assert_false(leads(r, "a scene.yaml/new.yaml", false));
}

static void names_outside_the_folder_are_refused(void **state)
{
    const room *r = *state;
    char *absolute = text_format("%s/a scene.yaml", r->inside), *longest = malloc(100001);
    memset(longest, 'a', 100000);
    longest[100000] = 0;
    const char *const bad[] = {"",
                               ".",
                               "..",
                               "/",
                               "../secret.yaml",
                               "sub/../../secret.yaml",
                               "sub/../a scene.yaml",
                               "./a scene.yaml",
                               "sub//Kuh-\xc3\xbc.yml",
                               "sub/",
                               "/etc/passwd",
                               "out.yaml",
                               "up/secret.yaml",
                               "up/lab/a scene.yaml/..",
                               "gone.yaml",
                               "gone-out.yaml",
                               "up/new.yaml",
                               "up/labour/secret.yaml",
                               "../labour/secret.yaml",
                               "a\nb.yaml",
                               absolute,
                               longest};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        if (leads(r, bad[i], true) || leads(r, bad[i], false))
            fail_msg("'%.80s' was accepted", bad[i]);
    /* A path through a link and back is inside. */
    assert_true(leads(r, "up/lab/a scene.yaml", true));
    free(absolute);
    free(longest);
}

static void name_is(const room *r, const char *below, const char *expected)
{
    char *path = text_format("%s/%s", r->inside, below), *name = folder_name(r->f, path);
    if (expected)
        assert_string_equal(name, expected);
    else
        assert_null(name);
    free(name);
    free(path);
}

static void paths_are_named_relative_to_the_folder(void **state)
{
    const room *r = *state;
    name_is(r, "a scene.yaml", "a scene.yaml");
    name_is(r, "sub/../a scene.yaml", "a scene.yaml");
    name_is(r, "in.yaml", "sub/Kuh-\xc3\xbc.yml");
    name_is(r, "sub/none/so/far.png", "sub/none/so/far.png");
    name_is(r, "none/../far.png", NULL);
    name_is(r, "", NULL);
    name_is(r, "..", NULL);
    name_is(r, "../secret.yaml", NULL);
    name_is(r, "../labour/secret.yaml", NULL);
    name_is(r, "../labour", NULL);
    name_is(r, "up/none.png", NULL);
    name_is(r, "gone-out.yaml", NULL);
    name_is(r, "gone-out.yaml/none", NULL);
    assert_null(folder_name(r->f, "/etc/passwd"));
    assert_null(folder_name(r->f, ""));
}

static void the_working_directory_can_be_the_folder(void **state)
{
    const room *r = *state;
    char here[4096], *path = NULL;
    folder *f = NULL;
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(chdir(r->inside), 0);
    assert_int_equal(folder_open(".", &f, NULL), STATUS_OK);
    assert_string_equal(folder_title(f), "lab");
    assert_int_equal(folder_path(f, "a scene.yaml", true, &path, NULL), STATUS_OK);
    assert_string_equal(path, "a scene.yaml");
    free(path);
    assert_int_equal(folder_path(f, "-", false, &path, NULL), STATUS_OK); /* not standard output */
    assert_string_equal(path, "./-");
    free(path);
    assert_int_equal(folder_path(f, "up/secret.yaml", true, &path, NULL), STATUS_BAD_INPUT);
    assert_int_equal(folder_path_from(f, "sub/x.png", "", &path, NULL), STATUS_OK);
    assert_string_equal(path, "sub/x.png");
    free(path);
    assert_int_equal(folder_path_from(f, "x.png", "sub/scene.yaml", &path, NULL), STATUS_OK);
    assert_string_equal(path, "../x.png");
    free(path);
    folder_close(f);
    assert_int_equal(chdir(here), 0);
    assert_int_equal(folder_open("/", &f, NULL), STATUS_OK);
    assert_int_equal(folder_path(f, "etc/passwd", true, &path, NULL), STATUS_OK);
    assert_string_equal(path, "/etc/passwd");
    free(path);
    folder_close(f);
}

static void invalid_folders_are_refused(void **state)
{
    const room *r = *state;
    char *file = text_format("%s/a scene.yaml", r->inside);
    const char *const bad[] = {file, "/nowhere at all", ""};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        folder *f = NULL;
        diagnostic why = {.what = ""};
        assert_int_equal(folder_open(bad[i], &f, &why), STATUS_BAD_INPUT);
        assert_null(f);
        assert_true(why.what[0]);
    }
    folder_close(NULL);
    free(file);
}

/* A scene in sub/ that uses that path. */
static status check_naming(const room *r, const char *row, const char *path)
{
    scene *s = NULL;
    diagnostic why = {.what = ""};
    assert_int_equal(new_scene(false, &s, NULL), STATUS_OK);
    free(s->path);
    s->path = text_format("%s/sub/scene.yaml", r->inside);
    assert_int_equal(scene_add(s, PARAM_MESH, "body", NULL, NULL), STATUS_OK);
    assert_int_equal(scene_add(s, PARAM_TEXTURE, "cloth", NULL, NULL), STATUS_OK);
    assert_int_equal(scene_add(s, PARAM_DATA, "dye", NULL, NULL), STATUS_OK);
    assert_int_equal(scene_set(s, row, path, NULL), STATUS_OK);
    const status code = folder_check_scene(r->f, s, &why);
    assert_true((code == STATUS_OK) == !why.what[0]);
    scene_destroy(s);
    return code;
}

static void files_that_a_scene_refers_to_must_be_inside(void **state)
{
    const room *r = *state;
    static const char *const rows[] = {"background.image", "body.file", "body.script", "cloth.file", "dye.file"};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(check_naming(r, rows[i], "pull.yaml"), STATUS_OK);
        assert_int_equal(check_naming(r, rows[i], "../a scene.yaml"), STATUS_OK);
        assert_int_equal(check_naming(r, rows[i], "not/there.png"), STATUS_OK);
        assert_int_equal(check_naming(r, rows[i], "../../secret.yaml"), STATUS_BAD_INPUT);
        assert_int_equal(check_naming(r, rows[i], "../../nowhere.png"), STATUS_BAD_INPUT);
        assert_int_equal(check_naming(r, rows[i], "../out.yaml"), STATUS_BAD_INPUT);
        assert_int_equal(check_naming(r, rows[i], "../up/labour/secret.yaml"), STATUS_BAD_INPUT);
        assert_int_equal(check_naming(r, rows[i], "/etc/passwd"), STATUS_BAD_INPUT);
    }
}

static bool lists(const json_t *all, const char *use, const char *name)
{
    size_t i;
    json_t *item;
    json_array_foreach(json_object_get(all, use), i, item) if (strcmp(json_string_value(item), name) == 0) return true;
    return false;
}

static void visible_files_inside_are_listed_by_use(void **state)
{
    const room *r = *state;
    put(r->inside, ".hidden.yaml", "solids: {}\n");
    make_folder(r->inside, ".git");
    put(r->inside, ".git/x.yaml", "solids: {}\n");
    make_folder(r->inside, "sub/two");
    make_folder(r->inside, "sub/two/three");
    make_folder(r->inside, "sub/two/three/four");
    put(r->inside, "sub/two/three/deep.OBJ", "");
    put(r->inside, "sub/two/three/four/deeper.obj", "");
    put(r->inside, "p.jpeg", "");
    put(r->inside, "q.study", "");
    put(r->inside, "bad\xff.png", "");
    put(r->inside, "notes.md", "");
    put(r->inside, "led.csv", "");
    put(r->inside, "SCHOTT.AGF", "");
    put(r->inside, "bk7.yml", "DATA: [{type: formula 1}]\n");
    link_to(r->inside, "passwd.png", "/etc/passwd");
    json_t *all = NULL;
    assert_int_equal(folder_json(r->f, &all, NULL), STATUS_OK);
    assert_string_equal(json_string_value(json_object_get(all, "folder")), "lab");
    assert_true(lists(all, "scenes", "a scene.yaml") && lists(all, "scenes", "sub/Kuh-\xc3\xbc.yml") &&
                lists(all, "scenes", "broken.yaml"));
    assert_true(lists(all, "scenes", "in.yaml") && lists(all, "scripts", "sub/pull.yaml") &&
                lists(all, "models", "sub/two/three/deep.OBJ"));
    assert_true(lists(all, "images", "p.jpeg") && lists(all, "studies", "q.study"));
    assert_true(lists(all, "data", "led.csv") && lists(all, "data", "SCHOTT.AGF") && lists(all, "data", "bk7.yml"));
    assert_int_equal(json_array_size(json_object_get(all, "data")), 3);
    assert_int_equal(json_array_size(json_object_get(all, "scenes")), 4);
    assert_int_equal(json_array_size(json_object_get(all, "scripts")), 1);
    assert_int_equal(json_array_size(json_object_get(all, "models")), 1);
    assert_int_equal(json_array_size(json_object_get(all, "images")), 1);
    assert_string_equal(json_string_value(json_array_get(json_object_get(all, "scenes"), 0)), "a scene.yaml");
    assert_string_equal(json_string_value(json_array_get(json_object_get(all, "scenes"), 3)), "sub/Kuh-\xc3\xbc.yml");
    json_decref(all);
}

/* Files of upper folders are listed first. */
static void the_list_of_files_is_limited(void **state)
{
    const room *r = *state;
    make_folder(r->inside, "aa");
    for (int i = 0; i < FOLDER_FILES_MAX + 10; i++) {
        char name[32];
        snprintf(name, sizeof name, "aa/%d.png", i);
        put(r->inside, name, "");
    }
    json_t *all = NULL;
    assert_int_equal(folder_json(r->f, &all, NULL), STATUS_OK);
    size_t count = 0;
    static const char *const uses[] = {"scenes", "models", "images", "scripts", "studies"};
    for (size_t i = 0; i < sizeof uses / sizeof *uses; i++)
        count += json_array_size(json_object_get(all, uses[i]));
    assert_int_equal(count, FOLDER_FILES_MAX);
    assert_true(lists(all, "scenes", "a scene.yaml"));
    json_decref(all);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(names_inside_the_folder_are_accepted, enter, leave),
        cmocka_unit_test_setup_teardown(names_outside_the_folder_are_refused, enter, leave),
        cmocka_unit_test_setup_teardown(paths_are_named_relative_to_the_folder, enter, leave),
        cmocka_unit_test_setup_teardown(the_working_directory_can_be_the_folder, enter, leave),
        cmocka_unit_test_setup_teardown(invalid_folders_are_refused, enter, leave),
        cmocka_unit_test_setup_teardown(files_that_a_scene_refers_to_must_be_inside, enter, leave),
        cmocka_unit_test_setup_teardown(visible_files_inside_are_listed_by_use, enter, leave),
        cmocka_unit_test_setup_teardown(the_list_of_files_is_limited, enter, leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
