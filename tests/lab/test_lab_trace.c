/* Tests of traces through the API: identical to the output of `cuvette trace` of the same scene, byte for byte, and
 * refused requests. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "lab_fixture.h"
#include "render_fixture.h"
#include "report/trace_writers.h"
#include <pthread.h>

/* Ten panes of glass: the number of a ray's descendants doubles with the depth. */
static char *panes(int depth)
{
    char *text = text_format(
        "render: {width: 16, height: 12, depth: %d}\ncamera: {position: [0, 0.3, -6], target: [0, 0, 0]}\nsolids:\n",
        depth);
    for (int i = 0; i < 10; i++) {
        char *longer = text_format("%s  pane%d: {shape: box, size: [9, 9, 0.2], position: [0, 0, %g], transparency: 1, "
                                   "ior: 1.5, priority: %d}\n",
                                   text, i, 0.5 * i, i + 1);
        free(text);
        text = longer;
    }
    return text;
}

static char *rod_text(void)
{
    char *text;
    size_t size;
    diagnostic why = {.line = 0};
    worked(file_read(ROD_SCENE, 1 << 20, &text, &size, &why), &why);
    return text;
}

static int open_rod(void **state)
{
    static lab_room room;
    char *text = rod_text();
    room_open(&room, text);
    free(text);
    room_post(&room, "/api/set", "{\"set\": {\"render.width\": 80, \"render.height\": 60}}");
    *state = &room;
    return 0;
}

static int close_room(void **state)
{
    room_close(*state);
    return 0;
}

static char *ask_at(const lab_room *room, const char *kind, int x, int y)
{
    char *target = text_format("/api/trace%s?x=%d&y=%d", kind, x, y);
    char *reply = client_ask(room->server, "GET", target, "", NULL);
    assert_int_equal(reply_code(reply), 200);
    char *text = strdup(reply_body(reply));
    free(reply);
    free(target);
    return text;
}

typedef status trace_writer(const traced *t, FILE *out, diagnostic *why);

static char *written(scene *s, trace_writer *write, const char *name, int x, int y)
{
    probe *p = NULL;
    ray_tree tree = {0};
    char *text = NULL;
    size_t size;
    diagnostic why = {.line = 0};
    worked(scene_load(s, &why), &why);
    worked(probe_create(s, isa_best(), &p, &why), &why);
    worked(probe_pixel(p, x, y, &tree, &why), &why);
    FILE *out = open_memstream(&text, &size);
    worked(write(&(traced){s, p, &tree, name, true}, out, &why), &why);
    assert_int_equal(fclose(out), 0);
    ray_tree_release(&tree);
    probe_destroy(p);
    return text;
}

static void compare_at(const lab_room *room, scene *s, int x, int y)
{
    static const struct {
        const char *kind;
        trace_writer *write;
    } kinds[] = {{"", trace_write_json}, {".txt", trace_write_text}, {".svg", trace_write_drawing}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        char *there = ask_at(room, kinds[i].kind, x, y), *here = written(s, kinds[i].write, "scene.yaml", x, y);
        assert_string_equal(there, here);
        free(there);
        free(here);
    }
}

static void a_trace_equals_the_commands_output(void **state)
{
    scene *s = rod_scene("render.width=80 render.height=60");
    for (int y = 5; y < 60; y += 18)
        for (int x = 0; x < 80; x += 13)
            compare_at(*state, s, x, y);
    compare_at(*state, s, 79, 59);
    scene_destroy(s);
}

static void a_trace_uses_the_current_scene(void **state)
{
    char *before = ask_at(*state, "", 40, 40);
    room_post(*state, "/api/set", "{\"set\": {\"liquid.ior\": 1.5, \"render.samples\": 4}}");
    char *after = ask_at(*state, "", 40, 40);
    assert_string_not_equal(before, after);
    assert_non_null(strstr(after, "\"roots\":"));
    scene *s = rod_scene("render.width=80 render.height=60 liquid.ior=1.5 render.samples=4");
    compare_at(*state, s, 40, 40);
    scene_destroy(s);
    room_post(*state, "/api/undo", "{}");
    char *again = ask_at(*state, "", 40, 40);
    assert_string_equal(before, again);
    free(before);
    free(after);
    free(again);
}

static void a_trace_has_the_radiance_of_the_displayed_pixel(void **state)
{
    free(room_film(*state));
    json_t *trace = room_get(*state, "/api/trace?x=41&y=37");
    scene *s = rod_scene("render.width=80 render.height=60");
    render_result *result = render(s);
    for (int c = 0; c < 3; c++)
        assert_true(json_number_value(json_array_get(json_object_get(trace, "radiance"), (size_t)c)) ==
                    film_value(result->img, 41, 37, c));
    render_result_destroy(result);
    scene_destroy(s);
    json_decref(trace);
}

static void refused(const lab_room *room, const char *target, const char *words)
{
    char *json = room_refused(room, "GET", target, NULL, 400);
    if (!strstr(json, words))
        fail_msg("%s: '%s' does not contain '%s'", target, json, words);
    free(json);
}

static void invalid_pixels_are_refused(void **state)
{
    refused(*state, "/api/trace?x=80&y=0", "pixel 80,0 is outside the image of 80 x 60");
    refused(*state, "/api/trace?x=0&y=60", "outside");
    refused(*state, "/api/trace?x=-1&y=0", "outside");
    refused(*state, "/api/trace.svg?x=0&y=-1", "outside");
    refused(*state, "/api/trace.txt?x=4000&y=1", "outside");
    refused(*state, "/api/trace?x=1", "y is missing");
    refused(*state, "/api/trace", "x is missing");
    refused(*state, "/api/trace?x=1.5&y=1", "x is not an integer: '1.5'");
    refused(*state, "/api/trace?x=1&y=", "y is not an integer");
    refused(*state, "/api/trace?x=99999999999&y=1", "x is not an integer");
    refused(*state, "/api/trace?x=1&y=99999999999999999999", "y is not an integer");
}

static void large_trees_are_refused(void **state)
{
    (void)state;
    lab_room room;
    char *text = panes(17);
    room_open(&room, text);
    refused(&room, "/api/trace?x=8&y=6",
            "more than the limit of 100000; lower render.depth or render.samples, or raise render.min_weight");
    room_post(&room, "/api/set", "{\"set\": {\"render.depth\": 40}}");
    refused(&room, "/api/trace?x=8&y=6", "more than 2000000 rays; lower render.depth, or raise render.min_weight");
    room_post(&room, "/api/set", "{\"set\": {\"render.depth\": 8}}");
    json_decref(room_get(&room, "/api/trace?x=8&y=6"));
    room_close(&room);
    free(text);
}

typedef struct client {
    const lab_room *room;
    pthread_t thread;
    char *text;
} client;

static void *ask_once(void *context)
{
    client *a = context;
    a->text = ask_at(a->room, "", 40, 40);
    return NULL;
}

static void concurrent_traces_return_the_same_text(void **state)
{
    client clients[10];
    for (size_t i = 0; i < 10; i++) {
        clients[i].room = *state;
        assert_int_equal(pthread_create(&clients[i].thread, NULL, ask_once, &clients[i]), 0);
    }
    for (size_t i = 0; i < 10; i++)
        pthread_join(clients[i].thread, NULL);
    assert_non_null(strstr(clients[0].text, "\"root\":"));
    for (size_t i = 1; i < 10; i++)
        assert_string_equal(clients[i].text, clients[0].text);
    for (size_t i = 0; i < 10; i++)
        free(clients[i].text);
}

/* "scene" is the name under which the scene was last opened or saved. */
static void a_trace_names_the_scenes_file(void **state)
{
    json_decref(room_ask(*state, "POST", "/api/save", "{\"file\": \"saved.yaml\"}", 200));
    json_t *trace = room_get(*state, "/api/trace?x=1&y=1");
    assert_string_equal(json_string_value(json_object_get(trace, "scene")), "saved.yaml");
    json_decref(trace);
    room_post(*state, "/api/open", "{\"new\": true}");
    trace = room_get(*state, "/api/trace?x=1&y=1");
    assert_string_equal(json_string_value(json_object_get(trace, "scene")), "");
    json_decref(trace);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_trace_equals_the_commands_output),
        cmocka_unit_test(a_trace_uses_the_current_scene),
        cmocka_unit_test(a_trace_has_the_radiance_of_the_displayed_pixel),
        cmocka_unit_test(invalid_pixels_are_refused),
        cmocka_unit_test(concurrent_traces_return_the_same_text),
        cmocka_unit_test(large_trees_are_refused),
        cmocka_unit_test(a_trace_names_the_scenes_file),
    };
    return cmocka_run_group_tests(tests, open_rod, close_room);
}
