/* The integrator interface. An integrator decides which rays the camera sends out, what they hit, and how hits and
 * misses contribute to the film. Everything else is common to all integrators and belongs to the renderer and the
 * tracer: workers, tiles, queues of rays by depth, batches, groups by surface, colours, lights, counters, times.
 *
 * A new integrator is a row of INTEGRATORS (scene/model/integrators.h) and a file in render/integrators that defines
 * its table of functions, most of which may be NULL. Each function is called once per frame, tile, batch or group,
 * never per ray. Integrators read and write the tracer (tracer.h) and call the functions of render/shade and
 * render/camera; several tables share intersect_nearest (shading.h), background_sky (exposure.h) and camera_samples
 * (kernels.h).
 *
 * Order of calls in a frame: `prepare`; each step, by all workers and then by one; on each worker that gets a tile
 * `begin`, then for its tiles `tile`, and for its batches `intersect`, `background`, `place` and `shade`; `finish`;
 * `release`. The image must not depend on the order or thread of these calls. Ownership: what `prepare` returns belongs
 * to the frame until `release`; what `begin` stores in t->worker_data belongs to the worker, is kept for later frames
 * of the same integrator, and is released by `end`. */
#pragma once

#include "geometry/rays.h"
#include "render/plan/film.h"
#include "render/plan/plan.h"
#include "render/plan/schedule.h"
#include "render/tracer/queue.h"

typedef struct tracer tracer;

/* The outputs of a frame. The maps may be NULL; pixel_cut receives the throughput of each pixel's rays that are not
 * traced, red + green + blue in units of 1/COUNTERS_CUT_ONE: integers, so that their order does not matter. state is
 * the integrator's state for the frame; layers receives named layers, NULL if they are not requested;
 * integrator_override: NULL for the integrator of the plan's settings. */
typedef struct tracer_target {
    const plan *frame_plan;
    film *img;
    double *pixel_rays, *pixel_ns, *pixel_cut;
    void *state;
    layer_set *layers;
    const struct integrator *integrator_override;
} tracer_target;

/* The numbers of camera rays of one pixel. camera_rays_enqueue (render/camera/camera_rays.c) makes the rays. */
typedef struct camera_sampling {
    int64_t rays;
    int64_t points;         /* upper limit of sample points in a pixel: the largest k x k grid with at most that many */
    int64_t rays_per_point; /* consecutive rays through one point; the next rays use the next point, cyclically */
    bool jittered;          /* instead of the grid, each ray has a random point of the pixel */
    int64_t marks; /* further bits of the rays' sample keys, in addition to pixel and sample (render/plan/sampling.h) */
} camera_sampling;

/* A step of a pre-pass. A step starts when the previous one has ended. */
typedef struct integrator_step {
    void (*parallel)(void *frame);                  /* called by all workers at once; divides the work among them */
    status (*serial)(void *frame, diagnostic *why); /* then called by one thread; NULL: none */
} integrator_step;

/* What a ray does where a surface is there in part (material_alpha). */
typedef enum cover_use {
    COVER_CUT,    /* meets it if at least half of it is there */
    COVER_CHANCE, /* meets it by chance */
    COVER_SPLIT   /* meets it, and a further ray goes on, if lighting is whitted; otherwise as COVER_CUT */
} cover_use;

typedef struct integrator {
    cover_use cover;
    bool traced;   /* hits are found by ray tests of the solids, so that all rays are counted and media absorb */
    bool by_solid; /* its values depend on the solid that a ray hits, not only on the material */
    bool needs_sample_number; /* it needs the sample number of each ray within its pixel */

    /* --- a frame --- */
    camera_sampling (*sampling)(const render_settings *r);
    /* The number of replicates of a pixel's rays, equal in size, which are exposed separately, so that their
     * differences give the noise; NULL: 1. */
    int (*replicates)(const render_settings *r);
    status (*prepare)(const plan *p, void **frame, diagnostic *why);
    const integrator_step *steps; /* ends with a row of NULLs; NULL: none */
    /* Called after the last ray: adds to the frame's mesh report; returns an error if the image is incomplete. */
    status (*finish)(void *frame, mesh_report *report, diagnostic *why);
    void (*release)(void *frame); /* frame may be NULL */

    /* --- a worker --- */
    bool (*begin)(tracer *t); /* begins a frame, with t->target set; false when out of memory */
    void (*end)(void *worker_data);

    /* --- a tile, a batch, a group --- */
    void (*tile)(tracer *t, const image_tile *tile); /* called before the tile's camera rays */
    /* Fills t->batch.hits; a traced integrator uses intersect_nearest. */
    void (*intersect)(tracer *t, ray_queue *q, int first, int depth, const ray_batch *rays);
    /* Handles rays list[0 .. count - 1] of the batch, which hit nothing. */
    void (*background)(tracer *t, const ray_queue *q, int first, const int *list, int count);
    /* May move points of the gathered group before its colours are computed; list: its rays in the batch. */
    void (*place)(tracer *t, const int *list);
    /* Shades the gathered group, whose colours are computed: adds light to the film, enqueues shadow rays and
     * children. */
    void (*shade)(tracer *t, int depth, int priority_index);
} integrator;

/* The integrator of render.integrator: render/frame/tracers.c. */
const integrator *integrator_for(const render_settings *r);

/* Whitted's recursion for all depth limits at once: the film of each limit without a frame for each.
 *
 * The film has LEVELS_LAYERS(limit) layers, each as large as the image and stored one after another: a film of the
 * image's width, and of its height times that number. Layer 2 k is the light that rays of depth k bring, layer 2 k + 1
 * what render.beyond substitutes for their branches. So the image with a depth limit d is the sum of layers 0, 2, .. 2
 * d and of layer 2 d + 1. The maps of a tracer_target have the same layers: in pixel_rays layer 2 k counts the rays of
 * depth k; in pixel_cut layer 2 k + 1 is the throughput that a limit of k cuts, and layer 2 k + 2 what
 * render.min_weight cuts of the branches of depth k. The image is that of integrator_of_whitted, except that random
 * numbers differ: they depend on the place in the film. render.lighting must be whitted. For
 * tracer_target.integrator_override; defined in render/integrators/whitted.c. */
#define LEVELS_LAYERS(limit) (2 * ((limit) + 1))
extern const integrator integrator_of_levels;
