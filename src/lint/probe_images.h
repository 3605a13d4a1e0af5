/* Small images of a plan at chosen depth limits, with the throughput of the rays that the limits cut. One thread per
 * processing unit renders stripes of an image; images, ray counts and therefore notes do not depend on the number of
 * threads. Ownership: call probe_images_end after probe_images_begin, even if it failed; it restores the depth of the
 * plan, which is borrowed. The caller frees an image with probe_image_free. */
#pragma once

#include "base/isa.h"
#include "base/worker_pool.h"
#include "render/frame/tracers.h"
#include "render/plan/plan.h"
#include <stdatomic.h>

enum { PROBE_THREADS_MAX = 8 };

/* A display shows darker values as black. */
#define PROBE_DARK (1.0f / 255.0f)

typedef struct probe_image {
    float *rgb; /* linear, [pixel][channel], 1 is white; NULL: not rendered */
    /* Per pixel, the throughput that render.depth cut: mean of RGB, as a fraction of the camera rays'. If
     * render.min_weight cuts rays, too, both are divided in the same proportion in every pixel. */
    float *cut;
    double by_weight; /* throughput that render.min_weight cut, mean over the pixels */
} probe_image;

typedef struct probe_images {
    plan *made;
    thread_team *team;
    tracer *tracers[PROBE_THREADS_MAX]; /* one per member of the team */
    int stripes;
    atomic_int next_stripe;
    double *pixel_rays, *pixel_cut;
    int64_t depth; /* the plan's depth, restored at the end */
    double spent;  /* number of rays so far */
} probe_images;

/* False when out of memory. */
bool probe_images_begin(probe_images *p, plan *made, isa level);
void probe_images_end(probe_images *p);

/* Renders an image with this depth limit. *to may hold an earlier image, whose memory is reused. */
status probe_images_render(probe_images *p, int depth, probe_image *to, diagnostic *why);
/* Renders the images of ray trees for each limit from 0 to `limit` in one pass (integrator_of_levels).
 * levels[limit + 1]: as above; rays[limit + 1]: the number of rays of each depth, with their shadow rays. */
status probe_images_render_levels(probe_images *p, int limit, probe_image *levels, double *rays, diagnostic *why);
void probe_image_free(probe_image *old);

/* Whether a contribution left the film's range in one of the images. */
bool probe_images_overflowed(const probe_images *p);

static inline size_t probe_pixels(const probe_images *p)
{
    return (size_t)(p->made->render.width * p->made->render.height);
}

/* --- what an image may lack because rays were cut, and the remedy ---
 *
 * A pixel's radiance is the sum of throughput times radiance over its rays. If rays of total throughput T are cut, each
 * of a radiance between 0 and B, the pixel changes by at most T B, whatever render.beyond substitutes. Let T be the
 * mean over the pixels, and L the image's mean radiance. If the cut rays are as bright as the image, they carry the
 * fraction T of its light: this estimate decides about notes. If they are white, they carry T / L: this bound decides
 * about the depth of a remedy. With a deeper image the difference is known, and only the rays that it cuts are unknown.
 * Pure. */

/* An image may lack this fraction of its light without a note. */
#define LACK_ACCEPTED 0.01

typedef struct lack {
    double mean;    /* missing light, known and unknown, as a fraction of the image's light; may exceed 1 */
    double unknown; /* the part of it that the deepest image does not show */
    double bound;   /* `unknown` if the cut rays are white */
    double error;   /* standard error of mean, if the pixels are a random sample */
    double largest; /* the largest fraction of a pixel's throughput that is cut */
} lack;

/* What the image `at` lacks, by comparison with a deeper image, which may be `at` itself. */
lack lack_of(size_t pixels, const probe_image *at, const probe_image *deepest);

/* The mean of an image's cut throughput over its pixels. */
double lack_cut(size_t pixels, const probe_image *of);

/* The factor by which each of `levels` levels multiplied the cut throughput, at most 1. */
double lack_decay(double before, double after, int levels);

/* The least depth at which the bound is accepted, if each level multiplies it by decay; INT_MAX if there is none; twice
 * the depth if the decay is unknown (NaN). */
int lack_depth_enough(int depth, double bound, double decay);

/* The end of a remedy for random paths, which need no limit: Russian roulette ends faint paths without bias. */
#define REMEDY_WITHOUT_LIMIT "render.depth=unlimited"
