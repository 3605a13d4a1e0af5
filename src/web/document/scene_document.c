/* The scene document: its limits, its versions with their views, undo and redo, and the reuse of loaded data.
 * scene_document_changes.c edits the scene and moves the camera. */
#include "base/json_build.h"
#include "report/json.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "web/document/scene_document_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- limits: pixels, work and triangles --- */

static status check_bounds(const scene *s, diagnostic *why)
{
    const double triangles = scene_planned_triangles(s), rays = scene_camera_rays(&s->render);
    if (s->render.width * s->render.height > DOCUMENT_PIXELS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "render larger images with `cuvette render`",
                        "%lld x %lld pixels exceed the laboratory's limit of %d", (long long)s->render.width,
                        (long long)s->render.height, DOCUMENT_PIXELS_MAX);
    if (rays > DOCUMENT_WORK_MAX)
        return diagnose(why, STATUS_BAD_INPUT,
                        "use fewer pixels, samples, paths or wavelengths, or run `cuvette render`",
                        "%.3g camera rays exceed the laboratory's limit of %.0e", rays, DOCUMENT_WORK_MAX);
    if (triangles > DOCUMENT_TRIANGLES_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use smaller meshes, or run `cuvette render`",
                        "%.0f triangles exceed the laboratory's limit of %d", triangles, DOCUMENT_TRIANGLES_MAX);
    return STATUS_OK;
}

status scene_document_check(const scene *s, const folder *files, diagnostic *why)
{
    status code = scene_check(s, why);
    THEN(code, check_bounds(s, why));
    return code == STATUS_OK && files ? folder_check_scene(files, s, why) : code;
}

status scene_document_limit(scene *s, const folder *files, diagnostic *why)
{
    return scene_limit(s, files ? folder_real(files) : NULL, DOCUMENT_TRIANGLES_MAX, why);
}

/* --- versions --- */

static origin *origin_create(const scene *s, uint64_t number)
{
    origin *o = calloc(1, sizeof *o);
    if (o)
        *o = (origin){.s = scene_clone(s), .number = number, .references = 1};
    if (o && o->s)
        return o;
    free(o);
    return NULL;
}

static void origin_release(origin *o)
{
    if (o && --o->references == 0) {
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
    for (size_t i = 0; i < s->data_count; i++)
        data_entry_unload(&s->data[i]);
    scene_follow_data(s);
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

/* --- views --- */

bool camera_equal(const struct camera *a, const struct camera *b)
{
    return memcmp(a, b, sizeof *a) == 0; /* all members have eight bytes, so there is no padding */
}

static void push_view(view_stack *p, const camera_view *v)
{
    if (p->count == VIEWS_MAX) {
        memmove(&p->item[0], &p->item[1], (VIEWS_MAX - 1) * sizeof p->item[0]);
        p->count--;
    }
    p->item[p->count++] = *v;
}

/* Records the view before a move. Consecutive moves with the same gesture are one entry; gesture NULL: a new entry. */
static void view_history_push(view_history *h, const camera_view *before, const char *gesture)
{
    const bool continues = gesture && h->gesture[0] && strcmp(gesture, h->gesture) == 0;
    snprintf(h->gesture, sizeof h->gesture, "%s", gesture ? gesture : "");
    if (!continues)
        push_view(&h->back, before);
    h->forward.count = 0;
}

bool view_history_go(view_history *h, bool forward, camera_view *now)
{
    view_stack *from = forward ? &h->forward : &h->back, *to = forward ? &h->back : &h->forward;
    if (from->count == 0)
        return false;
    push_view(to, now);
    *now = from->item[--from->count];
    h->gesture[0] = 0;
    return true;
}

static void view_history_clear(view_history *h)
{
    h->back.count = h->forward.count = 0;
    h->gesture[0] = 0;
}

camera_view scene_document_view_now(const scene_document *d)
{
    return (camera_view){d->now.s->camera, d->pivot};
}

void scene_document_put_view(scene_document *d, const camera_view *next, const char *gesture)
{
    const camera_view before = scene_document_view_now(d);
    if (camera_equal(&next->camera, &before.camera))
        return;
    view_history_push(&d->views, &before, gesture);
    d->now.s->camera = next->camera;
    d->pivot = next->pivot;
}

/* --- the document --- */

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
                          .last_number = 1,
                          .saved_number = file ? 1 : 0};
    d->now = (version){.s = first, .file = name, .number = 1, .from = from, .saved_camera = first->camera};
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

status scene_document_push(scene_document *d, scene *next, const char *file, origin *from,
                           const struct camera *saved_camera, const char *what, const char *gesture, diagnostic *why)
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
    d->now = (version){.s = next,
                       .file = name,
                       .number = ++d->last_number,
                       .from = from ? from : before.from,
                       .saved_camera = *saved_camera};
    if (from) {
        from->number = d->now.number;
        view_history_clear(&d->views);
    } else {
        before.from->references++;
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

/* --- opening, undo and redo --- */

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

/* Keeps the view if both versions have the same saved camera; otherwise the view becomes the new version's saved
 * camera. A version of another opened scene is shown with its last view. */
static void restore_view(scene_document *d, const version *before, const camera_view *view)
{
    if (d->now.from != before->from) {
        view_history_clear(&d->views);
        return;
    }
    d->now.s->camera = view->camera;
    if (!camera_equal(&d->now.saved_camera, &before->saved_camera))
        scene_document_put_view(d, &(camera_view){d->now.saved_camera, {{0, 0, 0}, false}}, NULL);
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
    scene_retain_meshes(next.s, before.s);
    camera_view view = scene_document_view_now(d);
    stack_push(to, before);
    d->now = next;
    restore_view(d, &before, &view);
    d->gesture[0] = 0;
    d->generation++;
    return scene_document_finish(d, STATUS_OK, generation);
}

/* --- copies, files and the state --- */

scene *scene_document_copy(scene_document *d, uint64_t *generation)
{
    pthread_mutex_lock(&d->lock);
    scene *copy = scene_clone(d->now.s);
    if (generation)
        *generation = d->generation;
    pthread_mutex_unlock(&d->lock);
    return copy;
}

scene *scene_document_copy_to_save(scene_document *d, uint64_t *generation, uint64_t *number)
{
    pthread_mutex_lock(&d->lock);
    scene *copy = scene_clone(d->now.s);
    if (copy)
        copy->camera = d->now.saved_camera;
    if (generation)
        *generation = d->generation;
    if (number)
        *number = d->now.number;
    pthread_mutex_unlock(&d->lock);
    return copy;
}

bool scene_document_copies(scene_document *d, scene **now, scene **opened, uint64_t *generation, uint64_t *number)
{
    pthread_mutex_lock(&d->lock);
    *now = scene_clone(d->now.s);
    *opened = scene_clone(d->now.from->s);
    *generation = d->generation;
    *number = d->now.number;
    pthread_mutex_unlock(&d->lock);
    return *now && *opened;
}

uint64_t scene_document_generation(scene_document *d)
{
    pthread_mutex_lock(&d->lock);
    const uint64_t generation = d->generation;
    pthread_mutex_unlock(&d->lock);
    return generation;
}

/* loaded began as a copy of s, so their objects correspond. */
static void share_loaded(scene *s, const scene *loaded)
{
    for (size_t i = 0; i < s->texture_count; i++)
        if (!s->textures[i].data && loaded->textures[i].data) {
            s->textures[i].data = loaded->textures[i].data;
            texture_retain(s->textures[i].data);
        }
    for (size_t i = 0; i < s->data_count; i++)
        if (!s->data[i].data && loaded->data[i].data) {
            s->data[i].data = loaded->data[i].data;
            optical_data_retain(s->data[i].data);
        }
    scene_follow_data(s);
    if (!s->background.img && loaded->background.img) {
        s->background.img = image_retain(loaded->background.img);
        s->background.brightest = loaded->background.brightest;
    }
    scene_retain_meshes(s, loaded);
}

void scene_document_reuse_loaded(scene_document *d, const scene *loaded, uint64_t generation)
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

/* Whether changes would be lost; an opened scene without changes can be opened again. The caller holds the lock. */
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

static json_t *view_json(const scene_document *d)
{
    const vec3 at = camera_pivot_of(d->now.s, d->pivot);
    return json_pack("{s:b, s:b, s:b, s:[f,f,f], s:o}", "back", d->views.back.count > 0, "forward",
                     d->views.forward.count > 0, "kept", camera_equal(&d->now.saved_camera, &d->now.s->camera), "pivot",
                     at.x, at.y, at.z, "distance", json_of_real(vec3_length(vec3_sub(at, d->now.s->camera.position))));
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
    json_add_as(&json, "view", view_json(d));
    pthread_mutex_unlock(&d->lock);
    return json_object_update_new(state, json) == 0;
}
