#include "study/keep.h"
#include "base/file.h"
#include "base/text.h"
#include "image/image.h"
#include "render/frame/record.h"
#include "study/cell_table.h"
#include "study/grid.h"
#include "scene/model/scene.h"
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

/* The files of a cell, and the settings of the study that select them. */
static const struct {
    size_t wish; /* offset in study of a bool */
    const char *ending;
} files[] = {
    {offsetof(study, keep_image), ".png"},
    {offsetof(study, keep_pfm), ".pfm"},
    {offsetof(study, keep_pixel_rays), "-rays.png"},
    {offsetof(study, keep_pixel_rays), "-rays.pfm"},
    {offsetof(study, keep_pixel_time), "-ns.png"},
    {offsetof(study, keep_pixel_time), "-ns.pfm"},
    {offsetof(study, keep_pixel_cut), "-cut.png"},
    {offsetof(study, keep_pixel_cut), "-cut.pfm"},
    {offsetof(study, keep_timeline), "-timeline.json"},
    {offsetof(study, keep_metrics), "-metrics.tsv"},
    {offsetof(study, keep_curves), "-curves.tsv"},
    {offsetof(study, keep_motion), "-motion.tsv"},
};
enum { KEPT_COUNT = sizeof files / sizeof *files };

static bool wanted(const study *s, size_t what)
{
    return *(const bool *)((const char *)s + files[what].wish);
}

bool study_keeps_files(const study *s)
{
    for (size_t what = 0; what < KEPT_COUNT; what++)
        if (wanted(s, what))
            return true;
    return false;
}

#define KEPT_PATH "%s/images/%04zu%s"

static char *kept_path(const char *folder, size_t cell, size_t what)
{
    return text_format(KEPT_PATH, folder, cell, files[what].ending);
}

char *keep_image_path(const char *folder, size_t cell)
{
    return kept_path(folder, cell, 0);
}

size_t keep_missing_count(const study *s, const char *folder, size_t cell)
{
    size_t missing = 0;
    for (size_t what = 0; what < KEPT_COUNT; what++) {
        if (!wanted(s, what))
            continue;
        char path[PATH_MAX]; /* a longer one cannot exist */
        const int length = snprintf(path, sizeof path, KEPT_PATH, folder, cell, files[what].ending);
        missing += length < 0 || length >= PATH_MAX || access(path, F_OK) != 0;
    }
    return missing;
}

bool keep_missing(const study *s, const char *folder, size_t cell)
{
    return keep_missing_count(s, folder, cell) > 0;
}

status keep_room(const study *s, const char *folder, size_t cell, const scene *setting, disk_room *to, diagnostic *why)
{
    enum { TABLE_MOST = 100000, EVENT_MOST = 160, KEY_SIDE = 240 };
    const double tile = setting->render.tile > 0 ? (double)setting->render.tile : 1;
    const double width = (double)setting->render.width, height = (double)setting->render.height;
    for (size_t what = 0; what < KEPT_COUNT; what++) {
        if (!wanted(s, what))
            continue;
        char *path = kept_path(folder, cell, what);
        if (!path)
            return out_of_memory(why);
        if (access(path, F_OK) != 0) {
            const image_format format = image_format_of(path);
            const bool is_map = format == IMAGE_PNG && files[what].wish != offsetof(study, keep_image);
            if (format != IMAGE_UNKNOWN) /* a map has a key, and is as wide as the key at least */
                image_room(format, is_map ? fmax(width, KEY_SIDE) : width, is_map ? height + KEY_SIDE : height, 1, to);
            else if (files[what].wish == offsetof(study, keep_timeline)) /* tiles are halved where there are few */
                disk_room_add(to, 1, 0, TABLE_MOST + EVENT_MOST * 4 * ceil(width / tile) * ceil(height / tile));
            else
                disk_room_add(to, 1, 0, TABLE_MOST);
        }
        free(path);
    }
    return STATUS_OK;
}

const char *keep_ending(const study *s, size_t i)
{
    for (size_t what = 0; what < KEPT_COUNT; what++)
        if (wanted(s, what) && i-- == 0)
            return files[what].ending;
    return NULL;
}

render_options keep_options(const study *s)
{
    return (render_options){.pixel_rays = s->keep_pixel_rays,
                            .pixel_time = s->keep_pixel_time,
                            .pixel_cut = s->keep_pixel_cut,
                            .timeline = s->keep_timeline};
}

static status write_kept(const study *s, const kept_cell *c, size_t what, const char *path, diagnostic *why)
{
    const render_result *frame = c->made->result;
    const size_t wish = files[what].wish;
    if (wish == offsetof(study, keep_pixel_rays))
        return record_map(frame->pixel_rays, frame->img, "rays per pixel", path, why);
    if (wish == offsetof(study, keep_pixel_time))
        return record_map(frame->pixel_ns, frame->img, "nanoseconds per pixel", path, why);
    if (wish == offsetof(study, keep_pixel_cut))
        return record_map(frame->pixel_cut, frame->img, "share of cut light per pixel", path, why);
    if (wish == offsetof(study, keep_timeline))
        return record_timeline(frame, path, why);
    if (wish == offsetof(study, keep_image) || wish == offsetof(study, keep_pfm))
        return record_image(frame->img, c->made->of, path, 8, why);
    const cell_table which = wish == offsetof(study, keep_metrics)  ? CELL_METRICS
                             : wish == offsetof(study, keep_curves) ? CELL_CURVES
                                                                    : CELL_MOTION;
    return cell_table_write(which, s, c->cell, c->made->of, c->made->level, path, why);
}

status keep_write(const study *s, const char *folder, const kept_cell *c, diagnostic *why)
{
    char *images = text_format("%s/images", folder);
    status code = images ? file_make_directory(images, why) : out_of_memory(why);
    free(images);
    for (size_t what = 0; code == STATUS_OK && what < KEPT_COUNT; what++) {
        if (!wanted(s, what))
            continue;
        char *path = kept_path(folder, c->cell, what);
        code = path ? write_kept(s, c, what, path, why) : out_of_memory(why);
        free(path);
    }
    return code;
}

static status list_kept(const study *s, const char *folder, FILE *out, diagnostic *why)
{
    fputs("file\tcell", out);
    grid_put_paths(s, out);
    fputc('\n', out);
    for (size_t cell = 0; cell < study_cell_count(s); cell++)
        for (size_t what = 0; what < KEPT_COUNT; what++) {
            char *path = kept_path(folder, cell, what);
            if (!path)
                return out_of_memory(why);
            if (access(path, F_OK) == 0) {
                fprintf(out, "%s\t%zu", strrchr(path, '/') + 1, cell);
                grid_put_values(s, cell, out);
                fputc('\n', out);
            }
            free(path);
        }
    return STATUS_OK;
}

status keep_index(const study *s, const char *folder, bool renew, diagnostic *why)
{
    bool keeps = study_keeps_files(s);
    char *path = text_format("%s/images/index.tsv", folder), *images = text_format("%s/images", folder);
    status code = path && images ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK && keeps && access(images, F_OK) == 0 && (renew || access(path, F_OK) != 0)) {
        file_writer writer;
        /* If several shards finish at the same time, the last one must list the files of all of them. */
        int lock = open(images, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (lock >= 0)
            flock(lock, LOCK_EX);
        code = file_writer_open(&writer, path, why);
        THEN(code, file_writer_end(&writer, list_kept(s, folder, writer.stream, why), why));
        if (lock >= 0)
            close(lock);
    }
    free(images);
    free(path);
    return code;
}
