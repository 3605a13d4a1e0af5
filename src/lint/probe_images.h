/* Small images of a plan at chosen depth limits, with the throughput of the rays that these cut. A thread per
 * processing unit traces stripes of an image; images, ray counts and so the notes do not depend on the number of
 * threads. Ownership: probe_images_begin and probe_images_end pair, also after an error; the plan is borrowed, and its
 * depth is as it was at the end; an image belongs to the caller, who frees it with probe_image_free. */
#pragma once

#include "base/isa.h"
#include "base/thread_team.h"
#include "render/core/plan.h"
#include "render/core/tracer.h"

#include <stdatomic.h>

enum { PROBE_THREADS_MAX = 8 };

/* What a display shows of darker values is black. */
#define PROBE_DARK (1.0f / 255.0f)

typedef struct probe_image {
    float *rgb; /* linear, [pixel][channel], 1 is white; NULL: not traced */
    float *cut; /* throughput of each pixel's rays that render.depth cut, mean of RGB, where its camera rays have 1 in
                     all; with render.min_weight its share of what both cut, as over the whole image */
    double by_weight; /* mean over the pixels of what render.min_weight cut */
} probe_image;

typedef struct probe_images {
    plan *made;
    thread_team *team;
    tracer *rays[PROBE_THREADS_MAX]; /* one per member of the team */
    int stripes;
    atomic_int next_stripe;
    double *pixel_rays, *pixel_cut;
    int64_t depth; /* of the plan at the beginning */
    double spent;  /* rays so far */
} probe_images;

/* False when out of memory. */
bool probe_images_begin(probe_images *p, plan *made, isa level);
void probe_images_end(probe_images *p);

/* *to: may hold an earlier image, whose memory is used again. */
status probe_images_trace(probe_images *p, int depth, probe_image *to, diagnostic *why);
void probe_image_free(probe_image *old);

/* Whether a contribution left the film's range in one of the images. */
bool probe_images_overflowed(const probe_images *p);

static inline size_t probe_pixels(const probe_images *p)
{
    return (size_t)(p->made->render.width * p->made->render.height);
}
