/* Tests of slimes in scene files: the mesh is exactly the surface of a body with these parameters and this script. */
#include "study_fixture.h"

#include "base/cancel.h"
#include "job/job.h"
#include "scene/assets/slime.h"
#include "scene/file/write.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <limits.h>

static const char tug[] = "hands:\n"
                          "  left:\n"
                          "    - {time_s: 0.01, grab: [0, 1, -6], towards: [0, 0, 1], reach: 0.4}\n"
                          "    - {time_s: 0.05, move: [-0.3, 0.2, 0]}\n";

static const char toy[] = "meshes:\n"
                          "  toy:\n"
                          "    generate: slime\n"
                          "    level: 2\n"
                          "    time_s: 0.05\n"
                          "    script: scripts/tug.yaml\n"
                          "solids: {body: {shape: mesh, mesh: toy, diffuse: 0.7}}\n";

static const char falling[] =
    "meshes: {toy: {generate: slime, level: 2, time_s: 0.25, ground: off, velocity: [1, 2, 3]}}\n";

static void worked(status code, const diagnostic *why)
{
    char text[DIAGNOSTIC_TEXT_MAX];
    if (code != STATUS_OK)
        fail_msg("%s", diagnostic_text(why, text, sizeof text));
}

static void write_scripts(const fixture *f, const char *text)
{
    char path[400];
    fixture_path(f, "scripts", path);
    mkdir(path, 0777);
    fixture_write(f, "scripts/tug.yaml", text);
}

static scene *read_scene(const fixture *f, const char *text)
{
    char path[400];
    fixture_write(f, "toy.yaml", text);
    fixture_path(f, "toy.yaml", path);
    scene *s = NULL;
    diagnostic why = {0};
    worked(scene_read(path, &s, &why), &why);
    return s;
}

static scene *loaded(const fixture *f, const char *text)
{
    scene *s = read_scene(f, text);
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    assert_non_null(s->meshes[0].data);
    return s;
}

static void set(scene *s, const char *assignment)
{
    diagnostic why = {0};
    worked(scene_set_assignment(s, assignment, &why), &why);
}

/* The body of a scene, made without the scene. */
static mesh *skin_of(const mesh_entry *m, const hand_script *script, softbody_quantities *account)
{
    const softbody_settings settings = slime_settings(m);
    softbody *b = NULL;
    mesh *surface = NULL;
    diagnostic why = {0};
    worked(softbody_create(&settings, isa_best(), &b, &why), &why);
    if (script)
        assert_int_equal(softbody_follow(b, script, NULL), STATUS_OK);
    worked(softbody_advance(b, m->time_s, &why), &why);
    worked(softbody_surface(b, &surface, &why), &why);
    *account = softbody_measure(b);
    softbody_destroy(b);
    return surface;
}

static void expect_skin(const mesh_entry *m, const hand_script *script)
{
    softbody_quantities account;
    mesh *surface = skin_of(m, script, &account);
    assert_int_equal(m->data->vertex_count, surface->vertex_count);
    assert_int_equal(m->data->triangle_count, surface->triangle_count);
    assert_memory_equal(m->data->vertices, surface->vertices, surface->vertex_count * sizeof *surface->vertices);
    assert_memory_equal(m->data->normals, surface->normals, surface->vertex_count * sizeof *surface->normals);
    assert_true(m->data->closed);
    assert_true(m->account.time_s == account.time_s && m->account.steps == account.steps &&
                m->account.kinetic == account.kinetic);
    assert_int_equal(m->account.held, account.held);
    mesh_release(surface);
}

/* Semi-implicit Euler after n steps: y0 + v n dt - g dt^2 n (n + 1) / 2 for the centre, independent of the springs. */
static void a_falling_slime_is_at_the_integrators_position(void **state)
{
    scene *s = loaded(*state, falling);
    const mesh_entry *m = &s->meshes[0];
    const double dt = 0.001, n = 250.0;
    assert_int_equal(m->account.steps, 250);
    assert_true(fabs(m->account.time_s - 0.25) < 1e-12);
    assert_int_equal(m->data->triangle_count, 20 * 16);
    assert_true(fabs(m->account.center.x - n * dt) < 1e-12 && fabs(m->account.center.z - 3.0 * n * dt) < 1e-12);
    assert_true(fabs(m->account.center.y - (1.0 + 2.0 * n * dt - 9.81 * dt * dt * n * (n + 1.0) / 2.0)) < 1e-12);
    vec3 sum = {0.0, 0.0, 0.0}; /* of the surface, whose vertices are all masses */
    for (size_t i = 0; i < m->data->vertex_count; i++)
        sum = vec3_add(sum, m->data->vertices[i]);
    if (m->data->vertex_count == 10 * 16 + 2)
        assert_true(fabs(sum.y / (double)m->data->vertex_count - m->account.center.y) < 1e-12);
    expect_skin(m, NULL);
    scene_destroy(s);
}

static void a_script_path_is_relative_to_the_scene_and_moves_the_slime(void **state)
{
    write_scripts(*state, tug);
    scene *s = loaded(*state, toy);
    diagnostic why = {0};
    hand_script *script = NULL;
    worked(slime_read_script(s, &s->meshes[0], &script, &why), &why);
    assert_non_null(script);
    assert_int_equal(script->tracks[0].key_count, 2);
    assert_true(s->meshes[0].account.held > 0);
    expect_skin(&s->meshes[0], script);
    hand_script_destroy(script);
    scene_destroy(s);
}

/* Asserts that loading fails with this diagnostic, located in a file of the fixture. */
static void refused_at(const fixture *f, const char *text, const char *file, long line, long column, const char *what)
{
    char path[400];
    scene *s = read_scene(f, text);
    diagnostic why = {0};
    assert_int_equal(scene_load(s, &why), STATUS_BAD_INPUT);
    fixture_path(f, file, path);
    assert_string_equal(why.file, path);
    if (why.line != line || why.column != column || !strstr(why.what, what))
        fail_msg("%ld:%ld: %s", why.line, why.column, why.what);
    assert_null(s->meshes[0].data);
    scene_destroy(s);
}

static void errors_in_slimes_are_located(void **state)
{
    const fixture *f = *state;
    refused_at(f, toy, "toy.yaml", 6, 13, "scripts/tug.yaml");
    write_scripts(f, "hands:\n  left:\n    - {time_s: 1, move: [1, 0, 0]}\n");
    refused_at(f, toy, "scripts/tug.yaml", 3, 7, "without a grab");
    write_scripts(f, "");
    refused_at(f, toy, "scripts/tug.yaml", 1, 1, "empty");
    write_scripts(f, "hands:\n  left:\n    - {time_s: 0.02, grab: [9, 9, 9], towards: [0, 1, 0], reach: 1}\n");
    refused_at(f, toy, "scripts/tug.yaml", 3, 7, "");
    refused_at(f, "meshes:\n  toy: {generate: slime, level: 2, time_s: 1, dt_s: 0.1, stiffness: 1e6}\n", "toy.yaml", 2,
               19, "toy: ");
}

static void refused_to_read(const char *text, const char *what)
{
    scene *s = NULL;
    diagnostic why = {0};
    assert_int_equal(scene_read_text("toy.yaml", text, strlen(text), &s, &why), STATUS_BAD_INPUT);
    if (!strstr(why.what, what) || why.line != 1)
        fail_msg("%ld:%ld: %s", why.line, why.column, why.what);
}

static void settings_without_a_valid_body_are_refused(void **state)
{
    (void)state;
    refused_to_read("meshes: {toy: {generate: slime, level: 8}}\n", "level");
    refused_to_read("meshes: {toy: {generate: slime, stiffness: soft}}\n", "toy.stiffness");
    refused_to_read("meshes: {toy: {generate: slime, mass_kg: 0}}\n", "toy.mass_kg");
    refused_to_read("meshes: {toy: {generate: slime, time_s: -1}}\n", "toy.time_s");
    refused_to_read("meshes: {toy: {generate: slime, time_s: 1000, dt_s: 1e-7}}\n", "steps");
    refused_to_read("meshes: {toy: {generate: slime, time_s: 0, dt_s: 9e-10}}\n", "toy.dt_s");
    refused_to_read("meshes: {toy: {generate: slime, file: a.obj}}\n", "both a file and a generator");
    scene *s = NULL;
    const char sphere[] = "meshes: {ball: {generate: icosphere, level: 8}}\n"; /* which can be repeated */
    assert_int_equal(scene_read_text("ball.yaml", sphere, strlen(sphere), &s, NULL), STATUS_OK);
    scene_destroy(s);
}

static void a_change_releases_the_body_and_a_clone_keeps_it(void **state)
{
    scene *s = loaded(*state, falling);
    scene *copy = scene_clone(s);
    assert_ptr_equal(copy->meshes[0].data, s->meshes[0].data);
    assert_int_equal(copy->meshes[0].account.steps, 250);
    assert_true(copy->meshes[0].motion_s == s->meshes[0].motion_s);
    set(s, "toy.time_s=0.1");
    assert_null(s->meshes[0].data);
    assert_int_equal(s->meshes[0].account.steps, 0);
    assert_true(s->meshes[0].motion_s == 0.0);
    assert_non_null(copy->meshes[0].data);
    worked(scene_load(s, NULL), &(diagnostic){0});
    assert_int_equal(s->meshes[0].account.steps, 100);
    scene_destroy(copy);
    scene_destroy(s);
}

static void slimes_are_reused_only_if_meshes_are_kept(void **state)
{
    scene *from = loaded(*state, falling);
    for (int keep = 0; keep < 2; keep++) {
        scene *s = read_scene(*state, falling);
        set(s, keep ? "render.keep=on" : "render.keep=off");
        scene_retain_meshes(s, from);
        assert_true((s->meshes[0].data == from->meshes[0].data) == keep);
        assert_int_equal(s->meshes[0].account.steps, keep ? 250 : 0);
        assert_true(s->meshes[0].motion_s == (keep ? from->meshes[0].motion_s : 0.0));
        scene_destroy(s);
    }
    scene *other = read_scene(*state, falling);
    set(other, "toy.damping=0.03");
    scene_retain_meshes(other, from);
    assert_null(other->meshes[0].data);
    scene_destroy(other);
    scene_destroy(from);
}

/* Two rows of one cell: one shared simulation, or one each. */
static void the_rows_of_a_study_share_a_simulation_unless_keep_is_off(void **state)
{
    for (int keep = 0; keep < 2; keep++) {
        mesh_cache shared = {.count = 0};
        scene *rows[2];
        for (int i = 0; i < 2; i++) {
            diagnostic why = {0};
            rows[i] = read_scene(*state, falling);
            set(rows[i], keep ? "render.keep=on" : "render.keep=off");
            worked(mesh_cache_load(&shared, rows[i], NULL, &why), &why);
            assert_int_equal(rows[i]->meshes[0].account.steps, 250);
        }
        assert_true((rows[0]->meshes[0].data == rows[1]->meshes[0].data) == keep);
        assert_int_equal(shared.count, keep);
        for (int i = 0; i < 2; i++)
            scene_destroy(rows[i]);
        mesh_cache_clear(&shared);
    }
}

typedef struct waiting {
    int polls, patience; /* times */
    double share;
    bool in_order;
    cancel_token token;
} waiting;

static void wait(void *context, double fraction_done)
{
    waiting *w = context;
    w->in_order &= fraction_done > w->share && fraction_done <= 1.0;
    w->share = fraction_done;
    if (++w->polls >= w->patience)
        cancel_set(&w->token);
}

/* Days of motion, interrupted at the first poll. */
static void an_interrupted_load_does_not_change_the_slime(void **state)
{
    scene *s = read_scene(
        *state,
        "meshes:\n  ball: {generate: icosphere, level: 1}\n  toy: {generate: slime, level: 2, time_s: 86400}\n");
    waiting w = {.patience = 3, .in_order = true};
    diagnostic why = {0};
    cancel_begin(&w.token);
    assert_int_equal(scene_load_until(s, &(load_watch){wait, &w}, &why), STATUS_INTERRUPTED);
    cancel_end(&w.token);
    assert_int_equal(w.polls, 3);
    assert_true(w.in_order && w.share > 0.0 && w.share < 1.0);
    assert_non_null(strstr(why.what, "toy: interrupted at "));
    assert_non_null(s->meshes[0].data);
    assert_null(s->meshes[1].data);
    assert_true(s->meshes[1].time_s == 86400.0 && s->meshes[1].motion_s == 0.0 && s->meshes[1].account.steps == 0);
    set(s, "toy.time_s=0.05");
    worked(scene_load(s, &why), &why);
    assert_int_equal(s->meshes[1].account.steps, 50);
    scene_destroy(s);
}

/* Progress covers both slimes; watching changes nothing. */
static void progress_callbacks_do_not_change_the_load(void **state)
{
    static const char two[] = "meshes:\n  a: {generate: slime, level: 4, time_s: 0.31}\n  b: {generate: slime, level: "
                              "4, time_s: 0.4, dt_s: 0.0007}\n";
    scene *alone = loaded(*state, two), *watched = read_scene(*state, two);
    waiting w = {.patience = INT_MAX, .in_order = true};
    diagnostic why = {0};
    worked(scene_load_until(watched, &(load_watch){wait, &w}, &why), &why);
    assert_true(w.in_order);
    for (int i = 0; i < 2; i++) {
        const mesh *one = alone->meshes[i].data, *other = watched->meshes[i].data;
        assert_int_equal(watched->meshes[i].account.steps, i == 0 ? 310 : 571);
        assert_memory_equal(one->vertices, other->vertices, one->vertex_count * sizeof *one->vertices);
    }
    scene_destroy(alone);
    scene_destroy(watched);
}

static uint64_t identity(const fixture *f)
{
    char path[400];
    study *s = NULL;
    diagnostic why = {0};
    fixture_path(f, "toy.study", path);
    worked(study_read(path, &s, &why), &why);
    const uint64_t hash = s->identity[0];
    study_destroy(s);
    return hash;
}

static void the_identity_of_a_cell_includes_the_text_of_the_script(void **state)
{
    const fixture *f = *state;
    write_scripts(f, tug);
    fixture_write(f, "toy.yaml", toy);
    fixture_write(f, "toy.study", "study: toy\nscene: toy.yaml\ngrid:\n  - {toy.stiffness: [10, 20]}\n");
    const uint64_t hash = identity(f);
    assert_true(identity(f) == hash);
    char other[sizeof tug];
    memcpy(other, tug, sizeof tug);
    *strstr(other, "0.4") = '1';
    write_scripts(f, other);
    assert_true(identity(f) != hash);
    write_scripts(f, tug);
    assert_true(identity(f) == hash);
}

static void a_slime_round_trips_and_its_script_path_is_adjusted(void **state)
{
    const fixture *f = *state;
    char path[400], *text = NULL, *script = NULL;
    write_scripts(f, tug);
    scene *s = loaded(f, toy), *again = NULL;
    set(s, "toy.stiffness=50");
    set(s, "toy.velocity=[1, 0, 0]");
    diagnostic why = {0};
    fixture_path(f, "scripts/there.yaml", path);
    worked(scene_write(s, path, false, &why), &why);
    worked(scene_read(path, &again, &why), &why);
    worked(scene_get(again, "toy.script", &script, &why), &why);
    assert_string_equal(script, "tug.yaml");
    worked(scene_load(s, &why), &why);
    worked(scene_load(again, &why), &why);
    assert_memory_equal(s->meshes[0].data->vertices, again->meshes[0].data->vertices,
                        s->meshes[0].data->vertex_count * sizeof(vec3));
    worked(scene_write_text(s, s->path, false, &text, &why), &why);
    assert_non_null(strstr(text, "  toy:\n    generate: slime\n    level: 2\n    time_s: 0.05\n    script: "
                                 "scripts/tug.yaml\n    velocity: [1, 0, 0]\n"
                                 "    stiffness: 50\n"));
    free(text);
    free(script);
    scene_destroy(again);
    scene_destroy(s);
}

static status note_row(void *context, const char *path, const param *row, const char *value)
{
    (void)row;
    (void)value;
    *(bool *)context |= strcmp(path, "toy.stiffness") == 0;
    return STATUS_OK;
}

static void only_slimes_list_slime_parameters(void **state)
{
    scene *s = read_scene(*state, falling);
    bool has = false;
    assert_int_equal(scene_each_param(s, note_row, &has), STATUS_OK);
    assert_true(has);
    set(s, "toy.generate=icosphere");
    has = false;
    assert_int_equal(scene_each_param(s, note_row, &has), STATUS_OK);
    assert_false(has);
    scene_destroy(s);
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, fixture_setup, fixture_teardown)
    const struct CMUnitTest tests[] = {
        IN_FOLDER(a_falling_slime_is_at_the_integrators_position),
        IN_FOLDER(a_script_path_is_relative_to_the_scene_and_moves_the_slime),
        IN_FOLDER(errors_in_slimes_are_located),
        cmocka_unit_test(settings_without_a_valid_body_are_refused),
        IN_FOLDER(a_change_releases_the_body_and_a_clone_keeps_it),
        IN_FOLDER(slimes_are_reused_only_if_meshes_are_kept),
        IN_FOLDER(the_rows_of_a_study_share_a_simulation_unless_keep_is_off),
        IN_FOLDER(an_interrupted_load_does_not_change_the_slime),
        IN_FOLDER(progress_callbacks_do_not_change_the_load),
        IN_FOLDER(the_identity_of_a_cell_includes_the_text_of_the_script),
        IN_FOLDER(a_slime_round_trips_and_its_script_path_is_adjusted),
        IN_FOLDER(only_slimes_list_slime_parameters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
