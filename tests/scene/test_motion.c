/* Tests of a moving scene, and of script files. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "bad_files.h"
#include "base/cancel.h"
#include "base/hash.h"
#include "render_fixture.h"
#include "scene/assets/slime.h"
#include "scene/model/scene.h"
#include "scene/motion/motion_hands.h"

/* A moving scene: its film at each time equals that of the scene loaded with that time_s for its slimes. */

static const char toys[] =
    "render: {width: 64, height: 48, depth: 3}\n"
    "camera: {position: [0, 2, -6], target: [0, 1, 0]}\n"
    "background: {kind: gradient, color: [0.2, 0.4, 0.9], horizon: [0.9, 0.8, 0.6], ambient: [0.2, 0.2, 0.2]}\n"
    "lights: {lamp: {position: [3, 6, -4]}}\n"
    "meshes:\n"
    "  pin: {generate: icosphere, level: 1}\n"
    "  toy: {generate: slime, level: 2, position: [-0.6, 1.1, 0], radius: 0.9, time_s: 0.4}\n"
    "  drop: {generate: slime, level: 1, position: [1.2, 1.5, 0.3], radius: 0.5, dt_s: 0.0025, velocity: [-1, 0, 0]}\n"
    "solids:\n"
    "  ground: {shape: plane, diffuse: 0.7, ambient: 0.1, checker: 0.5}\n"
    "  jelly: {shape: mesh, mesh: toy, transparency: 0.9, ior: 1.3, specular: 0.5, priority: 1}\n"
    "  ball: {shape: mesh, mesh: drop, diffuse: 0.8, color: [0.9, 0.3, 0.2], priority: 2}\n"
    "  needle: {shape: mesh, mesh: pin, diffuse: 0.8, scale: [0.2, 0.2, 0.2], position: [0, 0.2, -1.5], priority: 3}\n";

static const double moments[] = {0.0, 0.1, 0.15, 0.15, 0.3, 0.6};
enum { MOMENTS = sizeof moments / sizeof *moments };

static scene *toys_with(const char *assignments)
{
    scene *s = scene_from(toys);
    set_all(s, assignments);
    return s;
}

static uint64_t film_of(const scene *s)
{
    render_result *result = render(s);
    const uint64_t hash = film_hash(result->img);
    render_result_destroy(result);
    return hash;
}

static uint64_t film_afresh(const char *assignments, double time_s)
{
    scene *s = toys_with(assignments);
    char text[128];
    snprintf(text, sizeof text, "toy.time_s=%.17g drop.time_s=%.17g", time_s, time_s);
    set_all(s, text);
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    const uint64_t hash = film_of(s);
    scene_destroy(s);
    return hash;
}

static scene_motion *begin(scene *s)
{
    scene_motion *m = NULL;
    diagnostic why = {0};
    worked(scene_motion_create(s, &m, &why), &why);
    return m;
}

static void advance(scene_motion *m, double time_s, bool surfaces)
{
    diagnostic why = {0};
    worked(scene_motion_advance(m, time_s, surfaces, &why), &why);
}

static void expect_films(const char *assignments)
{
    scene *s = toys_with(assignments);
    scene_motion *m = begin(s);
    uint64_t before = 0;
    for (size_t i = 0; i < MOMENTS; i++) {
        advance(m, moments[i], true);
        const uint64_t seen = film_of(s);
        if (seen != film_afresh(assignments, moments[i]))
            fail_msg("%s: another film at %g s", assignments, moments[i]);
        assert_true((seen == before) == (i > 0 && moments[i] == moments[i - 1])); /* the film changes */
        before = seen;
    }
    scene_motion_destroy(m);
    scene_destroy(s);
}

static void the_film_is_that_of_the_scene_loaded_at_its_time(void **state)
{
    (void)state;
    static const char *const settings[] = {
        "render.threads=1",          "render.threads=2 toy.threads=2 drop.threads=2",
        "render.keep=off",           "render.accel=octant",
        "render.rebuild=1",          "render.rebuild=1000 render.build_threads=2",
        "render.integrator=zbuffer", "toy.integrator=verlet drop.integrator=implicit"};
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++)
        expect_films(settings[i]);
}

static void a_motion_starts_at_time_0_with_all_meshes_loaded(void **state)
{
    (void)state;
    scene *s = toys_with("render.threads=2");
    diagnostic why = {0};
    worked(scene_load(s, &why), &why); /* the toy at 0.4 s */
    scene_motion *m = begin(s);
    assert_true(scene_moves(s));
    assert_int_equal(scene_motion_count(m), 2);
    assert_int_equal(scene_motion_mesh(m, 0), 1);
    assert_int_equal(scene_motion_mesh(m, 1), 2);
    assert_int_equal(softbody_mass_count(scene_motion_body(m, 0)), 10 * 16 + 2);
    assert_true(s->meshes[1].time_s == 0.0 && s->meshes[1].account.steps == 0);
    assert_non_null(s->meshes[0].data);
    assert_true(film_of(s) == film_afresh("render.threads=1", 0.0));
    scene_motion_destroy(m);
    assert_non_null(s->meshes[1].data); /* the mesh at its current time */
    scene_destroy(s);
}

static void advancing_without_surfaces_keeps_the_film(void **state)
{
    (void)state;
    scene *s = toys_with("render.threads=1");
    scene_motion *m = begin(s);
    const uint64_t start = film_of(s);
    advance(m, 0.2, false);
    assert_true(film_of(s) == start);
    assert_true(s->meshes[1].time_s == 0.2 && s->meshes[1].account.steps == 200);
    advance(m, 0.3, true);
    assert_true(film_of(s) == film_afresh("render.threads=1", 0.3));
    scene_motion_destroy(m);
    scene_destroy(s);
}

static void the_report_counts_the_latest_advance(void **state)
{
    (void)state;
    scene *s = toys_with("render.threads=1 render.rebuild=1000");
    scene_motion *m = begin(s);
    film_of(s); /* builds hierarchies, which are kept */
    advance(m, 0.1, true);
    scene_motion_report r = scene_motion_last(m);
    assert_int_equal(r.steps, 100 + 40);
    assert_int_equal(r.hierarchies.refitted, 2);
    assert_int_equal(r.hierarchies.rebuilt, 0);
    assert_true(s->meshes[1].account.steps == 100 && s->meshes[2].account.steps == 40);
    advance(m, 0.1, true);
    r = scene_motion_last(m);
    assert_int_equal(r.steps, 0);
    advance(m, 0.2, false);
    r = scene_motion_last(m);
    assert_int_equal(r.steps, 140);
    assert_int_equal(r.hierarchies.refitted, 0);
    scene_motion_destroy(m);
    scene_destroy(s);
}

/* A clone shares the slimes' surfaces: they stay unchanged for it, and the scene gets new ones. */
static void a_clone_does_not_move(void **state)
{
    (void)state;
    scene *s = toys_with("render.threads=1");
    scene_motion *m = begin(s);
    advance(m, 0.1, true);
    scene *copy = scene_clone(s);
    const mesh *shared = copy->meshes[1].data;
    assert_ptr_equal(shared, s->meshes[1].data);
    advance(m, 0.3, true);
    assert_ptr_not_equal(shared, s->meshes[1].data);
    assert_int_equal(mesh_reference_count(shared), 1);
    assert_true(film_of(copy) == film_afresh("render.threads=1", 0.1));
    assert_true(film_of(s) == film_afresh("render.threads=1", 0.3));
    const mesh *own = s->meshes[1].data;
    advance(m, 0.4, true);
    assert_ptr_equal(own, s->meshes[1].data); /* in place, once the mesh has one owner again */
    scene_destroy(copy);
    scene_motion_destroy(m);
    scene_destroy(s);
}

/* The motion continues in another scene that has the same slimes, and the scene that it left gets its own meshes
 * back. */
static void a_motion_joins_another_scene_with_the_same_slimes(void **state)
{
    (void)state;
    scene *s = toys_with("render.threads=1"),
          *other = toys_with("render.threads=1 jelly.ior=1.6 camera.fov_deg=30 drop.time_s=3");
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    const mesh *own = s->meshes[1].data;
    scene_motion *m = begin(s);
    advance(m, 0.1, true);
    const mesh *surface = s->meshes[1].data;
    bool joined = false;
    worked(scene_motion_join(m, other, &joined, &why), &why);
    assert_true(joined);
    assert_ptr_equal(s->meshes[1].data, own);
    assert_true(s->meshes[1].time_s == 0.4 && s->meshes[1].account.steps == 400);
    assert_ptr_equal(other->meshes[1].data, surface);
    assert_true(other->meshes[1].time_s == 0.1 && other->meshes[2].time_s == 0.1);
    worked(scene_load(other, &why), &why);
    advance(m, 0.3, true);
    assert_true(film_of(other) == film_afresh("render.threads=1 jelly.ior=1.6 camera.fov_deg=30", 0.3));
    scene_destroy(s);
    scene *softer = toys_with("toy.stiffness=9"), *fewer = scene_from("meshes: {toy: {generate: slime, level: 2}}\n");
    worked(scene_motion_join(m, softer, &joined, &why), &why);
    assert_false(joined || softer->meshes[1].data);
    worked(scene_motion_join(m, fewer, &joined, &why), &why);
    assert_false(joined);
    scene_motion_end(m);
    assert_true(other->meshes[1].time_s == 0.4 && other->meshes[2].time_s == 3.0 && !other->meshes[1].data);
    scene_destroy(softer);
    scene_destroy(fewer);
    scene_destroy(other);
}

static void a_scene_that_cannot_move_is_unchanged(void **state)
{
    (void)state;
    scene *s = scene_from("meshes: {pin: {generate: icosphere}}\n");
    scene_motion *m = NULL;
    diagnostic why = {0};
    assert_false(scene_moves(s));
    assert_int_equal(scene_motion_create(s, &m, &why), STATUS_BAD_INPUT);
    assert_null(m);
    scene_destroy(s);
    s = toys_with("drop.script=no-such.yaml");
    assert_int_equal(scene_motion_create(s, &m, &why), STATUS_BAD_INPUT);
    assert_null(m);
    assert_non_null(strstr(why.what, "drop"));
    assert_true(s->meshes[1].time_s == 0.4);
    assert_null(s->meshes[1].data);
    scene_destroy(s);
    scene_motion_destroy(NULL);
}

static void an_unstable_slime_is_reported(void **state)
{
    (void)state;
    scene *s = toys_with("toy.stiffness=1e7 toy.dt_s=0.1");
    scene_motion *m = begin(s);
    diagnostic why = {0};
    assert_int_equal(scene_motion_advance(m, 10.0, true, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "toy"));
    scene_motion_destroy(m);
    scene_destroy(s);
}

typedef struct leaving {
    double share;
    cancel_token token;
} leaving;

static void leave(void *context, double fraction_done)
{
    leaving *l = context;
    l->share = fraction_done;
    cancel_set(&l->token);
}

/* Interrupted at the first check of a long advance, twice; afterwards the motion equals one that was never
 * interrupted. */
static void an_interrupted_advance_can_be_continued(void **state)
{
    (void)state;
    const double far_s = 40.0;
    scene *s = toys_with(""), *straight = toys_with("");
    scene_motion *m = begin(s), *uninterrupted = begin(straight);
    const mesh *surface = s->meshes[1].data;
    const vec3 first = surface->vertices[0];
    for (int i = 0; i < 2; i++) {
        leaving l = {.share = -1.0};
        diagnostic why = {0};
        cancel_begin(&l.token);
        assert_int_equal(scene_motion_advance_until(m, 4000.0, true, &(load_watch){leave, &l}, &why),
                         STATUS_INTERRUPTED);
        cancel_end(&l.token);
        assert_true(l.share > 0.0 && l.share < 0.5); /* of two slimes, during the first */
        assert_true(s->meshes[1].data == surface && s->meshes[1].time_s == 0.0 && s->meshes[1].account.steps == 0);
        assert_memory_equal(&surface->vertices[0], &first, sizeof first);
    }
    advance(m, far_s, true);
    advance(uninterrupted, far_s, true);
    assert_true(s->meshes[1].account.steps == straight->meshes[1].account.steps && s->meshes[1].time_s == far_s);
    for (int i = 1; i < 3; i++)
        assert_memory_equal(s->meshes[i].data->vertices, straight->meshes[i].data->vertices,
                            s->meshes[i].data->vertex_count * sizeof first);
    scene_motion_destroy(m);
    scene_motion_destroy(uninterrupted);
    scene_destroy(s);
    scene_destroy(straight);
}

/* Script files: the contents of a valid one, and that each file of tests/bad/scripts gives STATUS_BAD_INPUT
 * with its line of expected.txt. Run from the repository root. */

#define FOLDER "tests/bad/scripts/"

static const char good[] = "title: A tug to the left\n"
                           "hands:\n"
                           "  left:\n"
                           "    - {time_s: 0.5, grab: [0, 1, -6], towards: [0, 0.5, 1], reach: 0.3}\n"
                           "    - {time_s: 1.5, move: [-1.2, 0.8, 0]}\n"
                           "    - {time_s: 2, release: on}\n"
                           "  right:\n"
                           "    - time_s: 0\n"
                           "      grab: [3, 1, 2]\n"
                           "      towards: [-1, 0, 0]\n"
                           "      reach: 1\n";

static hand_script *read_good(void)
{
    hand_script *s = NULL;
    diagnostic why = {.what = ""};
    if (script_read_text("good.yaml", good, sizeof good - 1, &s, &why) != STATUS_OK)
        fail_msg("%ld: %s", why.line, why.what);
    return s;
}

static bool is_at(vec3 v, double x, double y, double z)
{
    return v.x == x && v.y == y && v.z == z;
}

static void the_hands_and_keys_of_a_valid_script_are_read(void **state)
{
    (void)state;
    hand_script *s = read_good();
    assert_string_equal(s->path, "good.yaml");
    assert_int_equal(s->track_count, 2);
    const hand_track *left = &s->tracks[0], *right = &s->tracks[1];
    assert_string_equal(left->name, "left");
    assert_string_equal(right->name, "right");
    assert_int_equal(left->key_count, 3);
    assert_int_equal(right->key_count, 1);
    const hand_key *k = left->keys;
    assert_true(k[0].act == HAND_GRAB && k[1].act == HAND_MOVE && k[2].act == HAND_RELEASE);
    assert_true(k[0].time_s == 0.5 && k[1].time_s == 1.5 && k[2].time_s == 2.0);
    assert_true(is_at(k[0].origin, 0.0, 1.0, -6.0) && is_at(k[0].direction, 0.0, 0.5, 1.0) && k[0].reach == 0.3);
    assert_true(is_at(k[1].by, -1.2, 0.8, 0.0));
    assert_true(k[2].line == 6 && k[2].column == 7);
    assert_true(is_at(right->keys[0].origin, 3.0, 1.0, 2.0) && is_at(right->keys[0].direction, -1.0, 0.0, 0.0));
    assert_true(right->keys[0].time_s == 0.0 && right->keys[0].reach == 1.0 && right->keys[0].line == 8);
    assert_true(hand_script_end_s(s) == 2.0);
    hand_script_destroy(s);
}

static status read_bad_script(const char *path, diagnostic *why)
{
    hand_script *s = NULL;
    const status code = script_read_below(path, NULL, &s, why);
    assert_null(s);
    assert_true(!why || why->remedy[0]);
    return code;
}

static void errors_in_scripts_are_located(void **state)
{
    (void)state;
    assert_bad_files(FOLDER, read_bad_script, 50);
}

/* A truncated script is valid or refused with a location. */
static void truncated_scripts_are_valid_or_refused(void **state)
{
    (void)state;
    size_t refused = 0;
    for (size_t cut = 0; cut < sizeof good - 1; cut++) {
        char *exact = malloc(cut + 1); /* exact size, for the address sanitizer */
        assert_non_null(exact);
        memcpy(exact, good, cut);
        diagnostic why = {.what = ""};
        hand_script *s;
        const status code = script_read_text("cut.yaml", exact, cut, &s, &why);
        assert_true(code == STATUS_OK || (code == STATUS_BAD_INPUT && why.line > 0 && why.column > 0 && why.what[0]));
        refused += code != STATUS_OK;
        hand_script_destroy(s);
        free(exact);
    }
    assert_true(refused > 100);
}

static void missing_and_too_large_scripts_are_refused(void **state)
{
    (void)state;
    diagnostic why = {.what = ""};
    hand_script *s;
    assert_int_equal(script_read_below(FOLDER "no-such.yaml", NULL, &s, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.file, FOLDER "no-such.yaml");
    assert_null(s);
    assert_int_equal(script_read_below("tests", NULL, &s, NULL), STATUS_BAD_INPUT);
    const size_t size = (256 << 20) + 1;
    char *huge = malloc(size);
    assert_non_null(huge);
    memset(huge, '#', size);
    assert_int_equal(script_read_text("huge.yaml", huge, size, &s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "larger than 256 MiB"));
    free(huge);
}

/* Grabs the slime where the ray hits it, pulls it by `by`, and returns a hash of its vertices, which are those of the
 * mesh's frame. */
static uint64_t grabbed(const char *assignments, vec3 origin, vec3 direction, vec3 by)
{
    scene *s = toys_with(assignments);
    scene_motion *m = begin(s);
    motion_hand hands[SOFTBODY_HANDS_MAX] = {{.holds = false}};
    motion_place place;
    diagnostic why = {0};
    int number = -1;
    worked(scene_motion_pick(m, 0, 1, origin, direction, &place, &why), &why);
    assert_true(place.distance < 10.0);
    worked(scene_motion_grab(m, 0, &place, 0.9, hands, &number, &why), &why);
    hands[number].to = motion_hand_offset(&hands[number], by);
    worked(scene_motion_step_held(m, 0, hands, 0.05, NULL, &why), &why);
    advance(m, 0.05, true);
    const mesh *shown = s->meshes[scene_motion_mesh(m, 0)].data;
    const uint64_t hash = hash_numbers(0, &shown->vertices->x, 3 * shown->vertex_count, sizeof(double));
    scene_motion_destroy(m);
    scene_destroy(s);
    return hash;
}

static void a_mirrored_slime_is_grabbed_where_it_is_seen(void **state)
{
    (void)state;
    const vec3 o = {-0.4, 1.0, -5.0}, d = {0.0, 0.0, 1.0}, by = {0.25, 0.5, -0.5};
    const uint64_t plain = grabbed("", o, d, by);
    assert_true(plain != grabbed("", o, d, vec3_make(0.25, 0.5, 0.5)));
    assert_true(plain ==
                grabbed("jelly.scale=-1,-1,-1", vec3_scale(o, -1.0), vec3_scale(d, -1.0), vec3_scale(by, -1.0)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_film_is_that_of_the_scene_loaded_at_its_time),
        cmocka_unit_test(a_motion_starts_at_time_0_with_all_meshes_loaded),
        cmocka_unit_test(advancing_without_surfaces_keeps_the_film),
        cmocka_unit_test(the_report_counts_the_latest_advance),
        cmocka_unit_test(a_clone_does_not_move),
        cmocka_unit_test(a_motion_joins_another_scene_with_the_same_slimes),
        cmocka_unit_test(a_scene_that_cannot_move_is_unchanged),
        cmocka_unit_test(an_unstable_slime_is_reported),
        cmocka_unit_test(an_interrupted_advance_can_be_continued),
        cmocka_unit_test(the_hands_and_keys_of_a_valid_script_are_read),
        cmocka_unit_test(a_mirrored_slime_is_grabbed_where_it_is_seen),
        cmocka_unit_test(errors_in_scripts_are_located),
        cmocka_unit_test(truncated_scripts_are_valid_or_refused),
        cmocka_unit_test(missing_and_too_large_scripts_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
