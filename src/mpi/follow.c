/* The loop of a rank other than 0. Its main thread is the messenger; a second one runs the job, whose pool traces. */
#include "mpi/follow.h"

#include "base/cancel.h"
#include "job/job.h"
#include "measure/usage.h"
#include "mpi/scene_wire.h"
#include "mpi/tracing.h"
#include "render/frame/renderer.h"
#include "scene/model/scene.h"
#include <assert.h>
#include <mpi.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct follower {
    job *with;
    frame_order order;
    scene *s;
    team *own;
    job_account account;
    rank_report report;
    const render_options *options;
} follower;

static void *trace(void *context)
{
    follower *f = context;
    cancel_begin(team_token(f->own));
    const status traced = job_render(f->with, f->s, f->options, &f->account, &f->report.why);
    cancel_end(team_token(f->own));
    f->report.code = team_status(f->own, traced, &f->report.why);
    team_left(f->own);
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

/* Traces this rank's part of the frame. */
static status trace_part(follower *f, diagnostic *why)
{
    const render_settings settings = tiles_settings(&f->s->render, f->order.tile);
    schedule tiles;
    schedule_start(&tiles, &settings);
    TRY(team_create(&tiles, scene_threads(&f->s->render), &f->own, why));
    const render_options options = {.usage = f->order.usage, .source = team_source(f->own)};
    f->options = &options;
    pthread_t thread;
    traffic moved = {0};
    if (pthread_create(&thread, NULL, trace, f) != 0)
        return diagnose(why, STATUS_FAILURE, "use fewer threads", "a thread cannot be started");
    messenger_work(f->order.head.frame, team_tracing(f->own), &moved);
    pthread_join(thread, NULL);
    f->report.account.pieces = moved.pieces;
    f->report.account.piece_bytes = moved.piece_bytes;
    return STATUS_OK;
}

static void run_frame(job *with, const frame_order *order)
{
    follower f = {.with = with, .order = *order};
    bool given_up = false;
    status code = scene_wire_receive(&f.s, &given_up, &f.report.why);
    if (given_up)
        return;
    THEN(code, trace_part(&f, &f.report.why));
    if (code != STATUS_OK)
        f.report.code = code;
    send_report(&f);
    job_account_release(&f.account);
    team_destroy(f.own);
    scene_destroy(f.s);
}

/* Waits for the next order; MPI would wait without sleeping. Messages of earlier frames are dropped. */
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
    job *with = NULL;
    frame_order order;
    TRY(job_create(&(job_settings){.level = NULL}, &with, why));
    while (next_order(&order) == TAG_FRAME)
        run_frame(with, &order);
    job_destroy(with);
    return STATUS_OK;
}
