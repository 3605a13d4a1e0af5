/* Edits the scene document: changes, resets, moves of the camera, and keeping a view as the scene's own camera.
 * api/scene_changes.c lists the differences between two scenes. */
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "web/document/scene_document_private.h"

#include <stdio.h>
#include <stdlib.h>

/* A change of a camera parameter makes the current view the scene's own camera. */
static status apply(scene_document *d, const char *what, const char *gesture, bool of_camera,
                    scene_document_change *change, void *context, uint64_t *generation, diagnostic *why)
{
    pthread_mutex_lock(&d->lock);
    scene *next = scene_clone(d->now.s);
    status code = next ? change(context, next, why) : out_of_memory(why);
    THEN(code, scene_document_check(next, d->files, why));
    if (code == STATUS_OK) {
        const bool moved = of_camera || !camera_equal(&next->camera, &d->now.s->camera);
        code = scene_document_push(d, next, d->now.file, NULL, moved ? &next->camera : &d->now.saved_camera, what,
                                   gesture, why);
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
        scene_retain_meshes(next, d->now.s);
        char words[128];
        snprintf(words, sizeof words, count == 1 ? "reset %.100s" : "reset", count == 1 ? paths[0] : "");
        const bool moved = count == 0 || !camera_equal(&next->camera, &d->now.s->camera);
        code = scene_document_push(d, next, d->now.file, NULL, moved ? &next->camera : &d->now.saved_camera, words,
                                   NULL, why);
        if (code == STATUS_OK && count == 0)
            d->now.number = from->number; /* the opened version again */
    }
    if (code != STATUS_OK)
        scene_destroy(next);
    return scene_document_finish(d, code, generation);
}

/* --- the camera --- */

/* Readers hold copies of the scene, so its camera can be replaced in place. */
status scene_document_move_view(scene_document *d, camera_move *move, const char *gesture, uint64_t *generation,
                                diagnostic *why)
{
    pthread_mutex_lock(&d->lock);
    scene *moved = scene_clone(d->now.s);
    move->pivot = d->pivot;
    status code = moved ? camera_move_apply(move, moved, why) : out_of_memory(why);
    THEN(code, scene_document_check(moved, d->files, why));
    if (code == STATUS_OK) {
        scene_document_put_view(d, &(camera_view){moved->camera, move->pivot}, gesture);
        d->generation++;
    }
    scene_destroy(moved);
    return scene_document_finish(d, code, generation);
}

static status keep(scene_document *d, diagnostic *why)
{
    if (camera_equal(&d->now.saved_camera, &d->now.s->camera))
        return diagnose(why, STATUS_BAD_INPUT, "move the camera first", "the scene has this view already");
    scene *copy = scene_clone(d->now.s);
    const status code = copy
                            ? scene_document_push(d, copy, d->now.file, NULL, &copy->camera, "keep the view", NULL, why)
                            : out_of_memory(why);
    if (code != STATUS_OK)
        scene_destroy(copy);
    return code;
}

static status show(scene_document *d, view_command order, diagnostic *why)
{
    camera_view now = scene_document_view_now(d);
    if (order == VIEW_HOME) {
        if (camera_equal(&d->now.saved_camera, &now.camera))
            return diagnose(why, STATUS_BAD_INPUT, "", "this is the scene's own view");
        scene_document_put_view(d, &(camera_view){d->now.saved_camera, {{0, 0, 0}, false}}, NULL);
    } else {
        if (!view_history_go(&d->views, order == VIEW_FORWARD, &now))
            return diagnose(why, STATUS_BAD_INPUT, "", "there is no %s view",
                            order == VIEW_FORWARD ? "later" : "earlier");
        d->now.s->camera = now.camera;
        d->pivot = now.pivot;
    }
    d->generation++;
    return STATUS_OK;
}

status scene_document_view(scene_document *d, view_command order, uint64_t *generation, diagnostic *why)
{
    pthread_mutex_lock(&d->lock);
    return scene_document_finish(d, order == VIEW_KEEP ? keep(d, why) : show(d, order, why), generation);
}
