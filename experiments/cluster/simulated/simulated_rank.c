/* Tiles that take time of a simulated processor instead of being traced. */
#include "simulated_rank.h"

#include "simulated_mpi.h"
#include <math.h>
#include <mpi.h>
#include <stdlib.h>
#include <time.h>

#define RING (4 * HANDOUT_MOST)

double frame_tile_ns(const frame_costs *f, int64_t tile)
{
    image_tile at;
    const double w = f->tiles->width, h = f->tiles->height;
    schedule_tile(f->tiles, tile, &at);
    return f->scale * (at.x1 - at.x0) * (at.y1 - at.y0) *
           cost_map_mean_ns(f->map, at.x0 / w, at.y0 / h, at.x1 / w, at.y1 / h);
}

size_t frame_tile_bytes(const frame_costs *f, int64_t tile)
{
    image_tile at;
    schedule_tile(f->tiles, tile, &at);
    return f->pixel_bytes * (size_t)(at.x1 - at.x0) * (size_t)(at.y1 - at.y0);
}

void spend_ns(double ns)
{
#ifdef SIMULATED
    smpi_execute_flops(ns); /* hosts of 1 Gf: one operation a nanosecond */
#else
    (void)ns;
#endif
}

static void give(void *of, const int32_t *tiles, int count)
{
    simulated_rank *r = of;
    for (int i = 0; i < count; i++) {
        if (r->count == RING)
            MPI_Abort(MPI_COMM_WORLD, STATUS_FAILURE);
        r->queue[(r->first + r->count++) % RING] = tiles[i];
    }
}

static tile_message *take(void *of)
{
    simulated_rank *r = of;
    tile_message *tile = r->finished;
    r->finished = NULL;
    return tile;
}

static void end(void *of)
{
    simulated_rank *r = of;
    r->ended = true;
}

static void stop(void *of)
{
    simulated_rank *r = of;
    r->ended = true;
    r->count = 0;
}

static bool over(void *of)
{
    const simulated_rank *r = of;
    return r->ended && r->count == 0 && !r->finished;
}

static bool never_traces(void *of)
{
    (void)of;
    return true;
}

/* The payload's memory is only reserved: what is not written takes no pages. */
static void trace(simulated_rank *r)
{
    const int32_t tile = r->queue[r->first];
    const size_t bytes = frame_tile_bytes(r->frame, tile);
    r->first = (r->first + 1) % RING;
    r->count--;
    const double begun_s = MPI_Wtime();
    spend_ns(frame_tile_ns(r->frame, tile));
    r->busy_s += MPI_Wtime() - begun_s;
    r->finished = malloc(sizeof *r->finished + bytes);
    if (!r->finished)
        MPI_Abort(MPI_COMM_WORLD, STATUS_FAILURE);
    r->finished->next = NULL;
    r->finished->bytes = sizeof r->finished->head + bytes;
    r->finished->head = (wire_head){.value = tile};
}

/* The messenger of a real rank looks for messages at intervals (wait_for_event in mpi/tracing.c). This one blocks, so
 * that a simulation has no idle turns, and then sleeps until the next of those times. */
static void wait_for_message(int idle)
{
    const double begun_s = MPI_Wtime();
    keep_next_message();
    const double passed_s = MPI_Wtime() - begun_s;
    double look_s = 0.0;
    while (look_s < passed_s && idle < 40)
        look_s += idle++ < 8 ? 50e-6 : 200e-6;
    if (look_s < passed_s)
        look_s += 1e-3 * ceil((passed_s - look_s) / 1e-3);
    const double rest_s = look_s - passed_s;
#ifdef SIMULATED
    if (rest_s > 1e-9)
        nanosleep(&(struct timespec){.tv_nsec = (long)(rest_s * 1e9)}, NULL);
#else
    (void)rest_s;
#endif
}

static void wait_or_trace(void *of, int idle)
{
    simulated_rank *r = of;
    if (r->count > 0)
        trace(r);
    else
        wait_for_message(idle);
}

tracing simulated_tracing(simulated_rank *r, const frame_costs *frame, int threads)
{
    *r = (simulated_rank){.frame = frame};
    return (tracing){threads, r, give, take, end, stop, threads > 0 ? over : never_traces, wait_or_trace};
}
