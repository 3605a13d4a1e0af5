#include "study/keep.h"
#include "base/file.h"
#include "base/text.h"
#include "render/core/record.h"
#include "study/grid.h"
#include "study/metric_table.h"
#include "study/motion_table.h"
#include "study/rows.h"
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

typedef enum kept {
    KEPT_PNG,
    KEPT_PFM,
    KEPT_RAYS_PNG,
    KEPT_RAYS_PFM,
    KEPT_NS_PNG,
    KEPT_NS_PFM,
    KEPT_TIMELINE,
    KEPT_METRICS,
    KEPT_CURVES,
    KEPT_MOTION,
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
    case KEPT_METRICS: return s->keep_metrics;
    case KEPT_CURVES: return s->keep_curves;
    case KEPT_MOTION: return s->keep_motion;
    case KEPT_COUNT: break;
    }
    return false;
}

bool study_keeps_files(const study *s)
{
    for (kept what = 0; what < KEPT_COUNT; what++)
        if (wanted(s, what))
            return true;
    return false;
}

static char *kept_path(const char *folder, size_t cell, kept what)
{
    static const char *const endings[KEPT_COUNT] = {".png",        ".pfm",       "-rays.png",      "-rays.pfm",
                                                    "-ns.png",     "-ns.pfm",    "-timeline.json", "-metrics.tsv",
                                                    "-curves.tsv", "-motion.tsv"};
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

static status write_kept(const study *s, const kept_cell *c, kept what, const char *path, diagnostic *why)
{
    const render_result *frame = c->made->result;
    switch (what) {
    case KEPT_PNG:
    case KEPT_PFM: return record_picture(frame->picture, path, 8, why);
    case KEPT_RAYS_PNG:
    case KEPT_RAYS_PFM: return record_map(frame->pixel_rays, frame->picture, "rays per pixel", path, why);
    case KEPT_NS_PNG:
    case KEPT_NS_PFM: return record_map(frame->pixel_ns, frame->picture, "nanoseconds per pixel", path, why);
    case KEPT_TIMELINE: return record_timeline(frame, path, why);
    case KEPT_METRICS: return metric_table_write(s, c->cell, c->made->of, c->made->level, path, why);
    case KEPT_CURVES: return curve_table_write(s, c->cell, c->made->of, c->made->level, path, why);
    case KEPT_MOTION: return motion_table_write(s, c->cell, c->made->of, c->made->level, path, why);
    case KEPT_COUNT: break;
    }
    return STATUS_OK;
}

status keep_write(const study *s, const char *folder, const kept_cell *c, diagnostic *why)
{
    char *images = text_format("%s/images", folder);
    status code = images ? file_make_directory(images, why) : out_of_memory(why);
    free(images);
    for (kept what = 0; code == STATUS_OK && what < KEPT_COUNT; what++) {
        if (!wanted(s, what))
            continue;
        char *path = kept_path(folder, c->cell, what);
        code = path ? write_kept(s, c, what, path, why) : out_of_memory(why);
        free(path);
    }
    return code;
}

static void index_header(const study *s, FILE *out)
{
    const char *path;
    fputs("file\tcell", out);
    for (size_t i = 0; (path = study_grid_path(s, i)); i++)
        fprintf(out, "\t%s", path);
    fputc('\n', out);
}

static void index_line(const study *s, const char *path, size_t cell, FILE *out)
{
    fprintf(out, "%s\t%zu", strrchr(path, '/') + 1, cell);
    grid_put_values(s, cell, out);
    fputc('\n', out);
}

static status list_kept(const study *s, const char *folder, FILE *out, diagnostic *why)
{
    index_header(s, out);
    for (size_t cell = 0; cell < study_cell_count(s); cell++)
        for (kept what = 0; what < KEPT_COUNT; what++) {
            char *path = kept_path(folder, cell, what);
            if (!path)
                return out_of_memory(why);
            if (access(path, F_OK) == 0)
                index_line(s, path, cell, out);
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
        /* Of shards that end at one time the last one must list the files of all. */
        int lock = open(images, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (lock >= 0)
            flock(lock, LOCK_EX);
        code = file_writer_open(&writer, path, why);
        if (code == STATUS_OK && (code = list_kept(s, folder, writer.stream, why)) != STATUS_OK)
            file_writer_abandon(&writer);
        else if (code == STATUS_OK)
            code = file_writer_commit(&writer, why);
        if (lock >= 0)
            close(lock);
    }
    free(images);
    free(path);
    return code;
}
