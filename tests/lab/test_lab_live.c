/* Tests of the live slime without a server: this thread acts as the render worker, another one moves the hands.
 * tests/softbody/test_softbody.c tests the simulation itself. */
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include <cmocka.h>

#include "base/text.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "web/live/live.h"

/* The slime starts on the floor and soon comes to rest. */
static const char toys[] =
    "render: {width: 32, height: 24}\n"
    "camera: {position: [0, 0, -6], target: [0, 0, 0]}\n"
    "lights: {lamp: {position: [3, 6, -4]}}\n"
    "meshes:\n"
    "  pin: {generate: icosphere, level: 1}\n"
    "  toy: {generate: slime, level: 2, position: [0, 0, 0], ground_y: -1, damping: 0.5, dt_s: 0.0005, time_s: 0.05}\n"
    "materials: {jelly: {transparency: 0.9, ior: 1.3}}\n"
    "solids:\n"
    "  needle: {shape: mesh, mesh: pin, position: [0, 9, 0]}\n"
    "  body: {shape: mesh, mesh: toy, material: jelly, position: [1, 0, 0]}\n";

static const double most_s = 0.02;
enum { TOY = 1 };

static scene *scene_with(const char *text, const char *assignments)
{
    scene *s = NULL;
    diagnostic why = {.what = ""};
    if (scene_read_text("test.yaml", text, strlen(text), &s, &why) != STATUS_OK)
        fail_msg("%s", why.what);
    char *copy = strdup(assignments), *rest = copy;
    for (char *one; (one = strsep(&rest, " "));)
        if (*one && scene_set_assignment(s, one, &why) != STATUS_OK)
            fail_msg("%s", why.what);
    free(copy);
    return s;
}

static void attach(live *l, scene *stage)
{
    diagnostic why = {.what = ""};
    if (live_attach(l, stage, &why) != STATUS_OK)
        fail_msg("%s", why.what);
}

static bool advance(live *l)
{
    diagnostic why = {.what = ""};
    bool json = false;
    if (live_advance(l, most_s, &json, &why) != STATUS_OK)
        fail_msg("%s", why.what);
    return json;
}

static json_t *part(live *l, const char *key)
{
    json_t *all = live_json(l), *value = json_incref(json_object_get(all, key));
    json_decref(all);
    return value;
}

static double number(live *l, const char *key)
{
    json_t *value = part(l, key);
    const double n = json_number_value(value);
    assert_true(json_is_number(value));
    json_decref(value);
    return n;
}

static bool flag(live *l, const char *key)
{
    json_t *value = part(l, key);
    const bool yes = json_is_true(value);
    assert_true(json_is_boolean(value));
    json_decref(value);
    return yes;
}

static bool is_troubled(live *l)
{
    json_t *value = part(l, "trouble");
    const bool yes = json_is_object(value);
    json_decref(value);
    return yes;
}

/* Advances and checks the order of states; the awaited state must come within a simulated minute. */
static void advance_playing(live *l)
{
    advance(l);
    assert_false(is_troubled(l));
    assert_true(flag(l, "playing"));
    assert_true(number(l, "time_s") < 60.0);
}

static void come_to_rest(live *l)
{
    do {
        advance_playing(l);
    } while (live_is_moving(l));
    assert_true(flag(l, "resting"));
}

/* --- the hand of another thread --- */

typedef struct puller {
    live *l;
    vec3 origin, direction;
    int hand;
    vec3 where;
    status code;
    diagnostic why;
    atomic_bool done;
} puller;

static void *grab_there(void *of)
{
    puller *h = of;
    h->code = live_grab(h->l, h->origin, h->direction, 0.3, &h->hand, &h->where, &h->why);
    atomic_store(&h->done, true);
    return NULL;
}

/* Advances while the other thread waits. */
static puller grab(live *l, double x, double y)
{
    puller h = {.l = l, .origin = vec3_make(x, y, -6), .direction = vec3_make(0, 0, 2)};
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, grab_there, &h), 0);
    while (!atomic_load(&h.done))
        advance(l);
    pthread_join(thread, NULL);
    return h;
}

static vec3 surface_low(const scene *s)
{
    return s->meshes[TOY].data->bounds.low;
}

/* --- tests --- */

static void a_slime_is_off_until_played(void **state)
{
    (void)state;
    live *l = live_create(NULL, NULL);
    scene *s = scene_with(toys, "");
    json_t *nothing = live_json(l);
    assert_true(json_is_null(nothing));
    json_decref(nothing);
    attach(l, s);
    assert_false(live_is_on(l) || live_is_moving(l) || live_is_due(l));
    assert_false(flag(l, "on"));
    diagnostic why = {.what = ""};
    assert_int_equal(scene_load(s, &why), STATUS_OK);
    const mesh *own = s->meshes[TOY].data;
    live_send(l, LIVE_PLAY);
    assert_true(live_is_due(l) && live_is_on(l));
    assert_true(advance(l));
    assert_true(live_is_moving(l));
    assert_true(live_fetch_moved(l));
    assert_ptr_not_equal(s->meshes[TOY].data, own);
    assert_non_null(s->meshes[0].data);
    live_send(l, LIVE_OFF);
    advance(l);
    assert_ptr_equal(s->meshes[TOY].data, own);
    assert_true(s->meshes[TOY].time_s == 0.05);
    assert_false(live_is_on(l));
    assert_true(live_fetch_moved(l));
    assert_false(live_fetch_moved(l));
    live_detach(l);
    live_destroy(l);
    scene_destroy(s);
}

static void the_simulation_plays_pauses_and_restarts(void **state)
{
    (void)state;
    live *l = live_create(NULL, NULL);
    scene *s = scene_with(toys, "toy.ground=off"); /* without a floor it falls and never comes to rest */
    attach(l, s);
    live_send(l, LIVE_PLAY);
    while (number(l, "time_s") < 0.05)
        advance_playing(l);
    assert_true(s->meshes[TOY].time_s == number(l, "time_s"));
    assert_true(number(l, "speed") > 0.0);
    assert_true(fabs(number(l, "volume") / number(l, "volume_at_rest") - 1.0) < 0.01);
    live_send(l, LIVE_PAUSE);
    assert_true(advance(l));
    const double then_s = number(l, "time_s");
    assert_false(flag(l, "playing"));
    assert_false(advance(l));
    assert_false(live_is_due(l));
    assert_true(number(l, "time_s") == then_s);
    live_send(l, LIVE_RESTART);
    advance(l);
    assert_true(flag(l, "playing"));
    assert_true(number(l, "time_s") < then_s);
    live_detach(l);
    live_destroy(l);
    scene_destroy(s);
}

static void a_pulled_slime_stretches_and_recovers(void **state)
{
    (void)state;
    live *l = live_create(NULL, NULL);
    scene *s = scene_with(toys, "");
    attach(l, s);
    live_send(l, LIVE_PLAY);
    come_to_rest(l); /* a hand on a bouncing slime would hold it where it never rests */
    const bounds3 rest = s->meshes[TOY].data->bounds;
    puller missed = grab(l, 3.5, 0);
    assert_int_equal(missed.code, STATUS_OK);
    assert_int_equal(missed.hand, LIVE_MISSED);
    puller h = grab(l, 0.2, 0), still = grab(l, 1.5, 0); /* a second hand keeps it from rolling away */
    assert_int_equal(h.code, STATUS_OK);
    assert_true(h.hand > 0);
    assert_true(fabs(h.where.x - 0.2) < 1e-9 && h.where.z < 0.0 && h.where.z > -1.0);
    assert_true(number(l, "held") > 0);
    vec3 json;
    diagnostic why = {.what = ""};
    assert_int_equal(live_where(l, h.hand, &json, &why), STATUS_OK);
    assert_true(json.x == h.where.x && json.y == h.where.y && json.z == h.where.z);
    assert_int_equal(live_move(l, h.hand, vec3_make(-1.0, 0, 0), &why), STATUS_OK);
    while (surface_low(s).x > rest.low.x - 0.8)
        advance_playing(l);
    assert_false(flag(l, "resting"));
    assert_int_equal(live_release(l, h.hand, &why), STATUS_OK);
    assert_int_equal(live_move(l, h.hand, vec3_make(0, 0, 0), &why), STATUS_BAD_INPUT); /* the hand is released */
    while (surface_low(s).x < rest.low.x - 0.2)
        advance_playing(l);
    assert_true(number(l, "held") > 0.0);
    assert_int_equal(live_release(l, still.hand, &why), STATUS_OK);
    advance(l);
    assert_true(number(l, "held") == 0.0);
    live_detach(l);
    live_destroy(l);
    scene_destroy(s);
}

static void a_hand_wakes_a_resting_slime(void **state)
{
    (void)state;
    live *l = live_create(NULL, NULL);
    scene *s = scene_with(toys, "");
    attach(l, s);
    live_send(l, LIVE_PLAY);
    come_to_rest(l);
    assert_false(live_is_due(l));
    puller h = grab(l, 1, 0), other = grab(l, 1.3, 0.7);
    assert_true(live_is_moving(l));
    assert_true(other.hand > h.hand);
    diagnostic why = {.what = ""};
    assert_int_equal(live_release(l, LIVE_ALL, &why), STATUS_OK);
    advance(l);
    assert_true(number(l, "held") == 0.0);
    assert_int_equal(live_release(l, other.hand, &why), STATUS_BAD_INPUT);
    live_detach(l);
    live_destroy(l);
    scene_destroy(s);
}

/* A slow render worker advances in long steps; at the end of each the body may be at a turning point. */
static void rest_is_detected_over_several_samples(void **state)
{
    (void)state;
    const struct timespec slow = {.tv_nsec = 200000000};
    live *l = live_create(NULL, NULL);
    scene *s = scene_with(toys, "");
    attach(l, s);
    live_send(l, LIVE_PLAY);
    come_to_rest(l);
    grab(l, 1, 0);
    diagnostic why = {.what = ""};
    assert_int_equal(live_release(l, LIVE_ALL, &why), STATUS_OK);
    int looks = 0;
    do {
        nanosleep(&slow, NULL);
        advance_playing(l);
        looks++;
    } while (live_is_moving(l));
    assert_true(looks >= 5);
    live_detach(l);
    live_destroy(l);
    scene_destroy(s);
}

/* Replaces the scene as the render worker does after a change of the document. */
static scene *replace(live *l, scene *old, const char *assignments)
{
    scene *next = scene_with(toys, assignments);
    live_detach(l);
    scene_destroy(old);
    attach(l, next);
    return next;
}

static void unrelated_changes_keep_the_slimes_shape(void **state)
{
    (void)state;
    live *l = live_create(NULL, NULL);
    scene *s = scene_with(toys, "");
    attach(l, s);
    live_send(l, LIVE_PLAY);
    advance(l);
    puller h = grab(l, 0.2, 0);
    diagnostic why = {.what = ""};
    live_move(l, h.hand, vec3_make(-1.0, 0.3, 0), &why);
    while (surface_low(s).x > -1.5)
        advance_playing(l);
    const size_t size = s->meshes[TOY].data->vertex_count * sizeof(vec3);
    vec3 *before = malloc(size);
    memcpy(before, s->meshes[TOY].data->vertices, size);
    const double then_s = number(l, "time_s");
    s = replace(l, s, "jelly.absorb_per_m=3,0,1 camera.fov_deg=50 lamp.intensity=2 toy.time_s=0.2 body.position=2,0,0");
    assert_memory_equal(before, s->meshes[TOY].data->vertices, size);
    assert_true(number(l, "time_s") == then_s && s->meshes[TOY].time_s == then_s);
    assert_null(s->meshes[0].data); /* left for the loader */
    advance(l);
    assert_true(number(l, "held") > 0);
    assert_int_equal(live_move(l, h.hand, vec3_make(-1.5, 0.3, 0), &why), STATUS_OK);
    while (surface_low(s).x > -2.0)
        advance_playing(l);
    live_send(l, LIVE_OFF);
    advance(l);
    assert_true(s->meshes[TOY].time_s == 0.2 && !s->meshes[TOY].data);
    free(before);
    live_detach(l);
    live_destroy(l);
    scene_destroy(s);
}

static void a_changed_slime_restarts(void **state)
{
    (void)state;
    static const char *const others[] = {"toy.stiffness=30", "toy.level=1", "toy.gravity=0,1,0"};
    live *l = live_create(NULL, NULL);
    scene *s = scene_with(toys, "");
    attach(l, s);
    live_send(l, LIVE_PLAY);
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        while (number(l, "time_s") == 0.0)
            advance_playing(l);
        puller h = grab(l, 1.1, 0.1);
        assert_true(h.hand > 0);
        s = replace(l, s, others[i]);
        assert_true(number(l, "time_s") == 0.0);
        assert_true(flag(l, "playing"));
        diagnostic why = {.what = ""};
        assert_int_equal(live_move(l, h.hand, vec3_make(0, 0, 0), &why), STATUS_BAD_INPUT);
        advance(l);
        assert_true(number(l, "time_s") > 0.0);
    }
    s = replace(l, s, "pin.level=0 body.mesh=pin");
    assert_true(live_is_on(l)); /* the slime moves, although it is not rendered */
    live_detach(l);
    scene_destroy(s);
    s = scene_with("solids: {ball: {shape: sphere}}\n", "");
    attach(l, s);
    assert_false(live_is_on(l));
    json_t *nothing = live_json(l);
    assert_true(json_is_null(nothing));
    json_decref(nothing);
    live_detach(l);
    live_destroy(l);
    scene_destroy(s);
}

static void divergence_is_reported_until_restart(void **state)
{
    (void)state;
    live *l = live_create(NULL, NULL);
    scene *s = scene_with(toys, "toy.stiffness=1e7");
    attach(l, s);
    live_send(l, LIVE_PLAY);
    while (!is_troubled(l))
        advance(l);
    assert_false(flag(l, "playing"));
    assert_false(live_is_moving(l) || live_is_due(l));
    assert_false(advance(l));
    puller h = grab(l, 1, 0);
    assert_int_equal(h.code, STATUS_BAD_INPUT);
    live_send(l, LIVE_PLAY);
    advance(l);
    assert_true(number(l, "time_s") < 0.05);
    while (!is_troubled(l))
        advance(l);
    s = replace(l, s, "");
    assert_false(is_troubled(l));
    assert_true(flag(l, "playing"));
    advance(l);
    assert_true(number(l, "time_s") > 0.0);
    live_detach(l);
    live_destroy(l);
    scene_destroy(s);
}

static void put_script(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void a_script_plays_until_hands_interfere(void **state)
{
    (void)state;
    char path[] = "/tmp/cuvette_live_XXXXXX";
    const int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    put_script(path, "hands: {left: [{time_s: 0.02, grab: [-0.7, 0, -6], towards: [0, 0, 1], reach: 0.3}, {time_s: "
                     "0.1, move: [-0.8, 0, 0]}, {time_s: 0.6, release: on}]}\n");
    char *assignment = text_format("toy.script=%s", path);
    live *l = live_create(NULL, NULL);
    scene *s = scene_with(toys, assignment);
    attach(l, s);
    live_send(l, LIVE_PLAY);
    while (number(l, "time_s") < 0.55) {
        advance_playing(l);
        assert_true(live_is_moving(l)); /* never at rest before the script's end */
    }
    assert_true(surface_low(s).x < -1.5);
    live_detach(l);
    scene_destroy(s);
    free(assignment);
    put_script(path, "hands: {left: [{time_s: 0, grab: [-0.7, 0, -6], towards: [0, 0, 1], reach: 0.3}], right: "
                     "[{time_s: 0.1, grab: [7, 0, -6], towards: [0, 0, 1], reach: 0.3}]}\n");
    assignment = text_format("toy.script=%s toy.seed=2", path);
    s = scene_with(toys, assignment);
    attach(l, s);
    advance(l);
    assert_true(number(l, "held") > 0);
    while (number(l, "time_s") < 0.2)
        advance_playing(l);
    assert_false(is_troubled(l));
    assert_true(number(l, "held") == 0.0);
    live_detach(l);
    live_destroy(l);
    scene_destroy(s);
    free(assignment);
    unlink(path);
}

static void a_slime_that_cannot_start_reports_an_error(void **state)
{
    (void)state;
    live *l = live_create(NULL, NULL);
    scene *s = scene_with(toys, "toy.script=/nowhere/to/be/found.yaml");
    attach(l, s);
    live_send(l, LIVE_PLAY);
    assert_true(advance(l));
    assert_true(is_troubled(l));
    assert_false(live_is_moving(l) || live_is_due(l));
    live_detach(l);
    scene_destroy(s);
    s = scene_with(toys, "toy.script=/nowhere/to/be/found.yaml");
    diagnostic why = {.what = ""};
    assert_int_equal(live_attach(l, s, &why), STATUS_BAD_INPUT);
    assert_true(why.what[0] && is_troubled(l));
    s = replace(l, s, "");
    advance_playing(l);
    live_detach(l);
    live_destroy(l);
    scene_destroy(s);
}

static void waits_end_when_the_worker_ends(void **state)
{
    (void)state;
    live *l = live_create(NULL, NULL);
    scene *s = scene_with(toys, "");
    attach(l, s);
    live_send(l, LIVE_PLAY);
    advance(l);
    puller h = {.l = l, .origin = vec3_make(1, 0, -6), .direction = vec3_make(0, 0, 1)};
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, grab_there, &h), 0);
    live_stop(l);
    pthread_join(thread, NULL);
    assert_int_equal(h.code, STATUS_INTERRUPTED);
    advance(l); /* no request is left */
    assert_true(number(l, "held") == 0.0);
    live_detach(l);
    live_destroy(l);
    scene_destroy(s);
}

/* Commands from many threads while the snapshot is replaced again and again. */
static void *send_commands(void *of)
{
    puller *h = of;
    diagnostic why;
    for (int i = 0; i < 50; i++) {
        live_grab(h->l, h->origin, h->direction, 0.3, &h->hand, &h->where, &h->why);
        live_move(h->l, h->hand, vec3_make(0.1 * (i % 5), 0, 0), &why);
        json_decref(live_json(h->l));
        if (i % 10 == 9)
            live_send(h->l, LIVE_RESTART);
        live_release(h->l, h->hand, &why);
    }
    atomic_store(&h->done, true);
    live_stop(h->l);
    return NULL;
}

static void many_threads_may_send_commands(void **state)
{
    (void)state;
    enum { THREADS = 4 };
    live *l = live_create(NULL, NULL);
    scene *s = scene_with(toys, "");
    attach(l, s);
    live_send(l, LIVE_PLAY);
    puller h[THREADS];
    pthread_t threads[THREADS];
    for (int i = 0; i < THREADS; i++) {
        h[i] = (puller){.l = l, .origin = vec3_make(0.7 + 0.2 * i, 0, -6), .direction = vec3_make(0, 0, 1)};
        assert_int_equal(pthread_create(&threads[i], NULL, send_commands, &h[i]), 0);
    }
    for (int turn = 0; !atomic_load(&h[0].done); turn++) {
        advance(l);
        if (turn % 7 == 6)
            s = replace(l, s, turn % 2 ? "toy.stiffness=20" : "jelly.ior=1.4");
    }
    for (int i = 0; i < THREADS; i++)
        pthread_join(threads[i], NULL);
    diagnostic why = {.what = ""};
    live_release(l, LIVE_ALL, &why);
    advance(l);
    assert_true(number(l, "held") == 0.0);
    live_detach(l);
    live_destroy(l);
    scene_destroy(s);
}

/* The document may already have a slime, and a command to play it, while the worker still attaches the previous
 * scene. */
static void a_command_for_a_future_slime_is_kept(void **state)
{
    (void)state;
    static const char bare[] = "camera: {position: [0, 0, -6], target: [0, 0, 0]}\n";
    live *l = live_create(NULL, NULL);
    scene *s = scene_with(bare, ""), *next = scene_with(toys, "");
    live_send(l, LIVE_PLAY);
    attach(l, s);
    live_detach(l);
    attach(l, next);
    assert_true(live_is_on(l));
    advance(l);
    assert_true(flag(l, "playing"));
    assert_true(number(l, "time_s") > 0.0);
    live_detach(l);
    scene_destroy(next);
    attach(l, s); /* without a slime no command is pending */
    assert_false(live_is_on(l));
    live_detach(l);
    live_destroy(l);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slime_is_off_until_played),
        cmocka_unit_test(the_simulation_plays_pauses_and_restarts),
        cmocka_unit_test(a_pulled_slime_stretches_and_recovers),
        cmocka_unit_test(a_hand_wakes_a_resting_slime),
        cmocka_unit_test(rest_is_detected_over_several_samples),
        cmocka_unit_test(unrelated_changes_keep_the_slimes_shape),
        cmocka_unit_test(a_changed_slime_restarts),
        cmocka_unit_test(divergence_is_reported_until_restart),
        cmocka_unit_test(a_script_plays_until_hands_interfere),
        cmocka_unit_test(a_slime_that_cannot_start_reports_an_error),
        cmocka_unit_test(waits_end_when_the_worker_ends),
        cmocka_unit_test(many_threads_may_send_commands),
        cmocka_unit_test(a_command_for_a_future_slime_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
