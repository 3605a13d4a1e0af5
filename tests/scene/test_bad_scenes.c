/* Tests of faulty scene files: every file of tests/bad/scenes is refused with STATUS_BAD_INPUT and the one line of
 * expected.txt. Run from the repository root. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "bad_files.h"
#include "scene/model/scene.h"
#include <stdlib.h>
#include <string.h>

#define FOLDER "tests/bad/scenes/"

static status read_bad_scene(const char *path, diagnostic *why)
{
    scene *s = NULL;
    const status code = scene_read(path, &s, why);
    assert_null(s);
    return code;
}

static void every_faulty_scene_is_refused_with_its_located_error(void **state)
{
    (void)state;
    assert_bad_files(FOLDER, read_bad_scene, 60);
}

/* A file truncated at any byte is either a valid scene or refused with a location. */
static void every_truncation_of_a_valid_scene_is_read_or_refused(void **state)
{
    (void)state;
    char text[16384];
    FILE *file = fopen("experiments/scenes/rod.yaml", "r");
    assert_non_null(file);
    size_t size = fread(text, 1, sizeof text, file), refused = 0;
    fclose(file);
    assert_true(size > 1000 && size < sizeof text);
    for (size_t cut = 0; cut < size; cut++) {
        char *exact = malloc(cut + 1); /* of exact size, for the address sanitizer */
        assert_non_null(exact);
        memcpy(exact, text, cut);
        diagnostic why = {.what = ""};
        scene *s;
        status code = scene_read_text("cut.yaml", exact, cut, &s, &why);
        assert_true(code == STATUS_OK || (code == STATUS_BAD_INPUT && why.line > 0 && why.column > 0 && why.what[0]));
        refused += code != STATUS_OK;
        scene_destroy(s);
        free(exact);
    }
    assert_true(refused > 100);
}

static void the_first_light_too_many_is_located(void **state)
{
    (void)state;
    enum { LIGHTS = 1025 };
    static char text[16 * LIGHTS];
    int size = snprintf(text, sizeof text, "lights:\n");
    for (int i = 0; i < LIGHTS; i++)
        size += snprintf(text + size, sizeof text - (size_t)size, "  l%d: {}\n", i);
    diagnostic why = {.what = ""};
    scene *s;
    assert_int_equal(scene_read_text("lights.yaml", text, (size_t)size, &s, &why), STATUS_BAD_INPUT);
    assert_int_equal(why.line, LIGHTS + 1);
    assert_int_equal(why.column, 3);
    assert_string_equal(why.what, "more than 1024 lights");
    assert_string_equal(why.remedy, "use at most 1024 lights");
}

static void a_missing_file_is_named_in_the_error(void **state)
{
    (void)state;
    diagnostic why = {.what = ""};
    scene *s;
    assert_int_equal(scene_read(FOLDER "no-such.yaml", &s, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.file, FOLDER "no-such.yaml");
    assert_int_equal(scene_read("tests", &s, NULL), STATUS_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_faulty_scene_is_refused_with_its_located_error),
        cmocka_unit_test(every_truncation_of_a_valid_scene_is_read_or_refused),
        cmocka_unit_test(the_first_light_too_many_is_located),
        cmocka_unit_test(a_missing_file_is_named_in_the_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
