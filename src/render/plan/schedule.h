/* The schedule: which worker renders which tile. columns and rows: one block per worker, as in the published rod
 * report; tiles: square tiles assigned in turn; dynamic: the next tile to the next free worker, except that the first
 * tile of each worker is reserved for it. Otherwise, with a thousand threads on a few processing units, most would
 * start after the last tile was assigned, and a few would render the frame. Ownership: a plain value; next is the only
 * field that workers modify. Errors: none. */
#pragma once

#include "scene/model/render_settings.h"
#include <stdatomic.h>

typedef struct image_tile {
    int x0, y0, x1, y1;
} image_tile; /* x0 <= x < x1 */

typedef struct schedule {
    schedule_rule rule;
    int width, height, tile, workers;
    int64_t tiles_across, tile_count;
    _Alignas(64) atomic_int_fast64_t next;
} schedule;

void schedule_start(schedule *s, const render_settings *settings);

/* Tile number index, row by row from the top; false when there are fewer. */
bool schedule_tile(const schedule *s, int64_t index, image_tile *out);

/* The next tile for a worker that has had `taken` tiles; false when there is none left. */
bool schedule_next(schedule *s, int worker, uint64_t taken, image_tile *out);
