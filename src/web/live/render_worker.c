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

void render_worker_wake(render_worker *worker)
{
    pthread_mutex_lock(&worker->lock);
    worker->wake_requested = true;
    pthread_cond_signal(&worker->wake);
    pthread_mutex_unlock(&worker->lock);
}

static void wake(void *of)
{
    render_worker_wake(of);
}

void render_worker_suspend(render_worker *worker, const char *text)
{
    pthread_mutex_lock(&worker->lock);
    snprintf(worker->waiting_text, sizeof worker->waiting_text, "%s", text ? text : "");
    worker->waiting = text ? worker->waiting_text : NULL;
    worker->wake_requested = true;
    pthread_cond_broadcast(&worker->changed);
    pthread_cond_signal(&worker->wake);
    while (text && worker->busy)
        pthread_cond_wait(&worker->changed, &worker->lock);
    pthread_mutex_unlock(&worker->lock);
    worker->listener.state_changed(worker->listener.context);
}

const shared_image *render_worker_newest(render_worker *worker)
{
    pthread_mutex_lock(&worker->lock);
    const shared_image *newest = worker->newest;
    if (newest)
        shared_image_retain(newest);
    pthread_mutex_unlock(&worker->lock);
    return newest;
}

/* After a failure of the machine (memory, open files), a later request lets the worker load and render the scene again.
 * The caller holds the lock. */
static void try_again(render_worker *worker)
{
#ifdef __EMSCRIPTEN__
    if (wasm_is_repeated)
        return;
#endif
    if (worker->trouble_code != STATUS_FAILURE || clock_wall_s() < worker->again_from_s)
        return;
    worker->again = true;
    worker->snapshot_generation = 0; /* not settled */
    worker->wake_requested = true;
    pthread_cond_signal(&worker->wake);
}

/* Waits for the next change. STATUS_INTERRUPTED if the worker is suspended or ends, or after the time limit. The caller
 * holds the lock. */
static status wait_for_change(render_worker *worker, const struct timespec *until, const char *reason,
                              const char *timeout_text, diagnostic *why)
{
    if (worker->waiting)
        return diagnose(why, STATUS_INTERRUPTED, "try again when it has ended", "%s: %.200s", reason, worker->waiting);
    if (worker->stop || pthread_cond_clockwait(&worker->changed, &worker->lock, CLOCK_MONOTONIC, until) == ETIMEDOUT)
        return diagnose(why, STATUS_INTERRUPTED, "try again", "%s", timeout_text);
    return STATUS_OK;
}

status render_worker_wait_for_final(render_worker *worker, double limit_s, const shared_image **out, diagnostic *why)
{
    const uint64_t min_generation = scene_document_generation(worker->scene_document);
    const struct timespec until = clock_after(limit_s);
    status code = STATUS_OK;
    *out = NULL;
    pthread_mutex_lock(&worker->lock);
    if (!worker->newest || !worker->newest->final || worker->newest->generation < min_generation)
        try_again(worker);
    while (!*out && code == STATUS_OK) {
        if (worker->newest && worker->newest->final && worker->newest->generation >= min_generation) {
            shared_image_retain(*out = worker->newest);
        } else if (worker->trouble_code != STATUS_OK && worker->snapshot_generation >= min_generation) {
            *why = worker->trouble;
            code = worker->trouble_code;
        } else {
            code = wait_for_change(worker, &until, "rendering is suspended", "the image is not finished yet", why);
        }
    }
    pthread_mutex_unlock(&worker->lock);
    return code;
}

live *render_worker_live(render_worker *worker)
{
    return worker->live_slime;
}

/* Whether that generation, or a newer one, is loaded or has failed. The caller holds the lock. */
static bool is_settled(const render_worker *worker, uint64_t min_generation)
{
    return worker->snapshot_generation >= min_generation &&
           (worker->snapshot_ready || worker->trouble_code != STATUS_OK);
}

static status wait_for_scene(render_worker *worker, diagnostic *why)
{
    const uint64_t min_generation = scene_document_generation(worker->scene_document);
    const struct timespec until = clock_after(scene_wait_s);
    status code = STATUS_OK;
    pthread_mutex_lock(&worker->lock);
    if (!worker->snapshot_ready)
        try_again(worker);
    while (!is_settled(worker, min_generation) && code == STATUS_OK)
        code = wait_for_change(worker, &until, "ray queries are suspended", "the scene is still being loaded", why);
    if (code == STATUS_OK && !worker->snapshot_ready) {
        *why = worker->trouble;
        code = worker->trouble_code;
    }
    pthread_mutex_unlock(&worker->lock);
    return code;
}

/* The caller holds the snapshot lock. */
static bool snapshot_is_ready(render_worker *worker)
{
    pthread_mutex_lock(&worker->lock);
    const bool ready = worker->snapshot_ready && worker->snapshot_generation > 0;
    pthread_mutex_unlock(&worker->lock);
    return ready;
}

/* If the worker begins another scene between the two locks, the loop waits for that scene. */
status render_worker_with_scene(render_worker *worker, status (*act)(void *context, scene *s, diagnostic *why),
                                void *context, diagnostic *why)
{
    for (;;) {
        TRY(wait_for_scene(worker, why));
        status code = STATUS_OK;
        pthread_rwlock_rdlock(&worker->snapshot_lock);
        const bool ready = snapshot_is_ready(worker);
        if (ready)
            code = act(context, worker->snapshot, why);
        pthread_rwlock_unlock(&worker->snapshot_lock);
        if (ready)
            return code;
    }
}

static bool prepare_locks(render_worker *worker)
{
    pthread_rwlockattr_t kind;
    if (pthread_rwlockattr_init(&kind) != 0)
        return false;
    /* Readers that follow each other without a gap must not starve the worker. */
    pthread_rwlockattr_setkind_np(&kind, PTHREAD_RWLOCK_PREFER_WRITER_NONRECURSIVE_NP);
    const bool good = pthread_mutex_init(&worker->lock, NULL) == 0 &&
                      pthread_rwlock_init(&worker->snapshot_lock, &kind) == 0 &&
                      pthread_cond_init(&worker->wake, NULL) == 0 && pthread_cond_init(&worker->changed, NULL) == 0;
    pthread_rwlockattr_destroy(&kind);
    return good;
}

static void release(render_worker *worker)
{
    if (worker->live_slime) /* NULL if its creation failed */
        live_detach(worker->live_slime);
    live_destroy(worker->live_slime);
    scene_destroy(worker->snapshot);
    shared_image_release(worker->newest);
    job_destroy(worker->renderer);
    pthread_rwlock_destroy(&worker->snapshot_lock);
    pthread_cond_destroy(&worker->wake);
    pthread_cond_destroy(&worker->changed);
    pthread_mutex_destroy(&worker->lock);
    free(worker);
}

status render_worker_create(scene_document *d, isa level, const render_worker_listener *listener, render_worker **out,
                            diagnostic *why)
{
    *out = NULL;
    render_worker *worker = calloc(1, sizeof *worker);
    if (!worker || !prepare_locks(worker)) {
        free(worker);
        return out_of_memory(why);
    }
    worker->scene_document = d;
    worker->listener = *listener;
    worker->traced.step = worker->raster.step = 3; /* start coarse until the frame time is known */
    worker->live_slime = live_create(wake, worker);
    const job_settings settings = {.level = &level};
    status code = worker->live_slime ? job_create(&settings, &worker->renderer, why) : out_of_memory(why);
    THEN(code, render_worker_start(worker, why));
    if (code == STATUS_OK)
        *out = worker;
    else
        release(worker);
    return code;
}

void render_worker_end(render_worker *worker)
{
    pthread_mutex_lock(&worker->lock);
    worker->stop = true;
    pthread_cond_broadcast(&worker->changed);
    pthread_cond_signal(&worker->wake);
    pthread_mutex_unlock(&worker->lock);
    live_stop(worker->live_slime);
    render_worker_join(worker);
}

void render_worker_destroy(render_worker *worker)
{
    if (worker)
        release(worker);
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

bool render_worker_json(render_worker *worker, json_t *state)
{
    scene *current = scene_document_copy(worker->scene_document, NULL);
    pthread_mutex_lock(&worker->lock);
    json_t *json = json_pack("{s:o, s:o, s:o, s:o}", "trouble",
                             worker->trouble_code != STATUS_OK ? json_of_diagnostic(&worker->trouble) : json_null(),
                             "waiting", worker->waiting ? json_of_text(worker->waiting) : json_null(), "image",
                             worker->newest ? shared_image_json(worker->newest) : json_null(), "camera",
                             current ? camera_json(current) : NULL);
    pthread_mutex_unlock(&worker->lock);
    scene_destroy(current);
    return json_object_update_new(state, json) == 0;
}
