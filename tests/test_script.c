/* Tests of script files: the contents of a valid one, and that each file of tests/bad-scripts gives STATUS_BAD_INPUT
 * with its line of expected.txt. Run from the repository root. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "bad_files.h"
#include "scene/assets/script.h"
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FOLDER "tests/bad-scripts/"

static const char good[] = "title: A tug to the left\n"
                           "hands:\n"
                           "  left:\n"
                           "    - {time_s: 0.5, grab: [0, 1, -6], towards: [0, 0.5, 1], reach: 0.3}\n"
                           "    - {time_s: 1.5, move: [-1.2, 0.8, 0]}\n"
                           "    - {time_s: 2, release: on}\n"
                           "  right:\n"
                           "    - time_s: 0\n"
                           "      grab: [3, 1, 2]\n"
                           "      towards: [-1, 0, 0]\n"
                           "      reach: 1\n";

static hand_script *read_good(void)
{
    hand_script *s = NULL;
    diagnostic why = {.what = ""};
    if (script_read_text("good.yaml", good, sizeof good - 1, &s, &why) != STATUS_OK)
        fail_msg("%ld: %s", why.line, why.what);
    return s;
}

static bool is_at(vec3 v, double x, double y, double z)
{
    return v.x == x && v.y == y && v.z == z;
}

static void the_hands_and_keys_of_a_valid_script_are_read(void **state)
{
    (void)state;
    hand_script *s = read_good();
    assert_string_equal(s->path, "good.yaml");
    assert_int_equal(s->track_count, 2);
    const hand_track *left = &s->tracks[0], *right = &s->tracks[1];
    assert_string_equal(left->name, "left");
    assert_string_equal(right->name, "right");
    assert_int_equal(left->key_count, 3);
    assert_int_equal(right->key_count, 1);
    const hand_key *k = left->keys;
    assert_true(k[0].act == HAND_GRAB && k[1].act == HAND_MOVE && k[2].act == HAND_RELEASE);
    assert_true(k[0].time_s == 0.5 && k[1].time_s == 1.5 && k[2].time_s == 2.0);
    assert_true(is_at(k[0].origin, 0.0, 1.0, -6.0) && is_at(k[0].direction, 0.0, 0.5, 1.0) && k[0].reach == 0.3);
    assert_true(is_at(k[1].by, -1.2, 0.8, 0.0));
    assert_true(k[2].line == 6 && k[2].column == 7);
    assert_true(is_at(right->keys[0].origin, 3.0, 1.0, 2.0) && is_at(right->keys[0].direction, -1.0, 0.0, 0.0));
    assert_true(right->keys[0].time_s == 0.0 && right->keys[0].reach == 1.0 && right->keys[0].line == 8);
    assert_true(hand_script_end_s(s) == 2.0);
    hand_script_destroy(s);
}

static status read_bad_script(const char *path, diagnostic *why)
{
    hand_script *s = NULL;
    const status code = script_read_below(path, NULL, &s, why);
    assert_null(s);
    assert_true(!why || why->remedy[0]);
    return code;
}

static void errors_in_scripts_are_located(void **state)
{
    (void)state;
    assert_bad_files(FOLDER, read_bad_script, 50);
}

/* A truncated script is valid or refused with a location. */
static void truncated_scripts_are_valid_or_refused(void **state)
{
    (void)state;
    size_t refused = 0;
    for (size_t cut = 0; cut < sizeof good - 1; cut++) {
        char *exact = malloc(cut + 1); /* exact size, for the address sanitizer */
        assert_non_null(exact);
        memcpy(exact, good, cut);
        diagnostic why = {.what = ""};
        hand_script *s;
        const status code = script_read_text("cut.yaml", exact, cut, &s, &why);
        assert_true(code == STATUS_OK || (code == STATUS_BAD_INPUT && why.line > 0 && why.column > 0 && why.what[0]));
        refused += code != STATUS_OK;
        hand_script_destroy(s);
        free(exact);
    }
    assert_true(refused > 100);
}

static void missing_and_too_large_scripts_are_refused(void **state)
{
    (void)state;
    diagnostic why = {.what = ""};
    hand_script *s;
    assert_int_equal(script_read_below(FOLDER "no-such.yaml", NULL, &s, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.file, FOLDER "no-such.yaml");
    assert_null(s);
    assert_int_equal(script_read_below("tests", NULL, &s, NULL), STATUS_BAD_INPUT);
    const size_t size = (64 << 20) + 1;
    char *huge = malloc(size);
    assert_non_null(huge);
    memset(huge, '#', size);
    assert_int_equal(script_read_text("huge.yaml", huge, size, &s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "larger than 64 MiB"));
    free(huge);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hands_and_keys_of_a_valid_script_are_read),
        cmocka_unit_test(errors_in_scripts_are_located),
        cmocka_unit_test(truncated_scripts_are_valid_or_refused),
        cmocka_unit_test(missing_and_too_large_scripts_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
