/* Decides how many tiles a rank may hold, and records which. */
#include "mpi/messenger.h"

#include <math.h>
#include <stdlib.h>

enum { HOLDER_NONE = -1, HOLDER_RETURNED = -2 };

typedef struct rank_state {
    int threads; /* 0: the rank has not joined */
    int64_t held, returned;
    double joined_s, last_s; /* when it joined, and when it last returned a tile */
} rank_state;

struct handout {
    int64_t tiles, next, returned;
    int ranks, threads; /* threads of all ranks that have joined */
    int32_t *holder;    /* by tile: a rank, or HOLDER_* */
    rank_state *rank;
};

status handout_create(int64_t tiles, int ranks, handout **out, diagnostic *why)
{
    handout *h = calloc(1, sizeof *h);
    if (h) {
        h->tiles = tiles;
        h->ranks = ranks;
        h->holder = malloc((size_t)tiles * sizeof *h->holder);
        h->rank = calloc((size_t)ranks, sizeof *h->rank);
    }
    if (!h || !h->holder || !h->rank) {
        handout_destroy(h);
        return out_of_memory(why);
    }
    for (int64_t i = 0; i < tiles; i++)
        h->holder[i] = HOLDER_NONE;
    *out = h;
    return STATUS_OK;
}

void handout_destroy(handout *h)
{
    if (!h)
        return;
    free(h->holder);
    free(h->rank);
    free(h);
}

void handout_join(handout *h, int rank, int threads, double now_s)
{
    h->rank[rank] = (rank_state){.threads = threads, .joined_s = now_s, .last_s = now_s};
    h->threads += threads;
}

/* Seconds that a thread of the rank needs for a tile; 0 while it is unknown. */
static double tile_s(const rank_state *r)
{
    return r->returned > 0 ? (r->last_s - r->joined_s) * r->threads / (double)r->returned : 0.0;
}

/* The number of tiles that the rank should hold. */
static int64_t limit_of(const handout *h, const rank_state *r)
{
    const double each_s = tile_s(r);
    const bool slow = each_s > HANDOUT_AHEAD_S, last = h->tiles - h->next < 2 * (int64_t)h->threads;
    if (slow && last)
        return r->threads;
    const double wanted = each_s > 0.0 ? ceil(r->threads * HANDOUT_AHEAD_S / each_s) : (double)r->threads;
    const double fair = (double)(h->tiles - h->next) / (2.0 * h->ranks); /* leave tiles for the others */
    return r->threads + (int64_t)fmax(1.0, fmin(wanted, fair));
}

int handout_assign(handout *h, int rank, int32_t *tiles)
{
    rank_state *r = &h->rank[rank];
    if (r->threads == 0)
        return 0;
    const int64_t limit = limit_of(h, r), ahead = limit - r->threads;
    if (r->held > r->threads + ahead / 2) /* wait, so that one message assigns several tiles */
        return 0;
    int count = 0;
    while (r->held < limit && h->next < h->tiles && count < HANDOUT_MOST) {
        h->holder[h->next] = rank;
        tiles[count++] = (int32_t)h->next++;
        r->held++;
    }
    return count;
}

bool handout_return(handout *h, int rank, int64_t tile, double now_s)
{
    rank_state *r = &h->rank[rank];
    if (tile < 0 || tile >= h->tiles || h->holder[tile] != rank)
        return false;
    h->holder[tile] = HOLDER_RETURNED;
    h->returned++;
    r->held--;
    r->returned++;
    r->last_s = now_s;
    return true;
}

bool handout_is_empty(const handout *h)
{
    return h->next == h->tiles;
}

bool handout_is_complete(const handout *h)
{
    return h->returned == h->tiles;
}

double handout_fraction(const handout *h)
{
    return (double)h->returned / (double)h->tiles;
}

int64_t handout_held(const handout *h, int rank)
{
    return h->rank[rank].held;
}
