/* The loops of rank 0 and of the other ranks during a frame. */
#include "mpi/messenger.h"
#include "base/cancel.h"

#include <mpi.h>
#include <stdlib.h>

/* Allocates memory for a message. If there is none, ends all ranks, because the frame cannot be completed. */
static void *message_memory(size_t bytes)
{
    void *memory = malloc(bytes);
    if (!memory)
        MPI_Abort(MPI_COMM_WORLD, STATUS_FAILURE);
    return memory;
}

/* --- rank 0 --- */

typedef struct serving {
    int64_t frame;
    int ranks, reports, idle;
    handout *tiles;
    const tracing *tile_renderer;
    const frame_sink *sink;
    traffic *moved;
    bool *ended; /* by rank: whether TAG_END was sent */
    bool all_ended, cancelled;
} serving;

static void send_head(serving *s, int rank, int tag)
{
    const wire_head head = {.frame = s->frame};
    MPI_Send(&head, sizeof head, MPI_BYTE, rank, tag, MPI_COMM_WORLD);
    s->moved->messages++;
}

static void cancel_frame(serving *s)
{
    if (s->cancelled)
        return;
    s->cancelled = true;
    s->tile_renderer->stop(s->tile_renderer->of);
    for (int rank = 1; rank < s->ranks; rank++)
        send_head(s, rank, TAG_STOP);
}

/* Sends the rank the tiles that it should hold. When no tile is left, sends TAG_END, once. */
static void assign_tiles(serving *s, int rank)
{
    struct {
        wire_head head;
        int32_t tiles[HANDOUT_MOST];
    } message = {.head.frame = s->frame};
    if (s->cancelled)
        return;
    const int count = handout_assign(s->tiles, rank, message.tiles);
    if (count > 0 && rank == 0)
        s->tile_renderer->assign(s->tile_renderer->of, message.tiles, count);
    if (count > 0 && rank != 0) {
        const size_t bytes = sizeof message.head + (size_t)count * sizeof message.tiles[0];
        MPI_Send(&message, (int)bytes, MPI_BYTE, rank, TAG_TILES, MPI_COMM_WORLD);
        s->moved->messages++;
    }
    if (handout_is_empty(s->tiles) && !s->ended[rank]) {
        s->ended[rank] = true;
        if (rank == 0)
            s->tile_renderer->end(s->tile_renderer->of);
        else
            send_head(s, rank, TAG_END);
    }
}

/* When no tile is left, sends TAG_END to every rank, not only to the one that received the last tile. */
static void send_end(serving *s)
{
    if (s->all_ended || !handout_is_empty(s->tiles))
        return;
    s->all_ended = true;
    for (int rank = 0; rank < s->ranks; rank++)
        assign_tiles(s, rank);
}

static void accept_tile(serving *s, int rank, tile_message *tile)
{
    if (!handout_return(s->tiles, rank, tile->head.value, MPI_Wtime()))
        MPI_Abort(MPI_COMM_WORLD, STATUS_FAILURE);
    s->moved->tiles += rank != 0;
    s->moved->tile_bytes += rank != 0 ? tile->bytes : 0;
    s->sink->tile(s->sink->of, tile);
    assign_tiles(s, rank);
}

static void accept_report(serving *s, int rank, const void *bytes)
{
    const rank_report *report = bytes;
    const worker_report *workers = (const worker_report *)(report + 1);
    s->reports++;
    s->sink->report(s->sink->of, rank, report, workers);
}

/* Receives one message that has arrived. */
static void receive(serving *s, const MPI_Status *arrived)
{
    int bytes = 0;
    MPI_Get_count(arrived, MPI_BYTE, &bytes);
    const size_t size = (size_t)bytes;
    tile_message *tile = message_memory(sizeof *tile + size);
    tile->bytes = size;
    tile->next = NULL;
    MPI_Recv(&tile->head, bytes, MPI_BYTE, arrived->MPI_SOURCE, arrived->MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    s->moved->messages++;
    if (tile->head.frame == s->frame && arrived->MPI_TAG == TAG_RESULT) {
        accept_tile(s, arrived->MPI_SOURCE, tile);
        return;
    }
    if (tile->head.frame == s->frame && arrived->MPI_TAG == TAG_READY) {
        handout_join(s->tiles, arrived->MPI_SOURCE, (int)((const ready_note *)(const void *)&tile->head)->threads,
                     MPI_Wtime());
        assign_tiles(s, arrived->MPI_SOURCE);
    } else if (tile->head.frame == s->frame && arrived->MPI_TAG == TAG_REPORT) {
        accept_report(s, arrived->MPI_SOURCE, &tile->head);
    }
    free(tile);
}

/* Handles all messages that have arrived, and all finished tiles; false if there were none. */
static bool serve_once(serving *s)
{
    bool any = false;
    for (;;) {
        MPI_Status arrived;
        int there = 0;
        MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &arrived);
        if (!there)
            break;
        receive(s, &arrived);
        any = true;
    }
    for (tile_message *tile; (tile = s->tile_renderer->pop(s->tile_renderer->of)); any = true)
        accept_tile(s, 0, tile);
    return any;
}

static bool is_complete(const serving *s)
{
    return s->reports == s->ranks - 1 && s->tile_renderer->is_done(s->tile_renderer->of) &&
           (s->cancelled || handout_is_complete(s->tiles));
}

void messenger_serve(int64_t frame, int ranks, handout *tiles, const tracing *tile_renderer, const frame_sink *sink,
                     traffic *moved)
{
    serving s = {
        .frame = frame, .ranks = ranks, .tiles = tiles, .tile_renderer = tile_renderer, .sink = sink, .moved = moved};
    s.ended = message_memory((size_t)ranks * sizeof *s.ended);
    for (int rank = 0; rank < ranks; rank++)
        s.ended[rank] = false;
    if (tile_renderer->threads > 0) {
        handout_join(tiles, 0, tile_renderer->threads, MPI_Wtime());
        assign_tiles(&s, 0);
    }
    while (!is_complete(&s)) {
        if (serve_once(&s)) {
            s.idle = 0;
            send_end(&s);
        } else {
            tile_renderer->wait(tile_renderer->of, s.idle++);
        }
        sink->progress(sink->of, handout_fraction(tiles));
        if (cancel_asked())
            cancel_frame(&s);
    }
    free(s.ended);
}

/* --- the other ranks --- */

/* A ring of tiles that are being sent. */
enum { SENDING_MOST = 64 };

typedef struct working {
    int64_t frame;
    const tracing *tile_renderer;
    traffic *moved;
    tile_message *sending[SENDING_MOST];
    MPI_Request request[SENDING_MOST];
    int oldest, count;
    bool cancelled;
} working;

/* Frees the oldest tiles that have been sent; waits until at most `most` are still being sent. */
static void finish_sending(working *w, int most)
{
    while (w->count > 0) {
        int sent = 0;
        if (w->count > most)
            MPI_Wait(&w->request[w->oldest], MPI_STATUS_IGNORE);
        else
            MPI_Test(&w->request[w->oldest], &sent, MPI_STATUS_IGNORE);
        if (w->count <= most && !sent)
            return;
        free(w->sending[w->oldest]);
        w->oldest = (w->oldest + 1) % SENDING_MOST;
        w->count--;
    }
}

static void send_tile(working *w, tile_message *tile)
{
    finish_sending(w, SENDING_MOST - 1);
    const int at = (w->oldest + w->count++) % SENDING_MOST;
    tile->head.frame = w->frame;
    w->sending[at] = tile;
    MPI_Isend(&tile->head, (int)tile->bytes, MPI_BYTE, 0, TAG_RESULT, MPI_COMM_WORLD, &w->request[at]);
    w->moved->tiles++;
    w->moved->tile_bytes += tile->bytes;
    w->moved->messages++;
}

static void handle_message(working *w, const MPI_Status *arrived)
{
    struct {
        wire_head head;
        int32_t tiles[HANDOUT_MOST];
    } message;
    int bytes = 0;
    MPI_Get_count(arrived, MPI_BYTE, &bytes);
    MPI_Recv(&message, sizeof message, MPI_BYTE, 0, arrived->MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    if (message.head.frame != w->frame)
        return;
    const int count = (int)(((size_t)bytes - sizeof message.head) / sizeof message.tiles[0]);
    if (arrived->MPI_TAG == TAG_TILES)
        w->tile_renderer->assign(w->tile_renderer->of, message.tiles, count);
    if (arrived->MPI_TAG == TAG_END)
        w->tile_renderer->end(w->tile_renderer->of);
    if (arrived->MPI_TAG == TAG_STOP) {
        w->tile_renderer->stop(w->tile_renderer->of);
        w->cancelled = true;
    }
}

static bool work_once(working *w)
{
    bool any = false;
    for (tile_message *tile; (tile = w->tile_renderer->pop(w->tile_renderer->of)); any = true)
        if (w->cancelled)
            free(tile);
        else
            send_tile(w, tile);
    MPI_Status arrived;
    int there = 0;
    MPI_Iprobe(0, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &arrived);
    if (there)
        handle_message(w, &arrived);
    finish_sending(w, SENDING_MOST);
    return any || there;
}

void messenger_work(int64_t frame, const tracing *tile_renderer, traffic *moved)
{
    working w = {.frame = frame, .tile_renderer = tile_renderer, .moved = moved};
    const ready_note ready = {.head.frame = frame, .threads = tile_renderer->threads};
    MPI_Send(&ready, sizeof ready, MPI_BYTE, 0, TAG_READY, MPI_COMM_WORLD);
    for (int idle = 0; !tile_renderer->is_done(tile_renderer->of);)
        if (work_once(&w))
            idle = 0;
        else
            tile_renderer->wait(tile_renderer->of, idle++);
    finish_sending(&w, 0);
}
