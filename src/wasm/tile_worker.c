/* A tile worker: renders the tiles of orders, in the last scene that it received. */
#include "job/job.h"
#include "measure/clock.h"
#include "render/frame/renderer.h"
#include "scene/model/scene.h"
#include "scene/package/package.h"
#include "wasm/exports.h"
#include "wasm/worker.h"
#include "web/live/passes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static job *tile_job;
static scene *tile_scene;
static diagnostic no_scene; /* why there is no scene */

/* The answer that is being filled. */
typedef struct answering {
    schedule tiles;
    int64_t next, end;
    double began_s;
    char *bytes; /* a tile_answer, then its tiles */
    size_t size, room;
    bool failed;
} answering;

static answering now;

static tile_answer *head(void)
{
    return (tile_answer *)(void *)now.bytes;
}

static bool reserve(size_t size)
{
    if (now.size + size <= now.room)
        return true;
    const size_t room = 2 * now.room > now.size + size ? 2 * now.room : now.size + size;
    char *grown = realloc(now.bytes, room);
    if (!grown)
        return false;
    now.bytes = grown;
    now.room = room;
    return true;
}

int wasm_tiles_scene(const void *bytes, size_t size)
{
    no_scene = (diagnostic){.line = 0};
    scene_destroy(tile_scene);
    tile_scene = NULL;
    status code = tile_job ? STATUS_OK : job_create(&(job_settings){.level = NULL}, &tile_job, &no_scene);
    THEN(code, scene_unpack(bytes, size, &tile_scene, &no_scene));
    return trouble_note(code, &no_scene);
}

static bool next(void *context, int worker, image_tile *out)
{
    (void)context, (void)worker;
    if (isnan(head()->setup_s))
        head()->setup_s = clock_wall_s() - now.began_s;
    return now.next < now.end && !now.failed && schedule_tile(&now.tiles, now.next++, out);
}

static void done(void *context, const image_tile *rect, const film *rendered, const double *variance)
{
    (void)context;
    const int64_t tile = rect->y0 / now.tiles.tile * now.tiles.tiles_across + rect->x0 / now.tiles.tile;
    const size_t values = 3 * (size_t)(rect->x1 - rect->x0) * (size_t)(rect->y1 - rect->y0) * sizeof(int64_t);
    if (!reserve(sizeof tile + 2 * values)) {
        now.failed = true;
        return;
    }
    memcpy(now.bytes + now.size, &tile, sizeof tile);
    memcpy(now.bytes + now.size + sizeof tile, rendered->sum, values);
    now.size += sizeof tile + values;
    if (variance) {
        memcpy(now.bytes + now.size, variance, values);
        now.size += values;
    }
    head()->traced++;
}

static status render_tiles(const tile_order *order, diagnostic *why)
{
    if (!tile_scene) {
        *why = no_scene;
        return STATUS_FAILURE;
    }
    scene view = *tile_scene;
    view.render = passes_settings(&tile_scene->render, order->shrink, order->single);
    view.render.threads = 1;
    const render_settings settings = tiles_settings(&view.render, order->side);
    schedule_start(&now.tiles, &settings);
    const tile_source source = {.side = order->side, .next = next, .done = done};
    const render_options options = {.source = &source};
    job_account account;
    status code = job_render(tile_job, &view, &options, &account, why);
    if (account.result) {
        head()->counters = account.result->counters;
        head()->few = account.result->few;
    }
    job_account_release(&account);
    return now.failed ? out_of_memory(why) : code;
}

const void *wasm_tiles_trace(const void *bytes, size_t size, size_t *answer_size)
{
    static tile_answer no_memory = {.code = STATUS_FAILURE};
    tile_order order;
    memcpy(&order, bytes, size < sizeof order ? size : sizeof order);
    now.size = 0;
    now.failed = false;
    now.next = order.first;
    now.end = order.first + order.count;
    now.began_s = clock_wall_s();
    if (!reserve(sizeof(tile_answer))) {
        no_memory.of = order;
        out_of_memory(&no_memory.why);
        *answer_size = sizeof no_memory;
        return &no_memory;
    }
    now.size = sizeof(tile_answer);
    memset(now.bytes, 0, now.size);
    head()->of = order;
    head()->setup_s = NAN;
    diagnostic why = {.line = 0};
    const status code = render_tiles(&order, &why); /* may move now.bytes */
    head()->code = (int32_t)code;
    head()->why = why;
    head()->wall_s = clock_wall_s() - now.began_s;
    *answer_size = now.size;
    return now.bytes;
}
