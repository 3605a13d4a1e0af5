/* Tests of the parameter table: its rows, setting and getting by path, diagnostics. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/number.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char example[] = "materials:\n"
                              "  glass: {ior: 1.5, transparency: 1}\n"
                              "  matte: {diffuse: 0.7}\n"
                              "lights:\n"
                              "  lamp: {position: [4, 7, -5]}\n"
                              "solids:\n"
                              "  vessel: {shape: cup, material: glass}\n"
                              "  lens: {shape: sphere, material: glass, ior: 1.7}\n"
                              "  block: {shape: box, material: matte}\n"
                              "  tank: {shape: cylinder}\n"
                              "  ground: {shape: plane}\n";

static scene *make(void)
{
    scene *s;
    diagnostic why = {.what = ""};
    status code = scene_read_text("example.yaml", example, sizeof example - 1, &s, &why);
    assert_string_equal(why.what, "");
    assert_int_equal(code, STATUS_OK);
    return s;
}

static void set(scene *s, const char *path, const char *value)
{
    diagnostic why = {.what = ""};
    status code = scene_set(s, path, value, &why);
    assert_string_equal(why.what, "");
    assert_int_equal(code, STATUS_OK);
}

static void assert_value(const scene *s, const char *path, const char *value)
{
    char *text;
    assert_int_equal(scene_get(s, path, &text, NULL), STATUS_OK);
    assert_string_equal(text, value);
    free(text);
}

/* A value as text with a number close to the expected one; for derived angles. */
static void assert_value_near(const scene *s, const char *path, double value)
{
    char *text;
    double got;
    assert_int_equal(scene_get(s, path, &text, NULL), STATUS_OK);
    assert_true(number_parse_real(text, &got) && fabs(got - value) < 1e-12);
    free(text);
}

/* ---- the table ---- */

static void rows_are_complete_and_defaults_are_in_range(void **state)
{
    (void)state;
    assert_true(param_count() > 40);
    assert_null(param_at(param_count()));
    scene *s = make();
    for (size_t i = 0; i < param_count(); i++) {
        const param *row = param_at(i);
        assert_true(i == 0 || param_at(i - 1)->group <= row->group); /* param_find relies on it */
        char text[200];
        assert_true(row->name[0] && row->meaning[0] && row->unit && row->fallback);
        assert_true(row->meaning[strlen(row->meaning) - 1] != '.');
        assert_true(strlen(param_range_text(row, text, sizeof text)) > 3);
        assert_true(row->type != PARAM_CHOICE || row->choices);
        assert_ptr_equal(param_find(row->group, row->name), row);
        for (size_t j = 0; j < i; j++) { /* a solid's own rows and its surface's share paths */
            const param *other = param_at(j);
            bool share = other->group == row->group || (other->group >= PARAM_MATERIAL && row->group >= PARAM_MATERIAL);
            assert_false(share && strcmp(other->name, row->name) == 0);
        }
        assert_true(i == 0 || param_at(i - 1)->group <= row->group);
    }
    assert_ptr_equal(param_find(PARAM_SOLID, "ior"), param_find(PARAM_MATERIAL, "ior"));
    assert_null(param_find(PARAM_MATERIAL, "radius"));
    assert_null(param_find(PARAM_RENDER, "Depth"));
    assert_string_equal(param_group_name(PARAM_BACKGROUND), "background");
    scene_destroy(s);
}

static void ranges_have_readable_texts(void **state)
{
    (void)state;
    static const struct {
        param_group group;
        const char *name, *text;
    } cases[] = {
        {PARAM_RENDER, "width", "integer 1..65536"},
        {PARAM_RENDER, "beyond", "one of: sky, black, mean"},
        {PARAM_RENDER, "samples", "one of: 1, 4, 9, 16, 25, 36, 49, 64"},
        {PARAM_RENDER, "min_weight", "number 0..1"},
        {PARAM_CAMERA, "fov_deg", "number > 0, at most 179"},
        {PARAM_MATERIAL, "color", "3 numbers, each 0..1"},
        {PARAM_BACKGROUND, "image", "path of a file"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[200];
        assert_string_equal(param_range_text(param_find(cases[i].group, cases[i].name), text, sizeof text),
                            cases[i].text);
    }
}

static void assert_slider(param_group group, const char *name, const char *initial, const char *value,
                          param_slider expected)
{
    const param_slider s = param_slider_of(param_find(group, name), initial, value);
    assert_true(s.lowest == expected.lowest && s.highest == expected.highest && s.step == expected.step &&
                s.log_from == expected.log_from);
}

static void sliders_are_the_useful_part_of_a_range(void **state)
{
    (void)state;
    assert_slider(PARAM_RENDER, "depth", NULL, "4", (param_slider){0, 64, 1, 0});
    assert_slider(PARAM_RENDER, "width", NULL, "800", (param_slider){1, 2000, 1, 0});
    assert_slider(PARAM_RENDER, "width", "4000", "800", (param_slider){1, 10000, 1, 0});
    assert_slider(PARAM_RENDER, "threads", "auto", "auto", (param_slider){1, 20, 1, 0});
    assert_slider(PARAM_SOLID, "scale", NULL, "1,1,1", (param_slider){0.001, 2.5, 0.001, 0});
    assert_slider(PARAM_SOLID, "scale", NULL, "1,0.0001,4", (param_slider){0.0001, 8, 0.001, 0});
    assert_slider(PARAM_SOLID, "scale", NULL, "-1,1,1", (param_slider){-2.5, 2.5, 0.001, 0});
    assert_slider(PARAM_RENDER, "build_threads", NULL, "0", (param_slider){0, 100, 1, 1});
    assert_slider(PARAM_RENDER, "photons", NULL, "1000", (param_slider){10, 30000000, 1, 10});
    assert_slider(PARAM_CAMERA, "fov_deg", NULL, "45", (param_slider){0.1, 179, 0.1, 0});
    assert_slider(PARAM_CAMERA, "position", NULL, "[0, 1, -6]", (param_slider){-15, 15, 0.01, 0});
    assert_slider(PARAM_CAMERA, "aperture", NULL, "0", (param_slider){0, 100, 0, 0.001});
    assert_slider(PARAM_CAMERA, "aperture", NULL, "0.02", (param_slider){0, 0.05, 0.0001, 0});
    assert_slider(PARAM_MATERIAL, "color", NULL, "1,1,1", (param_slider){0, 1, 0.001, 0});
    assert_slider(PARAM_MATERIAL, "ior", NULL, "1.33", (param_slider){1, 2.5, 0.01, 0});
    assert_slider(PARAM_MATERIAL, "ior", NULL, "0.05", (param_slider){0.01, 2.5, 0.01, 0});
    assert_slider(PARAM_MATERIAL, "ior", NULL, "4", (param_slider){1, 8, 0.01, 0});
    assert_slider(PARAM_MATERIAL, "absorb_per_m", NULL, "1,2,300", (param_slider){0, 600, 0, 1e-5 * 600});
    assert_slider(PARAM_MESH, "gravity", NULL, "0,-50,0", (param_slider){-100, 100, 0.05, 0});
}

static void sliders_contain_the_value_and_stay_in_range(void **state)
{
    (void)state;
    size_t count = 0;
    for (size_t i = 0; i < param_count(); i++) {
        const param *row = param_at(i);
        double value;
        if (!param_has_slider(row))
            continue;
        const param_slider s = param_slider_of(row, NULL, row->fallback);
        assert_true(s.lowest >= row->lowest && s.highest <= row->highest && s.lowest < s.highest && s.step >= 0);
        assert_true(!row->above_lowest || s.lowest > row->lowest);
        assert_true(row->type != PARAM_INT || s.step == 1);
        assert_true(s.log_from == 0 || s.log_from >= s.lowest);
        if (number_parse_real(row->fallback, &value))
            assert_true(value >= s.lowest && value <= s.highest);
        assert_true(!row->coefficient || (row->type == PARAM_COLOR && row->highest > 1));
        count++;
    }
    assert_true(count > 100);
}

static param_match match_of(const char *path, const char *words)
{
    const char *dot = strchr(path, '.');
    const param *row = param_find(strncmp(path, "render", 6) == 0   ? PARAM_RENDER
                                  : strncmp(path, "camera", 6) == 0 ? PARAM_CAMERA
                                  : strncmp(path, "lamp", 4) == 0   ? PARAM_LIGHT
                                                                    : PARAM_SOLID,
                                  dot + 1);
    assert_non_null(row);
    return param_matches(row, path, words);
}

static void words_find_parameters(void **state)
{
    (void)state;
    static const struct {
        const char *path, *words;
        param_match match;
    } cases[] = {
        {"render.depth", "", PARAM_IN_NAME},
        {"render.depth", "dep", PARAM_IN_NAME},
        {"render.depth", "RENDER  depth", PARAM_IN_NAME},
        {"camera.fov_deg", "deg", PARAM_IN_NAME},
        {"render.depth", "epth", PARAM_IN_PATH},
        {"render.depth", "bounces", PARAM_IN_PATH},
        {"lamp.intensity", "brightness", PARAM_IN_PATH},
        {"lamp.intensity", "brigh", PARAM_IN_PATH},
        {"lamp.intensity", "lamp brightness", PARAM_IN_PATH},
        {"camera.fov_deg", "zoom", PARAM_IN_PATH},
        {"vessel.ior", "mirrors", PARAM_IN_PATH},
        {"render.depth", "recursion", PARAM_IN_TEXT},
        {"vessel.medium", "diamond", PARAM_IN_TEXT},
        {"render.depth", "recursion brightness", PARAM_NO_MATCH},
        {"vessel.radius", "br", PARAM_NO_MATCH},
        {"vessel.ior", "soaps", PARAM_NO_MATCH},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_int_equal(match_of(cases[i].path, cases[i].words), cases[i].match);
}

static status same_as_fallback(void *context, const char *path, const param *row, const char *value)
{
    (void)path;
    assert_string_equal(value, row->fallback);
    ++*(size_t *)context;
    return STATUS_OK;
}

/* So a scene prints its defaults in the same form as the table. */
static void an_empty_scene_has_the_defaults(void **state)
{
    (void)state;
    scene *s = scene_create();
    assert_non_null(s);
    size_t count = 0;
    assert_int_equal(scene_each_param(s, same_as_fallback, &count), STATUS_OK);
    assert_int_equal(count, 41 + 13 + 14); /* of render, camera, background: their objects are there at once */
    assert_int_equal(s->render.width, 800);
    assert_int_equal(s->render.shadows, SHADOWS_ATTENUATED);
    assert_int_equal(s->render.schedule, SCHEDULE_DYNAMIC);
    assert_int_equal(s->render.pool, 1);
    assert_int_equal(s->camera.aimed, 1);
    scene_destroy(s);
}

/* ---- setting ---- */

static void values_of_every_type_are_set_and_read(void **state)
{
    (void)state;
    static const struct {
        const char *path, *value, *got;
    } cases[] = {
        {"render.depth", "8", "8"},
        {"render.depth", " 0 ", "0"},
        {"render.min_weight", "0.1", "0.1"},
        {"render.min_weight", "1e-3", "0.001"},
        {"render.weights", "constant", "constant"},
        {"render.pool", "off", "off"},
        {"render.threads", "8", "8"},
        {"render.threads", " auto ", "auto"},
        {"render.samples", "4", "4"},
        {"camera.position", "0,2.75,-6", "0,2.75,-6"},
        {"camera.position", "[0, 1e2, -.5]", "0,100,-0.5"},
        {"camera.position.y", "3", "3"},
        {"background.image", "sky 1.png", "sky 1.png"},
        {"background.image", "", ""},
        {"lamp.color", "1,0.5,0.25", "1,0.5,0.25"},
        {"lamp.color.g", "0.75", "0.75"},
        {"vessel.ior", "1.3", "1.3"},
        {"vessel.inner_radius", "0.8", "0.8"},
        {"tank.m", "2", "2"},
        {"block.size.z", "0.125", "0.125"},
        {"ground.visible", "off", "off"},
        {"ground.visible", "yes", "on"},
        {"ground.visible", "no", "off"},
        {"ground.visible", "true", "on"},
        {"ground.visible", "False", "off"},
        {"ground.visible", "ON", "on"},
        {"ground.visible", "off", "off"},
        {"block.priority", "-3", "-3"},
    };
    scene *s = make();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        set(s, cases[i].path, cases[i].value);
        assert_value(s, cases[i].path, cases[i].got);
    }
    assert_value(s, "camera.position", "0,3,-0.5");
    assert_value(s, "lamp.color", "1,0.75,0.25");
    assert_true(s->solids[3].shape.m == 2 && s->solids[2].shape.size.z == 0.125 && s->solids[4].visible == 0);
    assert_true(s->lights[0].color.y == 0.75 && s->render.weights == WEIGHTS_CONSTANT);
    scene_destroy(s);
}

static void a_material_changes_all_its_solids_and_a_solid_only_itself(void **state)
{
    (void)state;
    scene *s = make();
    assert_value(s, "vessel.ior", "1.5");
    assert_value(s, "lens.ior", "1.7"); /* overridden in the file */
    set(s, "vessel.ior", "1.4");
    assert_value(s, "glass.ior", "1.5");
    assert_value(s, "lens.ior", "1.7");
    set(s, "glass.ior", "1.6"); /* the last setting wins, for all solids */
    assert_value(s, "vessel.ior", "1.6");
    assert_value(s, "lens.ior", "1.6");
    assert_value(s, "block.ior", "1");
    set(s, "glass.color.g", "0.5");
    assert_value(s, "lens.color", "1,0.5,1");
    scene_destroy(s);
}

static void the_last_of_target_and_angles_applies(void **state)
{
    (void)state;
    scene *s = make();
    set(s, "camera.position", "1,2,3");
    set(s, "camera.target", "2,2,4");
    assert_int_equal(s->camera.aimed, 1);
    assert_value_near(s, "camera.yaw_deg", 45);
    assert_value_near(s, "camera.pitch_deg", 0);
    set(s, "camera.pitch_deg", "30"); /* the yaw stays */
    assert_int_equal(s->camera.aimed, 0);
    assert_true(fabs(s->camera.yaw_deg - 45) < 1e-12);
    assert_value_near(s, "camera.target.y", 2.5); /* one unit ahead */
    assert_value_near(s, "camera.target.x", 1 + sqrt(0.375));
    set(s, "camera.position", "0,0,0"); /* the direction is unchanged */
    assert_value(s, "camera.pitch_deg", "30");
    set(s, "camera.yaw_deg", "-90");
    set(s, "camera.pitch_deg", "0");
    assert_value(s, "camera.target", "-1,0,0");
    set(s, "camera.target.y", "1"); /* the other elements are those of the current direction */
    assert_int_equal(s->camera.aimed, 1);
    assert_value_near(s, "camera.pitch_deg", 45);
    assert_value_near(s, "camera.yaw_deg", -90);
    scene_destroy(s);
}

static void setting_an_image_selects_the_image_background(void **state)
{
    (void)state;
    scene *s = make();
    set(s, "background.image", "");
    assert_value(s, "background.kind", "uniform");
    set(s, "background.image", "sky.png");
    assert_value(s, "background.kind", "image");
    set(s, "background.kind", "gradient"); /* the last one wins */
    assert_value(s, "background.kind", "gradient");
    assert_value(s, "background.image", "sky.png");
    scene_destroy(s);
}

typedef struct copy {
    scene *s;
    size_t count;
} copy;

static status set_in_copy(void *context, const char *path, const param *row, const char *value)
{
    copy *c = context;
    assert_non_null(row);
    c->count++;
    return scene_set(c->s, path, value, NULL);
}

static status compare_with_copy(void *context, const char *path, const param *row, const char *value)
{
    (void)row;
    assert_value(((copy *)context)->s, path, value);
    return STATUS_OK;
}

static void expect_reproduced(const scene *changed)
{
    copy c = {.s = make()};
    assert_int_equal(scene_each_param(changed, set_in_copy, &c), STATUS_OK);
    assert_true(c.count > 100);
    assert_int_equal(scene_each_param(changed, compare_with_copy, &c), STATUS_OK);
    assert_int_equal(c.s->camera.aimed, changed->camera.aimed);
    assert_int_equal(c.s->background.kind, changed->background.kind);
    scene_destroy(c.s);
}

static void printed_parameters_give_the_same_scene(void **state)
{
    (void)state;
    scene *s = make();
    expect_reproduced(s);
    set(s, "glass.ior", "1.1"); /* before the solid's own values, unlike the order of printing */
    set(s, "lens.ior", "1.33333333333333333");
    set(s, "vessel.reflectivity", "0.1");
    set(s, "glass.reflectivity", "0.3");
    set(s, "render.shadows", "opaque");
    set(s, "background.image", "a b.png");
    set(s, "camera.target", "0.1,0.2,0.30000000000000004");
    expect_reproduced(s);
    set(s, "background.kind", "gradient"); /* while an image that is not shown is set */
    expect_reproduced(s);
    set(s, "camera.pitch_deg", "-12.3");
    expect_reproduced(s);
    set(s, "camera.position", "9,8,7");
    expect_reproduced(s);
    scene_destroy(s);
}

static status stop_at_third(void *context, const char *path, const param *row, const char *value)
{
    (void)path, (void)row, (void)value;
    return ++*(int *)context == 3 ? STATUS_INTERRUPTED : STATUS_OK;
}

static void a_visit_stops_when_the_callback_fails(void **state)
{
    (void)state;
    scene *s = make();
    int count = 0;
    assert_int_equal(scene_each_param(s, stop_at_third, &count), STATUS_INTERRUPTED);
    assert_int_equal(count, 3);
    scene_destroy(s);
}

/* ---- errors ---- */

static void errors_of_paths_and_values_name_the_valid_ones(void **state)
{
    (void)state;
    static const struct {
        const char *assignment, *text;
    } cases[] = {
        {"vesel.ior=1", "the scene has no object 'vesel'; did you mean 'vessel.ior'?"},
        {"rendr.depth=1", "the scene has no object 'rendr'; did you mean 'render.depth'?"},
        {"vessel.iro=1", "vessel has no parameter 'iro'; did you mean 'vessel.ior'?"},
        {"render.dpeth=1", "render has no parameter 'dpeth'; did you mean 'render.depth'?"},
        {"depth=1", "the scene has no object 'depth'; did you mean 'render.depth'?"},
        {"fov_dge=1", "the scene has no object 'fov_dge'; did you mean 'camera.fov_deg'?"},
        {"lens.height=2",
         "lens is a sphere, which has no height; a sphere has follows, position, rotation, radius, points, "
         "scale, priority, visible, "
         "and the parameters of a material"},
        {"lens.n=1.5", "lens has no parameter 'n'; did you mean 'lens.ior'?"},
        {"lens.opacity=0.5", "lens has no parameter 'opacity'; did you mean 'lens.transparency'?"},
        {"lens.material=glass",
         "lens has no parameter 'material'; shape and material are set in the scene file or by cuvette scene; "
         "for glass set lens.transparency=1 and lens.ior=1.5"},
        {"lens.radius=75cm", "lens.radius: '75cm' is not a finite number; write only the number, in scene units"},
        {"lens.ior=1,5", "lens.ior: '1,5' is not a finite number; a decimal comma? write 1.5"},
        {"camera.fov=45", "camera has no parameter 'fov'; did you mean 'camera.fov_deg'?"},
        {"camera.5=1",
         "camera has no parameter '5'; camera has position, target, yaw_deg, pitch_deg, roll_deg, "
         "projection, fov_deg, view_height, aperture, focus, analyser, analyser_angle_deg, exposure, tone, white"},
        {"fov=45", "the scene has no object 'fov'; did you mean 'camera.fov_deg'?"},
        {"lens.visible=of", "lens.visible: 'of' is not one of the choices; give one of: off, on"},
        {"lens.visible=noo", "lens.visible: 'noo' is not one of the choices; give one of: off, on"},
        {"render.shadows=no", "render.shadows: 'no' is not one of the choices; give one of: off, opaque, attenuated"},
        {"glass.radius=2",
         "glass has no parameter 'radius'; glass has color, color_data, ambient, diffuse, specular, shininess, "
         "emission, reflectivity, transparency, ior, extinction, medium, coefficients, medium_data, extraordinary_ior, "
         "optic_axis, film_thickness_nm, film_ior, coating, coating_data, sheet, sheet_axis, sheet_pass, sheet_block, "
         "retardance_deg, "
         "birefringence, roughness, absorb_per_m, absorb_spectrum, absorb_data, scatter_per_m, "
         "..."},
        {"lamp.position.w=2", "lamp.position has no element 'w'; the elements are .x, .y and .z"},
        {"lamp.color.x=2", "lamp.color has no element 'x'; the elements are .r, .g and .b"},
        {"lamp.position.xy=2", "lamp.position has no element 'xy'; the elements are .x, .y and .z"},
        {"lamp.position.=2", "lamp.position has no element ''; the elements are .x, .y and .z"},
        {"render.depth.x=2", "render.depth has no elements; remove the part after the second dot"},
        {"render.depth", "'render.depth' has no '='; write path=value, such as render.depth=8"},
        {"render.depth=", "render.depth has no value; give an integer 0..64, or unlimited"},
        {"render.depth=65", "render.depth: 65 is out of range; give an integer 0..64, or unlimited"},
        {"render.depth=4.0", "render.depth: '4.0' is not an integer; give an integer 0..64, or unlimited"},
        {"render.samples=3", "render.samples: 3 is out of range; give one of: 1, 4, 9, 16, 25, 36, 49, 64"},
        {"render.schedule=dinamic",
         "render.schedule: 'dinamic' is not one of the choices; did you mean 'dynamic'? It is one of: columns, "
         "rows, tiles, dynamic"},
        {"render.pin=", "render.pin has no value; give one of: none, compact, scatter"},
        {"render.threads=0", "render.threads: 0 is out of range; give an integer 1..1024, or auto"},
        {"render.threads=automatic", "render.threads: 'automatic' is not an integer; give an integer 1..1024, or auto"},
        {"render.depth=auto", "render.depth: 'auto' is not an integer; give an integer 0..64, or unlimited"},
        {"camera.fov_deg=0", "camera.fov_deg: 0 is out of range; give a number > 0, at most 179"},
        {"camera.fov_deg=nan", "camera.fov_deg: 'nan' is not a finite number; give a number > 0, at most 179"},
        {"camera.position=1,2", "camera.position: 2 values instead of 3; give 3 numbers, each -1000000..1000000"},
        {"camera.position=1,inf,2", "camera.position.y: 'inf' is not a finite number; give a number -1000000..1000000"},
        {"lamp.color=0,-1,0", "lamp.color.g: -1 is out of range; give a number 0..10000"},
        {"lens.scale=-1,0,1", "lens.scale.y: 0 is out of range; give a number -1000000..1000000, not 0"},
        {"lens.scale=1,-0,1", "lens.scale.y: -0 is out of range; give a number -1000000..1000000, not 0"},
        {"block.size.x=0", "block.size.x: 0 is out of range; give a number > 0, at most 1000000"},
        {"vessel.ior=0x1p3", "vessel.ior: '0x1p3' is not a finite number; give a number > 0, at most 1000000000"},
        {"background.image=a\nb", "background.image: the path contains a control character; give a path of a file"},
    };
    scene *s = make(), *untouched = make();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        diagnostic why = {.what = ""};
        char text[DIAGNOSTIC_TEXT_MAX];
        assert_int_equal(scene_set_assignment(s, cases[i].assignment, &why), STATUS_BAD_INPUT);
        assert_string_equal(diagnostic_text(&why, text, sizeof text), cases[i].text);
        assert_int_equal(scene_set_assignment(s, cases[i].assignment, NULL), STATUS_BAD_INPUT);
    }
    copy c = {.s = s};
    assert_int_equal(scene_each_param(untouched, compare_with_copy, &c), STATUS_OK);
    scene_destroy(s);
    scene_destroy(untouched);
}

static void malformed_paths_are_refused(void **state)
{
    (void)state;
    static const char *const paths[] = {"",
                                        ".",
                                        "..",
                                        "...",
                                        "render",
                                        "render.",
                                        ".depth",
                                        "render..x",
                                        "vessel",
                                        "lights.lamp",
                                        "solid.ior",
                                        "camera.aimed",
                                        "vessel.shape",
                                        "vessel.material",
                                        "lamp.position.x.y"};
    scene *s = make();
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        char *value;
        diagnostic why = {.what = ""};
        assert_int_equal(scene_set(s, paths[i], "1", &why), STATUS_BAD_INPUT);
        assert_true(why.what[0] && why.remedy[0]);
        assert_int_equal(scene_get(s, paths[i], &value, NULL), STATUS_BAD_INPUT);
        assert_null(value);
    }
    char huge[5000];
    memset(huge, 'a', sizeof huge - 1);
    huge[sizeof huge - 1] = 0;
    assert_int_equal(scene_set(s, huge, "1", NULL), STATUS_BAD_INPUT);
    assert_int_equal(scene_set(s, "render.depth", huge, NULL), STATUS_BAD_INPUT);
    assert_int_equal(scene_set(s, "background.image", huge, NULL), STATUS_BAD_INPUT);
    scene_destroy(s);
}

static void an_assignment_splits_at_its_first_equals_sign(void **state)
{
    (void)state;
    scene *s = make();
    assert_int_equal(scene_set_assignment(s, "background.image=a=b.png", NULL), STATUS_OK);
    assert_value(s, "background.image", "a=b.png");
    scene_destroy(s);
}

/* Identities of cells omit values at the first default of a parameter, so it must never change. A new parameter gets a
 * line here; a parameter whose default changes gets a first_default in the table, and its line stays. */
static void first_defaults_never_change(void **state)
{
    (void)state;
    FILE *file = fopen("tests/data/first_defaults.tsv", "r");
    assert_non_null(file);
    char line[500];
    size_t count = 0;
    for (; fgets(line, sizeof line, file); count++) {
        char *value = strchr(line, '\t');
        assert_non_null(value);
        *value++ = 0;
        value[strcspn(value, "\n")] = 0;
        const param *row = count < param_count() ? param_at(count) : NULL;
        char name[100], *text = row ? param_first_default_text(row) : NULL;
        if (row)
            snprintf(name, sizeof name, "%s.%s", param_group_name(row->group), row->name);
        for (size_t i = 0; !row || strcmp(name, line) != 0; i++) { /* the order may change */
            if (i == param_count())
                fail_msg("%s is gone: rows that set it would lose their cells", line);
            row = param_at(i);
            snprintf(name, sizeof name, "%s.%s", param_group_name(row->group), row->name);
            free(text);
            text = param_first_default_text(row);
        }
        if (strcmp(text, value) != 0)
            fail_msg("the first default of %s was '%s', not '%s': set first_default", line, value, text);
        free(text);
    }
    fclose(file);
    if (count != param_count())
        fail_msg("%zu of %zu parameters are in tests/data/first_defaults.tsv", count, param_count());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_are_complete_and_defaults_are_in_range),
        cmocka_unit_test(ranges_have_readable_texts),
        cmocka_unit_test(sliders_are_the_useful_part_of_a_range),
        cmocka_unit_test(sliders_contain_the_value_and_stay_in_range),
        cmocka_unit_test(words_find_parameters),
        cmocka_unit_test(an_empty_scene_has_the_defaults),
        cmocka_unit_test(values_of_every_type_are_set_and_read),
        cmocka_unit_test(a_material_changes_all_its_solids_and_a_solid_only_itself),
        cmocka_unit_test(the_last_of_target_and_angles_applies),
        cmocka_unit_test(setting_an_image_selects_the_image_background),
        cmocka_unit_test(printed_parameters_give_the_same_scene),
        cmocka_unit_test(a_visit_stops_when_the_callback_fails),
        cmocka_unit_test(errors_of_paths_and_values_name_the_valid_ones),
        cmocka_unit_test(malformed_paths_are_refused),
        cmocka_unit_test(an_assignment_splits_at_its_first_equals_sign),
        cmocka_unit_test(first_defaults_never_change),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
