/* The renderer: renders frames of a scene on a pool of workers. The film depends only on the scene and its parameters,
 * and not on threads, schedule, tile, pinning, batch or instruction set. Ownership: a renderer owns its pool, and may
 * serve many frames and scenes, one at a time; the caller owns a result and releases it with render_result_destroy. No
 * global state: several renderers may run in one process. */
#pragma once

#include "base/counters.h"
#include "base/isa.h"
#include "base/status.h"
#include "measure/topology.h"
#include "measure/usage.h"
#include "render/plan/film.h"
#include "render/plan/schedule.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include <stdbool.h>

typedef struct renderer renderer;

/* --- renderer.c: threads --- */

/* level: from isa_choose. machine is borrowed for pinning; if it is NULL, threads are not pinned. */
status renderer_create(isa level, const topology *machine, renderer **out, diagnostic *why);
void renderer_destroy(renderer *r);

/* Sets the machine of a renderer that was created without it. */
void renderer_set_machine(renderer *r, const topology *machine);

/* --- options and results --- */

/* One worker's report of a frame; times in seconds. */
typedef struct worker_report {
    double wall_s;  /* from its first to its last instruction in this frame */
    double cpu_s;   /* CLOCK_THREAD_CPUTIME_ID over the same interval */
    double start_s; /* when it began to work, counted from the frame's start */
    double busy_s;  /* from its first tile to its last ray; 0 without a tile */
    /* part of busy_s spent in visibility queries (nearest hits and shadows); NaN for scenes without meshes */
    double visibility_s;
    double waiting_s;                          /* the frame's wall time minus busy_s */
    int rank;                                  /* number of its process, if several render the frame; else 0 */
    uint64_t tiles;                            /* tiles that it rendered */
    uint64_t camera, reflect, refract, shadow; /* rays that it traced */
    int pu;                                    /* processing unit at the end; -1: unknown */
    thread_usage usage;                        /* over the interval of wall_s; unknown unless requested */
} worker_report;

typedef struct tile_event {
    int worker;
    int x0, y0, x1, y1;
    double begin_s, end_s;
} tile_event;

/* A source of tiles, for a frame that several processes render: this process renders the tiles of its source, each into
 * a film of one tile, and the result has no film. All workers call both functions, possibly at the same time. */
typedef struct tile_source {
    int side; /* the largest width and height of a tile */
    /* Waits for the worker's next tile; false: there is none, and the worker's part of the frame ends. */
    bool (*next)(void *context, int worker, image_tile *out);
    /* Receives a rendered tile: its film, with all replicates added, and the variance of its values, or NULL. Both are
     * borrowed for the call. */
    void (*done)(void *context, const image_tile *tile, const film *traced, const double *variance);
    void *context;
} tile_source;

/* Outputs of a render in addition to the film. */
typedef struct render_options {
    bool pixel_rays; /* rays of all kinds by pixel */
    bool pixel_time; /* nanoseconds by pixel; a batch's time is divided among its rays */
    bool pixel_cut;  /* throughput of the rays that are not traced, by pixel: see render_result */
    bool layers;     /* named layers, if the integrator supports them */
    bool timeline;   /* the worker and times of each tile */
    bool usage; /* times for which each worker ran, was ready to run, and was blocked; costs about 20 us per worker */
    /* Called every progress_s seconds (0: 0.1) on the thread that called renderer_render. May be NULL. */
    void (*progress)(void *context, double fraction_done);
    double progress_s;
    /* Seconds, below 1, between two polls of the calling thread for cancellation and progress; 0: 0.02. A poll costs
     * instructions, and their number varies with the load, so callers that count instructions poll rarely. */
    double watch_s;
    /* Called by the worker that traced the last ray of a tile (x0 <= x < x1, y0 <= y < y1), possibly by several threads
     * at the same time; the callback may read the film in the tile. With a callback, batches are not filled across
     * tiles, which costs time but leaves the film bit-identical. May be NULL. */
    void (*tile_done)(void *context, const film *img, int x0, int y0, int x1, int y1);
    void *context;
    /* NULL: all tiles. It cannot be combined with maps, layers, tile_done, or render.error. */
    const tile_source *source;
} render_options;

/* One of the processes that render a frame; its workers have its number as `rank`. */
typedef struct rank_usage {
    double wall_s, cpu_s;                 /* as in render_result, for this process */
    uint64_t peak_rss_bytes;              /* of the process so far */
    uint64_t tiles_sent, tile_bytes_sent; /* sent to rank 0 */
} rank_usage;

/* The result of a frame. Under render.error, counts of rays and times include the pilot; the maps do not. */
typedef struct render_result {
    film *img;             /* NULL if the tiles came from a source */
    ray_counters counters; /* sums over all workers */
    /* from the start of the workers to the end of the last worker; with render.pool off, including creating and joining
     * them */
    double wall_s;
    double cpu_s; /* CPU time of the process over the same interval */
    int worker_count;
    worker_report *workers;
    double *pixel_rays; /* NULL unless requested; width * height */
    double *pixel_ns;
    /* the fraction of each pixel's weight whose light is unknown: the throughput, mean of RGB, of its rays that
     * render.depth or render.min_weight cut off, relative to the throughput of its camera rays */
    double *pixel_cut;
    /* For random paths: square of the standard error of each film value, [(y * width + x) * 3 + channel] in the film's
     * colour space, from the differences between the replicates (render/plan/sampling.h). NULL if unknown. For a
     * spectral film under render.sampler=philox it is an overestimate: each replicate has its own wavelengths, so that
     * they differ by more than random noise. */
    double *variance;
    int replicates;     /* of the paths of a pixel, 1 if the variance is unknown */
    tile_event *events; /* in order of begin_s; NULL unless requested */
    size_t event_count;
    mesh_report meshes;
    layer_set *layers;   /* NULL unless requested and supported */
    photon_shortage few; /* of render.caustics */
    /* by rank, if several processes render the frame; else NULL */
    rank_usage *ranks;
    int rank_count, tile; /* tile: the side of the ranks' tiles */
    uint64_t scene_bytes; /* sent to each rank */
} render_result;

/* --- render_result.c: results --- */

/* Root of the mean variance over pixels and channels: the typical random error of a film value. NaN without random
 * paths, or with too few paths for an estimate. */
double render_noise_rms(const render_result *result);
void render_result_destroy(render_result *result);

/* --- renderer.c: renders --- */

/* Checks the scene and renders one frame of it; call scene_load first. STATUS_INTERRUPTED when cancelled: *out then
 * holds the finished part, under render.error perhaps of the pilot. */
status renderer_render(renderer *r, const scene *s, const render_options *options, render_result **out,
                       diagnostic *why);

/* --- render_result.c: memory --- */

/* Creates the film, with one replicate, and the variance (NULL if it is unknown) of a frame whose tiles come from tile
 * sources. The caller owns both. */
status renderer_film(const scene *s, film **img, double **variance, diagnostic *why);
/* The replicates of the paths of a pixel, as in a result. */
int renderer_replicates(const scene *s);

/* Memory of the film and the maps of a frame with these options, bytes. */
uint64_t renderer_result_bytes(const scene *s, const render_options *options);

/* Memory of all threads' tracers, and of photons, bytes. */
uint64_t renderer_tracing_bytes(const scene *s);

/* --- frame.c --- */

/* With render.pool on, starts the threads that s requires, so that the first frame's time does not include their
 * start. */
status renderer_prepare(renderer *r, const scene *s, diagnostic *why);

/* --- renderer.c: adaptive numbers of random paths --- */

/* With render.error a pilot render of PILOT_PATHS paths per pixel gives the variance of each pixel, from which the
 * number of paths for the requested standard error follows. The pilot's paths do not enter the film: a mean that stops
 * when its own samples look good is biased (Kirk and Arvo, "Unbiased sampling techniques for image synthesis", SIGGRAPH
 * 1991). The caller owns and frees the counts. */
enum { PILOT_PATHS = 16 };

/* Whether the number of paths differs between pixels. */
static inline bool path_counts_apply(const render_settings *r)
{
    return integrator_traits_of(r)->by_chance && r->error > 0.0 && r->paths > PILOT_PATHS;
}

/* The settings of the pilot: a seed that no scene has. */
render_settings path_counts_pilot(const render_settings *r);

/* The number of paths of each pixel: a multiple of the replicates of r, at most r->paths. */
status path_counts_create(const render_settings *r, const render_result *pilot, uint32_t **out, diagnostic *why);

/* --- render_result.c: a frame whose tiles several processes render --- */

/* The processes are, for example, the ranks of an MPI job or the workers of a browser, each with a tile_source. The
 * film is bit-identical to the film of one process. Ownership: tiled_frame_begin allocates film and variance;
 * tiled_frame_release frees them, unless the owner keeps them and sets them to NULL. For one thread at a time. */

/* Settings that give all processes the same tiles, with that side, whatever their numbers of threads. */
render_settings tiles_settings(const render_settings *r, int side);

typedef struct tiled_frame {
    schedule places; /* positions of the tiles */
    film *img;
    double *variance; /* NULL: unknown */
} tiled_frame;

status tiled_frame_begin(const scene *s, int side, tiled_frame *out, diagnostic *why);
void tiled_frame_release(tiled_frame *f);

/* The number of values of a rendered tile: its sums, 3 per pixel, then as many variances (doubles) if there are any. */
size_t tiled_frame_values(const tiled_frame *f, int64_t tile);
/* Copies a rendered tile into the film. */
void tiled_frame_store(tiled_frame *f, int64_t tile, const int64_t *values);
