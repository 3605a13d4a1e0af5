/* What a frame leaves on disk beside its numbers: the picture, maps of a quantity by pixel, the timeline. Every file
 * appears whole or not at all; results are borrowed. */
#pragma once

#include "render/core/renderer.h"

/* The film as a picture, by the ending of path; bits as image_write takes them. */
status record_image(const film *f, const char *path, int bits, diagnostic *why);

/* values, one a pixel of f: in false colours with a key and a title; or, in a file that ends in .pfm, the numbers
 * themselves (the same in all three channels). */
status record_map(const double *values, const film *f, const char *title, const char *path, diagnostic *why);

/* Of a result with named layers: the path of one, PREFIX-WORD.pfm, fresh memory, NULL when that is out; and all of them
 * written there, one number in all three channels. */
char *record_layer_path(const char *prefix, int layer);
status record_layers(const render_result *result, const char *prefix, diagnostic *why);

/* The timeline in Chrome's trace event format (Google 2016): one row a worker, one bar a tile, microseconds from the
 * frame's start. Opens in chrome://tracing and in Perfetto. Needs a result with events. */
/* The standard error of each pixel, root of the mean over its channels; result has a variance. */
status record_noise(const render_result *result, const char *path, diagnostic *why);

status record_timeline(const render_result *result, const char *path, diagnostic *why);
