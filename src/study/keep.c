#include "study/keep.h"
#include "base/file.h"
#include "base/text.h"
#include "image/heatmap.h"
#include "image/image.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef enum kept {
    KEPT_PNG,
    KEPT_PFM,
    KEPT_RAYS_PNG,
    KEPT_RAYS_PFM,
    KEPT_NS_PNG,
    KEPT_NS_PFM,
    KEPT_TIMELINE,
    KEPT_COUNT
} kept;

static bool wanted(const study *s, kept what)
{
    switch (what) {
    case KEPT_PNG: return s->keep_image;
    case KEPT_PFM: return s->keep_pfm;
    case KEPT_RAYS_PNG:
    case KEPT_RAYS_PFM: return s->keep_pixel_rays;
    case KEPT_NS_PNG:
    case KEPT_NS_PFM: return s->keep_pixel_time;
    case KEPT_TIMELINE: return s->keep_timeline;
    case KEPT_COUNT: break;
    }
    return false;
}

static char *kept_path(const char *folder, size_t cell, kept what)
{
    static const char *const endings[KEPT_COUNT] = {".png",    ".pfm",    "-rays.png",     "-rays.pfm",
                                                    "-ns.png", "-ns.pfm", "-timeline.json"};
    return text_format("%s/images/%04zu%s", folder, cell, endings[what]);
}

bool keep_missing(const study *s, const char *folder, size_t cell)
{
    for (kept what = 0; what < KEPT_COUNT; what++) {
        char *path = wanted(s, what) ? kept_path(folder, cell, what) : NULL;
        bool missing = path && access(path, F_OK) != 0;
        free(path);
        if (missing)
            return true;
    }
    return false;
}

render_options keep_options(const study *s)
{
    return (render_options){
        .pixel_rays = s->keep_pixel_rays, .pixel_time = s->keep_pixel_time, .timeline = s->keep_timeline};
}

static status write_film(const render_result *frame, const char *path, diagnostic *why)
{
    image *picture;
    status code = film_image(frame->picture, &picture, why);
    if (code != STATUS_OK)
        return code;
    code = image_write(picture, path, 8, why);
    image_destroy(picture);
    return code;
}

/* The values themselves, the same in all three channels. */
static status write_values(const double *values, int width, int height, const char *path, diagnostic *why)
{
    image *picture;
    status code = image_create(width, height, &picture, why);
    if (code != STATUS_OK)
        return code;
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
        for (size_t channel = 0; channel < 3; channel++)
            picture->pixel[3 * i + channel] = (float)values[i];
    code = image_write(picture, path, 8, why);
    image_destroy(picture);
    return code;
}

static status write_heatmap(const double *values, int width, int height, const char *title, const char *path,
                            diagnostic *why)
{
    image *picture;
    status code = heatmap_create(values, width, height, title, &picture, why);
    if (code != STATUS_OK)
        return code;
    code = image_write(picture, path, 8, why);
    image_destroy(picture);
    return code;
}

/* Chrome's trace event format: one complete event ("X") a tile, microseconds, a worker a thread. */
static status write_timeline(const render_result *frame, const char *path, diagnostic *why)
{
    file_writer writer;
    status code = file_writer_open(&writer, path, why);
    if (code != STATUS_OK)
        return code;
    fputs("{\"displayTimeUnit\": \"ms\", \"traceEvents\": [", writer.stream);
    for (size_t i = 0; i < frame->event_count; i++) {
        const tile_event *e = &frame->events[i];
        /* Whole nanoseconds: no decimal point that a locale could change. */
        long long begin_ns = (long long)(e->begin_s * 1e9), length_ns = (long long)((e->end_s - e->begin_s) * 1e9);
        fprintf(writer.stream, "%s\n{\"name\": \"%d,%d-%d,%d\", \"ph\": \"X\", \"pid\": 0, \"tid\": %d", i ? "," : "", e->x0,
                e->y0, e->x1, e->y1, e->worker);
        fprintf(writer.stream, ", \"ts\": %lld.%03lld, \"dur\": %lld.%03lld}", begin_ns / 1000, begin_ns % 1000,
                length_ns / 1000, length_ns % 1000);
    }
    fputs("\n]}\n", writer.stream);
    return file_writer_commit(&writer, why);
}

static status write_kept(const render_result *frame, kept what, const char *path, diagnostic *why)
{
    int width = frame->picture->width, height = frame->picture->height;
    switch (what) {
    case KEPT_PNG:
    case KEPT_PFM: return write_film(frame, path, why);
    case KEPT_RAYS_PNG: return write_heatmap(frame->pixel_rays, width, height, "rays per pixel", path, why);
    case KEPT_RAYS_PFM: return write_values(frame->pixel_rays, width, height, path, why);
    case KEPT_NS_PNG: return write_heatmap(frame->pixel_ns, width, height, "nanoseconds per pixel", path, why);
    case KEPT_NS_PFM: return write_values(frame->pixel_ns, width, height, path, why);
    case KEPT_TIMELINE: return write_timeline(frame, path, why);
    case KEPT_COUNT: break;
    }
    return STATUS_OK;
}

status keep_write(const study *s, const char *folder, size_t cell, const render_result *frame, diagnostic *why)
{
    char *images = text_format("%s/images", folder);
    status code = images ? file_make_directory(images, why) : diagnose(why, STATUS_FAILURE, "", "out of memory");
    free(images);
    for (kept what = 0; code == STATUS_OK && what < KEPT_COUNT; what++) {
        if (!wanted(s, what))
            continue;
        char *path = kept_path(folder, cell, what);
        code = path ? write_kept(frame, what, path, why) : diagnose(why, STATUS_FAILURE, "", "out of memory");
        free(path);
    }
    return code;
}
