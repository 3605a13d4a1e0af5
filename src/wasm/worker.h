/* What the files of a module's workers share. wasm/exports.h has what scripts call. */
#pragma once

#include "base/counters.h"
#include "base/status.h"
#include "scene/model/render_settings.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* --- the last error of a call from a script: its text, until the next one (wasm_why) --- */

/* Keeps the error's text, if there is one. Returns the status as a number. */
int trouble_note(status code, const diagnostic *why);

/* --- requests of the page to a laboratory in a browser, as messages --- */

/* The routes and handlers are those of the server (web/http/http.h), without its checks, which protect a server from
 * strangers. One thread: a request whose handler had to wait for an image is kept and handled again later. */

/* Handles the waiting requests again, each at most once. Something that they may wait for has happened. */
void requests_retry(void);

/* --- the render worker of a laboratory in a browser, without a thread --- */

/* Its work is done in turns between messages. The coarse pass and the moving slime are rendered here; the tiles of the
 * finer passes go to tile workers, if there are any, so that the page's requests do not wait for a frame; but one with
 * render.error, which needs the noise of the whole image, is rendered here and lets nothing through. See
 * web/live/render_worker.h for what it does, and wasm/exports.h for wasm_lab_turn and wasm_lab_traced. */

/* The number of tile workers; once, before the laboratory starts. */
void render_turns_set_workers(int workers);
/* Returns as wasm_lab_turn. */
double render_turns_take(void);
/* Takes a tile worker's answer. */
void render_turns_traced(int worker, const void *bytes, size_t size);
/* A tile worker cannot start. */
void render_turns_lost(int worker);

/* --- orders to tile workers and their answers --- */

/* The parts of a pass that a laboratory has traced elsewhere. All workers run the same module, so structures travel as
 * their bytes. The film merges exactly, whoever traced which tile. */

typedef struct tile_order {
    int64_t frame;          /* number of the pass; answers of earlier ones are dropped */
    int32_t shrink, single; /* of the pass (web/live/passes.h) */
    int32_t side;           /* of the tiles */
    int32_t first, count;   /* tiles first .. first + count - 1 */
} tile_order;

/* Then, for each tile: its number as int64_t, sums and, with replicates, variances: 3 values for each pixel of the
 * tile. */
typedef struct tile_answer {
    tile_order of;
    int32_t code, traced;   /* a status; tiles that follow */
    double setup_s, wall_s; /* until the first tile began; all */
    ray_counters counters;
    diagnostic why;
} tile_answer;
