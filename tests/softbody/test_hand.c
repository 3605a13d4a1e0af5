/* Tests of recorded hands: the keys of a script, and the keys that it refuses without being changed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "softbody/softbody.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static hand_key grab(double time_s)
{
    return (hand_key){
        .time_s = time_s, .act = HAND_GRAB, .origin = {0.0, 1.0, -6.0}, .direction = {0.0, 0.0, 1.0}, .reach = 0.3};
}

static hand_key move(double time_s, double x)
{
    return (hand_key){.time_s = time_s, .act = HAND_MOVE, .by = {x, 0.0, 0.0}};
}

static hand_key release(double time_s)
{
    return (hand_key){.time_s = time_s, .act = HAND_RELEASE};
}

static hand_script *create(void)
{
    hand_script *s = hand_script_create("tug.yaml");
    assert_non_null(s);
    return s;
}

static void add(hand_script *s, const char *hand, hand_key key)
{
    diagnostic why = {.what = ""};
    if (hand_script_add(s, hand, &key, &why) != STATUS_OK)
        fail_msg("%s; %s", why.what, why.remedy);
}

static void refuse(hand_script *s, const char *hand, hand_key key, const char *what)
{
    diagnostic why = {.what = ""};
    const size_t tracks = s->track_count, keys = tracks ? s->tracks[0].key_count : 0;
    assert_int_equal(hand_script_add(s, hand, &key, &why), STATUS_BAD_INPUT);
    if (!strstr(why.what, what))
        fail_msg("'%s' is not in '%s'", what, why.what);
    assert_true(why.remedy[0] != 0 && why.file[0] == 0);
    assert_int_equal(s->track_count, tracks);
    assert_true(tracks == 0 || s->tracks[0].key_count == keys);
    assert_int_equal(hand_script_add(s, hand, &key, NULL), STATUS_BAD_INPUT);
}

static void an_empty_script_ends_at_time_0(void **state)
{
    (void)state;
    char path[] = "tug.yaml";
    hand_script *s = hand_script_create(path);
    assert_non_null(s);
    path[0] = 'm';
    assert_string_equal(s->path, "tug.yaml");
    assert_int_equal(s->track_count, 0);
    assert_true(hand_script_end_s(s) == 0.0);
    hand_script_destroy(s);
    hand_script_destroy(NULL);
}

static void keys_are_kept_per_hand_in_the_order_added(void **state)
{
    (void)state;
    hand_script *s = create();
    add(s, "left", grab(0.5));
    add(s, "right", grab(0.25));
    for (int i = 0; i < 100; i++) {
        add(s, "left", move(1.0 + i, -i));
        add(s, "right", move(1.0 + i, i));
    }
    add(s, "left", release(100.0));
    add(s, "left", grab(100.0)); /* again, at the same time */
    add(s, "right", move(100.5, 3.0));
    assert_int_equal(s->track_count, 2);
    assert_string_equal(s->tracks[0].name, "left");
    assert_string_equal(s->tracks[1].name, "right");
    assert_int_equal(s->tracks[0].key_count, 103);
    assert_int_equal(s->tracks[1].key_count, 102);
    for (size_t i = 0; i < 100; i++) {
        assert_true(s->tracks[0].keys[i + 1].by.x == -(double)i && s->tracks[1].keys[i + 1].by.x == (double)i);
        assert_true(s->tracks[0].keys[i + 1].time_s == 1.0 + (double)i);
    }
    assert_int_equal(s->tracks[0].keys[102].act, HAND_GRAB);
    assert_true(hand_script_end_s(s) == 100.5);
    hand_script_destroy(s);
}

static void impossible_key_sequences_are_refused(void **state)
{
    (void)state;
    hand_script *s = create();
    refuse(s, "left", move(0.0, 1.0), "cannot move without a grab");
    refuse(s, "left", release(0.0), "cannot release without a grab");
    add(s, "left", grab(1.0));
    refuse(s, "left", grab(2.0), "already holds something");
    refuse(s, "left", move(0.999, 1.0), "comes after");
    refuse(s, "right", move(2.0, 1.0), "cannot move without a grab");
    add(s, "left", move(1.0, 1.0));
    refuse(s, "left", grab(2.0), "already holds something");
    add(s, "left", release(1.5));
    refuse(s, "left", move(2.0, 1.0), "cannot move without a grab");
    refuse(s, "left", release(2.0), "cannot release without a grab");
    refuse(s, "left", grab(1.25), "comes after");
    hand_script_destroy(s);
}

static void invalid_numbers_are_refused(void **state)
{
    (void)state;
    hand_script *s = create();
    hand_key key = grab(-1.0);
    refuse(s, "left", key, "invalid time");
    key = grab((double)NAN);
    refuse(s, "left", key, "invalid time");
    key = grab((double)INFINITY);
    refuse(s, "left", key, "invalid time");
    key = grab(0.0);
    key.direction = (vec3){0.0, 0.0, 0.0};
    refuse(s, "left", key, "the grab ray is not finite or has no direction");
    key = grab(0.0);
    key.origin.y = (double)NAN;
    refuse(s, "left", key, "the grab ray is not finite or has no direction");
    key = grab(0.0);
    key.reach = 0.0;
    refuse(s, "left", key, "reach");
    key.reach = (double)NAN;
    refuse(s, "left", key, "reach");
    add(s, "left", grab(0.0));
    refuse(s, "left", move(1.0, (double)INFINITY), "the displacement is not finite");
    hand_script_destroy(s);
}

static void hands_are_limited_in_number_and_have_valid_names(void **state)
{
    (void)state;
    hand_script *s = create();
    char name[HAND_NAME_MAX + 2];
    refuse(s, "", grab(0.0), "is not a valid name of a hand");
    memset(name, 'a', sizeof name);
    name[HAND_NAME_MAX + 1] = 0;
    refuse(s, name, grab(0.0), "is not a valid name of a hand");
    name[HAND_NAME_MAX] = 0;
    add(s, name, grab(0.0));
    for (int i = 1; i < SOFTBODY_HANDS_MAX; i++) {
        snprintf(name, sizeof name, "hand%d", i);
        add(s, name, grab(0.0));
    }
    refuse(s, "another", grab(0.0), "too many hands");
    add(s, "hand3", release(0.0));
    add(s, "hand3", grab(0.0));
    assert_int_equal(s->track_count, SOFTBODY_HANDS_MAX);
    hand_script_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_script_ends_at_time_0),
        cmocka_unit_test(keys_are_kept_per_hand_in_the_order_added),
        cmocka_unit_test(impossible_key_sequences_are_refused),
        cmocka_unit_test(invalid_numbers_are_refused),
        cmocka_unit_test(hands_are_limited_in_number_and_have_valid_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
