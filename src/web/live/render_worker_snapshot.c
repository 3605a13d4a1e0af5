/* The work of the render worker's thread: the snapshot, which is the copy of the scene document that is rendered, is
 * kept up to date, moved, and rendered in passes. See web/live/render_worker_private.h. */
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
static void notify(render_worker *p)
{
    p->listener.state_changed(p->listener.context);
}

/* A failed attempt that took longer than this is repeated only after the same time has passed. */
static const double soon_s = 0.25;

/* Sets the snapshot's error. The caller holds the lock, and calls the listener if this returns true. */
static bool take_error(render_worker *p, status code, const diagnostic *why)
{
    const bool differs = code != p->trouble_code || (code != STATUS_OK && strcmp(why->what, p->trouble.what) != 0);
    p->trouble_code = code;
    p->trouble = *why;
    const double now_s = clock_wall_s(); /* a scene that never fits must not keep the machine busy */
    p->again_from_s = now_s + fmax(0.0, now_s - p->started_s - soon_s);
    pthread_cond_broadcast(&p->changed);
    return differs;
}

/* Sets the snapshot's error, and calls the listener. */
static void set_error(render_worker *p, status code, const diagnostic *why)
{
    pthread_mutex_lock(&p->lock);
    const bool differs = take_error(p, code, why);
    pthread_mutex_unlock(&p->lock);
    if (differs)
        notify(p);
}

/* --- the snapshot --- */

/* Computing time of the motion in a live frame. */
static const double move_s = 0.02;

/* Changes that come faster than images must not starve the viewer: a first pass that is out of date continues for
 * first_s, twice its planned time. Where that is too short, because the speed was estimated wrong or a model is being
 * loaded, a pass after INTERRUPTED_MAX interrupted ones continues for grace_s. */
enum { INTERRUPTED_MAX = 3 };
static const double first_s = 2.0 * RENDER_WORKER_FIRST_S, grace_s = 0.5;

double render_worker_due_s(render_worker *p)
{
    if (render_worker_is_stale(p) || live_is_due(p->live_slime))
        return 0.0;
    if (!p->snapshot_ready || p->pass >= p->plan.count)
        return INFINITY;
    return p->pass > 0 ? fmax(0.0, p->finer_after_s - clock_wall_s()) : 0.0;
}

bool render_worker_is_stale(render_worker *p)
{
    return scene_document_generation(p->scene_document) != p->taken_generation;
}

/* Whether to interrupt the current load or pass; of is the render worker. As the ask of a token. */
static bool must_end(void *of)
{
    render_worker *p = of;
    pthread_mutex_lock(&p->lock);
    const bool stopping = p->stop || p->waiting;
    pthread_mutex_unlock(&p->lock);
    const double granted_s = p->pass > 0 ? 0.0 : p->interrupted >= INTERRUPTED_MAX ? grace_s : first_s;
    return stopping || (render_worker_is_stale(p) && clock_wall_s() - p->started_s >= granted_s) ||
           (live_is_due(p->live_slime) && p->pass > 0);
}

typedef struct loading {
    render_worker *of;
    cancel_token token;
} loading;

/* Simulating a slime up to its time_s may take long: it is interrupted by a newer document or a command to the live
 * slime. */
static void look_for_commands(void *context, double share_done)
{
    loading *l = context;
    (void)share_done;
    if (live_is_due(l->of->live_slime))
        cancel_set(&l->token);
}

static status load_snapshot(render_worker *p, diagnostic *why)
{
    loading l = {p, {.ask = must_end, .context = p}};
    p->started_s = clock_wall_s();
    cancel_begin(&l.token);
    const status code = job_load(p->renderer, p->snapshot, &(load_watch){look_for_commands, &l}, why);
    cancel_end(&l.token);
    return code;
}

static bool has_slime(const render_worker *p)
{
    return p->snapshot && scene_moves(p->snapshot);
}

/* Call it under the snapshot lock, so that no reader sees a snapshot that is not loaded. */
static void set_ready(render_worker *p, bool ready)
{
    pthread_mutex_lock(&p->lock);
    p->snapshot_ready = ready;
    pthread_mutex_unlock(&p->lock);
}

/* Changes within together_s of each other are a drag: the passes after the first wait until there was no change for
 * rest_s. They would be interrupted anyway, and until then take processor time from the page that shows the first
 * pass. */
static const double together_s = 0.25, rest_s = 0.15;

static void note_change(render_worker *p, uint64_t generation)
{
    if (generation == p->seen_generation)
        return;
    const double now_s = clock_wall_s();
    const bool several = p->seen_generation > 0 && generation - p->seen_generation > 1;
    p->finer_after_s = several || now_s - p->changed_s < together_s ? now_s + rest_s : now_s;
    p->changed_s = now_s;
    p->seen_generation = generation;
}

/* Copies the scene document to the snapshot and reuses as much loaded data as possible. */
void render_worker_renew_snapshot(render_worker *p)
{
    diagnostic why = {.line = 0};
    uint64_t generation;
    p->started_s = clock_wall_s();
    scene *next = scene_document_copy(p->scene_document, &generation);
    p->taken_generation = generation; /* set before loading, which a newer generation interrupts */
    note_change(p, generation);
    p->pass = 0;
    const bool had_slime = has_slime(p);
    pthread_rwlock_wrlock(&p->snapshot_lock);
    set_ready(p, false);
    status code = next ? STATUS_OK : out_of_memory(&why);
    if (next) {
        if (p->snapshot && !live_is_on(p->live_slime))
            scene_borrow_meshes(next, p->snapshot);
        live_detach(p->live_slime);
        scene_destroy(p->snapshot);
        p->snapshot = next;
        code = live_attach(p->live_slime, next, &why);
    }
    THEN(code, load_snapshot(p, &why));
    pthread_rwlock_unlock(&p->snapshot_lock);
    if (code == STATUS_OK && !live_is_on(p->live_slime))
        scene_document_share_loaded(p->scene_document, p->snapshot, generation);
    pthread_mutex_lock(&p->lock);
    p->snapshot_generation =
        code == STATUS_INTERRUPTED ? 0 : generation; /* 0: try again, with the data loaded so far */
    p->snapshot_ready = code == STATUS_OK;
    const bool differs = take_error(p, code == STATUS_INTERRUPTED ? STATUS_OK : code, &why);
    pthread_mutex_unlock(&p->lock);
    if (differs || has_slime(p) != had_slime) /* whether there is a slime is part of the state */
        notify(p);
    if (code == STATUS_INTERRUPTED) {
        p->interrupted += render_worker_is_stale(p);
        p->taken_generation = 0;
    }
    p->plan =
        code == STATUS_OK ? passes_plan(&p->snapshot->render, p->rate, RENDER_WORKER_FIRST_S) : (pass_plan){.count = 0};
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
void render_worker_move_snapshot(render_worker *p)
{
    diagnostic why = {.line = 0};
    bool state_changed = false;
    p->started_s = clock_wall_s();
    pthread_rwlock_wrlock(&p->snapshot_lock);
    status code = live_advance(p->live_slime, move_s, &state_changed, &why);
    const bool moved = live_fetch_moved(p->live_slime), interrupted = (p->was_on && !live_is_on(p->live_slime)) ||
                                                                      (p->snapshot_ready && lacks_mesh(p->snapshot));
    p->was_on = live_is_on(p->live_slime);
    if (code == STATUS_OK && interrupted)
        code = load_snapshot(p, &why);
    if (code != STATUS_OK)
        set_ready(p, false);
    pthread_rwlock_unlock(&p->snapshot_lock);
    if (code == STATUS_INTERRUPTED) {
        pthread_mutex_lock(&p->lock);
        p->snapshot_generation = 0;
        pthread_mutex_unlock(&p->lock);
        p->taken_generation = 0; /* copy and load again */
    } else if (code != STATUS_OK) {
        set_error(p, code, &why);
    }
    if (moved || interrupted || state_changed) {
        p->pass = 0;
        p->plan = passes_plan(&p->snapshot->render, p->rate, RENDER_WORKER_FIRST_S);
    }
    if (state_changed)
        notify(p);
}

/* --- passes --- */

/* How often a render checks for an interruption; the target time of a live frame, for about 20 frames a second. */
static const double poll_s = 0.002, live_frame_s = 0.045;

static bool publish(render_worker *p, shared_image *shown)
{
    pthread_mutex_lock(&p->lock);
    shown->serial = ++p->serial;
    pthread_mutex_unlock(&p->lock);
    const shared_image *published = shared_image_create(shown);
    if (!published) {
        shared_image_drop(shown);
        return false;
    }
    shared_image_retain(published); /* for the listener */
    pthread_mutex_lock(&p->lock);
    const shared_image *before = p->newest;
    p->newest = published;
    pthread_cond_broadcast(&p->changed);
    pthread_mutex_unlock(&p->lock);
    shared_image_release(before);
    p->listener.published(p->listener.context, published);
    shared_image_release(published);
    return true;
}

static bool is_raster(render_worker *p, bool moving)
{
    return moving && live_preview_of(p->live_slime) == LIVE_ZBUFFER;
}

/* The snapshot's scene with the settings of the pass. tempo: of a moving scene; otherwise NULL. */
static scene pass_scene(const render_worker *p, int pass, const adaptive_resolution *tempo, bool raster)
{
    scene view = *p->snapshot;
    view.render = tempo ? passes_settings(&p->snapshot->render, adaptive_resolution_divisor(tempo), true)
                        : passes_settings(&p->snapshot->render, p->plan.shrink[pass], p->plan.single[pass]);
    if (raster) {
        draw_triangles(&view.render);
        view.render.spectrum = SPECTRUM_RGB;
    }
    return view;
}

static status describe(render_worker *p, const job_account *account, int pass, bool moving, shared_image *out,
                       diagnostic *why)
{
    const film *shown = account->result->img;
    image *linear = NULL;
    TRY(film_image(shown, &linear, why));
    linear->tone = camera_tone(p->snapshot);
    const bool final = !moving && pass == p->plan.count - 1;
    *out = (shared_image){.generation = p->snapshot_generation,
                          .pass = pass + 1,
                          .passes = p->plan.count,
                          .final = final,
                          .width = shown->width,
                          .height = shown->height,
                          .full_width = (int)p->snapshot->render.width,
                          .full_height = (int)p->snapshot->render.height,
                          .numbers = report_page(account),
                          .film_hash = final ? job_account_hash(account) : 0,
                          .linear = linear,
                          .of = final ? scene_clone(p->snapshot) : NULL};
    if (out->numbers && (out->of || !final))
        return STATUS_OK;
    shared_image_drop(out);
    return out_of_memory(why);
}

/* Smoothed, so that the images of a drag keep their size. */
static void take_rate(render_worker *p, int pass, const render_result *result)
{
    const double recent = 0.4;
    if (result->wall_s <= 0.0)
        return;
    const double rate = passes_work(&p->snapshot->render, p->plan.shrink[pass], p->plan.single[pass]) / result->wall_s;
    p->rate = p->rate > 0.0 ? p->rate + recent * (rate - p->rate) : rate;
}

void render_worker_begin_pass(render_worker *p, started_pass *out)
{
    const bool moving = live_is_moving(p->live_slime), raster = is_raster(p, moving);
    adaptive_resolution *tempo = !moving ? NULL : raster ? &p->raster : &p->traced;
    p->started_s = clock_wall_s();
    pthread_rwlock_rdlock(&p->snapshot_lock);
    *out = (started_pass){p->pass, moving, raster, tempo, pass_scene(p, p->pass, tempo, raster)};
}

void render_worker_end_pass(render_worker *p, const started_pass *of, status code, job_account *account,
                            diagnostic *why)
{
    const render_result *result = account->result;
    shared_image shown;
    THEN(code, describe(p, account, of->pass, of->moving, &shown, why));
    pthread_rwlock_unlock(&p->snapshot_lock);
    if (code == STATUS_OK) {
        if (of->tempo)
            adaptive_resolution_update(of->tempo, result->wall_s, live_frame_s);
        else
            take_rate(p, of->pass, result);
        p->pass = of->moving ? p->plan.count : of->pass + 1;
        p->interrupted = 0;
    } else if (code == STATUS_INTERRUPTED) {
        p->interrupted += of->pass == 0 && render_worker_is_stale(p);
    } else {
        p->pass = p->plan.count;
    }
    job_account_release(account);
    if (code != STATUS_INTERRUPTED)
        set_error(p, code, why);
    if (code == STATUS_OK && !publish(p, &shown)) {
        p->pass = p->plan.count;
        set_error(p, out_of_memory(why), why);
    }
}

void render_worker_render_pass(render_worker *p)
{
    const render_options options = {.progress_s = poll_s};
    diagnostic why = {.line = 0};
    started_pass of;
    job_account account;
    render_worker_begin_pass(p, &of);
    cancel_token token = {.ask = must_end, .context = p};
    cancel_begin(&token);
    const status code = job_render(p->renderer, &of.view, &options, &account, &why);
    cancel_end(&token);
    render_worker_end_pass(p, &of, code, &account, &why);
}
