/* The integrator interface. An integrator decides which rays the camera sends out, what they hit, and how hits and
 * misses contribute to the film. Everything else is common to all integrators and belongs to the renderer and the
 * tracer: workers, pieces of the image, queues of rays by depth, batches, groups by surface, colours, lights, counters,
 * times.
 *
 * A new integrator is a row of INTEGRATORS (scene/model/integrators.h) and a file here that defines its table of
 * functions, most of which may be NULL. Each is called once per frame, piece, batch or group, never per ray. They
 * access the tracer's internals through render/shade/shading.h, which also declares the functions that several tables
 * share: intersect_nearest and background_sky (render/shade/shading.c), camera_samples (render/camera/camera_rays.c).
 *
 * Order of calls in a frame: prepare; each step, by all workers and then by one; on each worker that gets a piece
 * begin, then for its pieces piece, and for its batches intersect, background, place and shade; finish; release. The
 * image must not depend on the order or thread of these calls. Ownership: what prepare returns
 * belongs to the frame until release; what begin stores in t->own belongs to the worker, is kept for later frames of
 * the same integrator, and is released by end. */
#pragma once

#include "geometry/rays.h"
#include "render/core/mesh_report.h"
#include "render/core/plan.h"
#include "render/core/queue.h"
#include "render/core/schedule.h"
#include "render/core/tracer.h"

/* The numbers of camera rays of one pixel. camera_rays_enqueue (render/camera/camera_rays.c) makes the rays. */
typedef struct camera_sampling {
    int64_t rays;
    int64_t points;   /* upper limit of sample points in a pixel: the largest k x k grid with at most that many */
    int64_t together; /* number of consecutive rays through one point; the next ones use the next point, cyclically */
    bool jittered;    /* instead, each ray has its own random point of the pixel */
    int64_t marks;    /* further bits of their sample keys besides pixel and sample (render/core/sample_key.h) */
} camera_sampling;

/* A step of a pre-pass. A step starts when the previous one has ended. */
typedef struct integrator_step {
    void (*together)(void *frame);                 /* by all workers at once; it distributes its own work among them */
    status (*alone)(void *frame, diagnostic *why); /* then by one thread; NULL: none */
} integrator_step;

typedef struct integrator {
    bool traced;    /* hits are found by ray tests of the solids: all rays count, and media absorb */
    bool by_solid;  /* its values depend on which solid a ray hits, beyond the material */
    bool by_sample; /* it needs the sample number of each ray within its pixel */

    /* --- a frame --- */
    camera_sampling (*sampling)(const render_settings *r);
    /* Number of equal shares of a pixel's rays that are exposed separately, so that their differences give the noise;
     * NULL: 1. */
    int (*shares)(const render_settings *r);
    status (*prepare)(const plan *p, void **frame, diagnostic *why);
    const integrator_step *steps; /* ends with a row of NULLs; NULL: none */
    /* Called after the last ray: adds to the frame's mesh report; returns an error if the image is incomplete. */
    status (*finish)(void *frame, mesh_report *report, diagnostic *why);
    void (*release)(void *frame); /* frame may be NULL */

    /* --- a worker --- */
    bool (*begin)(tracer *t); /* begins a frame, with t->target set; false when out of memory */
    void (*end)(void *own);

    /* --- a piece, a batch, a group --- */
    void (*piece)(tracer *t, const span *piece); /* called before the piece's camera rays */
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

/* The integrator of render.integrator. */
const integrator *integrator_for(const render_settings *r);
