/* API: the state, the scene, its parameters and undo. See web/README.md. */
#include "base/json_build.h"
#include "web/api/api.h"
#include "web/api/scene_since.h"
#include "base/number.h"
#include "base/text.h"
#include "report/json.h"
#include "report/report.h"
#include "lint/lint.h"
#include "scene/model/params.h"
#include "scene/file/write.h"
#include "scene/model/open.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

status api_state(call *c)
{
    return api_reply_json(c, lab_state(c->l));
}

/* The generation in ?since; -1 for none. */
static bool take_since(call *c, long long *since)
{
    const char *text = http_query_value(c->request, "since");
    char *end = NULL;
    *since = text ? strtoll(text, &end, 10) : -1;
    return !text || (end > text && *end == '\0' && *since >= 0);
}

status api_scene(call *c)
{
    uint64_t generation;
    long long since;
    if (!take_since(c, &since))
        return api_refuse(c, 400, "since is not a generation", "use ?since=N with the generation of an earlier reply");
    scene *current = scene_document_take(c->l->scene_document, &generation),
          *opened = scene_document_take_opened(c->l->scene_document);
    json_t *all = current && opened ? scene_json(current, opened, generation) : NULL;
    char *text = all ? sent_scenes_reply(c->l->sent, all, since) : NULL;
    scene_destroy(current);
    scene_destroy(opened);
    return text ? api_send(c, "application/json", text, strlen(text)) : out_of_memory(&c->why);
}

typedef struct param_question {
    const char *words;
    json_t *found[PARAM_NO_MATCH]; /* by param_match */
} param_question;

static status add_found(void *context, const char *path, const param *row, const char *value)
{
    param_question *q = context;
    const param_match match = param_matches(row, path, q->words);
    (void)value;
    if (match != PARAM_NO_MATCH)
        json_add(&q->found[match], json_of_text(path));
    return STATUS_OK;
}

status api_find(call *c)
{
    param_question q = {.words = http_query_value(c->request, "find")};
    if (!q.words)
        return api_refuse(c, 400, "find is missing", "use ?find=WORDS");
    scene *current = scene_document_take(c->l->scene_document, NULL);
    json_t *found = json_array();
    for (int i = 0; i < PARAM_NO_MATCH; i++)
        q.found[i] = json_array();
    if (!current || scene_each_param(current, add_found, &q) != STATUS_OK) {
        json_decref(found);
        found = NULL;
    }
    for (int i = 0; i < PARAM_NO_MATCH; i++)
        json_add(&found, q.found[i]);
    scene_destroy(current);
    return api_reply_json(c, json_pack("{s:o}", "found", found));
}

/* --- set and reset --- */

/* Whether it is one number or word. */
static bool is_item(const json_t *value)
{
    const char *word = json_string_value(value);
    return json_is_boolean(value) || (json_is_number(value) && isfinite(json_number_value(value))) ||
           (word && strlen(word) == json_string_length(value));
}

static void write_item(FILE *out, const json_t *value)
{
    char text[NUMBER_TEXT_MAX];
    fputs(json_is_number(value)    ? number_format(json_number_value(value), text)
          : json_is_boolean(value) ? (json_is_true(value) ? "on" : "off")
                                   : json_string_value(value),
          out);
}

status api_value_text(const json_t *value, const char *place, char **text, diagnostic *why)
{
    text_writer writer;
    bool good = json_is_array(value) || is_item(value);
    *text = NULL;
    for (size_t i = 0; i < json_array_size(value) && good; i++)
        good = is_item(json_array_get(value, i));
    if (!good)
        return diagnose(why, STATUS_BAD_INPUT, "give a number, a string or a list of numbers",
                        "%.200s: not a valid value", place);
    TRY(text_writer_open(&writer, why));
    if (!json_is_array(value))
        write_item(writer.stream, value);
    for (size_t i = 0; i < json_array_size(value); i++) {
        fputs(i > 0 ? "," : "", writer.stream);
        write_item(writer.stream, json_array_get(value, i));
    }
    return text_writer_close(&writer, text, NULL, why);
}

/* The parameters to set, and notes on those without effect (lint/lint.h); NULL while there are none. */
typedef struct set_request {
    const json_t *values;
    json_t *notes;
} set_request;

/* A live slime ignores time_s, so no note is made for it. */
static status note_inert(set_request *x, const scene *s, diagnostic *why)
{
    const char *path;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)x->values, path, value)
    {
        inert_answer answer;
        if (!inert_ask(s, path, NULL, &answer) || strcmp(answer.rule, "time-0") == 0)
            continue;
        x->notes = x->notes ? x->notes : json_array();
        json_add(&x->notes, report_note(answer.note.place, answer.note.text, answer.note.remedy));
        if (!x->notes)
            return out_of_memory(why);
    }
    return STATUS_OK;
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
        char *text = NULL;
        THEN(code, api_value_text(value, path, &text, why));
        THEN(code, scene_set(s, path, text, why));
        free(text);
    }
    json_decref(x->notes);
    x->notes = NULL;
    return code == STATUS_OK ? note_inert(x, s, why) : code;
}

static bool sets_camera(json_t *values)
{
    const char *path;
    json_t *value;
    json_object_foreach(values, path, value) if (strncmp(path, "camera.", 7) == 0) return true;
    return false;
}

status api_set(call *c)
{
    json_t *values = json_object_get(c->body, "set");
    const char *gesture;
    uint64_t generation = 0;
    char what[128];
    if (!json_is_object(values) || json_object_size(values) == 0)
        return api_refuse(c, 400, "nothing to set", "give {\"set\": {PATH: VALUE}}");
    if (!api_take_gesture(c, &gesture))
        return STATUS_BAD_INPUT;
    snprintf(what, sizeof what, "set %.100s", json_object_iter_key(json_object_iter(values)));
    set_request x = {values, NULL};
    const status code = (sets_camera(values) ? scene_document_apply_to_camera : scene_document_apply)(
        c->l->scene_document, what, gesture, set_all, &x, &generation, &c->why);
    if (code == STATUS_OK && x.notes)
        api_reply_json(c, json_pack("{s:I, s:O}", "generation", (json_int_t)generation, "notes", x.notes));
    else
        api_changed(c, code, generation);
    json_decref(x.notes);
    return code;
}

status api_reset(call *c)
{
    enum { PATHS_MAX = 1000 };
    const json_t *paths = json_object_get(c->body, "paths");
    const size_t count = json_array_size(paths);
    const char **text = calloc(count + 1, sizeof *text);
    uint64_t generation = 0;
    if (!text)
        return out_of_memory(&c->why);
    bool good = json_is_object(c->body) && (!paths || (json_is_array(paths) && count > 0 && count <= PATHS_MAX));
    for (size_t i = 0; i < count && good; i++)
        good = (text[i] = json_string_value(json_array_get(paths, i))) != NULL;
    const status code =
        good ? scene_document_reset(c->l->scene_document, text, count, &generation, &c->why)
             : api_refuse(c, 400, "'paths' must be a list of paths", "give {\"paths\": [PATH, ..]}, or {} for all");
    free(text);
    return api_changed(c, code, generation);
}

static status undo_or_redo(call *c, bool redo)
{
    uint64_t generation = 0;
    c->refused = 409;
    const status code = scene_document_undo(c->l->scene_document, redo, &generation, &c->why);
    return api_changed(c, code, generation);
}

status api_undo(call *c)
{
    return undo_or_redo(c, false);
}

status api_redo(call *c)
{
    return undo_or_redo(c, true);
}

/* --- the scene as a file, and as a command --- */

status api_scene_file(call *c)
{
    char *text = NULL;
    scene *current = scene_document_take(c->l->scene_document, NULL);
    if (current)
        lab_clear_default_threads(c->l, current);
    const status code =
        current ? scene_write_text(current, scene_path(current), false, &text, &c->why) : out_of_memory(&c->why);
    scene_destroy(current);
    return code == STATUS_OK ? api_send(c, "application/yaml; charset=utf-8", text, strlen(text)) : code;
}

status api_command(call *c)
{
    char *text = NULL, *file = api_document_file(c);
    bool complete = false;
    scene *current = scene_document_take(c->l->scene_document, NULL);
    const status code = current && file ? command_line(c->l->files, *file ? file : NULL, current,
                                                       c->l->settings.threads, &text, &complete, &c->why)
                                        : out_of_memory(&c->why);
    if (code == STATUS_OK)
        api_reply_json(c, json_pack("{s:o,s:b}", "command", json_of_text(text), "complete", (int)complete));
    free(text);
    free(file);
    scene_destroy(current);
    return code;
}
