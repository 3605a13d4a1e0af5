/* Tests of files in a running laboratory: nothing outside its folder is read or written, and a saved and reopened scene
 * makes the same film. */
#include "lab_edit_fixture.h"

static void files_of_the_folder_are_listed(void **state)
{
    const room *r = *state;
    json_t *files = ask(r, 200, "GET", "/api/files", NULL);
    assert_string_equal(json_string_value(json_object_get(files, "folder")), "lab");
    assert_int_equal(json_array_size(json_object_get(files, "scenes")), 4);
    assert_string_equal(json_string_value(json_array_get(json_object_get(files, "models"), 0)), "deep/Two sides.obj");
    assert_string_equal(json_string_value(json_object_get(files, "prefix")), "../");
    json_decref(files);
    /* `prefix` + name is a path relative to the scene's file. */
    expect(r, 200, "POST", "/api/set", "{\"set\": {\"background.image\": \"../image.png\"}}");
    char hash[64];
    film(r, hash);
    json_t *media = ask(r, 200, "GET", "/api/media", NULL);
    assert_true(json_array_size(media) > 10 || json_object_size(media) > 0);
    json_decref(media);
}

static void opening_refuses_invalid_requests_and_files(void **state)
{
    const room *r = *state;
    const json_int_t before = generation(r);
    static const char *const bad[] = {
        "{\"file\": \"../outside.yaml\"}",
        "{\"file\": \"deep/../../outside.yaml\"}",
        "{\"file\": \"/etc/passwd\"}",
        "{\"file\": \"\"}",
        "{\"file\": 3}",
        "{}",
        "[]",
        "{\"file\": \"deep\"}",
        "{\"file\": \"climbs.yaml\"}",
        "{\"file\": \"climbs2.yaml\"}",
        "{\"new\": true, \"file\": \"deep/ball.yaml\"}",
        "{\"new\": 1}",
        "{\"file\": \"image.png\"}",
        "{\"file\"",
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        expect(r, 400, "POST", "/api/open", bad[i]);
    expect(r, 404, "POST", "/api/open", "{\"file\": \"none.yaml\"}");
    json_t *why = ask(r, 400, "POST", "/api/open", "{\"file\": \"wrong.yaml\"}");
    assert_int_equal(json_integer_value(json_object_get(why, "line")), 2);
    json_decref(why);
    assert_int_equal(generation(r), before);
}

static void opening_a_scene_can_be_undone(void **state)
{
    const room *r = *state;
    char first[64], hash[64], text[256];
    film(r, first);
    expect(r, 200, "POST", "/api/open", "{\"new\": true}");
    assert_string_equal(state_text(r, "file", text), "");
    assert_string_equal(state_text(r, "title", text), "A new scene");
    expect(r, 200, "POST", "/api/set", "{\"set\": {\"render.width\": 40, \"render.height\": 30}}");
    film(r, hash);
    assert_string_not_equal(hash, first);
    expect(r, 200, "POST", "/api/undo", "{}");
    expect(r, 200, "POST", "/api/undo", "{}");
    assert_string_equal(state_text(r, "file", text), "deep/ball.yaml");
    film(r, hash);
    assert_string_equal(hash, first);
    expect(r, 200, "POST", "/api/open", "{\"file\": \"deep/ball.yaml\"}");
    film(r, hash);
    assert_string_equal(hash, first);
}

static void a_saved_scene_reopens_with_the_same_film_and_invalid_names_are_refused(void **state)
{
    const room *r = *state;
    static const char *const bad[] = {"{\"file\": \"../new.yaml\"}",
                                      "{\"file\": \"/tmp/new.yaml\"}",
                                      "{\"file\": \"none/new.yaml\"}",
                                      "{\"file\": \"new.txt\"}",
                                      "{\"file\": \"new\"}",
                                      "{\"file\": \".new.yaml\"}",
                                      "{\"file\": \"-\"}",
                                      "{\"file\": \"\"}",
                                      "{}",
                                      "{\"file\": \"new.yaml\", \"replace\": \"yes\"}",
                                      "{\"file\": \"deep\", \"replace\": true}"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        expect(r, 400, "POST", "/api/save", bad[i]);
    assert_false(is_there(r, "new.yaml"));
    char before[64], after[64], text[256];
    expect(r, 200, "POST", "/api/objects", "{\"kind\": \"model\", \"file\": \"deep/Two sides.obj\"}");
    expect(r, 200, "POST", "/api/set", "{\"set\": {\"background.image\": \"../image.png\"}}");
    film(r, before);
    expect(r, 409, "POST", "/api/save", "{\"file\": \"wrong.yaml\"}");
    expect(r, 409, "POST", "/api/save", "{\"file\": \"wrong.yaml\", \"replace\": false}");
    /* Its paths are relative to another folder now. */
    expect(r, 200, "POST", "/api/save", "{\"file\": \"wrong.yaml\", \"replace\": true}");
    assert_string_equal(state_text(r, "file", text), "wrong.yaml");
    expect(r, 200, "POST", "/api/save", "{\"file\": \"wrong.yaml\"}");
    expect(r, 200, "POST", "/api/save", "{\"file\": \"deep/Another \\u00fc.yml\"}");
    assert_true(is_there(r, "lab/deep/Another \xc3\xbc.yml"));
    char *path = text_format("%s/wrong.yaml", r->inside), *saved = NULL;
    size_t size;
    assert_int_equal(file_read(path, 1 << 20, &saved, &size, NULL), STATUS_OK);
    assert_null(strstr(saved, "threads")); /* threads is the laboratory's default */
    assert_non_null(strstr(saved, "deep/Two sides.obj"));
    free(saved);
    free(path);
    expect(r, 200, "POST", "/api/open", "{\"new\": true}");
    static const char *const again[] = {"{\"file\": \"wrong.yaml\"}", "{\"file\": \"deep/Another \\u00fc.yml\"}"};
    for (size_t i = 0; i < 2; i++) {
        expect(r, 200, "POST", "/api/open", again[i]);
        film(r, after);
        assert_string_equal(before, after);
    }
}

static void saving_does_not_follow_links_out_of_the_folder(void **state)
{
    const room *r = *state;
    char *link_path = text_format("%s/link.yaml", r->inside), *gone = text_format("%s/gone.yaml", r->inside);
    assert_int_equal(symlink("../outside.yaml", link_path), 0);
    assert_int_equal(symlink("../fresh.yaml", gone), 0);
    expect(r, 400, "POST", "/api/save", "{\"file\": \"link.yaml\", \"replace\": true}");
    expect(r, 400, "POST", "/api/save", "{\"file\": \"gone.yaml\", \"replace\": true}");
    expect(r, 400, "POST", "/api/open", "{\"file\": \"link.yaml\"}");
    assert_false(is_there(r, "fresh.yaml"));
    free(link_path);
    free(gone);
}

static void path_parameters_are_confined_to_the_folder(void **state)
{
    const room *r = *state;
    expect(r, 200, "POST", "/api/objects", "{\"kind\": \"texture\", \"file\": \"image.png\", \"name\": \"cloth\"}");
    expect(r, 200, "POST", "/api/objects",
           "{\"kind\": \"model\", \"file\": \"deep/Two sides.obj\", \"name\": \"body\"}");
    const json_int_t before = generation(r);
    expect(r, 400, "POST", "/api/set", "{\"set\": {\"background.image\": \"../../outside.png\"}}");
    expect(r, 400, "POST", "/api/set", "{\"set\": {\"cloth.file\": \"../../outside.png\"}}");
    expect(r, 400, "POST", "/api/set", "{\"set\": {\"body-mesh.file\": \"../../outside.obj\"}}");
    expect(r, 400, "POST", "/api/set", "{\"set\": {\"body-mesh.script\": \"/etc/passwd\"}}");
    assert_int_equal(generation(r), before);
    expect(r, 200, "POST", "/api/objects/body/rename", "{\"to\": \"cut\"}");
    expect(r, 200, "POST", "/api/set", "{\"set\": {\"stone.texture\": \"cloth\"}}");
    char hash[64];
    film(r, hash);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(files_of_the_folder_are_listed, enter, leave),
        cmocka_unit_test_setup_teardown(opening_refuses_invalid_requests_and_files, enter, leave),
        cmocka_unit_test_setup_teardown(opening_a_scene_can_be_undone, enter, leave),
        cmocka_unit_test_setup_teardown(a_saved_scene_reopens_with_the_same_film_and_invalid_names_are_refused, enter,
                                        leave),
        cmocka_unit_test_setup_teardown(saving_does_not_follow_links_out_of_the_folder, enter, leave),
        cmocka_unit_test_setup_teardown(path_parameters_are_confined_to_the_folder, enter, leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
