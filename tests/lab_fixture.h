/* A laboratory in a temporary folder for tests of web/lab.h, with a client. Ownership: room_open creates, room_close
 * stops the laboratory and removes the folder; returned strings and JSON belong to the caller. */
#pragma once

#include "base/file.h"
#include "http_fixture.h"
#include "web/lab.h"
#include <ftw.h>
#include <sys/stat.h>

typedef struct lab_room {
    char folder[64], results[80];
    lab *lab;
    const http_server *server;
} lab_room;

/* A ball on a chequered floor: quick to trace, and every change affects the image. */
#define BALL_SCENE                                                                                               \
    "title: Ball\nrender: {width: 64, height: 48, depth: 3}\ncamera: {position: [0, 2, -6], target: [0, 1, "     \
    "0]}\nbackground: {color: [0.5, 0.7, 0.9]}\n"                                                                \
    "materials:\n  tiles: {ambient: 0.1, diffuse: 0.7, color: [0.8, 0.8, 0.8], checker_color: [0.2, 0.3, 0.4], " \
    "checker: 0.5}\n"                                                                                            \
    "lights:\n  lamp: {position: [4, 7, -5]}\n"                                                                  \
    "solids:\n  ground: {shape: plane, material: tiles, priority: 0}\n"                                          \
    "  ball: {shape: sphere, position: [0, 1.2, 0], radius: 1, transparency: 1, ior: 1.5, priority: 1}\n"

static inline char *room_path(const lab_room *room, const char *name)
{
    return text_format("%s/%s", room->folder, name);
}

static inline void room_write(const lab_room *room, const char *name, const char *text)
{
    char *path = room_path(room, name);
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fputs(text, out);
    assert_int_equal(fclose(out), 0);
    free(path);
}

/* Starts a laboratory in a folder that exists. file: the scene's name in it, NULL for none. */
static inline void room_start(lab_room *room, const char *file, lab_settings settings)
{
    char *path = file ? room_path(room, file) : NULL;
    snprintf(room->results, sizeof room->results, "%s/results", room->folder);
    settings.folder = room->folder;
    settings.scene = path;
    settings.results = room->results;
    settings.level = isa_best();
    settings.threads = 2;
    settings.requests_per_s = 1e9;
    settings.confine = true;
    diagnostic why = {.line = 0};
    char text[DIAGNOSTIC_TEXT_MAX];
    if (lab_start(&settings, &room->lab, &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, text, sizeof text));
    room->server = lab_server(room->lab);
    free(path);
}

/* yaml: the text of scene.yaml, which is opened; NULL: none. */
static inline void room_open_with(lab_room *room, const char *yaml, lab_settings settings)
{
    snprintf(room->folder, sizeof room->folder, "/tmp/cuvette-lab-XXXXXX");
    assert_non_null(mkdtemp(room->folder));
    if (yaml)
        room_write(room, "scene.yaml", yaml);
    room_start(room, yaml ? "scene.yaml" : NULL, settings);
}

static inline void room_open(lab_room *room, const char *yaml)
{
    room_open_with(room, yaml, (lab_settings){.port = 0});
}

static inline int room_unlink(const char *path, const struct stat *what, int kind, struct FTW *place)
{
    (void)what, (void)kind, (void)place;
    return remove(path);
}

static inline void room_remove(const char *folder)
{
    nftw(folder, room_unlink, 16, FTW_DEPTH | FTW_PHYS);
}

static inline void room_close(lab_room *room)
{
    lab_stop(room->lab);
    room_remove(room->folder);
}

/* Sends a request, checks the code, and returns the body as JSON (NULL if it is not JSON). */
static inline json_t *room_ask(const lab_room *room, const char *method, const char *target, const char *body, int code)
{
    char *reply = client_ask(room->server, method, target, body ? "Content-Type: application/json\r\n" : "", body);
    if (reply_code(reply) != code)
        fail_msg("%s %s %s: expected %d, got: %.800s", method, target, body ? body : "", code, reply);
    json_t *json = json_loads(reply_body(reply), JSON_DECODE_ANY, NULL);
    free(reply);
    return json;
}

static inline json_t *room_get(const lab_room *room, const char *target)
{
    return room_ask(room, "GET", target, NULL, 200);
}

/* The generation of a change. */
static inline json_int_t room_post(const lab_room *room, const char *target, const char *body)
{
    json_t *made = room_ask(room, "POST", target, body, 200);
    const json_int_t generation = json_integer_value(json_object_get(made, "generation"));
    json_decref(made);
    return generation;
}

/* A request that must be refused; returns "error; remedy". */
static inline char *room_refused(const lab_room *room, const char *method, const char *target, const char *body,
                                 int code)
{
    json_t *json = room_ask(room, method, target, body, code);
    const char *error = json_string_value(json_object_get(json, "error")),
               *remedy = json_string_value(json_object_get(json, "remedy"));
    assert_non_null(error);
    assert_non_null(remedy);
    assert_true(error[0] != 0);
    char *text = text_format("%s; %s", error, remedy);
    json_decref(json);
    return text;
}

/* The body of a reply of that type, such as an image. */
static inline unsigned char *room_bytes(const lab_room *room, const char *target, const char *type, size_t *size)
{
    char *reply = client_ask(room->server, "GET", target, "", NULL), *head = text_format("Content-Type: %s", type);
    if (reply_code(reply) != 200 || !reply_has(reply, head))
        fail_msg("%s: expected %s, got: %.800s", target, type, reply);
    const char *length = strstr(reply, "Content-Length: ");
    assert_non_null(length);
    *size = (size_t)strtoul(length + strlen("Content-Length: "), NULL, 10);
    unsigned char *bytes = malloc(*size + 1);
    assert_non_null(bytes);
    memcpy(bytes, reply_body(reply), *size);
    free(head);
    free(reply);
    return bytes;
}

/* Waits for the final image of the scene document and returns the hash of its film. */
static inline char *room_film(const lab_room *room)
{
    free(client_ask(room->server, "GET", "/api/picture.png?wait=1", "", NULL));
    json_t *state = room_get(room, "/api/state");
    const char *hash = json_string_value(json_object_get(json_object_get(state, "picture"), "film_hash"));
    assert_non_null(hash);
    char *copy = strdup(hash);
    json_decref(state);
    return copy;
}
