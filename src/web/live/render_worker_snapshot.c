/* The work of the render worker's thread: it updates the snapshot (the copy of the scene document that is rendered),
 * moves its slimes, and renders it in passes. See web/live/render_worker_private.h. */
#include "base/cancel.h"
#include "measure/clock.h"
#include "report/report.h"
#include "scene/model/camera.h"
#include "scene/model/scene.h"
#include "scene/motion/motion.h"
#include "web/live/render_worker_private.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* --- what the thread reports --- */

/* Calls the listener's state_changed. */
static void notify(render_worker *worker)
{
    worker->listener.state_changed(worker->listener.context);
}

/* A failed attempt that took longer than this is repeated only after a pause of about the same length. */
static const double soon_s = 0.25;

/* Stores the snapshot's error. The caller holds the lock, and calls notify if this returns true. */
static bool store_error(render_worker *worker, status code, const diagnostic *why)
{
    const bool differs =
        code != worker->trouble_code || (code != STATUS_OK && strcmp(why->what, worker->trouble.what) != 0);
    worker->trouble_code = code;
    worker->trouble = *why;
    const double now_s = clock_wall_s(); /* a scene that never fits must not keep the machine busy */
    worker->again_from_s = now_s + fmax(0.0, now_s - worker->started_s - soon_s);
    pthread_cond_broadcast(&worker->changed);
    return differs;
}

/* Sets the snapshot's error, and calls the listener. */
static void set_error(render_worker *worker, status code, const diagnostic *why)
{
    pthread_mutex_lock(&worker->lock);
    const bool differs = store_error(worker, code, why);
    pthread_mutex_unlock(&worker->lock);
    if (differs)
        notify(worker);
}

/* --- the snapshot --- */

/* Computing time of the motion in a live frame. */
static const double move_s = 0.02;

/* Changes that come faster than images must not starve the viewer: a first pass that is out of date continues for
 * first_s, twice its planned time. If that is too short, because the speed was estimated wrong or a model is being
 * loaded, a pass after INTERRUPTED_MAX interrupted ones continues for grace_s. */
enum { INTERRUPTED_MAX = 3 };
static const double first_s = 2.0 * RENDER_WORKER_FIRST_S, grace_s = 0.5;

double render_worker_due_s(render_worker *worker)
{
    if (render_worker_is_stale(worker) || live_is_due(worker->live_slime))
        return 0.0;
    if (!worker->snapshot_ready || worker->pass >= worker->plan.count)
        return INFINITY;
    return worker->pass > 0 ? fmax(0.0, worker->finer_after_s - clock_wall_s()) : 0.0;
}

bool render_worker_is_stale(render_worker *worker)
{
    return scene_document_generation(worker->scene_document) != worker->copied_generation;
}

/* The ask of a cancel token: whether to interrupt the current load or pass. */
static bool is_cancelled(void *context)
{
    render_worker *worker = context;
    pthread_mutex_lock(&worker->lock);
    const bool stopping = worker->stop || worker->waiting;
    pthread_mutex_unlock(&worker->lock);
    const double granted_s = worker->pass > 0 ? 0.0 : worker->interrupted >= INTERRUPTED_MAX ? grace_s : first_s;
    return stopping || (render_worker_is_stale(worker) && clock_wall_s() - worker->started_s >= granted_s) ||
           (live_is_due(worker->live_slime) && worker->pass > 0);
}

typedef struct loading {
    render_worker *worker;
    cancel_token token;
} loading;

/* Simulating a slime up to its time_s may take long: it is interrupted by a newer document or a command to the live
 * slime. */
static void poll_commands(void *context, double fraction_done)
{
    loading *l = context;
    (void)fraction_done;
    if (live_is_due(l->worker->live_slime))
        cancel_set(&l->token);
}

static status load_snapshot(render_worker *worker, diagnostic *why)
{
    loading l = {worker, {.ask = is_cancelled, .context = worker}};
    worker->started_s = clock_wall_s();
    cancel_begin(&l.token);
    const status code = job_load(worker->renderer, worker->snapshot, &(load_watch){poll_commands, &l}, why);
    cancel_end(&l.token);
    return code;
}

static bool has_slime(const render_worker *worker)
{
    return worker->snapshot && scene_moves(worker->snapshot);
}

/* The caller holds the snapshot lock, so that no reader sees a snapshot that is not loaded. */
static void set_ready(render_worker *worker, bool ready)
{
    pthread_mutex_lock(&worker->lock);
    worker->snapshot_ready = ready;
    pthread_mutex_unlock(&worker->lock);
}

/* Changes within together_s of each other are a drag: the passes after the first wait until there was no change for
 * rest_s. They would be interrupted anyway, and until then compete for the processor with the page that shows the
 * first pass. */
static const double together_s = 0.25, rest_s = 0.15;

static void note_change(render_worker *worker, uint64_t generation)
{
    if (generation == worker->seen_generation)
        return;
    const double now_s = clock_wall_s();
    const bool several = worker->seen_generation > 0 && generation - worker->seen_generation > 1;
    worker->finer_after_s = several || now_s - worker->changed_s < together_s ? now_s + rest_s : now_s;
    worker->changed_s = now_s;
    worker->seen_generation = generation;
}

/* Copies the scene document to the snapshot and reuses as much loaded data as possible. */
void render_worker_renew_snapshot(render_worker *worker)
{
    diagnostic why = {.line = 0};
    uint64_t generation;
    worker->started_s = clock_wall_s();
    scene *next = scene_document_copy(worker->scene_document, &generation);
    worker->copied_generation = generation; /* set before loading, which a newer generation interrupts */
    note_change(worker, generation);
    worker->pass = 0;
    const bool had_slime = has_slime(worker);
    pthread_rwlock_wrlock(&worker->snapshot_lock);
    set_ready(worker, false);
    status code = next ? STATUS_OK : out_of_memory(&why);
    if (next) {
        if (worker->snapshot && !live_is_on(worker->live_slime))
            scene_retain_meshes(next, worker->snapshot);
        live_detach(worker->live_slime);
        scene_destroy(worker->snapshot);
        worker->snapshot = next;
        code = live_attach(worker->live_slime, next, &why);
    }
    THEN(code, load_snapshot(worker, &why));
    pthread_rwlock_unlock(&worker->snapshot_lock);
    if (code == STATUS_OK && !live_is_on(worker->live_slime))
        scene_document_reuse_loaded(worker->scene_document, worker->snapshot, generation);
    pthread_mutex_lock(&worker->lock);
    worker->snapshot_generation =
        code == STATUS_INTERRUPTED ? 0 : generation; /* 0: try again, with the data loaded so far */
    worker->snapshot_ready = code == STATUS_OK;
    const bool differs = store_error(worker, code == STATUS_INTERRUPTED ? STATUS_OK : code, &why);
    pthread_mutex_unlock(&worker->lock);
    if (differs || has_slime(worker) != had_slime) /* whether there is a slime is part of the state */
        notify(worker);
    if (code == STATUS_INTERRUPTED) {
        worker->interrupted += render_worker_is_stale(worker);
        worker->copied_generation = 0;
    }
    worker->plan = code == STATUS_OK ? passes_plan(&worker->snapshot->render, worker->rate, RENDER_WORKER_FIRST_S)
                                     : (pass_plan){.count = 0};
}

static bool lacks_mesh(const scene *snapshot)
{
    bool lacks = false;
    for (size_t i = 0; i < snapshot->mesh_count; i++)
        lacks |= !snapshot->meshes[i].data;
    return lacks;
}

/* Runs the slime's commands and its motion; a snapshot that moved is rendered again. A slime without a mesh is loaded
 * again. */
void render_worker_move_snapshot(render_worker *worker)
{
    diagnostic why = {.line = 0};
    bool state_changed = false;
    worker->started_s = clock_wall_s();
    pthread_rwlock_wrlock(&worker->snapshot_lock);
    status code = live_advance(worker->live_slime, move_s, &state_changed, &why);
    const bool moved = live_fetch_moved(worker->live_slime),
               reload = (worker->was_on && !live_is_on(worker->live_slime)) ||
                        (worker->snapshot_ready && lacks_mesh(worker->snapshot));
    worker->was_on = live_is_on(worker->live_slime);
    if (code == STATUS_OK && reload)
        code = load_snapshot(worker, &why);
    if (code != STATUS_OK)
        set_ready(worker, false);
    pthread_rwlock_unlock(&worker->snapshot_lock);
    if (code == STATUS_INTERRUPTED) {
        pthread_mutex_lock(&worker->lock);
        worker->snapshot_generation = 0;
        pthread_mutex_unlock(&worker->lock);
        worker->copied_generation = 0; /* copy and load again */
    } else if (code != STATUS_OK) {
        set_error(worker, code, &why);
    }
    if (moved || reload || state_changed) {
        worker->pass = 0;
        worker->plan = passes_plan(&worker->snapshot->render, worker->rate, RENDER_WORKER_FIRST_S);
    }
    if (state_changed)
        notify(worker);
}

/* --- passes --- */

/* How often a render checks for an interruption; the target time of a live frame, for about 20 frames per second. */
static const double poll_s = 0.002, live_frame_s = 0.045;

static bool publish(render_worker *worker, shared_image *shown)
{
    pthread_mutex_lock(&worker->lock);
    shown->serial = ++worker->serial;
    pthread_mutex_unlock(&worker->lock);
    const shared_image *published = shared_image_create(shown);
    if (!published) {
        shared_image_drop(shown);
        return false;
    }
    shared_image_retain(published); /* for the listener */
    pthread_mutex_lock(&worker->lock);
    const shared_image *before = worker->newest;
    worker->newest = published;
    pthread_cond_broadcast(&worker->changed);
    pthread_mutex_unlock(&worker->lock);
    shared_image_release(before);
    worker->listener.published(worker->listener.context, published);
    shared_image_release(published);
    return true;
}

static bool is_raster(render_worker *worker, bool moving)
{
    return moving && live_preview_of(worker->live_slime) == LIVE_ZBUFFER;
}

/* The snapshot's scene with the settings of the pass. resolution: of a moving scene; otherwise NULL. */
static scene pass_scene(const render_worker *worker, int pass, const adaptive_resolution *resolution, bool raster)
{
    scene view = *worker->snapshot;
    view.render =
        resolution ? passes_settings(&worker->snapshot->render, adaptive_resolution_divisor(resolution), true)
                   : passes_settings(&worker->snapshot->render, worker->plan.shrink[pass], worker->plan.single[pass]);
    if (raster) {
        use_zbuffer(&view.render);
        view.render.spectrum = SPECTRUM_RGB;
    }
    return view;
}

static status describe(render_worker *worker, const job_account *account, int pass, bool moving, shared_image *out,
                       diagnostic *why)
{
    const film *shown = account->result->img;
    image *linear = NULL;
    TRY(film_image(shown, &linear, why));
    linear->tone = camera_tone(worker->snapshot);
    const bool final = !moving && pass == worker->plan.count - 1;
    *out = (shared_image){.generation = worker->snapshot_generation,
                          .pass = pass + 1,
                          .passes = worker->plan.count,
                          .final = final,
                          .width = shown->width,
                          .height = shown->height,
                          .full_width = (int)worker->snapshot->render.width,
                          .full_height = (int)worker->snapshot->render.height,
                          .numbers = report_image_numbers(account),
                          .film_hash = final ? job_account_hash(account) : 0,
                          .linear = linear,
                          .rendered = final ? scene_clone(worker->snapshot) : NULL};
    if (out->numbers && (out->rendered || !final))
        return STATUS_OK;
    shared_image_drop(out);
    return out_of_memory(why);
}

/* Updates the measured rate, which is smoothed so that the images of a drag keep their size. */
static void update_rate(render_worker *worker, int pass, const render_result *result)
{
    const double recent = 0.4;
    if (result->wall_s <= 0.0)
        return;
    const double rate =
        passes_work(&worker->snapshot->render, worker->plan.shrink[pass], worker->plan.single[pass]) / result->wall_s;
    worker->rate = worker->rate > 0.0 ? worker->rate + recent * (rate - worker->rate) : rate;
}

void render_worker_begin_pass(render_worker *worker, started_pass *out)
{
    const bool moving = live_is_moving(worker->live_slime), raster = is_raster(worker, moving);
    adaptive_resolution *resolution = !moving ? NULL : raster ? &worker->raster : &worker->traced;
    worker->started_s = clock_wall_s();
    pthread_rwlock_rdlock(&worker->snapshot_lock);
    *out =
        (started_pass){worker->pass, moving, raster, resolution, pass_scene(worker, worker->pass, resolution, raster)};
}

void render_worker_end_pass(render_worker *worker, const started_pass *started, status code, job_account *account,
                            diagnostic *why)
{
    const render_result *result = account->result;
    shared_image shown;
    THEN(code, describe(worker, account, started->pass, started->moving, &shown, why));
    pthread_rwlock_unlock(&worker->snapshot_lock);
    if (code == STATUS_OK) {
        if (started->resolution)
            adaptive_resolution_update(started->resolution, result->wall_s, live_frame_s);
        else
            update_rate(worker, started->pass, result);
        worker->pass = started->moving ? worker->plan.count : started->pass + 1;
        worker->interrupted = 0;
    } else if (code == STATUS_INTERRUPTED) {
        worker->interrupted += started->pass == 0 && render_worker_is_stale(worker);
    } else {
        worker->pass = worker->plan.count;
    }
    job_account_release(account);
    if (code != STATUS_INTERRUPTED)
        set_error(worker, code, why);
    if (code == STATUS_OK && !publish(worker, &shown)) {
        worker->pass = worker->plan.count;
        set_error(worker, out_of_memory(why), why);
    }
}

void render_worker_render_pass(render_worker *worker)
{
    const render_options options = {.progress_s = poll_s};
    diagnostic why = {.line = 0};
    started_pass started;
    job_account account;
    render_worker_begin_pass(worker, &started);
    cancel_token token = {.ask = is_cancelled, .context = worker};
    cancel_begin(&token);
    const status code = job_render(worker->renderer, &started.view, &options, &account, &why);
    cancel_end(&token);
    render_worker_end_pass(worker, &started, code, &account, &why);
}
