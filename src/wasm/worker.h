/* Functions between the files of a module's workers. wasm/exports.h has the functions that scripts call. */
#pragma once

#include "base/counters.h"
#include "base/status.h"
#include "render/plan/schedule.h"
#include "scene/model/render_settings.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* --- the last error of a call from a script --- */

/* Stores the error's text, if there is an error, for wasm_why. Returns the status as a number. */
int trouble_note(status code, const diagnostic *why);

/* --- requests of the page to a laboratory in a browser, as messages --- */

/* Routes and handlers are those of the server (web/http/http.h), without the checks that protect a server from
 * strangers. There is one thread: a request whose handler must wait for an image is kept and handled again later. */

/* Handles each waiting request again, once. */
void requests_retry(void);

/* --- the render worker of a laboratory in a browser, without a thread --- */

/* The render worker (web/live/render_worker.h) works in turns between messages. It renders the coarse pass and the
 * moving slime; the tiles of finer passes go to tile workers, if there are any, so that the page's requests do not wait
 * for a frame. A pass with render.error needs the noise of the whole image: the render worker renders it in one turn,
 * and requests wait for it. */

/* Sets the number of tile workers; call it once, before the laboratory starts. */
void render_turns_set_workers(int workers);
/* The work of wasm_lab_turn; returns the same. */
double render_turns_run(void);
/* Merges the answer of a tile worker. */
void render_turns_traced(int worker, const void *bytes, size_t size);
/* A tile worker could not start, or failed. */
void render_turns_lost(int worker);

/* --- orders to tile workers and their answers --- */

/* All workers run the same module, so structures are sent as bytes. Films merge exactly, whichever worker renders a
 * tile. */

typedef struct tile_order {
    int64_t frame;          /* number of the pass; answers for earlier passes are dropped */
    int32_t shrink, single; /* settings of the pass (web/live/passes.h) */
    int32_t side;           /* side of the tiles */
    int32_t first, count;   /* tiles first .. first + count - 1 */
} tile_order;

/* The rendered tiles follow this structure. Each is its number as int64_t, its sums and, with replicates, its
 * variances, 3 values per pixel. */
typedef struct tile_answer {
    tile_order of;
    int32_t code, traced;   /* a status; the number of tiles that follow */
    double setup_s, wall_s; /* time until the first tile began; total time */
    ray_counters counters;
    photon_shortage few;
    diagnostic why;
} tile_answer;
