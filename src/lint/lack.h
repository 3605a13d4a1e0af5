/* What an image may lack because rays were cut, and the remedy. A pixel's radiance is the sum over its rays of what
 * each brings, times its throughput. Rays of throughput T in all that were not traced, each of a radiance from 0 to B,
 * change it by at most T B, whatever render.beyond puts in their place. As bright as the image in the mean, they are
 * the share T of its light, T the mean over the pixels: this estimate decides about notes. As bright as white, they are
 * T / L of an image of the mean radiance L: this bound decides about the depth of a remedy. Where a deeper image
 * exists, its difference is known, and only the rays that it cuts are unknown. Pure. */
#pragma once

#include "lint/probe_images.h"

/* An image may lack this share of its light without a note. */
#define LACK_ACCEPTED 0.01

typedef struct lack {
    double mean;    /* known and unknown, as a share of the image's light; may exceed 1 */
    double unknown; /* the part that no image shows */
    double bound;   /* the same if rays that were cut are white */
    double error;   /* standard error of mean, of the pixels as a random sample */
    double largest; /* the largest share of a pixel's weight that at cuts */
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
