/* GET /api/scene?since=GENERATION: what differs, applied to the earlier reply, gives the whole scene. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "lab_fixture.h"
#include "web/api/api.h"

static lab_room room;

static int open_room(void **state)
{
    (void)state;
    room_open(&room, BALL_SCENE);
    return 0;
}

static int close_room(void **state)
{
    (void)state;
    room_close(&room);
    return 0;
}

static json_int_t generation_of(const json_t *whole)
{
    return json_integer_value(json_object_get(whole, "generation"));
}

static json_t *since(json_int_t generation)
{
    char *target = text_format("/api/scene?since=%lld", (long long)generation);
    json_t *reply = room_get(&room, target);
    free(target);
    return reply;
}

/* The row of that path, or NULL. */
static json_t *row_of(const json_t *params, const char *path)
{
    size_t i;
    json_t *row;
    json_array_foreach((json_t *)(uintptr_t)params, i, row)
    {
        if (strcmp(json_string_value(json_object_get(row, "path")), path) == 0)
            return row;
    }
    return NULL;
}

/* As README.md of src/web defines it: the order of the paths is that of `order`, or the earlier one. */
static json_t *applied(const json_t *before, const json_t *delta)
{
    json_t *made = json_copy((json_t *)(uintptr_t)before), *rows = json_array(), *value;
    const json_t *order = json_object_get(delta, "order"), *old = json_object_get(before, "params"),
                 *new = json_object_get(delta, "params");
    const char *key;
    json_object_foreach((json_t *)(uintptr_t)delta, key, value) json_object_set(made, key, value);
    json_object_del(made, "since");
    json_object_del(made, "order");
    for (size_t i = 0; i < json_array_size(order ? order : old); i++) {
        const json_t *item = json_array_get(order ? order : old, i);
        const char *path = json_string_value(order ? item : json_object_get(item, "path"));
        json_t *row = row_of(new, path);
        json_array_append(rows, row ? row : row_of(old, path));
    }
    json_object_set_new(made, "params", rows);
    return made;
}

static void what_differs_completes_an_earlier_scene(void **state)
{
    (void)state;
    static const struct {
        const char *target, *body;
        size_t most_rows; /* 0: not checked */
        bool order;
    } changes[] = {
        {"/api/set", "{\"set\": {\"ball.ior\": 1.7}}", 1, false},
        {"/api/camera", "{\"orbit\": [10, 5]}", 2, false},
        {"/api/objects", "{\"kind\": \"solid\", \"shape\": \"cup\"}", 0, true},
        {"/api/objects/ball", NULL, 0, true},
        {"/api/undo", "{}", 0, true},
        {"/api/objects/ball/rename", "{\"to\": \"pearl\"}", 0, true},
        {"/api/open", "{\"new\": true}", 0, true},
    };
    json_t *first = room_get(&room, "/api/scene"), *last = json_incref(first);
    assert_null(json_object_get(first, "since"));
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        const char *method = changes[i].body ? "POST" : "DELETE";
        json_decref(room_ask(&room, method, changes[i].target, changes[i].body ? changes[i].body : "{}", 200));
        json_t *whole = room_get(&room, "/api/scene");
        for (int which = 0; which < 2; which++) {
            const json_t *before = which ? first : last;
            json_t *delta = since(generation_of(before)), *made = applied(before, delta);
            assert_int_equal(json_integer_value(json_object_get(delta, "since")), generation_of(before));
            if (!json_equal(made, whole))
                fail_msg("%s %s: what differs does not complete the scene", method, changes[i].target);
            const size_t rows = json_array_size(json_object_get(delta, "params"));
            if (!which && changes[i].most_rows)
                assert_in_range(rows, 1, changes[i].most_rows);
            if (!which)
                assert_int_equal(json_object_get(delta, "order") != NULL, changes[i].order);
            json_decref(delta);
            json_decref(made);
        }
        json_decref(last);
        last = whole;
    }
    json_decref(first);
    json_decref(last);
}

static void an_unknown_generation_gets_the_whole_scene(void **state)
{
    (void)state;
    json_t *whole = room_get(&room, "/api/scene"), *reply = since(999999);
    assert_true(json_equal(whole, reply));
    json_decref(reply);
    reply = since(generation_of(whole));
    assert_int_equal(json_array_size(json_object_get(reply, "params")), 0);
    assert_null(json_object_get(reply, "objects"));
    json_decref(reply);
    json_decref(whole);
    static const char *const wrong[] = {"x", "", "-3", "1x"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char *target = text_format("/api/scene?since=%s", wrong[i]);
        free(room_refused(&room, "GET", target, NULL, 400));
        free(target);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(what_differs_completes_an_earlier_scene, open_room, close_room),
        cmocka_unit_test_setup_teardown(an_unknown_generation_gets_the_whole_scene, open_room, close_room),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
