/* API: the scene document: the state, changes of parameters, undo, the camera, the scene as a file, a command or a
 * link, and opening and saving files of the folder. See web/README.md. */
#include "base/json_build.h"
#include "base/number.h"
#include "base/text.h"
#include "lint/lint.h"
#include "report/json.h"
#include "report/param_rows.h"
#include "report/report.h"
#include "scene/file/shared.h"
#include "scene/file/write.h"
#include "scene/model/camera.h"
#include "scene/model/open.h"
#include "scene/model/params.h"
#include "web/api/api.h"
#include "web/session/session.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

status api_state(call *c)
{
    return api_reply_json(c, c->l->state(c->l));
}

/* --- set and reset --- */

/* Whether the value is one number or one word. */
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

/* The parameters to set, and the notes on those without effect (lint/lint.h); notes: NULL if there are none. */
typedef struct set_request {
    const json_t *values;
    json_t *notes;
} set_request;

/* Collects the notes. A live slime ignores time_s, so parameters without effect at time 0 (the rule time-0) get no
 * note. */
static status note_inert(set_request *x, const scene *s, diagnostic *why)
{
    const char *path;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)x->values, path, value)
    {
        inert_answer answer;
        if (!param_is_inert(s, path, NULL, &answer) || strcmp(answer.rule, "time-0") == 0)
            continue;
        x->notes = x->notes ? x->notes : json_array();
        json_add(&x->notes, report_note(answer.note.place, answer.note.text, answer.note.remedy));
        if (!x->notes)
            return out_of_memory(why);
    }
    return STATUS_OK;
}

static status set_all(void *context, scene *s, diagnostic *why)
{
    set_request *x = context;
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
    if (!api_read_gesture(c, &gesture))
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

/* --- the scene as a file, a command, a link --- */

status api_scene_file(call *c)
{
    char *text = NULL;
    scene *current = scene_document_copy(c->l->scene_document, NULL);
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
    scene *current = scene_document_copy(c->l->scene_document, NULL);
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

status api_link(call *c)
{
    char *text = NULL, *code = NULL;
    scene *current = scene_document_copy(c->l->scene_document, NULL);
    status result = current ? shared_scene_text(current, &text, &c->why) : out_of_memory(&c->why);
    THEN(result, shared_scene_code(text, &code, &c->why));
    c->refused = 409;
    if (result == STATUS_OK)
        api_reply_json(c, json_pack("{s:s, s:s}", "fragment", SHARED_FRAGMENT, "code", code));
    free(text);
    free(code);
    scene_destroy(current);
    return result;
}

/* --- the camera: the view of the scene, and its history --- */

static bool read_pair(call *c, const char *key, double pair[2])
{
    const json_t *angles = json_object_get(c->body, key);
    for (size_t i = 0; angles && i < 2; i++) {
        const json_t *item = json_array_get(angles, i);
        if (json_array_size(angles) != 2 || !json_is_number(item) || !(fabs(json_number_value(item)) <= 1e6)) {
            api_refuse(c, 400, "the camera needs two angles", "give [YAW, PITCH] in degrees, each -1e6..1e6");
            return false;
        }
        pair[i] = json_number_value(item);
    }
    return true;
}

static bool read_zoom(call *c, double *zoom)
{
    const double most = 1e6;
    if (!api_read_number(c, "zoom", false, zoom))
        return false;
    if (!json_object_get(c->body, "zoom") || (*zoom >= 1.0 / most && *zoom <= most))
        return true;
    api_refuse(c, 400, "'zoom' is out of range", "give a factor of the distance, 1e-6..1e6");
    return false;
}

status api_camera(call *c)
{
    camera_move move = {.zoom = 0.0};
    const char *gesture;
    uint64_t generation = 0;
    if (!read_pair(c, "orbit", move.orbit_deg) || !read_pair(c, "turn", move.turn_deg) || !read_zoom(c, &move.zoom) ||
        !api_read_vector(c, "step", false, move.step) || !api_read_text(c, "look", false, &move.look) ||
        !api_read_text(c, "frame", false, &move.frame) || !api_read_gesture(c, &gesture))
        return STATUS_BAD_INPUT;
    const status code = scene_document_move_view(c->l->scene_document, &move, gesture, &generation, &c->why);
    return api_changed(c, code, generation);
}

status api_view(call *c)
{
    static const char *const words[] = {
        [VIEW_BACK] = "back", [VIEW_FORWARD] = "forward", [VIEW_HOME] = "home", [VIEW_KEEP] = "keep"};
    const char *word = NULL;
    uint64_t generation = 0;
    if (!api_read_text(c, "do", true, &word))
        return STATUS_BAD_INPUT;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strcmp(words[i], word) == 0) {
            c->refused = 409;
            const status code = scene_document_view(c->l->scene_document, (view_command)i, &generation, &c->why);
            return api_changed(c, code, generation);
        }
    return api_refuse(c, 400, "'do' is not a command for views", "use back, forward, home or keep");
}

/* --- the files of the folder, and the media catalogue --- */

/* The path from the scene's folder to the chosen folder; NULL when out of memory. */
static char *prefix_of(const lab *l)
{
    static const char any[] = "name";
    scene *s = scene_document_copy(l->scene_document, NULL);
    char *path = NULL;
    const status code = s ? folder_path_from(l->files, any, scene_path(s), &path, NULL) : STATUS_FAILURE;
    scene_destroy(s);
    if (code == STATUS_OK)
        path[strlen(path) - strlen(any)] = 0;
    return path;
}

status api_files(call *c)
{
    json_t *all = NULL;
    char *prefix = prefix_of(c->l);
    status code = prefix ? STATUS_OK : out_of_memory(&c->why);
    THEN(code, folder_json(c->l->files, &all, &c->why));
    if (code == STATUS_OK)
        json_add_as(&all, "prefix", json_of_text(prefix));
    free(prefix);
    return code == STATUS_OK ? api_reply_json(c, all) : code;
}

status api_media(call *c)
{
    return api_reply_json(c, media_rows_json((media_choice){NULL, NULL, NULL}, 0.0));
}

/* --- opening --- */

/* Reads a scene; 404 for a valid name without a file. */
static status read_scene(call *c, const char *name, scene **out, char note[LENS_NOTE_MAX])
{
    const folder *files = c->l->files;
    char *path = NULL;
    status code = folder_path(files, name, true, &path, &c->why);
    if (code == STATUS_OK)
        code = lens_file_named(name) ? api_lens_file(path, NULL, folder_real(files), out, note, &c->why)
                                     : scene_read_below(path, folder_real(files), out, &c->why);
    else if (code == STATUS_BAD_INPUT && folder_path(files, name, false, &path, NULL) == STATUS_OK)
        c->refused = 404;
    free(path);
    return code;
}

status api_open(call *c)
{
    const char *name = NULL, *link = NULL, *lens = NULL, *text = NULL;
    char note[LENS_NOTE_MAX] = "";
    const json_t *word = json_object_get(c->body, "new");
    const bool bench = json_is_string(word) && strcmp(json_string_value(word), "bench") == 0;
    bool fresh = bench;
    scene *s = NULL;
    uint64_t generation = 0;
    if ((!bench && !api_read_flag(c, "new", &fresh)) || !api_read_text(c, "link", false, &link) ||
        !api_read_text(c, "lens", false, &lens) || !api_read_text(c, "text", lens != NULL, &text) ||
        !api_read_text(c, "file", !fresh && !link && !lens, &name))
        return STATUS_BAD_INPUT;
    if (fresh + (name != NULL) + (link != NULL) + (lens != NULL) > 1)
        return api_refuse(c, 400, "'file', 'new', 'link' and 'lens' cannot be combined", "give only one of them");
    if (link && !shared_is_link(link))
        return api_refuse(c, 400, "the link holds no scene", "give a link with #scene=CODE");
    TRY(fresh  ? new_scene(bench, &s, &c->why)
        : link ? shared_read_link(link, &s, &c->why)
        : lens ? api_lens_file(lens, text, folder_real(c->l->files), &s, note, &c->why)
               : read_scene(c, name, &s, note));
    lab_set_default_threads(c->l, s);
    const char *file = name && lab_is_scene_name(name) ? name : NULL; /* no saving into an image */
    status code = scene_document_open(c->l->scene_document, s, file, &generation, &c->why);
    if (code != STATUS_OK || !note[0])
        return api_changed(c, code, generation);
    return api_reply_json(c, json_pack("{s:I, s:o}", "generation", (json_int_t)generation, "note", json_of_text(note)));
}

/* --- saving --- */

/* Whether the file is the open scene document. */
static bool is_open(const call *c, const char *name)
{
    char *file = api_document_file(c);
    const bool same = file && strcmp(file, name) == 0;
    free(file);
    return same;
}

static status write_file(call *c, const char *name, const char *path)
{
    uint64_t generation = 0, version = 0;
    scene *s = scene_document_copy_to_save(c->l->scene_document, &generation, &version);
    if (s)
        lab_clear_default_threads(c->l, s);
    const status code = s ? scene_write(s, path, false, &c->why) : out_of_memory(&c->why);
    scene_destroy(s);
    if (code == STATUS_OK)
        scene_document_saved(c->l->scene_document, name, version);
    return api_changed(c, code, generation);
}

status api_save(call *c)
{
    const char *name = NULL;
    char *path = NULL;
    bool replace = false;
    if (!api_read_text(c, "file", true, &name) || !api_read_flag(c, "replace", &replace))
        return STATUS_BAD_INPUT;
    status code = folder_path(c->l->files, name, false, &path, &c->why);
    if (code == STATUS_OK && !lab_is_scene_name(name))
        code =
            diagnose(&c->why, STATUS_BAD_INPUT, "use a name that ends in .yaml and has no part that begins with a dot",
                     "'%.200s' is not a valid scene name", name);
    else if (code == STATUS_OK && !replace && access(path, F_OK) == 0 && !is_open(c, name))
        code = api_refuse(c, 409, "the file already exists", "choose another name, or set 'replace'");
    else if (code == STATUS_OK)
        code = write_file(c, name, path);
    free(path);
    return code;
}

/* --- scenes of laboratories that ended without saving --- */

status api_rescue(call *c)
{
    const char *action = NULL, *id = NULL;
    uint64_t generation = 0;
    if (!api_read_text(c, "action", true, &action) || !api_read_text(c, "id", true, &id))
        return STATUS_BAD_INPUT;
    const bool opens = strcmp(action, "open") == 0;
    if (!opens && strcmp(action, "discard") != 0)
        return api_refuse(c, 400, "'action' is neither open nor discard", "use open or discard");
    if (opens)
        return api_changed(c, rescue_open(c->l->rescue, id, &generation, &c->why), generation);
    TRY(rescue_discard(c->l->rescue, id, &c->why));
    return api_state(c);
}
