/* Tests of the comparison with the reference image: numbers and map equal those of image/compare.h, the list of
 * changed parameters, and refused requests. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "image/compare.h"
#include "lab_fixture.h"
#include "render_fixture.h"
#include <pthread.h>

static int open_ball(void **state)
{
    lab_room *room = calloc(1, sizeof *room);
    room_open(room, BALL_SCENE);
    *state = room;
    return 0;
}

static int close_room(void **state)
{
    room_close(*state);
    free(*state);
    return 0;
}

static void change(const lab_room *room, const char *values)
{
    char *body = text_format("{\"set\": {%s}}", values);
    room_post(room, "/api/set", body);
    free(body);
}

static void pin(const lab_room *room)
{
    json_t *json = room_ask(room, "POST", "/api/reference?wait=1", "{}", 200);
    assert_true(json_is_object(json_object_get(json, "reference")));
    json_decref(json);
}

static double number(const json_t *of, const char *key)
{
    const json_t *value = json_object_get(of, key);
    if (!json_is_number(value))
        fail_msg("%s is not a number", key);
    return json_number_value(value);
}

static image *image_of(const char *assignments)
{
    scene *s = scene_from(BALL_SCENE);
    image *held_image = NULL;
    set_all(s, assignments);
    render_result *result = render(s);
    assert_int_equal(film_image(result->img, &held_image, NULL), STATUS_OK);
    render_result_destroy(result);
    scene_destroy(s);
    return held_image;
}

static void refused(const lab_room *room, const char *method, const char *target, int code, const char *words)
{
    char *json = room_refused(room, method, target, strcmp(method, "GET") == 0 ? NULL : "{}", code);
    if (!strstr(json, words))
        fail_msg("%s: '%s' does not contain '%s'", target, json, words);
    free(json);
}

static image *decoded(const lab_room *room, const char *target)
{
    size_t size;
    unsigned char *bytes = room_bytes(room, target, "image/png", &size);
    char *path = room_path(room, "reply.png");
    FILE *out = fopen(path, "wb");
    assert_int_equal(fwrite(bytes, 1, size, out), size);
    assert_int_equal(fclose(out), 0);
    image *held_image = NULL;
    diagnostic why = {.line = 0};
    worked(image_read(path, &held_image, NULL, &why), &why);
    free(path);
    free(bytes);
    return held_image;
}

static void comparing_requires_a_reference_image(void **state)
{
    free(room_film(*state));
    refused(*state, "GET", "/api/compare", 409, "no reference image is pinned");
    refused(*state, "GET", "/api/compare?wait=1", 409, "POST /api/reference");
    refused(*state, "GET", "/api/compare.png", 409, "no reference image is pinned");
    refused(*state, "GET", "/api/reference.png", 404, "no reference image is pinned");
    json_t *json = room_get(*state, "/api/state");
    assert_true(json_is_null(json_object_get(json, "reference")));
    json_decref(json);
    json_decref(room_ask(*state, "DELETE", "/api/reference", "{}", 200));
}

static void equal_images_have_no_difference(void **state)
{
    pin(*state);
    json_t *json = room_get(*state, "/api/compare?wait=1"), *c = json_object_get(json, "comparison");
    assert_true(json_is_null(json_object_get(c, "psnr_db")));
    assert_true(json_is_null(json_object_get(c, "largest_at")));
    assert_true(number(c, "mse") == 0.0 && number(c, "flip") == 0.0 && number(c, "largest") == 0.0 &&
                number(c, "differing_fraction") == 0.0);
    assert_true(number(c, "ssim") == 1.0);
    assert_int_equal(json_array_size(json_object_get(json, "changed")), 0);
    assert_true(json_equal(json_object_get(json, "a"), json_object_get(json, "b")));
    json_decref(json);
}

static void check_numbers(const json_t *c, const image_comparison *found)
{
    assert_true(number(c, "mse") == found->mse);
    assert_true(number(c, "psnr_db") == found->psnr_db);
    assert_true(number(c, "ssim") == found->ssim);
    assert_true(number(c, "flip") == found->flip);
    assert_true(number(c, "largest") == found->largest);
    assert_true(number(c, "differing_fraction") == found->differing_fraction);
    const json_t *place = json_object_get(c, "largest_at");
    assert_int_equal(json_integer_value(json_array_get(place, 0)), found->largest_x);
    assert_int_equal(json_integer_value(json_array_get(place, 1)), found->largest_y);
}

static void check_map(const lab_room *room, const image *a, const image *b)
{
    image *map = NULL;
    unsigned char *bytes = NULL;
    size_t size, there_size;
    assert_int_equal(image_compare_map(a, b, &map, NULL), STATUS_OK);
    assert_int_equal(image_encode(map, IMAGE_PNG, 8, true, &bytes, &size, NULL), STATUS_OK);
    unsigned char *there = room_bytes(room, "/api/compare.png?wait=1", "image/png", &there_size);
    assert_int_equal(there_size, size);
    assert_memory_equal(there, bytes, size);
    free(there);
    free(bytes);
    image_destroy(map);
}

static void numbers_and_map_equal_those_of_image_compare(void **state)
{
    pin(*state);
    change(*state, "\"ball.ior\": 1.7");
    json_t *json = room_get(*state, "/api/compare?wait=1");
    image *a = image_of(""), *b = image_of("ball.ior=1.7");
    image_comparison found;
    assert_int_equal(image_compare(a, b, &found, NULL), STATUS_OK);
    assert_true(found.largest > 0.05);
    check_numbers(json_object_get(json, "comparison"), &found);
    check_map(*state, a, b);
    assert_string_not_equal(json_string_value(json_object_get(json_object_get(json, "a"), "film_hash")),
                            json_string_value(json_object_get(json_object_get(json, "b"), "film_hash")));
    assert_true(number(json_object_get(json, "a"), "rays") > 64 * 48);
    assert_true(number(json_object_get(json, "b"), "generation") > number(json_object_get(json, "a"), "generation"));
    json_decref(json);
    change(*state, "\"ball.ior\": 1.2");
    json = room_get(*state, "/api/compare?wait=1");
    image *c = image_of("ball.ior=1.2");
    assert_int_equal(image_compare(a, c, &found, NULL), STATUS_OK);
    check_numbers(json_object_get(json, "comparison"), &found);
    check_map(*state, a, c);
    image_destroy(a);
    image_destroy(b);
    image_destroy(c);
    json_decref(json);
}

typedef enum shown { SHOWN_OTHER, SHOWN_COARSE, SHOWN_FINAL } shown;

/* Waits for an image of that generation and returns its state. */
static shown shown_of(const lab_room *room, json_int_t generation)
{
    json_t *json = room_get(room, "/api/state"), *newest = json_object_get(json, "image");
    const bool its = json_integer_value(json_object_get(newest, "generation")) == generation,
               final = json_is_true(json_object_get(newest, "final"));
    json_decref(json);
    return !its ? SHOWN_OTHER : final ? SHOWN_FINAL : SHOWN_COARSE;
}

static void an_unfinished_image_is_not_compared(void **state)
{
    pin(*state);
    const json_int_t heavy = room_post(
        *state, "/api/set", "{\"set\": {\"render.width\": 2400, \"render.height\": 1800, \"render.samples\": 64}}");
    while (shown_of(*state, heavy) == SHOWN_OTHER)
        usleep(1000);
    refused(*state, "GET", "/api/compare", 409, "not finished yet");
    refused(*state, "POST", "/api/reference", 409, "?wait=1");
    assert_int_equal(shown_of(*state, heavy), SHOWN_COARSE);
    room_post(*state, "/api/undo", "{}");
    json_t *json = room_get(*state, "/api/compare?wait=1");
    assert_true(number(json_object_get(json, "b"), "generation") > (double)heavy);
    json_decref(json);
}

static void the_reference_image_is_kept_across_changes(void **state)
{
    pin(*state);
    change(*state, "\"render.width\": 32");
    free(room_film(*state));
    image *a = image_of(""), *fine = decoded(*state, "/api/reference.png?bits=16"),
          *plain = decoded(*state, "/api/reference.png");
    image_comparison found;
    assert_int_equal(image_compare(a, fine, &found, NULL), STATUS_OK);
    assert_true(found.largest <= 0.51 / 65535);
    assert_int_equal(image_compare(a, plain, &found, NULL), STATUS_OK);
    assert_true(found.largest <= 0.51 / 255 && found.largest > 0.51 / 65535);
    refused(*state, "GET", "/api/reference.png?bits=9", 400, "?bits=16");
    image_destroy(a);
    image_destroy(fine);
    image_destroy(plain);
}

static void expect_change(const json_t *list, size_t at, const char *path, const char *a, const char *b)
{
    json_t *expected = json_pack("{s:s, s:o, s:o}", "path", path, "a", json_loads(a, JSON_DECODE_ANY, NULL), "b",
                                 json_loads(b, JSON_DECODE_ANY, NULL));
    char *text = json_dumps(json_array_get(list, at), 0), *expected_text = json_dumps(expected, 0);
    if (!json_equal(json_array_get(list, at), expected))
        fail_msg("found %s, expected %s", text ? text : "nothing", expected_text);
    free(text);
    free(expected_text);
    json_decref(expected);
}

static void changed_parameters_are_listed(void **state)
{
    pin(*state);
    change(*state,
           "\"ball.ior\": 1.7, \"lamp.position\": [1, 2, 3], \"render.threads\": 1, \"background.kind\": \"gradient\"");
    change(*state, "\"ball.radius\": 0.5");
    change(*state, "\"ball.radius\": 1");
    json_t *json = room_get(*state, "/api/compare?wait=1"), *list = json_object_get(json, "changed");
    assert_int_equal(json_array_size(list), 4);
    expect_change(list, 0, "render.threads", "2", "1");
    expect_change(list, 1, "background.kind", "\"uniform\"", "\"gradient\"");
    expect_change(list, 2, "lamp.position", "[4.0, 7.0, -5.0]", "[1.0, 2.0, 3.0]");
    expect_change(list, 3, "ball.ior", "1.5", "1.7");
    json_decref(json);
}

/* A solid that inherits its material's colour is not listed; a solid with a new material is. */
static void a_material_is_listed_once(void **state)
{
    pin(*state);
    change(*state, "\"tiles.color\": [0.1, 0.2, 0.3]");
    json_t *json = room_get(*state, "/api/compare?wait=1");
    assert_int_equal(json_array_size(json_object_get(json, "changed")), 1);
    expect_change(json_object_get(json, "changed"), 0, "tiles.color", "[0.8, 0.8, 0.8]", "[0.1, 0.2, 0.3]");
    json_decref(json);
    change(*state, "\"ground.color\": [0.5, 0.5, 0.5]");
    json = room_get(*state, "/api/compare?wait=1");
    assert_int_equal(json_array_size(json_object_get(json, "changed")), 2);
    expect_change(json_object_get(json, "changed"), 1, "ground.color", "[0.8, 0.8, 0.8]", "[0.5, 0.5, 0.5]");
    json_decref(json);
}

static const json_t *entry(const json_t *list, const char *path)
{
    const json_t *one;
    size_t i;
    json_array_foreach(list, i, one) if (strcmp(json_string_value(json_object_get(one, "path")), path) == 0) return one;
    fail_msg("%s is not in the list of changes", path);
    return NULL;
}

static void added_and_removed_objects_have_one_side(void **state)
{
    pin(*state);
    json_decref(room_ask(*state, "DELETE", "/api/objects/ball", "{}", 200));
    json_decref(room_ask(*state, "POST", "/api/objects", "{\"kind\": \"light\", \"name\": \"sun\"}", 200));
    json_t *json = room_get(*state, "/api/compare?wait=1"), *list = json_object_get(json, "changed");
    assert_true(json_is_null(json_object_get(entry(list, "ball.radius"), "b")));
    assert_true(number(entry(list, "ball.radius"), "a") == 1.0);
    assert_true(json_is_null(json_object_get(entry(list, "sun.intensity"), "a")));
    assert_true(json_is_number(json_object_get(entry(list, "sun.intensity"), "b")));
    json_decref(json);
}

static void images_of_different_sizes_have_no_comparison(void **state)
{
    pin(*state);
    change(*state, "\"render.width\": 32");
    json_t *json = room_get(*state, "/api/compare?wait=1");
    assert_true(json_is_null(json_object_get(json, "comparison")));
    assert_true(number(json_object_get(json, "a"), "width") == 64 && number(json_object_get(json, "b"), "width") == 32);
    assert_int_equal(json_array_size(json_object_get(json, "changed")), 1);
    refused(*state, "GET", "/api/compare.png", 409, "");
    json_decref(json);
}

static void a_cleared_reference_image_is_removed(void **state)
{
    pin(*state);
    json_t *json = room_get(*state, "/api/state");
    assert_true(number(json_object_get(json, "reference"), "width") == 64);
    json_decref(json);
    json = room_ask(*state, "DELETE", "/api/reference", "{}", 200);
    assert_true(json_is_null(json_object_get(json, "reference")));
    json_decref(json);
    refused(*state, "GET", "/api/compare", 409, "no reference image is pinned");
    json = room_get(*state, "/api/state");
    assert_true(json_is_null(json_object_get(json, "reference")));
    json_decref(json);
}

typedef struct client {
    const lab_room *room;
    pthread_t thread;
    char *text;
    int rounds, code;
} client;

static void *ask(void *context)
{
    client *a = context;
    char *reply = client_ask(a->room->server, "GET", "/api/compare?wait=1", "", NULL);
    a->code = reply_code(reply);
    a->text = strdup(reply_body(reply));
    free(reply);
    return NULL;
}

static void concurrent_comparisons_return_the_same_result(void **state)
{
    client clients[10];
    pin(*state);
    change(*state, "\"ball.ior\": 1.3");
    for (size_t i = 0; i < 10; i++) {
        clients[i] = (client){.room = *state};
        assert_int_equal(pthread_create(&clients[i].thread, NULL, ask, &clients[i]), 0);
    }
    for (size_t i = 0; i < 10; i++)
        pthread_join(clients[i].thread, NULL);
    assert_non_null(strstr(clients[0].text, "\"comparison\":{"));
    for (size_t i = 0; i < 10; i++) {
        assert_int_equal(clients[i].code, 200);
        assert_string_equal(clients[i].text, clients[0].text);
    }
    for (size_t i = 0; i < 10; i++)
        free(clients[i].text);
}

static void *ask_often(void *context)
{
    static const char *const targets[] = {"/api/compare", "/api/compare.png", "/api/reference.png",
                                          "/api/compare?wait=1", "/api/trace?x=30&y=20"};
    client *a = context;
    for (int k = 0; k < a->rounds; k++) {
        char *reply = client_ask(a->room->server, "GET", targets[k % 5], "", NULL);
        a->code = reply_code(reply);
        free(reply);
        if (a->code != 200 && a->code != 404 && a->code != 409)
            break;
    }
    return NULL;
}

/* Reference images are replaced while other threads compare. */
static void reference_images_may_change_during_comparisons(void **state)
{
    client clients[6];
    for (size_t i = 0; i < 6; i++) {
        clients[i] = (client){.room = *state, .rounds = 25};
        assert_int_equal(pthread_create(&clients[i].thread, NULL, ask_often, &clients[i]), 0);
    }
    for (int k = 0; k < 8; k++) {
        char *values = text_format("\"ball.ior\": %g", 1.2 + 0.05 * k);
        pin(*state);
        change(*state, values);
        free(values);
        if (k % 3 == 2)
            json_decref(room_ask(*state, "DELETE", "/api/reference", "{}", 200));
    }
    for (size_t i = 0; i < 6; i++)
        pthread_join(clients[i].thread, NULL);
    for (size_t i = 0; i < 6; i++)
        assert_true(clients[i].code == 200 || clients[i].code == 404 || clients[i].code == 409);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(comparing_requires_a_reference_image, open_ball, close_room),
        cmocka_unit_test_setup_teardown(equal_images_have_no_difference, open_ball, close_room),
        cmocka_unit_test_setup_teardown(numbers_and_map_equal_those_of_image_compare, open_ball, close_room),
        cmocka_unit_test_setup_teardown(an_unfinished_image_is_not_compared, open_ball, close_room),
        cmocka_unit_test_setup_teardown(the_reference_image_is_kept_across_changes, open_ball, close_room),
        cmocka_unit_test_setup_teardown(changed_parameters_are_listed, open_ball, close_room),
        cmocka_unit_test_setup_teardown(a_material_is_listed_once, open_ball, close_room),
        cmocka_unit_test_setup_teardown(added_and_removed_objects_have_one_side, open_ball, close_room),
        cmocka_unit_test_setup_teardown(images_of_different_sizes_have_no_comparison, open_ball, close_room),
        cmocka_unit_test_setup_teardown(a_cleared_reference_image_is_removed, open_ball, close_room),
        cmocka_unit_test_setup_teardown(concurrent_comparisons_return_the_same_result, open_ball, close_room),
        cmocka_unit_test_setup_teardown(reference_images_may_change_during_comparisons, open_ball, close_room),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
