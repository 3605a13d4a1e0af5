/* Tests of the laboratory's API: the scene document, the camera, the image, and refused clients. Files, traces,
 * comparisons, slimes and studies have their own tests. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "lab_fixture.h"
#include "render_fixture.h"
#include "scene/file/write.h"
#include "scene/model/camera.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

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

static const json_t *row_of(const json_t *json, const char *path)
{
    size_t i;
    const json_t *row;
    json_array_foreach(json_object_get(json, "params"), i, row)
    {
        if (strcmp(json_string_value(json_object_get(row, "path")), path) == 0)
            return row;
    }
    return NULL;
}

static void assert_param(const char *path, const char *key, double expected)
{
    json_t *json = room_get(&room, "/api/scene");
    const json_t *row = row_of(json, path);
    assert_non_null(row);
    assert_true(json_number_value(json_object_get(row, key)) == expected);
    json_decref(json);
}

static const char *found_at(const json_t *reply, size_t match, size_t place)
{
    return json_string_value(json_array_get(json_array_get(json_object_get(reply, "found"), match), place));
}

static void parameters_are_found_by_words(void **state)
{
    (void)state;
    json_t *json = room_get(&room, "/api/params?find=lamp%20brightness");
    assert_int_equal(json_array_size(json_object_get(json, "found")), PARAM_NO_MATCH);
    assert_string_equal(found_at(json, PARAM_IN_PATH, 0), "lamp.intensity");
    assert_null(found_at(json, PARAM_IN_NAME, 0));
    json_decref(json);
    json = room_get(&room, "/api/params?find=ior");
    assert_non_null(strstr(found_at(json, PARAM_IN_NAME, 0), ".ior"));
    json_decref(json);
    char *reply = client_ask(room.server, "GET", "/api/params", "", NULL);
    assert_non_null(strstr(reply, " 400 "));
    free(reply);
}

static void parameters_are_set_as_by_the_option_set(void **state)
{
    (void)state;
    room_post(&room, "/api/set",
              "{\"set\": {\"ball.ior\": 1.6, \"lamp.position\": [1, 2.5, -3], \"render.beyond\": \"black\", "
              "\"render.depth\": 5}}");
    assert_param("ball.ior", "value", 1.6);
    assert_param("ball.ior", "initial", 1.5);
    assert_param("render.depth", "value", 5);
    json_t *json = room_get(&room, "/api/scene");
    assert_true(json_number_value(json_array_get(json_object_get(row_of(json, "lamp.position"), "value"), 1)) == 2.5);
    assert_string_equal(json_string_value(json_object_get(row_of(json, "render.beyond"), "value")), "black");
    json_decref(json);
    room_post(&room, "/api/set", "{\"set\": {\"lamp.position.y\": 9, \"ball.visible\": false}}");
    json = room_get(&room, "/api/scene");
    assert_true(json_number_value(json_array_get(json_object_get(row_of(json, "lamp.position"), "value"), 1)) == 9.0);
    assert_string_equal(json_string_value(json_object_get(row_of(json, "ball.visible"), "value")), "off");
    json_decref(json);
    room_post(&room, "/api/reset", "{\"paths\": [\"ball.ior\"]}");
    assert_param("ball.ior", "value", 1.5);
    assert_param("render.depth", "value", 5);
    room_post(&room, "/api/reset", "{}");
    assert_param("render.depth", "value", 3);
}

/* Sets values and returns the number of notes in the reply; checks place and words of the first note if they are
 * given. */
static size_t notes_on(const char *body, const char *place, const char *words)
{
    json_t *answer = room_ask(&room, "POST", "/api/set", body, 200);
    const json_t *notes = json_object_get(answer, "notes"), *first = json_array_get(notes, 0);
    const size_t n = json_array_size(notes);
    assert_true(json_integer_value(json_object_get(answer, "generation")) > 0);
    if (place && n > 0) {
        assert_string_equal(json_string_value(json_object_get(first, "place")), place);
        assert_non_null(strstr(json_string_value(json_object_get(first, "text")), words));
        assert_non_null(json_string_value(json_object_get(first, "remedy")));
    }
    json_decref(answer);
    return n;
}

static void ineffective_values_are_noted(void **state)
{
    (void)state;
    assert_int_equal(notes_on("{\"set\": {\"render.paths\": 7}}", "render.paths", "integrator=whitted"), 1);
    assert_int_equal(notes_on("{\"set\": {\"render.integrator\": \"path\", \"render.paths\": 9}}", NULL, NULL), 0);
    assert_int_equal(notes_on("{\"set\": {\"ball.ior\": 1.4}}", NULL, NULL), 0);
    assert_int_equal(notes_on("{\"set\": {\"ball.transparency\": 0, \"ball.ior\": 1.7}}", "ball.ior", "opaque"), 1);
}

static void assert_refused(const char *method, const char *target, const char *body, int code, const char *words)
{
    char *text = room_refused(&room, method, target, body, code);
    if (!strstr(text, words))
        fail_msg("%s %s: '%s' is not in '%s'", target, body ? body : "", words, text);
    free(text);
}

static void wrong_values_are_refused_with_a_remedy(void **state)
{
    (void)state;
    json_t *before = room_get(&room, "/api/scene");
    assert_refused("POST", "/api/set", "{\"set\": {\"ball.ior\": 1.7, \"ball.iorr\": 1}}", 400, "ball.ior");
    assert_refused("POST", "/api/set", "{\"set\": {\"ball.ior\": 1.7, \"ball.radius\": -1}}", 400, "out of range");
    assert_refused("POST", "/api/set", "{\"set\": {\"ball.ior\": {\"a\": 1}}}", 400, "not a valid value");
    assert_refused("POST", "/api/set", "{\"set\": {\"ball.ior\": null}}", 400, "not a valid value");
    assert_refused("POST", "/api/set", "{\"set\": {\"lamp.position\": [1, [2], 3]}}", 400, "not a valid value");
    assert_refused("POST", "/api/set", "{\"set\": {\"lamp.position\": [1, 2]}}", 400, "number");
    assert_refused("POST", "/api/set", "{\"set\": {\"render.depth\": 1.5}}", 400, "render.depth");
    assert_refused("POST", "/api/set", "{\"set\": {\"render.width\": 30000, \"render.height\": 30000}}", 400, "pixels");
    assert_refused("POST", "/api/set", "{\"set\": {}}", 400, "nothing to set");
    assert_refused("POST", "/api/set", "{\"set\": {\"ball.ior\": 1.7}, \"gesture\": 7}", 400, "gesture");
    assert_refused("POST", "/api/set", "{\"set\"", 400, "");
    assert_refused("POST", "/api/set", "[]", 400, "nothing to set");
    assert_refused("POST", "/api/reset", "{\"paths\": [7]}", 400, "paths");
    assert_refused("POST", "/api/reset", "[\"ball.ior\"]", 400, "paths");
    assert_refused("POST", "/api/reset", "7", 400, "paths");
    assert_refused("POST", "/api/reset", "{\"paths\": [\"ball.nothing\"]}", 400, "ball");
    assert_refused("POST", "/api/camera", "{\"orbit\": [1]}", 400, "YAW");
    assert_refused("POST", "/api/camera", "{\"step\": [1, 2, \"3\"]}", 400, "step");
    assert_refused("POST", "/api/camera", "{\"zoom\": 0}", 400, "zoom");
    assert_refused("POST", "/api/camera", "{\"look\": \"below\"}", 400, "front, back");
    assert_refused("POST", "/api/camera", "{\"frame\": \"bal\"}", 400, "bal");
    assert_refused("POST", "/api/camera", "{\"frame\": \"ground\"}", 400, "unbounded");
    assert_refused("POST", "/api/view", "{\"do\": \"sideways\"}", 400, "back, forward");
    assert_refused("POST", "/api/view", "{\"do\": \"back\"}", 409, "no earlier view");
    assert_refused("POST", "/api/view", "{\"do\": \"keep\"}", 409, "already");
    assert_refused("POST", "/api/undo", "{}", 409, "nothing to undo");
    assert_refused("GET", "/api/image.png?bits=9", NULL, 400, "?bits=16");
    assert_refused("GET", "/api/nothing", NULL, 404, "");
    assert_refused("GET", "/api/set", NULL, 405, "");
    json_t *after = room_get(&room, "/api/scene");
    assert_true(json_equal(before, after)); /* not even the generation has changed */
    json_decref(before);
    json_decref(after);
}

static vec3 vector_of(const json_t *list)
{
    return vec3_make(json_number_value(json_array_get(list, 0)), json_number_value(json_array_get(list, 1)),
                     json_number_value(json_array_get(list, 2)));
}

/* The whole body is scanned once: copying it for each number would take hours. */
static void the_longest_list_is_refused_quickly(void **state)
{
    (void)state;
    enum { NUMBERS = 500000 };
    static const char begin[] = "{\"set\": {\"lamp.position\": [1", end[] = "]}}";
    char *body = malloc(sizeof begin + 2 * NUMBERS + sizeof end), *at = stpcpy(body, begin);
    for (int i = 1; i < NUMBERS; i++)
        at = stpcpy(at, ",1");
    strcpy(at, end);
    assert_refused("POST", "/api/set", body, 400, "lamp.position");
    free(body);
}

typedef struct eye {
    vec3 at, forward, right, target;
} eye;

static eye view_now(void)
{
    json_t *state = room_get(&room, "/api/state");
    const json_t *c = json_object_get(state, "camera");
    const eye e = {vector_of(json_object_get(c, "eye")), vector_of(json_object_get(c, "forward")),
                   vector_of(json_object_get(c, "right")), vector_of(json_object_get(c, "target"))};
    json_decref(state);
    return e;
}

static void assert_near(double a, double b)
{
    if (!(fabs(a - b) <= 1e-12))
        fail_msg("%.17g is not %.17g", a, b);
}

static void assert_same_place(vec3 a, vec3 b)
{
    assert_near(a.x, b.x);
    assert_near(a.y, b.y);
    assert_near(a.z, b.z);
}

static void the_camera_orbits_turns_and_steps(void **state)
{
    (void)state;
    const eye first = view_now();
    room_post(&room, "/api/camera", "{\"orbit\": [30, 0]}");
    eye now = view_now();
    assert_same_place(now.target, first.target);
    assert_near(vec3_length(vec3_sub(now.at, now.target)), vec3_length(vec3_sub(first.at, first.target)));
    /* Seen from above, the direction to the target has turned by 30 degrees from +z to +x. */
    assert_near(atan2(now.forward.x, now.forward.z) * 180.0 / M_PI, 30.0);
    assert_near(now.forward.y, first.forward.y);
    room_post(&room, "/api/camera", "{\"orbit\": [0, 300]}"); /* clamped to nearly straight down */
    now = view_now();
    assert_near(asin(-now.forward.y) * 180.0 / M_PI, 89.5);
    assert_refused("POST", "/api/undo", "{}", 409, "nothing to undo"); /* a view is no change of the scene */
    room_post(&room, "/api/view", "{\"do\": \"back\"}");
    room_post(&room, "/api/view", "{\"do\": \"back\"}");
    room_post(&room, "/api/camera", "{\"turn\": [-90, 0]}");
    now = view_now();
    assert_same_place(now.at, first.at);
    assert_near(atan2(now.forward.x, now.forward.z) * 180.0 / M_PI, -90.0);
    assert_near(vec3_length(vec3_sub(now.at, now.target)), vec3_length(vec3_sub(first.at, first.target)));
    room_post(&room, "/api/view", "{\"do\": \"home\"}");
    room_post(&room, "/api/camera", "{\"step\": [0.5, 0, 2]}");
    now = view_now();
    assert_same_place(now.at,
                      vec3_add(first.at, vec3_add(vec3_scale(first.right, 0.5), vec3_scale(first.forward, 2.0))));
    assert_same_place(now.forward, first.forward);
    /* The camera has no target any more. */
    room_post(&room, "/api/set", "{\"set\": {\"camera.yaw_deg\": 20, \"camera.pitch_deg\": -10}}");
    room_post(&room, "/api/camera", "{\"turn\": [5, 3]}");
    now = view_now();
    assert_near(atan2(now.forward.x, now.forward.z) * 180.0 / M_PI, 25.0);
    assert_near(asin(now.forward.y) * 180.0 / M_PI, -7.0);
}

/* Renders the film of the command from GET /api/command, split by hand: it contains only blanks and quotes. */
static char *film_of_command(void)
{
    json_t *json = room_get(&room, "/api/command");
    assert_true(json_is_true(json_object_get(json, "complete")));
    char *line = strdup(json_string_value(json_object_get(json, "command"))), *path = room_path(&room, "scene.yaml");
    scene *s;
    diagnostic why = {0};
    worked(scene_read(path, &s, &why), &why);
    assert_non_null(strstr(line, path));
    for (char *at = line; (at = strstr(at, " --set "));) {
        at += 7;
        const char quote = *at == '\'' ? '\'' : ' ';
        char *word = quote == '\'' ? at + 1 : at, *end = strchr(word, quote);
        *end = 0;
        worked(scene_set_assignment(s, word, &why), &why);
        *(at = end) = quote;
    }
    renderer *r;
    render_result *made;
    worked(scene_load(s, &why), &why);
    worked(renderer_create(isa_best(), NULL, &r, &why), &why);
    worked(renderer_render(r, s, NULL, &made, &why), &why);
    char *hash = text_format("%016llx", (unsigned long long)film_hash(made->img));
    render_result_destroy(made);
    renderer_destroy(r);
    scene_destroy(s);
    free(path);
    free(line);
    json_decref(json);
    return hash;
}

static void the_command_renders_the_same_film(void **state)
{
    (void)state;
    room_post(&room, "/api/set",
              "{\"set\": {\"tiles.color\": [0.9, 0.1, 0.2], \"ground.ambient\": 0.3, \"ball.absorb_per_m\": [0.5, 0, "
              "0.25], \"camera.yaw_deg\": 12, \"camera.pitch_deg\": -15, \"render.samples\": 4}}");
    room_post(&room, "/api/camera", "{\"orbit\": [3, 4], \"step\": [0.1, 0.2, 0.3]}");
    char *shown = room_film(&room), *made = film_of_command();
    assert_string_equal(shown, made);
    free(shown);
    free(made);
}

/* The paths of its textures are relative to its own folder. */
static void the_command_works_for_a_file_in_another_folder(void **state)
{
    (void)state;
    char *inner = room_path(&room, "inner");
    assert_int_equal(mkdir(inner, 0700), 0);
    char *png = client_ask(room.server, "GET", "/api/image.png?wait=1", "", NULL), *path = room_path(&room, "sky.png");
    const char *length = strstr(png, "Content-Length: ");
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    assert_non_null(length);
    assert_int_equal(fwrite(reply_body(png), 1, strtoul(length + 16, NULL, 10), out), strtoul(length + 16, NULL, 10));
    assert_int_equal(fclose(out), 0);
    room_post(&room, "/api/set", "{\"set\": {\"background.image\": \"sky.png\"}}");
    free(room_film(&room));
    room_post(&room, "/api/save", "{\"file\": \"inner/moved.yaml\"}");
    room_post(&room, "/api/set", "{\"set\": {\"ball.ior\": 1.25}}");
    json_t *json = room_get(&room, "/api/command");
    char *expected = text_format("cuvette render %s/moved.yaml --set ball.ior=1.25 -o image.png", inner);
    assert_string_equal(json_string_value(json_object_get(json, "command")), expected);
    assert_true(json_is_true(json_object_get(json, "complete")));
    json_decref(json);
    free(expected);
    free(png);
    free(path);
    free(inner);
}

static void the_scene_is_returned_as_a_scene_file(void **state)
{
    (void)state;
    room_post(&room, "/api/set", "{\"set\": {\"ball.ior\": 1.8}}");
    char *reply = client_ask(room.server, "GET", "/api/scene.yaml", "", NULL), *shown = room_film(&room),
         *path = room_path(&room, "again.yaml");
    room_write(&room, "again.yaml", reply_body(reply));
    scene *s;
    diagnostic why = {0};
    worked(scene_read(path, &s, &why), &why);
    char *value;
    assert_int_equal(scene_get(s, "ball.ior", &value, NULL), STATUS_OK);
    assert_string_equal(value, "1.8");
    assert_int_equal(s->render.threads, 1); /* the 2 here is the laboratory's default */
    free(value);
    scene_destroy(s);
    free(path);
    free(shown);
    free(reply);
}

static const char *note_of(const json_t *json, const char *key)
{
    return json_string_value(json_object_get(json_array_get(json_object_get(json, "notes"), 0), key));
}

static void the_linters_notes_are_listed(void **state)
{
    (void)state;
    room_post(&room, "/api/set", "{\"set\": {\"render.depth\": 12}}");
    json_t *json = room_get(&room, "/api/notes");
    assert_int_equal(json_array_size(json_object_get(json, "notes")), 0);
    json_decref(json);
    room_post(&room, "/api/set", "{\"set\": {\"ball.ior\": 150}}");
    json = room_get(&room, "/api/notes");
    assert_int_equal(json_array_size(json_object_get(json, "notes")), 1);
    assert_string_equal(note_of(json, "place"), "ball.ior");
    assert_non_null(strstr(note_of(json, "text"), "index of 150"));
    assert_non_null(strstr(note_of(json, "remedy"), "between 1 and 5"));
    json_decref(json);
}

static void images_are_labelled_with_their_generation(void **state)
{
    (void)state;
    const json_int_t generation = room_post(&room, "/api/set", "{\"set\": {\"ball.radius\": 0.8}}");
    char *line = text_format("X-Cuvette-Generation: %lld", (long long)generation);
    char *png = client_ask(room.server, "GET", "/api/image.png?wait=1&download=a%22b.png", "", NULL);
    assert_true(reply_has(png, "Content-Type: image/png"));
    assert_true(reply_has(png, line));
    assert_true(reply_has(png, "X-Cuvette-Final: 1"));
    assert_true(reply_has(png, "Content-Disposition: attachment; filename=\"a_b.png\""));
    assert_int_equal(memcmp(reply_body(png), "\x89PNG\r\n\x1a\n", 8), 0);
    free(png);
    char *jpeg = client_ask(room.server, "GET", "/api/image.jpg", "", NULL);
    assert_true(reply_has(jpeg, "Content-Type: image/jpeg"));
    assert_int_equal(memcmp(reply_body(jpeg), "\xff\xd8\xff", 3), 0);
    free(jpeg);
    free(line);
}

static void clients_without_token_or_with_foreign_origin_are_refused(void **state)
{
    (void)state;
    static const char *const targets[] = {"/",           "/api/state", "/api/scene",   "/api/image.png",
                                          "/api/events", "/api/files", "/api/studies", "/api/machine"};
    const int port = http_port(room.server);
    char *host = text_format("Host: 127.0.0.1:%d\r\n", port),
         *token = text_format("Authorization: Bearer %s\r\n", http_token(room.server));
    char *foreign = text_format("%s%sOrigin: http://evil.example\r\nContent-Type: application/json\r\n", host, token);
    char *other_host = text_format("Host: evil.example:%d\r\n%s", port, token);
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        char *reply = client_ask_as(port, "GET", targets[i], host, NULL);
        assert_int_equal(reply_code(reply), 401);
        free(reply);
        reply = client_ask_as(port, "GET", targets[i], other_host, NULL);
        assert_int_equal(reply_code(reply), 421);
        free(reply);
        reply = client_ask_as(port, "GET", targets[i], foreign, NULL);
        assert_int_equal(reply_code(reply), 403);
        free(reply);
    }
    char *reply = client_ask_as(port, "POST", "/api/set", foreign, "{\"set\": {\"ball.ior\": 2}}");
    assert_int_equal(reply_code(reply), 403);
    free(reply);
    char *form = text_format("%s%sContent-Type: text/plain\r\n", host, token);
    reply = client_ask_as(port, "POST", "/api/set", form, "{\"set\": {\"ball.ior\": 2}}");
    assert_int_equal(reply_code(reply), 415);
    free(reply);
    assert_param("ball.ior", "value", 1.5);
    free(form);
    free(other_host);
    free(foreign);
    free(token);
    free(host);
}

static void without_a_scene_the_lab_opens_a_new_one(void **state)
{
    (void)state;
    lab_room empty;
    room_open(&empty, NULL);
    json_t *json = room_get(&empty, "/api/state");
    assert_true(json_is_null(json_object_get(json, "file")));
    json_decref(json);
    free(room_film(&empty));
    json = room_get(&empty, "/api/command");
    assert_false(json_is_true(json_object_get(json, "complete")));
    json_decref(json);
    room_close(&empty);
}

static void invalid_arguments_of_lab_start_are_refused(void **state)
{
    (void)state;
    lab *l;
    diagnostic why = {0};
    char *broken = room_path(&room, "broken.yaml");
    room_write(&room, "broken.yaml", "solids: [\n");
    assert_int_equal(
        lab_start(&(lab_settings){.folder = room.folder, .scene = broken, .results = room.results, .level = isa_best()},
                  &l, &why),
        STATUS_BAD_INPUT);
    assert_string_equal(why.file, broken);
    assert_true(why.line > 0);
    assert_int_equal(
        lab_start(&(lab_settings){.folder = "/nowhere", .results = room.results, .level = isa_best()}, &l, &why),
        STATUS_BAD_INPUT);
    assert_int_equal(
        lab_start(
            &(lab_settings){.folder = room.folder, .scene = ROD_SCENE, .results = room.results, .level = isa_best()},
            &l, &why),
        STATUS_BAD_INPUT);
    assert_int_equal(lab_start(&(lab_settings){.folder = room.folder,
                                               .results = room.results,
                                               .level = isa_best(),
                                               .port = http_port(room.server)},
                               &l, &why),
                     STATUS_BAD_INPUT);
    assert_null(l);
    free(broken);
}

int main(void)
{
#define IN_A_ROOM(test) cmocka_unit_test_setup_teardown(test, open_room, close_room)
    const struct CMUnitTest cases[] = {
        IN_A_ROOM(parameters_are_found_by_words),
        IN_A_ROOM(parameters_are_set_as_by_the_option_set),
        IN_A_ROOM(ineffective_values_are_noted),
        IN_A_ROOM(wrong_values_are_refused_with_a_remedy),
        IN_A_ROOM(the_camera_orbits_turns_and_steps),
        IN_A_ROOM(the_command_renders_the_same_film),
        IN_A_ROOM(the_scene_is_returned_as_a_scene_file),
        IN_A_ROOM(the_linters_notes_are_listed),
        IN_A_ROOM(images_are_labelled_with_their_generation),
        IN_A_ROOM(clients_without_token_or_with_foreign_origin_are_refused),
        IN_A_ROOM(without_a_scene_the_lab_opens_a_new_one),
        IN_A_ROOM(invalid_arguments_of_lab_start_are_refused),
        IN_A_ROOM(the_command_works_for_a_file_in_another_folder),
        IN_A_ROOM(the_longest_list_is_refused_quickly),
    };
    return cmocka_run_group_tests_name("lab", cases, NULL, NULL);
}
