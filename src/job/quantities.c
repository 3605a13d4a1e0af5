/* The table of quantities and the functions that read them from an account. */
#include "job/quantities.h"
#include "render/frame/renderer.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#ifndef CUVETTE_COMPILER_FLAGS
#define CUVETTE_COMPILER_FLAGS "unknown"
#endif

/* --- readers that need more than an expression --- */

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

/* Converts throughput from the counters' fixed point, in which COUNTERS_CUT_ONE is 1. */
static void set_cut(quantity_value *v, const int64_t throughput[3])
{
    for (int channel = 0; channel < 3; channel++)
        v->real[channel] = (double)throughput[channel] / COUNTERS_CUT_ONE;
}

/* The mean over the channels of the throughput of rays that were cut for one reason, or for two; other may be NULL. */
static double mean_cut(const int64_t one[3], const int64_t other[3])
{
    double sum = 0;
    for (int channel = 0; channel < 3; channel++)
        sum += (double)one[channel] + (other ? (double)other[channel] : 0.0);
    return sum / (3 * COUNTERS_CUT_ONE);
}

/* The throughput that was cut as a fraction of the throughput of the camera rays. The camera rays of a pixel have
 * throughput 1 in total, 0.5 behind an analyser; the pilot of render.error adds the same once more. */
static double cut_fraction(const job_account *a)
{
    const render_settings *r = &a->of->render;
    const ray_counters *c = &a->result->counters;
    const double initial = r->polarisation && a->of->camera.analyser != ANALYSER_NONE ? 0.5 : 1.0,
                 passes = path_counts_apply(r) ? 2.0 : 1.0;
    return mean_cut(c->cut_depth_throughput, c->cut_weight_throughput) /
           ((double)r->width * (double)r->height * initial * passes);
}

static double largest_cut(const render_result *r)
{
    const size_t pixels = r->pixel_cut ? (size_t)r->img->width * (size_t)r->img->height : 0;
    double largest = pixels > 0 ? 0.0 : (double)NAN;
    for (size_t i = 0; i < pixels; i++)
        largest = fmax(largest, r->pixel_cut[i]);
    return largest;
}

/* Mean over all pixels, by channel; NaN without random paths. */
static void set_variance(quantity_value *v, const render_result *r)
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

/* -1, unknown, unless the frame counted its tests. */
static int64_t counted(const job_account *a, uint64_t count)
{
    return CUVETTE_COUNTERS && a->of->render.count_tests ? (int64_t)count : -1;
}

/* --- the list --- */

#define IN_ROWS true
#define JSON_ONLY false

/* Q(name, unit, type, merge, row, json, page, meaning, value): value in the form that the type requires (the SET_
 * macros below); a: the account, r: its result, c: its counters. */
// clang-format off
#define FRAME_QUANTITIES(Q) \
 Q(film_hash, "", HASH, SAME, IN_ROWS, "film_hash", NULL, "hash of the film, 16 hex digits", \
   job_account_hash(a)) \
 Q(complete, "", TRUTH, OVER, JSON_ONLY, "complete", NULL, \
   "false: the render was interrupted, and the numbers cover only its finished part", \
   a->complete) \
 Q(wall_s, "s", REAL, MEDIAN, IN_ROWS, "wall_s", "wall_s", \
   "wall time of the frame; with render.pool off, including creating and joining threads", job_account_wall_s(a)) \
 Q(cpu_s, "s", REAL, MEDIAN, IN_ROWS, "cpu_s", "cpu_s", "CPU time of the process over the same interval", \
   job_account_cpu_s(a)) \
 Q(rays_camera, "rays", COUNT, SAME, IN_ROWS, "rays.camera", NULL, "camera rays traced", c->camera) \
 Q(rays_reflect, "rays", COUNT, SAME, IN_ROWS, "rays.reflect", NULL, "reflected rays traced", c->reflect) \
 Q(rays_refract, "rays", COUNT, SAME, IN_ROWS, "rays.refract", NULL, "refracted rays traced", c->refract) \
 Q(rays_shadow, "rays", COUNT, SAME, IN_ROWS, "rays.shadow", NULL, "shadow rays traced", c->shadow) \
 Q(rays_photon, "rays", COUNT, SAME, IN_ROWS, "rays.photon", NULL, \
   "rays of photons, traced from the lamps for caustics", c->photon) \
 Q(rays_total, "rays", COUNT, SAME, IN_ROWS, "rays.total", "rays", "sum of the five kinds", ray_counters_total(c)) \
 Q(rays_by_depth, "rays", DEPTHS, SAME, IN_ROWS, "rays_by_depth", NULL, \
   "camera, reflected and refracted rays at depth 0;1;2;...", c->by_depth) \
 Q(total_internal, "", COUNT, SAME, IN_ROWS, "total_internal", NULL, "total internal reflections", c->total_internal) \
 Q(cut_depth, "rays", COUNT, SAME, IN_ROWS, "cut.depth.rays", NULL, \
   "rays not traced because of the depth limit, render.depth", c->cut_depth) \
 Q(cut_depth_color, "rays", COLOR, SAME, JSON_ONLY, "cut.depth.throughput", NULL, \
   "summed throughput of the rays that the depth limit cut, in red, green and blue", \
   set_cut(&v, c->cut_depth_throughput)) \
 Q(cut_depth_throughput, "rays", REAL, SAME, IN_ROWS, "cut.depth.throughput_mean", NULL, \
   "summed throughput of the rays that the depth limit cut, mean of RGB", mean_cut(c->cut_depth_throughput, NULL)) \
 Q(cut_weight, "rays", COUNT, SAME, IN_ROWS, "cut.weight.rays", NULL, \
   "rays not traced because their weight is below render.min_weight", c->cut_weight) \
 Q(cut_weight_color, "rays", COLOR, SAME, JSON_ONLY, "cut.weight.throughput", NULL, \
   "summed throughput of the rays that render.min_weight cut, in red, green and blue", \
   set_cut(&v, c->cut_weight_throughput)) \
 Q(cut_weight_throughput, "rays", REAL, SAME, IN_ROWS, "cut.weight.throughput_mean", NULL, \
   "summed throughput of the rays that render.min_weight cut, mean of RGB", mean_cut(c->cut_weight_throughput, NULL)) \
 Q(cut_throughput, "rays", REAL, SAME, JSON_ONLY, "cut_throughput", NULL, \
   "summed throughput of all rays not traced, mean of RGB", \
   mean_cut(c->cut_depth_throughput, c->cut_weight_throughput)) \
 Q(cut_fraction, "", REAL, SAME, IN_ROWS, "cut.fraction", "cut", \
   "fraction of a pixel's light that is missing because rays were cut: their throughput divided by the throughput " \
   "of the camera rays, mean over all pixels, 0..1", \
   cut_fraction(a)) \
 Q(cut_fraction_largest, "", REAL, LAST, JSON_ONLY, "cut.fraction_largest", NULL, \
   "cut.fraction of the pixel that lacks most light; NA without the map of cut light", largest_cut(r)) \
 Q(first_hits, "rays", SOLIDS, SAME, IN_ROWS, "first_hits", NULL, \
   "camera rays whose first interface is on the solid", c->first_hits) \
 Q(hits, "rays", SOLIDS, SAME, IN_ROWS, "hits", NULL, \
   "hits on interfaces of the solid by camera, reflected and refracted rays", c->hits) \
 Q(tests, "rays", SOLIDS, SAME, JSON_ONLY, "tests", NULL, "rays tested against the solid", c->tests) \
 Q(query_rays, "rays", COUNT, SAME, IN_ROWS, "queries.rays", NULL, \
   "queries of a mesh's hierarchy by one ray each; NA without render.count_tests, like the other counts of queries", \
   counted(a, c->queries.rays)) \
 Q(query_nodes, "", COUNT, SAME, IN_ROWS, "queries.nodes", NULL, \
   "nodes that these rays enter: inner nodes of a BVH, spheres of a tree of spheres", counted(a, c->queries.nodes)) \
 Q(query_boxes, "", COUNT, SAME, IN_ROWS, "queries.boxes", NULL, \
   "boxes, or spheres, that these rays test, each ray as if it were traversed alone", counted(a, c->queries.boxes)) \
 Q(query_triangles, "", COUNT, SAME, IN_ROWS, "queries.triangles", NULL, \
   "triangles that these rays test, each ray as if it were traversed alone", counted(a, c->queries.triangles)) \
 Q(noise_rms, "radiance", REAL, SAME, IN_ROWS, "noise.rms", "noise", \
   "standard error of the film's values, root mean square, 1 is white; NA without random paths", \
   render_noise_rms(r)) \
 Q(noise_variance, "radiance^2", COLOR, SAME, JSON_ONLY, "noise.variance", NULL, \
   "mean variance of the film's values by channel; NA without random paths", set_variance(&v, r)) \
 Q(triangles, "", COUNT, SAME, IN_ROWS, "meshes.triangles", NULL, \
   "triangles in all instances of all meshes; 0 without meshes", r->meshes.triangles) \
 Q(instances, "", COUNT, SAME, IN_ROWS, "meshes.instances", NULL, "instances of meshes", r->meshes.instances) \
 Q(accel_bytes, "B", COUNT, SAME, IN_ROWS, "meshes.accel_bytes", NULL, \
   "memory of the meshes' hierarchies, each mesh counted once", r->meshes.bytes) \
 Q(bytes_per_triangle, "B", REAL, SAME, JSON_ONLY, "meshes.bytes_per_triangle", NULL, \
   "accel_bytes / triangles", bytes_per_triangle(&r->meshes)) \
 Q(build_s, "s", REAL, LAST, IN_ROWS, "meshes.build_s", NULL, \
   "wall time of building the hierarchies, for this frame (render.keep off) or before it; not part of wall_s", \
   r->meshes.build_s) \
 Q(motion_steps, "", COUNT, SAME, IN_ROWS, "meshes.motion_steps", NULL, \
   "simulation steps and substeps of slimes from their initial states to the rendered times; 0 without slimes", \
   r->meshes.motion_steps) \
 Q(motion_s, "s", REAL, LAST, IN_ROWS, "meshes.motion_s", NULL, \
   "wall time of the slimes' steps, for this frame (render.keep off) or before it; not part of wall_s", \
   r->meshes.motion_s) \
 Q(drawn, "", COUNT, SAME, IN_ROWS, "meshes.drawn", NULL, \
   "triangles rasterised into the depth buffer, including those of analytic solids; 0 without a depth buffer", \
   r->meshes.drawn) \
 Q(drawn_bytes, "B", COUNT, SAME, IN_ROWS, "meshes.drawn_bytes", NULL, \
   "memory of the depth buffer and of the rasterised triangles", r->meshes.raster_bytes) \
 Q(workers, "", COUNT, SAME, IN_ROWS, "workers", "threads", "worker threads of the frame", r->worker_count) \
 Q(workers_with_tiles, "", COUNT, LAST, IN_ROWS, "workers_with_tiles", NULL, \
   "workers that rendered at least one tile", \
   sum_workers(a).with_tiles) \
 Q(busy_s_mean, "s", REAL, LAST, IN_ROWS, "busy_s_mean", NULL, \
   "time from a worker's first tile to its last ray, 0 without a tile; mean over all workers", \
   sum_workers(a).busy_mean) \
 Q(busy_s_max, "s", REAL, LAST, IN_ROWS, "busy_s_max", NULL, "largest busy time of a worker", sum_workers(a).busy_max) \
 Q(waiting_s_mean, "s", REAL, LAST, IN_ROWS, "waiting_s_mean", NULL, \
   "wall_s minus busy time, mean over all workers", sum_workers(a).waiting_mean) \
 Q(visibility_s_sum, "s", REAL, LAST, IN_ROWS, "visibility_s_sum", NULL, \
   "time in visibility queries (nearest hits and shadows), sum over all workers; NA for scenes without meshes", \
   sum_workers(a).visibility_sum) \
 Q(worker_cpu_s_sum, "s", REAL, LAST, IN_ROWS, "worker_cpu_s_sum", NULL, \
   "CPU time, sum over all workers", sum_workers(a).cpu_sum) \
 Q(imbalance, "", REAL, LAST, IN_ROWS, "imbalance", NULL, "busy_s_max / busy_s_mean - 1", sum_workers(a).imbalance) \
 Q(peak_rss_bytes, "B", COUNT, OVER, IN_ROWS, "peak_rss_bytes", NULL, \
   "peak resident memory of the process so far; in a study, since the start of the frame if Linux allows a reset", \
   a->spent.peak_rss_bytes) \
 Q(voluntary_switches, "", COUNT, OVER, IN_ROWS, "voluntary_switches", NULL, \
   "voluntary context switches of the process during the frame", a->spent.voluntary_switches) \
 Q(involuntary_switches, "", COUNT, OVER, IN_ROWS, "involuntary_switches", NULL, \
   "involuntary context switches of the process during the frame", a->spent.involuntary_switches) \
 Q(others_fraction, "", REAL, OVER, IN_ROWS, "others_fraction", NULL, \
   "fraction of the machine used by other processes, 0..1, during the frame, at least during the 0.5 s before its " \
   "end; includes steal_fraction", \
   a->noise.others_fraction) \
 Q(steal_fraction, "", REAL, OVER, IN_ROWS, "steal_fraction", NULL, \
   "fraction of the machine that a hypervisor withheld, 0..1, over the same interval as others_fraction", \
   a->noise.steal_fraction) \
 Q(frequency_hz, "Hz", REAL, OVER, IN_ROWS, "frequency_hz", NULL, \
   "clock frequency at the end of the frame, the highest of 16 units; NA if the system does not report it", \
   a->noise.frequency_hz) \
 Q(frequency_drop, "", REAL, OVER, IN_ROWS, "frequency_drop", NULL, \
   "fraction by which frequency_hz is below the highest frequency so far in the process, 0..1", \
   a->noise.frequency_drop) \
 Q(stalled_fraction, "", REAL, LAST, IN_ROWS, "stalled_fraction", NULL, \
   "fraction of the workers' time in which they did not run although they had work: stopped (Ctrl-Z), frozen or " \
   "throttled by a control group, or without a processing unit; a lower bound if there are more workers than units", \
   a->noise.stalled_fraction) \
 Q(cycles, "", COUNT, OVER, IN_ROWS, "hardware.cycles", NULL, \
   "processor cycles of the process during the frame, user mode (hardware counter)", a->hardware.cycles) \
 Q(instructions, "", COUNT, OVER, IN_ROWS, "hardware.instructions", NULL, \
   "instructions of the process during the frame, user mode (hardware counter)", \
   a->hardware.instructions) \
 Q(branch_misses, "", COUNT, OVER, IN_ROWS, "hardware.branch_misses", NULL, \
   "mispredicted branches, user mode (hardware counter)", \
   a->hardware.branch_misses) \
 Q(cache_misses, "", COUNT, OVER, IN_ROWS, "hardware.cache_misses", NULL, \
   "cache misses, user mode (hardware counter)", a->hardware.cache_misses) \
 Q(isa, "", WORD, SAME, IN_ROWS, "isa", NULL, "instruction set of the kernels: sse2, avx2, avx512", \
   isa_name(a->level)) \
 Q(config, "", WORD, SAME, IN_ROWS, "config", NULL, "build configuration: release, debug, sanitize, tsan, nocounters", \
   CUVETTE_COMPILER_FLAGS)

/* k: the worker's report. */
#define WORKER_QUANTITIES(Q) \
 Q(worker, "", COUNT, SAME, IN_ROWS, "worker", NULL, "number of the worker, counted from 0", worker) \
 Q(rank, "", COUNT, LAST, JSON_ONLY, "rank", NULL, \
   "rank of the worker's process among those that render the frame (cuvette-mpi)", k->rank) \
 Q(pu, "", NUMBER, LAST, IN_ROWS, "pu", NULL, "processing unit at the end of the frame (OS index)", k->pu) \
 Q(tiles, "", COUNT, LAST, IN_ROWS, "tiles", NULL, "tiles rendered", k->tiles) \
 Q(rays_total, "rays", COUNT, LAST, IN_ROWS, "rays.total", NULL, "rays of all kinds traced by this worker", \
   k->camera + k->reflect + k->refract + k->shadow) \
 Q(rays_camera, "rays", COUNT, LAST, IN_ROWS, "rays.camera", NULL, "camera rays traced by this worker", k->camera) \
 Q(rays_reflect, "rays", COUNT, LAST, IN_ROWS, "rays.reflect", NULL, \
   "reflected rays traced by this worker", k->reflect) \
 Q(rays_refract, "rays", COUNT, LAST, IN_ROWS, "rays.refract", NULL, \
   "refracted rays traced by this worker", k->refract) \
 Q(rays_shadow, "rays", COUNT, LAST, IN_ROWS, "rays.shadow", NULL, "shadow rays traced by this worker", k->shadow) \
 Q(start_s, "s", REAL, LAST, IN_ROWS, "start_s", NULL, "start of its work, relative to the frame's start", k->start_s) \
 Q(wall_s, "s", REAL, LAST, IN_ROWS, "wall_s", NULL, "wall time from its first to its last instruction in the frame", \
   k->wall_s) \
 Q(cpu_s, "s", REAL, LAST, IN_ROWS, "cpu_s", NULL, "CPU time of the thread over the same interval", k->cpu_s) \
 Q(busy_s, "s", REAL, LAST, IN_ROWS, "busy_s", NULL, \
   "time from its first tile to its last ray; 0 without a tile", k->busy_s) \
 Q(visibility_s, "s", REAL, LAST, IN_ROWS, "visibility_s", NULL, \
   "part of busy_s spent in visibility queries (nearest hits and shadows); NA for scenes without meshes", \
   k->visibility_s) \
 Q(waiting_s, "s", REAL, LAST, IN_ROWS, "waiting_s", NULL, "wall time of the frame minus busy_s", k->waiting_s) \
 Q(running_s, "s", REAL, LAST, IN_ROWS, "running_s", NULL, \
   "part of wall_s in which the thread ran: its CPU time, read together with the next four columns", \
   k->usage.running_s) \
 Q(runnable_s, "s", REAL, LAST, IN_ROWS, "runnable_s", NULL, \
   "part of wall_s in which the thread could run, and waited for a processing unit (Linux, schedstat)", \
   k->usage.runnable_s) \
 Q(blocked_s, "s", REAL, LAST, IN_ROWS, "blocked_s", NULL, \
   "the rest of wall_s: the thread waited for something other than a processing unit", k->usage.blocked_s) \
 Q(voluntary_switches, "", COUNT, LAST, IN_ROWS, "voluntary_switches", NULL, \
   "times that the thread gave up its processing unit because it was blocked", k->usage.voluntary_switches) \
 Q(involuntary_switches, "", COUNT, LAST, IN_ROWS, "involuntary_switches", NULL, \
   "times that the kernel took the processing unit from the running thread", k->usage.involuntary_switches)
// clang-format on

/* --- readers --- */

#define SET_COUNT(value) v.count = (int64_t)(value)
#define SET_NUMBER(value) SET_COUNT(value)
#define SET_TRUTH(value) SET_COUNT(value)
#define SET_REAL(value) v.real[0] = (value)
#define SET_COLOR(value) value
#define SET_HASH(value) v.hash = (value)
/* The text before a colon: "release" of "release: -O3 ...". */
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
