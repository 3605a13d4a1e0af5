/* The files of a frame: the image, maps of a quantity by pixel, the timeline. Every file is written completely or not
 * at all; results are borrowed. */
#pragma once

#include "render/frame/renderer.h"

/* Writes the film as an image in the format of the path's ending; bits: as in image_write. s: the scene, whose tone
 * applies to images with 8 bits, and which is stored in the metadata of PNG and OpenEXR (scene/file/shared.h); NULL:
 * neither. OpenEXR also has channels for all else that the result has, by these names: noise.R .G .B, the standard
 * errors (noise.X .Y .Z of CIE XYZ for a spectral film); normal.X .Y .Z, position.X .Y .Z, albedo.R .G .B, depth.Z,
 * solid.V, material.V; rays.V, time.V (nanoseconds), cut.V; and `more`, which may be NULL. */
typedef struct record_more {
    image_channel channels[IMAGE_CHANNELS_MORE];
    int count;
    const image_text *texts; /* attributes; with the scene's at most IMAGE_TEXTS_MAX */
    int text_count;
} record_more;
status record_image(const render_result *result, const record_more *more, const scene *s, const char *path, int bits,
                    diagnostic *why);
/* record_image for an image of the film on which lines were drawn. */
status record_drawing(const image *img, const scene *s, const char *path, int bits, diagnostic *why);

/* Writes values, one per pixel of f, as a false-colour image with a colour key and a title; or the numbers
 * themselves, if path ends in .pfm (equal in all three channels) or in .exr (as the channel Y). */
status record_map(const double *values, const film *f, const char *title, const char *path, diagnostic *why);

/* record_layer_path returns the path of a named layer, PREFIX-WORD.pfm, in newly allocated memory, NULL when out of
 * memory; record_layers writes all layers to these paths, a layer of one channel into all three. */
char *record_layer_path(const char *prefix, int layer);
status record_layers(const render_result *result, const char *prefix, diagnostic *why);

/* The standard error of each pixel, root mean square over its channels; result must have a variance. record_noise
 * writes it to a file. */
void record_noise_values(const render_result *result, double *values);
status record_noise(const render_result *result, const char *path, diagnostic *why);

/* Writes the timeline in Chrome's trace event format (Google 2016): one row per worker, one bar per tile, in
 * microseconds from the frame's start. Open it in chrome://tracing or Perfetto. result must have events. */
status record_timeline(const render_result *result, const char *path, diagnostic *why);
