/* Assignment of tiles to workers. */
#include "render/plan/schedule.h"

static void cut_into_tiles(schedule *s, int tile)
{
    s->tile = tile;
    s->tiles_across = (s->width + tile - 1) / tile;
    s->tile_count = s->tiles_across * ((s->height + tile - 1) / tile);
}

/* Halves the tiles until each worker can have the requested number of tiles, or a tile is a pixel. */
static void set_tiles(schedule *s, const render_settings *settings)
{
    const int64_t least = settings->tiles_per_worker * settings->threads;
    cut_into_tiles(s, (int)settings->tile);
    while (s->tile_count < least && s->tile > 1)
        cut_into_tiles(s, s->tile / 2);
}

void schedule_start(schedule *s, const render_settings *settings)
{
    s->rule = (schedule_rule)settings->schedule;
    s->width = (int)settings->width;
    s->height = (int)settings->height;
    s->workers = (int)settings->threads;
    set_tiles(s, settings);
    atomic_store(&s->next, s->workers); /* the first tile of each worker is reserved */
}

static int clamp(int64_t v, int most)
{
    return v < most ? (int)v : most;
}

/* The worker's block of `length` units, ceil(length / workers) each, as in the published rod report. */
static bool block(int length, int workers, int worker, int *from, int *to)
{
    int64_t each = (length + workers - 1) / workers;
    *from = clamp(each * worker, length);
    *to = clamp(each * (worker + 1), length);
    return *from < *to;
}

bool schedule_tile(const schedule *s, int64_t index, image_tile *out)
{
    if (index >= s->tile_count)
        return false;
    int64_t x = index % s->tiles_across * s->tile, y = index / s->tiles_across * s->tile;
    *out = (image_tile){(int)x, (int)y, clamp(x + s->tile, s->width), clamp(y + s->tile, s->height)};
    return true;
}

/* The worker's reserved tile, then the next unassigned one. */
static bool tile_on_demand(schedule *s, int worker, uint64_t taken, image_tile *out)
{
    return schedule_tile(s, taken == 0 ? worker : atomic_fetch_add_explicit(&s->next, 1, memory_order_relaxed), out);
}

bool schedule_next(schedule *s, int worker, uint64_t taken, image_tile *out)
{
    *out = (image_tile){0, 0, s->width, s->height};
    switch (s->rule) {
    case SCHEDULE_COLUMNS: return taken == 0 && block(s->width, s->workers, worker, &out->x0, &out->x1);
    case SCHEDULE_ROWS: return taken == 0 && block(s->height, s->workers, worker, &out->y0, &out->y1);
    case SCHEDULE_TILES: return schedule_tile(s, worker + (int64_t)taken * s->workers, out);
    case SCHEDULE_DYNAMIC: return tile_on_demand(s, worker, taken, out);
    }
    return false;
}
