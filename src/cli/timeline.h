/* The timeline of a frame in Chrome's trace event format: one row a worker, one bar a tile, microseconds from the
 * frame's start. Opens in chrome://tracing and in Perfetto (Trace Event Format, Google 2016). */
#ifndef CUVETTE_CLI_TIMELINE_H
#define CUVETTE_CLI_TIMELINE_H

#include "render/renderer.h"

/* Needs a result with events. The file appears whole or not at all. */
status timeline_write(const render_result *result, const char *path, diagnostic *why);

#endif
