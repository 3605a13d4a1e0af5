/* API: the lessons of the folder and of the program, and thumbnails. The program's lessons are in its installation,
 * outside the chosen folder, so requests name lessons, never paths. */
#include "base/json_build.h"
#include "base/text.h"
#include "report/json.h"
#include "report/report.h"
#include "scene/model/edit/edit.h"
#include "scene/model/scene.h"
#include "web/api/api.h"
#include "web/live/images.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A visit to the lessons, which ends when `found` is set or the machine fails. act is called with each lesson, or with
 * NULL and the error if the file cannot be read. */
typedef struct lesson_visit {
    void (*act)(struct lesson_visit *v, lesson *l, const char *path, bool in_folder, const diagnostic *error);
    call *c;
    json_t *list;
    const char *name; /* of the lesson to find */
    status code;      /* STATUS_FAILURE if memory or the disk failed; the reason is in the call */
    lesson *found;
} lesson_visit;

static void visit_file(lesson_visit *v, const char *path, const char *root, bool in_folder)
{
    lesson *l = NULL;
    diagnostic why = {.what = ""};
    if (v->found || v->code != STATUS_OK)
        return;
    if (lesson_read_below(path, root, &l, &why) == STATUS_FAILURE) {
        v->code = STATUS_FAILURE;
        v->c->why = why;
    } else {
        v->act(v, l, path, in_folder, &why);
    }
    if (l != v->found)
        lesson_destroy(l);
}

/* Visits the folder's lessons; a file that was removed after the list was made is skipped. */
static status visit_folder(lesson_visit *v)
{
    const folder *files = v->c->l->files;
    json_t *all = NULL, *name;
    size_t i;
    status code = folder_json(files, &all, &v->c->why);
    json_array_foreach(json_object_get(all, "lessons"), i, name)
    {
        if (code != STATUS_OK || v->code != STATUS_OK || v->found)
            break;
        char *path = NULL;
        diagnostic why = {.what = ""};
        const status one = folder_path(files, json_string_value(name), true, &path, &why);
        if (one == STATUS_OK)
            visit_file(v, path, folder_real(files), true);
        else if (one == STATUS_FAILURE) {
            code = one;
            v->c->why = why;
        }
        free(path);
    }
    json_decref(all);
    return code;
}

/* The folder's lessons come first: a teacher's copy replaces the program's lesson of that name. */
static status visit_lessons(lesson_visit *v)
{
    TRY(visit_folder(v));
    char *installed = lesson_folder(), *root = installed ? strdup(installed) : NULL;
    lesson_list list = {.path = NULL};
    if (root && strrchr(root, '/'))
        *strrchr(root, '/') = 0;
    status code = root ? lesson_list_find(installed, &list, &v->c->why) : STATUS_OK;
    for (size_t k = 0; k < list.count; k++)
        visit_file(v, list.path[k], root, false);
    lesson_list_release(&list);
    free(installed);
    free(root);
    return code == STATUS_OK ? v->code : code;
}

static bool is_listed(const json_t *list, const char *name)
{
    size_t i;
    const json_t *one;
    json_array_foreach(list, i, one)
    {
        const char *other = json_string_value(json_object_get(one, "name"));
        if (other && strcmp(other, name) == 0)
            return true;
    }
    return false;
}

static void list_lesson(lesson_visit *v, lesson *l, const char *path, bool in_folder, const diagnostic *error)
{
    if (l && is_listed(v->list, l->name))
        return;
    json_t *one = l ? lesson_json(l)
                    : json_pack("{s:o,s:o}", "file", json_of_text(strrchr(path, '/') ? strrchr(path, '/') + 1 : path),
                                "error", json_of_diagnostic(error));
    json_add_as(&one, "own", json_boolean(in_folder));
    json_add(&v->list, one);
}

static void match_lesson(lesson_visit *v, lesson *l, const char *path, bool in_folder, const diagnostic *error)
{
    (void)path, (void)in_folder, (void)error;
    if (l && strcmp(l->name, v->name) == 0)
        v->found = l;
}

status api_lessons(call *c)
{
    lesson_visit v = {.act = list_lesson, .c = c, .list = json_array()};
    const status code = visit_lessons(&v);
    api_reply_json(c, json_pack("{s:o}", "lessons", v.list));
    return code;
}

/* The lesson {name} of the path; the caller destroys it. */
static status find_lesson(call *c, lesson **out)
{
    lesson_visit v = {.act = match_lesson, .c = c, .name = http_path_value(c->request, "name")};
    const status code = visit_lessons(&v);
    if (code != STATUS_OK) {
        lesson_destroy(v.found);
        return code;
    }
    *out = v.found;
    return v.found ? STATUS_OK : api_refuse(c, 404, "there is no lesson of that name", "GET /api/lessons lists them");
}

/* Opens the lesson's scene as a new scene, so that saving requires a name. If the scene's path, to which the names of
 * its files are relative, is inside the folder, the scene keeps it. */
status api_lesson_open(call *c)
{
    lesson *l = NULL;
    uint64_t generation = 0;
    TRY(find_lesson(c, &l));
    scene *s = l->start;
    l->start = NULL;
    char *inside, *path = strdup("");
    status code = folder_find(c->l->files, l->scene_path, &inside, &c->why);
    if (code == STATUS_OK && !path)
        code = out_of_memory(&c->why);
    if (inside) {
        free(path);
    } else {
        free(s->path);
        s->path = path;
    }
    THEN(code, scene_limit(s, folder_real(c->l->files), 0, &c->why));
    THEN(code, scene_set_title(s, l->title, &c->why));
    free(inside);
    lesson_destroy(l);
    if (code != STATUS_OK) {
        scene_destroy(s);
        return code;
    }
    lab_set_default_threads(c->l, s);
    code = scene_document_open(c->l->scene_document, s, NULL, &generation, &c->why);
    return api_changed(c, code, generation);
}

typedef struct lesson_question {
    const lab *lab;
    const lesson *lesson;
    lesson_result *result;
} lesson_question;

static status measure(void *context, scene *s, diagnostic *why)
{
    const lesson_question *q = context;
    return lesson_measure(q->lesson, s, q->lab->settings.level, q->result, why);
}

/* Measures in the current scene, whatever its file. */
status api_lesson_measure(call *c)
{
    lesson_question q = {.lab = c->l, .result = malloc(sizeof *q.result)};
    lesson *l = NULL;
    status code = q.result ? find_lesson(c, &l) : out_of_memory(&c->why);
    q.lesson = l;
    THEN(code, semaphore_acquire(c->l->heavy, &c->why));
    if (code == STATUS_OK) {
        code = render_worker_with_scene(c->l->render_worker, measure, &q, &c->why);
        semaphore_release(c->l->heavy);
    }
    if (code == STATUS_OK)
        api_reply_json(c, lesson_result_json(l, q.result));
    lesson_destroy(l);
    free(q.result);
    return code;
}

/* --- thumbnails --- */

/* Sends the thumbnail that is kept for the key, or renders it. Destroys the scene. */
static status send_thumbnail(call *c, const char *key, scene *s)
{
    unsigned char *bytes = NULL;
    size_t size = 0;
    status code = key ? thumbnails_find(c->l->thumbnails, key, &bytes, &size, &c->why) : out_of_memory(&c->why);
    if (code == STATUS_OK && !bytes) {
        THEN(code, scene_document_check(s, NULL, &c->why));
        THEN(code, scene_limit(s, scene_root(s), DOCUMENT_TRIANGLES_MAX, &c->why));
        THEN(code, thumbnails_render(c->l->thumbnails, key, s, &bytes, &size, &c->why));
    }
    scene_destroy(s);
    return code == STATUS_OK ? api_send(c, "image/jpeg", bytes, size) : code;
}

static char *key_of(const char *kind, const char *path)
{
    struct stat about = {.st_size = 0};
    stat(path, &about);
    return text_format("%s %s %lld %lld.%09ld", kind, path, (long long)about.st_size, (long long)about.st_mtim.tv_sec,
                       about.st_mtim.tv_nsec);
}

/* Refuses while a study measures, which a render would disturb. */
static status may_render(call *c)
{
    json_t *state = json_object();
    const bool waits =
        render_worker_json(c->l->render_worker, state) && !json_is_null(json_object_get(state, "waiting"));
    json_decref(state);
    return waits ? api_refuse(c, 409, "a study is measuring", "try again when it has ended") : STATUS_OK;
}

status api_lesson_thumbnail(call *c)
{
    lesson *l = NULL;
    TRY(may_render(c));
    TRY(find_lesson(c, &l));
    scene *s = l->start;
    char *key = key_of("lesson", l->path);
    l->start = NULL;
    lesson_destroy(l);
    const status code = send_thumbnail(c, key, s);
    free(key);
    return code;
}

status api_thumbnail(call *c)
{
    const char *name = http_query_value(c->request, "file");
    char *path = NULL, *key;
    scene *s = NULL;
    if (!name)
        return api_refuse(c, 400, "file is missing", "give ?file=NAME of a scene");
    TRY(may_render(c));
    status code = folder_path(c->l->files, name, true, &path, &c->why);
    THEN(code, scene_read_below(path, folder_real(c->l->files), &s, &c->why));
    key = code == STATUS_OK ? key_of("scene", path) : NULL;
    if (code == STATUS_OK)
        code = send_thumbnail(c, key, s);
    free(key);
    free(path);
    return code;
}
