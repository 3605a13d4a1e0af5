/* The desk's part of the API: the state, the scene, its parameters, undo, the camera. See web/README.md. */
#include "web/lab_private.h"
#include "base/number.h"
#include "base/text_writer.h"
#include "report/json.h"
#include "report/param_rows.h"
#include "scene/model/inert/inert.h"
#include "scene/model/params.h"
#include "scene/file/write.h"
#include "scene/model/camera_moves.h"
#include "web/session/command_line.h"
#include "web/api/scene_json.h"
#include "scene/model/open.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void get_state(void *of, const http_request *q, http_reply *r)
{
    (void)q;
    http_reply_json(r, 200, lab_state(of));
}

static void get_scene(void *of, const http_request *q, http_reply *r)
{
    lab *l = of;
    (void)q;
    uint64_t generation;
    scene *now = desk_take(l->desk, &generation), *opened = desk_take_opened(l->desk);
    json_t *told = now && opened ? scene_json(now, opened, generation) : NULL;
    scene_destroy(now);
    scene_destroy(opened);
    http_reply_json(r, 200, told);
}

/* --- set and reset --- */

/* One number or word; fresh memory, NULL for what is neither (or memory that is out). */
static char *item_text(const json_t *value)
{
    if (json_is_string(value))
        return strlen(json_string_value(value)) == json_string_length(value) ? strdup(json_string_value(value)) : NULL;
    if (json_is_boolean(value))
        return strdup(json_is_true(value) ? "on" : "off");
    char text[NUMBER_TEXT_MAX];
    return json_is_number(value) && isfinite(json_number_value(value))
               ? strdup(number_format(json_number_value(value), text))
               : NULL;
}

/* As scene_set takes it; likewise. */
static char *value_text(const json_t *value)
{
    if (!json_is_array(value))
        return item_text(value);
    char *joined = NULL;
    text_writer writer;
    if (text_writer_open(&writer, NULL) != STATUS_OK)
        return NULL;
    bool good = true;
    for (size_t i = 0; i < json_array_size(value) && good; i++) {
        char *one = item_text(json_array_get(value, i));
        good = one && fprintf(writer.stream, "%s%s", i ? "," : "", one) >= 0;
        free(one);
    }
    if (good)
        text_writer_close(&writer, &joined, NULL, NULL);
    else
        text_writer_abandon(&writer);
    return joined;
}

/* What is set, and notes on what of that does nothing (scene/model/inert/inert.h); NULL while there are none. */
typedef struct set_request {
    const json_t *values;
    json_t *notes;
} set_request;

/* A slime that moves on the page does so whatever its time_s. */
static void note_inert(set_request *x, const scene *s)
{
    const char *path;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)x->values, path, value)
    {
        inert_answer answer;
        if (!inert_ask(s, path, NULL, &answer) || strcmp(answer.rule, "time-0") == 0)
            continue;
        x->notes = x->notes ? x->notes : json_array();
        json_array_append_new(x->notes,
                              json_pack("{s:o, s:o, s:o}", "place", json_of_text(answer.note.place), "text",
                                        json_of_text(answer.note.text), "remedy", json_of_text(answer.note.remedy)));
    }
}

static status set_all(void *of, scene *s, diagnostic *why)
{
    set_request *x = of;
    const json_t *values = x->values;
    const char *path;
    json_t *value;
    status code = STATUS_OK;
    json_object_foreach((json_t *)(uintptr_t)values, path, value)
    {
        char *text = code == STATUS_OK ? value_text(value) : NULL;
        if (code == STATUS_OK && !text)
            code = diagnose(why, STATUS_BAD_INPUT, "give a number, a text or a list of numbers",
                            "%.200s: this is no value", path);
        else if (code == STATUS_OK)
            code = scene_set(s, path, text, why);
        free(text);
    }
    json_decref(x->notes);
    x->notes = NULL;
    if (code == STATUS_OK)
        note_inert(x, s);
    return code;
}

static void post_set(void *of, const http_request *q, http_reply *r)
{
    lab *l = of;
    json_t *body = http_body_json(q, r);
    if (!body)
        return;
    json_t *values = json_object_get(body, "set");
    const char *gesture;
    if (!json_is_object(values) || json_object_size(values) == 0) {
        http_reply_error(r, 400, "there is nothing to set", "give {\"set\": {PATH: VALUE}}");
    } else if (lab_take_gesture(body, &gesture, r)) {
        diagnostic why = {.line = 0};
        uint64_t generation = 0;
        char what[128];
        snprintf(what, sizeof what, "set %.100s", json_object_iter_key(json_object_iter(values)));
        set_request x = {values, NULL};
        const status code = desk_apply(l->desk, what, gesture, set_all, &x, &generation, &why);
        if (code == STATUS_OK && x.notes)
            http_reply_json(r, 200, json_pack("{s:I, s:O}", "generation", (json_int_t)generation, "notes", x.notes));
        else
            lab_reply_generation(r, code, generation, &why);
        json_decref(x.notes);
    }
    json_decref(body);
}

static void post_reset(void *of, const http_request *q, http_reply *r)
{
    enum { PATHS_MAX = 1000 };
    lab *l = of;
    json_t *body = http_body_json(q, r);
    if (!body)
        return;
    const json_t *paths = json_object_get(body, "paths");
    const size_t count = json_array_size(paths);
    const char **text = calloc(count + 1, sizeof *text);
    bool good = text && json_is_object(body) && (!paths || (json_is_array(paths) && count > 0 && count <= PATHS_MAX));
    for (size_t i = 0; i < count && good; i++)
        good = (text[i] = json_string_value(json_array_get(paths, i))) != NULL;
    if (good) {
        diagnostic why = {.line = 0};
        uint64_t generation = 0;
        const status code = desk_reset(l->desk, text, count, &generation, &why);
        lab_reply_generation(r, code, generation, &why);
    } else {
        http_reply_error(r, 400, "'paths' is no list of paths", "give {\"paths\": [PATH, ..]}, or {} for all");
    }
    free(text);
    json_decref(body);
}

static void go_back(lab *l, bool redo, http_reply *r)
{
    diagnostic why = {.line = 0};
    uint64_t generation = 0;
    const status code = desk_undo(l->desk, redo, &generation, &why);
    if (code == STATUS_BAD_INPUT)
        http_reply_error(r, 409, why.what, why.remedy);
    else
        lab_reply_generation(r, code, generation, &why);
}

static void post_undo(void *of, const http_request *q, http_reply *r)
{
    (void)q;
    go_back(of, false, r);
}

static void post_redo(void *of, const http_request *q, http_reply *r)
{
    (void)q;
    go_back(of, true, r);
}

/* --- the camera --- */

static bool take_pair(const json_t *body, const char *key, double pair[2], http_reply *r)
{
    const json_t *given = json_object_get(body, key);
    if (!given)
        return true;
    for (size_t i = 0; i < 2; i++) {
        const json_t *item = json_array_get(given, i);
        if (json_array_size(given) != 2 || !json_is_number(item) || !(fabs(json_number_value(item)) <= 1e6)) {
            http_reply_error(r, 400, "an angle of the camera is no number", "give [YAW, PITCH] in degrees");
            return false;
        }
        pair[i] = json_number_value(item);
    }
    return true;
}

static void post_camera(void *of, const http_request *q, http_reply *r)
{
    lab *l = of;
    json_t *body = http_body_json(q, r);
    if (!body)
        return;
    camera_move move = {.step = {0.0, 0.0, 0.0}};
    const char *gesture;
    if (take_pair(body, "orbit", move.orbit_deg, r) && take_pair(body, "turn", move.turn_deg, r) &&
        lab_take_vector(body, "step", false, move.step, r) && lab_take_gesture(body, &gesture, r)) {
        diagnostic why = {.line = 0};
        uint64_t generation = 0;
        const status code =
            desk_apply(l->desk, "move the camera", gesture, camera_move_apply, &move, &generation, &why);
        lab_reply_generation(r, code, generation, &why);
    }
    json_decref(body);
}

/* --- the scene as a file, and as a command --- */

static void get_file(void *of, const http_request *q, http_reply *r)
{
    lab *l = of;
    (void)q;
    diagnostic why = {.line = 0};
    char *text = NULL;
    scene *now = desk_take(l->desk, NULL);
    if (now)
        lab_forget_threads(l, now);
    const status code = now ? scene_write_text(now, scene_path(now), false, &text, &why) : out_of_memory(&why);
    scene_destroy(now);
    if (code == STATUS_OK)
        http_reply_bytes(r, 200, "application/yaml; charset=utf-8", text, strlen(text));
    else
        http_reply_diagnostic(r, code, &why);
}

static void get_command(void *of, const http_request *q, http_reply *r)
{
    lab *l = of;
    (void)q;
    diagnostic why = {.line = 0};
    char *text = NULL;
    bool complete = false;
    scene *now = desk_take(l->desk, NULL);
    json_t *told = json_object();
    const bool known = now && told && desk_tell(l->desk, told);
    const char *file = known ? json_string_value(json_object_get(told, "file")) : NULL;
    const status code =
        known ? command_line(l->files, file, now, l->settings.threads, &text, &complete, &why) : out_of_memory(&why);
    if (code == STATUS_OK)
        http_reply_json(r, 200, json_pack("{s:o,s:b}", "command", json_of_text(text), "complete", (int)complete));
    else
        http_reply_diagnostic(r, code, &why);
    free(text);
    json_decref(told);
    scene_destroy(now);
}

static const http_route routes[] = {
    {"GET", "/api/state", get_state, NULL},     {"GET", "/api/scene", get_scene, NULL},
    {"POST", "/api/set", post_set, NULL},       {"POST", "/api/reset", post_reset, NULL},
    {"POST", "/api/undo", post_undo, NULL},     {"POST", "/api/redo", post_redo, NULL},
    {"POST", "/api/camera", post_camera, NULL}, {"GET", "/api/scene.yaml", get_file, NULL},
    {"GET", "/api/command", get_command, NULL}, {"GET", "/api/events", http_events, NULL},
};
const lab_routes desk_routes = {routes, sizeof routes / sizeof *routes};
