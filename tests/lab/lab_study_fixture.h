/* A laboratory with a tiny study, for tests of web/session/studies.h and of results. Include cmocka.h and the
 * headers it requires first. */
#pragma once

#include "lab_fixture.h"

#define TINY(repetitions)                                                                             \
    "study: tiny\ntitle: A tiny one\nscene: scene.yaml\nset: {render.width: 16, render.height: 12}\n" \
    "grid:\n  - {render.depth: [0, 1, 2]}\n  - {render.threads: [1, 2]}\nrepetitions: " repetitions "\nwarmups: 1\n"
enum { TINY_CELLS = 6 };
#define ENDLESS TINY("100000")

static inline int set_up(void **state)
{
    lab_room *room = calloc(1, sizeof *room);
    room_open(room, BALL_SCENE);
    *state = room;
    return 0;
}

static inline int tear_down(void **state)
{
    room_close(*state);
    free(*state);
    return 0;
}

static inline void make_folder(const lab_room *room, const char *name)
{
    char *path = room_path(room, name);
    assert_int_equal(mkdir(path, 0777), 0);
    free(path);
}

static inline char *read_text(const lab_room *room, const char *name)
{
    char *path = room_path(room, name), *text = NULL;
    size_t size;
    assert_int_equal(file_read(path, 64 << 20, &text, &size, NULL), STATUS_OK);
    free(path);
    return text;
}

static inline json_int_t number_at(const json_t *from, const char *key)
{
    const json_t *value = json_object_get(from, key);
    assert_true(json_is_integer(value));
    return json_integer_value(value);
}

static inline json_int_t rows_so_far(const lab_room *room)
{
    json_t *json = room_get(room, "/api/studies/tiny/rows?from=1000000");
    const json_int_t count = number_at(json, "count");
    assert_int_equal(json_array_size(json_object_get(json, "rows")), 0);
    json_decref(json);
    return count;
}

static inline void wait_for_rows(const lab_room *room, json_int_t count)
{
    while (rows_so_far(room) < count)
        ;
}

/* Waits for the study's end; returns its state. */
static inline json_t *wait_for_end(const lab_room *room)
{
    for (;;) {
        json_t *state = room_get(room, "/api/state"), *now = json_incref(json_object_get(state, "study"));
        json_decref(state);
        if (json_is_false(json_object_get(now, "running")))
            return now;
        json_decref(now);
    }
}

static inline void run_to_the_end(const lab_room *room)
{
    json_decref(room_ask(room, "POST", "/api/studies/tiny/run", "{}", 200));
    json_t *ended = wait_for_end(room);
    assert_true(json_is_null(json_object_get(ended, "error")));
    json_decref(ended);
}
