/* The render worker of a laboratory in a browser, without a thread: its work is done in turns between messages.
 * The coarse pass and the moving slime are rendered here; the tiles of the finer passes go to tile workers
 * (wasm/tiles.h), if there are any, so that the page's requests do not wait for a frame; but one with
 * render.error, which needs the noise of the whole image, is rendered here and lets nothing through. See
 * web/live/render_worker.h for what it does, and wasm/exports.h for wasm_lab_turn and wasm_lab_traced. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* The number of tile workers; once, before the laboratory starts. */
void render_turns_set_workers(int workers);
/* Returns as wasm_lab_turn. */
double render_turns_take(void);
/* Takes a tile worker's answer. */
void render_turns_traced(int worker, const void *bytes, size_t size);
/* A tile worker cannot start. */
void render_turns_lost(int worker);
