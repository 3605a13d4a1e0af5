/* The painter's stage: the scene that it shows, brought there from the desk and moved. See
 * web/live/render_worker_private.h. */
#include "web/live/render_worker_private.h"
#include "measure/clock.h"
#include "scene/motion/motion.h"
#include "scene/model/scene.h"

/* Of a frame of the live slime, how long its motion may take. */
static const double move_s = 0.02;

/* So often may a first pass be ended by newer changes before one is let through: who watches somebody else's drag shall
 * see it. But no longer than so: what takes minutes must not keep back what is newer. */
enum { ENDED_MAX = 12 };
static const double let_through_s = 0.5;

bool render_worker_is_stale(render_worker *p)
{
    return scene_document_generation(p->scene_document) != p->taken;
}

/* Shall what is on its way end? A first pass that was ended too often goes on for a while. */
bool render_worker_must_end(void *of)
{
    render_worker *p = of;
    pthread_mutex_lock(&p->lock);
    const bool now = p->stop || p->waiting;
    pthread_mutex_unlock(&p->lock);
    const bool let_through = p->ended >= ENDED_MAX && clock_wall_s() - p->begun_s < let_through_s;
    return now || (render_worker_is_stale(p) && !let_through) || (live_is_due(p->toy) && p->pass > 0);
}

/* A slime's way to its moment may be long: it ends where that is no longer wanted, by the desk or by who plays with it.
 */
static bool go_on_loading(void *of, double share_done)
{
    (void)share_done;
    return !live_is_due(((render_worker *)of)->toy);
}

static status load_snapshot(render_worker *p, diagnostic *why)
{
    const load_watch watch = {go_on_loading, p};
    p->begun_s = clock_wall_s();
    return job_load(p->with, p->snapshot, &watch, why);
}

static bool has_slime(const render_worker *p)
{
    return p->snapshot && scene_moves(p->snapshot);
}

/* Under the stage lock, so that nobody looks at a stage that is not loaded. */
static void set_ready(render_worker *p, bool ready)
{
    pthread_mutex_lock(&p->lock);
    p->snapshot_ready = ready;
    pthread_mutex_unlock(&p->lock);
}

/* The stage becomes what is on the desk, with as much as possible of what was loaded before. */
void render_worker_renew_snapshot(render_worker *p)
{
    diagnostic why = {.line = 0};
    uint64_t generation;
    scene *next = scene_document_take(p->scene_document, &generation);
    p->taken = generation; /* before it is loaded, which ends when there is a newer one */
    const bool had_slime = has_slime(p);
    pthread_rwlock_wrlock(&p->snapshot_lock);
    set_ready(p, false);
    status code = next ? STATUS_OK : out_of_memory(&why);
    if (next) {
        if (p->snapshot && !live_is_on(p->toy))
            scene_borrow_meshes(next, p->snapshot);
        live_detach(p->toy);
        scene_destroy(p->snapshot);
        p->snapshot = next;
        code = live_attach(p->toy, next, &why);
    }
    THEN(code, load_snapshot(p, &why));
    pthread_rwlock_unlock(&p->snapshot_lock);
    if (code == STATUS_OK && !live_is_on(p->toy))
        scene_document_lend(p->scene_document, p->snapshot, generation);
    pthread_mutex_lock(&p->lock);
    p->snapshot_generation =
        code == STATUS_INTERRUPTED ? 0 : generation; /* 0: begun again, from what was loaded so far */
    p->snapshot_ready = code == STATUS_OK;
    const bool differs = render_worker_take_error(p, code == STATUS_INTERRUPTED ? STATUS_OK : code, &why);
    pthread_mutex_unlock(&p->lock);
    if (differs || has_slime(p) != had_slime) /* which is part of the state */
        render_worker_notify(p);
    if (code == STATUS_INTERRUPTED) {
        p->ended += render_worker_is_stale(p);
        p->taken = 0;
    }
    p->pass = 0;
    p->plan =
        code == STATUS_OK ? passes_plan(&p->snapshot->render, p->rate, RENDER_WORKER_FIRST_S) : (pass_plan){.count = 0};
}

static bool is_bare(const scene *snapshot)
{
    bool bare = false;
    for (size_t i = 0; i < snapshot->mesh_count; i++)
        bare |= !snapshot->meshes[i].data;
    return bare;
}

/* The slime's orders and its motion; a stage that moved is painted anew. What it leaves without a mesh, whenever the
 * order came, is loaded. */
void render_worker_move_snapshot(render_worker *p)
{
    diagnostic why = {.line = 0};
    bool told = false;
    pthread_rwlock_wrlock(&p->snapshot_lock);
    status code = live_advance(p->toy, move_s, &told, &why);
    const bool moved = live_take_moved(p->toy),
               ended = (p->was_on && !live_is_on(p->toy)) || (p->snapshot_ready && is_bare(p->snapshot));
    p->was_on = live_is_on(p->toy);
    if (code == STATUS_OK && ended)
        code = load_snapshot(p, &why);
    if (code != STATUS_OK)
        set_ready(p, false);
    pthread_rwlock_unlock(&p->snapshot_lock);
    if (code == STATUS_INTERRUPTED) {
        pthread_mutex_lock(&p->lock);
        p->snapshot_generation = 0;
        pthread_mutex_unlock(&p->lock);
        p->taken = 0; /* begun again */
    } else if (code != STATUS_OK) {
        render_worker_set_error(p, code, &why);
    }
    if (moved || ended || told) {
        p->pass = 0;
        p->plan = passes_plan(&p->snapshot->render, p->rate, RENDER_WORKER_FIRST_S);
    }
    if (told)
        render_worker_notify(p);
}
