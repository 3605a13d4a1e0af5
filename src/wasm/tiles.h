/* Orders to tile workers and their answers: the parts of a pass that a laboratory has traced elsewhere. All workers run
 * the same module, so structures travel as their bytes. The film merges exactly, whoever traced which tile. */
#pragma once

#include "base/counters.h"
#include "base/status.h"
#include "scene/model/render_settings.h"
#include <stdint.h>

typedef struct tile_order {
    int64_t frame;          /* number of the pass; answers of earlier ones are dropped */
    int32_t shrink, single; /* of the pass (web/live/passes.h) */
    int32_t side;           /* of the tiles */
    int32_t first, count;   /* tiles first .. first + count - 1 */
} tile_order;

/* Then, for each tile: its number as int64_t, sums and, with shares, variances: 3 values for each pixel of the tile. */
typedef struct tile_answer {
    tile_order of;
    int32_t code, traced;   /* a status; tiles that follow */
    double setup_s, wall_s; /* until the first tile began; all */
    ray_counters counters;
    diagnostic why;
} tile_answer;
