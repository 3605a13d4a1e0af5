/* The scene document: versions, undo and redo stacks, and sharing of loaded data. */
#include "base/json_build.h"
#include "web/session/scene_document_private.h"
#include "scene/model/params.h"
#include "report/json.h"
#include "scene/model/scene.h"

#include <stdlib.h>
#include <string.h>

static origin *origin_create(const scene *s, uint64_t number)
{
    origin *o = calloc(1, sizeof *o);
    if (o)
        *o = (origin){.s = scene_clone(s), .number = number, .owners = 1};
    if (o && o->s)
        return o;
    free(o);
    return NULL;
}

static void origin_release(origin *o)
{
    if (o && --o->owners == 0) {
        scene_destroy(o->s);
        free(o);
    }
}

static void version_clear(version *v)
{
    scene_destroy(v->s);
    origin_release(v->from);
    free(v->file);
    free(v->what);
    *v = (version){0};
}

static void stack_clear(version_stack *p)
{
    while (p->count)
        version_clear(&p->item[--p->count]);
}

static void unload(scene *s)
{
    for (size_t i = 0; i < s->mesh_count; i++)
        if (s->meshes[i].source != MESH_ARRAYS)
            mesh_entry_unload(&s->meshes[i]);
    for (size_t i = 0; i < s->texture_count; i++)
        texture_entry_unload(&s->textures[i]);
    image_destroy(s->background.img);
    s->background.img = NULL;
}

static void stack_push(version_stack *p, version v)
{
    unload(v.s);
    if (p->count == DOCUMENT_UNDO_MAX) {
        version_clear(&p->item[0]);
        memmove(&p->item[0], &p->item[1], (DOCUMENT_UNDO_MAX - 1) * sizeof p->item[0]);
        p->count--;
    }
    p->item[p->count++] = v;
}

static char *copy_or_null(const char *text)
{
    return text ? strdup(text) : NULL;
}

status scene_document_create(scene *first, const char *file, const folder *files, void (*changed)(void *context),
                             void *context, scene_document **out, diagnostic *why)
{
    *out = NULL;
    status code = first ? scene_document_check(first, files, why) : out_of_memory(why);
    THEN(code, scene_document_limit(first, files, why));
    scene_document *d = code == STATUS_OK ? calloc(1, sizeof *d) : NULL;
    origin *from = d ? origin_create(first, 1) : NULL;
    char *name = copy_or_null(file);
    if (!from || (file && !name)) {
        origin_release(from);
        free(name);
        free(d);
        scene_destroy(first);
        return code == STATUS_OK ? out_of_memory(why) : code;
    }
    *d = (scene_document){.lock = PTHREAD_MUTEX_INITIALIZER,
                          .files = files,
                          .changed = changed,
                          .context = context,
                          .generation = 1,
                          .numbers = 1,
                          .saved_number = file ? 1 : 0};
    d->now = (version){.s = first, .file = name, .number = 1, .from = from, .kept = first->camera};
    *out = d;
    return STATUS_OK;
}

void scene_document_destroy(scene_document *d)
{
    if (!d)
        return;
    stack_clear(&d->undo);
    stack_clear(&d->redo);
    version_clear(&d->now);
    pthread_mutex_destroy(&d->lock);
    free(d);
}

status scene_document_push(scene_document *d, scene *next, const char *file, origin *from, const struct camera *kept,
                           const char *what, const char *gesture, diagnostic *why)
{
    char *name = copy_or_null(file), *words = strdup(what);
    if (!words || (file && !name)) {
        free(name);
        free(words);
        return out_of_memory(why);
    }
    const bool continues = gesture && d->gesture[0] && strcmp(gesture, d->gesture) == 0;
    snprintf(d->gesture, sizeof d->gesture, "%s", gesture ? gesture : "");
    version before = d->now;
    d->now =
        (version){.s = next, .file = name, .number = ++d->numbers, .from = from ? from : before.from, .kept = *kept};
    if (from) {
        from->number = d->now.number;
        view_history_clear(&d->views);
    } else {
        before.from->owners++;
        if (!camera_equal(&next->camera, &before.s->camera))
            view_history_push(&d->views, &(camera_view){before.s->camera, d->pivot}, gesture);
    }
    if (continues) {
        free(words);
        version_clear(&before);
    } else {
        before.what = words;
        stack_push(&d->undo, before);
    }
    stack_clear(&d->redo);
    d->generation++;
    return STATUS_OK;
}

status scene_document_finish(scene_document *d, status code, uint64_t *generation)
{
    if (code == STATUS_OK && generation)
        *generation = d->generation;
    pthread_mutex_unlock(&d->lock);
    if (code == STATUS_OK && d->changed)
        d->changed(d->context);
    return code;
}

/* A change of the camera's parameters is one of the scene, which then has the whole view as its camera. */
static status apply(scene_document *d, const char *what, const char *gesture, bool of_camera,
                    scene_document_change *change, void *context, uint64_t *generation, diagnostic *why)
{
    pthread_mutex_lock(&d->lock);
    scene *next = scene_clone(d->now.s);
    status code = next ? change(context, next, why) : out_of_memory(why);
    THEN(code, scene_document_check(next, d->files, why));
    if (code == STATUS_OK) {
        const bool moved = of_camera || !camera_equal(&next->camera, &d->now.s->camera);
        code =
            scene_document_push(d, next, d->now.file, NULL, moved ? &next->camera : &d->now.kept, what, gesture, why);
    }
    if (code != STATUS_OK)
        scene_destroy(next);
    return scene_document_finish(d, code, generation);
}

status scene_document_apply(scene_document *d, const char *what, const char *gesture, scene_document_change *change,
                            void *context, uint64_t *generation, diagnostic *why)
{
    return apply(d, what, gesture, false, change, context, generation, why);
}

status scene_document_apply_to_camera(scene_document *d, const char *what, const char *gesture,
                                      scene_document_change *change, void *context, uint64_t *generation,
                                      diagnostic *why)
{
    return apply(d, what, gesture, true, change, context, generation, why);
}

static status open_as(scene_document *d, scene *s, const char *file, bool rescued, uint64_t *generation,
                      diagnostic *why)
{
    status code = scene_document_check(s, d->files, why);
    THEN(code, scene_document_limit(s, d->files, why));
    origin *from = code == STATUS_OK ? origin_create(s, 0) : NULL;
    if (!from) {
        scene_destroy(s);
        return code == STATUS_OK ? out_of_memory(why) : code;
    }
    char words[128];
    from->unfiled = rescued;
    snprintf(words, sizeof words, "open %.100s", rescued ? "a rescued scene" : file ? file : "a new scene");
    pthread_mutex_lock(&d->lock);
    code = scene_document_push(d, s, file, from, &s->camera, words, NULL, why);
    if (code != STATUS_OK) {
        origin_release(from);
        scene_destroy(s);
    } else if (file && !rescued) {
        d->saved_number = d->now.number;
    }
    return scene_document_finish(d, code, generation);
}

status scene_document_open(scene_document *d, scene *s, const char *file, uint64_t *generation, diagnostic *why)
{
    return open_as(d, s, file, false, generation, why);
}

status scene_document_rescue(scene_document *d, scene *s, const char *file, uint64_t *generation, diagnostic *why)
{
    return open_as(d, s, file, true, generation, why);
}

/* A version with the same camera of its own leaves the view as it is, and one with another camera shows it. Versions of
 * another file come with their last view. */
static void restore_view(scene_document *d, const version *before, const camera_view *view)
{
    if (d->now.from != before->from) {
        view_history_clear(&d->views);
        return;
    }
    d->now.s->camera = view->camera;
    if (!camera_equal(&d->now.kept, &before->kept))
        scene_document_put_view(d, &(camera_view){d->now.kept, {{0, 0, 0}, false}}, NULL);
}

status scene_document_undo(scene_document *d, bool redo, uint64_t *generation, diagnostic *why)
{
    pthread_mutex_lock(&d->lock);
    version_stack *from = redo ? &d->redo : &d->undo, *to = redo ? &d->undo : &d->redo;
    if (from->count == 0)
        return scene_document_finish(d, diagnose(why, STATUS_BAD_INPUT, "", "nothing to %s", redo ? "redo" : "undo"),
                                     NULL);
    version next = from->item[--from->count], before = d->now;
    before.what = next.what; /* the change between the two versions */
    next.what = NULL;
    scene_borrow_meshes(next.s, before.s);
    camera_view view = scene_document_view_now(d);
    stack_push(to, before);
    d->now = next;
    restore_view(d, &before, &view);
    d->gesture[0] = 0;
    d->generation++;
    return scene_document_finish(d, STATUS_OK, generation);
}

static status reset_path(scene *s, const scene *opened, const char *path, diagnostic *why)
{
    char *value = NULL;
    status code = scene_get(opened, path, &value, why);
    THEN(code, scene_set(s, path, value, why));
    free(value);
    return code;
}

status scene_document_reset(scene_document *d, const char *const *paths, size_t count, uint64_t *generation,
                            diagnostic *why)
{
    pthread_mutex_lock(&d->lock);
    const origin *from = d->now.from;
    scene *next = scene_clone(count ? d->now.s : from->s);
    status code = next ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; i < count && code == STATUS_OK; i++)
        code = reset_path(next, from->s, paths[i], why);
    THEN(code, scene_document_check(next, d->files, why));
    if (code == STATUS_OK) {
        scene_borrow_meshes(next, d->now.s);
        char words[128];
        snprintf(words, sizeof words, count == 1 ? "reset %.100s" : "reset", count == 1 ? paths[0] : "");
        const bool moved = count == 0 || !camera_equal(&next->camera, &d->now.s->camera);
        code = scene_document_push(d, next, d->now.file, NULL, moved ? &next->camera : &d->now.kept, words, NULL, why);
        if (code == STATUS_OK && count == 0)
            d->now.number = from->number; /* it is that version again */
    }
    if (code != STATUS_OK)
        scene_destroy(next);
    return scene_document_finish(d, code, generation);
}

scene *scene_document_take(scene_document *d, uint64_t *generation)
{
    pthread_mutex_lock(&d->lock);
    scene *copy = scene_clone(d->now.s);
    if (generation)
        *generation = d->generation;
    pthread_mutex_unlock(&d->lock);
    return copy;
}

scene *scene_document_take_opened(scene_document *d)
{
    pthread_mutex_lock(&d->lock);
    scene *copy = scene_clone(d->now.from->s);
    pthread_mutex_unlock(&d->lock);
    return copy;
}

uint64_t scene_document_generation(scene_document *d)
{
    pthread_mutex_lock(&d->lock);
    const uint64_t generation = d->generation;
    pthread_mutex_unlock(&d->lock);
    return generation;
}

/* Both are copies of one version, so their objects correspond. */
static void share_loaded(scene *s, const scene *loaded)
{
    for (size_t i = 0; i < s->texture_count; i++)
        if (!s->textures[i].data && loaded->textures[i].data) {
            s->textures[i].data = loaded->textures[i].data;
            texture_retain(s->textures[i].data);
        }
    if (!s->background.img && loaded->background.img)
        s->background.img = image_retain(loaded->background.img);
    scene_borrow_meshes(s, loaded);
}

void scene_document_share_loaded(scene_document *d, const scene *loaded, uint64_t generation)
{
    pthread_mutex_lock(&d->lock);
    if (generation == d->generation)
        share_loaded(d->now.s, loaded);
    pthread_mutex_unlock(&d->lock);
}

void scene_document_saved(scene_document *d, const char *file, uint64_t number)
{
    char *name = strdup(file);
    pthread_mutex_lock(&d->lock);
    if (name && number == d->now.number) {
        free(d->now.file);
        d->now.file = name;
        d->saved_number = d->now.number;
        d->now.from->unfiled = true;
        name = NULL;
    }
    pthread_mutex_unlock(&d->lock);
    free(name);
    if (d->changed)
        d->changed(d->context);
}

/* A scene that was opened and not changed can be opened again. The caller holds the lock. */
static bool is_unsaved(const scene_document *d)
{
    const origin *from = d->now.from;
    return d->now.number != d->saved_number && (from->unfiled || d->now.number != from->number);
}

bool scene_document_unsaved(scene_document *d, uint64_t *number, char **file)
{
    pthread_mutex_lock(&d->lock);
    const bool unsaved = is_unsaved(d);
    *number = d->now.number;
    if (file)
        *file = copy_or_null(d->now.file);
    pthread_mutex_unlock(&d->lock);
    return unsaved;
}

static json_t *top_json(const version_stack *p)
{
    return p->count ? json_of_text(p->item[p->count - 1].what) : json_null();
}

bool scene_document_json(scene_document *d, json_t *state)
{
    pthread_mutex_lock(&d->lock);
    json_t *json = json_pack("{s:I, s:o, s:o, s:b, s:b, s:o, s:o}", "generation", (json_int_t)d->generation, "file",
                             d->now.file ? json_of_text(d->now.file) : json_null(), "title",
                             json_of_text(d->now.s->title), "saved", d->now.number == d->saved_number, "unsaved",
                             is_unsaved(d), "undo", top_json(&d->undo), "redo", top_json(&d->redo));
    json_add_as(&json, "view", scene_document_view_json(d));
    pthread_mutex_unlock(&d->lock);
    return json_object_update_new(state, json) == 0;
}
