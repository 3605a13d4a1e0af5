/* A laboratory whose folder has a scene and files, inside another folder with files that it must not access. */
#pragma once

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "image/image.h"
#include "lab_fixture.h"
#include <math.h>

static const char small[] =
    "title: A ball\n"
    "render: {width: 48, height: 36}\n"
    "camera: {position: [0, 1, -6], target: [0, 1, 0]}\n"
    "materials: {stone: {color: [0.5, 0.5, 0.5], diffuse: 0.7, ambient: 0.2}}\n"
    "lights: {lamp: {position: [4, 8, -6]}, beam: {kind: cone, position: [0, 5, 0], target: [0, 0, 0]}}\n"
    "solids: {ground: {shape: plane, material: stone}, ball: {shape: sphere, position: [0, 1, 0], diffuse: 0.8, color: "
    "[0.8, 0.2, 0.1]}}\n";
static const char tetrahedron[] = "v 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/* The laboratory's folder is inside another folder with files that it must not access. */
typedef struct room {
    char *above, *inside;
    lab_room lab;
} room;

static void put(const room *r, const char *name, const char *text)
{
    char *path = text_format("%s/%s", r->above, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    free(path);
}

__attribute__((unused)) static bool is_there(const room *r, const char *name)
{
    char *path = text_format("%s/%s", r->above, name);
    const bool is = access(path, F_OK) == 0;
    free(path);
    return is;
}

static void start(room *r)
{
    char *ball = text_format("%s/deep/ball.yaml", r->inside);
    snprintf(r->lab.results, sizeof r->lab.results, "%s/results", r->inside);
    const lab_settings settings = {.folder = r->inside,
                                   .scene = ball,
                                   .results = r->lab.results,
                                   .level = isa_best(),
                                   .threads = 3,
                                   .requests_per_s = 1e9};
    diagnostic why = {.what = ""};
    if (lab_start(&settings, &r->lab.lab, &why) != STATUS_OK)
        fail_msg("%s", why.what);
    r->lab.server = lab_server(r->lab.lab);
    free(ball);
}

static void make_folder(const char *path)
{
    assert_int_equal(mkdir(path, 0700), 0);
}

__attribute__((unused)) static int enter(void **state)
{
    room *r = calloc(1, sizeof *r);
    char place[] = "/tmp/cuvette-edit-XXXXXX";
    r->above = strdup(mkdtemp(place));
    r->inside = text_format("%s/lab", r->above);
    make_folder(r->inside);
    char *deep = text_format("%s/deep", r->inside), *image_path = text_format("%s/image.png", r->inside),
         *outside = text_format("%s/outside.png", r->above);
    make_folder(deep);
    image *img = NULL;
    assert_int_equal(image_create(4, 2, &img, NULL), STATUS_OK);
    assert_int_equal(image_write(img, image_path, 8, NULL), STATUS_OK);
    assert_int_equal(image_write(img, outside, 8, NULL), STATUS_OK);
    image_destroy(img);
    free(deep);
    free(image_path);
    free(outside);
    put(r, "lab/deep/ball.yaml", small);
    put(r, "lab/deep/Two sides.obj", tetrahedron);
    put(r, "outside.yaml", small);
    put(r, "outside.obj", tetrahedron);
    put(r, "lab/climbs.yaml", "background: {image: ../outside.png}\n");
    put(r, "lab/climbs2.yaml", "meshes: {m: {file: ../outside.obj}}\nsolids: {s: {shape: mesh, mesh: m}}\n");
    put(r, "lab/wrong.yaml", "solids: {ball: {shape: sphere,\n  radios: 3}}\n");
    start(r);
    *state = r;
    return 0;
}

__attribute__((unused)) static int leave(void **state)
{
    room *r = *state;
    lab_stop(r->lab.lab);
    nftw(r->above, room_unlink, 16, FTW_DEPTH | FTW_PHYS);
    free(r->inside);
    free(r->above);
    free(r);
    return 0;
}

/* The JSON of a reply, whose code must be `code`; an error must have a message. */
static json_t *ask(const room *r, int code, const char *method, const char *target, const char *body)
{
    json_t *reply = room_ask(&r->lab, method, target, body, code);
    if (code >= 400)
        assert_true(json_is_string(json_object_get(reply, "error")) &&
                    json_is_string(json_object_get(reply, "remedy")));
    return reply;
}

static void expect(const room *r, int code, const char *method, const char *target, const char *body)
{
    json_decref(ask(r, code, method, target, body));
}

static json_int_t generation(const room *r)
{
    json_t *state = ask(r, 200, "GET", "/api/state", NULL);
    const json_int_t number = json_integer_value(json_object_get(state, "generation"));
    json_decref(state);
    return number;
}

/* A string of the state, "" for null; static memory. */
static const char *state_text(const room *r, const char *key, char text[256])
{
    json_t *state = ask(r, 200, "GET", "/api/state", NULL);
    const char *value = json_string_value(json_object_get(state, key));
    snprintf(text, 256, "%s", value ? value : "");
    json_decref(state);
    return text;
}

/* The hash of the final film of the scene document. */
static void film(const room *r, char hash[64])
{
    char *text = room_film(&r->lab);
    json_t *state = room_get(&r->lab, "/api/state");
    assert_true(json_is_null(json_object_get(state, "trouble")));
    snprintf(hash, 64, "%s", text);
    json_decref(state);
    free(text);
}

static json_t *find(const room *r, const char *list, const char *key, const char *name)
{
    json_t *all = ask(r, 200, "GET", "/api/scene", NULL), *found = NULL, *item;
    size_t i;
    json_array_foreach(json_object_get(all, list), i, item) if (strcmp(json_string_value(json_object_get(item, key)),
                                                                       name) == 0) found = json_incref(item);
    json_decref(all);
    return found;
}

__attribute__((unused)) static bool has_object(const room *r, const char *name)
{
    json_t *object = find(r, "objects", "name", name);
    json_decref(object);
    return object != NULL;
}

__attribute__((unused)) static const char *word_of(const room *r, const char *object_name, const char *key,
                                                   char text[64])
{
    json_t *object = find(r, "objects", "name", object_name);
    const char *word = json_string_value(json_object_get(object, key));
    snprintf(text, 64, "%s", word ? word : "");
    json_decref(object);
    return text;
}

__attribute__((unused)) static double value(const room *r, const char *path, size_t index)
{
    json_t *row = find(r, "params", "path", path), *v = json_object_get(row, "value");
    const double number = json_number_value(json_is_array(v) ? json_array_get(v, index) : v);
    json_decref(row);
    return number;
}
