/* Small images of a plan at chosen depth limits, with the throughput of the rays that these cut. A thread per
 * processing unit traces stripes of an image; images, ray counts and so the notes do not depend on the number of
 * threads. Ownership: probe_images_begin and probe_images_end pair, also after an error; the plan is borrowed, and its
 * depth is as it was at the end; an image belongs to the caller, who frees it with probe_image_free. */
#pragma once

#include "base/isa.h"
#include "base/thread_team.h"
#include "render/plan/plan.h"
#include "render/frame/tracers.h"
#include <stdatomic.h>

enum { PROBE_THREADS_MAX = 8 };

/* What a display shows of darker values is black. */
#define PROBE_DARK (1.0f / 255.0f)

typedef struct probe_image {
    float *rgb; /* linear, [pixel][channel], 1 is white; NULL: not traced */
    float *cut; /* throughput of each pixel's rays that render.depth cut, mean of RGB, where its camera rays have 1 in
                     all; with render.min_weight its part of what both cut, as over the whole image */
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

/* --- what an image may lack because rays were cut, and the remedy ---
 *
 * A pixel's radiance is the sum over its rays of the radiance of each, times its throughput. Rays of throughput T in
 * all that were not traced, each of a radiance from 0 to B, change it by at most T B, whatever render.beyond puts in
 * their place. As bright as the image in the mean, they are the fraction T of its light, T the mean over the pixels:
 * this estimate decides about notes. As bright as white, they are T / L of an image of the mean radiance L: this bound
 * decides about the depth of a remedy. Where a deeper image exists, its difference is known, and only the rays that it
 * cuts are unknown. Pure. */

/* An image may lack this fraction of its light without a note. */
#define LACK_ACCEPTED 0.01

typedef struct lack {
    double mean;    /* known and unknown, as a fraction of the image's light; may exceed 1 */
    double unknown; /* the part that no image shows */
    double bound;   /* the same if rays that were cut are white */
    double error;   /* standard error of mean, of the pixels as a random sample */
    double largest; /* the largest fraction of a pixel's weight that at cuts */
} lack;

/* Of the image at, where deepest, which may be at itself, is known. */
lack lack_of(size_t pixels, const probe_image *at, const probe_image *deepest);

/* The mean of the image's cut. */
double lack_cut(size_t pixels, const probe_image *of);

/* The factor by which each of some levels multiplied the throughput that is cut, at most 1. */
double lack_decay(double before, double after, int levels);

/* The least depth at which the bound is accepted, if each level multiplies it by decay: INT_MAX for none; twice the
 * depth where the decay is unknown, NaN. */
int lack_depth_enough(int depth, double bound, double decay);

/* Random paths need no limit: faint ones end at random, and the others take over their weight, so that the mean is that
 * of all. The end of a remedy that sets it. */
#define REMEDY_WITHOUT_LIMIT "render.depth=unlimited"
