#include "job/quantities.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#ifndef CUVETTE_COMPILER_FLAGS
#define CUVETTE_COMPILER_FLAGS "unknown"
#endif

/* --- what takes more than an expression --- */

/* Sums, maximum and means over all workers. */
typedef struct workers_sum {
    int64_t with_tiles;
    double busy_mean, busy_max, waiting_mean, visibility_sum, cpu_sum, imbalance;
} workers_sum;

static workers_sum sum_workers(const job_account *a)
{
    workers_sum sum = {0};
    for (int i = 0; i < a->result->worker_count; i++) {
        const worker_report *w = &a->result->workers[i];
        sum.cpu_sum += w->cpu_s;
        sum.with_tiles += w->tiles > 0;
        sum.busy_mean += w->busy_s;
        sum.waiting_mean += w->waiting_s;
        sum.visibility_sum += w->visibility_s;
        sum.busy_max = fmax(sum.busy_max, w->busy_s);
    }
    const double count = a->result->worker_count > 0 ? (double)a->result->worker_count : NAN;
    sum.busy_mean /= count;
    sum.waiting_mean /= count;
    sum.imbalance = sum.busy_mean > 0 ? sum.busy_max / sum.busy_mean - 1 : NAN;
    return sum;
}

/* In throughput of one whole ray. */
static void take_cut(quantity_value *v, const int64_t throughput[3])
{
    for (int channel = 0; channel < 3; channel++)
        v->real[channel] = (double)throughput[channel] / COUNTERS_CUT_ONE;
}

/* Mean of the channels, of rays cut for one reason or for both. */
static double mean_cut(const int64_t one[3], const int64_t other[3])
{
    double sum = 0;
    for (int channel = 0; channel < 3; channel++)
        sum += (double)one[channel] + (other ? (double)other[channel] : 0.0);
    return sum / (3 * COUNTERS_CUT_ONE);
}

/* Mean over all pixels, by channel; NaN where nothing is drawn by chance. */
static void take_variance(quantity_value *v, const render_result *r)
{
    const size_t pixels = r->variance ? (size_t)r->img->width * (size_t)r->img->height : 0;
    for (int channel = 0; channel < 3; channel++)
        v->real[channel] = pixels > 0 ? 0.0 : (double)NAN;
    for (size_t i = 0; i < 3 * pixels; i++)
        v->real[i % 3] += r->variance[i] / (double)pixels;
}

static double bytes_per_triangle(const mesh_report *m)
{
    return m->triangles > 0 ? (double)m->bytes / (double)m->triangles : (double)NAN;
}

static size_t depths_of(const job_account *a)
{
    const int64_t depth = a->of->render.depth;
    return (size_t)(depth < COUNTERS_DEPTH_MAX ? depth : COUNTERS_DEPTH_MAX) + 1;
}

static size_t solids_of(const job_account *a)
{
    return a->of->solid_count < COUNTERS_SOLID_MAX ? a->of->solid_count : COUNTERS_SOLID_MAX;
}

/* --- the list --- */

#define ROW true
#define OUT false

/* Q(name, unit, type, merge, row, json, page, meaning, value): value as the type takes it (the SET_ macros below); a:
 * the account, r: its result, c: its counters. */
// clang-format off
#define FRAME_QUANTITIES(Q) \
 Q(film_hash, "", HASH, SAME, ROW, "film_hash", NULL, "fingerprint of the film, 16 hex digits", \
   job_account_hash(a)) \
 Q(whole, "", TRUTH, OVER, OUT, "whole", NULL, "false: the render was interrupted, and this is the account of a part", \
   a->whole) \
 Q(wall_s, "s", REAL, MEDIAN, ROW, "wall_s", "wall_s", \
   "wall time of the frame; with render.pool off, making and joining threads too", job_account_wall_s(a)) \
 Q(cpu_s, "s", REAL, MEDIAN, ROW, "cpu_s", "cpu_s", "CPU time of the process over the same stretch", \
   job_account_cpu_s(a)) \
 Q(rays_camera, "rays", COUNT, SAME, ROW, "rays.camera", NULL, "camera rays traced", c->camera) \
 Q(rays_reflect, "rays", COUNT, SAME, ROW, "rays.reflect", NULL, "reflected rays traced", c->reflect) \
 Q(rays_refract, "rays", COUNT, SAME, ROW, "rays.refract", NULL, "refracted rays traced", c->refract) \
 Q(rays_shadow, "rays", COUNT, SAME, ROW, "rays.shadow", NULL, "shadow rays traced", c->shadow) \
 Q(rays_total, "rays", COUNT, SAME, ROW, "rays.total", "rays", "sum of the four kinds", ray_counters_total(c)) \
 Q(rays_by_depth, "rays", DEPTHS, SAME, ROW, "rays_by_depth", NULL, \
   "camera, reflected and refracted rays at depth 0;1;2;...", c->by_depth) \
 Q(total_internal, "", COUNT, SAME, ROW, "total_internal", NULL, "total internal reflections", c->total_internal) \
 Q(cut_depth, "rays", COUNT, SAME, ROW, "cut.depth.rays", NULL, \
   "rays not traced because they lie beyond the last depth", c->cut_depth) \
 Q(cut_depth_color, "rays", COLOR, SAME, OUT, "cut.depth.throughput", NULL, \
   "their throughput in red, green and blue, summed", take_cut(&v, c->cut_depth_throughput)) \
 Q(cut_depth_throughput, "rays", REAL, SAME, ROW, "cut.depth.throughput_mean", NULL, \
   "their throughput, mean of RGB, summed", mean_cut(c->cut_depth_throughput, NULL)) \
 Q(cut_weight, "rays", COUNT, SAME, ROW, "cut.weight.rays", NULL, \
   "rays not traced because they weigh less than render.min_weight", c->cut_weight) \
 Q(cut_weight_color, "rays", COLOR, SAME, OUT, "cut.weight.throughput", NULL, \
   "their throughput in red, green and blue, summed", take_cut(&v, c->cut_weight_throughput)) \
 Q(cut_weight_throughput, "rays", REAL, SAME, ROW, "cut.weight.throughput_mean", NULL, \
   "their throughput, mean of RGB, summed", mean_cut(c->cut_weight_throughput, NULL)) \
 Q(cut_throughput, "rays", REAL, SAME, OUT, "cut_throughput", NULL, \
   "throughput of all rays not traced, mean of RGB, summed", \
   mean_cut(c->cut_depth_throughput, c->cut_weight_throughput)) \
 Q(first_hits, "rays", SOLIDS, SAME, ROW, "first_hits", NULL, \
   "camera rays whose first interface is on that solid", c->first_hits) \
 Q(hits, "rays", SOLIDS, SAME, ROW, "hits", NULL, \
   "interfaces met on that solid by rays of all kinds but shadow rays", c->hits) \
 Q(tests, "rays", SOLIDS, SAME, OUT, "tests", NULL, "rays tested against that solid", c->tests) \
 Q(noise_rms, "radiance", REAL, SAME, ROW, "noise.rms", "noise", \
   "of random paths: root of the mean square of the film's standard error, over all its values, 1 is white; else NA", \
   render_noise_rms(r)) \
 Q(noise_variance, "radiance^2", COLOR, SAME, OUT, "noise.variance", NULL, \
   "of random paths: mean variance of the film's values by channel", take_variance(&v, r)) \
 Q(triangles, "", COUNT, SAME, ROW, "meshes.triangles", NULL, \
   "of all meshes as they stand there, copies counted; 0 without meshes", r->meshes.triangles) \
 Q(instances, "", COUNT, SAME, ROW, "meshes.instances", NULL, "copies of meshes", r->meshes.instances) \
 Q(accel_bytes, "B", COUNT, SAME, ROW, "meshes.accel_bytes", NULL, \
   "memory of the hierarchies over their triangles, each mesh once", r->meshes.bytes) \
 Q(bytes_per_triangle, "B", REAL, SAME, OUT, "meshes.bytes_per_triangle", NULL, \
   "accel_bytes / triangles", bytes_per_triangle(&r->meshes)) \
 Q(build_s, "s", REAL, LAST, ROW, "meshes.build_s", NULL, \
   "wall time of building these, for this frame (render.keep off) or before it; not in wall_s", r->meshes.build_s) \
 Q(motion_steps, "", COUNT, SAME, ROW, "meshes.motion_steps", NULL, \
   "steps and substeps of slimes from their beginnings to the moments that are shown; 0 without slimes", \
   r->meshes.motion_steps) \
 Q(motion_s, "s", REAL, LAST, ROW, "meshes.motion_s", NULL, \
   "wall time of these, for this frame (render.keep off) or before it; not in wall_s", r->meshes.motion_s) \
 Q(drawn, "", COUNT, SAME, ROW, "meshes.drawn", NULL, \
   "of the depth buffer: triangles in the picture, analytic solids' too; else 0", r->meshes.drawn) \
 Q(drawn_bytes, "B", COUNT, SAME, ROW, "meshes.drawn_bytes", NULL, \
   "memory of the depth buffer and of these triangles", r->meshes.raster_bytes) \
 Q(workers, "", COUNT, SAME, ROW, "workers", "threads", "threads of the frame", r->worker_count) \
 Q(workers_with_tiles, "", COUNT, LAST, ROW, "workers_with_tiles", NULL, "those that had a piece of the picture", \
   sum_workers(a).with_tiles) \
 Q(busy_s_mean, "s", REAL, LAST, ROW, "busy_s_mean", NULL, \
   "from a worker's first piece to its last ray, 0 without a piece; mean over all workers", sum_workers(a).busy_mean) \
 Q(busy_s_max, "s", REAL, LAST, ROW, "busy_s_max", NULL, "the longest of them", sum_workers(a).busy_max) \
 Q(waiting_s_mean, "s", REAL, LAST, ROW, "waiting_s_mean", NULL, \
   "wall_s less busy time, mean over all workers", sum_workers(a).waiting_mean) \
 Q(visibility_s_sum, "s", REAL, LAST, ROW, "visibility_s_sum", NULL, \
   "of all workers' busy time, finding out what rays meet and what stands in a light's way; NA for scenes without " \
   "meshes", sum_workers(a).visibility_sum) \
 Q(worker_cpu_s_sum, "s", REAL, LAST, ROW, "worker_cpu_s_sum", NULL, "CPU time of all workers", \
   sum_workers(a).cpu_sum) \
 Q(imbalance, "", REAL, LAST, ROW, "imbalance", NULL, "busy_s_max / busy_s_mean - 1", sum_workers(a).imbalance) \
 Q(peak_rss_bytes, "B", COUNT, OVER, ROW, "peak_rss_bytes", NULL, \
   "highest resident memory of the process: in a study since the frame began where Linux lets it be reset, else so " \
   "far", a->spent.peak_rss_bytes) \
 Q(voluntary_switches, "", COUNT, OVER, ROW, "voluntary_switches", NULL, \
   "context switches by waiting, whole process, during the frame", a->spent.voluntary_switches) \
 Q(involuntary_switches, "", COUNT, OVER, ROW, "involuntary_switches", NULL, \
   "context switches by losing the processor", a->spent.involuntary_switches) \
 Q(others_share, "", REAL, OVER, ROW, "others_share", NULL, \
   "share of the machine used by other processes meanwhile, 0..1; coarse under 0.1 s", usage_others_share(&a->spent)) \
 Q(cycles, "", COUNT, OVER, ROW, "hardware.cycles", NULL, \
   "hardware counter of the process over the frame, user mode", a->hardware.cycles) \
 Q(instructions, "", COUNT, OVER, ROW, "hardware.instructions", NULL, "hardware counter", a->hardware.instructions) \
 Q(branch_misses, "", COUNT, OVER, ROW, "hardware.branch_misses", NULL, "hardware counter", a->hardware.branch_misses) \
 Q(cache_misses, "", COUNT, OVER, ROW, "hardware.cache_misses", NULL, "hardware counter", a->hardware.cache_misses) \
 Q(isa, "", WORD, SAME, ROW, "isa", NULL, "vector instructions used: sse2, avx2, avx512", isa_name(a->level)) \
 Q(config, "", WORD, SAME, ROW, "config", NULL, "build: release, debug, sanitize, tsan, nocounters", \
   CUVETTE_COMPILER_FLAGS)

/* k: the worker's report. */
#define WORKER_QUANTITIES(Q) \
 Q(worker, "", COUNT, SAME, ROW, "worker", NULL, "number of the worker, from 0", worker) \
 Q(pu, "", NUMBER, LAST, ROW, "pu", NULL, "processing unit that it ended on (the system's number)", k->pu) \
 Q(tiles, "", COUNT, LAST, ROW, "tiles", NULL, "pieces of the picture that it took", k->tiles) \
 Q(rays_total, "rays", COUNT, LAST, ROW, "rays.total", NULL, "rays of all kinds that it traced", \
   k->camera + k->reflect + k->refract + k->shadow) \
 Q(rays_camera, "rays", COUNT, LAST, ROW, "rays.camera", NULL, "camera rays among them", k->camera) \
 Q(rays_reflect, "rays", COUNT, LAST, ROW, "rays.reflect", NULL, "reflected rays among them", k->reflect) \
 Q(rays_refract, "rays", COUNT, LAST, ROW, "rays.refract", NULL, "refracted rays among them", k->refract) \
 Q(rays_shadow, "rays", COUNT, LAST, ROW, "rays.shadow", NULL, "shadow rays among them", k->shadow) \
 Q(start_s, "s", REAL, LAST, ROW, "start_s", NULL, "when it began to work, after the frame's start", k->start_s) \
 Q(wall_s, "s", REAL, LAST, ROW, "wall_s", NULL, "from its first instruction to its last in the frame", k->wall_s) \
 Q(cpu_s, "s", REAL, LAST, ROW, "cpu_s", NULL, "its CPU time over the same stretch", k->cpu_s) \
 Q(busy_s, "s", REAL, LAST, ROW, "busy_s", NULL, \
   "from its first piece taken to its last ray traced; 0 without a piece", k->busy_s) \
 Q(visibility_s, "s", REAL, LAST, ROW, "visibility_s", NULL, \
   "of busy_s: finding out what rays meet and what stands in a light's way; NA for scenes without meshes", \
   k->visibility_s) \
 Q(waiting_s, "s", REAL, LAST, ROW, "waiting_s", NULL, "wall time of the frame less busy_s", k->waiting_s)
// clang-format on

/* --- readers --- */

#define SET_COUNT(value) v.count = (int64_t)(value)
#define SET_NUMBER(value) SET_COUNT(value)
#define SET_TRUTH(value) SET_COUNT(value)
#define SET_REAL(value) v.real[0] = (value)
#define SET_COLOR(value) value
#define SET_HASH(value) v.hash = (value)
/* Up to a colon: "release" of "release: -O3 ...". */
#define SET_WORD(value) snprintf(v.word, sizeof v.word, "%.*s", (int)strcspn(value, ":"), value)
#define SET_DEPTHS(value) v.list = (value), v.size = depths_of(a)
#define SET_SOLIDS(value) v.list = (value), v.size = solids_of(a)

#define FRAME_READER(name, unit, type, merge, row, json, page, meaning, value) \
    static quantity_value read_##name(const job_account *a, int worker)        \
    {                                                                          \
        const render_result *r = a->result;                                    \
        const ray_counters *c = &r->counters;                                  \
        quantity_value v = {.count = 0};                                       \
        (void)worker, (void)c;                                                 \
        SET_##type(value);                                                     \
        return v;                                                              \
    }
#define WORKER_READER(name, unit, type, merge, row, json, page, meaning, value) \
    static quantity_value read_worker_##name(const job_account *a, int worker)  \
    {                                                                           \
        const worker_report *k = &a->result->workers[worker];                   \
        quantity_value v = {.count = 0};                                        \
        (void)k;                                                                \
        SET_##type(value);                                                      \
        return v;                                                               \
    }
#define FRAME_ENTRY(name, unit, type, merge, row, json, page, meaning, value) \
    {#name, unit, meaning, QUANTITY_##type, QUANTITY_##merge, row, json, page, read_##name},
#define WORKER_ENTRY(name, unit, type, merge, row, json, page, meaning, value) \
    {#name, unit, meaning, QUANTITY_##type, QUANTITY_##merge, row, json, page, read_worker_##name},

FRAME_QUANTITIES(FRAME_READER)
WORKER_QUANTITIES(WORKER_READER)

const quantity frame_quantities[] = {FRAME_QUANTITIES(FRAME_ENTRY)};
const size_t frame_quantity_count = sizeof frame_quantities / sizeof frame_quantities[0];
const quantity worker_quantities[] = {WORKER_QUANTITIES(WORKER_ENTRY)};
const size_t worker_quantity_count = sizeof worker_quantities / sizeof worker_quantities[0];

const quantity *frame_quantity(const char *name)
{
    for (size_t i = 0; i < frame_quantity_count; i++)
        if (strcmp(frame_quantities[i].name, name) == 0)
            return &frame_quantities[i];
    return NULL;
}
