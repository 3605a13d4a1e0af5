/* Tests of the scene document, and of what a page reads of it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "lab_fixture.h"
#include "render_fixture.h"
#include "scene/model/scene.h"
#include "web/api/api.h"
#include "web/document/scene_document.h"
#include <pthread.h>

/* The scene document: changes, undo, gestures, resets, limits. */

static int changes_seen;

static void changed(void *context)
{
    (void)context;
    __atomic_add_fetch(&changes_seen, 1, __ATOMIC_RELAXED);
}

static scene_document *open_document(const char *text)
{
    scene_document *d;
    diagnostic why = {0};
    worked(scene_document_create(scene_from(text), "ball.yaml", NULL, changed, NULL, &d, &why), &why);
    return d;
}

static status set_one(void *of, scene *s, diagnostic *why)
{
    return scene_set_assignment(s, of, why);
}

static uint64_t apply_as(scene_document *d, const char *assignment, const char *gesture)
{
    uint64_t generation = 0;
    diagnostic why = {0};
    worked(scene_document_apply(d, assignment, gesture, set_one, (void *)(uintptr_t)assignment, &generation, &why),
           &why);
    return generation;
}

static uint64_t apply(scene_document *d, const char *assignment)
{
    return apply_as(d, assignment, NULL);
}

static void assert_value(scene_document *d, const char *path, const char *expected)
{
    char *value = NULL;
    scene *s = scene_document_copy(d, NULL);
    assert_int_equal(scene_get(s, path, &value, NULL), STATUS_OK);
    assert_string_equal(value, expected);
    free(value);
    scene_destroy(s);
}

static json_t *state_json(scene_document *d)
{
    json_t *state = json_object();
    assert_true(scene_document_json(d, state));
    return state;
}

static void assert_state(scene_document *d, const char *key, const char *text)
{
    json_t *state = state_json(d);
    const json_t *value = json_object_get(state, key);
    if (text)
        assert_string_equal(json_string_value(value), text);
    else
        assert_true(json_is_null(value));
    json_decref(state);
}

static void each_change_increments_the_generation_and_can_be_undone(void **state)
{
    (void)state;
    scene_document *d = open_document(BALL_SCENE);
    changes_seen = 0;
    assert_int_equal(scene_document_generation(d), 1);
    assert_state(d, "undo", NULL);
    assert_int_equal(apply(d, "ball.ior=1.6"), 2);
    assert_int_equal(apply(d, "ball.ior=1.7"), 3);
    assert_state(d, "undo", "ball.ior=1.7");
    uint64_t generation;
    assert_int_equal(scene_document_undo(d, false, &generation, NULL), STATUS_OK);
    assert_int_equal(generation, 4);
    assert_value(d, "ball.ior", "1.6");
    assert_state(d, "redo", "ball.ior=1.7");
    assert_int_equal(scene_document_undo(d, false, NULL, NULL), STATUS_OK);
    assert_value(d, "ball.ior", "1.5");
    assert_int_equal(scene_document_undo(d, false, NULL, NULL), STATUS_BAD_INPUT);
    assert_int_equal(scene_document_undo(d, true, NULL, NULL), STATUS_OK);
    assert_int_equal(scene_document_undo(d, true, NULL, NULL), STATUS_OK);
    assert_int_equal(scene_document_undo(d, true, NULL, NULL), STATUS_BAD_INPUT);
    assert_value(d, "ball.ior", "1.7");
    assert_int_equal(scene_document_undo(d, false, NULL, NULL), STATUS_OK);
    apply(d, "ball.radius=0.5"); /* a new change clears the redo stack */
    assert_state(d, "redo", NULL);
    assert_int_equal(changes_seen, 8);
    scene_document_destroy(d);
}

static void a_refused_change_has_no_effect(void **state)
{
    (void)state;
    static const char *const bad[] = {"ball.ior=-1", "ball.nothing=1", "camera.position=0,1,0", "render.width=0",
                                      "render.width=65536"};
    scene_document *d = open_document(BALL_SCENE);
    apply(d, "render.height=4096");
    changes_seen = 0;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        diagnostic why = {0};
        assert_int_equal(scene_document_apply(d, "x", NULL, set_one, (void *)(uintptr_t)bad[i], NULL, &why),
                         STATUS_BAD_INPUT);
        assert_true(why.what[0] != 0);
    }
    assert_int_equal(scene_document_generation(d), 2);
    assert_int_equal(changes_seen, 0);
    assert_value(d, "render.width", "64");
    assert_state(d, "undo", "render.height=4096");
    scene_document_destroy(d);
}

static status ask_for_much(void *of, scene *s, diagnostic *why)
{
    const char *const *assignments = of;
    status code = STATUS_OK;
    for (size_t i = 0; assignments[i] && code == STATUS_OK; i++)
        code = scene_set_assignment(s, assignments[i], why);
    return code;
}

static void work_and_memory_are_limited(void **state)
{
    (void)state;
    static const char *const work[] = {"render.width=4096", "render.height=4096", "render.integrator=path",
                                       "render.paths=1000000", NULL};
    static const char *const triangles[] = {"soup.count=4000001", NULL}, *const enough[] = {"soup.count=4000000", NULL};
    scene_document *d = open_document(
        BALL_SCENE "  heap: {shape: mesh, mesh: soup, priority: 2}\nmeshes:\n  soup: {generate: sphere, count: 100}\n");
    assert_int_equal(scene_document_apply(d, "x", NULL, ask_for_much, (void *)(uintptr_t)work, NULL, NULL),
                     STATUS_BAD_INPUT);
    assert_int_equal(scene_document_apply(d, "x", NULL, ask_for_much, (void *)(uintptr_t)triangles, NULL, NULL),
                     STATUS_BAD_INPUT);
    assert_int_equal(scene_document_apply(d, "x", NULL, ask_for_much, (void *)(uintptr_t)enough, NULL, NULL),
                     STATUS_OK);
    scene_document_destroy(d);
}

static void a_gesture_is_one_undo_step(void **state)
{
    (void)state;
    scene_document *d = open_document(BALL_SCENE);
    for (int i = 0; i < 20; i++) {
        char text[32];
        snprintf(text, sizeof text, "ball.ior=1.%d", 10 + i);
        apply_as(d, text, "drag 1");
    }
    apply_as(d, "ball.radius=0.5", "drag 2");
    assert_int_equal(scene_document_generation(d), 22);
    assert_int_equal(scene_document_undo(d, false, NULL, NULL), STATUS_OK);
    assert_value(d, "ball.radius", "1");
    assert_value(d, "ball.ior", "1.29");
    assert_int_equal(scene_document_undo(d, false, NULL, NULL), STATUS_OK);
    assert_value(d, "ball.ior", "1.5");
    apply_as(d, "ball.ior=1.2", "drag 2"); /* after an undo the change is a separate step */
    assert_int_equal(scene_document_undo(d, false, NULL, NULL), STATUS_OK);
    assert_value(d, "ball.ior", "1.5");
    scene_document_destroy(d);
}

static void the_undo_history_has_a_limit(void **state)
{
    (void)state;
    scene_document *d = open_document(BALL_SCENE);
    for (int i = 0; i < DOCUMENT_UNDO_MAX + 50; i++) {
        char text[32];
        snprintf(text, sizeof text, "ball.ior=%d", 1 + i % 3);
        apply(d, text);
    }
    int undone = 0;
    while (scene_document_undo(d, false, NULL, NULL) == STATUS_OK)
        undone++;
    assert_int_equal(undone, DOCUMENT_UNDO_MAX);
    scene_document_destroy(d);
}

static void resets_restore_the_opened_scene(void **state)
{
    (void)state;
    static const char *const paths[] = {"ball.ior", "lamp.position"}, *const wrong[] = {"ball.nothing"};
    scene_document *d = open_document(BALL_SCENE);
    apply(d, "ball.ior=1.9");
    apply(d, "lamp.position=1,2,3");
    apply(d, "ball.radius=0.7");
    assert_int_equal(scene_document_reset(d, paths, 2, NULL, NULL), STATUS_OK);
    assert_value(d, "ball.ior", "1.5");
    assert_value(d, "lamp.position", "4,7,-5");
    assert_value(d, "ball.radius", "0.7");
    assert_int_equal(scene_document_reset(d, wrong, 1, NULL, NULL), STATUS_BAD_INPUT);
    assert_int_equal(scene_document_reset(d, NULL, 0, NULL, NULL), STATUS_OK);
    assert_value(d, "ball.radius", "1");
    assert_int_equal(scene_document_undo(d, false, NULL, NULL), STATUS_OK);
    assert_value(d, "ball.radius", "0.7");
    diagnostic why = {0};
    worked(scene_document_open(d, scene_from(BALL_SCENE "  cube: {shape: box, size: [1, 1, 1], priority: 5}\n"),
                               "other.yaml", NULL, &why),
           &why);
    apply(d, "cube.size=2,2,2");
    assert_int_equal(scene_document_reset(d, NULL, 0, NULL, NULL), STATUS_OK);
    assert_value(d, "cube.size", "1,1,1");
    assert_state(d, "file", "other.yaml");
    for (int i = 0; i < 3; i++)
        assert_int_equal(scene_document_undo(d, false, NULL, NULL), STATUS_OK);
    assert_state(d, "file", "ball.yaml"); /* opening can be undone */
    assert_int_equal(scene_document_reset(d, NULL, 0, NULL, NULL),
                     STATUS_OK); /* resets then use the scene opened before */
    assert_value(d, "ball.radius", "1");
    scene_document_destroy(d);
}

static bool is_saved(scene_document *d)
{
    json_t *state = state_json(d);
    const bool saved = json_is_true(json_object_get(state, "saved"));
    json_decref(state);
    return saved;
}

static uint64_t orbit_view(scene_document *d, double yaw_deg, const char *gesture)
{
    camera_move move = {.orbit_deg = {yaw_deg, 0.0}};
    uint64_t generation = 0;
    assert_int_equal(scene_document_move_view(d, &move, gesture, &generation, NULL), STATUS_OK);
    return generation;
}

static scene *take_kept(scene_document *d, uint64_t *generation)
{
    return scene_document_copy_to_save(d, generation, NULL);
}

static uint64_t version_now(scene_document *d)
{
    uint64_t number = 0;
    scene_destroy(scene_document_copy_to_save(d, NULL, &number));
    return number;
}

static bool is_unsaved(scene_document *d)
{
    uint64_t number;
    return scene_document_unsaved(d, &number, NULL);
}

static void changes_without_a_file_would_be_lost(void **state)
{
    (void)state;
    scene_document *d = open_document(BALL_SCENE);
    diagnostic why = {0};
    assert_false(is_unsaved(d));
    apply(d, "ball.ior=1.6");
    assert_true(is_unsaved(d));
    orbit_view(d, 10.0, NULL);
    scene_document_undo(d, false, NULL, NULL);
    assert_false(is_unsaved(d));
    worked(scene_document_open(d, scene_from(BALL_SCENE), NULL, NULL, &why), &why); /* it can be opened again */
    assert_false(is_unsaved(d));
    assert_false(is_saved(d));
    worked(scene_document_rescue(d, scene_from(BALL_SCENE), "ball.yaml", NULL, &why), &why);
    assert_true(is_unsaved(d));
    assert_false(is_saved(d));
    assert_state(d, "file", "ball.yaml");
    assert_state(d, "undo", "open a rescued scene");
    uint64_t before, written;
    assert_true(scene_document_unsaved(d, &before, NULL));
    apply(d, "ball.ior=1.7");
    assert_true(scene_document_unsaved(d, &written, NULL));
    assert_true(written > before);
    scene_document_saved(d, "ball.yaml", written);
    assert_false(is_unsaved(d));
    scene_document_undo(d, false, NULL, NULL);
    assert_true(is_unsaved(d)); /* the file has the later scene */
    scene_document_destroy(d);
}

static void the_document_tracks_whether_it_is_saved(void **state)
{
    (void)state;
    scene_document *d = open_document(BALL_SCENE);
    assert_true(is_saved(d));
    const uint64_t earlier = version_now(d);
    apply(d, "ball.ior=1.6");
    assert_false(is_saved(d));
    scene_document_undo(d, false, NULL, NULL);
    assert_true(is_saved(d)); /* it equals the file again */
    scene_document_reset(d, NULL, 0, NULL, NULL);
    assert_true(is_saved(d));
    apply(d, "ball.ior=1.6");
    assert_false(is_saved(d));
    scene_document_saved(d, "new.yaml", earlier); /* of an earlier scene */
    assert_false(is_saved(d));
    const uint64_t written = version_now(d);
    orbit_view(d, 20.0, NULL); /* another page moves the camera while the file is written */
    scene_document_saved(d, "new.yaml", written);
    assert_true(is_saved(d));
    assert_state(d, "file", "new.yaml");
    scene_document_destroy(d);
}

static double eye_x(scene_document *d, scene *(*take)(scene_document *d, uint64_t *generation))
{
    scene *s = take(d, NULL);
    const double x = s->camera.position.x;
    scene_destroy(s);
    return x;
}

static double view_x(scene_document *d)
{
    return eye_x(d, scene_document_copy);
}

/* A view makes a new image, but changes no scene: no undo step, nothing to save. */
static void views_have_a_history_of_their_own(void **state)
{
    (void)state;
    scene_document *d = open_document(BALL_SCENE);
    const double own = view_x(d);
    apply(d, "ball.ior=1.6");
    scene_document_saved(d, "ball.yaml", version_now(d));
    const uint64_t before = scene_document_generation(d);
    assert_int_equal(orbit_view(d, 20.0, "drag"), before + 1);
    orbit_view(d, 20.0, "drag"); /* the same view of the history */
    const double second = view_x(d);
    orbit_view(d, 20.0, NULL);
    const double third = view_x(d);
    assert_true(is_saved(d));
    assert_true(eye_x(d, take_kept) == own);
    assert_int_equal(scene_document_undo(d, false, NULL, NULL), STATUS_OK);
    assert_value(d, "ball.ior", "1.5");
    assert_true(view_x(d) == third); /* the scene's undo leaves the view */
    assert_int_equal(scene_document_undo(d, true, NULL, NULL), STATUS_OK);
    assert_int_equal(scene_document_view(d, VIEW_BACK, NULL, NULL), STATUS_OK);
    assert_true(view_x(d) == second);
    assert_int_equal(scene_document_view(d, VIEW_BACK, NULL, NULL), STATUS_OK);
    assert_true(view_x(d) == own);
    assert_int_equal(scene_document_view(d, VIEW_BACK, NULL, NULL), STATUS_BAD_INPUT);
    assert_int_equal(scene_document_view(d, VIEW_KEEP, NULL, NULL), STATUS_BAD_INPUT); /* the scene has it */
    assert_int_equal(scene_document_view(d, VIEW_FORWARD, NULL, NULL), STATUS_OK);
    assert_true(view_x(d) == second && is_saved(d));
    scene_document_destroy(d);
}

static void a_view_is_kept_on_demand(void **state)
{
    (void)state;
    scene_document *d = open_document(BALL_SCENE);
    const double own = view_x(d);
    orbit_view(d, 30.0, NULL);
    const double kept = view_x(d);
    assert_int_equal(scene_document_view(d, VIEW_KEEP, NULL, NULL), STATUS_OK);
    assert_false(is_saved(d));
    assert_state(d, "undo", "keep the view");
    assert_true(eye_x(d, take_kept) == kept);
    orbit_view(d, 30.0, NULL);
    assert_int_equal(scene_document_view(d, VIEW_HOME, NULL, NULL), STATUS_OK);
    assert_true(view_x(d) == kept);
    assert_int_equal(scene_document_undo(d, false, NULL, NULL), STATUS_OK);
    assert_true(view_x(d) == own && is_saved(d)); /* undoing a change of the scene's camera shows it */
    orbit_view(d, 30.0, NULL);
    const double shown = view_x(d);
    const char same[] = "camera.roll_deg=0"; /* what the view shows already */
    assert_int_equal(scene_document_apply_to_camera(d, same, NULL, set_one, (void *)(uintptr_t)same, NULL, NULL),
                     STATUS_OK);
    assert_true(view_x(d) == shown && eye_x(d, take_kept) == shown && !is_saved(d));
    assert_int_equal(scene_document_undo(d, false, NULL, NULL), STATUS_OK);
    assert_true(view_x(d) == own && is_saved(d));
    apply(d, "camera.fov_deg=30"); /* a parameter of the camera is one of the scene */
    assert_false(is_saved(d));
    scene_document_reset(d, NULL, 0, NULL, NULL);
    assert_true(is_saved(d));
    for (int i = 0; i < 300; i++)
        orbit_view(d, 1.0, NULL); /* the history is bounded */
    for (int i = 0; i < 100; i++)
        assert_int_equal(scene_document_view(d, VIEW_BACK, NULL, NULL), STATUS_OK);
    assert_int_equal(scene_document_view(d, VIEW_BACK, NULL, NULL), STATUS_BAD_INPUT);
    scene_document_destroy(d);
}

static void loaded_data_is_shared(void **state)
{
    (void)state;
    scene_document *d = open_document(
        BALL_SCENE "  heap: {shape: mesh, mesh: soup, priority: 2}\nmeshes:\n  soup: {generate: sphere, count: 100}\n");
    uint64_t generation;
    scene *s = scene_document_copy(d, &generation);
    assert_int_equal(scene_load(s, NULL), STATUS_OK);
    const mesh *loaded = s->meshes[0].data;
    scene_document_reuse_loaded(d, s, generation + 1); /* of another generation */
    scene *other = scene_document_copy(d, NULL);
    assert_null(other->meshes[0].data);
    scene_destroy(other);
    scene_document_reuse_loaded(d, s, generation);
    apply(d, "ball.ior=1.6");
    other = scene_document_copy(d, NULL);
    assert_ptr_equal(other->meshes[0].data, loaded);
    scene_destroy(other);
    apply(d, "soup.count=200");
    other = scene_document_copy(d, NULL);
    assert_null(other->meshes[0].data);
    scene_destroy(other);
    scene_destroy(s);
    scene_document_destroy(d);
}

enum { THREADS = 4, EACH = 200 };

static void *change_often(void *of)
{
    for (int i = 0; i < EACH; i++) {
        apply(of, i % 2 ? "ball.ior=1.5" : "ball.ior=1.4");
        if (i % 10 == 9)
            scene_document_undo(of, false, NULL, NULL);
    }
    return NULL;
}

static void concurrent_changes_are_all_applied(void **state)
{
    (void)state;
    scene_document *d = open_document(BALL_SCENE);
    pthread_t thread[THREADS];
    for (int i = 0; i < THREADS; i++)
        assert_int_equal(pthread_create(&thread[i], NULL, change_often, d), 0);
    for (int i = 0; i < THREADS; i++)
        pthread_join(thread[i], NULL);
    assert_int_equal(scene_document_generation(d), 1 + THREADS * (EACH + EACH / 10));
    scene_document_destroy(d);
}

/* GET /api/scene?since=GENERATION: what differs, applied to the earlier reply, gives the whole scene. */

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
        cmocka_unit_test(each_change_increments_the_generation_and_can_be_undone),
        cmocka_unit_test(a_refused_change_has_no_effect),
        cmocka_unit_test(work_and_memory_are_limited),
        cmocka_unit_test(a_gesture_is_one_undo_step),
        cmocka_unit_test(the_undo_history_has_a_limit),
        cmocka_unit_test(resets_restore_the_opened_scene),
        cmocka_unit_test(changes_without_a_file_would_be_lost),
        cmocka_unit_test(the_document_tracks_whether_it_is_saved),
        cmocka_unit_test(views_have_a_history_of_their_own),
        cmocka_unit_test(a_view_is_kept_on_demand),
        cmocka_unit_test(loaded_data_is_shared),
        cmocka_unit_test(concurrent_changes_are_all_applied),
        cmocka_unit_test_setup_teardown(what_differs_completes_an_earlier_scene, open_room, close_room),
        cmocka_unit_test_setup_teardown(an_unknown_generation_gets_the_whole_scene, open_room, close_room),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
