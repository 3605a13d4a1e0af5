/* Files of the folder: which there are, opening and saving; and the catalogue of media. */
#include "web/lab_private.h"
#include "scene/model/place/new_scene.h"
#include "report/json.h"
#include "report/media_rows.h"
#include "scene/file/write.h"
#include "scene/model/open.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

/* What leads from the scene's folder to the chosen one; NULL when memory is out. */
static char *prefix_of(const lab *l)
{
    static const char any[] = "name";
    scene *s = desk_take(l->desk, NULL);
    char *path = NULL;
    const status code = s ? folder_path_from(l->files, any, scene_path(s), &path, NULL) : STATUS_FAILURE;
    scene_destroy(s);
    if (code == STATUS_OK)
        path[strlen(path) - strlen(any)] = 0;
    return path;
}

static void tell_files(void *context, const http_request *q, http_reply *r)
{
    (void)q;
    const lab *l = context;
    json_t *all = folder_tell(l->files);
    char *prefix = prefix_of(l);
    if (!all || !prefix || json_object_set_new(all, "prefix", json_of_text(prefix)) != 0) {
        json_decref(all);
        all = NULL;
    }
    free(prefix);
    http_reply_json(r, 200, all);
}

static void tell_media(void *context, const http_request *q, http_reply *r)
{
    (void)context, (void)q;
    http_reply_json(r, 200, media_rows_json(NULL, 0.0));
}

/* --- opening --- */

/* False, with the reply set, where it cannot be read; 404 for a name that is right and of nothing. */
static bool read_scene(const lab *l, const char *name, scene **out, http_reply *r)
{
    diagnostic why = {.what = ""};
    char *path = NULL;
    status code = folder_path(l->files, name, true, &path, &why);
    if (code == STATUS_OK) {
        code = scene_read_below(path, folder_real(l->files), out, &why);
        if (code != STATUS_OK)
            http_reply_diagnostic(r, code, &why);
    } else if (code == STATUS_BAD_INPUT && folder_path(l->files, name, false, &path, NULL) == STATUS_OK) {
        http_reply_error(r, 404, why.what, why.remedy);
    } else {
        http_reply_diagnostic(r, code, &why);
    }
    free(path);
    return code == STATUS_OK;
}

static void answer_open(lab *l, scene *s, const char *name, http_reply *r)
{
    diagnostic why = {.what = ""};
    uint64_t generation = 0;
    lab_give_threads(l, s);
    const status code = desk_open(l->desk, s, name, &generation, &why);
    lab_reply_generation(r, code, generation, &why);
}

static void open_file(void *context, const http_request *q, http_reply *r)
{
    json_t *body = http_body_json(q, r);
    const char *name = NULL;
    bool fresh = false;
    scene *s = NULL;
    if (!body || !lab_take_flag(body, "new", &fresh, r) || !lab_take_text(body, "file", !fresh, &name, r)) {
        json_decref(body);
        return;
    }
    diagnostic why = {.what = ""};
    if (fresh && name) {
        http_reply_error(r, 400, "a new scene has no file yet", "give a file, or new");
    } else if (fresh) {
        const status code = new_scene(&s, &why);
        if (code != STATUS_OK)
            http_reply_diagnostic(r, code, &why);
    } else {
        read_scene(context, name, &s, r);
    }
    if (s)
        answer_open(context, s, name, r);
    json_decref(body);
}

/* --- saving --- */

/* Listed among the scenes, once it is there. */
static bool is_scene_name(const char *name)
{
    const char *ending = strrchr(name, '.');
    return ending && (strcasecmp(ending, ".yaml") == 0 || strcasecmp(ending, ".yml") == 0) && name[0] != '.' &&
           !strstr(name, "/.");
}

/* Is it the file that is on the desk? */
static bool is_open(const lab *l, const char *name)
{
    json_t *state = json_object();
    const char *file = state && desk_tell(l->desk, state) ? json_string_value(json_object_get(state, "file")) : NULL;
    const bool same = file && strcmp(file, name) == 0;
    json_decref(state);
    return same;
}

static void write_file(lab *l, const char *name, const char *path, http_reply *r)
{
    diagnostic why = {.what = ""};
    uint64_t generation = 0;
    scene *s = desk_take(l->desk, &generation);
    if (s)
        lab_forget_threads(l, s);
    const status code = s ? scene_write(s, path, false, &why) : out_of_memory(&why);
    scene_destroy(s);
    if (code == STATUS_OK)
        desk_saved(l->desk, name, generation);
    lab_reply_generation(r, code, generation, &why);
}

static void save_file(void *context, const http_request *q, http_reply *r)
{
    lab *l = context;
    json_t *body = http_body_json(q, r);
    const char *name = NULL;
    char *path = NULL;
    bool replace = false;
    diagnostic why = {.what = ""};
    if (!body || !lab_take_text(body, "file", true, &name, r) || !lab_take_flag(body, "replace", &replace, r)) {
        json_decref(body);
        return;
    }
    status code = folder_path(l->files, name, false, &path, &why);
    if (code == STATUS_OK && !is_scene_name(name))
        code = diagnose(&why, STATUS_BAD_INPUT, "let it end in .yaml, and no part of it begin with a dot",
                        "'%.200s' is no name for a scene", name);
    if (code != STATUS_OK)
        http_reply_diagnostic(r, code, &why);
    else if (!replace && access(path, F_OK) == 0 && !is_open(l, name))
        http_reply_error(r, 409, "there is a file of that name already", "choose another name, or replace it");
    else
        write_file(l, name, path, r);
    free(path);
    json_decref(body);
}

static const http_route routes[] = {
    {"GET", "/api/files", tell_files, NULL},
    {"POST", "/api/open", open_file, NULL},
    {"POST", "/api/save", save_file, NULL},
    {"GET", "/api/media", tell_media, NULL},
};
const lab_routes file_routes = {routes, sizeof routes / sizeof *routes};
