/* What an integrator is to the renderer: it decides which rays the camera sends out, what they meet, and what becomes
 * of those that met a surface and of those that met nothing. Everything else is alike for all of them and belongs to
 * the renderer and the tracer: workers, pieces of the image, queues of rays by depth, batches, groups by surface,
 * colours, lights, counters, times.
 *
 * A new integrator is a row of INTEGRATORS (scene/model/integrators.h) and a file here that defines its table of
 * functions, most of which may be NULL. All are called once for a frame, a piece, a batch or a group, never for a
 * single ray. They reach the tracer's inside through render/shade/shading.h, which also declares the functions that
 * several tables share: meet_nearest and background_sky (render/shade/shading.c), camera_samples
 * (render/camera/camera_rays.c).
 *
 * Order of a frame: prepare; each step, by all workers and then by one; on each worker that gets a piece begin, then
 * for its pieces piece, and for its batches meet, background, place and shade; finish; release. The image must not
 * depend on who calls when (design, decision 5).
 * Ownership: what prepare gives is the frame's, until release; what begin puts into t->own is the worker's, is kept
 * for later frames of the same integrator, and goes with end. */
#pragma once

#include "geometry/rays.h"
#include "render/core/mesh_report.h"
#include "render/core/plan.h"
#include "render/core/queue.h"
#include "render/core/schedule.h"
#include "render/core/tracer.h"

/* The camera rays of one pixel: numbers. The rays themselves are made by camera_rays_put_in_line
 * (render/camera/camera_rays.c). */
typedef struct camera_sampling {
    int64_t rays;
    int64_t points;   /* of the pixel that they go through, at most: the largest square grid of no more is taken */
    int64_t together; /* rays, one after another, through one point; the next ones through the next, round and round */
    int64_t marks;    /* bits that their tickets have besides pixel and sample (render/core/sample_key.h) */
} camera_sampling;

/* A step of a pre-pass. Steps wait for each other. */
typedef struct integrator_step {
    void (*together)(void *frame);                 /* by all workers at once; it is to share out its own work */
    status (*alone)(void *frame, diagnostic *why); /* then by one thread; NULL for nothing */
} integrator_step;

typedef struct integrator {
    bool traced;    /* what is met is found by tests of the solids: all rays count, and media dim them */
    bool by_sample; /* it wants to know of each ray which sample of its pixel it belongs to */

    /* --- a frame --- */
    camera_sampling (*sampling)(const render_settings *r);
    /* How many equal shares of a pixel's rays are exposed apart, so that their differences tell the noise; NULL: 1. */
    int (*shares)(const render_settings *r);
    status (*prepare)(const plan *p, void **frame, diagnostic *why);
    const integrator_step *steps; /* ends with NULLs; NULL for none */
    /* After the last ray: adds to the frame's account; an error where the image is not whole. */
    status (*finish)(void *frame, mesh_report *report, diagnostic *why);
    void (*release)(void *frame); /* NULL is allowed as the frame */

    /* --- a worker --- */
    bool (*begin)(tracer *t); /* a frame, with t->target set; false when memory is out */
    void (*end)(void *own);

    /* --- a piece, a batch, a group --- */
    void (*piece)(tracer *t, const span *piece); /* before the piece's camera rays */
    /* Fills t->batch.hits: meet_nearest for a traced one. */
    void (*meet)(tracer *t, ray_queue *q, int first, int depth, const ray_batch *rays);
    /* Rays list[0 .. count - 1] of the batch, which met nothing. */
    void (*background)(tracer *t, const ray_queue *q, int first, const int *list, int count);
    /* May move points of the gathered group before it gets its colours; list: its rays in the batch. */
    void (*place)(tracer *t, const int *list);
    /* The gathered group, coloured: light to the film, shadow rays and children put in line. */
    void (*shade)(tracer *t, int depth, int priority_index);
} integrator;

/* The integrator of render.integrator. */
const integrator *integrator_for(const render_settings *r);
