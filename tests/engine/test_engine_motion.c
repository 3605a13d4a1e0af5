/* Tests of motions through cuvette.h: the film is that of the scene at the motion's time, hands act like those of a
 * script, picks agree with the rays of a query. tests/softbody/test_softbody.c tests the simulation itself. */
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "cuvette.h"
#include "engine/engine_private.h"
#include "engine_fixture.h"

static const char toys[] =
    "render: {width: 40, height: 30, depth: 5, threads: 2}\n"
    "camera: {position: [0, 2, -5], target: [0, 0.8, 0]}\n"
    "background: {kind: gradient, color: [0.2, 0.4, 0.9], horizon: [0.9, 0.8, 0.6]}\n"
    "lights: {lamp: {position: [3, 6, -4]}}\n"
    "meshes:\n"
    "  pin: {generate: icosphere, level: 1}\n"
    "  toy: {generate: slime, level: 3, position: [-0.6, 1.1, 0], radius: 0.9, time_s: 0.4}\n"
    "  drop: {generate: slime, level: 1, position: [0, 0.7, 0], radius: 0.5, dt_s: 0.0025, velocity: [-1, 0, 0]}\n"
    "solids:\n"
    "  ground: {shape: plane, diffuse: 0.7, checker: 0.5}\n"
    "  jelly: {shape: mesh, mesh: toy, transparency: 0.9, ior: 1.3, priority: 1}\n"
    "  far: {shape: mesh, mesh: drop, diffuse: 0.8, position: [1.5, 0.5, 2.5], rotation: [20, 130, -40], scale: [0.5, "
    "1.5, 0.8], priority: 2,\n"
    "        copies: [2, 1, 2], spacing: [1.2, 0, 1.7]}\n"
    "  near: {shape: mesh, mesh: drop, diffuse: 0.8, position: [1.5, 0.5, -1.5], priority: 3}\n"
    "  needle: {shape: mesh, mesh: pin, diffuse: 0.8, scale: [0.2, 0.2, 0.2], position: [0, 0.2, -1.5], priority: 4}\n";

static cuvette_scene *scene_of(const char *text)
{
    cuvette_diagnostic why;
    cuvette_scene *s;
    fine(cuvette_scene_read_text("test.yaml", text, strlen(text), &s, &why), &why);
    return s;
}

static uint64_t film_of(const cuvette_scene *s)
{
    cuvette_diagnostic why;
    cuvette_engine *engine;
    cuvette_frame *frame;
    fine(cuvette_engine_create(NULL, &engine, &why), &why);
    fine(cuvette_engine_render(engine, s, NULL, &frame, &why), &why);
    const uint64_t hash = cuvette_frame_hash(frame);
    cuvette_frame_destroy(frame);
    cuvette_engine_destroy(engine);
    return hash;
}

/* script: NULL for none */
static uint64_t film_afresh(double time_s, const char *script)
{
    cuvette_diagnostic why;
    cuvette_scene *s = scene_of(toys);
    fine(cuvette_scene_set_double(s, "toy.time_s", time_s, &why), &why);
    fine(cuvette_scene_set_double(s, "drop.time_s", time_s, &why), &why);
    if (script)
        turn(s, "toy.script", script);
    const uint64_t hash = film_of(s);
    cuvette_scene_destroy(s);
    return hash;
}

static cuvette_motion *begin(cuvette_scene *s)
{
    cuvette_diagnostic why;
    cuvette_motion *m;
    fine(cuvette_motion_create(s, &m, &why), &why);
    return m;
}

static void advance(cuvette_motion *m, double time_s)
{
    cuvette_diagnostic why;
    fine(cuvette_motion_advance(m, time_s, &why), &why);
}

static cuvette_slime state_of(const cuvette_motion *m, const char *name)
{
    cuvette_diagnostic why;
    cuvette_slime state = {.size = sizeof state};
    fine(cuvette_motion_state(m, name, &state, &why), &why);
    return state;
}

static cuvette_ray ray_of(double x, double y, double z, double dx, double dy, double dz)
{
    return (cuvette_ray){.origin = {x, y, z}, .direction = {dx, dy, dz}};
}

static int grab(cuvette_motion *m, const char *name, cuvette_ray ray, double reach)
{
    cuvette_diagnostic why;
    int hand = -7;
    fine(cuvette_motion_grab(m, name, &ray, reach, &hand, NULL, &why), &why);
    return hand;
}

static double distance_to(const cuvette_motion *m, const char *name, cuvette_ray ray, double *where)
{
    cuvette_diagnostic why;
    double distance = -1;
    fine(cuvette_motion_pick(m, name, &ray, where, &distance, &why), &why);
    return distance;
}

static void expect_ended(cuvette_motion *m, const char *because)
{
    cuvette_diagnostic why;
    cuvette_slime state = {.size = sizeof state};
    const cuvette_ray ray = ray_of(-0.6, 1, -6, 0, 0, 1);
    int hand;
    double distance;
    assert_int_equal(cuvette_motion_advance(m, 0.5, &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.what, because));
    assert_int_equal(cuvette_motion_state(m, "toy", &state, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_pick(m, "toy", &ray, NULL, &distance, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_grab(m, "toy", &ray, 0.1, &hand, NULL, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_release(m, 0, &why), CUVETTE_BAD_INPUT);
    assert_true(cuvette_motion_count(m) == 0 && !cuvette_motion_name(m, 0));
    cuvette_motion_destroy(m);
}

static void the_film_is_that_of_the_scene_at_the_motions_time(void **state)
{
    (void)state;
    static const double moments[] = {0.0, 0.1, 0.15, 0.15, 0.5};
    cuvette_diagnostic why;
    cuvette_scene *s = scene_of(toys);
    double time_s;
    film_of(s); /* the toy at 0.4 s, after which it moves on */
    cuvette_motion *m = begin(s);
    assert_int_equal((int)cuvette_motion_count(m), 2);
    assert_string_equal(cuvette_motion_name(m, 0), "toy");
    assert_string_equal(cuvette_motion_name(m, 1), "drop");
    assert_null(cuvette_motion_name(m, 2));
    assert_true(film_of(s) == film_afresh(0.0, NULL));
    for (size_t i = 0; i < sizeof moments / sizeof *moments; i++) {
        advance(m, moments[i]);
        assert_true(film_of(s) == film_afresh(moments[i], NULL));
        fine(cuvette_scene_get_double(s, "toy.time_s", &time_s, &why), &why);
        assert_true(time_s == moments[i]);
    }
    cuvette_motion_destroy(m);
    assert_true(film_of(s) == film_afresh(0.5, NULL)); /* in its current shape */
    cuvette_scene_destroy(s);
}

/* Start, target and times of the hand: in a script, and by calls. */
static void hands_are_bit_identical_to_a_script(void **state)
{
    (void)state;
    static const char text[] = "hands:\n  left:\n"
                               "    - {time_s: 0.1, grab: [-1.1, 0.9, -6], towards: [0, 0, 1], reach: 0.3}\n"
                               "    - {time_s: 0.2, move: [-0.4, 0.3, -0.1]}\n"
                               "    - {time_s: 0.3, move: [0.1, 0.5, 0.0]}\n"
                               "    - {time_s: 0.35, release: on}\n";
    char path[] = "/tmp/cuvette-motion-XXXXXX";
    const int file = mkstemp(path);
    assert_true(file >= 0 && write(file, text, sizeof text - 1) == (ssize_t)(sizeof text - 1) && close(file) == 0);
    cuvette_diagnostic why;
    cuvette_scene *s = scene_of(toys);
    cuvette_motion *m = begin(s);
    advance(m, 0.1);
    const int hand = grab(m, "jelly", ray_of(-1.1, 0.9, -6, 0, 0, 1), 0.3);
    assert_int_equal(hand, 0);
    assert_true(state_of(m, "toy").held > 3);
    fine(cuvette_motion_move(m, hand, (const double[]){-0.4, 0.3, -0.1}, &why), &why);
    advance(m, 0.2);
    assert_true(film_of(s) == film_afresh(0.2, path));
    assert_true(film_of(s) != film_afresh(0.2, NULL));
    fine(cuvette_motion_move(m, hand, (const double[]){7, 7, 7}, &why), &why); /* the hand changes its target */
    fine(cuvette_motion_move(m, hand, (const double[]){0.1, 0.5, 0.0}, &why), &why);
    advance(m, 0.3);
    assert_true(film_of(s) == film_afresh(0.3, path));
    advance(m, 0.35);
    fine(cuvette_motion_release(m, hand, &why), &why);
    assert_int_equal(cuvette_motion_release(m, hand, &why), CUVETTE_BAD_INPUT);
    assert_true(state_of(m, "toy").held == 0);
    advance(m, 0.45);
    assert_true(film_of(s) == film_afresh(0.45, path));
    cuvette_motion_destroy(m);
    cuvette_scene_destroy(s);
    unlink(path);
}

/* A pick finds the same point as the camera on a solid that is translated, scaled unequally, rotated and copied. */
static void picks_agree_with_ray_hits(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s = scene_of(toys);
    cuvette_motion *m = begin(s);
    advance(m, 0.2);
    unsigned copies = 0;
    for (int moment = 0; moment < 2; moment++) {
        cuvette_query *q;
        int hits = 0;
        fine(cuvette_query_create(s, NULL, &q, &why), &why);
        for (int i = 0; i < 40 * 30; i++) {
            cuvette_ray ray;
            cuvette_hit hit;
            double where[3];
            fine(cuvette_query_camera_ray(q, i % 40 + 0.5, i / 40 + 0.5, &ray, &why), &why);
            fine(cuvette_query_nearest(q, &ray, 1, &hit, &why), &why);
            if (hit.solid != 1 && hit.solid != 2 && hit.solid != 3)
                continue;
            hits++;
            copies |= hit.solid == 2 ? 1U << hit.copy : 0;
            const double distance = distance_to(m, cuvette_scene_name(s, CUVETTE_SOLID, (size_t)hit.solid), ray, where);
            assert_true(fabs(distance - hit.distance) < 1e-12 * hit.distance);
            for (int k = 0; k < 3; k++)
                assert_true(fabs(where[k] - hit.point[k]) < 1e-12 * hit.distance);
        }
        assert_true(hits > 50);
        cuvette_query_destroy(q);
        const int hand = grab(m, "far", ray_of(1.5, 9, 2.5, 0, -1, 0), 0.3);
        if (hand >= 0)
            fine(cuvette_motion_move(m, hand, (const double[]){0, 0.2, 0}, &why), &why);
        advance(m, 0.3);
        turn(s, "camera.position", "2,7,7"); /* from behind */
        turn(s, "camera.target", "1,0.5,2");
    }
    assert_int_equal((int)copies, 0xb); /* along x, and along both; the one along z is hidden */
    cuvette_motion_destroy(m);
    cuvette_scene_destroy(s);
}

static void picking_a_mesh_finds_the_nearest_of_its_solids(void **state)
{
    (void)state;
    cuvette_scene *s = scene_of(toys);
    cuvette_motion *m = begin(s);
    cuvette_ray ray = ray_of(1.5, 1.2, -9, 0, 0, 3);
    const double near = distance_to(m, "near", ray, NULL);
    assert_true(fabs(near - (9 - 1.5 - 0.5)) < 0.2);
    assert_true(distance_to(m, "drop", ray, NULL) == near);
    turn(s, "near.visible", "off");
    assert_true(distance_to(m, "near", ray, NULL) == near); /* picked by name */
    assert_true(distance_to(m, "drop", ray, NULL) == distance_to(m, "far", ray, NULL));
    ray.reach = near * 0.999;
    assert_true(isinf(distance_to(m, "near", ray, NULL)));
    ray.reach = near * 1.001;
    assert_true(distance_to(m, "near", ray, NULL) == near);
    cuvette_motion_destroy(m);
    cuvette_scene_destroy(s);
}

static void a_miss_grabs_nothing(void **state)
{
    (void)state;
    cuvette_scene *s = scene_of(toys);
    cuvette_motion *m = begin(s);
    double where[3] = {1, 2, 3};
    const cuvette_ray past = ray_of(0, 5, -6, 0, 0, 1), from_inside = ray_of(-0.6, 1.1, 0, 0, 0, 1),
                      away = ray_of(-0.6, 1.1, -6, 0, 0, -1);
    assert_true(isinf(distance_to(m, "toy", past, where)) && where[0] == 1 && where[1] == 2 && where[2] == 3);
    assert_true(isinf(distance_to(m, "toy", from_inside, where)));
    assert_true(isinf(distance_to(m, "jelly", away, where)));
    assert_int_equal(grab(m, "jelly", past, 0.5), CUVETTE_NO_HAND);
    assert_true(state_of(m, "jelly").held == 0);
    cuvette_motion_destroy(m);
    cuvette_scene_destroy(s);
}

/* A body that is held completely follows the hand: by R^T by / scale in its own frame. Half a turn about y maps x, y, z
 * to -x, y, -z. */
static void held_masses_follow_the_hand(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s = scene_of(
        "meshes: {toy: {generate: slime, level: 3, gravity: [0, 0, 0], ground: off}}\n"
        "solids: {body: {shape: mesh, mesh: toy, position: [10, 2, 3], rotation: [0, 180, 0], scale: [2, 4, 2]}}\n");
    cuvette_motion *m = begin(s);
    const cuvette_slime before = state_of(m, "body");
    assert_true(before.masses == 642 && before.held == 0 && before.time_s == 0.0 && before.steps == 0);
    assert_true(fabs(before.volume / (4.0 / 3.0 * 3.14159265358979) - 1.0) < 0.01 &&
                fabs(before.volume / before.volume_at_rest - 1.0) < 1e-12);
    assert_true(fabs(before.high - before.low - 2.0) < 0.02 && before.kinetic == 0.0);
    double where[3];
    assert_true(fabs(distance_to(m, "body", ray_of(10, 2 + 4 * before.center[1], -7, 0, 0, 1), where) - 8.0) < 0.05);
    assert_true(fabs(where[2] - 1.0) < 0.05);
    const int part = grab(m, "body", ray_of(10, 2 + 4 * before.center[1], -7, 0, 0, 1), 1.0);
    const uint64_t in_a_quarter = state_of(m, "toy").held; /* the largest scale is 4 */
    assert_true(in_a_quarter > 1 && in_a_quarter < 642 / 16);
    fine(cuvette_motion_release(m, part, &why), &why);
    const int hand = grab(m, "body", ray_of(10, 2 + 4 * before.center[1], -7, 0, 0, 1), 100.0);
    assert_true(state_of(m, "toy").held == 642);
    fine(cuvette_motion_move(m, hand, (const double[]){1.0, 0.5, -3.0}, &why), &why);
    advance(m, 0.25);
    const cuvette_slime half = state_of(m, "body");
    assert_true(fabs(half.center[0] - before.center[0] + 0.5) < 1e-9);
    assert_true(fabs(half.center[1] - before.center[1] - 0.125) < 1e-9);
    assert_true(fabs(half.center[2] - before.center[2] - 1.5) < 1e-9);
    /* uniformly, over the whole distance */
    assert_true(fabs(half.speed_max - sqrt(0.25 + 0.125 * 0.125 + 2.25) / 0.25) < 1e-6);
    advance(m, 0.5); /* and stays there */
    assert_true(state_of(m, "body").speed_max < 1e-9);
    assert_true(fabs(state_of(m, "body").center[2] - half.center[2]) < 1e-9);
    cuvette_motion_destroy(m);
    cuvette_scene_destroy(s);
}

static void a_slime_has_at_most_sixteen_hands(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s = scene_of(toys);
    cuvette_motion *m = begin(s);
    const cuvette_ray ray = ray_of(-0.6, 1.1, -6, 0, 0, 1), other = ray_of(1.5, 1.2, -9, 0, 0, 1);
    int hands[16], more = -7;
    for (int i = 0; i < 16; i++) {
        hands[i] = grab(m, "toy", ray, 1e-3);
        for (int k = 0; k < i; k++)
            assert_int_not_equal(hands[i], hands[k]);
    }
    assert_int_equal(cuvette_motion_grab(m, "toy", &ray, 1e-3, &more, NULL, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(more, -7);
    const int of_drop = grab(m, "near", other, 0.1);
    assert_true(of_drop >= 0 && state_of(m, "drop").held > 0 && state_of(m, "toy").held == 16);
    fine(cuvette_motion_release(m, hands[3], &why), &why);
    assert_true(state_of(m, "toy").held == 15);
    assert_int_equal(grab(m, "toy", ray, 1e-3), hands[3]);
    cuvette_motion_destroy(m);
    cuvette_scene_destroy(s);
}

static void errors_are_reported(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s = scene_of(toys), *still = scene_of("meshes: {pin: {generate: icosphere}}\n");
    cuvette_motion *m = (cuvette_motion *)&why;
    const cuvette_ray ray = ray_of(-0.6, 1.1, -6, 0, 0, 1), nowhere = ray_of(0, 0, 0, 0, 0, 0),
                      beyond = ray_of(2e6, 0, 0, 1, 0, 0);
    double distance;
    int hand;
    cuvette_slime body = {.size = 0};
    assert_int_equal(cuvette_motion_create(s, NULL, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_create(NULL, &m, &why), CUVETTE_BAD_INPUT);
    assert_null(m);
    assert_int_equal(cuvette_motion_create(still, &m, &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.remedy, "slime"));
    assert_null(m);
    m = begin(s);
    assert_int_equal(cuvette_motion_advance(NULL, 1, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_advance(m, (double)NAN, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_advance(m, -0.1, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_advance(m, 1e6, NULL), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_state(NULL, "toy", &body, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_state(m, NULL, &body, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_state(m, "toy", NULL, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_state(m, "toy", &body, &why), CUVETTE_BAD_INPUT); /* its size is not set */
    body.size = sizeof body;
    static const char *const no_slimes[] = {"pin", "needle", "ground", "lamp", "camera", "nobody", ""};
    for (size_t i = 0; i < sizeof no_slimes / sizeof *no_slimes; i++)
        assert_int_equal(cuvette_motion_state(m, no_slimes[i], &body, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_pick(NULL, "toy", &ray, NULL, &distance, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_pick(m, NULL, &ray, NULL, &distance, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_pick(m, "toy", NULL, NULL, &distance, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_pick(m, "toy", &ray, NULL, NULL, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_pick(m, "toy", &nowhere, NULL, &distance, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_pick(m, "toy", &beyond, NULL, &distance, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_grab(NULL, "toy", &ray, 1, &hand, NULL, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_grab(m, "toy", &ray, 1, NULL, NULL, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_grab(m, "toy", &ray, 0, &hand, NULL, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_grab(m, "toy", &ray, (double)NAN, &hand, NULL, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_move(m, 0, (const double[]){0, 0, 0}, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_release(m, -1, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_release(m, 32, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_release(NULL, 0, &why), CUVETTE_BAD_INPUT);
    hand = grab(m, "toy", ray, 0.2);
    assert_int_equal(cuvette_motion_move(NULL, hand, (const double[]){0, 0, 0}, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_move(m, hand, NULL, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_motion_move(m, hand, (const double[]){0, (double)NAN, 0}, &why), CUVETTE_BAD_INPUT);
    fine(cuvette_motion_release(m, hand, &why), &why);
    advance(m, 0.1);
    assert_int_equal(cuvette_motion_advance(m, 0.09, &why), CUVETTE_BAD_INPUT);
    assert_true(film_of(s) == film_afresh(0.1, NULL)); /* the refused calls had no effect */
    assert_true(cuvette_motion_count(NULL) == 0 && !cuvette_motion_name(NULL, 0));
    cuvette_motion_destroy(m);
    cuvette_motion_destroy(NULL);
    cuvette_scene_destroy(s);
    cuvette_scene_destroy(still);
}

static void a_motion_ends_when_its_slimes_change(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s = scene_of(toys);
    cuvette_motion *m = begin(s);
    turn(s, "camera.position", "0,2,-4"); /* everything else may change */
    turn(s, "toy.time_s", "0.3");
    expect_ended(m, "out of date");
    m = begin(s);
    assert_int_equal(cuvette_scene_set(s, "toy.stiffness", "-1", &why), CUVETTE_BAD_INPUT); /* nothing was changed */
    turn(s, "jelly.position", "0,0,1");
    turn(s, "pin.level", "2");
    fine(cuvette_scene_rename(s, "toy", "goo", &why), &why);
    fine(cuvette_scene_add_mesh(s, "more", &why), &why);
    turn(s, "more.generate", "torus");
    advance(m, 0.1);
    assert_true(state_of(m, "goo").steps == 100);
    fine(cuvette_scene_remove(s, "needle", &why), &why);
    advance(m, 0.2);
    fine(cuvette_scene_remove(s, "pin", &why), &why); /* the indices of later meshes change */
    expect_ended(m, "out of date");
    m = begin(s);
    turn(s, "more.generate", "slime");
    expect_ended(m, "out of date");
    m = begin(s);
    turn(s, "goo.generate", "sphere");
    expect_ended(m, "out of date");
    m = begin(s);
    cuvette_motion *second = begin(s);
    expect_ended(m, "another motion");
    advance(second, 0.1);
    cuvette_motion_destroy(second);
    cuvette_scene_destroy(s);
}

static void motion_and_scene_are_released_in_any_order(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s = scene_of(toys), *copy;
    cuvette_motion *m = begin(s);
    advance(m, 0.1);
    fine(cuvette_scene_clone(s, &copy, &why), &why);
    cuvette_motion *other = begin(copy); /* the clone's own slimes, from their initial state */
    advance(m, 0.2);
    assert_true(film_of(copy) == film_afresh(0.0, NULL));
    cuvette_scene_destroy(s);
    expect_ended(m, "destroyed");
    advance(other, 0.3);
    assert_true(film_of(copy) == film_afresh(0.3, NULL));
    cuvette_scene_destroy(copy);
    cuvette_motion_destroy(other);
}

static void a_motion_ends_when_a_slime_is_unstable(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s = scene_of(toys);
    turn(s, "toy.stiffness", "1e7");
    turn(s, "toy.dt_s", "0.1");
    cuvette_motion *m = begin(s);
    assert_int_equal(cuvette_motion_advance(m, 10.0, &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.what, "toy"));
    expect_ended(m, "failed");
    m = begin(s); /* the same with a moving hand */
    const int hand = grab(m, "toy", ray_of(-0.6, 1.1, -6, 0, 0, 1), 0.1);
    fine(cuvette_motion_move(m, hand, (const double[]){0, 1, 0}, &why), &why);
    assert_int_equal(cuvette_motion_advance(m, 10.0, &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.what, "toy: the simulation diverged"));
    expect_ended(m, "failed");
    cuvette_scene_destroy(s);
}

typedef struct watcher {
    cuvette_scene *s;
    cuvette_motion *m;
    int calls;
} watcher;

static bool try_while_rendering(void *context, double share)
{
    watcher *w = context;
    cuvette_diagnostic why;
    cuvette_motion *second;
    if (share > 0.0 || w->calls > 0) /* before the first ray it is called as often as it takes */
        return true;
    assert_int_equal(cuvette_motion_advance(w->m, 1.0, &why), CUVETTE_BUSY);
    assert_int_equal(cuvette_motion_create(w->s, &second, &why), CUVETTE_BUSY);
    assert_null(second);
    assert_true(grab(w->m, "toy", ray_of(-0.6, 1.1, -6, 0, 0, 1), 0.1) >= 0); /* takes effect in the next advance */
    assert_true(state_of(w->m, "toy").held > 0);
    w->calls++;
    return true;
}

static void objects_in_use_return_busy(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    watcher w = {.s = scene_of(toys)};
    w.m = begin(w.s);
    cuvette_request request = CUVETTE_REQUEST;
    request.progress = try_while_rendering, request.context = &w;
    cuvette_engine *engine;
    fine(cuvette_engine_create(NULL, &engine, &why), &why);
    fine(cuvette_engine_render(engine, w.s, &request, NULL, &why), &why);
    assert_true(w.calls >= 1);

    const cuvette_ray ray = ray_of(-0.6, 1.1, -6, 0, 0, 1);
    cuvette_slime body = {.size = sizeof body};
    double distance;
    int hand;
    assert_int_equal(engine_begin_advance(w.s, &why), CUVETTE_OK); /* as if another thread were in an advance */
    assert_int_equal(cuvette_engine_render(engine, w.s, NULL, NULL, &why), CUVETTE_BUSY);
    assert_int_equal(cuvette_scene_set(w.s, "render.depth", "1", &why), CUVETTE_BUSY);
    assert_int_equal(cuvette_motion_advance(w.m, 1.0, &why), CUVETTE_BUSY);
    assert_int_equal(cuvette_motion_state(w.m, "toy", &body, &why), CUVETTE_BUSY);
    assert_int_equal(cuvette_motion_pick(w.m, "toy", &ray, NULL, &distance, &why), CUVETTE_BUSY);
    assert_int_equal(cuvette_motion_grab(w.m, "toy", &ray, 1.0, &hand, NULL, &why), CUVETTE_BUSY);
    assert_int_equal(cuvette_motion_release(w.m, 0, &why), CUVETTE_BUSY);
    engine_end_advance(w.s);
    fine(cuvette_engine_render(engine, w.s, NULL, NULL, &why), &why); /* neither remains locked */
    fine(cuvette_motion_release(w.m, 0, &why), &why);
    advance(w.m, 0.1);
    assert_true(film_of(w.s) == film_afresh(0.1, NULL));
    cuvette_engine_destroy(engine);
    cuvette_motion_destroy(w.m);
    cuvette_scene_destroy(w.s);
}

static void *move_one(void *context)
{
    uint64_t *hashes = context;
    cuvette_scene *s = scene_of(toys);
    cuvette_motion *m = begin(s);
    for (int i = 0; i < 4; i++) {
        advance(m, 0.05 * (i + 1));
        hashes[i] = film_of(s);
    }
    cuvette_motion_destroy(m);
    cuvette_scene_destroy(s);
    return NULL;
}

static void two_motions_do_not_affect_each_other(void **state)
{
    (void)state;
    uint64_t hashes[2][4];
    pthread_t threads[2];
    for (int i = 0; i < 2; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, move_one, hashes[i]), 0);
    for (int i = 0; i < 2; i++)
        pthread_join(threads[i], NULL);
    for (int i = 0; i < 4; i++)
        assert_true(hashes[0][i] == hashes[1][i] && hashes[0][i] == film_afresh(0.05 * (i + 1), NULL));
}

/* Stops at the call of that number, from 1, and tries a clone, which a lock held by the caller must allow. */
typedef struct patience {
    const cuvette_scene *of;
    int calls, most;
    double share;
} patience;

static bool be_patient(void *context, double share)
{
    patience *p = context;
    cuvette_scene *clone;
    cuvette_diagnostic why;
    fine(cuvette_scene_clone(p->of, &clone, &why), &why);
    cuvette_scene_destroy(clone);
    assert_true(share >= p->share && share <= 1);
    p->share = share;
    return ++p->calls < p->most;
}

static void loading_stops_and_continues(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s = scene_of(toys);
    cuvette_engine *engine;
    cuvette_frame *frame = NULL;
    fine(cuvette_scene_set(s, "toy.time_s", "2000", &why), &why);
    patience p = {.of = s, .most = 2};
    assert_int_equal(cuvette_scene_load(s, be_patient, &p, &why), CUVETTE_CANCELLED);
    assert_int_equal(p.calls, 2);
    cuvette_request request = CUVETTE_REQUEST;
    p = (patience){.of = s, .most = 3};
    request.progress = be_patient, request.context = &p;
    fine(cuvette_engine_create(NULL, &engine, &why), &why);
    assert_int_equal(cuvette_engine_render(engine, s, &request, &frame, &why), CUVETTE_CANCELLED);
    assert_true(p.calls == 3 && p.share == 0 && !frame);
    cuvette_engine_destroy(engine);
    turn(s, "toy.time_s", "0.4");
    fine(cuvette_scene_load(s, NULL, NULL, &why), &why);
    turn(s, "drop.time_s", "0.4");
    assert_true(film_of(s) == film_afresh(0.4, NULL));
    cuvette_scene_destroy(s);
}

static void an_advance_stops_and_continues(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s = scene_of(toys);
    cuvette_motion *m = begin(s);
    const uint64_t at_rest = film_of(s);
    patience p = {.of = s, .most = 1};
    assert_int_equal(cuvette_motion_advance_watched(m, 2000, be_patient, &p, &why), CUVETTE_CANCELLED);
    const double reached_s = state_of(m, "toy").time_s;
    assert_true(reached_s > 0 && reached_s < 100 && state_of(m, "drop").time_s == 0);
    assert_true(film_of(s) == at_rest);
    assert_int_equal(cuvette_motion_advance(m, 0, &why), CUVETTE_BAD_INPUT);
    advance(m, reached_s + 0.1);
    assert_true(film_of(s) == film_afresh(reached_s + 0.1, NULL));
    cuvette_motion_destroy(m);
    cuvette_scene_destroy(s);
}

/* A hand that is stopped on its way stays there, and goes on from there. */
static void a_hand_stops_on_its_way(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s = scene_of(toys);
    cuvette_motion *m = begin(s);
    const cuvette_ray down = {.origin = {-0.6, 9, 0}, .direction = {0, -1, 0}};
    const int hand = grab(m, "toy", down, 0.2);
    const double from = state_of(m, "toy").high;
    fine(cuvette_motion_move(m, hand, (const double[]){0, 0.5, 0}, &why), &why);
    patience p = {.of = s, .most = 1};
    assert_int_equal(cuvette_motion_advance_watched(m, 60, be_patient, &p, &why), CUVETTE_CANCELLED);
    const cuvette_slime between = state_of(m, "toy");
    assert_true(between.time_s > 0 && between.time_s < 30 && between.high < from + 0.3);
    advance(m, between.time_s + 0.5);
    assert_true(fabs(state_of(m, "toy").high - (from + 0.5)) < 0.05);
    cuvette_motion_destroy(m);
    cuvette_scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_film_is_that_of_the_scene_at_the_motions_time),
        cmocka_unit_test(hands_are_bit_identical_to_a_script),
        cmocka_unit_test(picks_agree_with_ray_hits),
        cmocka_unit_test(picking_a_mesh_finds_the_nearest_of_its_solids),
        cmocka_unit_test(a_miss_grabs_nothing),
        cmocka_unit_test(held_masses_follow_the_hand),
        cmocka_unit_test(a_slime_has_at_most_sixteen_hands),
        cmocka_unit_test(errors_are_reported),
        cmocka_unit_test(a_motion_ends_when_its_slimes_change),
        cmocka_unit_test(motion_and_scene_are_released_in_any_order),
        cmocka_unit_test(a_motion_ends_when_a_slime_is_unstable),
        cmocka_unit_test(objects_in_use_return_busy),
        cmocka_unit_test(two_motions_do_not_affect_each_other),
        cmocka_unit_test(loading_stops_and_continues),
        cmocka_unit_test(an_advance_stops_and_continues),
        cmocka_unit_test(a_hand_stops_on_its_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
