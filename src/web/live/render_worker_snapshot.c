/* The render worker's snapshot: the copy of the scene document that is rendered, kept up to date and moved. See
 * web/live/render_worker_private.h. */
#include "web/live/render_worker_private.h"
#include "base/cancel.h"
#include "measure/clock.h"
#include "scene/motion/motion.h"
#include "scene/model/scene.h"

#include <math.h>

/* The share of a live frame that the motion may take. */
static const double move_s = 0.02;

/* Changes that come faster than images must not starve the viewer: a first pass that is out of date goes on for
 * first_s, its planned time twice over. Where that is too short, because the speed was estimated wrong or a model is
 * being loaded, one that follows INTERRUPTED_MAX interrupted ones goes on for let_through_s. */
enum { INTERRUPTED_MAX = 3 };
static const double first_s = 2.0 * RENDER_WORKER_FIRST_S, let_through_s = 0.5;

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

/* Whether to interrupt the current load or pass. */
bool render_worker_must_end(void *of)
{
    render_worker *p = of;
    pthread_mutex_lock(&p->lock);
    const bool stopping = p->stop || p->waiting;
    pthread_mutex_unlock(&p->lock);
    const double granted_s = p->pass > 0 ? 0.0 : p->interrupted >= INTERRUPTED_MAX ? let_through_s : first_s;
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
    loading l = {p, {.ask = render_worker_must_end, .context = p}};
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

/* Changes that follow each other within TOGETHER_S are a drag: the passes after the first wait until it rests for
 * REST_S. They would be interrupted anyway, and meanwhile take the processors from whoever shows the first pass. */
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
    scene *next = scene_document_take(p->scene_document, &generation);
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
    const bool differs = render_worker_take_error(p, code == STATUS_INTERRUPTED ? STATUS_OK : code, &why);
    pthread_mutex_unlock(&p->lock);
    if (differs || has_slime(p) != had_slime) /* whether there is a slime is part of the state */
        render_worker_notify(p);
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

/* Runs the slime's commands and its motion; a snapshot that moved is rendered again. A slime that is left without a
 * mesh is loaded, whenever the command came. */
void render_worker_move_snapshot(render_worker *p)
{
    diagnostic why = {.line = 0};
    bool state_changed = false;
    p->started_s = clock_wall_s();
    pthread_rwlock_wrlock(&p->snapshot_lock);
    status code = live_advance(p->live_slime, move_s, &state_changed, &why);
    const bool moved = live_take_moved(p->live_slime), interrupted = (p->was_on && !live_is_on(p->live_slime)) ||
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
        render_worker_set_error(p, code, &why);
    }
    if (moved || interrupted || state_changed) {
        p->pass = 0;
        p->plan = passes_plan(&p->snapshot->render, p->rate, RENDER_WORKER_FIRST_S);
    }
    if (state_changed)
        render_worker_notify(p);
}
