/* Access to a frame (pixels, hash, counts, times), and to images of files. */
#include "engine/engine_private.h"
#include "image/compare.h"
#include "render/frame/record.h"

#include <stdlib.h>
#include <string.h>

void cuvette_frame_destroy(cuvette_frame *frame)
{
    if (!frame)
        return;
    job_account_release(&frame->account);
    scene_destroy(frame->scene);
    free(frame);
}

int cuvette_frame_width(const cuvette_frame *frame)
{
    return frame ? frame->account.result->img->width : 0;
}

int cuvette_frame_height(const cuvette_frame *frame)
{
    return frame ? frame->account.result->img->height : 0;
}

uint64_t cuvette_frame_hash(const cuvette_frame *frame)
{
    return frame ? job_account_hash(&frame->account) : 0;
}

/* stride, element_bytes: as for canvas_stride. */
static status check_rectangle(const film *f, int x0, int y0, int x1, int y1, size_t *stride, size_t element_bytes,
                              diagnostic *why)
{
    if (x0 < 0 || y0 < 0 || x1 > f->width || y1 > f->height || x0 >= x1 || y0 >= y1)
        return diagnose(why, STATUS_BAD_INPUT, "keep 0 <= x0 < x1 <= width, and y likewise",
                        "an image of %d x %d has no rectangle from %d,%d to %d,%d", f->width, f->height, x0, y0, x1,
                        y1);
    return canvas_stride(stride, element_bytes, x1 - x0, y1 - y0, why);
}

cuvette_status cuvette_frame_rgb(const cuvette_frame *frame, int x0, int y0, int x1, int y1, float *rgb, size_t stride,
                                 cuvette_diagnostic *why)
{
    ENGINE_CALL(frame, rgb);
    const status code = check_rectangle(frame->account.result->img, x0, y0, x1, y1, &stride, sizeof *rgb, &inner);
    if (code == STATUS_OK)
        film_read(frame->account.result->img, x0, y0, x1, y1, rgb, stride);
    return engine_report(code, &inner, why);
}

cuvette_status cuvette_frame_srgb(const cuvette_frame *frame, int x0, int y0, int x1, int y1, unsigned char *srgb,
                                  size_t stride, cuvette_diagnostic *why)
{
    ENGINE_CALL(frame, srgb);
    const status code = check_rectangle(frame->account.result->img, x0, y0, x1, y1, &stride, sizeof *srgb, &inner);
    if (code == STATUS_OK) {
        codec_bytes bytes;
        codec_bytes_prepare(&bytes);
        canvas_bytes(frame->account.result->img, &bytes, x0, y0, x1, y1, srgb, stride);
    }
    return engine_report(code, &inner, why);
}

cuvette_status cuvette_frame_write(const cuvette_frame *frame, const char *path, int bits, cuvette_diagnostic *why)
{
    ENGINE_CALL(frame, path);
    status code = bits == 8 || bits == 16
                      ? STATUS_OK
                      : diagnose(&inner, STATUS_BAD_INPUT, "use 8 or 16", "unsupported bit depth %d", bits);
    THEN(code, record_image(frame->account.result, NULL, frame->scene, path, bits, &inner));
    return engine_report(code, &inner, why);
}

_Static_assert(sizeof(((cuvette_counters *)0)->by_depth) == sizeof(((ray_counters *)0)->by_depth),
               "the arrays have the same length");

cuvette_status cuvette_frame_counters(const cuvette_frame *frame, cuvette_counters *out, cuvette_diagnostic *why)
{
    ENGINE_CALL(frame, out);
    const ray_counters *c = &frame->account.result->counters;
    cuvette_counters result = {.camera = c->camera,
                               .reflect = c->reflect,
                               .refract = c->refract,
                               .shadow = c->shadow,
                               .photon = c->photon,
                               .total_internal = c->total_internal,
                               .cut_depth = c->cut_depth,
                               .cut_weight = c->cut_weight};
    for (int i = 0; i < 3; i++) {
        result.cut_depth_throughput[i] = (double)c->cut_depth_throughput[i] / COUNTERS_CUT_ONE;
        result.cut_weight_throughput[i] = (double)c->cut_weight_throughput[i] / COUNTERS_CUT_ONE;
    }
    memcpy(result.by_depth, c->by_depth, sizeof result.by_depth);
    return engine_copy_struct(&result, sizeof result, out, why);
}

cuvette_status cuvette_frame_solid_counters(const cuvette_frame *frame, size_t index, cuvette_solid_counters *out,
                                            cuvette_diagnostic *why)
{
    ENGINE_CALL(frame, out);
    if (index >= frame->solid_count)
        return engine_report(diagnose(&inner, STATUS_BAD_INPUT, "count solids from 0",
                                      "solid index %zu is out of range: the scene has %zu solids", index,
                                      frame->solid_count),
                             &inner, why);
    if (index >= COUNTERS_SOLID_MAX)
        return engine_report(diagnose(&inner, STATUS_BAD_INPUT,
                                      "use an index from 0 to 63: later solids are not counted one by one",
                                      "solid %zu has no counters", index),
                             &inner, why);
    const ray_counters *c = &frame->account.result->counters;
    const cuvette_solid_counters result = {
        .tests = c->tests[index], .hits = c->hits[index], .first_hits = c->first_hits[index]};
    return engine_copy_struct(&result, sizeof result, out, why);
}

cuvette_status cuvette_frame_statistics(const cuvette_frame *frame, cuvette_statistics *out, cuvette_diagnostic *why)
{
    ENGINE_CALL(frame, out);
    const render_result *r = frame->account.result;
    const cuvette_statistics result = {.wall_s = r->wall_s,
                                       .cpu_s = r->cpu_s,
                                       .preview_s = frame->preview_s,
                                       .threads = r->worker_count,
                                       .noise_rms = render_noise_rms(r)};
    return engine_copy_struct(&result, sizeof result, out, why);
}

cuvette_status cuvette_frame_layer(const cuvette_frame *frame, const char *name, const float **values, int *channels,
                                   cuvette_diagnostic *why)
{
    ENGINE_CALL(frame, name, values, channels);
    const layer_set *layers = frame->account.result->layers;
    *values = NULL;
    if (!layers)
        return engine_report(diagnose(&inner, STATUS_BAD_INPUT,
                                      "set layers in the request, and render.integrator to aov",
                                      "the frame has no layers"),
                             &inner, why);
    for (int i = 0; i < LAYER_COUNT; i++)
        if (strcmp(layer_words[i], name) == 0) {
            *values = layers->values[i];
            *channels = layer_channels[i];
            return CUVETTE_OK;
        }
    return engine_report(diagnose(&inner, STATUS_BAD_INPUT, "use normal, albedo, depth, solid, material or position",
                                  "there is no layer '%.64s'", name),
                         &inner, why);
}

cuvette_status cuvette_frame_map(const cuvette_frame *frame, const char *name, double *values, cuvette_diagnostic *why)
{
    ENGINE_CALL(frame, name, values);
    const render_result *r = frame->account.result;
    const size_t pixels = (size_t)r->img->width * (size_t)r->img->height;
    const bool rays = strcmp(name, "rays") == 0, ns = strcmp(name, "time") == 0, cut = strcmp(name, "cut") == 0,
               noise = strcmp(name, "noise") == 0;
    const double *found = rays ? r->pixel_rays : ns ? r->pixel_ns : cut ? r->pixel_cut : noise ? r->variance : NULL;
    if (!rays && !ns && !cut && !noise)
        diagnose(&inner, STATUS_BAD_INPUT, "use rays, time, cut or noise", "there is no map '%.64s'", name);
    else if (!found)
        diagnose(&inner, STATUS_BAD_INPUT,
                 noise ? "set render.integrator to path and render.paths to a multiple of 16 * render.samples"
                       : "set pixel_rays, pixel_time or pixel_cut in the request",
                 "the frame has no map '%s'", name);
    if (!found)
        return engine_report(STATUS_BAD_INPUT, &inner, why);
    if (noise)
        record_noise_values(r, values);
    else
        memcpy(values, found, pixels * sizeof *values);
    return CUVETTE_OK;
}

/* --- images of files, and the difference of two images --- */

struct cuvette_image {
    image *held;
};

cuvette_status cuvette_image_read(const char *path, cuvette_image **out, cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    ENGINE_NEED(path);
    int bits;
    cuvette_image *made = calloc(1, sizeof *made);
    const status code = made ? image_read(path, &made->held, &bits, &inner) : out_of_memory(&inner);
    if (code == STATUS_OK)
        *out = made;
    else
        free(made);
    return engine_report(code, &inner, why);
}

void cuvette_image_destroy(cuvette_image *img)
{
    if (!img)
        return;
    image_destroy(img->held);
    free(img);
}

const float *cuvette_image_rgb(const cuvette_image *img, int *width, int *height)
{
    if (width)
        *width = img ? img->held->width : 0;
    if (height)
        *height = img ? img->held->height : 0;
    return img ? img->held->pixel : NULL;
}

static status check_size(int width, int height, diagnostic *why)
{
    if (width >= 1 && height >= 1 && width <= IMAGE_SIDE_MAX && height <= IMAGE_SIDE_MAX)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "use sides from 1 to 65536", "images cannot be %d x %d", width, height);
}

cuvette_status cuvette_compare(int width, int height, const float *a, const float *b, float *map,
                               cuvette_comparison *out, cuvette_diagnostic *why)
{
    ENGINE_CALL(a, b, out);
    /* The comparison only reads its images, so that const can be cast away. */
    const image one = {.width = width, .height = height, .pixel = (float *)(uintptr_t)a, .owners = 1};
    const image other = {.width = width, .height = height, .pixel = (float *)(uintptr_t)b, .owners = 1};
    image_comparison found;
    image *drawn = NULL;
    status code = check_size(width, height, &inner);
    THEN(code, image_compare(&one, &other, &found, &inner));
    if (code == STATUS_OK && map)
        code = image_compare_map(&one, &other, &drawn, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    if (map)
        memcpy(map, drawn->pixel, 3 * (size_t)width * (size_t)height * sizeof *map);
    image_destroy(drawn);
    const cuvette_comparison result = {.mse = found.mse,
                                       .psnr_db = found.psnr_db,
                                       .ssim = found.ssim,
                                       .flip = found.flip,
                                       .largest = found.largest,
                                       .differing_fraction = found.differing_fraction,
                                       .largest_x = found.largest_x,
                                       .largest_y = found.largest_y};
    return engine_copy_struct(&result, sizeof result, out, why);
}
