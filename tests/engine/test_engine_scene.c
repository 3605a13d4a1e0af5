/* Tests of scenes through cuvette.h: parameters by path, objects, textures from memory, and their errors. */
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "cuvette.h"
#include "engine_fixture.h"
#include "probe_fixture.h"

static void errors_are_reported_and_leave_the_arguments_unchanged(void **state)
{
    (void)state;
    cuvette_diagnostic why = {.what = ""};
    cuvette_scene *s = NULL, *none = NULL;
    cuvette_engine *engine = NULL;
    cuvette_query *query = NULL;
    assert_int_equal(cuvette_scene_create(NULL, &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.what, "'out' is NULL"));
    assert_int_equal(cuvette_scene_read(NULL, &none, NULL), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_scene_read("no/such/file.yaml", &none, &why), CUVETTE_BAD_INPUT);
    assert_string_equal(why.file, "no/such/file.yaml");
    const char *slip = "solids:\n  ball: {shape: sphere, raduis: 1}\n";
    assert_int_equal(cuvette_scene_read_text("mine.yaml", slip, strlen(slip), &none, &why), CUVETTE_BAD_INPUT);
    assert_true(why.line == 2 && why.column > 0 && strstr(why.remedy, "radius") && !none);
    assert_int_equal(cuvette_engine_create("mmx", &engine, &why), CUVETTE_BAD_INPUT);
    assert_null(engine);
    assert_int_equal(cuvette_engine_render(NULL, NULL, NULL, NULL, &why), CUVETTE_BAD_INPUT);
    fine(cuvette_scene_create(&s, &why), &why);
    assert_int_equal(cuvette_scene_set(s, NULL, "1", &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_scene_set(NULL, "render.depth", "1", &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.what, "'scene' is NULL"));
    assert_int_equal(cuvette_scene_set(s, "render.deph", "1", &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.remedy, "render.depth"));
    assert_int_equal(cuvette_scene_add_solid(s, "ball", "spere", NULL, &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.remedy, "sphere"));
    /* An unknown material: the solid is not added either. */
    assert_int_equal(cuvette_scene_add_solid(s, "ball", "sphere", "glass", &why), CUVETTE_BAD_INPUT);
    assert_int_equal((int)cuvette_scene_count(s, CUVETTE_SOLID), 0);
    assert_int_equal(cuvette_query_create(NULL, NULL, &query, &why), CUVETTE_BAD_INPUT);
    cuvette_scene_destroy(s);
    cuvette_scene_destroy(NULL);
    cuvette_engine_destroy(NULL);
    cuvette_frame_destroy(NULL);
    cuvette_query_destroy(NULL);
    cuvette_engine_cancel(NULL);
}

static void parameters_are_set_and_read_by_path(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s = rod(80, 4, 1);
    char text[64];
    double number, three[3];
    int64_t integer;
    size_t length, count;
    fine(cuvette_scene_set_double(s, "liquid.ior", 1.0 / 3.0 + 1.0, &why), &why);
    fine(cuvette_scene_get_double(s, "liquid.ior", &number, &why), &why);
    assert_true(number == 1.0 / 3.0 + 1.0); /* all digits */
    fine(cuvette_scene_set_int(s, "render.polarisation", 1, &why), &why);
    fine(cuvette_scene_get(s, "render.polarisation", text, sizeof text, &length, &why), &why);
    assert_string_equal(text, "on");
    assert_int_equal((int)length, 2);
    fine(cuvette_scene_get_int(s, "render.polarisation", &integer, &why), &why);
    assert_int_equal((int)integer, 1);
    fine(cuvette_scene_set_vector(s, "lamp.position", (const double[]){1.5, -2.0, 1e-9}, 3, &why), &why);
    fine(cuvette_scene_get_vector(s, "lamp.position", three, 3, &count, &why), &why);
    assert_true(count == 3 && three[0] == 1.5 && three[1] == -2.0 && three[2] == 1e-9);
    fine(cuvette_scene_get_double(s, "lamp.position.y", &number, &why), &why);
    assert_true(number == -2.0);
    const double spectrum[] = {400, 0.1, 500, 0.2, 600, 0.5};
    fine(cuvette_scene_set_vector(s, "liquid.absorb_spectrum", spectrum, 6, &why), &why);
    assert_int_equal(cuvette_scene_get_vector(s, "liquid.absorb_spectrum", three, 3, &count, &why), CUVETTE_BAD_INPUT);
    assert_int_equal((int)count, 6);

    assert_int_equal(cuvette_scene_set_double(s, "liquid.ior", (double)NAN, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_scene_set_int(s, "render.depth", 65, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_scene_set_double(s, "render.depth", 2.5, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_scene_set_vector(s, "lamp.position", three, 2, &why), CUVETTE_BAD_INPUT);
    fine(cuvette_scene_get_int(s, "render.depth", &integer, &why), &why);
    assert_int_equal((int)integer, 4);
    assert_int_equal(cuvette_scene_get_int(s, "render.integrator", &integer, &why), CUVETTE_BAD_INPUT); /* a word */
    fine(cuvette_scene_set_int(s, "render.threads", 0, &why), &why);                                    /* auto */
    fine(cuvette_scene_get(s, "render.threads", text, sizeof text, NULL, &why), &why);
    assert_string_equal(text, "auto");
    fine(cuvette_scene_get_int(s, "render.threads", &integer, &why), &why);
    assert_int_equal(integer, 0);
    fine(cuvette_scene_set_int(s, "render.threads", 1, &why), &why);
    assert_int_equal(cuvette_scene_get(s, "render.integrator", text, 7, &length, &why), CUVETTE_BAD_INPUT);
    assert_int_equal((int)length, 7); /* whitted, and there is its 0 */
    fine(cuvette_scene_get(s, "render.integrator", text, 8, NULL, &why), &why);
    assert_string_equal(text, "whitted");
    assert_int_equal(cuvette_scene_get(s, "render.integrator", NULL, 0, &length, &why), CUVETTE_BAD_INPUT);
    cuvette_scene_destroy(s);
}

static bool set_on_other(void *context, const cuvette_parameter *one)
{
    assert_true(one->range[0] && one->meaning[0] && one->initial);
    turn(context, one->path, one->value);
    return true;
}

static bool stop_after_three(void *context, const cuvette_parameter *one)
{
    (void)one;
    return ++*(int *)context < 3;
}

static void copying_every_parameter_reproduces_the_film(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_engine *engine = make_engine();
    cuvette_scene *changed = rod(80, 3, 1), *other = rod(40, 1, 1);
    int visited = 0;
    turn(changed, "liquid.medium", "water");
    turn(changed, "rod.rotation", "0,10,20");
    fine(cuvette_scene_each_parameter(changed, set_on_other, other, &why), &why);
    assert_true(hash_of(engine, changed) == hash_of(engine, other));
    fine(cuvette_scene_each_parameter(changed, stop_after_three, &visited, &why), &why);
    assert_int_equal(visited, 3);
    cuvette_scene_destroy(changed);
    cuvette_scene_destroy(other);
    cuvette_engine_destroy(engine);
}

/* experiments/scenes/rod.yaml, line by line. */
static cuvette_scene *rod_by_calls(void)
{
    static const char *const set[][2] = {
        {"render.width", "80"},
        {"render.height", "60"},
        {"render.depth", "4"},
        {"camera.position", "0,2.75,-6"},
        {"camera.target", "0,1.5,0"},
        {"camera.fov_deg", "45"},
        {"background.color", "0.53,0.75,0.92"},
        {"clear.transparency", "1"},
        {"clear.specular", "0.6"},
        {"clear.shininess", "80"},
        {"tiles.color", "0.85,0.85,0.85"},
        {"tiles.checker_color", "0.25,0.3,0.35"},
        {"tiles.checker", "0.5"},
        {"tiles.ambient", "0.1"},
        {"tiles.diffuse", "0.7"},
        {"plastic.color", "0.85,0.15,0.1"},
        {"plastic.ambient", "0.1"},
        {"plastic.diffuse", "0.7"},
        {"plastic.specular", "0.5"},
        {"plastic.shininess", "40"},
        {"lamp.position", "4,7,-5"},
        {"lamp.color", "1,1,1"},
        {"lamp.intensity", "1"},
        {"ground.priority", "0"},
        {"vessel.ior", "1.5"},
        {"vessel.position", "0,0.001,0"},
        {"vessel.radius", "1"},
        {"vessel.inner_radius", "0.9"},
        {"vessel.height", "3"},
        {"vessel.floor", "0.1"},
        {"vessel.priority", "2"},
        {"liquid.ior", "1.33"},
        {"liquid.position", "0,0.051,0"},
        {"liquid.radius", "0.95"},
        {"liquid.height", "1.95"},
        {"liquid.priority", "1"},
        {"rod.position", "0.2,2.101,0"},
        {"rod.size", "0.25,3,0.25"},
        {"rod.priority", "3"},
    };
    cuvette_diagnostic why;
    cuvette_scene *s;
    fine(cuvette_scene_create(&s, &why), &why);
    for (size_t i = 0; i < 3; i++)
        fine(cuvette_scene_add_material(s, (const char *const[]){"clear", "tiles", "plastic"}[i], &why), &why);
    fine(cuvette_scene_add_light(s, "lamp", &why), &why);
    fine(cuvette_scene_add_solid(s, "ground", "plane", "tiles", &why), &why);
    fine(cuvette_scene_add_solid(s, "vessel", "cup", "clear", &why), &why);
    fine(cuvette_scene_add_solid(s, "liquid", "cylinder", "clear", &why), &why);
    fine(cuvette_scene_add_solid(s, "rod", "box", "plastic", &why), &why);
    for (size_t i = 0; i < COUNT(set); i++)
        turn(s, set[i][0], set[i][1]);
    return s;
}

static void a_scene_built_by_calls_equals_its_file(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_engine *engine = make_engine();
    cuvette_scene *called = rod_by_calls(), *filed = rod(80, 4, 1), *again, *clone;
    const uint64_t hash = hash_of(engine, filed);
    assert_true(hash_of(engine, called) == hash);
    char text[8192];
    size_t length;
    fine(cuvette_scene_write_text(called, text, sizeof text, &length, &why), &why);
    fine(cuvette_scene_read_text("again.yaml", text, length, &again, &why), &why);
    fine(cuvette_scene_clone(again, &clone, &why), &why);
    cuvette_scene_destroy(again);
    assert_true(hash_of(engine, clone) == hash);
    cuvette_scene_destroy(clone);
    char link[8192] = "#scene=";
    fine(cuvette_scene_write_link(called, link + strlen(link), sizeof link - strlen(link), NULL, &why), &why);
    cuvette_scene *opened;
    fine(cuvette_scene_read(link, &opened, &why), &why);
    assert_true(hash_of(engine, opened) == hash);
    cuvette_scene_destroy(opened);
    cuvette_scene_destroy(called);
    cuvette_scene_destroy(filed);
    cuvette_engine_destroy(engine);
}

static void objects_are_added_moved_turned_and_removed(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_engine *engine = make_engine();
    cuvette_scene *s = rod(80, 2, 1), *set = rod(80, 2, 1);
    const uint64_t as_it_was = hash_of(engine, s);
    fine(cuvette_scene_move(s, "rod", (const double[]){0.5, 0.25, -0.125}, &why), &why);
    fine(cuvette_scene_turn(s, "rod", (const double[]){0.0, 30.0, 0.0}, &why), &why);
    turn(set, "rod.position", "0.7,2.351,-0.125");
    turn(set, "rod.rotation", "0,30,0");
    const uint64_t moved = hash_of(engine, s);
    assert_true(moved == hash_of(engine, set) && moved != as_it_was);
    fine(cuvette_scene_scale(s, "all+camera", 4.0, &why), &why);
    assert_true(hash_of(engine, s) == moved); /* a power of two: the same bits */
    fine(cuvette_scene_scale(s, "all+camera", 0.25, &why), &why);
    assert_int_equal(cuvette_scene_scale(s, "all+camera", 0.0, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_scene_scale(s, NULL, 2.0, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_scene_scale(s, "none", 2.0, &why), CUVETTE_BAD_INPUT);
    fine(cuvette_scene_add_solid(s, "ball", "sphere", "clear", &why), &why);
    assert_int_equal((int)cuvette_scene_count(s, CUVETTE_SOLID), 5);
    assert_string_equal(cuvette_scene_name(s, CUVETTE_SOLID, 4), "ball");
    assert_null(cuvette_scene_name(s, CUVETTE_SOLID, 5));
    assert_int_equal(cuvette_scene_add_light(s, "ball", &why), CUVETTE_BAD_INPUT); /* the name is taken */
    fine(cuvette_scene_rename(s, "ball", "globe", &why), &why);
    turn(s, "globe.radius", "0.5");
    turn(s, "globe.position", "2,1,0");
    turn(s, "globe.ior", "1.5");
    assert_true(hash_of(engine, s) != moved);
    fine(cuvette_scene_remove(s, "globe", &why), &why);
    assert_int_equal(cuvette_scene_remove(s, "globe", &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_scene_remove(s, "clear", &why), CUVETTE_BAD_INPUT); /* two solids have it */
    assert_true(hash_of(engine, s) == moved);
    fine(cuvette_scene_look_at(s, (const double[]){0.0, 1.0, 0.0}, &why), &why);
    turn(set, "camera.target", "0,1,0");
    assert_true(hash_of(engine, s) == hash_of(engine, set));
    cuvette_scene_destroy(s);
    cuvette_scene_destroy(set);
    cuvette_engine_destroy(engine);
}

/* In ambient light only, a white wall with a texture of one pixel shows that pixel's light; so does a clone. */
static void a_texture_from_memory_is_visible(void **state)
{
    (void)state;
    static const char *const set[][2] = {
        {"render.width", "1"},         {"render.height", "1"},     {"render.depth", "0"},
        {"camera.position", "0,0,-5"}, {"camera.target", "0,0,0"}, {"background.ambient", "1,1,1"},
        {"wall.color", "1,1,1"},       {"wall.ambient", "1"},      {"wall.diffuse", "0"},
        {"wall.specular", "0"},        {"wall.texture", "paint"}};
    const float one_pixel[3] = {0.25F, 0.5F, 0.75F};
    float seen[3];
    cuvette_diagnostic why;
    cuvette_engine *engine = make_engine();
    cuvette_scene *s, *clone;
    fine(cuvette_scene_create(&s, &why), &why);
    fine(cuvette_scene_add_pixels(s, "paint", 1, 1, one_pixel, &why), &why);
    assert_string_equal(cuvette_scene_name(s, CUVETTE_TEXTURE, 0), "paint");
    fine(cuvette_scene_add_solid(s, "wall", "box", NULL, &why), &why);
    for (size_t i = 0; i < COUNT(set); i++)
        turn(s, set[i][0], set[i][1]);
    char text[4096];
    /* A file cannot contain its pixels. */
    assert_int_equal(cuvette_scene_write_text(s, text, sizeof text, NULL, &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.what, "paint"));
    assert_int_equal(cuvette_scene_write_link(s, text, sizeof text, NULL, &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.what, "paint was given as"));
    fine(cuvette_scene_clone(s, &clone, &why), &why);
    cuvette_scene_destroy(s);
    cuvette_request request = CUVETTE_REQUEST;
    request.width = request.height = 1, request.rgb = seen;
    fine(cuvette_engine_render(engine, clone, &request, NULL, &why), &why);
    for (int k = 0; k < 3; k++)
        assert_true(fabsf(seen[k] - one_pixel[k]) < 1e-6F);
    cuvette_scene_destroy(clone);
    cuvette_engine_destroy(engine);
}

/* A wall of 30 % reflectance, measured at three wavelengths. */
static void values_become_optical_data(void **state)
{
    (void)state;
    static const char *const set[][2] = {{"render.width", "1"},       {"render.height", "1"},
                                         {"render.depth", "0"},       {"camera.position", "0,0,-5"},
                                         {"camera.target", "0,0,0"},  {"background.ambient", "1,1,1"},
                                         {"wall.color_data", "grey"}, {"wall.ambient", "1"},
                                         {"wall.diffuse", "0"},       {"wall.specular", "0"}};
    static const double lambda_nm[] = {400.0, 500.0, 700.0}, falling_nm[] = {500.0, 400.0, 700.0},
                        grey[] = {0.3, 0.3, 0.3}, negative[] = {0.0, 0.0, -1.0};
    float seen[3];
    cuvette_diagnostic why;
    cuvette_engine *engine = make_engine();
    cuvette_scene *s, *clone;
    fine(cuvette_scene_create(&s, &why), &why);
    assert_int_equal(cuvette_scene_add_values(s, "grey", falling_nm, grey, NULL, 3, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_scene_add_values(s, "grey", lambda_nm, grey, negative, 3, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_scene_add_values(s, "grey", lambda_nm, grey, NULL, 0, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_scene_count(s, CUVETTE_DATA), 0);
    fine(cuvette_scene_add_values(s, "grey", lambda_nm, grey, grey, 3, &why), &why);
    assert_string_equal(cuvette_scene_name(s, CUVETTE_DATA, 0), "grey");
    assert_int_equal(cuvette_scene_add_values(s, "grey", lambda_nm, grey, NULL, 3, &why), CUVETTE_BAD_INPUT);
    fine(cuvette_scene_add_solid(s, "wall", "box", NULL, &why), &why);
    for (size_t i = 0; i < COUNT(set); i++)
        turn(s, set[i][0], set[i][1]);
    char text[4096];
    assert_int_equal(cuvette_scene_write_text(s, text, sizeof text, NULL, &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.what, "grey"));
    assert_int_equal(cuvette_scene_write_link(s, text, sizeof text, NULL, &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.what, "grey was given as"));
    fine(cuvette_scene_clone(s, &clone, &why), &why);
    cuvette_scene_destroy(s);
    cuvette_request request = CUVETTE_REQUEST;
    request.width = request.height = 1, request.rgb = seen;
    fine(cuvette_engine_render(engine, clone, &request, NULL, &why), &why);
    for (int k = 0; k < 3; k++)
        assert_true(fabsf(seen[k] - 0.3F) < 1e-6F);
    turn(clone, "grey.scale", "2"); /* discards the arrays, so a file is missing */
    assert_int_equal(cuvette_engine_render(engine, clone, &request, NULL, &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.what, "no file"));
    cuvette_scene_destroy(clone);
    fine(cuvette_scene_create(&s, &why), &why);
    fine(cuvette_scene_add_data(s, "crown", &why), &why);
    assert_int_equal(cuvette_scene_count(s, CUVETTE_DATA), 1);
    cuvette_scene_destroy(s);
    cuvette_engine_destroy(engine);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_reported_and_leave_the_arguments_unchanged),
        cmocka_unit_test(parameters_are_set_and_read_by_path),
        cmocka_unit_test(copying_every_parameter_reproduces_the_film),
        cmocka_unit_test(a_scene_built_by_calls_equals_its_file),
        cmocka_unit_test(objects_are_added_moved_turned_and_removed),
        cmocka_unit_test(a_texture_from_memory_is_visible),
        cmocka_unit_test(values_become_optical_data),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
