/* The files that a study keeps for a cell: their names, the space that they need, and their contents. */
#include "study/plan/keep.h"
#include "base/file.h"
#include "base/number.h"
#include "base/text.h"
#include "image/image.h"
#include "realism/realism.h"
#include "render/frame/record.h"
#include "scene/assets/slime.h"
#include "scene/model/scene.h"
#include "scene/motion/motion.h"
#include "softbody/trials.h"
#include "study/plan/grid.h"
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
    size_t wish; /* offset of the bool in study that selects the file */
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
        char path[PATH_MAX]; /* a longer path cannot exist */
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
            if (format != IMAGE_UNKNOWN) /* a map has a legend, and is at least as wide as the legend */
                image_room(format, is_map ? fmax(width, KEY_SIDE) : width, is_map ? height + KEY_SIDE : height, 1, to);
            else if (files[what].wish == offsetof(study, keep_timeline)) /* one event per tile, with a margin */
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

/* --- tables --- */

typedef enum cell_table { CELL_METRICS, CELL_CURVES, CELL_MOTION } cell_table;

/* The sources of a cell's table, and its output file. */
typedef struct cell_lines {
    const study *s;
    size_t cell;
    const scene *setting;
    isa level;
    FILE *out;
} cell_lines;

/* Writes the start of a line, up to the last axis value. */
static void begin(const cell_lines *l)
{
    fprintf(l->out, "%s\t%zu", l->s->name, l->cell);
    grid_put_values(l->s, l->cell, l->out);
}

static void put_numbers(const cell_lines *l, const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        grid_put_number(l->out, values[i]);
}

static status put_metrics(const cell_lines *l, diagnostic *why)
{
    realism_report report;
    const status code = realism_measure(l->setting, l->level, &report, why);
    for (int i = 0; code == STATUS_OK && i < report.count; i++) {
        const realism_value *v = &report.value[i];
        begin(l);
        fprintf(l->out, "\t%s\t%s", v->metric, v->unit[0] ? v->unit : "NA");
        put_numbers(l, (double[]){v->measured, v->theory, realism_error(v), v->tolerance}, 4);
        fprintf(l->out, "\t%s\t%s\n", !realism_is_defined(v) ? "NA" : realism_passes(v) ? "1" : "0", v->what);
    }
    return code;
}

static status put_curves(const cell_lines *l, diagnostic *why)
{
    status code = STATUS_OK;
    for (int which = 0; which < REALISM_CURVE_STUDY_COUNT && code == STATUS_OK; which++) {
        realism_points points;
        code = realism_measure_curve(l->setting, l->level, (realism_curve)which, &points, why);
        for (int i = 0; code == STATUS_OK && i < points.count; i++) {
            begin(l);
            fprintf(l->out, "\t%s", realism_curve_name((realism_curve)which));
            put_numbers(l, (double[]){points.at[i].x, points.at[i].measured, points.at[i].theory}, 3);
            fputc('\n', l->out);
        }
    }
    return code;
}

static status put_slime(const cell_lines *l, const mesh_entry *m, diagnostic *why)
{
    const softbody_settings settings = slime_settings(m);
    softbody_trial_report report;
    const status code = softbody_trials(&settings, l->level, &report, why);
    for (int i = 0; code == STATUS_OK && i < SOFTBODY_TRIAL_COUNT; i++) {
        const softbody_trial *v = &report.value[i];
        begin(l);
        fprintf(l->out, "\t%s\t%s\t%s", m->name, v->name, v->unit[0] ? v->unit : "NA");
        put_numbers(l, (double[]){v->measured, v->theory, softbody_trial_error(v)}, 3);
        fprintf(l->out, "\t%s\n", v->what);
    }
    return code;
}

static status put_motion(const cell_lines *l, diagnostic *why)
{
    for (size_t i = 0; i < l->setting->mesh_count; i++)
        if (l->setting->meshes[i].source == MESH_SLIME)
            TRY(put_slime(l, &l->setting->meshes[i], why));
    return STATUS_OK;
}

static const struct {
    const char *columns; /* after the axis values */
    status (*put)(const cell_lines *l, diagnostic *why);
} tables[] = {
    [CELL_METRICS] = {"metric\tunit\tmeasured\ttheory\terror\ttolerance\tpasses\twhat", put_metrics},
    [CELL_CURVES] = {"curve\tx\tmeasured\ttheory", put_curves},
    [CELL_MOTION] = {"slime\tname\tunit\tmeasured\ttheory\terror\twhat", put_motion},
};

static status write_table(cell_table which, const study *s, const kept_cell *c, const char *path, diagnostic *why)
{
    const job_account *account = c->account;
    file_writer file;
    TRY(file_writer_open(&file, path, why));
    fputs("study\tcell", file.stream);
    grid_put_paths(s, file.stream);
    fprintf(file.stream, "\t%s\n", tables[which].columns);
    const cell_lines lines = {s, c->cell, account->of, account->level, file.stream};
    return file_writer_end(&file, tables[which].put(&lines, why), why);
}

static status check_metrics(void *context, const study *s, size_t cell, scene *setting, diagnostic *why)
{
    (void)context;
    diagnostic bad = {.what = ""};
    const status code = realism_check(setting, s->keep_curves, &bad);
    if (code == STATUS_OK)
        return code;
    return diagnose(why, code, bad.remedy, "%s of cell %zu cannot be saved: %s", s->keep_curves ? "curves" : "metrics",
                    cell, bad.what);
}

static status check_motion(void *context, const study *s, size_t cell, scene *setting, diagnostic *why)
{
    (void)context, (void)s;
    if (scene_moves(setting))
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "add a mesh with 'generate: slime'",
                    "the motion of cell %zu cannot be saved: nothing moves in it", cell);
}

status keep_check_tables(const study *s, const char **key, diagnostic *why)
{
    *key = s->keep_curves ? "curves" : "metrics";
    if (s->keep_metrics || s->keep_curves)
        TRY(grid_each_cell(s, check_metrics, NULL, why));
    *key = "motion";
    return s->keep_motion ? grid_each_cell(s, check_motion, NULL, why) : STATUS_OK;
}

/* --- writing --- */

static status write_kept(const study *s, const kept_cell *c, size_t what, const char *path, diagnostic *why)
{
    const render_result *frame = c->account->result;
    const size_t wish = files[what].wish;
    if (wish == offsetof(study, keep_pixel_rays))
        return record_map(frame->pixel_rays, frame->img, "rays per pixel", path, why);
    if (wish == offsetof(study, keep_pixel_time))
        return record_map(frame->pixel_ns, frame->img, "nanoseconds per pixel", path, why);
    if (wish == offsetof(study, keep_pixel_cut))
        return record_map(frame->pixel_cut, frame->img, "fraction of cut light per pixel", path, why);
    if (wish == offsetof(study, keep_timeline))
        return record_timeline(frame, path, why);
    if (wish == offsetof(study, keep_image) || wish == offsetof(study, keep_pfm))
        return record_image(frame, NULL, c->account->of, path, 8, why);
    const cell_table which = wish == offsetof(study, keep_metrics)  ? CELL_METRICS
                             : wish == offsetof(study, keep_curves) ? CELL_CURVES
                                                                    : CELL_MOTION;
    return write_table(which, s, c, path, why);
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
