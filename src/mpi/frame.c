/* A frame on the ranks of an MPI job. Rank 0 leads: it sends the order, runs the messenger on a thread, and collects
 * all tiles. The other ranks follow: their main thread is the messenger, and a second thread runs the job, whose pool
 * renders. */
#include "base/cancel.h"
#include "job/job.h"
#include "measure/clock.h"
#include "measure/usage.h"
#include "mpi/tracing.h"
#include "render/frame/renderer.h"
#include "scene/model/scene.h"
#include "scene/package/package.h"

#include <assert.h>
#include <math.h>
#include <mpi.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* --- rank 0 --- */

#define WATCH_S 0.1

/* The reports of the other ranks, with the workers of all these ranks in one list. */
typedef struct other_ranks {
    ray_counters counters;
    rank_usage *ranks; /* indexed by rank */
    worker_report *workers;
    int count;
    status code; /* the first error that a rank reported; cancellations do not count */
    diagnostic why;
} other_ranks;

struct lead {
    int ranks;
    int64_t frame;
    job_distribution job_interface;
    /* of the current frame */
    pthread_t thread;
    handout *tiles;
    tiled_frame sum;
    tile_queues *queues;
    frame_sink sink;
    void (*progress)(void *context, double fraction); /* or NULL */
    void *context;
    cancel_token *token; /* of the thread that renders */
    double begun_s, complete_s, watched_s;
    other_ranks others;
    uint64_t scene_bytes;
};

/* --- messages that arrive --- */

static void put_tile(void *of, tile_message *tile)
{
    lead *l = of;
    tiled_frame_store(&l->sum, tile->head.value, tile->values);
    free(tile);
    if (handout_is_complete(l->tiles))
        l->complete_s = clock_wall_s();
}

/* Appends a rank's workers, whose times count from the rank's start of the frame. */
static bool append_workers(other_ranks *o, int rank, const worker_report *workers, int count)
{
    worker_report *grown = realloc(o->workers, (size_t)(o->count + count) * sizeof *grown);
    if (!grown)
        return false;
    o->workers = grown;
    for (int i = 0; i < count; i++) {
        grown[o->count] = workers[i];
        grown[o->count++].rank = rank;
    }
    return true;
}

static void add_report(void *of, int rank, const rank_report *report, const worker_report *workers)
{
    lead *l = of;
    other_ranks *o = &l->others;
    ray_counters_add(&o->counters, &report->counters);
    o->ranks[rank] = report->account;
    status code = (status)report->code;
    diagnostic why = report->why;
    if (!append_workers(o, rank, workers, (int)report->workers))
        code = out_of_memory(&why);
    if (code == STATUS_OK && handout_held(l->tiles, rank) > 0)
        code = diagnose(&why, STATUS_FAILURE, "report this as a bug, with the scene", "tiles are missing");
    if (o->code == STATUS_OK && code != STATUS_OK && code != STATUS_INTERRUPTED) {
        o->code = code;
        o->why = why;
        diagnose(&o->why, code, why.remedy, "rank %d: %.400s", rank, why.what);
        cancel_set(tile_queues_token(l->queues));
    }
}

static void show_progress(void *of, double fraction)
{
    lead *l = of;
    const double now_s = clock_wall_s();
    if (!l->progress || now_s - l->watched_s < WATCH_S)
        return;
    l->watched_s = now_s;
    l->progress(l->context, fraction);
}

static void *serve(void *of)
{
    lead *l = of;
    traffic moved = {0}; /* not used: each rank reports its traffic */
    cancel_follow(l->token);
    messenger_serve(l->frame, l->ranks, l->tiles, tile_queues_tracing(l->queues), &l->sink, &moved);
    return NULL;
}

/* --- the frame --- */

static status refuse(const scene *s, const render_options *o, diagnostic *why)
{
    if (s->render.error > 0.0 && s->render.integrator == INTEGRATOR_PATH)
        return diagnose(why, STATUS_BAD_INPUT, "set render.error to 0, or use one process",
                        "render.error needs the noise of the whole image, which no rank has");
    if (o->pixel_rays || o->pixel_time || o->pixel_cut || o->layers || o->timeline)
        return diagnose(why, STATUS_BAD_INPUT, "request only the image, or use one process",
                        "maps, layers and the timeline are not sent between ranks");
    if (s->render.bands > 0)
        return diagnose(why, STATUS_BAD_INPUT, "leave out --bands, or use one process",
                        "bands of wavelengths are not sent between ranks");
    return STATUS_OK;
}

static void release_frame(lead *l)
{
    tiled_frame_release(&l->sum);
    free(l->others.workers);
    free(l->others.ranks);
    handout_destroy(l->tiles);
    tile_queues_destroy(l->queues);
    l->others = (other_ranks){.code = STATUS_OK};
    l->tiles = NULL;
    l->queues = NULL;
}

/* SIDE_MOST: MPI counts the bytes of a tile's message in an int. */
enum { SIDE_MOST = 4096, SIDE_GROWN = 128, TILES_ENOUGH = 64 };

/* The side of the tiles: as for a single process with the workers of all ranks, but larger while each worker still has
 * TILES_ENOUGH tiles, because the last rays of a tile do not fill batches (renderer.h, tile_source). */
static int tile_side(const scene *s, int ranks)
{
    render_settings all = s->render;
    schedule tiles;
    all.threads = (int64_t)scene_threads(&s->render) * ranks;
    schedule_start(&tiles, &all);
    int side = tiles.tile < SIDE_MOST ? tiles.tile : SIDE_MOST;
    while (2 * side <= SIDE_GROWN &&
           s->render.width * s->render.height / (4 * side * side) >= TILES_ENOUGH * all.threads)
        side *= 2;
    return side;
}

static status prepare(lead *l, const scene *s, diagnostic *why)
{
    TRY(tiled_frame_begin(s, tile_side(s, l->ranks), &l->sum, why));
    TRY(handout_create(l->sum.places.tile_count, l->ranks, &l->tiles, why));
    TRY(tile_queues_create(&l->sum.places, scene_threads(&s->render), &l->queues, why));
    return (l->others.ranks = calloc((size_t)l->ranks, sizeof *l->others.ranks)) ? STATUS_OK : out_of_memory(why);
}

/* Sends the order and the scene to the other ranks, which answer when they are ready. */
static status send_orders(lead *l, const scene *s, bool measured, diagnostic *why)
{
    const frame_order order = {.head.frame = ++l->frame, .tile = l->sum.places.tile, .usage = measured};
    for (int rank = 1; rank < l->ranks; rank++)
        MPI_Send(&order, sizeof order, MPI_BYTE, rank, TAG_FRAME, MPI_COMM_WORLD);
    l->scene_bytes = 0;
    return l->ranks > 1 ? scene_wire_send(s, &l->scene_bytes, why) : STATUS_OK;
}

static status begin(void *of, const scene *s, const render_options *requested, const tile_source **source,
                    diagnostic *why)
{
    lead *l = of;
    TRY(refuse(s, requested, why));
    status code = prepare(l, s, why);
    THEN(code, scene_build_hierarchies(s, why)); /* before the other ranks wait for the scene */
    THEN(code, send_orders(l, s, requested->usage, why));
    if (code != STATUS_OK) {
        release_frame(l);
        return code;
    }
    l->sink = (frame_sink){l, put_tile, add_report, show_progress};
    l->progress = requested->progress;
    l->context = requested->context;
    cancel_begin(tile_queues_token(l->queues));
    l->token = cancel_current();
    l->begun_s = l->watched_s = clock_wall_s();
    l->complete_s = NAN;
    *source = tile_queues_source(l->queues);
    if (pthread_create(&l->thread, NULL, serve, l) != 0)
        MPI_Abort(MPI_COMM_WORLD, STATUS_FAILURE); /* the other ranks wait for the tiles of this frame */
    return STATUS_OK;
}

/* Sets the usage of all ranks; this process is rank 0. */
static void add_ranks(lead *l, render_result *result)
{
    rank_usage *ranks = l->others.ranks;
    ranks[0] = (rank_usage){
        .wall_s = result->wall_s, .cpu_s = result->cpu_s, .peak_rss_bytes = (uint64_t)usage_now().peak_rss_bytes};
    for (int rank = 1; rank < l->ranks; rank++)
        result->cpu_s += ranks[rank].cpu_s;
    result->ranks = ranks;
    result->rank_count = l->ranks;
    result->tile = l->sum.places.tile;
    result->scene_bytes = l->scene_bytes;
    l->others.ranks = NULL;
}

/* Appends the workers of the other ranks, and sets the waiting times of all workers: the wall time of the frame minus
 * their busy times. */
static status add_workers(const lead *l, render_result *result, double wall_s, diagnostic *why)
{
    const other_ranks *o = &l->others;
    worker_report *all = realloc(result->workers, (size_t)(result->worker_count + o->count) * sizeof *all);
    if (!all)
        return out_of_memory(why);
    if (o->count > 0)
        memcpy(all + result->worker_count, o->workers, (size_t)o->count * sizeof *all);
    result->workers = all;
    result->worker_count += o->count;
    for (int i = 0; i < result->worker_count; i++)
        all[i].waiting_s = wall_s - all[i].busy_s;
    return STATUS_OK;
}

/* Adds the results of the other ranks to this rank's. */
static status add_others(lead *l, render_result *result, diagnostic *why)
{
    const double wall_s = (isfinite(l->complete_s) ? l->complete_s : clock_wall_s()) - l->begun_s;
    ray_counters_add(&result->counters, &l->others.counters);
    add_ranks(l, result);
    result->wall_s = wall_s;
    result->img = l->sum.img;
    result->variance = l->sum.variance;
    l->sum.img = NULL;
    l->sum.variance = NULL;
    return add_workers(l, result, wall_s, why);
}

static status end(void *of, status rendered, render_result *result, diagnostic *why)
{
    lead *l = of;
    rendered = tile_queues_status(l->queues, rendered, why);
    if (rendered != STATUS_OK)
        cancel_set(tile_queues_token(l->queues));
    tile_queues_close(l->queues);
    cancel_join(l->thread);
    status code = rendered == STATUS_OK && cancel_asked() ? STATUS_INTERRUPTED : rendered;
    cancel_end(tile_queues_token(l->queues));
    if (l->others.code != STATUS_OK) {
        code = l->others.code;
        *why = l->others.why;
    }
    if (result) {
        const status added = add_others(l, result, why);
        code = added == STATUS_OK ? code : added;
    }
    release_frame(l);
    return code;
}

/* --- creation --- */

status lead_create(int ranks, lead **out, diagnostic *why)
{
    lead *l = aligned_alloc(64, (sizeof *l + 63) / 64 * 64); /* a schedule is aligned to cache lines */
    if (!l)
        return out_of_memory(why);
    memset(l, 0, sizeof *l);
    l->ranks = ranks;
    l->job_interface = (job_distribution){begin, end, l};
    *out = l;
    return STATUS_OK;
}

void lead_destroy(lead *l)
{
    if (!l)
        return;
    const wire_head head = {.frame = l->frame + 1};
    for (int rank = 1; rank < l->ranks; rank++)
        MPI_Send(&head, sizeof head, MPI_BYTE, rank, TAG_QUIT, MPI_COMM_WORLD);
    free(l);
}

const job_distribution *lead_distribution(const lead *l)
{
    return &l->job_interface;
}

/* --- the other ranks --- */

typedef struct follower {
    job *frame_job;
    frame_order order;
    scene *s;
    tile_queues *queues;
    job_account account;
    rank_report report;
    const render_options *options;
} follower;

static void *render(void *context)
{
    follower *f = context;
    cancel_begin(tile_queues_token(f->queues));
    const status rendered = job_render(f->frame_job, f->s, f->options, &f->account, &f->report.why);
    cancel_end(tile_queues_token(f->queues));
    f->report.code = tile_queues_status(f->queues, rendered, &f->report.why);
    tile_queues_close(f->queues);
    return NULL;
}

static void send_report(follower *f)
{
    const render_result *result = f->account.result;
    const size_t workers = result ? (size_t)result->worker_count : 0;
    const size_t bytes = sizeof f->report + workers * sizeof *result->workers;
    char *message = malloc(bytes);
    if (!message)
        MPI_Abort(MPI_COMM_WORLD, STATUS_FAILURE);
    f->report.head.frame = f->order.head.frame;
    f->report.workers = (int64_t)workers;
    f->report.account.peak_rss_bytes = (uint64_t)usage_now().peak_rss_bytes;
    if (result) {
        f->report.counters = result->counters;
        f->report.account.wall_s = result->wall_s;
        f->report.account.cpu_s = result->cpu_s;
        memcpy(message + sizeof f->report, result->workers, workers * sizeof *result->workers);
    }
    memcpy(message, &f->report, sizeof f->report);
    MPI_Send(message, (int)bytes, MPI_BYTE, 0, TAG_REPORT, MPI_COMM_WORLD);
    free(message);
}

/* Renders this rank's part of the frame. */
static status render_part(follower *f, diagnostic *why)
{
    const render_settings settings = tiles_settings(&f->s->render, f->order.tile);
    schedule tiles;
    schedule_start(&tiles, &settings);
    TRY(tile_queues_create(&tiles, scene_threads(&f->s->render), &f->queues, why));
    const render_options options = {.usage = f->order.usage, .source = tile_queues_source(f->queues)};
    f->options = &options;
    pthread_t thread;
    traffic moved = {0};
    if (pthread_create(&thread, NULL, render, f) != 0)
        return diagnose(why, STATUS_FAILURE, "use fewer threads", "a thread cannot be started");
    messenger_work(f->order.head.frame, tile_queues_tracing(f->queues), &moved);
    pthread_join(thread, NULL);
    f->report.account.tiles_sent = moved.tiles;
    f->report.account.tile_bytes_sent = moved.tile_bytes;
    return STATUS_OK;
}

static void run_frame(job *frame_job, const frame_order *order)
{
    follower f = {.frame_job = frame_job, .order = *order};
    bool failed = false;
    status code = scene_wire_receive(&f.s, &failed, &f.report.why);
    if (failed)
        return;
    THEN(code, render_part(&f, &f.report.why));
    if (code != STATUS_OK)
        f.report.code = code;
    send_report(&f);
    job_account_release(&f.account);
    tile_queues_destroy(f.queues);
    scene_destroy(f.s);
}

/* Waits for the next order; MPI's wait would keep a processor busy. Messages of earlier frames are dropped. */
static int next_order(frame_order *order)
{
    for (;;) {
        MPI_Status arrived;
        int there = 0;
        MPI_Iprobe(0, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &arrived);
        if (!there) {
            nanosleep(&(struct timespec){.tv_nsec = 500000}, NULL);
            continue;
        }
        char message[sizeof(wire_head) + HANDOUT_MOST * sizeof(int32_t)];
        static_assert(sizeof message >= sizeof *order, "any message to a rank fits");
        MPI_Recv(message, sizeof message, MPI_BYTE, 0, arrived.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        memcpy(order, message, sizeof *order);
        if (arrived.MPI_TAG == TAG_FRAME || arrived.MPI_TAG == TAG_QUIT)
            return arrived.MPI_TAG;
    }
}

status follow(diagnostic *why)
{
    job *frame_job = NULL;
    frame_order order;
    TRY(job_create(&(job_settings){.level = NULL}, &frame_job, why));
    while (next_order(&order) == TAG_FRAME)
        run_frame(frame_job, &order);
    job_destroy(frame_job);
    return STATUS_OK;
}
