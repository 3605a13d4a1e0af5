/* The views of the scene document: camera moves, their history, and keeping a view as the scene's own camera. */
#include "web/session/scene_document_private.h"
#include "report/json.h"
#include "scene/model/scene.h"

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
    if (camera_equal(&d->now.kept, &d->now.s->camera))
        return diagnose(why, STATUS_BAD_INPUT, "move the camera first", "the scene has this view already");
    scene *same = scene_clone(d->now.s);
    const status code = same
                            ? scene_document_push(d, same, d->now.file, NULL, &same->camera, "keep the view", NULL, why)
                            : out_of_memory(why);
    if (code != STATUS_OK)
        scene_destroy(same);
    return code;
}

static status show(scene_document *d, view_command order, diagnostic *why)
{
    camera_view now = scene_document_view_now(d);
    if (order == VIEW_HOME) {
        if (camera_equal(&d->now.kept, &now.camera))
            return diagnose(why, STATUS_BAD_INPUT, "", "this is the scene's own view");
        scene_document_put_view(d, &(camera_view){d->now.kept, {{0, 0, 0}, false}}, NULL);
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

scene *scene_document_take_kept(scene_document *d, uint64_t *generation, uint64_t *number)
{
    pthread_mutex_lock(&d->lock);
    scene *copy = scene_clone(d->now.s);
    if (copy)
        copy->camera = d->now.kept;
    if (generation)
        *generation = d->generation;
    if (number)
        *number = d->now.number;
    pthread_mutex_unlock(&d->lock);
    return copy;
}

json_t *scene_document_view_json(const scene_document *d)
{
    const vec3 at = camera_pivot_of(d->now.s, d->pivot);
    return json_pack("{s:b, s:b, s:b, s:[f,f,f], s:o}", "back", d->views.back.count > 0, "forward",
                     d->views.forward.count > 0, "kept", camera_equal(&d->now.kept, &d->now.s->camera), "pivot", at.x,
                     at.y, at.z, "distance", json_of_real(vec3_length(vec3_sub(at, d->now.s->camera.position))));
}
