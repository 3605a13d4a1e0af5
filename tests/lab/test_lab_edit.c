/* Tests of objects in a running laboratory: they are added, changed and removed completely or not at all. */
#include "lab_edit_fixture.h"
#include "whole.h"
#include <pthread.h>

static void each_added_solid_is_visible(void **state)
{
    const room *r = *state;
    static const char *const shapes[] = {"torus",    "cone", "prism", "lens",   "plane",
                                         "cylinder", "cup",  "box",   "sphere", "mesh"};
    enum { ALONE = 4 }; /* that many are removed again: ten at one point would hide each other */
    char before[64], after[64], word[64];
    film(r, before);
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        char *body = text_format("{\"kind\": \"solid\", \"shape\": \"%s\"}", shapes[i]);
        json_t *reply = ask(r, 200, "POST", "/api/objects", body);
        const char *name = json_string_value(json_object_get(reply, "name"));
        assert_string_equal(name, strcmp(shapes[i], "mesh") == 0 ? "ring" : shapes[i]);
        assert_string_equal(word_of(r, name, "shape", word), shapes[i]);
        film(r, after);
        assert_string_not_equal(before, after);
        if (i < ALONE)
            expect(r, 200, "POST", "/api/undo", "{}");
        else
            memcpy(before, after, sizeof before);
        json_decref(reply);
        free(body);
    }
    json_t *second = ask(r, 200, "POST", "/api/objects", "{\"kind\": \"solid\", \"shape\": \"box\"}");
    assert_string_equal(json_string_value(json_object_get(second, "name")), "box2");
    json_decref(second);
    /* On the ground, a sixth of the viewing distance in size, and disjoint. */
    assert_float_equal(value(r, "box.size", 0), 1.0, 1e-9);
    assert_float_equal(value(r, "box.position", 1), 0.5, 1e-9);
    assert_float_equal(value(r, "cup.position", 1), 0.0, 1e-9);
    assert_true(hypot(value(r, "box.position", 0) - value(r, "box2.position", 0),
                      value(r, "box.position", 2) - value(r, "box2.position", 2)) > 1.0);
}

static void lights_materials_models_and_slimes_are_added(void **state)
{
    const room *r = *state;
    char hash[64], next[64];
    film(r, hash);
    expect(r, 200, "POST", "/api/objects", "{\"kind\": \"light\"}");
    film(r, next);
    assert_string_not_equal(hash, next);
    expect(r, 200, "POST", "/api/objects", "{\"kind\": \"material\"}");
    assert_true(has_object(r, "lamp2") && has_object(r, "paint"));
    json_t *model = ask(r, 200, "POST", "/api/objects", "{\"kind\": \"model\", \"file\": \"deep/Two sides.obj\"}");
    assert_string_equal(json_string_value(json_object_get(model, "name")), "Two-sides");
    json_decref(model);
    assert_true(has_object(r, "Two-sides-mesh"));
    assert_float_equal(value(r, "Two-sides.scale", 0), 0.05, 1e-9); /* the model's edges are 20 long, scaled to 1 */
    film(r, hash);
    assert_string_not_equal(hash, next);
    expect(r, 200, "POST", "/api/objects", "{\"kind\": \"slime\"}");
    film(r, next);
    assert_string_not_equal(hash, next);
    /* A slime, whose simulation takes time to load. */
    expect(r, 200, "POST", "/api/set", "{\"set\": {\"slime-mesh.time_s\": 0.3}}");
    film(r, hash);
    assert_string_not_equal(hash, next);
    static const char *const bad[] = {"{\"kind\": \"solid\"}",
                                      "{\"kind\": \"solid\", \"shape\": \"moebius\"}",
                                      "{\"kind\": \"cloud\"}",
                                      "{}",
                                      "{\"kind\": 1}",
                                      "{\"kind\": \"light\", \"name\": \"two words\"}",
                                      "{\"kind\": \"light\", \"name\": \"camera\"}",
                                      "{\"kind\": \"model\"}",
                                      "{\"kind\": \"model\", \"file\": \"../outside.obj\"}",
                                      "{\"kind\": \"model\", \"file\": \"image.png\"}",
                                      "{\"kind\": \"texture\", \"file\": \"../outside.png\"}",
                                      "{\"kind\": \"texture\", \"file\": \"deep/ball.yaml\"}",
                                      "{\"kind\": \"model\", \"file\": \"none.obj\"}"};
    const json_int_t before = generation(r);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        expect(r, 400, "POST", "/api/objects", bad[i]);
    expect(r, 409, "POST", "/api/objects", "{\"kind\": \"material\", \"name\": \"ball\"}");
    assert_int_equal(generation(r), before);
}

/* All in one undo step; a rejected value adds nothing. */
static void a_new_object_has_the_values_of_its_request(void **state)
{
    const room *r = *state;
    char word[64];
    expect(r, 200, "POST", "/api/objects",
           "{\"kind\": \"solid\", \"shape\": \"sphere\", \"set\": {\"medium\": \"water\", \"transparency\": 1, "
           "\"absorb_per_m\": [0.3, 0.05, 0.01]}}");
    assert_string_equal(word_of(r, "sphere", "shape", word), "sphere");
    assert_float_equal(value(r, "sphere.transparency", 0), 1.0, 0.0);
    assert_float_equal(value(r, "sphere.absorb_per_m", 1), 0.05, 0.0);
    expect(r, 200, "POST", "/api/undo", "{}");
    assert_false(has_object(r, "sphere"));
    static const char *const bad[] = {
        "{\"mediu\": \"water\"}", "{\"medium\": \"wine\"}", "{\"radius\": -1}", "{\"radius\": {}}", "[1]", "7"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char *body = text_format("{\"kind\": \"solid\", \"shape\": \"sphere\", \"set\": %s}", bad[i]);
        expect(r, 400, "POST", "/api/objects", body);
        free(body);
    }
    assert_false(has_object(r, "sphere"));
}

static void assert_near(double found, double expected)
{
    if (!(fabs(found - expected) <= 1e-12))
        fail_msg("%.17g, not %.17g", found, expected);
}

/* A small box in the ball moves along with it, and only with it. */
static void contents_are_listed_and_move_along(void **state)
{
    const room *r = *state;
    expect(r, 200, "POST", "/api/objects", "{\"kind\": \"solid\", \"shape\": \"box\", \"name\": \"seed\"}");
    expect(r, 200, "POST", "/api/set", "{\"set\": {\"seed.size\": [0.1, 0.1, 0.1], \"seed.position\": [0, 0, 0]}}");
    const double x = value(r, "ball.position", 0), y = value(r, "ball.position", 1), z = value(r, "ball.position", 2);
    char *at = text_format("{\"set\": {\"seed.position\": [%.17g, %.17g, %.17g]}}", x + 0.2, y, z);
    expect(r, 200, "POST", "/api/set", at);
    free(at);
    json_t *inside = ask(r, 200, "GET", "/api/objects/ball/contents", NULL);
    assert_int_equal(json_array_size(json_object_get(inside, "contents")), 1);
    assert_string_equal(json_string_value(json_array_get(json_object_get(inside, "contents"), 0)), "seed");
    json_decref(inside);
    expect(r, 404, "GET", "/api/objects/bal/contents", NULL);
    expect(r, 200, "POST", "/api/objects/ball/move", "{\"by\": [1, 0, 0], \"with\": [\"seed\"]}");
    assert_near(value(r, "seed.position", 0), x + 1.2);
    expect(r, 200, "POST", "/api/objects/ball/turn", "{\"by\": [0, 0, 90], \"with\": [\"seed\"]}");
    assert_near(value(r, "seed.position", 0), x + 1.0);
    assert_near(value(r, "seed.position", 1), y + 0.2);
    expect(r, 200, "POST", "/api/objects/ball/scale", "{\"factor\": 0.5, \"with\": [\"seed\"]}");
    assert_near(value(r, "seed.position", 1), y + 0.1);
    assert_near(value(r, "seed.size", 0), 0.05);
    const json_int_t before = generation(r);
    static const char *const bad[] = {"{\"by\": [1, 0, 0], \"with\": [\"sed\"]}", "{\"by\": [1, 0, 0], \"with\": [1]}",
                                      "{\"by\": [1, 0, 0], \"with\": \"seed\"}",
                                      "{\"by\": [1, 0, 0], \"with\": [\"camera\"]}"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        expect(r, 400, "POST", "/api/objects/ball/move", bad[i]);
    assert_int_equal(generation(r), before);
}

static void objects_are_moved_turned_scaled_renamed_and_copied(void **state)
{
    const room *r = *state;
    char word[64], text[256];
    expect(r, 200, "POST", "/api/objects/ball/move", "{\"by\": [1, 0, -0.5], \"gesture\": \"a\"}");
    expect(r, 200, "POST", "/api/objects/ball/move", "{\"by\": [1, 0, -0.5], \"gesture\": \"a\"}");
    assert_float_equal(value(r, "ball.position", 0), 2.0, 1e-12);
    assert_string_equal(state_text(r, "undo", text), "move ball");
    expect(r, 200, "POST", "/api/undo", "{}");
    assert_float_equal(value(r, "ball.position", 0), 0.0, 1e-12); /* one gesture is one undo step */
    expect(r, 200, "POST", "/api/objects/ball/turn", "{\"by\": [0, 90, 0]}");
    assert_float_equal(value(r, "ball.rotation", 1), 90.0, 1e-9);
    expect(r, 200, "POST", "/api/objects/beam/turn", "{\"by\": [0, 0, 30]}");
    expect(r, 200, "POST", "/api/objects/camera/move", "{\"by\": [0, 0, 1]}");
    assert_float_equal(value(r, "camera.position", 2), -5.0, 1e-12);
    const double radius = value(r, "ball.radius", 0);
    expect(r, 200, "POST", "/api/objects/ball/scale", "{\"factor\": 2, \"gesture\": \"b\"}");
    expect(r, 200, "POST", "/api/objects/ball/scale", "{\"factor\": 2, \"gesture\": \"b\"}");
    assert_true(fabs(value(r, "ball.radius", 0) - (4.0 * radius)) < 1e-12);
    expect(r, 200, "POST", "/api/undo", "{}");
    assert_true(fabs(value(r, "ball.radius", 0) - (radius)) < 1e-12);
    expect(r, 200, "POST", "/api/objects/ball/rename", "{\"to\": \"globe\"}");
    assert_true(has_object(r, "globe") && !has_object(r, "ball"));
    expect(r, 200, "POST", "/api/objects/globe/material", "{\"material\": \"stone\"}");
    assert_string_equal(word_of(r, "globe", "material", word), "stone");
    expect(r, 200, "POST", "/api/objects/globe/material", "{\"material\": null}");
    assert_string_equal(word_of(r, "globe", "material", word), "");
    assert_float_equal(value(r, "globe.diffuse", 0), 0.7, 1e-12); /* the solid keeps the stone's values */
    static const char *const copied[][2] = {
        {"globe", "globe2"}, {"lamp", "lamp2"}, {"stone", "stone2"}, {"lamp2", "lamp3"}, {"ground", "ground2"}};
    for (size_t i = 0; i < sizeof copied / sizeof *copied; i++) {
        char *target = text_format("/api/objects/%s/copy", copied[i][0]);
        json_t *reply = ask(r, 200, "POST", target, "{}");
        assert_string_equal(json_string_value(json_object_get(reply, "name")), copied[i][1]);
        json_decref(reply);
        free(target);
    }
    assert_true(fabs(value(r, "globe2.position", 0) - value(r, "globe.position", 0)) >= 2.0);
}

/* The rod of the reference scene, long and thin, in its vessel. */
static const char rod_scene[] =
    "render: {width: 40, height: 30}\ncamera: {position: [0, 2.75, -6], target: [0, 1.5, 0], fov_deg: 45}\n"
    "lights: {lamp: {position: [4, 7, -5]}}\n"
    "solids:\n  ground: {shape: plane, priority: 0}\n"
    "  vessel: {shape: cup, transparency: 1, ior: 1.5, position: [0, 0.001, 0], radius: 1, inner_radius: 0.9, height: "
    "3, floor: 0.1, priority: 2}\n"
    "  liquid: {shape: cylinder, transparency: 1, ior: 1.33, position: [0, 0.051, 0], radius: 0.95, height: 1.95, "
    "priority: 1}\n"
    "  rod: {shape: box, diffuse: 0.7, position: [0.2, 2.101, 0], size: [0.25, 3, 0.25], priority: 3}\n";

static double apart(const room *r, const char *a, const char *b, size_t axis)
{
    char of_a[32], of_b[32];
    snprintf(of_a, sizeof of_a, "%s.position", a);
    snprintf(of_b, sizeof of_b, "%s.position", b);
    return fabs(value(r, of_a, axis) - value(r, of_b, axis));
}

/* Are all corners of its bounding box inside the image of rod_scene? */
static bool is_seen(const room *r, const char *rod)
{
    char path[32];
    snprintf(path, sizeof path, "%s.position", rod);
    const double length = hypot(1.25, 6.0), half_height = tan(acos(-1.0) / 8.0), half_width = half_height * 4.0 / 3.0;
    for (int corner = 0; corner < 8; corner++) {
        const double x = value(r, path, 0) + (corner & 1 ? 0.125 : -0.125);
        const double y = value(r, path, 1) + (corner & 2 ? 1.5 : -1.5) - 2.75,
                     z = value(r, path, 2) + (corner & 4 ? 0.125 : -0.125) + 6.0;
        const double ahead = (6.0 * z - 1.25 * y) / length, up = (6.0 * y + 1.25 * z) / length;
        if (ahead <= 0.0 || fabs(x) > half_width * ahead || fabs(up) > half_height * ahead)
            return false;
    }
    return true;
}

static void copies_of_a_rod_are_visible_and_disjoint(void **state)
{
    const room *r = *state;
    static const char *const rods[] = {"rod", "rod2", "rod3", "rod4"};
    put(r, "lab/rod.yaml", rod_scene);
    expect(r, 200, "POST", "/api/open", "{\"file\": \"rod.yaml\"}");
    for (size_t i = 1; i < sizeof rods / sizeof *rods; i++) {
        expect(r, 200, "POST", "/api/objects/rod/copy", "{}");
        assert_true(is_seen(r, rods[i]));
        for (size_t k = 0; k < i; k++)
            assert_true(apart(r, rods[i], rods[k], 0) > 0.25 || apart(r, rods[i], rods[k], 2) > 0.25 ||
                        apart(r, rods[i], rods[k], 1) > 3.0);
    }
    assert_true(apart(r, "rod", "rod2", 0) < 0.3); /* the copy is in the liquid too */
}

static void meshes_and_textures_are_copied_and_removed(void **state)
{
    const room *r = *state;
    char hash[64], next[64];
    expect(r, 200, "POST", "/api/objects",
           "{\"kind\": \"model\", \"file\": \"deep/Two sides.obj\", \"name\": \"body\"}");
    expect(r, 200, "POST", "/api/objects", "{\"kind\": \"texture\", \"file\": \"image.png\", \"name\": \"cloth\"}");
    film(r, hash);
    expect(r, 200, "POST", "/api/objects/body-mesh/copy", "{}");
    expect(r, 200, "POST", "/api/objects/cloth/copy", "{}");
    assert_true(has_object(r, "body-mesh2") && has_object(r, "cloth2"));
    film(r, next);
    assert_string_equal(hash, next);
    expect(r, 200, "POST", "/api/objects/body/copy", "{}");
    film(r, next);
    assert_string_not_equal(hash, next);
    expect(r, 409, "DELETE", "/api/objects/body-mesh", "{}");
    expect(r, 200, "DELETE", "/api/objects/body", "{}");
    expect(r, 200, "DELETE", "/api/objects/body2", "{}");
    expect(r, 200, "DELETE", "/api/objects/body-mesh", "{}");
    expect(r, 200, "POST", "/api/undo", "{}");
    expect(r, 200, "POST", "/api/undo", "{}");
    expect(r, 200, "POST", "/api/undo", "{}");
    film(r, hash);
    assert_string_equal(hash, next);
}

/* A table, and a glass of a catalogue, which must be named. */
static void optical_data_are_added_from_files(void **state)
{
    const room *r = *state;
    char hash[64], next[64];
    put(r, "lab/paint.csv", "nm,R\n400,0.2\n700,0.6\n");
    put(r, "lab/two.agf",
        "NM A 2 0 1.5 60 0 1\nCD 1 0.01 0.2 0.02 1 100 0 0 0 0\nLD 0.4 0.7\n"
        "NM B 2 0 1.6 60 0 1\nCD 1.1 0.01 0.2 0.02 1 100 0 0 0 0\nLD 0.4 0.7\n");
    film(r, hash);
    expect(r, 200, "POST", "/api/objects", "{\"kind\": \"data\", \"file\": \"paint.csv\", \"name\": \"paint\"}");
    film(r, next);
    assert_string_equal(hash, next);
    assert_true(has_object(r, "paint"));
    expect(r, 200, "POST", "/api/set", "{\"set\": {\"ball.color_data\": \"paint\"}}");
    film(r, next);
    assert_string_not_equal(hash, next);
    expect(r, 409, "DELETE", "/api/objects/paint", "{}");
    expect(r, 400, "POST", "/api/objects", "{\"kind\": \"data\", \"file\": \"two.agf\"}");
    expect(r, 400, "POST", "/api/objects", "{\"kind\": \"data\", \"file\": \"two.agf\", \"set\": {\"glass\": \"C\"}}");
    expect(r, 200, "POST", "/api/objects", "{\"kind\": \"data\", \"file\": \"two.agf\", \"set\": {\"glass\": \"B\"}}");
    assert_true(has_object(r, "two"));
    expect(r, 400, "POST", "/api/objects", "{\"kind\": \"data\", \"file\": \"../outside.csv\"}");
}

static void groups_of_objects_are_moved_scaled_and_turned(void **state)
{
    const room *r = *state;
    const double lamp = value(r, "lamp.position", 0), ball = value(r, "ball.position", 0),
                 eye = value(r, "camera.position", 0);
    char text[256];
    expect(r, 200, "POST", "/api/objects/all/move", "{\"by\": [1, 0, 0]}");
    assert_true(fabs(value(r, "lamp.position", 0) - (lamp + 1.0)) < 1e-12);
    assert_true(fabs(value(r, "ball.position", 0) - (ball + 1.0)) < 1e-12);
    assert_true(fabs(value(r, "camera.position", 0) - (eye)) < 1e-12);
    assert_string_equal(state_text(r, "undo", text), "move all");
    expect(r, 200, "POST", "/api/objects/solids%2Bcamera/move", "{\"by\": [-1, 0, 0]}");
    assert_true(fabs(value(r, "lamp.position", 0) - (lamp + 1.0)) < 1e-12);
    assert_true(fabs(value(r, "ball.position", 0) - (ball)) < 1e-12);
    assert_true(fabs(value(r, "camera.position", 0) - (eye - 1.0)) < 1e-12);
    expect(r, 200, "POST", "/api/objects/lights/scale", "{\"factor\": 3}");
    assert_true(fabs(value(r, "lamp.position", 0) - (3.0 * (lamp + 1.0))) < 1e-12);
    expect(r, 200, "POST", "/api/objects/all%2Bcamera/turn", "{\"by\": [0, 0, 90]}");
    assert_true(fabs(value(r, "lamp.position", 1) - (3.0 * (lamp + 1.0))) < 1e-12);
    for (int i = 0; i < 4; i++)
        expect(r, 200, "POST", "/api/undo", "{}");
    assert_true(fabs(value(r, "lamp.position", 0) - (lamp)) < 1e-12);
}

static void invalid_object_changes_are_refused(void **state)
{
    const room *r = *state;
    const json_int_t before = generation(r);
    static const struct {
        int code;
        const char *method, *target, *body;
    } bad[] = {
        {404, "DELETE", "/api/objects/none", "{}"},
        {409, "DELETE", "/api/objects/stone", "{}"},
        {400, "DELETE", "/api/objects/camera", "{}"},
        {400, "DELETE", "/api/objects/render", "{}"},
        {404, "POST", "/api/objects/none/move", "{\"by\": [1, 0, 0]}"},
        {400, "POST", "/api/objects/ball/move", "{\"by\": [1, 0]}"},
        {400, "POST", "/api/objects/ball/move", "{\"by\": [1, 0, \"x\"]}"},
        {400, "POST", "/api/objects/ball/move", "{\"by\": [1e9, 0, 0]}"},
        {400, "POST", "/api/objects/ball/move", "{}"},
        {400, "POST", "/api/objects/ball/move", "{\"by\": [1, 0, 0], \"gesture\": 3}"},
        {400, "POST", "/api/objects/stone/move", "{\"by\": [1, 0, 0]}"},
        {404, "POST", "/api/objects/all%2Bnone/move", "{\"by\": [1, 0, 0]}"},
        {400, "POST", "/api/objects/all/move", "{\"by\": [1e9, 0, 0]}"},
        {404, "DELETE", "/api/objects/all", "{}"},
        {404, "POST", "/api/objects/all/copy", "{}"},
        {400, "POST", "/api/objects/all/scale", "{\"factor\": 0}"},
        {400, "POST", "/api/objects/ball/scale", "{}"},
        {400, "POST", "/api/objects/ball/scale", "{\"factor\": \"2\"}"},
        {400, "POST", "/api/objects/camera/scale", "{\"factor\": 2}"},
        {400, "POST", "/api/objects/background/move", "{\"by\": [1, 0, 0]}"},
        {400, "POST", "/api/objects/lamp/turn", "{\"by\": [10, 0, 0]}"},
        {400, "POST", "/api/objects/ball/turn", "{\"by\": [1e300, 0, 0]}"},
        {409, "POST", "/api/objects/ball/rename", "{\"to\": \"lamp\"}"},
        {400, "POST", "/api/objects/ball/rename", "{\"to\": \"camera\"}"},
        {400, "POST", "/api/objects/ball/rename", "{\"to\": \"two words\"}"},
        {400, "POST", "/api/objects/ball/rename", "{\"to\": \"\"}"},
        {400, "POST", "/api/objects/camera/rename", "{\"to\": \"eye\"}"},
        {404, "POST", "/api/objects/none/rename", "{\"to\": \"some\"}"},
        {400, "POST", "/api/objects/ball/material", "{\"material\": \"none\"}"},
        {400, "POST", "/api/objects/ball/material", "{}"},
        {400, "POST", "/api/objects/ball/material", "{\"material\": 3}"},
        {400, "POST", "/api/objects/lamp/material", "{\"material\": \"stone\"}"},
        {400, "POST", "/api/objects/lamp/material", "{\"material\": null}"},
        {404, "POST", "/api/objects/none/material", "{\"material\": null}"},
        {400, "POST", "/api/objects/render/copy", "{}"},
        {404, "POST", "/api/objects/none/copy", "{}"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        expect(r, bad[i].code, bad[i].method, bad[i].target, bad[i].body);
    assert_int_equal(generation(r), before);
}

/* Names stay unique, and the limit of objects holds. */
static void the_number_of_objects_is_limited(void **state)
{
    ONLY_IN_CHECK();
    const room *r = *state;
    char name[64];
    for (int i = 1; i <= 1022; i++) {
        json_t *reply = ask(r, 200, "POST", "/api/objects", "{\"kind\": \"light\"}");
        snprintf(name, sizeof name, "lamp%d", i + 1);
        assert_string_equal(json_string_value(json_object_get(reply, "name")), name);
        json_decref(reply);
    }
    expect(r, 400, "POST", "/api/objects", "{\"kind\": \"light\"}");
    for (int i = 1; i <= 63; i++)
        expect(r, 200, "POST", "/api/objects", "{\"kind\": \"solid\", \"shape\": \"plane\"}");
    expect(r, 400, "POST", "/api/objects", "{\"kind\": \"solid\", \"shape\": \"plane\"}");
    expect(r, 400, "POST", "/api/objects/ground/copy", "{}");
    expect(r, 200, "POST", "/api/objects/ball/copy", "{}");
}

typedef struct visitor {
    const room *r;
    int number;
    pthread_t thread;
} visitor;

static void *visit(void *of)
{
    const visitor *v = of;
    char *save = text_format("{\"file\": \"visitor%d.yaml\", \"replace\": true}", v->number),
         *target = text_format("/api/objects/mine%d", v->number);
    char *body = text_format("{\"kind\": \"solid\", \"shape\": \"box\", \"name\": \"mine%d\"}", v->number),
         *move = text_format("%s/move", target);
    for (int i = 0; i < 5; i++) {
        expect(v->r, 200, "POST", "/api/objects", body);
        expect(v->r, 200, "POST", move, "{\"by\": [0.1, 0, 0], \"gesture\": \"drag\"}");
        expect(v->r, 200, "POST", "/api/save", save);
        expect(v->r, 200, "GET", "/api/files", NULL);
        expect(v->r, 200, "POST", "/api/objects", "{\"kind\": \"texture\", \"file\": \"image.png\"}");
        expect(v->r, 200, "DELETE", target, "{}");
    }
    free(save);
    free(target);
    free(body);
    free(move);
    return NULL;
}

static void concurrent_edits_are_all_applied(void **state)
{
    enum { VISITORS = 4 };
    const room *r = *state;
    visitor all[VISITORS];
    const json_int_t before = generation(r);
    for (int i = 0; i < VISITORS; i++) {
        all[i] = (visitor){.r = r, .number = i};
        assert_int_equal(pthread_create(&all[i].thread, NULL, visit, &all[i]), 0);
    }
    for (int i = 0; i < VISITORS; i++)
        pthread_join(all[i].thread, NULL);
    assert_int_equal(generation(r), before + VISITORS * 5 * 4); /* no change was lost */
    assert_true(has_object(r, "image20") && !has_object(r, "mine0"));
    char hash[64];
    film(r, hash);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(each_added_solid_is_visible, enter, leave),
        cmocka_unit_test_setup_teardown(lights_materials_models_and_slimes_are_added, enter, leave),
        cmocka_unit_test_setup_teardown(a_new_object_has_the_values_of_its_request, enter, leave),
        cmocka_unit_test_setup_teardown(contents_are_listed_and_move_along, enter, leave),
        cmocka_unit_test_setup_teardown(objects_are_moved_turned_scaled_renamed_and_copied, enter, leave),
        cmocka_unit_test_setup_teardown(groups_of_objects_are_moved_scaled_and_turned, enter, leave),
        cmocka_unit_test_setup_teardown(copies_of_a_rod_are_visible_and_disjoint, enter, leave),
        cmocka_unit_test_setup_teardown(optical_data_are_added_from_files, enter, leave),
        cmocka_unit_test_setup_teardown(meshes_and_textures_are_copied_and_removed, enter, leave),
        cmocka_unit_test_setup_teardown(invalid_object_changes_are_refused, enter, leave),
        cmocka_unit_test_setup_teardown(the_number_of_objects_is_limited, enter, leave),
        cmocka_unit_test_setup_teardown(concurrent_edits_are_all_applied, enter, leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
