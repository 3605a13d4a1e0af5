/* Renders a scene: camera rays, Whitted's recursion, Phong's local light, on a pool of workers. The film depends on the
 * scene and its parameters alone (design, decision 5): not on threads, schedule, tile, pinning, batch or instruction
 * set. Ownership: a renderer owns its pool, and may serve many frames and scenes, one at a time; a result is the
 * caller's, release it with render_result_destroy. No global state: several renderers may run in one process. */
#pragma once

#include "base/counters.h"
#include "base/isa.h"
#include "base/status.h"
#include "measure/topology.h"
#include "render/core/film.h"
#include "render/core/layers.h"
#include "render/core/mesh_report.h"
#include "scene/model/open.h"
#include <stdbool.h>

typedef struct renderer renderer;

/* level: from isa_choose. machine is borrowed for pinning; it may be NULL, then nothing is pinned. */
status renderer_create(isa level, const topology *machine, renderer **out, diagnostic *why);
void renderer_destroy(renderer *r);

/* The same machine, known later. */
void renderer_know_machine(renderer *r, const topology *machine);

/* One worker's account of a frame; seconds from the frame's start. */
typedef struct worker_report {
    double wall_s;       /* from its first instruction to its last in this frame */
    double cpu_s;        /* CLOCK_THREAD_CPUTIME_ID over the same stretch */
    double start_s;      /* when it began to work, after the frame's start */
    double busy_s;       /* from its first tile taken to its last ray traced; 0 without a tile */
    double visibility_s; /* of busy_s: finding out what rays meet and what stands in a light's way; NaN for scenes
                            without meshes */
    double waiting_s;    /* the frame's wall time less busy_s */
    uint64_t tiles;      /* pieces of the picture that it took */
    uint64_t camera, reflect, refract, shadow; /* rays that it traced */
    int pu;                                    /* processing unit it ended on; -1 unknown */
} worker_report;

typedef struct tile_event {
    int worker;
    int x0, y0, x1, y1;
    double begin_s, end_s;
} tile_event;

/* What is wanted beside the film. */
typedef struct render_options {
    bool pixel_rays; /* rays of all kinds by pixel */
    bool pixel_time; /* nanoseconds by pixel; a batch's time is shared among its rays */
    bool layers;     /* named layers, of an integrator that gives them */
    bool timeline;   /* when each tile was taken, and by whom */
    /* Called every progress_s (0: 0.1) seconds from the thread that called render; return false to stop the frame. May
     * be NULL. */
    bool (*progress)(void *context, double share_done);
    double progress_s;
    /* Called by the worker that has traced the last ray of a piece of the picture (x0 <= x < x1, y0 <= y < y1), so by
     * different threads at the same time; the film may be read there. Batches are then not filled up across pieces,
     * which costs time and changes no bit. May be NULL. */
    void (*piece_done)(void *context, const film *img, int x0, int y0, int x1, int y1);
    void *context;
} render_options;

typedef struct render_result {
    film *img;
    ray_counters counters; /* summed over workers */
    /* from the release of the workers to the end of the last; with pool off, their creation and join too */
    double wall_s;
    double cpu_s; /* of the process over the same stretch */
    int worker_count;
    worker_report *workers;
    double *pixel_rays; /* NULL unless wanted; width * height */
    double *pixel_ns;
    /* Of random paths: square of the standard error of each value of the film, [(y * width + x) * 3 + channel] in the
     * film's own space, from how 8 equal shares of the paths differ, or as many fewer as divide paths / samples. NULL
     * where it is not known. Of a spectral film too large rather than too small: the shares have wavelengths of their
     * own, which differ by more than chance. */
    double *variance;
    tile_event *events; /* in order of begin_s; NULL unless wanted */
    size_t event_count;
    mesh_report meshes;
    layer_set *layers; /* NULL unless wanted and given */
} render_result;

/* Root of the mean variance over pixels and channels: how far off a value of the film typically is by chance. NaN where
 * nothing is drawn by chance, or too few paths tell. */
double render_noise_rms(const render_result *result);

/* scene_load must have been called. STATUS_INTERRUPTED when progress returned false: *out then holds what was done. */
status renderer_render(renderer *r, const scene *s, const render_options *options, render_result **out,
                       diagnostic *why);
void render_result_destroy(render_result *result);

/* What the film and the maps of such a frame take. */
uint64_t renderer_result_bytes(const scene *s, const render_options *options);

/* Makes the pool as large as s asks for beforehand (render.pool on), so that the first frame does not pay for it. */
status renderer_prepare(renderer *r, const scene *s, diagnostic *why);
