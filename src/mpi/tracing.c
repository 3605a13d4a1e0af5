/* Queues between the messenger and the rendering threads of a rank. */
#include "mpi/tracing.h"
#include "base/array.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct tile_queues {
    pthread_mutex_t lock;
    pthread_cond_t has_tile, has_result;
    schedule tiles;
    int32_t *queue; /* waiting tiles: queue[first .. count - 1] */
    size_t first, count, capacity;
    tile_message *oldest, **newest;
    bool ended, renderer_ended;
    cancel_token token;
    atomic_bool failed; /* out of memory: the frame cannot be completed */
    tracing messenger_interface;
    tile_source renderer_interface;
};

/* --- the messenger's side --- */

static void assign(void *of, const int32_t *tiles, int count)
{
    tile_queues *t = of;
    pthread_mutex_lock(&t->lock);
    if (t->first > 0 && t->first == t->count)
        t->first = t->count = 0;
    if (GROW(t->queue, t->capacity, t->count + (size_t)count)) {
        memcpy(t->queue + t->count, tiles, (size_t)count * sizeof *tiles);
        t->count += (size_t)count;
    } else {
        cancel_set(&t->token);
        atomic_store(&t->failed, true);
    }
    pthread_cond_broadcast(&t->has_tile);
    pthread_mutex_unlock(&t->lock);
}

static tile_message *pop(void *of)
{
    tile_queues *t = of;
    pthread_mutex_lock(&t->lock);
    tile_message *tile = t->oldest;
    if (tile && !(t->oldest = tile->next))
        t->newest = &t->oldest;
    pthread_mutex_unlock(&t->lock);
    return tile;
}

static void end(void *of)
{
    tile_queues *t = of;
    pthread_mutex_lock(&t->lock);
    t->ended = true;
    pthread_cond_broadcast(&t->has_tile);
    pthread_mutex_unlock(&t->lock);
}

static void stop(void *of)
{
    tile_queues *t = of;
    pthread_mutex_lock(&t->lock);
    cancel_set(&t->token);
    pthread_cond_broadcast(&t->has_tile);
    pthread_mutex_unlock(&t->lock);
}

static bool is_done(void *of)
{
    tile_queues *t = of;
    pthread_mutex_lock(&t->lock);
    const bool is_over = t->renderer_ended && !t->oldest;
    pthread_mutex_unlock(&t->lock);
    return is_over;
}

/* MPI has to be polled for messages, which costs the rendering threads time. They have tiles for HANDOUT_AHEAD_S, so
 * that one poll per millisecond is enough; only a rank that waits for tiles polls more often, at first. */
static void wait_for_event(void *of, int idle)
{
    enum { SHORT_NS = 50000, LONG_NS = 1000000, SHORT_TIMES = 40 };
    tile_queues *t = of;
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    pthread_mutex_lock(&t->lock);
    const bool needs_tiles = t->first == t->count && !t->ended && idle < SHORT_TIMES;
    until.tv_nsec += needs_tiles ? SHORT_NS : LONG_NS;
    if (until.tv_nsec >= 1000000000)
        until.tv_nsec -= 1000000000, until.tv_sec++;
    if (!t->oldest)
        pthread_cond_timedwait(&t->has_result, &t->lock, &until);
    pthread_mutex_unlock(&t->lock);
}

/* --- the renderer's side --- */

static bool next(void *context, int worker, image_tile *out)
{
    tile_queues *t = context;
    (void)worker;
    pthread_mutex_lock(&t->lock);
    while (t->first == t->count && !t->ended && !cancel_is_set(&t->token))
        pthread_cond_wait(&t->has_tile, &t->lock);
    const bool any = t->first < t->count && !cancel_is_set(&t->token);
    if (any)
        schedule_tile(&t->tiles, t->queue[t->first++], out);
    pthread_mutex_unlock(&t->lock);
    return any;
}

static int64_t number_of(const schedule *s, const image_tile *tile)
{
    return tile->y0 / s->tile * s->tiles_across + tile->x0 / s->tile;
}

static void done(void *context, const image_tile *tile, const film *rendered, const double *variance)
{
    tile_queues *t = context;
    const size_t values = 3 * (size_t)(tile->x1 - tile->x0) * (size_t)(tile->y1 - tile->y0);
    const size_t bytes = values * sizeof(int64_t) * (variance ? 2 : 1);
    tile_message *message = malloc(sizeof *message + bytes);
    if (!message) {
        atomic_store(&t->failed, true);
        stop(t);
        return;
    }
    message->next = NULL;
    message->bytes = sizeof message->head + bytes;
    message->head = (wire_head){.value = number_of(&t->tiles, tile)};
    memcpy(message->values, rendered->sum, values * sizeof(int64_t));
    if (variance)
        memcpy(message->values + values, variance, values * sizeof *variance);
    pthread_mutex_lock(&t->lock);
    *t->newest = message;
    t->newest = &message->next;
    pthread_cond_signal(&t->has_result);
    pthread_mutex_unlock(&t->lock);
}

/* --- creation and status --- */

status tile_queues_create(const schedule *tiles, int threads, tile_queues **out, diagnostic *why)
{
    tile_queues *t = aligned_alloc(64, (sizeof *t + 63) / 64 * 64); /* a schedule is aligned to cache lines */
    if (!t)
        return out_of_memory(why);
    memset(t, 0, sizeof *t);
    pthread_condattr_t monotonic;
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_mutex_init(&t->lock, NULL);
    pthread_cond_init(&t->has_tile, NULL);
    pthread_cond_init(&t->has_result, &monotonic);
    pthread_condattr_destroy(&monotonic);
    t->tiles = *tiles;
    t->newest = &t->oldest;
    t->messenger_interface = (tracing){threads, t, assign, pop, end, stop, is_done, wait_for_event};
    t->renderer_interface = (tile_source){.side = tiles->tile, .next = next, .done = done, .context = t};
    *out = t;
    return STATUS_OK;
}

void tile_queues_destroy(tile_queues *t)
{
    if (!t)
        return;
    for (tile_message *tile = t->oldest, *following; tile; tile = following) {
        following = tile->next;
        free(tile);
    }
    pthread_cond_destroy(&t->has_result);
    pthread_cond_destroy(&t->has_tile);
    pthread_mutex_destroy(&t->lock);
    free(t->queue);
    free(t);
}

const tracing *tile_queues_tracing(const tile_queues *t)
{
    return &t->messenger_interface;
}

const tile_source *tile_queues_source(const tile_queues *t)
{
    return &t->renderer_interface;
}

void tile_queues_close(tile_queues *t)
{
    pthread_mutex_lock(&t->lock);
    t->renderer_ended = true;
    pthread_cond_signal(&t->has_result);
    pthread_mutex_unlock(&t->lock);
}

cancel_token *tile_queues_token(tile_queues *t)
{
    return &t->token;
}

status tile_queues_status(const tile_queues *t, status rendered, diagnostic *why)
{
    return atomic_load(&t->failed) ? out_of_memory(why) : rendered;
}
