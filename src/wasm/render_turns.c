/* Turns of the render worker without a thread, and passes whose tiles are rendered by tile workers. */
#include "measure/clock.h"
#include "render/frame/renderer.h"
#include "scene/model/integrators.h"
#include "scene/package/package.h"
#include "wasm/exports.h"
#include "wasm/no_threads.h"
#include "wasm/worker.h"
#include "web/live/render_worker_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WORKERS_MAX = 64, SIDE = 32 };

/* order_s: the time that an order should take; short, because a worker notices only between orders that its pass was
 * abandoned. But an order takes at least setup_factor times the preparation of the frame, such as photons. */
static const double order_s = 0.05, setup_factor = 4.0;

typedef struct remote {
    bool busy, lost;             /* lost: the worker could not start, or failed */
    uint64_t generation;         /* generation of the worker's scene; UINT64_MAX: a scene with a moving slime */
    double tiles_per_s, setup_s; /* measured in the last order of this pass; 0: none yet */
} remote;

static struct turns {
    render_worker *render;
    int workers;
    remote remotes[WORKERS_MAX];
    bool active;   /* tile workers are rendering a pass */
    int64_t frame; /* number of the pass */
    started_pass pass;
    tiled_frame sum;
    int64_t next, merged; /* the next tile for an order; number of merged tiles */
    bool has_photons;     /* the photons are counted: every order counts the same ones */
    ray_counters counters;
    photon_shortage few;
    double began_s;
} now;

void render_turns_set_workers(int workers)
{
    now.workers = workers < 0 ? 0 : workers > WORKERS_MAX ? WORKERS_MAX : workers;
}

status render_worker_start(render_worker *w, diagnostic *why)
{
    (void)why;
    now.render = w;
    return STATUS_OK;
}

void render_worker_join(render_worker *w)
{
    (void)w;
    now.render = NULL;
}

/* --- a pass of the tile workers --- */

static int64_t ceil_div(int64_t a, int64_t b)
{
    return (a + b - 1) / b;
}

/* The number of tiles of the next order. With photons, which every order traces again, each worker gets one order. */
static int64_t order_size(const remote *r)
{
    const int64_t all = now.sum.places.tile_count, left = all - now.next;
    if (scene_has_caustics(&now.pass.view.render))
        return ceil_div(all, now.workers);
    const double wanted_s = fmax(order_s, setup_factor * r->setup_s);
    const int64_t wanted =
        r->tiles_per_s > 0.0 ? (int64_t)ceil(r->tiles_per_s * wanted_s) : ceil_div(all, 16 * now.workers);
    const int64_t fair = ceil_div(left, 2 * (int64_t)now.workers); /* so that all end at about the same time */
    return wanted < fair ? wanted : fair;
}

static void send_order(int worker)
{
    remote *r = &now.remotes[worker];
    const int64_t left = now.sum.places.tile_count - now.next;
    if (r->busy || r->lost || left <= 0)
        return;
    const int64_t size = order_size(r), count = size < left ? size : left;
    const tile_order order = {.frame = now.frame,
                              .shrink = now.render->plan.shrink[now.pass.pass],
                              .single = now.render->plan.single[now.pass.pass],
                              .side = now.sum.places.tile,
                              .first = (int32_t)now.next,
                              .count = (int32_t)count};
    now.next += count;
    r->busy = true;
    host_send(worker, 1, &order, sizeof order);
}

static void finish(status code, job_account *account, diagnostic *why)
{
    tiled_frame_release(&now.sum);
    now.active = false;
    now.frame++;
    render_worker_end_pass(now.render, &now.pass, code, account, why);
}

/* Ends a pass that is out of date; answers to its orders will be dropped. */
static void abandon_pass(void)
{
    diagnostic why = {.line = 0};
    job_account none = {.result = NULL};
    finish(STATUS_INTERRUPTED, &none, &why);
}

static void fail(status code, diagnostic *why)
{
    job_account none = {.result = NULL};
    finish(code, &none, why);
}

static status sum_up(job_account *account, diagnostic *why)
{
    TRY(job_account_begin(&now.pass.view, job_isa(now.render->renderer), 1, account, why));
    render_result *result = calloc(1, sizeof *result);
    if (!result || !(result->workers = calloc((size_t)now.workers, sizeof *result->workers))) {
        free(result);
        return out_of_memory(why);
    }
    const double wall_s = clock_wall_s() - now.began_s;
    account->result = result;
    result->img = now.sum.img;
    result->variance = now.sum.variance;
    now.sum.img = NULL;
    now.sum.variance = NULL;
    result->counters = now.counters;
    result->few = now.few;
    result->replicates = renderer_replicates(&now.pass.view);
    result->worker_count = now.workers;
    result->wall_s = account->wall_s[0] = wall_s;
    result->cpu_s = account->cpu_s[0] = NAN;
    account->count = 1;
    account->complete = true;
    return STATUS_OK;
}

static void complete(void)
{
    diagnostic why = {.line = 0};
    job_account account = {.result = NULL};
    const status code = sum_up(&account, &why);
    finish(code, &account, &why);
}

/* render.error needs the noise of the whole image, which no worker has. */
static bool can_distribute(const scene *view)
{
    int present = 0;
    for (int i = 0; i < now.workers; i++)
        present += !now.remotes[i].lost;
    return present > 0 && !(view->render.error > 0.0 && view->render.integrator == INTEGRATOR_PATH);
}

/* Sends the snapshot to all workers, unless all have it already. */
static status send_scene(render_worker *w, diagnostic *why)
{
    bool all = true;
    for (int i = 0; i < now.workers; i++)
        all &= now.remotes[i].generation == w->snapshot_generation && !w->was_on;
    if (all)
        return STATUS_OK;
    void *bytes = NULL;
    size_t size = 0;
    TRY(scene_build_hierarchies(w->snapshot, why));
    TRY(scene_pack(w->snapshot, &bytes, &size, why));
    for (int i = 0; i < now.workers; i++) {
        host_send(i, 0, bytes, size);
        now.remotes[i].generation = w->was_on ? UINT64_MAX : w->snapshot_generation;
    }
    free(bytes);
    return STATUS_OK;
}

/* Starts the pass on the tile workers; false if the laboratory's worker must render it. */
static bool distribute_pass(render_worker *w)
{
    diagnostic why = {.line = 0};
    if (w->pass == 0 || live_is_moving(w->live_slime))
        return false;
    render_worker_begin_pass(w, &now.pass);
    if (!can_distribute(&now.pass.view) || send_scene(w, &why) != STATUS_OK) {
        pthread_rwlock_unlock(&w->snapshot_lock);
        return false;
    }
    now.active = true;
    now.next = now.merged = 0;
    now.has_photons = false;
    now.counters = (ray_counters){.camera = 0};
    now.began_s = clock_wall_s();
    const status code = tiled_frame_begin(&now.pass.view, SIDE, &now.sum, &why);
    if (code != STATUS_OK) {
        fail(code, &why);
        return true;
    }
    for (int i = 0; i < now.workers; i++) {
        now.remotes[i].tiles_per_s = now.remotes[i].setup_s = 0.0;
        send_order(i);
    }
    return true;
}

/* --- answers --- */

/* Adds the tiles; false for an incomplete answer. */
static bool merge(const tile_answer *a, const char *at, const char *end)
{
    for (int i = 0; i < a->traced; i++) {
        int64_t tile;
        if ((size_t)(end - at) < sizeof tile)
            return false;
        memcpy(&tile, at, sizeof tile);
        at += sizeof tile;
        const size_t bytes = tiled_frame_values(&now.sum, tile) * sizeof(int64_t);
        if (bytes == 0 || (size_t)(end - at) < bytes)
            return false;
        tiled_frame_store(&now.sum, tile, (const int64_t *)(const void *)at);
        at += bytes;
    }
    now.merged += a->traced;
    return true;
}

/* Every order traces the same photons. */
static void count(const tile_answer *a)
{
    ray_counters c = a->counters;
    if (now.has_photons)
        c.photon = 0;
    now.has_photons = true;
    now.few = a->few;
    ray_counters_add(&now.counters, &c);
}

void render_turns_traced(int worker, const void *bytes, size_t size)
{
    const tile_answer *a = bytes;
    remote *r = &now.remotes[worker];
    r->busy = false;
    if (!now.active)
        return;
    if (size < sizeof *a || a->of.frame != now.frame) {
        send_order(worker);
        return;
    }
    diagnostic why = a->why;
    if (a->code != STATUS_OK) {
        fail((status)a->code, &why);
        return;
    }
    if (a->traced != a->of.count || !merge(a, (const char *)(a + 1), (const char *)bytes + size)) {
        fail(diagnose(&why, STATUS_FAILURE, "report this as a bug, with the scene",
                      "the answer of a tile worker is incomplete"),
             &why);
        return;
    }
    count(a);
    r->setup_s = isnan(a->setup_s) ? 0.0 : a->setup_s;
    r->tiles_per_s = a->traced / fmax(1e-6, a->wall_s - r->setup_s);
    if (now.merged == now.sum.places.tile_count)
        complete();
    else
        send_order(worker);
}

/* A worker could not start, or failed: the pass begins again without it. */
void render_turns_lost(int worker)
{
    now.remotes[worker].lost = true;
    if (now.active)
        abandon_pass();
}

/* --- turns --- */

/* Does the work for which a request waits, if it can be done at once (no_threads.h). */
bool wasm_work_at_once(void)
{
    render_worker *w = now.render;
    if (!w)
        return false;
    const bool stale = render_worker_is_stale(w);
    if (!stale && !(w->snapshot && live_has_request(w->live_slime)))
        return false;
    if (now.active)
        abandon_pass();
    if (stale)
        render_worker_renew_snapshot(w);
    else
        render_worker_move_snapshot(w);
    return true;
}

/* One round of the loop of render_worker_thread.c. */
static void work(render_worker *w)
{
    if (render_worker_is_stale(w))
        render_worker_renew_snapshot(w);
    if (w->snapshot && (live_is_due(w->live_slime) || w->was_on))
        render_worker_move_snapshot(w);
    if (w->snapshot_ready && w->pass < w->plan.count && !distribute_pass(w))
        render_worker_render_pass(w);
}

double render_turns_run(void)
{
    render_worker *w = now.render;
    if (!w)
        return -1.0;
    if (w->again)
        w->copied_generation = 0;
    w->again = false;
    const bool changed = render_worker_is_stale(w) || live_is_due(w->live_slime);
    if (now.active && changed)
        abandon_pass();
    if (!now.active && render_worker_due_s(w) <= 0.0)
        work(w);
    requests_retry();
    if (now.active && !render_worker_is_stale(w) && !live_is_due(w->live_slime))
        return -1.0; /* until answers arrive */
    if (w->again)
        return 0.0;
    const double due_s = render_worker_due_s(w);
    return isinf(due_s) ? -1.0 : 1000.0 * due_s;
}
