/* Search for study files and for the folders of their rows. */
#include "base/json_build.h"
#include "base/status.h"
#include "base/text.h"
#include "scene/data/document.h"
#include "web/session/studies.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- files --- */

/* The name in the file, found without parsing the rest; otherwise the file's name. unread: the reason if the
 * machine could not read the file. NULL: out of memory. */
static char *name_of(const lab *l, const char *file, diagnostic *unread)
{
    char *path = NULL, *name;
    document *d = NULL;
    diagnostic reason = {.what = ""};
    status code = folder_path(l->files, file, true, &path, &reason);
    THEN(code, document_read_below(path, folder_real(l->files), &d, &reason));
    if (code == STATUS_FAILURE)
        *unread = reason;
    const node *root = d ? document_root(d) : NULL,
               *name_node = root && root->kind == NODE_MAP ? node_get(root, "study") : NULL;
    if (name_node && name_node->kind == NODE_SCALAR && name_node->text[0]) {
        name = strdup(name_node->text);
    } else {
        const char *last = strrchr(file, '/'), *stem = last ? last + 1 : file, *dot = strrchr(stem, '.');
        name = strndup(stem, dot ? (size_t)(dot - stem) : strlen(stem));
    }
    document_destroy(d);
    free(path);
    return name;
}

typedef bool study_visit(void *context, const char *name, const char *file);

static status each(const lab *l, study_visit *visit, void *context, diagnostic *unread, diagnostic *why)
{
    json_t *json = NULL;
    status code = folder_json(l->files, &json, why);
    const json_t *files = json_object_get(json, "studies");
    bool wants_more = true;
    for (size_t i = 0; wants_more && code == STATUS_OK && i < json_array_size(files); i++) {
        const char *file = json_string_value(json_array_get(files, i));
        char *name = file ? name_of(l, file, unread) : NULL;
        if (name)
            wants_more = visit(context, name, file);
        else
            code = out_of_memory(why);
        free(name);
    }
    json_decref(json);
    return code;
}

status study_each(const lab *l, study_visit *visit, void *context, diagnostic *why)
{
    diagnostic unread; /* reported when the study is opened */
    return each(l, visit, context, &unread, why);
}

typedef struct name_search {
    const char *name;
    char *file;
    bool found;
} name_search;

static bool match_name(void *context, const char *name, const char *file)
{
    name_search *w = context;
    if (strcmp(name, w->name) != 0)
        return true;
    w->found = true;
    w->file = strdup(file);
    return false;
}

status study_find(const lab *l, const char *name, char **file, diagnostic *why)
{
    name_search w = {.name = name};
    diagnostic unread = {.what = ""};
    *file = NULL;
    TRY(each(l, match_name, &w, &unread, why));
    if (w.found && !w.file)
        return out_of_memory(why);
    if (!w.found && unread.what[0]) {
        *why = unread; /* that file may be the study */
        return STATUS_FAILURE;
    }
    *file = w.file;
    return STATUS_OK;
}

/* --- files that a study may read --- */

static status may_open(void *context, const char *path, diagnostic *why)
{
    const lab *l = context;
    char *name;
    TRY(folder_find(l->files, path, &name, why));
    const bool inside = name != NULL;
    free(name);
    return inside ? STATUS_OK
                  : diagnose(why, STATUS_BAD_INPUT, "use a scene inside the laboratory's folder",
                             "the scene is outside of the folder");
}

static status may_load(void *context, const scene *setting, diagnostic *why)
{
    const lab *l = context;
    return folder_check_scene(l->files, setting, why);
}

study_guard study_guard_of(const lab *l)
{
    return (study_guard){may_open, may_load, (void *)(uintptr_t)l, folder_real(l->files)};
}

status study_open(const lab *l, const char *file, study **out, diagnostic *why)
{
    const study_guard guard = study_guard_of(l);
    char *path = NULL;
    *out = NULL;
    status code = folder_path(l->files, file, true, &path, why);
    THEN(code, study_read_guarded(path, &guard, out, why));
    free(path);
    return code;
}

/* --- the results --- */

static status check_inside(const lab *l, const char *path, diagnostic *why)
{
    char *name;
    TRY(folder_find(l->files, path, &name, why));
    if (name) {
        free(name);
        return STATUS_OK;
    }
    return diagnose_at(why, path, STATUS_BAD_INPUT, "use a results folder inside the laboratory's folder",
                       "the path is outside of the folder");
}

static status check_links(const lab *l, const char *path, diagnostic *why)
{
    DIR *open = opendir(path);
    if (!open)
        return errno == ENOENT ? STATUS_OK
                               : check_inside(l, path, why); /* other errors are reported by the later read or write */
    status code = STATUS_OK;
    for (struct dirent *entry; code == STATUS_OK && (entry = readdir(open));) {
        if (entry->d_type != DT_LNK && entry->d_type != DT_UNKNOWN)
            continue;
        char *inner = text_format("%s/%s", path, entry->d_name);
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0)
            code = inner ? check_inside(l, inner, why) : out_of_memory(why);
        free(inner);
    }
    closedir(open);
    return code;
}

status study_check_results(const lab *l, const char *results, const char *name, diagnostic *why)
{
    char *rows = text_format("%s/%s", results, name);
    status code = rows ? check_inside(l, rows, why) : out_of_memory(why);
    THEN(code, check_links(l, rows, why));
    free(rows);
    return code;
}

/* --- other runs --- */

enum { DEPTH_MAX = 3, RUNS_MAX = 200, FOLDERS_MAX = 20000 };

typedef struct run_search {
    const char *name;
    json_t *found; /* NULL: out of memory */
    int visited;
    status code; /* STATUS_FAILURE: a folder cannot be listed now */
    diagnostic *why;
} run_search;

static int is_shown_folder(const struct dirent *entry)
{
    return entry->d_type == DT_DIR && entry->d_name[0] != '.';
}

/* Looks for rows of the study in a folder. name: of the folder, relative to the chosen folder. */
static void visit_folder(run_search *search, const char *path, const char *name)
{
    char *rows = text_format("%s/%s/rows.csv", path, search->name);
    json_t *text = json_text_or_null(name);
    if (!rows || !text) {
        json_decref(search->found);
        search->found = NULL;
    } else if (access(rows, R_OK) == 0 && json_is_string(text) && json_array_size(search->found) < RUNS_MAX) {
        json_add(&search->found, json_incref(text)); /* names that are not UTF-8 are skipped */
    }
    json_decref(text);
    free(rows);
}

/* below: the folder's name relative to the chosen folder, "" for the chosen folder. */
static void search_runs(run_search *search, const char *path, const char *below, int depth)
{
    struct dirent **entries = NULL;
    diagnostic reason = {.what = ""};
    const int count = scandir(path, &entries, is_shown_folder, alphasort);
    if (count < 0 && system_error(&reason, STATUS_OK, path, "cannot be listed", errno, "") != STATUS_OK) {
        search->code = STATUS_FAILURE;
        *search->why = reason;
    }
    for (int i = 0; i < count; i++) {
        if (search->found && search->code == STATUS_OK && search->visited++ < FOLDERS_MAX) {
            char *inner = text_format("%s/%s", path, entries[i]->d_name),
                 *name = text_format("%s%s%s", below, below[0] ? "/" : "", entries[i]->d_name);
            if (inner && name) {
                visit_folder(search, inner, name);
                if (depth < DEPTH_MAX)
                    search_runs(search, inner, name, depth + 1);
            } else {
                json_decref(search->found);
                search->found = NULL;
            }
            free(name);
            free(inner);
        }
        free(entries[i]);
    }
    free(entries);
}

status study_runs(const lab *l, const char *name, json_t **out, diagnostic *why)
{
    run_search search = {.name = name, .found = json_array(), .why = why};
    if (search.found)
        search_runs(&search, folder_root(l->files), "", 1);
    if (search.code != STATUS_OK) {
        json_decref(search.found);
        search.found = NULL;
    }
    *out = search.found;
    return *out || search.code != STATUS_OK ? search.code : out_of_memory(why);
}
