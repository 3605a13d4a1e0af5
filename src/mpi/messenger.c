/* The loops of rank 0 and of the other ranks during a frame. */
#include "base/cancel.h"
#include "mpi/messenger.h"

#include <mpi.h>
#include <stdlib.h>

/* Memory for a message; without it the frame cannot be completed. */
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
    const tracing *own;
    const frame_sink *sink;
    traffic *moved;
    bool *ended; /* by rank: it was told that no tile is left */
    bool all_told, given_up;
} serving;

static void tell(serving *s, int rank, int tag)
{
    const wire_head head = {.frame = s->frame};
    MPI_Send(&head, sizeof head, MPI_BYTE, rank, tag, MPI_COMM_WORLD);
    s->moved->messages++;
}

static void give_up(serving *s)
{
    if (s->given_up)
        return;
    s->given_up = true;
    s->own->stop(s->own->of);
    for (int rank = 1; rank < s->ranks; rank++)
        tell(s, rank, TAG_STOP);
}

/* Sends the rank the tiles that it should hold, and once the message that none is left. */
static void give(serving *s, int rank)
{
    struct {
        wire_head head;
        int32_t tiles[HANDOUT_MOST];
    } message = {.head.frame = s->frame};
    if (s->given_up)
        return;
    const int count = handout_assign(s->tiles, rank, message.tiles);
    if (count > 0 && rank == 0)
        s->own->give(s->own->of, message.tiles, count);
    if (count > 0 && rank != 0) {
        const size_t bytes = sizeof message.head + (size_t)count * sizeof message.tiles[0];
        MPI_Send(&message, (int)bytes, MPI_BYTE, rank, TAG_TILES, MPI_COMM_WORLD);
        s->moved->messages++;
    }
    if (handout_is_empty(s->tiles) && !s->ended[rank]) {
        s->ended[rank] = true;
        if (rank == 0)
            s->own->end(s->own->of);
        else
            tell(s, rank, TAG_END);
    }
}

/* The end goes to every rank that waits, not only to the one that took the last tile. */
static void tell_end(serving *s)
{
    if (s->all_told || !handout_is_empty(s->tiles))
        return;
    s->all_told = true;
    for (int rank = 0; rank < s->ranks; rank++)
        give(s, rank);
}

static void take_tile(serving *s, int rank, tile_message *tile)
{
    if (!handout_return(s->tiles, rank, tile->head.value, MPI_Wtime()))
        MPI_Abort(MPI_COMM_WORLD, STATUS_FAILURE);
    s->moved->tiles += rank != 0;
    s->moved->tile_bytes += rank != 0 ? tile->bytes : 0;
    s->sink->tile(s->sink->of, tile);
    give(s, rank);
}

static void take_report(serving *s, int rank, const void *bytes)
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
        take_tile(s, arrived->MPI_SOURCE, tile);
        return;
    }
    if (tile->head.frame == s->frame && arrived->MPI_TAG == TAG_READY) {
        handout_join(s->tiles, arrived->MPI_SOURCE, (int)((const ready_note *)(const void *)&tile->head)->threads,
                     MPI_Wtime());
        give(s, arrived->MPI_SOURCE);
    } else if (tile->head.frame == s->frame && arrived->MPI_TAG == TAG_REPORT) {
        take_report(s, arrived->MPI_SOURCE, &tile->head);
    }
    free(tile);
}

/* Takes everything that has arrived or is finished; false if there was nothing. */
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
    for (tile_message *tile; (tile = s->own->take(s->own->of)); any = true)
        take_tile(s, 0, tile);
    return any;
}

static bool is_complete(const serving *s)
{
    return s->reports == s->ranks - 1 && s->own->over(s->own->of) && (s->given_up || handout_is_complete(s->tiles));
}

void messenger_serve(int64_t frame, int ranks, handout *tiles, const tracing *own, const frame_sink *sink,
                     traffic *moved)
{
    serving s = {.frame = frame, .ranks = ranks, .tiles = tiles, .own = own, .sink = sink, .moved = moved};
    s.ended = message_memory((size_t)ranks * sizeof *s.ended);
    for (int rank = 0; rank < ranks; rank++)
        s.ended[rank] = false;
    if (own->threads > 0) {
        handout_join(tiles, 0, own->threads, MPI_Wtime());
        give(&s, 0);
    }
    while (!is_complete(&s)) {
        if (serve_once(&s)) {
            s.idle = 0;
            tell_end(&s);
        } else {
            own->wait(own->of, s.idle++);
        }
        sink->progress(sink->of, handout_fraction(tiles));
        if (cancel_asked())
            give_up(&s);
    }
    free(s.ended);
}

/* --- the other ranks --- */

/* Tiles on their way, a ring. */
enum { SENDING_MOST = 64 };

typedef struct working {
    int64_t frame;
    const tracing *own;
    traffic *moved;
    tile_message *sending[SENDING_MOST];
    MPI_Request request[SENDING_MOST];
    int oldest, count;
    bool given_up;
} working;

/* Releases the oldest tiles that have left; waits until at most `most` are on their way. */
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

static void obey(working *w, const MPI_Status *arrived)
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
        w->own->give(w->own->of, message.tiles, count);
    if (arrived->MPI_TAG == TAG_END)
        w->own->end(w->own->of);
    if (arrived->MPI_TAG == TAG_STOP) {
        w->own->stop(w->own->of);
        w->given_up = true;
    }
}

static bool work_once(working *w)
{
    bool any = false;
    for (tile_message *tile; (tile = w->own->take(w->own->of)); any = true)
        if (w->given_up)
            free(tile);
        else
            send_tile(w, tile);
    MPI_Status arrived;
    int there = 0;
    MPI_Iprobe(0, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &arrived);
    if (there)
        obey(w, &arrived);
    finish_sending(w, SENDING_MOST);
    return any || there;
}

void messenger_work(int64_t frame, const tracing *own, traffic *moved)
{
    working w = {.frame = frame, .own = own, .moved = moved};
    const ready_note ready = {.head.frame = frame, .threads = own->threads};
    MPI_Send(&ready, sizeof ready, MPI_BYTE, 0, TAG_READY, MPI_COMM_WORLD);
    for (int idle = 0; !own->over(own->of);)
        if (work_once(&w))
            idle = 0;
        else
            own->wait(own->of, idle++);
    finish_sending(&w, 0);
}
