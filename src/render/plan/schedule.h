/* The schedule: which worker renders which tile. columns and rows: one block per worker, as in the published rod
 * report; tiles: square tiles assigned in turn; dynamic: the next tile to the next free worker, except that the first
 * tile of each worker is reserved for it. Otherwise, with a thousand threads on a few processing units, most would
 * start after the last tile was assigned, and a few would render the frame. Ownership: a plain value; next is the only
 * field that workers modify. Errors: none. */
#pragma once

#include "scene/model/render_settings.h"
#include <stdatomic.h>
#include <stdint.h>

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

/* Plain values that a frame reports: its meshes, and a caustic with too few photons. */

/* The mesh statistics of a frame: sizes of meshes, and time and memory of their hierarchies. A hierarchy is counted
 * once per mesh, whatever the number of instances. */
typedef struct mesh_report {
    uint64_t triangles, instances; /* instances: copies of meshes; triangles: in all instances */
    uint64_t bytes;                /* of hierarchies */
    double build_s;                /* wall time of building them, for this frame or earlier */
    uint64_t motion_steps;         /* simulation steps of slimes up to the rendered times, including substeps */
    double motion_s;               /* wall time of these steps, when the scene was loaded */
    /* only in a rasterised frame: triangles in the image, including those of analytic solids, and memory of the depth
     * buffer */
    uint64_t drawn, raster_bytes;
} mesh_report;

/* The solid with the fewest photons, if they are too few for its caustic. */
typedef struct photon_shortage {
    int solid;       /* its number in the scene; -1: every solid has enough */
    int64_t arrived; /* photons that it deflected to matte surfaces */
    int64_t enough;  /* the value of render.photons that suffices */
} photon_shortage;
