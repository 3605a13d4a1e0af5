/* Tests of lessons and thumbnails through the API: a teacher's lesson of the folder, what it measures in the scene as
 * it is changed, and small images that are those of the renderer. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "lab_study_fixture.h"
#include "lesson/lesson.h"
#include "render/plan/film.h"
#include "render_fixture.h"
#include <pthread.h>

/* Has the name of one of the program's own lessons. */
#define OWN                                                                                           \
    "lesson: critical-angle\ntitle: Ours\nquestion: Why?\nscene: rod.yaml\n"                          \
    "set: {liquid.ior: 1.5, render.width: 64, render.height: 48}\n"                                   \
    "controls: [{parameter: liquid.ior, label: Index, from: 1.1, to: 2}]\n"                           \
    "prediction: {ask: Which angle?, within: 1}\n"                                                    \
    "measure: {curve: mirror, tolerance: 1e-9, reading: Angle, unit: deg, metric: critical.liquid}\n" \
    "answer: Because.\n"

static int open_with_lessons(void **state)
{
    char *rod = NULL;
    size_t size;
    set_up(state);
    const lab_room *room = *state;
    assert_int_equal(file_read(ROD_SCENE, 1 << 20, &rod, &size, NULL), STATUS_OK);
    room_write(room, "rod.yaml", rod);
    room_write(room, "own.lesson", OWN);
    free(rod);
    return 0;
}

static const char *text_of(const json_t *from, const char *key)
{
    const char *text = json_string_value(json_object_get(from, key));
    return text ? text : "";
}

static double real_of(const json_t *from, const char *key)
{
    return json_number_value(json_object_get(from, key));
}

static void lessons_of_the_folder_replace_those_of_the_program(void **state)
{
    const lab_room *room = *state;
    make_folder(room, "more");
    room_write(room, "more/broken.lesson", "lesson: broken\ntitle: Broken\ntitel: Broken\n");
    room_write(room, "more/outside.lesson", "lesson: outside\nscene: ../../scene.yaml\n");
    json_t *json = room_get(room, "/api/lessons");
    const json_t *list = json_object_get(json, "lessons"), *one;
    size_t i, ours = 0, wrong = 0, others = 0;
    json_array_foreach(list, i, one)
    {
        const bool own = json_is_true(json_object_get(one, "own"));
        const json_t *error = json_object_get(one, "error");
        if (strcmp(text_of(one, "name"), "critical-angle") == 0) {
            assert_true(own && strcmp(text_of(one, "title"), "Ours") == 0);
            ours++;
        } else if (error) {
            assert_true(own && text_of(one, "file")[0] && text_of(error, "error")[0] && text_of(error, "remedy")[0]);
            assert_true(number_at(error, "line") > 0);
            wrong++;
        } else {
            assert_false(own);
            others++;
        }
    }
    assert_int_equal(ours, 1);
    assert_int_equal(wrong, 2);
    char *programs = lesson_folder(); /* instrumented builds are too deep to find them */
    assert_true(programs ? others >= 8 : others == 0);
    free(programs);
    json_decref(json);
}

/* Checks what the lesson measures against Snell's law for that index, in degrees. */
static void measured(const lab_room *room, double ior)
{
    json_t *json = room_get(room, "/api/lessons/critical-angle/measure");
    const double expected = asin(1 / ior) * 180 / M_PI;
    assert_true(fabs(real_of(json, "measured") - expected) < 1e-9);
    assert_true(fabs(real_of(json, "theory") - expected) < 1e-9);
    assert_true(json_is_true(json_object_get(json, "passes")) && real_of(json, "error") <= 1e-9);
    assert_true(json_array_size(json_object_get(json, "points")) >= 10);
    json_decref(json);
}

static void a_lesson_is_opened_measured_and_undone(void **state)
{
    const lab_room *room = *state;
    char *refusal = room_refused(room, "GET", "/api/lessons/critical-angle/measure", NULL, 400);
    if (!strstr(refusal, "vessel")) /* the ball has none */
        fail_msg("%s", refusal);
    free(refusal);
    room_post(room, "/api/lessons/critical-angle/open", "{}");
    json_t *json = room_get(room, "/api/state");
    assert_string_equal(text_of(json, "title"), "Ours");
    assert_true(json_is_null(json_object_get(json, "file")) && json_is_string(json_object_get(json, "undo")));
    json_decref(json);
    measured(room, 1.5);
    room_post(room, "/api/set", "{\"set\": {\"liquid.ior\": 1.25}}");
    measured(room, 1.25);
    room_post(room, "/api/undo", "{}");
    room_post(room, "/api/undo", "{}");
    json = room_get(room, "/api/state");
    assert_string_equal(text_of(json, "title"), "Ball");
    json_decref(json);
}

static void unknown_lessons_are_refused(void **state)
{
    const lab_room *room = *state;
    char *text = room_refused(room, "POST", "/api/lessons/none/open", "{}", 404);
    assert_non_null(strstr(text, "GET /api/lessons"));
    free(text);
    free(room_refused(room, "GET", "/api/lessons/none/measure", NULL, 404));
    free(room_refused(room, "GET", "/api/lessons/none/thumbnail.jpg", NULL, 404));
    free(room_refused(room, "POST", "/api/lessons/critical-angle/open", "{\"scene\": \"rod.yaml\"}", 400));
}

/* --- thumbnails --- */

#define THUMBNAIL "/api/thumbnail.jpg?file=scene.yaml"

/* The image of a scene with the pixels and samples of a thumbnail. */
static unsigned char *rendered(const char *yaml, size_t *size)
{
    scene *s = scene_from(yaml);
    set_all(s, "render.width=240 render.height=180 render.samples=4");
    render_result *result = render(s);
    image *img = NULL;
    unsigned char *bytes = NULL;
    assert_int_equal(film_image(result->img, &img, NULL), STATUS_OK);
    assert_int_equal(image_encode(img, IMAGE_JPEG, 8, false, &bytes, size, NULL), STATUS_OK);
    image_destroy(img);
    render_result_destroy(result);
    scene_destroy(s);
    return bytes;
}

static void assert_thumbnail(const lab_room *room, const char *yaml)
{
    size_t size, expected_size;
    unsigned char *bytes = room_bytes(room, THUMBNAIL, "image/jpeg", &size), *expected = rendered(yaml, &expected_size);
    assert_int_equal(size, expected_size);
    assert_memory_equal(bytes, expected, size);
    free(expected);
    free(bytes);
}

static void a_thumbnail_is_the_image_of_the_file(void **state)
{
    const lab_room *room = *state;
    json_t *before = room_get(room, "/api/state"), *after;
    assert_thumbnail(room, BALL_SCENE);
    assert_thumbnail(room, BALL_SCENE); /* kept */
    room_write(room, "scene.yaml", BALL_SCENE "  more: {shape: sphere, position: [1.5, 1, 0], radius: 0.5}\n");
    assert_thumbnail(room, BALL_SCENE "  more: {shape: sphere, position: [1.5, 1, 0], radius: 0.5}\n");
    after = room_get(room, "/api/state");
    assert_int_equal(number_at(before, "generation"), number_at(after, "generation"));
    json_decref(before);
    json_decref(after);
    size_t size;
    free(room_bytes(room, "/api/lessons/critical-angle/thumbnail.jpg", "image/jpeg", &size));
    assert_true(size > 1000);
}

static void *ask_thumbnail(void *room)
{
    size_t size;
    return room_bytes(room, THUMBNAIL, "image/jpeg", &size);
}

static void pages_share_a_thumbnail(void **state)
{
    pthread_t page[4];
    size_t size;
    unsigned char *expected = rendered(BALL_SCENE, &size);
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&page[i], NULL, ask_thumbnail, *state), 0);
    for (size_t i = 0; i < 4; i++) {
        void *bytes = NULL;
        pthread_join(page[i], &bytes);
        assert_memory_equal(bytes, expected, size);
        free(bytes);
    }
    free(expected);
}

static void thumbnails_are_of_scenes_in_the_folder(void **state)
{
    const lab_room *room = *state;
    room_write(room, "wrong.yaml", "solids: {ball: {shape: bal}}\n");
    free(room_refused(room, "GET", "/api/thumbnail.jpg", NULL, 400));
    free(room_refused(room, "GET", "/api/thumbnail.jpg?file=none.yaml", NULL, 400));
    free(room_refused(room, "GET", "/api/thumbnail.jpg?file=../scene.yaml", NULL, 400));
    char *text = room_refused(room, "GET", "/api/thumbnail.jpg?file=wrong.yaml", NULL, 400);
    assert_non_null(strstr(text, "bal"));
    free(text);
}

static void no_thumbnail_disturbs_a_measurement(void **state)
{
    const lab_room *room = *state;
    room_write(room, "tiny.study", ENDLESS);
    json_decref(room_ask(room, "POST", "/api/studies/tiny/run", "{}", 200));
    wait_for_rows(room, 1);
    free(room_refused(room, "GET", THUMBNAIL, NULL, 409));
    free(room_refused(room, "GET", "/api/lessons/critical-angle/thumbnail.jpg", NULL, 409));
    json_decref(room_ask(room, "POST", "/api/studies/tiny/stop", "{}", 200));
    json_decref(wait_for_end(room));
    assert_thumbnail(room, BALL_SCENE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(lessons_of_the_folder_replace_those_of_the_program, open_with_lessons,
                                        tear_down),
        cmocka_unit_test_setup_teardown(a_lesson_is_opened_measured_and_undone, open_with_lessons, tear_down),
        cmocka_unit_test_setup_teardown(unknown_lessons_are_refused, open_with_lessons, tear_down),
        cmocka_unit_test_setup_teardown(a_thumbnail_is_the_image_of_the_file, open_with_lessons, tear_down),
        cmocka_unit_test_setup_teardown(pages_share_a_thumbnail, open_with_lessons, tear_down),
        cmocka_unit_test_setup_teardown(thumbnails_are_of_scenes_in_the_folder, open_with_lessons, tear_down),
        cmocka_unit_test_setup_teardown(no_thumbnail_disturbs_a_measurement, open_with_lessons, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
