/* Every file of tests/bad/scenes ends in STATUS_BAD_INPUT with the one line that expected.txt says. Run from the
 * repository root. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "scene/scene.h"
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FOLDER "tests/bad/scenes/"

/* Reads the file that a line of expected.txt begins with, and compares. */
static void compare_line(const char *expected)
{
    char path[256], text[DIAGNOSTIC_TEXT_MAX], wanted[DIAGNOSTIC_TEXT_MAX];
    int name = (int)strcspn(expected, ":");
    assert_true(snprintf(path, sizeof path, FOLDER "%.*s", name, expected) < (int)sizeof path);
    assert_true(snprintf(wanted, sizeof wanted, FOLDER "%s", expected) < (int)sizeof wanted);
    diagnostic why = {.what = ""};
    scene *s = NULL;
    status code = scene_read(path, &s, &why);
    if (code != STATUS_BAD_INPUT) {
        print_error("%s: status %d\n", path, (int)code);
    }
    assert_int_equal(code, STATUS_BAD_INPUT);
    assert_null(s);
    assert_string_equal(diagnostic_text(&why, text, sizeof text), wanted);
    assert_true(why.line > 0 && why.column > 0);
    assert_null(strchr(text, '\n'));
}

static size_t count_scenes(void)
{
    DIR *folder = opendir(FOLDER);
    assert_non_null(folder);
    size_t count = 0;
    for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        count += strstr(entry->d_name, ".yaml") != NULL;
    }
    closedir(folder);
    return count;
}

static void every_bad_scene_has_its_located_line(void **state)
{
    (void)state;
    FILE *list = fopen(FOLDER "expected.txt", "r");
    assert_non_null(list);
    char line[DIAGNOSTIC_TEXT_MAX];
    size_t count = 0;
    while (fgets(line, sizeof line, list)) {
        line[strcspn(line, "\n")] = 0;
        compare_line(line);
        count++;
    }
    fclose(list);
    assert_int_equal(count, count_scenes());
    assert_true(count >= 60);
}

/* A file that was cut anywhere is a scene or is refused with a place; it never does anything else. */
static void every_cut_of_a_good_scene_is_a_scene_or_refused(void **state)
{
    (void)state;
    char text[16384];
    FILE *file = fopen("experiments/scenes/rod.yaml", "r");
    assert_non_null(file);
    size_t size = fread(text, 1, sizeof text, file), refused = 0;
    fclose(file);
    assert_true(size > 1000 && size < sizeof text);
    for (size_t cut = 0; cut < size; cut++) {
        char *exact = malloc(cut + 1); /* of its own size, for the address sanitizer */
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

static void a_file_that_is_not_there_is_named(void **state)
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
        cmocka_unit_test(every_bad_scene_has_its_located_line),
        cmocka_unit_test(every_cut_of_a_good_scene_is_a_scene_or_refused),
        cmocka_unit_test(a_file_that_is_not_there_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
