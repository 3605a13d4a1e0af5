/* Tests that a whole scene can be moved, rotated and scaled: with its camera the film is the same up to rounding; only
 * the named parts change; and nothing changes if one of them would leave its range. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "render_fixture.h"
#include "scene/model/edit/edit.h"
#include "scene/model/scene.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

/* A scene with every kind of length: ellipses, absorption, copies, checkers, textures of faces, of planes and by size,
 * lights with reach, spotlights. */
static const char everything[] =
    "render: {width: 60, height: 45, depth: 6, unit_m: 0.5}\n"
    "camera: {position: [1, 3, -7], target: [0, 0.8, 0], fov_deg: 40, roll_deg: 10}\n"
    "background: {color: [0.2, 0.3, 0.5], ambient: [0.5, 0.6, 0.7], absorb_per_m: [0.02, 0.01, 0]}\n"
    "textures: {tiles: {file: experiments/scenes/chequer.png, filter: bilinear}}\n"
    "meshes: {cube: {generate: box, size: [0.6, 0.4, 0.5]}, donut: {generate: torus, around: 24, tube: 16}}\n"
    "lights:\n"
    "  lamp: {position: [4, 7, -5], reach: 9}\n"
    "  torch: {kind: soft_cone, position: [-3, 4, -3], target: [0, 0, 0], half_angle_deg: 40, reach: 5}\n"
    "materials:\n"
    "  dull: {diffuse: 0.7, ambient: 0.1, checker: 0.31, color: [0.8, 0.3, 0.2]}\n"
    "  paper: {diffuse: 0.7, ambient: 0.1, texture: tiles}\n"
    "  glass: {transparency: 1, ior: 1.5, absorb_per_m: [0.9, 0.2, 0.1], color: [0.9, 0.6, 0.8], tint_distance: 0.7}\n"
    "solids:\n"
    "  ground: {shape: plane, material: paper, position: [0, -0.01, 0]}\n"
    "  wall: {shape: plane, material: dull, checker: 0.83, position: [0, 0, 6], rotation: [-90, 0, 0]}\n"
    "  cup: {shape: cup, material: glass, radius: 0.8, m: 1.5, inner_radius: 0.7, height: 1, floor: 0.1, position: "
    "[-1, 0, -1], rotation: [0, 20, 0]}\n"
    "  can: {shape: cylinder, material: paper, texture_size: 0.7, radius: 0.4, m: 0.8, height: 1.2, position: [0.8, 0, "
    "0.5], rotation: [0, 30, 5]}\n"
    "  ball: {shape: sphere, material: glass, radius: 0.5, position: [0.3, 0.6, -2]}\n"
    "  box: {shape: box, material: paper, size: [0.5, 0.7, 0.6], position: [2, 0.6, 0], rotation: [10, 40, 5]}\n"
    "  crates: {shape: mesh, mesh: cube, material: dull, copies: [2, 1, 2], spacing: [0.9, 1, 0.9], scale: [1, 1.5, "
    "1], position: [-2.5, 0.4, 0]}\n"
    "  ring: {shape: mesh, mesh: donut, material: glass, scale: [0.5, 0.5, 0.5], position: [-0.5, 1.8, 0.5], rotation: "
    "[60, 0, 10]}\n"
    "  asphere: {shape: lens, material: glass, radius_1: 0.8, radius_2: -1, a4_1: -0.3, a8_1: 0.5, a6_2: 0.4, "
    "thickness: "
    "0.4, position: [1.2, 1.1, -1.5], rotation: [-60, 0, 20]}\n";

static scene *whole_scene(const char *settings)
{
    scene *s = scene_from(everything);
    set_all(s, settings);
    return s;
}

static render_result *film_of(scene *s)
{
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    worked(scene_check(s, &why), &why);
    return render(s);
}

static int pixels_beyond(const render_result *a, const render_result *b, double much)
{
    int beyond = 0;
    for (int y = 0; y < a->img->height; y++)
        for (int x = 0; x < a->img->width; x++) {
            double most = 0.0;
            for (int c = 0; c < 3; c++)
                most = fmax(most, fabs(film_value(a->img, x, y, c) - film_value(b->img, x, y, c)));
            beyond += most > much;
        }
    return beyond;
}

typedef struct change {
    vec3 move, turn_deg;
    double scale;
} change;

static void apply(scene *s, const char *name, const change *c)
{
    diagnostic why = {0};
    worked(scene_turn(s, name, c->turn_deg, &why), &why);
    worked(scene_scale(s, name, c->scale, &why), &why);
    worked(scene_move(s, name, c->move, &why), &why);
}

static const change changes[] = {
    {{3.3, -2.1, 0.7}, {0, 0, 0}, 1.0}, {{0, 0, 0}, {0, 90, 0}, 1.0},  {{0, 0, 0}, {33, -71, 117}, 1.0},
    {{0, 0, 0}, {0, 0, 0}, 2.0},        {{0, 0, 0}, {0, 0, 0}, 0.037}, {{1, 2, 3}, {-17, 140, 62}, 7.3},
    {{0, 0, 0}, {0, 0, 180}, 1.0}, /* upside down: only roll */
};

/* At most a few pixels whose ray hits the other side of an edge. */
static void transforming_scene_and_camera_keeps_the_film(void **state)
{
    (void)state;
    static const char *const settings[] = {"", "camera.yaw_deg=-12 camera.pitch_deg=-15",
                                           "camera.position=0,6,0 camera.target=0,0,0 camera.roll_deg=0",
                                           "render.integrator=raycast render.lighting=lambert"};
    for (size_t k = 0; k < COUNT(settings); k++) {
        scene *s = whole_scene(settings[k]);
        render_result *before = film_of(s);
        for (size_t i = 0; i < COUNT(changes); i++) {
            scene *t = scene_clone(s);
            assert_non_null(t);
            apply(t, "all+camera", &changes[i]);
            render_result *after = film_of(t);
            const int beyond = pixels_beyond(before, after, 1e-8);
            if (beyond > 6)
                fail_msg("'%s', change %zu: %d pixels differ", settings[k], i, beyond);
            render_result_destroy(after);
            scene_destroy(t);
        }
        render_result_destroy(before);
        scene_destroy(s);
    }
}

/* Area lights, whose radiance is proportional to (reach / radius)^2; path tracing uses the same random numbers. */
static void path_traced_films_are_the_same(void **state)
{
    (void)state;
    scene *s = whole_scene("render.integrator=path render.paths=4 lamp.radius=0.5 torch.radius=0.3");
    render_result *before = film_of(s);
    apply(s, "solids+lights+camera", &(change){{0, 0, 0}, {0, 0, 0}, 4.0});
    render_result *after = film_of(s);
    assert_true(pixels_beyond(before, after, 1e-8) <= 2);
    render_result_destroy(before);
    render_result_destroy(after);
    scene_destroy(s);
}

static void assert_vector(vec3 v, double x, double y, double z)
{
    if (!(fabs(v.x - x) < 1e-12 && fabs(v.y - y) < 1e-12 && fabs(v.z - z) < 1e-12))
        fail_msg("%.17g,%.17g,%.17g instead of %g,%g,%g", v.x, v.y, v.z, x, y, z);
}

static void only_the_named_objects_change(void **state)
{
    (void)state;
    const struct {
        const char *name;
        scene_parts parts;
    } names[] = {
        {"all", {true, true, true, false}},       {"solids", {true, false, false, false}},
        {"lights", {false, true, true, false}},   {"solids+camera", {true, false, false, true}},
        {"camera+all", {true, true, true, true}}, {"lights+camera", {false, true, true, true}},
    };
    for (size_t k = 0; k < COUNT(names); k++) {
        const scene_parts p = names[k].parts;
        scene *s = whole_scene("");
        apply(s, names[k].name, &(change){{0, 0, 1}, {0, 90, 0}, 2.0}); /* (x, y, z) goes to (2 z, 2 y, 1 - 2 x) */
        if (p.solids)
            assert_vector(s->solids[2].shape.position, -2, 0, 3);
        else
            assert_vector(s->solids[2].shape.position, -1, 0, -1);
        assert_true(s->solids[2].shape.radius == (p.solids ? 1.6 : 0.8) && s->solids[2].shape.m == 1.5);
        assert_true(s->solids[2].shape.rotation_deg.y == (p.solids ? 110 : 20));
        assert_true(s->materials[0].value.checker == (p.solids ? 0.62 : 0.31) &&
                    s->solids[1].surface.checker == (p.solids ? 1.66 : 0.83));
        assert_true(s->solids[0].surface.texture_size == (p.solids ? 2.0 : 0.0) &&
                    s->solids[5].surface.texture_size == 0.0);
        assert_true(s->render.unit_m == (p.solids ? 0.25 : 0.5));
        if (p.lights)
            assert_vector(s->lights[1].position, -6, 8, 7);
        else
            assert_vector(s->lights[1].position, -3, 4, -3);
        assert_true(s->lights[0].reach == (p.lights ? 18 : 9));
        if (p.camera)
            assert_vector(s->camera.position, -14, 6, -1);
        else
            assert_vector(s->camera.position, 1, 3, -7);
        assert_true(fabs(s->camera.roll_deg - 10.0) < 1e-12);
        scene_destroy(s);
    }
}

static void one_solid_or_light_is_scaled_about_its_position(void **state)
{
    (void)state;
    scene *s = whole_scene("");
    assert_int_equal(scene_scale(s, "can", 3.0, NULL), STATUS_OK);
    const solid *can = &s->solids[3];
    assert_vector(can->shape.position, 0.8, 0, 0.5);
    assert_true(fabs(can->shape.radius - 1.2) < 1e-15 && fabs(can->surface.texture_size - 2.1) < 1e-15 &&
                s->render.unit_m == 0.5);
    assert_true(s->materials[1].value.texture_size == 0.0 && s->solids[5].shape.size.x == 0.5);
    assert_int_equal(scene_scale(s, "lamp", 2.0, NULL), STATUS_OK);
    assert_true(s->lights[0].reach == 18 && s->lights[1].reach == 5);
    assert_vector(s->lights[0].position, 4, 7, -5);
    assert_int_equal(scene_scale(s, "crates", 2.0, NULL), STATUS_OK);
    assert_vector(s->solids[6].shape.scale, 2, 3, 2);
    assert_vector(s->solids[6].shape.spacing, 1.8, 2, 1.8);
    assert_int_equal(scene_scale(s, "asphere", 2.0, NULL), STATUS_OK); /* 1 / length^3, ^5 and ^7 */
    const solid_shape *lens = &s->solids[8].shape;
    assert_true(lens->radius_1 == 1.6 && lens->even_1[0] == -0.3 / 8.0 && lens->even_1[2] == 0.5 / 128.0 &&
                lens->even_2[1] == 0.4 / 32.0 && lens->even_2[0] == 0.0);
    scene_destroy(s);
}

static void expect_refused(scene *s, status code, const diagnostic *why, const char *words)
{
    char message[DIAGNOSTIC_TEXT_MAX];
    diagnostic_text(why, message, sizeof message);
    if (code != STATUS_BAD_INPUT || !strstr(message, words))
        fail_msg("%d, '%s' instead of '%s'", (int)code, message, words);
    assert_true(s->solids[0].shape.position.x == 0.0 && s->solids[2].shape.radius == 0.8 &&
                s->lights[0].position.x == 4.0);
    assert_true(s->materials[0].value.checker == 0.31 && s->render.unit_m == 0.5 && s->camera.position.x == 1.0);
}

static void refused_transformations_do_not_change_the_scene(void **state)
{
    (void)state;
    scene *s = whole_scene("box.position=999999,0,0");
    const double bad[] = {0.0, -1.0, 2e9, (double)NAN, (double)INFINITY};
    diagnostic why = {0};
    expect_refused(s, scene_move(s, "all", vec3_make(10, 0, 0), &why), &why, "box.position.x: 1000009 is out of range");
    expect_refused(s, scene_scale(s, "all+camera", 2.0, &why), &why, "box.position");
    expect_refused(s, scene_turn(s, "all", vec3_make(2e6, 0, 0), &why), &why, "cannot be rotated by these angles");
    for (size_t k = 0; k < COUNT(bad); k++)
        expect_refused(s, scene_scale(s, "all", bad[k], &why), &why, "cannot be scaled by");
    expect_refused(s, scene_scale(s, "camera", 2.0, &why), &why, "cannot be scaled");
    expect_refused(s, scene_scale(s, "glass", 2.0, &why), &why, "cannot be scaled");
    static const char *const names[] = {"", "+", "all+", "+all", "all+foo", "All", "all++lights", "everything"};
    for (size_t k = 0; k < COUNT(names); k++)
        expect_refused(s, scene_move(s, names[k], vec3_make(1, 0, 0), &why), &why, "no object");
    scene_destroy(s);
}

/* A solid named "all" in an old scene moves alone, as before. */
static void an_object_named_all_has_precedence(void **state)
{
    (void)state;
    scene *s = scene_from("solids: {all: {shape: sphere, diffuse: 1}, other: {shape: sphere, diffuse: 1}}\n");
    assert_int_equal(scene_move(s, "all", vec3_make(1, 0, 0), NULL), STATUS_OK);
    assert_true(s->solids[0].shape.position.x == 1.0 && s->solids[1].shape.position.x == 0.0);
    assert_int_equal(scene_move(s, "all+lights", vec3_make(1, 0, 0), NULL), STATUS_OK);
    assert_true(s->solids[0].shape.position.x == 2.0 && s->solids[1].shape.position.x == 1.0);
    scene_destroy(s);
}

static bool has_inside(const scene *s, const char *container, const char *name)
{
    contents inside;
    bool found = false;
    assert_int_equal(contents_find(s, container, &inside, NULL), STATUS_OK);
    for (size_t i = 0; i < inside.count; i++)
        found |= strcmp(inside.name[i], name) == 0;
    contents_clear(&inside);
    return found;
}

/* The liquid's centre is in the vessel's box, and the vessel's in the liquid's: the larger one is the container. */
static void a_vessel_contains_its_liquid_and_its_rod(void **state)
{
    (void)state;
    scene *s = rod_scene("rod.rotation=0,0,20 vessel.rotation=0,40,0");
    assert_true(has_inside(s, "vessel", "liquid") && has_inside(s, "vessel", "rod"));
    assert_false(has_inside(s, "liquid", "vessel") || has_inside(s, "rod", "liquid") ||
                 has_inside(s, "vessel", "lamp"));
    assert_false(has_inside(s, "vessel", "vessel") || has_inside(s, "ground", "rod") || has_inside(s, "lamp", "rod"));
    set_all(s, "lamp.position=0.1,1,0.1 rod.position=1.5,2,0");
    assert_true(has_inside(s, "vessel", "lamp") && !has_inside(s, "vessel", "rod"));
    contents none;
    assert_int_equal(contents_find(s, "nothing", &none, NULL), STATUS_BAD_INPUT);
    scene_destroy(s);
}

static void assert_at(const scene *s, const char *name, double x, double y, double z)
{
    const vec3 at = s->solids[scene_find_solid(s, name)].shape.position;
    if (!(vec3_length(vec3_sub(at, vec3_make(x, y, z))) < 1e-12))
        fail_msg("%s is at %g, %g, %g, not %g, %g, %g", name, at.x, at.y, at.z, x, y, z);
}

/* The rod is at (0.2, 2.101, 0), the vessel's base at (0, 0.001, 0): a right angle about y takes x to -z. */
static void objects_together_are_one_rigid_body(void **state)
{
    (void)state;
    scene *s = rod_scene("");
    const char *others[] = {"rod", "liquid", "rod", "vessel"}, *wrong[] = {"clear"}, *missing[] = {"rods"};
    const object_list all = {"vessel", others, 4};
    assert_int_equal(scene_move_objects(s, &all, vec3_make(1, 0, 0), NULL), STATUS_OK);
    assert_at(s, "vessel", 1, 0.001, 0);
    assert_at(s, "liquid", 1, 0.051, 0);
    assert_at(s, "rod", 1.2, 2.101, 0);
    assert_int_equal(scene_turn_objects(s, &all, vec3_make(0, 90, 0), NULL), STATUS_OK);
    assert_at(s, "vessel", 1, 0.001, 0);
    assert_at(s, "rod", 1, 2.101, -0.2);
    assert_true(s->solids[scene_find_solid(s, "rod")].shape.rotation_deg.y == 90.0);
    assert_int_equal(scene_scale_objects(s, &all, 0.5, NULL), STATUS_OK);
    assert_at(s, "rod", 1, 0.001 + 0.5 * 2.1, -0.1);
    assert_true(s->solids[scene_find_solid(s, "liquid")].shape.radius == 0.475);
    const double vessel_radius = s->solids[scene_find_solid(s, "vessel")].shape.radius;
    assert_int_equal(scene_move_objects(s, &(object_list){"vessel", wrong, 1}, vec3_make(1, 0, 0), NULL),
                     STATUS_BAD_INPUT);
    assert_int_equal(scene_move_objects(s, &(object_list){"vessel", missing, 1}, vec3_make(1, 0, 0), NULL),
                     STATUS_BAD_INPUT);
    const char *last_missing[] = {"rod", "rods"};
    const object_list broken = {"vessel", last_missing, 2};
    assert_int_equal(scene_move_objects(s, &broken, vec3_make(1, 0, 0), NULL), STATUS_BAD_INPUT);
    assert_int_equal(scene_turn_objects(s, &broken, vec3_make(0, 90, 0), NULL), STATUS_BAD_INPUT);
    assert_int_equal(scene_scale_objects(s, &broken, 0.5, NULL), STATUS_BAD_INPUT);
    assert_at(s, "vessel", 1, 0.001, 0);
    assert_at(s, "rod", 1, 0.001 + 0.5 * 2.1, -0.1);
    assert_true(s->solids[scene_find_solid(s, "vessel")].shape.rotation_deg.y == 90.0);
    assert_true(s->solids[scene_find_solid(s, "rod")].shape.rotation_deg.y == 90.0);
    assert_true(s->solids[scene_find_solid(s, "vessel")].shape.radius == vessel_radius);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transforming_scene_and_camera_keeps_the_film),
        cmocka_unit_test(path_traced_films_are_the_same),
        cmocka_unit_test(only_the_named_objects_change),
        cmocka_unit_test(one_solid_or_light_is_scaled_about_its_position),
        cmocka_unit_test(refused_transformations_do_not_change_the_scene),
        cmocka_unit_test(an_object_named_all_has_precedence),
        cmocka_unit_test(a_vessel_contains_its_liquid_and_its_rod),
        cmocka_unit_test(objects_together_are_one_rigid_body),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
