/* Tests of the live slime through the API: it plays, is grabbed in the image, dragged and released.
 * tests/lab/test_lab_live.c tests the motion. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "lab_fixture.h"

/* Seen from the front, in the centre of the image; the simulation up to its time_s takes many steps. */
#define TOY_SCENE                                                                                                 \
    "render: {width: 64, height: 48, depth: 2}\ncamera: {position: [0, 0, -6], target: [0, 0, 0]}\nbackground: "  \
    "{color: [0.5, 0.7, 0.9]}\n"                                                                                  \
    "lights:\n  lamp: {position: [4, 7, -5]}\n"                                                                   \
    "meshes:\n  toy: {generate: slime, level: 3, position: [0, 0, 0], ground_y: -1, damping: 0.3, dt_s: 0.0005, " \
    "time_s: 1}\n"                                                                                                \
    "solids:\n  ground: {shape: plane, position: [0, -1, 0], diffuse: 0.7}\n  body: {shape: mesh, mesh: toy, "    \
    "diffuse: 0.8, priority: 1}\n"

static json_t *state_of(const lab_room *room)
{
    json_t *state = room_get(room, "/api/state"), *slime = json_incref(json_object_get(state, "slime"));
    json_decref(state);
    return slime;
}

static double json(const lab_room *room, const char *key)
{
    json_t *slime = state_of(room);
    assert_true(json_is_number(json_object_get(slime, key)));
    const double value = json_number_value(json_object_get(slime, key));
    json_decref(slime);
    return value;
}

static bool is(const lab_room *room, const char *key)
{
    json_t *slime = state_of(room);
    assert_true(json_is_boolean(json_object_get(slime, key)));
    const bool value = json_is_true(json_object_get(slime, key));
    json_decref(slime);
    return value;
}

static void send_command(const lab_room *room, const char *text)
{
    json_decref(room_ask(room, "POST", "/api/slime", text, 200));
}

static void refused(const lab_room *room, const char *target, const char *text, int code)
{
    free(room_refused(room, "POST", target, text, code));
}

static void wait_for_time(const lab_room *room, double time_s)
{
    while (json(room, "time_s") < time_s)
        assert_true(is(room, "playing"));
}

static int grab(const lab_room *room, double x, double y, double where[3])
{
    char *text = text_format("{\"x\": %g, \"y\": %g, \"reach\": 0.4}", x, y);
    json_t *got = room_ask(room, "POST", "/api/slime/grab", text, 200);
    for (size_t i = 0; i < 3; i++)
        where[i] = json_number_value(json_array_get(json_object_get(got, "where"), i));
    const int hand = (int)json_integer_value(json_object_get(got, "hand"));
    json_decref(got);
    free(text);
    return hand;
}

static void switching_off_shows_the_slime_at_the_scenes_time(void **state)
{
    (void)state;
    lab_room room;
    room_open(&room, TOY_SCENE);
    char *before = room_film(&room);
    assert_false(is(&room, "on"));
    refused(&room, "/api/slime/grab", "{\"x\": 32, \"y\": 24}", 409);
    send_command(&room, "{\"do\": \"play\", \"preview\": \"zbuffer\"}");
    wait_for_time(&room, 0.05);
    send_command(&room, "{\"do\": \"pause\"}");
    char *paused = room_film(&room);
    assert_string_not_equal(paused, before);
    send_command(&room, "{\"do\": \"off\"}");
    while (is(&room, "on"))
        ;
    char *after = room_film(&room);
    for (int i = 0; i < 1000 && strcmp(after, before) != 0; i++) { /* the command may still be pending */
        free(after);
        after = room_film(&room);
    }
    assert_string_equal(after, before);
    free(before);
    free(paused);
    free(after);
    room_close(&room);
}

static void a_hand_drags_the_slime_through_the_image(void **state)
{
    (void)state;
    lab_room room;
    room_open(&room, TOY_SCENE);
    free(room_film(&room)); /* the state has a slime after the scene was loaded */
    send_command(&room, "{\"do\": \"play\"}");
    wait_for_time(&room, 0.1);
    refused(&room, "/api/slime/grab", "{\"x\": 1, \"y\": 1}", 404);
    double where[3];
    const int hand = grab(&room, 32, 24, where);
    assert_true(hand > 0 && json(&room, "held") > 0);
    assert_true(fabs(where[0]) < 1e-6 && where[2] < -0.8 && where[2] > -1.2); /* the grab point is on its front */
    const double then_s = json(&room, "time_s");
    char *move = text_format("{\"hand\": %d, \"x\": 10, \"y\": 24, \"depth\": -0.5}", hand);
    json_decref(room_ask(&room, "POST", "/api/slime/move", move, 200));
    wait_for_time(&room, then_s + 0.4);
    /* The slime is on now. */
    json_t *there = room_ask(&room, "POST", "/api/slime/grab", "{\"x\": 10, \"y\": 24, \"reach\": 0.01}", 200);
    json_decref(there);
    char *let_go = text_format("{\"hand\": %d}", hand);
    json_decref(room_ask(&room, "POST", "/api/slime/release", let_go, 200));
    refused(&room, "/api/slime/move", move, 409);
    refused(&room, "/api/slime/release", let_go, 409);
    json_decref(room_ask(&room, "POST", "/api/slime/release", "{}", 200));
    while (json(&room, "held") > 0)
        ;
    room_post(&room, "/api/set", "{\"set\": {\"body.color\": [1, 0, 0]}}");
    assert_true(json(&room, "time_s") > then_s);
    free(move);
    free(let_go);
    room_close(&room);
}

static void invalid_requests_are_refused(void **state)
{
    (void)state;
    lab_room room;
    room_open(&room, TOY_SCENE);
    free(room_film(&room)); /* the slime is known after the first image */
    static const char *const bodies[] = {"[]", "{}", "{\"do\": \"jump\"}", "{\"do\": 3}",
                                         "{\"do\": \"play\", \"preview\": \"fast\"}"};
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++)
        refused(&room, "/api/slime", bodies[i], 400);
    assert_false(is(&room, "on"));
    send_command(&room, "{\"do\": \"play\"}");
    static const char *const grabs[] = {"{\"x\": 1}", "{\"x\": 1e9, \"y\": 2}", "{\"x\": 32, \"y\": 24, \"reach\": -1}",
                                        "{\"x\": \"a\", \"y\": 2}"};
    for (size_t i = 0; i < sizeof grabs / sizeof *grabs; i++)
        refused(&room, "/api/slime/grab", grabs[i], 400);
    static const char *const moves[] = {"{\"x\": 1, \"y\": 2}", "{\"hand\": 1.5, \"x\": 1, \"y\": 2}",
                                        "{\"hand\": 1e30, \"x\": 1, \"y\": 2}"};
    for (size_t i = 0; i < sizeof moves / sizeof *moves; i++)
        refused(&room, "/api/slime/move", moves[i], 400);
    refused(&room, "/api/slime/move", "{\"hand\": 77, \"x\": 1, \"y\": 2}", 409);
    room_close(&room);
    room_open(&room, BALL_SCENE);
    refused(&room, "/api/slime", "{\"do\": \"play\"}", 409);
    json_t *nothing = state_of(&room);
    assert_true(json_is_null(nothing));
    json_decref(nothing);
    room_close(&room);
}

static void pages_receive_events_while_the_slime_moves(void **state)
{
    (void)state;
    enum { ROOM = 1 << 20 };
    lab_room room;
    room_open(&room, TOY_SCENE);
    const int fd = client_connect(http_port(room.server));
    char *request = text_format("GET /api/events HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nAuthorization: Bearer %s\r\n\r\n",
                                http_port(room.server), http_token(room.server));
    client_send(fd, request, strlen(request));
    send_command(&room, "{\"do\": \"play\"}");
    char *heard = calloc(ROOM, 1);
    size_t size = 0;
    while (!strstr(heard, "event: slime")) {
        const ssize_t got = recv(fd, heard + size, ROOM - 1 - size, 0);
        assert_true(got > 0);
        size += (size_t)got;
    }
    close(fd);
    free(heard);
    free(request);
    room_close(&room);
}

/* A grab during the shutdown gets a reply or is cut off; no thread waits forever. */
static void the_laboratory_stops_while_a_hand_holds_the_slime(void **state)
{
    (void)state;
    lab_room room;
    room_open(&room, TOY_SCENE);
    free(room_film(&room)); /* the state has a slime after the scene was loaded */
    send_command(&room, "{\"do\": \"play\"}");
    double where[3];
    assert_true(grab(&room, 32, 24, where) > 0);
    room_close(&room);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(switching_off_shows_the_slime_at_the_scenes_time),
        cmocka_unit_test(a_hand_drags_the_slime_through_the_image),
        cmocka_unit_test(invalid_requests_are_refused),
        cmocka_unit_test(pages_receive_events_while_the_slime_moves),
        cmocka_unit_test(the_laboratory_stops_while_a_hand_holds_the_slime),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
