/* The interface of the render worker for other threads: requests, newest image, state. */
#include "measure/clock.h"
#include "report/json.h"
#include "scene/model/camera.h"
#include "scene/model/open.h"
#include "scene/model/view_settings.h"
#include "web/live/render_worker_private.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* How long a caller waits for the current scene to be loaded. */
static const double scene_wait_s = 60.0;

/* --- requests of other threads --- */

void render_worker_wake(render_worker *p)
{
    pthread_mutex_lock(&p->lock);
    p->wake_requested = true;
    pthread_cond_signal(&p->wake);
    pthread_mutex_unlock(&p->lock);
}

static void wake(void *of)
{
    render_worker_wake(of);
}

void render_worker_suspend(render_worker *p, const char *text)
{
    pthread_mutex_lock(&p->lock);
    snprintf(p->waiting_text, sizeof p->waiting_text, "%s", text ? text : "");
    p->waiting = text ? p->waiting_text : NULL;
    p->wake_requested = true;
    pthread_cond_broadcast(&p->changed);
    pthread_cond_signal(&p->wake);
    while (text && p->busy)
        pthread_cond_wait(&p->changed, &p->lock);
    pthread_mutex_unlock(&p->lock);
    p->listener.state_changed(p->listener.context);
}

const shared_image *render_worker_newest(render_worker *p)
{
    pthread_mutex_lock(&p->lock);
    const shared_image *newest = p->newest;
    if (newest)
        shared_image_retain(newest);
    pthread_mutex_unlock(&p->lock);
    return newest;
}

/* After a failure of the machine (memory, open files), a later request has the scene loaded and rendered once more. The
 * caller holds the lock. */
static void try_again(render_worker *p)
{
#ifdef __EMSCRIPTEN__
    if (wasm_again)
        return;
#endif
    if (p->trouble_code != STATUS_FAILURE || clock_wall_s() < p->again_from_s)
        return;
    p->again = true;
    p->snapshot_generation = 0; /* not settled */
    p->wake_requested = true;
    pthread_cond_signal(&p->wake);
}

/* Waits for the next change; an error if none can come. The caller holds the lock. */
static status wait_for_change(render_worker *p, const struct timespec *until, const char *reason,
                              const char *timeout_text, diagnostic *why)
{
    if (p->waiting)
        return diagnose(why, STATUS_INTERRUPTED, "try again after that", "%s: %.200s", reason, p->waiting);
    if (p->stop || pthread_cond_clockwait(&p->changed, &p->lock, CLOCK_MONOTONIC, until) == ETIMEDOUT)
        return diagnose(why, STATUS_INTERRUPTED, "try again", "%s", timeout_text);
    return STATUS_OK;
}

status render_worker_wait_for_final(render_worker *p, double limit_s, const shared_image **out, diagnostic *why)
{
    const uint64_t min_generation = scene_document_generation(p->scene_document);
    const struct timespec until = clock_after(limit_s);
    status code = STATUS_OK;
    *out = NULL;
    pthread_mutex_lock(&p->lock);
    if (!p->newest || !p->newest->final || p->newest->generation < min_generation)
        try_again(p);
    while (!*out && code == STATUS_OK) {
        if (p->newest && p->newest->final && p->newest->generation >= min_generation) {
            shared_image_retain(*out = p->newest);
        } else if (p->trouble_code != STATUS_OK && p->snapshot_generation >= min_generation) {
            *why = p->trouble;
            code = p->trouble_code;
        } else {
            code = wait_for_change(p, &until, "rendering is suspended", "the image is not finished yet", why);
        }
    }
    pthread_mutex_unlock(&p->lock);
    return code;
}

live *render_worker_live(render_worker *p)
{
    return p->live_slime;
}

/* Whether that generation, or a newer one, is loaded or has failed. The caller holds the lock. */
static bool is_settled(const render_worker *p, uint64_t min_generation)
{
    return p->snapshot_generation >= min_generation && (p->snapshot_ready || p->trouble_code != STATUS_OK);
}

static status wait_for_scene(render_worker *p, diagnostic *why)
{
    const uint64_t min_generation = scene_document_generation(p->scene_document);
    const struct timespec until = clock_after(scene_wait_s);
    status code = STATUS_OK;
    pthread_mutex_lock(&p->lock);
    if (!p->snapshot_ready)
        try_again(p);
    while (!is_settled(p, min_generation) && code == STATUS_OK)
        code = wait_for_change(p, &until, "tracing is suspended", "the scene is still being loaded", why);
    if (code == STATUS_OK && !p->snapshot_ready) {
        *why = p->trouble;
        code = p->trouble_code;
    }
    pthread_mutex_unlock(&p->lock);
    return code;
}

/* The caller holds the snapshot lock. */
static bool snapshot_is_ready(render_worker *p)
{
    pthread_mutex_lock(&p->lock);
    const bool is = p->snapshot_ready && p->snapshot_generation > 0;
    pthread_mutex_unlock(&p->lock);
    return is;
}

/* The worker may start on another scene between the two locks; then this waits for that scene. */
status render_worker_with_scene(render_worker *p, status (*look)(void *context, scene *s, diagnostic *why),
                                void *context, diagnostic *why)
{
    for (;;) {
        TRY(wait_for_scene(p, why));
        status code = STATUS_OK;
        pthread_rwlock_rdlock(&p->snapshot_lock);
        const bool is_there = snapshot_is_ready(p);
        if (is_there)
            code = look(context, p->snapshot, why);
        pthread_rwlock_unlock(&p->snapshot_lock);
        if (is_there)
            return code;
    }
}

static bool prepare_locks(render_worker *p)
{
    pthread_rwlockattr_t kind;
    if (pthread_rwlockattr_init(&kind) != 0)
        return false;
    /* Readers that follow each other without a gap must not starve the worker. */
    pthread_rwlockattr_setkind_np(&kind, PTHREAD_RWLOCK_PREFER_WRITER_NONRECURSIVE_NP);
    const bool good = pthread_mutex_init(&p->lock, NULL) == 0 && pthread_rwlock_init(&p->snapshot_lock, &kind) == 0 &&
                      pthread_cond_init(&p->wake, NULL) == 0 && pthread_cond_init(&p->changed, NULL) == 0;
    pthread_rwlockattr_destroy(&kind);
    return good;
}

static void release(render_worker *p)
{
    if (p->live_slime) /* NULL if its creation failed */
        live_detach(p->live_slime);
    live_destroy(p->live_slime);
    scene_destroy(p->snapshot);
    shared_image_release(p->newest);
    job_destroy(p->renderer);
    pthread_rwlock_destroy(&p->snapshot_lock);
    pthread_cond_destroy(&p->wake);
    pthread_cond_destroy(&p->changed);
    pthread_mutex_destroy(&p->lock);
    free(p);
}

status render_worker_create(scene_document *d, isa level, const render_worker_listener *listener, render_worker **out,
                            diagnostic *why)
{
    *out = NULL;
    render_worker *p = calloc(1, sizeof *p);
    if (!p || !prepare_locks(p)) {
        free(p);
        return out_of_memory(why);
    }
    p->scene_document = d;
    p->listener = *listener;
    p->traced.step = p->raster.step = 3; /* start coarse until the frame time is known */
    p->live_slime = live_create(wake, p);
    const job_settings settings = {.level = &level};
    status code = p->live_slime ? job_create(&settings, &p->renderer, why) : out_of_memory(why);
    THEN(code, render_worker_start(p, why));
    if (code == STATUS_OK)
        *out = p;
    else
        release(p);
    return code;
}

void render_worker_end(render_worker *p)
{
    pthread_mutex_lock(&p->lock);
    p->stop = true;
    pthread_cond_broadcast(&p->changed);
    pthread_cond_signal(&p->wake);
    pthread_mutex_unlock(&p->lock);
    live_stop(p->live_slime);
    render_worker_join(p);
}

void render_worker_destroy(render_worker *p)
{
    if (p)
        release(p);
}

/* --- the state --- */

static json_t *vector_json(vec3 v)
{
    return json_pack("[o,o,o]", json_of_real(v.x), json_of_real(v.y), json_of_real(v.z));
}

static json_t *camera_json(const scene *s)
{
    const camera_frame f = camera_frame_of(s);
    const bool aimed = scene_camera(s)->aimed;
    return json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:o, s:b, s:o, s:o}", "eye", vector_json(f.eye), "forward", vector_json(f.forward),
        "right", vector_json(f.right), "up", vector_json(f.up), "half_width", json_of_real(f.half_width), "half_height",
        json_of_real(f.half_height), "parallel", (int)f.parallel, "target",
        aimed ? vector_json(scene_camera(s)->target) : json_null(), "distance",
        json_of_real(aimed ? vec3_length(vec3_sub(scene_camera(s)->target, scene_camera(s)->position)) : NAN));
}

bool render_worker_json(render_worker *p, json_t *state)
{
    scene *current = scene_document_copy(p->scene_document, NULL);
    pthread_mutex_lock(&p->lock);
    json_t *json = json_pack(
        "{s:o, s:o, s:o, s:o}", "trouble", p->trouble_code != STATUS_OK ? json_of_diagnostic(&p->trouble) : json_null(),
        "waiting", p->waiting ? json_of_text(p->waiting) : json_null(), "image",
        p->newest ? shared_image_json(p->newest) : json_null(), "camera", current ? camera_json(current) : NULL);
    pthread_mutex_unlock(&p->lock);
    scene_destroy(current);
    return json_object_update_new(state, json) == 0;
}
