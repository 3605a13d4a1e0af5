#include "study/rows.h"
#include "base/text.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifndef CUVETTE_COMPILER_FLAGS
#define CUVETTE_COMPILER_FLAGS "unknown"
#endif

/* What the workers' accounts come to. Means are over the workers that had a tile: with more threads than pieces the
 * others only wait, and would hide how evenly the work was shared. */
typedef struct workers_sum {
    int64_t with_tiles;
    double busy_mean, busy_max, waiting_mean, visibility_sum, cpu_sum, imbalance;
} workers_sum;

static workers_sum sum_workers(const render_result *frame)
{
    workers_sum sum = {0};
    for (int i = 0; i < frame->worker_count; i++) {
        const worker_report *w = &frame->workers[i];
        sum.cpu_sum += w->cpu_s;
        sum.with_tiles += w->tiles > 0;
        sum.busy_mean += w->busy_s;
        sum.waiting_mean += w->waiting_s;
        sum.visibility_sum += w->visibility_s;
        sum.busy_max = fmax(sum.busy_max, w->busy_s);
    }
    double count = frame->worker_count > 0 ? (double)frame->worker_count : NAN;
    sum.busy_mean /= count;
    sum.waiting_mean /= count;
    sum.imbalance = sum.busy_mean > 0 ? sum.busy_max / sum.busy_mean - 1 : NAN;
    return sum;
}

const char *study_grid_path(const study *s, size_t index)
{
    for (size_t axis = 0; axis < s->axis_count; axis++) {
        const study_point *first = &s->axes[axis].points[0];
        if (index < first->count)
            return first->paths[index];
        index -= first->count;
    }
    return NULL;
}

char *row_time(int64_t ms, char text[ROW_TIME_MAX])
{
    time_t seconds = (time_t)(ms / 1000);
    struct tm utc;
    gmtime_r(&seconds, &utc);
    size_t size = strftime(text, ROW_TIME_MAX, "%Y-%m-%dT%H:%M:%S", &utc);
    snprintf(text + size, ROW_TIME_MAX - size, ".%03dZ", (int)(ms % 1000));
    return text;
}

const char *row_build_config(char text[ROW_TIME_MAX])
{
    snprintf(text, ROW_TIME_MAX, "%.*s", (int)strcspn(CUVETTE_COMPILER_FLAGS, ":"), CUVETTE_COMPILER_FLAGS);
    return text;
}

void row_put_axes(csv_line *line, const study *s, const scene *setting)
{
    const char *path;
    for (size_t i = 0; (path = study_grid_path(s, i)); i++) {
        char *value = NULL;
        csv_text(line, scene_get(setting, path, &value, NULL) == STATUS_OK ? value : NULL);
        free(value);
    }
}

/* "480000;95458;...": depth 0 to the last one with a ray. */
static void put_by_depth(csv_line *line, const uint64_t by_depth[COUNTERS_DEPTH_MAX + 1])
{
    char text[(COUNTERS_DEPTH_MAX + 1) * 21 + 1];
    size_t last = COUNTERS_DEPTH_MAX, size = 0;
    while (last > 0 && by_depth[last] == 0)
        last--;
    for (size_t depth = 0; depth <= last; depth++)
        size += (size_t)snprintf(text + size, sizeof text - size, depth ? ";%" PRIu64 : "%" PRIu64, by_depth[depth]);
    csv_text(line, text);
}

/* Mean of the three channels, in throughput of one whole ray. */
static void put_cut(csv_line *line, const int64_t throughput[3])
{
    double sum = (double)throughput[0] + (double)throughput[1] + (double)throughput[2];
    csv_real(line, sum / (3 * COUNTERS_CUT_ONE));
}

static void put_solids(csv_line *line, const study_row *r, const uint64_t counts[COUNTERS_SOLID_MAX])
{
    for (size_t i = 0; i < r->setting->solid_count; i++)
        csv_count(line, i < COUNTERS_SOLID_MAX ? (int64_t)counts[i] : -1);
}

static void put_isa_and_config(csv_line *line, const study_row *r, bool config)
{
    char text[ROW_TIME_MAX];
    csv_text(line, config ? row_build_config(text) : isa_name(r->level));
}

static void put_time(csv_line *line, const study_row *r)
{
    char text[ROW_TIME_MAX];
    csv_text(line, row_time(r->time_ms, text));
}

/* A column's name, unit, meaning and how it is written stand together, so that header, dictionary and row cannot
 * part. In the last one: line, r (the row), c (its counters), w (its workers' sum). */
#define WHOSE(X)                                                                                                \
    X("study", "", "name of the study", csv_text(line, r->of->name))                                            \
    X("definition", "", "fingerprint of scene, fixed parameters and grid, 16 hex digits",                       \
      csv_hash(line, r->of->definition_hash))                                                                   \
    X("cell", "", "number of the grid point, the last axis fastest", csv_count(line, (int64_t)r->cell))         \
    X("repetition", "", "running number in the cell, from 0, warm-ups counted; a continued run warms up again", \
      csv_count(line, r->repetition))                                                                           \
    X("warmup", "", "1: frame before the first measured one of the cell in its process; not for summaries",     \
      csv_count(line, r->warmup))

#define ROW_COLUMNS(X)                                                                                                 \
    WHOSE(X)                                                                                                           \
    X("order", "", "running number of the row in the file that it was first written to",                               \
      csv_count(line, (int64_t)r->order))                                                                              \
    X("time_utc", "", "when the frame had ended, ISO 8601", put_time(line, r))                                         \
    X("<axis>", "of the parameter", "value of each parameter of the grid, in its order",                               \
      row_put_axes(line, r->of, r->setting))                                                                           \
    X("film_hash", "", "fingerprint of the film, 16 hex digits", csv_hash(line, r->film_hash))                         \
    X("film_expected", "",                                                                                             \
      "film_hash of the first row of all cells that must have one film: they differ only in how it is made (threads, " \
      "pool, schedule, tile, pin, hierarchies)",                                                                       \
      csv_hash(line, r->film_expected))                                                                                \
    X("marked", "", "1: film_hash is not film_expected, do not trust this row",                                        \
      csv_count(line, r->film_hash != r->film_expected))                                                               \
    X("wall_s", "s", "wall time of the frame; with render.pool off, making and joining threads too",                   \
      csv_real(line, r->frame->wall_s))                                                                                \
    X("cpu_s", "s", "CPU time of the process over the same stretch", csv_real(line, r->frame->cpu_s))                  \
    X("rays_camera", "rays", "camera rays traced", csv_count(line, (int64_t)c->camera))                                \
    X("rays_reflect", "rays", "reflected rays traced", csv_count(line, (int64_t)c->reflect))                           \
    X("rays_refract", "rays", "refracted rays traced", csv_count(line, (int64_t)c->refract))                           \
    X("rays_shadow", "rays", "shadow rays traced", csv_count(line, (int64_t)c->shadow))                                \
    X("rays_total", "rays", "sum of the four kinds", csv_count(line, (int64_t)ray_counters_total(c)))                  \
    X("rays_by_depth", "rays", "camera, reflected and refracted rays at depth 0;1;2;...",                              \
      put_by_depth(line, c->by_depth))                                                                                 \
    X("total_internal", "", "total internal reflections", csv_count(line, (int64_t)c->total_internal))                 \
    X("cut_depth", "rays", "rays not traced because they lie beyond the last depth",                                   \
      csv_count(line, (int64_t)c->cut_depth))                                                                          \
    X("cut_depth_throughput", "rays", "their throughput, mean of RGB, summed", put_cut(line, c->cut_depth_throughput)) \
    X("cut_weight", "rays", "rays not traced because they weigh less than render.min_weight",                          \
      csv_count(line, (int64_t)c->cut_weight))                                                                         \
    X("cut_weight_throughput", "rays", "their throughput, mean of RGB, summed",                                        \
      put_cut(line, c->cut_weight_throughput))                                                                         \
    X("first_hits.<solid>", "rays", "camera rays whose first interface is on that solid",                              \
      put_solids(line, r, c->first_hits))                                                                              \
    X("hits.<solid>", "rays", "interfaces met on that solid by rays of all kinds but shadow rays",                     \
      put_solids(line, r, c->hits))                                                                                    \
    X("noise_rms", "radiance",                                                                                         \
      "of random paths: root of the mean square of the film's standard error, over all its values, 1 is white; else "  \
      "NA",                                                                                                            \
      csv_real(line, render_noise_rms(r->frame)))                                                                      \
    X("triangles", "", "of all meshes as they stand there, copies counted; 0 without meshes",                          \
      csv_count(line, (int64_t)r->frame->meshes.triangles))                                                            \
    X("instances", "", "copies of meshes", csv_count(line, (int64_t)r->frame->meshes.instances))                       \
    X("accel_bytes", "B", "memory of the hierarchies over their triangles, each mesh once",                            \
      csv_count(line, (int64_t)r->frame->meshes.bytes))                                                                \
    X("build_s", "s", "wall time of building these, for this frame (render.keep off) or before it; not in wall_s",     \
      csv_real(line, r->frame->meshes.build_s))                                                                        \
    X("motion_steps", "",                                                                                              \
      "steps and substeps of slimes from their beginnings to the moments that are shown; 0 without slimes",            \
      csv_count(line, (int64_t)r->frame->meshes.motion_steps))                                                         \
    X("motion_s", "s", "wall time of these, for this frame (render.keep off) or before it; not in wall_s",             \
      csv_real(line, r->frame->meshes.motion_s))                                                                       \
    X("drawn", "", "of the depth buffer: triangles in the picture, analytic solids' too; else 0",                      \
      csv_count(line, (int64_t)r->frame->meshes.drawn))                                                                \
    X("drawn_bytes", "B", "memory of the depth buffer and of these triangles",                                         \
      csv_count(line, (int64_t)r->frame->meshes.drawn_bytes))                                                          \
    X("workers", "", "threads of the frame", csv_count(line, r->frame->worker_count))                                  \
    X("workers_with_tiles", "", "those that had a piece of the picture", csv_count(line, w.with_tiles))                \
    X("busy_s_mean", "s", "from a worker's first piece to its last ray, 0 without a piece; mean over all workers",     \
      csv_real(line, w.busy_mean))                                                                                     \
    X("busy_s_max", "s", "the longest of them", csv_real(line, w.busy_max))                                            \
    X("waiting_s_mean", "s", "wall_s less busy time, mean over all workers", csv_real(line, w.waiting_mean))           \
    X("visibility_s_sum", "s",                                                                                         \
      "of all workers' busy time, finding out what rays meet and what stands in a light's way; NA for scenes without " \
      "meshes",                                                                                                        \
      csv_real(line, w.visibility_sum))                                                                                \
    X("worker_cpu_s_sum", "s", "CPU time of all workers", csv_real(line, w.cpu_sum))                                   \
    X("imbalance", "", "busy_s_max / busy_s_mean - 1", csv_real(line, w.imbalance))                                    \
    X("peak_rss_bytes", "bytes",                                                                                       \
      "highest resident memory of the process: since the frame began where Linux lets it be reset, else so far",       \
      csv_count(line, r->used.peak_rss_bytes))                                                                         \
    X("voluntary_switches", "", "context switches by waiting, whole process, during the frame",                        \
      csv_count(line, r->used.voluntary_switches))                                                                     \
    X("involuntary_switches", "", "context switches by losing the processor",                                          \
      csv_count(line, r->used.involuntary_switches))                                                                   \
    X("others_share", "", "share of the machine used by other processes meanwhile, 0..1; coarse under 0.1 s",          \
      csv_real(line, usage_others_share(&r->used)))                                                                    \
    X("cycles", "", "hardware counter of the process over the frame, user mode", csv_count(line, r->hardware.cycles))  \
    X("instructions", "", "hardware counter", csv_count(line, r->hardware.instructions))                               \
    X("branch_misses", "", "hardware counter", csv_count(line, r->hardware.branch_misses))                             \
    X("cache_misses", "", "hardware counter", csv_count(line, r->hardware.cache_misses))                               \
    X("isa", "", "vector instructions used: sse2, avx2, avx512", put_isa_and_config(line, r, false))                   \
    X("config", "", "build: release, debug, sanitize, tsan, nocounters", put_isa_and_config(line, r, true))

/* k: the worker's report. */
#define WORKER_COLUMNS(X)                                                                                     \
    WHOSE(X)                                                                                                  \
    X("<axis>", "of the parameter", "value of each parameter of the grid, in its order",                      \
      row_put_axes(line, r->of, r->setting))                                                                  \
    X("worker", "", "number of the worker, from 0", csv_count(line, worker))                                  \
    X("pu", "", "processing unit that it ended on (the system's number)", csv_count(line, k->pu))             \
    X("tiles", "", "pieces of the picture that it took", csv_count(line, (int64_t)k->tiles))                  \
    X("rays_total", "rays", "rays of all kinds that it traced",                                               \
      csv_count(line, (int64_t)(k->camera + k->reflect + k->refract + k->shadow)))                            \
    X("rays_camera", "rays", "camera rays among them", csv_count(line, (int64_t)k->camera))                   \
    X("rays_reflect", "rays", "reflected rays among them", csv_count(line, (int64_t)k->reflect))              \
    X("rays_refract", "rays", "refracted rays among them", csv_count(line, (int64_t)k->refract))              \
    X("rays_shadow", "rays", "shadow rays among them", csv_count(line, (int64_t)k->shadow))                   \
    X("start_s", "s", "when it began to work, after the frame's start", csv_real(line, k->start_s))           \
    X("wall_s", "s", "from its first instruction to its last in the frame", csv_real(line, k->wall_s))        \
    X("cpu_s", "s", "its CPU time over the same stretch", csv_real(line, k->cpu_s))                           \
    X("busy_s", "s", "from its first piece taken to its last ray traced; 0 without a piece",                  \
      csv_real(line, k->busy_s))                                                                              \
    X("visibility_s", "s",                                                                                    \
      "of busy_s: finding out what rays meet and what stands in a light's way; NA for scenes without meshes", \
      csv_real(line, k->visibility_s))                                                                        \
    X("waiting_s", "s", "wall time of the frame less busy_s", csv_real(line, k->waiting_s))

#define DESCRIBE(name, unit, meaning, put) {name, unit, meaning},
#define PUT(name, unit, meaning, put) put;

const row_column row_columns[] = {ROW_COLUMNS(DESCRIBE)};
const size_t row_column_count = sizeof row_columns / sizeof row_columns[0];
const row_column worker_columns[] = {WORKER_COLUMNS(DESCRIBE)};
const size_t worker_column_count = sizeof worker_columns / sizeof worker_columns[0];

void row_columns_header(csv_line *line, const study *s, const row_column *columns, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const char *name = columns[i].name, *bracket = strchr(name, '<');
        if (!bracket) {
            csv_text(line, name);
        } else if (strcmp(bracket, "<axis>") == 0) {
            const char *path;
            for (size_t k = 0; (path = study_grid_path(s, k)); k++)
                csv_text(line, path);
        } else {
            for (size_t k = 0; k < s->base->solid_count; k++) {
                char *text = text_format("%.*s%s", (int)(bracket - name), name, s->base->solids[k].name);
                line->failed |= !text;
                csv_text(line, text);
                free(text);
            }
        }
    }
    csv_end(line);
}

void row_header(csv_line *line, const study *s)
{
    row_columns_header(line, s, row_columns, row_column_count);
}

void worker_header(csv_line *line, const study *s)
{
    row_columns_header(line, s, worker_columns, worker_column_count);
}

void row_write(csv_line *line, const study_row *r)
{
    const ray_counters *c = &r->frame->counters;
    workers_sum w = sum_workers(r->frame);
    ROW_COLUMNS(PUT)
    csv_end(line);
}

void worker_rows_write(csv_line *line, const study_row *r)
{
    for (int worker = 0; worker < r->frame->worker_count; worker++) {
        const worker_report *k = &r->frame->workers[worker];
        WORKER_COLUMNS(PUT)
        csv_end(line);
    }
}
